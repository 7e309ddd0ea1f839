//! Every sampler draws what its density says, and carries the flux its model says.

use crate::reference::{case, close, number, values};
use glam::{DVec2, DVec3};
use num_complex::Complex64;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::{PI, TAU};
use straylight::bsdf::reading::Unmeasured;
use straylight::bsdf::{
    Abg, Axis, Bsdf, Compensation, CosinePower, Distribution, Facets, Gaussian, Harvey, KCorrelation, Lambertian,
    Microfacet, OrenNayar, Polish, PsdTable, Side, Spectral, Tabulated, speos, zemax,
};
use straylight::math::Rng;
use straylight::math::quadrature::GaussLegendre;
use straylight::optics::Incidence;

/// Every scatter model, narrow, wide, clipped, on both sides.
pub fn family() -> Vec<(&'static str, Box<dyn Bsdf>)> {
    vec![
        ("lambertian", Box::new(Lambertian { reflectance: 0.3, transmittance: 0.0 })),
        ("lambertian both ways", Box::new(Lambertian { reflectance: 0.2, transmittance: 0.5 })),
        ("lambertian by wavelength", Box::new(spectral())),
        ("abg g 1.8", Box::new(Abg::new(0.0025, 0.001, 1.8, Side::Reflect))),
        ("abg g 2 B 1e-9", Box::new(Abg::new(1e-3, 1e-9, 2.0, Side::Reflect))),
        ("abg g 1", Box::new(Abg::new(0.01, 0.02, 1.0, Side::Reflect))),
        ("abg g 3.2", Box::new(Abg::new(1e-5, 1e-5, 3.2, Side::Reflect))),
        ("abg flat", Box::new(Abg::new(0.1, 0.5, 0.0, Side::Reflect))),
        ("abg wide", Box::new(Abg::new(0.3, 5.0, 2.5, Side::Reflect))),
        ("abg transmitted", Box::new(Abg::new(0.001, 1e-4, 1.9, Side::Transmit))),
        ("harvey", Box::new(Harvey::new(0.1, 0.01, -1.5, Side::Reflect))),
        ("harvey l 1e-6", Box::new(Harvey::new(1e8, 1e-6, -2.0, Side::Reflect))),
        ("harvey transmitted", Box::new(Harvey::new(0.1, 0.03, -2.6, Side::Transmit))),
        ("gaussian", Box::new(Gaussian::new(5.0, 0.1, Side::Reflect))),
        ("gaussian transmitted", Box::new(Gaussian::new(0.5, 0.3, Side::Transmit))),
        ("cosine power", Box::new(CosinePower::new(0.4, 12.5, Axis::Specular))),
        ("cosine power, retro", Box::new(CosinePower::new(0.4, 7.0, Axis::Source))),
        ("oren-nayar", Box::new(OrenNayar::new(0.8, 0.5))),
        ("polish", Box::new(Polish::new(ground(), Side::Reflect))),
        ("polish transmitted", Box::new(Polish::new(ground(), Side::Transmit))),
        ("polish, table", Box::new(Polish::new(profile(), Side::Reflect))),
        ("ggx", Box::new(Microfacet::new(Distribution::Ggx, 0.1, Facets::Interface, Side::Reflect))),
        ("ggx, mirror", Box::new(Microfacet::new(Distribution::Ggx, 0.5, Facets::Perfect, Side::Reflect))),
        ("ggx transmitted", Box::new(Microfacet::new(Distribution::Ggx, 0.3, Facets::Interface, Side::Transmit))),
        ("beckmann", Box::new(Microfacet::new(Distribution::Beckmann, 0.3, Facets::Interface, Side::Reflect))),
        (
            "beckmann transmitted",
            Box::new(Microfacet::new(Distribution::Beckmann, 0.15, Facets::Interface, Side::Transmit)),
        ),
        ("ggx, what is lost", Box::new(Compensation::new(Distribution::Ggx, 0.6, Facets::Perfect))),
        ("black anodize", Box::new(anodize())),
        ("black anodize, zemax", Box::new(zemax())),
    ]
}

