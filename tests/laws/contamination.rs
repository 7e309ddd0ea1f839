//! Particles on surfaces: numbers, sizes and light against the reference case; laws on mirrors, walls and glass.

use crate::reference::{case, close, number, values};
use glam::DVec3;
use num_complex::Complex64;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};
use straylight::bsdf::contamination::{Deposit, cumulated, distribution};
use straylight::coating::{Bare, Coating, Ideal, Mirror};
use straylight::math::Rng;
use straylight::medium::{Constant, Loss};
use straylight::optics::Incidence;
use straylight::surface::{Order, Scattering, Surface};
use straylight::system::compile::compile;
use straylight::system::document::Document;
use straylight::transport::{self, summary};

const LINE: f64 = 550e-9;

fn deposit(level: f64, slope: f64) -> Deposit {
    let dust = Constant { n: 1.53, loss: Loss::Extinction(0.001) };
    Deposit::new(&dust, &distribution(level, slope, [1e-6, 200e-6]), &[LINE])
}

fn surface(specular: Option<Arc<dyn Coating>>, deposit: Arc<Deposit>, behind: bool) -> Surface {
    Surface::new("dusty".into(), specular, Vec::new(), Order::ScatterFirst, Scattering::On).under(deposit, behind)
}

/// A level at which a good part of the light meets a particle.
fn dirty() -> Arc<Deposit> {
    static DIRTY: OnceLock<Arc<Deposit>> = OnceLock::new();
    DIRTY.get_or_init(|| Arc::new(deposit(800.0, 0.926))).clone()
}

fn by_key(value: &Value, name: &str) -> Vec<(f64, f64)> {
    let map = value[name].as_object().unwrap_or_else(|| panic!("no {name}"));
    map.iter().map(|(key, v)| (key.parse().expect("a number"), v.as_f64().expect("a number"))).collect()
}

#[test]
fn sca_12_particulate_contamination() {
    let all = case("SCA-12");
    for value in values(&all) {
        let (level, slope) = (number(&value, "level"), number(&value, "slope"));
        for (diameter, wanted) in by_key(&value, "N_ge_D_per_0p1m2") {
            let found = 0.1 * cumulated(level, slope, 1e-6 * diameter);
            close(found / wanted, 1.0, 1e-9, &format!("SCA-12 level {level}: N(>= {diameter} um)"));
        }
        let deposit = Arc::new(deposit(level, slope));
        let relative = |found: f64, name: &str| {
            close(found / number(&value, name), 1.0, 1e-5, &format!("SCA-12 level {level}: {name}"));
        };
        relative(deposit.coverage, "PAC_fraction");
        relative(deposit.extinction(LINE), "extinction");
        // A lossless screen that reflects nothing.
        let screen: Arc<dyn Coating> = Arc::new(Ideal { reflectance: 0.0, transmittance: 1.0 });
        let screen = surface(Some(screen), deposit, false);
        let at = Incidence::in_air(0.0, LINE);
        let shares = screen.shares(&at);
        for (angle, wanted) in by_key(&value, "BTDF_normal_incidence") {
            let (sin, cos) = f64::to_radians(angle).sin_cos();
            let wo = DVec3::new(sin, 0.0, -cos);
            let found = screen.weigh(&at, &shares, wo).value / cos;
            // The reference takes the layer to first order: t = 1 - E instead of exp(-E). Its rings are resolved to 1 %.
            close(found / wanted, 1.0, 0.012, &format!("SCA-12 level {level}: BTDF at {angle} deg"));
        }
        let [turned, passed] = screen.albedo(&at);
        close((turned + passed) / number(&value, "scatter_total"), 1.0, 0.005, "SCA-12: all scatter");
        close(passed / number(&value, "scatter_forward_hemisphere"), 1.0, 0.01, "SCA-12: scatter that goes on");
    }
}

