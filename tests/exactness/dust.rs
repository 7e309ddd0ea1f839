//! A contaminated mirror through the whole chain: the light of every ring about the specular ray against the integral, to first
//! order in the particles, of what each of them does to the light that arrives and to the light that leaves.

use crate::lab::{system, traced};
use crate::support::Model;
use glam::DVec3;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};
use straylight::optics::mie::Sphere;

const LINE: f64 = 550e-9;
const DUST: Complex64 = Complex64::new(1.53, 0.001);
const REFLECTANCE: f64 = 0.85;

/// Angle of incidence, rad.
const THETA: f64 = 0.7;

/// Diameters (m) and numbers per m2: 4e-4 of the light meets one.
const BINS: [(f64, f64); 2] = [(1e-6, 4e7), (5e-6, 5e6)];

/// Rings of the sky about the specular ray.
const RINGS: usize = 36;

/// Area of all particles of a size per area of the mirror, and one of them.
fn particles() -> Vec<(f64, Sphere)> {
    let of = |(diameter, number): (f64, f64)| {
        (0.25 * PI * diameter * diameter * number, Sphere::new(diameter, DUST, 1.0, LINE))
    };
    BINS.into_iter().map(of).collect()
}

/// Scattered cross-section per solid angle and area of the mirror at the cosine of a scattering angle, 1/sr.
fn cross_section(particles: &[(f64, Sphere)], cosine: f64) -> f64 {
    particles.iter().map(|(area, sphere)| area * sphere.differential(cosine)).sum()
}

/// Watts in each ring, of 1 W that arrives: of a particle's light p, forward and back,
///
///     per sr    ((1 + R^2) p(from the incident ray) + 2 R p(from the specular ray)) / cos
///
/// Light thrown back at once, or reflected, thrown back and reflected again; thrown forward and then reflected, or reflected first.
fn rings(particles: &[(f64, Sphere)]) -> Vec<f64> {
    // By angle, as often as both integrals ask for it.
    let steps = 20_000;
    let table: Vec<f64> =
        (0..=steps).map(|i| cross_section(particles, (PI * f64::from(i) / f64::from(steps)).cos())).collect();
    let p = |cosine: f64| table[(cosine.clamp(-1.0, 1.0).acos() / PI * f64::from(steps)).round() as usize];
    let (sin, cos) = THETA.sin_cos();
    let (incident, specular) = (DVec3::new(sin, 0.0, cos), DVec3::new(sin, 0.0, -cos));
    let (x, y) = (DVec3::new(cos, 0.0, sin), DVec3::Y);
    let (fine, sectors) = (150, 720);
    let mut rings = vec![0.0; RINGS];
    for i in 0..RINGS * fine {
        let width = PI / (RINGS * fine) as f64;
        let angle = (i as f64 + 0.5) * width;
        for j in 0..sectors {
            let azimuth = TAU * (f64::from(j) + 0.5) / f64::from(sectors);
            let towards = angle.cos() * specular + angle.sin() * (azimuth.cos() * x + azimuth.sin() * y);
            if towards.z < 0.0 {
                let r = REFLECTANCE;
                let value = ((1.0 + r * r) * p(towards.dot(incident)) + 2.0 * r * p(angle.cos())) / cos;
                rings[i / fine] += value * angle.sin() * width * TAU / f64::from(sectors);
            }
        }
    }
    rings
}

#[test]
fn a_contaminated_mirror_scatters_on_both_passes_as_its_particles_do() {
    let particles = particles();
    let (sin, cos) = THETA.sin_cos();
    let bins: Vec<String> =
        BINS.iter().map(|(diameter, number)| format!("(\"{:?} um\", {:?})", 1e6 * diameter, 0.1 * number)).collect();
    let text = format!(
        "geometry: [],
        elements: {{ \"mirror\": (body: Mirror(form: Plane, diameter: \"1 m\")) }},
        scatter: {{ \"dust\": Contamination(level: 1, bins: [{}], n: {:?}, k: {:?}) }},
        surfaces: [(on: Tag(\"*front\"), specular: Mirror(reflectance: {REFLECTANCE:?}), scatter: \"dust\")],
        sources: {{ \"beam\": (flux: \"1 W\", extent: Point, at: \"({:?}, 0, {:?}) mm\",
            angular: Collimated(direction: \"({sin:?}, 0, {cos:?})\"), spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"sky\": (on: FarField(axis: \"({sin:?}, 0, {:?})\"), quantity: Intensity, pixels: (1, {RINGS})) }},
        run: (rays: 400000, paths: 0),",
        bins.join(", "),
        DUST.re,
        DUST.im,
        -10.0 * sin,
        -10.0 * cos,
        -cos
    );
    let results = traced(&system(&text, &Model::new().gltf()));
    let extinction: f64 = particles.iter().map(|(area, sphere)| area * sphere.extinction).sum();
    let scattering: f64 = particles.iter().map(|(area, sphere)| area * sphere.scattering).sum();
    assert!((1e-4..1e-3).contains(&extinction), "{extinction}");
    let specular = results.detectors["sky"].classes["signal"].mean;
    let kept = REFLECTANCE * (-2.0 * extinction / cos).exp();
    assert!((specular / kept - 1.0).abs() < 1e-9, "{specular}, both passes keep {kept}");
    // What one ray carries, where so few arrive that their error bar is itself a guess.
    let rare = 12.0 * scattering / cos / results.rays as f64;
    let map = results.maps.iter().find(|map| map.detector == "sky").expect("a map");
    let wanted = rings(&particles);
    // Both hemispheres of both passes: to the side of the mirror goes what its quadrature finds, less than all.
    let all: f64 = wanted.iter().sum();
    assert!(all < 2.0 * scattering / cos && all > scattering / cos, "{all} of {}", scattering / cos);
    for (ring, wanted) in wanted.into_iter().enumerate() {
        let light = if ring == 0 { specular } else { 0.0 };
        let (found, error) = (map.mean[ring] * map.extent[ring] - light, map.error[ring] * map.extent[ring]);
        println!("ring {ring:2}: {found:.4e} +- {error:.1e}, integral {wanted:.4e}: {:+.2}", (found - wanted) / error);
        // The phase function is linear between angles that resolve its rings to 0.5 %; the second order is 4e-4.
        assert!(
            (found - wanted).abs() <= 4.0 * error + 5e-3 * wanted + rare,
            "ring {ring}: {found} +- {error}, {wanted}"
        );
    }
}