/// Between the entries of its spectrum at the wavelength of these laws.
fn spectral() -> Spectral<Lambertian> {
    let white = Lambertian { reflectance: 1.0, transmittance: 0.0 };
    Spectral::new(white, vec![500e-9, 600e-9], vec![0.1, 0.7])
}

/// A polish with a shoulder at 20 um.
fn ground() -> KCorrelation {
    KCorrelation::new(2e-9, [0.0, 1e6], 20e-6, 2.4)
}

/// A measured polish of three slopes.
fn profile() -> PsdTable {
    PsdTable::new(&[(1e3, 1e-25), (5e4, 1e-26), (4e5, 1e-28), (2e6, 1e-31)])
}

/// The plausible wall of the triplet.
pub fn anodize() -> Tabulated {
    let text = include_str!("../../systems/triplet/black-anodize-plausible.anisotropicbsdf");
    Tabulated::new(speos::parse(text).expect("a good table").remove(0), 1.0).expect("below 100 %")
}

/// A measured anodize whose table counts angles from the specular ray.
pub fn zemax() -> Tabulated {
    let text = include_str!("../data/bsdf/AnoBlackEC1onAlum.bsdf");
    Tabulated::new(zemax::parse(text, Unmeasured::Zero).expect("a good table").remove(0), 1.0).expect("below 100 %")
}

/// Incidences in air and in glass, from normal to grazing; for transmission also beyond the critical angle.
pub fn incidences(model: &dyn Bsdf) -> Vec<Incidence> {
    let (air, glass) = (Complex64::new(1.0, 0.0), Complex64::new(1.5168, 0.0));
    let pairs = if model.transmits() { [[air, glass], [glass, air]] } else { [[air, air], [glass, air]] };
    let angles = [0.0f64, 33.0, 66.5, 86.0];
    let all = pairs
        .iter()
        .flat_map(|&index| angles.map(|a| Incidence { index, ..Incidence::in_air(a.to_radians(), 550e-9) }));
    lit(model, all)
}

/// Those at which the model scatters anything: a polish passes nothing beyond the critical angle.
fn lit(model: &dyn Bsdf, all: impl Iterator<Item = Incidence>) -> Vec<Incidence> {
    all.filter(|at| model.albedo(at) > 0.0).collect()
}

/// True if the bins and their quadrature resolve the model: not what facets pass far beyond the critical angle, a hundredth of the light
/// in shapes with edges across the bins.
pub fn resolved(name: &str, at: &Incidence) -> bool {
    let facets = name.starts_with("ggx t") || name.starts_with("beckmann t");
    !(facets && at.index[0].re > at.index[1].re && at.wi.z < 0.45)
}

/// What the tables of a model's albedo may be off by, relative.
pub fn slack(name: &str) -> f64 {
    match name {
        "polish, table" => 5e-4,
        _ if name.starts_with("polish") => 2e-5,
        _ if name.starts_with("abg") => 1e-7,
        _ if name.starts_with("black") || name.starts_with("lambertian") => 1e-12,
        _ if name.starts_with("oren") => 1e-10,
        _ if name.starts_with("ggx") || name.starts_with("beckmann") => 1e-3,
        _ => 5e-6,
    }
}

/// Bins: both sides, rings of ln x about the specular direction, sectors about it.
const RINGS: usize = 8;
const SECTORS: usize = 8;
const NEAREST: f64 = 1e-5;

/// One side of the surface in the plane q = n_s beta, about q0 = -n_i wi.
struct Plane {
    side: f64,
    n: f64,
    specular: DVec2,
}

fn planes(at: &Incidence) -> [Plane; 2] {
    let specular = at.wi.truncate() * -at.index[0].re;
    [(1.0, at.index[0].re), (-1.0, at.index[1].re)].map(|(side, n)| Plane { side, n, specular })
}

impl Plane {
    fn reach(&self) -> f64 {
        self.n + self.specular.length()
    }

    /// Edges in ln x, the innermost from x = 0.
    fn edge(&self, ring: usize) -> f64 {
        let x = NEAREST * (self.reach() / NEAREST).powf(ring as f64 / RINGS as f64);
        if ring == 0 { 1e-12 } else { x }
    }

