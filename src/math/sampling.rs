//! Points drawn on simple domains, each function with its density. All take uniform numbers in [0, 1) and keep
//! neighbours near each other, so that low-discrepancy points stay so.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// On the unit disc, density 1/pi. Concentric map of the square (Shirley & Chiu, J. Graphics Tools 2(3), 45, 1997).
pub fn disc([u, v]: [f64; 2]) -> DVec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return DVec2::ZERO;
    }
    let wide = a.abs() > b.abs();
    let (sin, cos) = sin_cos_of_eighth(FRAC_PI_4 * if wide { b / a } else { a / b });
    if wide { DVec2::new(a * cos, a * sin) } else { DVec2::new(b * sin, b * cos) }
}

/// Sine and cosine of at most an eighth of a turn, |x| <= pi/4, to 2e-16: Taylor's series. No range to reduce, so five times
/// faster than the library's.
fn sin_cos_of_eighth(x: f64) -> (f64, f64) {
    /// 1 / n!
    const fn inverse(n: u32) -> f64 {
        let (mut product, mut k) = (1.0, 2);
        while k <= n {
            product *= k as f64;
            k += 1;
        }
        1.0 / product
    }
    const SIN: [f64; 8] =
        [-inverse(3), inverse(5), -inverse(7), inverse(9), -inverse(11), inverse(13), -inverse(15), inverse(17)];
    const COS: [f64; 8] =
        [-inverse(2), inverse(4), -inverse(6), inverse(8), -inverse(10), inverse(12), -inverse(14), inverse(16)];
    let square = x * x;
    let series = |terms: &[f64; 8]| terms.iter().rev().fold(0.0, |sum, term| (sum + term) * square);
    (x + x * series(&SIN), 1.0 + series(&COS))
}

/// Sine and cosine of `u` turns, 0 <= u <= 1, to 2e-16.
pub fn sin_cos_of_turn(u: f64) -> (f64, f64) {
    let quarter = (4.0 * u).round();
    let (sin, cos) = sin_cos_of_eighth(TAU * (u - 0.25 * quarter));
    match quarter as u8 {
        1 => (cos, -sin),
        2 => (-sin, -cos),
        3 => (-cos, sin),
        _ => (sin, cos),
    }
}

/// On the ring between radii `inner` and 1, 0 <= inner < 1: density 1 / (pi (1 - inner^2)).
pub fn annulus([u, v]: [f64; 2], inner: f64) -> DVec2 {
    let radius = (inner * inner + u * (1.0 - inner) * (1.0 + inner)).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec2::new(radius * cos, radius * sin)
}

/// Unit vector with z > 0, density cos(theta)/pi per sr (Malley: a uniform disc, projected up).
pub fn cosine_hemisphere(uv: [f64; 2]) -> DVec3 {
    let p = disc(uv);
    // |p| = 1 - 1e-16 at most by construction of `disc`; its rounding must not give the root of a negative number.
    p.extend((1.0 - p.length_squared()).max(f64::MIN_POSITIVE).sqrt())
}

/// Unit vector anywhere, density 1/(4 pi) per sr.
pub fn sphere([u, v]: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * u;
    around_z(z, 2.0 * (u * (1.0 - u)).sqrt(), v)
}

/// Unit vector within `half_angle` rad of +z, 0 < half_angle <= pi: density 1 / (4 pi sin^2(half_angle/2)) per sr.
/// Exact for cones of any narrowness: 1 - cos is computed as 2 sin^2 of the half.
pub fn cone([u, v]: [f64; 2], half_angle: f64) -> DVec3 {
    let h = u * 2.0 * (0.5 * half_angle).sin().powi(2);
    around_z(1.0 - h, (h * (2.0 - h)).sqrt(), v)
}

/// Solid angle of [`cone`], sr.
pub fn cone_solid_angle(half_angle: f64) -> f64 {
    4.0 * PI * (0.5 * half_angle).sin().powi(2)
}

