//! Every scatter model, narrow, wide, clipped, on both sides, and the incidences at which the laws are tried.

use crate::measured;
use crate::polar::Pole;
use glam::{DVec2, DVec3};
use num_complex::Complex64;
use std::sync::{Arc, OnceLock};
use straylight::bsdf::contamination::{Deposit, distribution};
use straylight::bsdf::{
    Abg, Axis, Bsdf, Compensation, CosinePower, Distribution, Facets, Gaussian, Harvey, KCorrelation, Lambertian,
    Microfacet, OrenNayar, Polish, PsdTable, Side, Spectral, Weighed,
};
use straylight::coating::{Bare, Coating, Mirror};
use straylight::math::Rng;
use straylight::medium::{Constant, Loss};
use straylight::optics::Incidence;
use straylight::surface::{Order, Scattering, Surface};

/// A model and the coordinates of its lobe.
pub struct Member {
    pub name: &'static str,
    pub model: Box<dyn Bsdf>,
    /// What its lobe is about.
    pub pole: Pole,
    /// What is known of its albedo, relative.
    pub slack: f64,
    /// What a quadrature that does not know its kinks is off by, relative, beyond 1e-6.
    pub kinks: f64,
    /// Indices of the media from which and into which light goes.
    pub media: Vec<[f64; 2]>,
}

const AIR: f64 = 1.0;
const GLASS: f64 = 1.5168;

/// Into glass and out of it.
pub fn both_ways() -> Vec<[f64; 2]> {
    vec![[AIR, GLASS], [GLASS, AIR]]
}

fn member(name: &'static str, pole: Pole, slack: f64, model: impl Bsdf + 'static) -> Member {
    Member { name, model: Box::new(model), pole, slack, kinks: 0.0, media: both_ways() }
}

fn with_kinks(kinks: f64, member: Member) -> Member {
    Member { kinks, ..member }
}

/// Every scatter model, built once.
pub fn family() -> &'static [Member] {
    static FAMILY: OnceLock<Vec<Member>> = OnceLock::new();
    let all =
        || [matt(), radial(), polished(), facets(), measured::tables(), mixtures()].into_iter().flatten().collect();
    FAMILY.get_or_init(all)
}

/// Wide lobes in closed form.
fn matt() -> Vec<Member> {
    let lost = Compensation::new(Distribution::Ggx, 0.6, Facets::Perfect);
    let lost = member("ggx, what is lost", Pole::Normal, 1e-6, lost);
    vec![
        member("lambertian", Pole::Normal, 1e-12, Lambertian { reflectance: 0.3, transmittance: 0.0 }),
        member("lambertian both ways", Pole::Normal, 1e-12, Lambertian { reflectance: 0.2, transmittance: 0.5 }),
        member("lambertian by wavelength", Pole::Normal, 1e-12, spectral()),
        with_kinks(1e-5, member("oren-nayar", Pole::Normal, 1e-10, OrenNayar::new(0.8, 0.5))),
        // Its density has steps.
        with_kinks(2e-4, lost),
    ]
}

/// Lobes of one distance.
fn radial() -> Vec<Member> {
    let abg = |name, a, b, g, side| member(name, Pole::Specular, 1e-7, Abg::new(a, b, g, side));
    vec![
        abg("abg g 1.8", 0.0025, 0.001, 1.8, Side::Reflect),
        abg("abg g 2 B 1e-9", 1e-3, 1e-9, 2.0, Side::Reflect),
        abg("abg g 1", 0.01, 0.02, 1.0, Side::Reflect),
        abg("abg g 3.2", 1e-5, 1e-5, 3.2, Side::Reflect),
        abg("abg flat", 0.1, 0.5, 0.0, Side::Reflect),
        abg("abg wide", 0.3, 5.0, 2.5, Side::Reflect),
        abg("abg transmitted", 0.001, 1e-4, 1.9, Side::Transmit),
        member("harvey", Pole::Specular, 5e-6, Harvey::new(0.1, 0.01, -1.5, Side::Reflect)),
        member("harvey l 1e-6", Pole::Specular, 5e-6, Harvey::new(1e8, 1e-6, -2.0, Side::Reflect)),
        member("harvey transmitted", Pole::Specular, 5e-6, Harvey::new(0.1, 0.03, -2.6, Side::Transmit)),
        member("gaussian", Pole::Specular, 5e-6, Gaussian::new(5.0, 0.1, Side::Reflect)),
        member("gaussian transmitted", Pole::Specular, 5e-6, Gaussian::new(0.5, 0.3, Side::Transmit)),
        member("cosine power", Pole::Normal, 5e-6, CosinePower::new(0.4, 12.5, Axis::Specular)),
        member("cosine power, retro", Pole::Normal, 5e-6, CosinePower::new(0.4, 7.0, Axis::Source)),
    ]
}

fn polished() -> Vec<Member> {
    let slope = || PsdTable::new(&[(1e3, 1e-25), (5e4, 1e-26), (4e5, 1e-28), (2e6, 1e-31)]);
    let shoulder = KCorrelation::new(2e-9, [0.0, 1e6], 20e-6, 2.4);
    vec![
        member("polish", Pole::Specular, 2e-5, Polish::new(shoulder, Side::Reflect)),
        member("polish transmitted", Pole::Specular, 2e-5, Polish::new(shoulder, Side::Transmit)),
        with_kinks(1.5e-3, member("polish, table", Pole::Specular, 5e-4, Polish::new(slope(), Side::Reflect))),
        with_kinks(
            1.5e-3,
            member("polish, table, transmitted", Pole::Specular, 5e-4, Polish::new(slope(), Side::Transmit)),
        ),
    ]
}

