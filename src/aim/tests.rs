use super::*;
use crate::math::sampling;
use std::f64::consts::PI;

fn plate(half: DVec3, centre: DVec3) -> Target {
    Target {
        label: String::new(),
        frame: Frame::from_z_x(DVec3::new(0.3, -0.5, 0.8).normalize(), DVec3::X),
        centre,
        half,
    }
}

/// From far and near, over an edge, a corner and the middle, flat and thick, small and large.
fn views() -> Vec<View> {
    let boxes = [DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.3, 0.3, 0.3), DVec3::new(5.0, 0.1, 1.0)];
    let aways = [
        DVec3::new(0.0, 0.0, 0.2),
        DVec3::new(3.0, 1.0, 7.0),
        DVec3::new(-40.0, 90.0, 30.0),
        DVec3::new(6.0, 0.0, -1.5),
    ];
    let see = |half: DVec3, away: DVec3| {
        let target = plate(half, DVec3::new(0.7, -0.2, 0.1));
        target.seen(target.centre + target.frame.to_world(away))
    };
    boxes.into_iter().flat_map(|half| aways.map(|away| see(half, away))).flatten().collect()
}

/// The solid angle of a centred rectangle, 4 asin(sin a sin b) with tan a = width / 2h, and so on.
#[test]
fn a_rectangle_straight_ahead_has_its_solid_angle() {
    let target = plate(DVec3::new(1.0, 2.0, 0.0), DVec3::ZERO);
    for height in [0.01f64, 1.0, 20.0] {
        let view = target.seen(height * target.frame.z).expect("it is seen");
        let sine = |half: f64| half / half.hypot(height);
        let exact = 4.0 * (sine(1.0) * sine(2.0)).asin();
        assert!((view.solid_angle() - exact).abs() < 1e-13, "{height}: {} {exact}", view.solid_angle());
    }
}

/// Draws fill the view as the density says: what is drawn weighs 1/density and adds up to the solid angle of any part of it,
/// and to that of the whole, found from directions all round.
#[test]
fn the_density_is_that_of_the_draws() {
    let mut rng = Rng::new(3, 0, 0);
    for (i, view) in views().iter().enumerate() {
        let n = 40_000;
        let drawn: Vec<DVec3> = (0..n).map(|_| view.draw(&mut rng)).collect();
        assert!(drawn.iter().all(|&d| view.density(d * (1.0 - 1e-12)) > 0.0 || view.density(d) > 0.0));
        // Moments of the direction over the view, once by its own draws and once by those in a cone around it.
        let middle = drawn.iter().sum::<DVec3>().normalize();
        let widest = drawn.iter().map(|d| d.angle_between(middle)).fold(0.0, f64::max);
        let half = (1.05 * widest).min(PI);
        let frame = Frame::from_z(middle);
        for part in [DVec3::ZERO, frame.x, frame.y] {
            let g = |d: DVec3| if part == DVec3::ZERO || d.dot(part) > 0.0 { 1.0 } else { 0.0 };
            let own: Vec<f64> = drawn.iter().map(|&d| g(d) / view.density(d).max(1e-300)).collect();
            let cone: Vec<f64> = (0..n)
                .map(|_| frame.to_world(sampling::cone(rng.pair(), half)))
                .map(|d| if view.density(d) > 0.0 { g(d) * sampling::cone_solid_angle(half) } else { 0.0 })
                .collect();
            let mean = |values: &[f64]| values.iter().sum::<f64>() / n as f64;
            let error = |values: &[f64]| {
                let m = mean(values);
                (values.iter().map(|v| (v - m).powi(2)).sum::<f64>() / (n as f64).powi(2)).sqrt()
            };
            let sigma = error(&own).hypot(error(&cone));
            assert!(
                (mean(&own) - mean(&cone)).abs() < 4.5 * sigma,
                "{i} {part}: {} {} ± {sigma}",
                mean(&own),
                mean(&cone)
            );
        }
    }
}

#[test]
fn nothing_is_seen_from_inside_or_from_the_plane() {
    let thick = plate(DVec3::splat(1.0), DVec3::ZERO);
    assert!(thick.seen(0.3 * thick.frame.x).is_none());
    let flat = plate(DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO);
    assert!(flat.seen(5.0 * flat.frame.x).is_none());
}