    fn bin(&self, wo: DVec3) -> usize {
        let d = wo.truncate() * self.n - self.specular;
        let x = d.length();
        let ring = (1..RINGS).take_while(|&k| self.edge(k) <= x).count();
        let turn = (d.y.atan2(d.x) / TAU).rem_euclid(1.0);
        ring * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
    }

    /// Part of the ray from q0 at azimuth `psi` that lies inside the disc, as [from, to] in x.
    fn inside(&self, psi: f64) -> Option<[f64; 2]> {
        let along = self.specular.dot(DVec2::new(psi.cos(), psi.sin()));
        let rho2 = self.specular.length_squared();
        let root = along * along - rho2 + self.n * self.n;
        let to = -along + root.max(0.0).sqrt();
        (root > 0.0 && to > 0.0).then(|| [(-along - root.sqrt()).max(0.0), to])
    }

    /// Integral of g dw over one bin, g per sr: dw = d^2 q / (n^2 |cos|).
    fn integral(&self, ring: usize, sector: usize, fine: &Rules, g: &dyn Fn(DVec3) -> f64) -> f64 {
        let width = TAU / SECTORS as f64;
        let along = |psi: f64| -> f64 {
            let Some([near, far]) = self.inside(psi) else { return 0.0 };
            let (from, to) = (self.edge(ring).max(near), self.edge(ring + 1).min(far));
            if from >= to { 0.0 } else { self.ray(psi, from, to, far, fine, g) }
        };
        let start = width * sector as f64;
        let panels = 4;
        let panel = |k: usize| start + width * k as f64 / panels as f64;
        (0..panels).map(|k| fine.azimuth.integrate(panel(k), panel(k + 1), along)).sum()
    }

    /// Along one azimuth, x from `from` to `to`. 1/|cos| is a square root singularity at the horizon x = `far`: v = sqrt(far - x)
    /// removes it; ln x resolves the lobe elsewhere.
    fn ray(&self, psi: f64, from: f64, to: f64, far: f64, fine: &Rules, g: &dyn Fn(DVec3) -> f64) -> f64 {
        let at = |x: f64| -> f64 {
            let q = self.specular + DVec2::new(psi.cos(), psi.sin()) * x;
            let z = ((self.n - q.length()) * (self.n + q.length())).max(1e-300).sqrt() / self.n;
            x * g((q / self.n).extend(self.side * z)) / (self.n * self.n * z)
        };
        let middle = (0.5 * far).clamp(from, to);
        let panels = 4;
        let step = (middle / from).ln() / panels as f64;
        let low: f64 = (0..panels)
            .map(|k| {
                let u = from.ln() + step * k as f64;
                fine.radius.integrate(u, u + step, |u| u.exp() * at(u.exp()))
            })
            .sum();
        let (v0, v1) = ((far - to).max(0.0).sqrt(), (far - middle).sqrt());
        let high: f64 = (0..panels)
            .map(|k| {
                let v = |k: usize| v0 + (v1 - v0) * k as f64 / panels as f64;
                fine.radius.integrate(v(k), v(k + 1), |v| 2.0 * v * at(far - v * v))
            })
            .sum();
        low + high
    }
}

struct Rules {
    azimuth: GaussLegendre,
    radius: GaussLegendre,
}

impl Rules {
    fn new(azimuth: usize, radius: usize) -> Rules {
        Rules { azimuth: GaussLegendre::new(azimuth), radius: GaussLegendre::new(radius) }
    }
}

/// Integral of `g` dw over every bin, g per sr.
fn over_bins(at: &Incidence, fine: &Rules, g: &dyn Fn(DVec3) -> f64) -> Vec<f64> {
    let mut bins = Vec::new();
    for plane in planes(at) {
        for ring in 0..RINGS {
            bins.extend((0..SECTORS).map(|sector| plane.integral(ring, sector, fine, g)));
        }
    }
    bins
}