fn facets() -> Vec<Member> {
    let facets = |name, distribution, alpha, facets, side| {
        with_kinks(1.5e-3, member(name, Pole::Specular, 1e-3, Microfacet::new(distribution, alpha, facets, side)))
    };
    use Distribution::{Beckmann, Ggx};
    vec![
        facets("ggx", Ggx, 0.1, Facets::Interface, Side::Reflect),
        facets("ggx, mirror", Ggx, 0.5, Facets::Perfect, Side::Reflect),
        facets("ggx transmitted", Ggx, 0.3, Facets::Interface, Side::Transmit),
        facets("beckmann", Beckmann, 0.3, Facets::Interface, Side::Reflect),
        facets("beckmann transmitted", Beckmann, 0.15, Facets::Interface, Side::Transmit),
    ]
}

/// Several lobes on one surface, and the particles on others.
fn mixtures() -> Vec<Member> {
    let matt = || -> Box<dyn Bsdf> { Box::new(Lambertian { reflectance: 0.1, transmittance: 0.0 }) };
    let abg = || -> Box<dyn Bsdf> { Box::new(Abg::new(0.0025, 0.001, 1.8, Side::Reflect)) };
    let through = || -> Box<dyn Bsdf> { Box::new(Gaussian::new(1.0, 0.1, Side::Transmit)) };
    let facets: Box<dyn Bsdf> = Box::new(Microfacet::new(Distribution::Ggx, 0.2, Facets::Perfect, Side::Reflect));
    let dirt = dirt();
    let mirror: Arc<dyn Coating> = Arc::new(Mirror { reflectance: 0.9 });
    let bare: Arc<dyn Coating> = Arc::new(Bare);
    let plain = |specular, lobes| Surface::new("sum".into(), specular, lobes, Order::ScatterFirst, Scattering::On);
    let scaled = Surface::new("sum".into(), Some(bare.clone()), vec![facets, through()], Order::Scaled, Scattering::On);
    let mixture = |name, slack, surface| member(name, Pole::Specular, slack, Mixture(surface));
    // The forward lobes of the particles have a hundred rings.
    let rings = |name, surface| with_kinks(1e-2, mixture(name, 2e-4, surface));
    let [glass, inside] = [plain(Some(bare.clone()), vec![]), plain(Some(bare), vec![])];
    let in_air = |member| Member { media: vec![[AIR, GLASS]], ..member };
    vec![
        mixture("abg + lambertian + gaussian", 1e-6, plain(None, vec![abg(), matt(), through()])),
        with_kinks(1e-3, mixture("facets + gaussian, scaled", 1e-3, scaled)),
        in_air(rings("particles on a mirror", plain(Some(mirror), vec![]).under(dirt.clone(), false))),
        in_air(rings("particles on a wall", plain(None, vec![matt()]).under(dirt.clone(), false))),
        in_air(Member { pole: Pole::Bent, ..rings("particles on glass", glass.under(dirt.clone(), false)) }),
        Member { media: vec![[GLASS, AIR]], ..rings("particles behind glass", inside.under(dirt, true)) },
    ]
}

/// So much dirt that a good part of the light meets a particle.
fn dirt() -> Arc<Deposit> {
    let dust = Constant { n: 1.53, loss: Loss::Extinction(0.001) };
    Arc::new(Deposit::new(&dust, &distribution(800.0, 0.926, [1e-6, 200e-6]), &[550e-9]))
}

/// Between the entries of its spectrum at the wavelength of these laws.
fn spectral() -> Spectral<Lambertian> {
    let white = Lambertian { reflectance: 1.0, transmittance: 0.0 };
    Spectral::new(white, vec![500e-9, 600e-9], vec![0.1, 0.7])
}

/// All lobes of a surface as the transport loop uses them: one density, one value.
#[derive(Debug)]
struct Mixture(Surface);

impl Bsdf for Mixture {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.weigh(at, wo).value
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.weigh(at, wo).density
    }

    fn weigh(&self, at: &Incidence, wo: DVec3) -> Weighed {
        let Weighed { value, density } = self.0.weigh(at, &self.0.shares(at), wo);
        Weighed { value: value / wo.z.abs(), density }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        self.0.draw(at, &self.0.shares(at), rng)
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.0.shares(at).scattered
    }

    fn transmits(&self) -> bool {
        self.0.lobes.iter().any(|lobe| lobe.transmits())
    }
}

impl Member {
    /// 0, 30, 60 and 85 deg and one out of the xz plane, between its media; for models that depend on the lay at another of its azimuths
    /// too.
    pub fn incidences(&self) -> Vec<Incidence> {
        let lays: &[f64] = if self.model.anisotropic() { &[0.0, -33.0] } else { &[0.0] };
        let angles = [(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (85.0, 0.0), (60.0, 40.0)];
        let mut all = Vec::new();
        for media in &self.media {
            let index = media.map(|n| Complex64::new(n, 0.0));
            for &lay in lays {
                all.extend(angles.map(|(theta, azimuth)| arriving(theta, azimuth, lay, index)));
            }
        }
        // Where nothing is scattered, as by polish beyond the critical angle, there is nothing to try.
        all.retain(|at| self.model.albedo(at) > 0.0);
        all
    }
}

/// Light from polar angle and azimuth (deg) on a surface whose lay is at another azimuth.
fn arriving(theta: f64, azimuth: f64, lay: f64, index: [Complex64; 2]) -> Incidence {
    let along = DVec2::from_angle(f64::to_radians(azimuth)) * f64::to_radians(theta).sin();
    let wi = along.extend(f64::to_radians(theta).cos());
    Incidence { wi, lay: DVec2::from_angle(lay.to_radians()), index, ..Incidence::in_air(0.0, 550e-9) }
}
