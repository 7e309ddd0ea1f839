//! Smooth scatter: the lobes of a surface. One model, one file.
//!
//! Local frame z up on the side the light comes from; `wi` and `wo` are unit and point away from the surface;
//! `wo.z > 0` is reflected, `wo.z < 0` transmitted. A BSDF f is dL_s / dE_i, 1/sr; scattered flux into dw is
//! f |cos theta_s| dw times the incident flux.

pub mod abg;
pub mod anisotropic;
pub mod contamination;
pub mod cosine_power;
pub mod csv_table;
mod entries;
pub mod finish;
pub mod fit;
pub mod fred;
pub mod gaussian;
pub mod harvey;
pub mod klems;
pub mod klems_xml;
pub mod lambertian;
pub mod microfacet;
pub mod oren_nayar;
pub mod polish;
pub mod radial;
pub mod reading;
pub mod scaled;
pub mod spectral;
pub mod speos;
pub mod tabulated;
pub mod zemax;

use crate::math::Rng;
use crate::optics::Incidence;
use glam::DVec3;

pub use abg::Abg;
pub use anisotropic::Anisotropic;
pub use cosine_power::{Axis, CosinePower};
pub use gaussian::Gaussian;
pub use harvey::Harvey;
pub use klems::Klems;
pub use lambertian::Lambertian;
pub use microfacet::{Compensation, Distribution, Facets, Microfacet};
pub use oren_nayar::OrenNayar;
pub use polish::{KCorrelation, Polish, PsdTable};
pub use radial::Side;
pub use scaled::Scaled;
pub use spectral::Spectral;
pub use tabulated::Tabulated;

/// BSDF and density of draws towards one direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weighed {
    /// f, 1/sr.
    pub value: f64,
    /// Density of the sampler's directions, 1/sr.
    pub density: f64,
}

/// A scatter model. `eval`, `pdf`, `sample` and `albedo` describe one and the same function at every incidence.
pub trait Bsdf: Send + Sync + std::fmt::Debug {
    /// f(wi -> wo), 1/sr, >= 0.
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64;

    /// Density of `sample`'s directions per solid angle, 1/sr; positive wherever `eval` is (to which it need not be proportional).
    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64;

    /// `eval` and `pdf` at once, where they have work in common.
    fn weigh(&self, at: &Incidence, wo: DVec3) -> Weighed {
        Weighed { value: self.eval(at, wo), density: self.pdf(at, wo) }
    }

    /// Draws a direction with density `pdf`. `None`: the draw fell outside the hemispheres that light can take;
    /// it counts as a draw of weight zero, and `pdf` does not integrate to 1 then.
    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3>;

    /// Scattered / incident flux at this incidence (the TIS), 0..1: the integral of f |cos| over all directions.
    fn albedo(&self, at: &Incidence) -> f64;

    /// True if it depends on the azimuth of the plane of incidence: its surface must have a lay.
    fn anisotropic(&self) -> bool {
        false
    }

    /// True if some light is transmitted.
    fn transmits(&self) -> bool {
        false
    }
}