/// [`over_bins`] of a table: g / cos(theta) is bilinear in (sin^2 theta, phi) on cells whose edges are among those of the small cells
/// here, each of which takes its value at the middle. The sum over all bins is exact; a bin is as good as its outline in small cells.
pub fn over_points(at: &Incidence, g: &dyn Fn(DVec3) -> f64) -> Vec<f64> {
    let plane = &planes(at)[0];
    let mut bins = vec![0.0; 2 * RINGS * SECTORS];
    small_cells([1800, 1440], g, |wo, flux| bins[plane.bin(wo)] += flux);
    bins
}

/// Hands every small cell's middle and the integral of `g` dw over it to `sum`; rings even in theta, sectors in phi.
pub fn small_cells([rings, sectors]: [i32; 2], g: &dyn Fn(DVec3) -> f64, mut sum: impl FnMut(DVec3, f64)) {
    let edge = |k: i32| (std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(rings)).sin().powi(2);
    for ring in 0..rings {
        let (from, to) = (edge(ring), edge(ring + 1));
        let (square, area) = (0.5 * (from + to), 0.5 * (to - from) * TAU / f64::from(sectors));
        let (radius, z) = (square.sqrt(), (1.0 - square).sqrt());
        for sector in 0..sectors {
            let (sin, cos) = (TAU * (f64::from(sector) + 0.5) / f64::from(sectors)).sin_cos();
            let wo = DVec3::new(radius * cos, radius * sin, z);
            sum(wo, g(wo) / z * area);
        }
    }
}

/// Integral of `g` dw of a table, exact.
pub fn over_cells(g: impl Fn(DVec3) -> f64) -> f64 {
    let mut total = 0.0;
    small_cells([180, 288], &g, |_, part| total += part);
    total
}

/// Integral of `g` dw over the sphere, g per sr.
pub fn integral(at: &Incidence, g: impl Fn(DVec3) -> f64) -> f64 {
    over_bins(at, &Rules::new(12, 12), &g).iter().sum()
}

/// p-value of one seed's histogram against `expected` (probabilities; the rest is "no direction").
fn p_value(model: &dyn Bsdf, at: &Incidence, expected: &[f64], seed: u64) -> f64 {
    let planes = planes(at);
    let bin = |wo: DVec3| if wo.z > 0.0 { planes[0].bin(wo) } else { RINGS * SECTORS + planes[1].bin(wo) };
    let mut rng = Rng::new(seed, 0, 0);
    chi_squared(20_000, expected, || model.sample(at, &mut rng).map(bin))
}

/// p-value of the bins that `draw` gives against their probabilities.
pub fn chi_squared(draws: u32, expected: &[f64], mut draw: impl FnMut() -> Option<usize>) -> f64 {
    let mut count = vec![0u32; expected.len()];
    let mut none = 0u32;
    for _ in 0..draws {
        match draw() {
            Some(bin) => count[bin] += 1,
            None => none += 1,
        }
    }
    // Bins expecting fewer than ten draws are pooled with the draws that gave no direction.
    let (mut chi, mut bins) = (0.0, 0);
    let (mut pool, mut pooled) = (1.0 - expected.iter().sum::<f64>(), f64::from(none));
    for (&p, &c) in expected.iter().zip(&count) {
        let mean = p * f64::from(draws);
        if mean < 10.0 {
            pool += p;
            pooled += f64::from(c);
        } else {
            chi += (f64::from(c) - mean).powi(2) / mean;
            bins += 1;
        }
    }
    let mean = pool * f64::from(draws);
    if mean >= 10.0 {
        chi += (pooled - mean).powi(2) / mean;
        bins += 1;
    } else {
        // `expected` is integrated to 1e-3 of all draws.
        assert!(pooled < mean.max(0.0) + 1e-3 * f64::from(draws) + 20.0, "{pooled} draws where {mean} were expected");
    }
    1.0 - ChiSquared::new(f64::from(bins - 1)).expect("several bins").cdf(chi)
}

/// Kolmogorov-Smirnov distance of p-values from the uniform law.
fn distance(p: &mut [f64]) -> f64 {
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let step = |(k, p): (usize, &f64)| (p - k as f64 / n).max((k + 1) as f64 / n - p);
    p.iter().enumerate().map(step).fold(0.0, f64::max)
}