/// Specular and scattered light and what the particles absorb are all of the light, for whatever is under them.
fn bill(surface: &Surface, at: &Incidence) -> [f64; 2] {
    let shares = surface.shares(at);
    let split = shares.split.map_or([0.0; 2], |s| [s.reflected.unpolarised(), s.transmitted.unpolarised()]);
    [split[0] * shares.specular[0] + split[1] * shares.specular[1], shares.scattered]
}

#[test]
fn a_dusty_surface_never_sends_on_more_than_arrives() {
    let perfect: Arc<dyn Coating> = Arc::new(Mirror { reflectance: 1.0 });
    let specular: [Option<Arc<dyn Coating>>; 3] = [None, Some(perfect), Some(Arc::new(Bare))];
    for coating in specular {
        for behind in [false, true] {
            let surface = surface(coating.clone(), dirty(), behind);
            for angle in [0.0, 45.0, 75.0, 85.0, 89.0] {
                let index = [1.0, 1.5].map(|n| Complex64::new(n, 0.0));
                let index = if behind { [index[1], index[0]] } else { index };
                let at = Incidence { index, ..Incidence::in_air(f64::to_radians(angle), LINE) };
                let [straight, scattered] = bill(&surface, &at);
                assert!(straight + scattered <= 1.0 + 1e-12, "{angle}: {straight} + {scattered}");
                if coating.as_ref().is_some_and(|c| c.opaque()) {
                    // A mirror under particles that absorb little loses what they absorb, and no more.
                    let lost = 1.0 - straight - scattered;
                    assert!((0.0..0.4).contains(&lost), "{angle}: {lost} lost");
                }
            }
        }
    }
}

/// Albedo and density against sums over the draws: every draw carries value / density, and their mean is what is scattered.
#[test]
fn what_is_drawn_carries_what_is_scattered() {
    let mirror: Arc<dyn Coating> = Arc::new(Mirror { reflectance: 0.9 });
    let bare = || Some(Arc::new(Bare) as Arc<dyn Coating>);
    let cases =
        [("wall", None, false), ("mirror", Some(mirror), false), ("glass", bare(), false), ("inside", bare(), true)];
    for (which, (name, coating, behind)) in cases.into_iter().enumerate() {
        let surface = surface(coating, dirty(), behind);
        for (step, angle) in [0.0, 40.0, 75.0].into_iter().enumerate() {
            let index = [1.0, 1.5].map(|n| Complex64::new(n, 0.0));
            let index = if behind { [index[1], index[0]] } else { index };
            let at = Incidence { index, ..Incidence::in_air(f64::to_radians(angle), LINE) };
            let shares = surface.shares(&at);
            if shares.scattered == 0.0 {
                assert!(behind, "{name} at {angle} deg scatters nothing");
                continue;
            }
            let mut rng = Rng::new(11, which as u64, step as u64);
            let draws = 100_000;
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..draws {
                let Some(wo) = surface.draw(&at, &shares, &mut rng) else { continue };
                assert!((wo.length() - 1.0).abs() < 1e-9);
                let weighed = surface.weigh(&at, &shares, wo);
                let weight = weighed.value / weighed.density;
                sum += weight;
                squares += weight * weight;
            }
            let mean = sum / f64::from(draws);
            let error = ((squares / f64::from(draws) - mean * mean) / f64::from(draws)).sqrt();
            assert!(
                (mean - shares.scattered).abs() < 4.0 * error + 2e-4 * shares.scattered,
                "{name} at {angle}: {mean} +- {error}, {}",
                shares.scattered
            );
        }
    }
}