/// Barycentric weights of a point on a triangle, density 1/area.
pub fn triangle([u, v]: [f64; 2]) -> [f64; 3] {
    let root = u.sqrt();
    [1.0 - root, root * (1.0 - v), root * v]
}

/// Two independent normal deviates, mean 0, variance 1 (Box & Muller, 1958); their tail reaches 8.5 sigma.
pub fn normal_pair([u, v]: [f64; 2]) -> DVec2 {
    let radius = (-2.0 * (1.0 - u).ln()).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec2::new(radius * cos, radius * sin)
}

/// The unit vector of height `z` and distance `radius` from the z axis, `turn` turns about it.
fn around_z(z: f64, radius: f64, turn: f64) -> DVec3 {
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    /// Mean of `f` over 1e5 draws.
    fn mean(f: impl Fn([f64; 2]) -> f64) -> f64 {
        let mut rng = Rng::new(5, 0, 0);
        (0..100_000).map(|_| f(rng.pair())).sum::<f64>() / 1e5
    }

    #[test]
    fn second_moments_are_those_of_the_uniform_densities() {
        // 1e5 draws: sigma of each mean < 0.0016 (the normal pair 0.0045), checked to 4 sigma.
        assert!((mean(|p| disc(p).length_squared()) - 0.5).abs() < 0.004);
        assert!((mean(|p| disc(p).x.powi(2)) - 0.25).abs() < 0.004);
        assert!((mean(|p| annulus(p, 0.5).length_squared()) - 0.625).abs() < 0.004);
        assert!((mean(|p| cosine_hemisphere(p).z) - 2.0 / 3.0).abs() < 0.004);
        assert!((mean(|p| sphere(p).z.powi(2)) - 1.0 / 3.0).abs() < 0.004);
        assert!((mean(|p| triangle(p)[0]) - 1.0 / 3.0).abs() < 0.004);
        assert!((mean(|p| normal_pair(p).x.powi(2)) - 1.0).abs() < 0.018);
    }

    #[test]
    fn a_cone_of_a_microradian_is_sampled_to_its_edge() {
        let half = 1e-6;
        let edge = cone([1.0 - f64::EPSILON, 0.0], half);
        assert!((edge.x / half - 1.0).abs() < 1e-9);
        assert!((cone_solid_angle(half) / (PI * half * half) - 1.0).abs() < 1e-12);
        assert!((mean(|p| cone(p, half).truncate().length_squared()) / (half * half) - 0.5).abs() < 0.004);
    }

    #[test]
    fn sines_of_an_eighth_of_a_turn_are_exact_to_the_last_digit() {
        for i in -1000..=1000 {
            let x = FRAC_PI_4 * i as f64 / 1000.0;
            let ((sin, cos), (s, c)) = (sin_cos_of_eighth(x), x.sin_cos());
            assert!((sin - s).abs() <= 2.3e-16 && (cos - c).abs() <= 2.3e-16, "{x}");
        }
    }

    #[test]
    fn sines_of_a_turn_are_exact_to_the_last_digit() {
        for i in 0..=1000 {
            let u = f64::from(i) / 1000.0;
            let ((sin, cos), (s, c)) = (sin_cos_of_turn(u), (TAU * u).sin_cos());
            // The library's argument is rounded: 4e-16.
            assert!((sin - s).abs() <= 7e-16 && (cos - c).abs() <= 7e-16, "{u}");
        }
    }

    #[test]
    fn directions_are_unit() {
        for p in [[0.0, 0.0], [0.3, 0.9], [0.999_999_999, 0.5], [1.0 - f64::EPSILON / 2.0, 0.0]] {
            for d in [cosine_hemisphere(p), sphere(p), cone(p, 1.0)] {
                assert!((d.length() - 1.0).abs() < 1e-15, "{p:?} {d}");
            }
            assert!(cosine_hemisphere(p).z > 0.0);
        }
    }
}