#[test]
fn every_sampler_draws_its_density() {
    for (name, model) in family() {
        for (k, at) in incidences(&*model).iter().enumerate().filter(|(_, at)| resolved(name, at)) {
            let expected = if name.contains("anodize") {
                over_points(at, &|wo| model.pdf(at, wo))
            } else if slack(name) == 1e-3 {
                over_bins(at, &Rules::new(20, 16), &|wo| model.pdf(at, wo))
            } else {
                over_bins(at, &Rules::new(10, 12), &|wo| model.pdf(at, wo))
            };
            let mut p: Vec<f64> = (0..20).map(|seed| p_value(&*model, at, &expected, 100 + seed)).collect();
            // Kolmogorov, n = 20, p > 1e-3: D < 0.422.
            let d = distance(&mut p);
            assert!(d < 0.422 && p[0] > 1e-5, "{name}, incidence {k}: D {d}, {p:?}");
        }
    }
}

/// 0, 30, 60 and 85 deg, in and out of the xz plane; 1e6 draws each, all p-values above alpha = 0.01 by Sidak.
#[test]
#[ignore = "a minute of draws"]
fn every_sampler_draws_its_density_to_a_million() {
    let mut all = Vec::new();
    for (name, model) in family().into_iter().filter(|(name, _)| !name.contains("anodize")) {
        let angles = [(0.0f64, 0.0f64), (30.0, 0.0), (60.0, 0.0), (85.0, 0.0), (60.0, 40.0)];
        let beyond = if model.transmits() { 1.5168 } else { 1.0 };
        let at = |(theta, turn): (f64, f64)| {
            let mut at = Incidence::in_air(theta.to_radians(), 550e-9);
            at.wi = DVec3::new(at.wi.x * turn.to_radians().cos(), at.wi.x * turn.to_radians().sin(), at.wi.z);
            Incidence { index: [Complex64::ONE, Complex64::new(beyond, 0.0)], ..at }
        };
        for at in lit(&*model, angles.into_iter().map(at)) {
            let expected = over_bins(&at, &Rules::new(40, 24), &|wo| model.pdf(&at, wo));
            let planes = planes(&at);
            let bin = |wo: DVec3| if wo.z > 0.0 { planes[0].bin(wo) } else { RINGS * SECTORS + planes[1].bin(wo) };
            let mut rng = Rng::new(77, all.len() as u64, 0);
            let p = chi_squared(1_000_000, &expected, || model.sample(&at, &mut rng).map(bin));
            all.push((p, name, at.wi));
        }
    }
    let alpha = 1.0 - 0.99f64.powf(1.0 / all.len() as f64);
    let failed: Vec<_> = all.iter().filter(|(p, ..)| *p < alpha).collect();
    assert!(failed.is_empty(), "{failed:?} of {} below {alpha:e}", all.len());
}

#[test]
fn the_mean_weight_of_a_sampler_is_the_albedo() {
    for (name, model) in family() {
        for at in incidences(&*model) {
            let mut rng = Rng::new(3, 1, 4);
            let (n, mut sum, mut squares) = (50_000, 0.0, 0.0);
            for _ in 0..n {
                let weight = |wo: DVec3| model.eval(&at, wo) * wo.z.abs() / model.pdf(&at, wo);
                let w = model.sample(&at, &mut rng).map_or(0.0, weight);
                sum += w;
                squares += w * w;
            }
            let mean = sum / f64::from(n);
            let sigma = ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
            let wanted = model.albedo(&at);
            // What is scattered once in 1e9 is not drawn at all. Where all weights are the same, sigma is 0 and what is left is rounding, or the interpolation of the albedo.
            assert!(
                (mean - wanted).abs() < 4.0 * sigma + slack(name) * wanted + 1e-9,
                "{name}: {mean} +- {sigma}, {wanted}"
            );
        }
    }
}