/// On a mirror the forward lobe stands about the specular ray and is there twice, less what the first pass took.
#[test]
fn the_forward_lobe_folds_about_the_specular_ray() {
    let deposit = dirty();
    let mirror: Arc<dyn Coating> = Arc::new(Mirror { reflectance: 1.0 });
    let screen: Arc<dyn Coating> = Arc::new(Ideal { reflectance: 0.0, transmittance: 1.0 });
    let [mirror, screen] = [mirror, screen].map(|coating| surface(Some(coating), deposit.clone(), false));
    let at = Incidence::in_air(0.5, LINE);
    let towards = |theta: f64, z: f64| DVec3::new(-theta.sin(), 0.0, z * theta.cos());
    for offset in [0.01, 0.05, 0.2] {
        let folded = mirror.weigh(&at, &mirror.shares(&at), towards(0.5 + offset, 1.0)).value;
        let passed = screen.weigh(&at, &screen.shares(&at), towards(0.5 + offset, -1.0)).value;
        let kept = (-deposit.extinction(LINE) / 0.5f64.cos()).exp();
        // Beside it lies the little that both passes throw straight back.
        assert!((folded / (passed * (1.0 + kept)) - 1.0).abs() < 0.05, "{offset}: {folded} {passed}");
    }
}

/// The phase function's share that goes on, against a sum over directions.
#[test]
fn the_share_that_goes_on_is_an_integral() {
    let deposit = dirty();
    let wall = surface(None, deposit.clone(), false);
    for angle in [0.0, 60.0, 85.0] {
        let at = Incidence::in_air(f64::to_radians(angle), LINE);
        let shares = wall.shares(&at);
        let (rings, sectors) = (1500, 600);
        let mut sum = 0.0;
        for i in 0..rings {
            let theta = 0.5 * PI * (f64::from(i) + 0.5) / f64::from(rings);
            for j in 0..sectors {
                let phi = TAU * (f64::from(j) + 0.5) / f64::from(sectors);
                let wo = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
                sum += wall.weigh(&at, &shares, wo).value * theta.sin() * 0.5 * PI / f64::from(rings) * TAU
                    / f64::from(sectors);
            }
        }
        assert!((sum / shares.scattered - 1.0).abs() < 0.01, "{angle}: {sum} {}", shares.scattered);
    }
}

/// Watts that a mirror in the sky's middle sends back, of one that arrives, and what is booked as scattered.
fn reflected(scatter: &str) -> (f64, f64) {
    let folder = tempfile::tempdir().expect("a folder for the system");
    let path = folder.path().join("system.ron");
    let text = format!(
        "System(
            elements: {{ \"mirror\": (body: Mirror(form: Plane, diameter: \"20 mm\")) }},
            scatter: {{ \"dust\": {scatter} }},
            surfaces: [(on: Tag(\"*front\"), specular: Mirror(reflectance: 0.9), scatter: \"dust\")],
            sources: {{ \"beam\": (flux: \"1 W\", extent: Point, at: \"(0, 0, -10) mm\",
                angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\")) }},
            detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, -1)\"), quantity: Intensity) }},
            run: (rays: 64),
        )"
    );
    std::fs::write(&path, text).expect("written");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    let compiled = compile(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    let counts = transport::run::<1>(&compiled.scene, &compiled.settings, &AtomicBool::new(false), &|_| ());
    let results = summary::results(&compiled.scene, &compiled.settings, &counts, 0, compiled.inputs, Vec::new());
    assert!(results.trusted, "{:?}", results.warnings);
    let sky = &results.detectors["sky"];
    let scattered = sky.classes.iter().filter(|(class, _)| class.starts_with("scatter"));
    (sky.flux_w.mean, scattered.map(|(_, flux)| flux.mean).sum())
}

#[test]
fn a_surface_on_which_no_particle_lies_is_clean() {
    for nothing in ["Contamination(level: 1, bins: [(\"5 um\", 0)])", "Contamination(level: 1, smallest: \"2 um\")"] {
        let (all, scattered) = reflected(nothing);
        // Level 1 has eight particles of 2 um or more on a square metre: some 1e-9 of the light.
        assert!((all - 0.9).abs() < 1e-8 && scattered < 1e-8, "{nothing}: {all} {scattered}");
    }
    let (_, scattered) = reflected("Contamination(level: 1, bins: [(\"5 um\", 1e5)])");
    assert!(scattered > 1e-5, "{scattered}");
}
