//! What one event costs: every scatter model as the transport loop asks a surface of it - shares, draw and weight - and Fresnel's
//! interface, beside one random number. Requirement: tables and ABg below four times Lambertian.

use criterion::{Criterion, criterion_group, criterion_main};
use num_complex::Complex64;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;
use straylight::bsdf::contamination::{Deposit, distribution};
use straylight::bsdf::reading::{Unmeasured, parse};
use straylight::bsdf::{
    Abg, Axis, Bsdf, Compensation, CosinePower, Distribution, Facets, Gaussian, Harvey, KCorrelation, Klems,
    Lambertian, Microfacet, OrenNayar, Polish, PsdTable, Side, Spectral, Tabulated, Weighed, klems_xml,
};
use straylight::coating::{Bare, Coating, Mirror};
use straylight::math::Rng;
use straylight::medium::{Constant, Loss};
use straylight::optics::Incidence;
use straylight::surface::{Order, Scattering, Surface};

const SPEOS: &str = include_str!("../systems/triplet/black-anodize-plausible.anisotropicbsdf");
const ZEMAX: &str = include_str!("../tests/data/bsdf/AnoBlackEC1onAlum.bsdf");
const FRED: &str = include_str!("../tests/data/bsdf/AnoBlackEC1onAlum.txt");
const KLEMS: &str = include_str!("../tests/data/bsdf/klems/ec60.xml");

fn table(text: &str) -> Box<dyn Bsdf> {
    let table = parse(text, Unmeasured::Zero).expect("a good table").remove(0);
    Box::new(Tabulated::new(table, 1.0).expect("below 100 %"))
}

fn sheet() -> Box<dyn Bsdf> {
    Box::new(Klems::new(klems_xml::parse(KLEMS, "Visible").expect("a good file").remove(0), 1.0))
}

fn spectral() -> Box<dyn Bsdf> {
    let white = Lambertian { reflectance: 1.0, transmittance: 0.0 };
    Box::new(Spectral::new(white, vec![500e-9, 600e-9], vec![0.1, 0.7]))
}

fn abg(g: f64, side: Side) -> Box<dyn Bsdf> {
    Box::new(Abg::new(0.0025, 0.001, g, side))
}

fn facets(distribution: Distribution, side: Side) -> Box<dyn Bsdf> {
    Box::new(Microfacet::new(distribution, 0.3, Facets::Interface, side))
}

/// Every model alone, and a sum of two.
fn models() -> Vec<(&'static str, Vec<Box<dyn Bsdf>>)> {
    let mirror = KCorrelation::new(1e-9, [0.0, 1e6], 20e-6, 2.5);
    let profile = PsdTable::new(&[(1e3, 1e-25), (5e4, 1e-26), (4e5, 1e-28), (2e6, 1e-31)]);
    let lambertian = || -> Box<dyn Bsdf> { Box::new(Lambertian { reflectance: 0.3, transmittance: 0.0 }) };
    vec![
        ("lambertian", vec![lambertian()]),
        ("lambertian by wavelength", vec![spectral()]),
        ("abg", vec![abg(1.8, Side::Reflect)]),
        ("abg, g 2", vec![abg(2.0, Side::Reflect)]),
        ("abg, transmitted", vec![abg(1.8, Side::Transmit)]),
        ("table, speos", vec![table(SPEOS)]),
        ("table, zemax", vec![table(ZEMAX)]),
        ("table, fred", vec![table(FRED)]),
        ("klems", vec![sheet()]),
        ("harvey", vec![Box::new(Harvey::new(0.1, 0.01, -1.5, Side::Reflect))]),
        ("gaussian", vec![Box::new(Gaussian::new(5.0, 0.1, Side::Reflect))]),
        ("cosine power", vec![Box::new(CosinePower::new(0.2, 30.0, Axis::Specular))]),
        ("oren-nayar", vec![Box::new(OrenNayar::new(0.8, 0.3))]),
        ("polish", vec![Box::new(Polish::new(mirror, Side::Reflect))]),
        ("polish, transmitted", vec![Box::new(Polish::new(mirror, Side::Transmit))]),
        ("polish, table", vec![Box::new(Polish::new(profile, Side::Reflect))]),
        ("ggx", vec![facets(Distribution::Ggx, Side::Reflect)]),
        ("ggx, transmitted", vec![facets(Distribution::Ggx, Side::Transmit)]),
        ("beckmann", vec![facets(Distribution::Beckmann, Side::Reflect)]),
        ("beckmann, transmitted", vec![facets(Distribution::Beckmann, Side::Transmit)]),
        ("ggx, what is lost", vec![Box::new(Compensation::new(Distribution::Ggx, 0.6, Facets::Perfect))]),
        ("abg + lambertian", vec![abg(1.8, Side::Reflect), lambertian()]),
    ]
}

/// Particles on a mirror.
fn dusty() -> Surface {
    let dust = Constant { n: 1.53, loss: Loss::Extinction(0.001) };
    let deposit = Deposit::new(&dust, &distribution(500.0, 0.926, [1e-6, 200e-6]), &[550e-9]);
    let mirror: Arc<dyn Coating> = Arc::new(Mirror { reflectance: 0.95 });
    Surface::new("dusty".into(), Some(mirror), Vec::new(), Order::ScatterFirst, Scattering::On)
        .under(Arc::new(deposit), false)
}

/// Incidences all over the hemisphere, into a second medium of index `n`.
fn incidences(n: Complex64) -> Vec<Incidence> {
    let mut rng = Rng::new(1, 0, 0);
    let angle = |u: f64| u.sqrt().asin();
    let at = |u: f64| Incidence { index: [Complex64::new(1.0, 0.0), n], ..Incidence::in_air(angle(u), 550e-9) };
    (0..1024).map(|_| at(rng.uniform())).collect()
}

/// Weight of one event.
fn weight(surface: &Surface, at: &Incidence, rng: &mut Rng) -> f64 {
    let shares = surface.shares(at);
    let weight = |wo| {
        let Weighed { value, density } = surface.weigh(at, &shares, wo);
        value / density
    };
    surface.draw(at, &shares, rng).map_or(0.0, weight)
}

fn events(criterion: &mut Criterion) {
    let glass = incidences(Complex64::new(1.5168, 0.0));
    let mut group = criterion.benchmark_group("models");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_millis(1200)).sample_size(30);
    let mut rng = Rng::new(2, 0, 0);
    group.bench_function("uniform number", |bench| bench.iter(|| black_box(rng.uniform())));
    let surface = |(name, lobes)| (name, Surface::new(String::new(), None, lobes, Order::ScatterFirst, Scattering::On));
    for (name, surface) in models().into_iter().map(surface).chain([("particles on a mirror", dusty())]) {
        let mut next = glass.iter().cycle();
        group.bench_function(name, |bench| {
            bench.iter(|| next.next().map(|at| black_box(weight(&surface, at, &mut rng))))
        });
    }
    for (name, n) in [("glass", Complex64::new(1.5168, 0.0)), ("metal", Complex64::new(1.2, 7.0))] {
        let incidences = incidences(n);
        let mut next = incidences.iter().cycle();
        group.bench_function(format!("fresnel, {name}"), |bench| {
            bench.iter(|| next.next().map(|at| black_box(Bare.split(at))))
        });
    }
    group.finish();
}

criterion_group!(benches, events);
criterion_main!(benches);