#[test]
fn a_table_draws_its_density_at_grazing_incidence() {
    let model = anodize();
    // Bins of 1.5 by 7.5 deg: their edges lie within the table's cells.
    let bin = |wo: DVec3| {
        let turn = (wo.y.atan2(wo.x) / TAU).rem_euclid(1.0);
        let ring = (wo.truncate().length().atan2(wo.z).to_degrees() / 1.5) as usize;
        ring.min(59) * 48 + ((turn * 48.0) as usize).min(47)
    };
    for (k, theta) in [80.0f64, 84.3, 87.75, 89.0].into_iter().enumerate() {
        let at = Incidence::in_air(theta.to_radians(), 550e-9);
        let mut expected = vec![0.0; 60 * 48];
        small_cells([180, 288], &|wo| model.pdf(&at, wo), |wo, p| expected[bin(wo)] += p);
        let mut rng = Rng::new(8, k as u64, 0);
        let p = chi_squared(1_000_000, &expected, || model.sample(&at, &mut rng).map(bin));
        assert!(p > 1e-4 && p < 1.0 - 1e-4, "{theta} deg: {p}");
    }
}

#[test]
fn drawn_directions_are_unit_and_have_a_density() {
    for (name, model) in family() {
        for at in incidences(&*model) {
            let mut rng = Rng::new(9, 2, 6);
            for _ in 0..2000 {
                let Some(wo) = model.sample(&at, &mut rng) else { continue };
                assert!((wo.length() - 1.0).abs() < 1e-12, "{name}: {wo}");
                assert!(model.pdf(&at, wo) > 0.0 && model.pdf(&at, wo).is_finite(), "{name}: {wo}");
            }
        }
    }
}

/// Flux-weighted probabilities of SCA-03: rings of equal area in |beta|, sectors about the direction of beta_0.
#[test]
fn sca_03_abg_histogram() {
    let reference = &values(&case("SCA-03"))[0];
    let lobe = Abg::new(0.01, 0.02, 1.5, Side::Reflect);
    let at = Incidence::in_air(30f64.to_radians(), 550e-9);
    close(lobe.albedo(&at), number(reference, "TIS"), 1e-8, "TIS");
    let wanted: Vec<f64> = reference["P_normalised"]
        .as_array()
        .expect("rings")
        .iter()
        .flat_map(|r| r.as_array().expect("sectors").iter().map(|p| p.as_f64().expect("a number")))
        .collect();
    let mut p = Vec::new();
    for seed in 0..20 {
        let (mut rng, mut count, mut kept) = (Rng::new(seed, 0, 0), [0u32; 64], 0.0);
        for _ in 0..100_000 {
            // Weights are constant, so counts are fluxes.
            let Some(wo) = lobe.sample(&at, &mut rng) else { continue };
            kept += 1.0;
            let ring = ((wo.x * wo.x + wo.y * wo.y) * 8.0) as usize;
            let turn = ((-wo.y).atan2(-wo.x) / TAU).rem_euclid(1.0);
            count[ring.min(7) * 8 + ((turn * 8.0) as usize).min(7)] += 1;
        }
        let chi: f64 = wanted.iter().zip(count).map(|(w, c)| (f64::from(c) - w * kept).powi(2) / (w * kept)).sum();
        p.push(1.0 - ChiSquared::new(63.0).expect("63").cdf(chi));
    }
    let d = distance(&mut p);
    assert!(d < 0.422 && p[0] > 1e-4, "D {d}, {p:?}");
}

#[test]
fn str_06_flux_within_cones_of_thousandths_of_a_degree() {
    for id in ["STR-06", "STR-06x"] {
        let case = case(id);
        let setup = |name: &str| number(&case["setup"], name);
        let lobe = Abg::new(setup("A"), setup("B"), setup("g"), Side::Reflect);
        let at = Incidence::in_air(0.0, 550e-9);
        let (n, mut rng) = (1_000_000, Rng::new(6, 0, 0));
        let total = PI * setup("A") * (1.0 / setup("B")).ln_1p();
        let sines: Vec<f64> =
            (0..n).filter_map(|_| lobe.sample(&at, &mut rng)).map(|w| w.truncate().length()).collect();
        for v in values(&case) {
            let edge = number(&v, "t_deg").to_radians().sin();
            let part = sines.iter().filter(|s| **s <= edge).count() as f64 / f64::from(n);
            let p = number(&v, "flux") / total;
            close(part, p, 4.0 * (p * (1.0 - p) / f64::from(n)).sqrt() + 1e-12, id);
        }
    }
}
