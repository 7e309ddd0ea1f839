//! What one event costs: every scatter model's draw, value and density; Fresnel's interface; beside one random number.

use criterion::{Criterion, criterion_group, criterion_main};
use num_complex::Complex64;
use std::hint::black_box;
use straylight::bsdf::{
    Abg, Axis, Bsdf, CosinePower, Distribution, Facets, Harvey, KCorrelation, Lambertian, Microfacet, OrenNayar,
    Polish, Side, Tabulated, speos,
};
use straylight::coating::{Bare, Coating};
use straylight::math::Rng;
use straylight::optics::Incidence;

fn table() -> Tabulated {
    let text = include_str!("../systems/triplet/black-anodize-plausible.anisotropicbsdf");
    Tabulated::new(speos::parse(text).expect("a good table").remove(0), 1.0).expect("below 100 %")
}

/// Incidences all over the hemisphere, into a second medium of index `n`.
fn incidences(n: Complex64) -> Vec<Incidence> {
    let mut rng = Rng::new(1, 0, 0);
    let angle = |u: f64| u.sqrt().asin();
    let at = |u: f64| Incidence { index: [Complex64::new(1.0, 0.0), n], ..Incidence::in_air(angle(u), 550e-9) };
    (0..1024).map(|_| at(rng.uniform())).collect()
}

/// Weight of one draw: sample, eval and pdf.
fn weight(model: &dyn Bsdf, at: &Incidence, rng: &mut Rng) -> f64 {
    let value = |wo: glam::DVec3| model.eval(at, wo) * wo.z.abs() / model.pdf(at, wo);
    model.sample(at, rng).map_or(0.0, value)
}

fn models(criterion: &mut Criterion) {
    let mirror = KCorrelation::new(1e-9, [0.0, 1e6], 20e-6, 2.5);
    let facets = |side| Microfacet::new(Distribution::Ggx, 0.3, Facets::Interface, side);
    let models: [(&str, Box<dyn Bsdf>); 11] = [
        ("lambertian", Box::new(Lambertian { reflectance: 0.3, transmittance: 0.0 })),
        ("abg", Box::new(Abg::new(0.0025, 0.001, 1.8, Side::Reflect))),
        ("abg, g 2", Box::new(Abg::new(0.0025, 0.001, 2.0, Side::Reflect))),
        ("abg, transmitted", Box::new(Abg::new(0.0025, 0.001, 1.8, Side::Transmit))),
        ("table", Box::new(table())),
        ("harvey", Box::new(Harvey::new(0.1, 0.01, -1.5, Side::Reflect))),
        ("cosine power", Box::new(CosinePower::new(0.2, 30.0, Axis::Specular))),
        ("oren-nayar", Box::new(OrenNayar::new(0.8, 0.3))),
        ("polish", Box::new(Polish::new(mirror, Side::Reflect))),
        ("facets", Box::new(facets(Side::Reflect))),
        ("facets, transmitted", Box::new(facets(Side::Transmit))),
    ];
    let glass = incidences(Complex64::new(1.5168, 0.0));
    let mut group = criterion.benchmark_group("models");
    let mut rng = Rng::new(2, 0, 0);
    group.bench_function("uniform number", |bench| bench.iter(|| black_box(rng.uniform())));
    for (name, model) in &models {
        let mut next = glass.iter().cycle();
        group.bench_function(format!("{name}: sample, eval, pdf"), |bench| {
            bench.iter(|| next.next().map(|at| black_box(weight(&**model, at, &mut rng))))
        });
        group.bench_function(format!("{name}: albedo"), |bench| {
            bench.iter(|| next.next().map(|at| black_box(model.albedo(at))))
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

criterion_group!(benches, models);
criterion_main!(benches);
