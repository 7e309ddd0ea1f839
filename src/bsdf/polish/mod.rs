//! Scatter of a polished surface from the power spectral density of its heights: Rayleigh-Rice.
//!
//!     f = n_s^2 4 pi^2 K PSD(x / lambda) / lambda^4   [1/sr]        x = |n_s beta_s - n_s beta_0|
//!     reflected     K = (2 n_i)^2 cos_i cos_s
//!     transmitted   K = (n_t cos_t - n_i cos_i)^2 cos_s / cos_t
//!
//! PSD two-dimensional, m^4, over spatial frequency x / lambda, 1/m; lambda vacuum wavelength, m; beta, beta_0 and n_s as of
//! every radial lobe ([`super::radial`]); cos_t of the refracted ray. f is for a surface that reflects (passes) everything: the
//! Q factor is the R (T) of the coating, which `order: Scaled` puts in. So a mirror has 16 pi^2 R cos_i cos_s PSD / lambda^4,
//! reflection inside glass n^4 of it (n^2 by the phase, n^2 per sr), and one PSD serves both sides of both faces of a lens.
//!
//!     TIS(theta_i) = integral of f cos_s over the hemisphere -> (2 pi dn sigma / lambda)^2  for a narrow PSD
//!     dn = 2 n_i cos_i reflected, |n_t cos_t - n_i cos_i| transmitted;  sigma^2 = 2 pi integral_0^(n/lambda) PSD f df
//!
//! f is reciprocal in reflection. Draws follow PSD in radius about the specular ray; the weight is in proportion to cos_s.
//!
//! Valid for TIS << 1. Within about TIS of the critical angle, where cos_t vanishes (and T with it), cos_t is not taken below the
//! narrow PSD's TIS at cos_t = 1, so that no more than everything is transmitted.
//! Left out: the dependence of the vector theory's Q on the scattered direction and on polarisation (Q = R, T of the
//! specular ray); second-order scatter.
//! Source: Church, Jenkinson & Zavada, Opt. Eng. 18, 125 (1979); Stover, Optical Scattering, 3rd ed. (2012), sec. 3.4 and 4.3;
//! the n_t cos_t - n_i cos_i of transmission: Elson, Appl. Opt. 16, 2872 (1977), first order.

mod correlation;
mod flux;
mod table;

use super::radial::{Profile, direction};
use super::{Bsdf, Side};
use crate::math::Rng;
use crate::optics::{Incidence, refraction};
use flux::Flux;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

pub use correlation::KCorrelation;
pub use table::PsdTable;

/// The scatter of a surface with a PSD: `P` gives m^4 over 1/m.
#[derive(Clone, Debug)]
pub struct Polish<P> {
    psd: P,
    side: Side,
    flux: Flux,
}

/// What every direction of an event has in common.
struct Event {
    /// beta_0, the direction cosines of the specular ray.
    specular: DVec2,
    /// n_s / lambda, 1/m.
    frequency: f64,
    /// f / (cos_s PSD), 1/(sr m^4).
    factor: f64,
}

/// TIS of a smooth surface: (2 pi `dn` `rms` / `wavelength`)^2, dimensionless, of the reflected or transmitted flux; `dn` is 2 cos_i
/// for a mirror, see the module. `rms` (m) counts up to the frequency that scatters to the horizon.
pub fn smooth_tis(rms: f64, dn: f64, wavelength: f64) -> f64 {
    (TAU * dn * rms / wavelength).powi(2)
}

impl<P: Profile> Polish<P> {
    /// The lobe of a PSD on one side.
    pub fn new(psd: P, side: Side) -> Polish<P> {
        Polish { psd, side, flux: Flux::new() }
    }

    /// `None` where there is no specular ray: total reflection of a transmitted lobe.
    fn event(&self, at: &Incidence) -> Option<Event> {
        let [here, beyond] = at.index.map(|n| n.re);
        let common = 4.0 * PI * PI / at.wavelength.powi(4);
        let (n, ray, factor) = match self.side {
            Side::Reflect => (here, refraction::reflect(at.wi), 4.0 * here * here * at.cos()),
            Side::Transmit => {
                let ray = refraction::refract(at.wi, here, beyond)?;
                let dn = here * at.cos() + beyond * ray.z;
                let smooth = smooth_tis(self.rms(beyond / at.wavelength), dn, at.wavelength);
                (beyond, ray, dn * dn / (-ray.z).max(smooth))
            }
        };
        Some(Event { specular: ray.truncate(), frequency: n / at.wavelength, factor: n * n * common * factor })
    }

    /// Rms height over the frequencies 0 to `highest` (1/m), m.
    pub fn rms(&self, highest: f64) -> f64 {
        (TAU * self.psd.integral(highest)).sqrt()
    }

    /// PSD of the scattered direction, m^4; 0 on the other side.
    fn density(&self, event: &Event, wo: DVec3) -> f64 {
        if !self.side.holds(wo) {
            return 0.0;
        }
        self.psd.value(event.frequency * (wo.truncate() - event.specular).length())
    }

    /// The highest frequency that any direction has, 1/m.
    fn reach(&self, event: &Event) -> f64 {
        event.frequency * (1.0 + event.specular.length())
    }
}

impl<P: Profile> Bsdf for Polish<P> {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.event(at).map_or(0.0, |event| event.factor * wo.z.abs() * self.density(&event, wo))
    }

    /// (n/lambda)^2 |cos| PSD / (2 pi integral_0^reach PSD f df).
    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let Some(event) = self.event(at) else { return 0.0 };
        let total = TAU * self.psd.integral(self.reach(&event));
        event.frequency * event.frequency * wo.z.abs() * self.density(&event, wo) / total
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let event = self.event(at)?;
        let x = self.psd.draw(self.reach(&event), rng) / event.frequency;
        direction(event.specular, 1.0, x, self.side, rng.uniform())
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        let Some(event) = self.event(at) else { return 0.0 };
        event.factor * self.flux.at(&self.psd, event.frequency, event.specular.length())
    }

    fn transmits(&self) -> bool {
        self.side == Side::Transmit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    /// The published check of Dittman's paper: 3 nm rms measured up to 1/632.8 nm, traced at 300 nm, R = 0.95.
    #[test]
    fn a_mirror_has_the_published_scatter_with_and_without_obliquity() {
        let psd = KCorrelation::new(3e-9, [0.0, 1.0 / 632.8e-9], 5.02655e-6, 3.0);
        let mirror = Polish::new(psd, Side::Reflect);
        let tis = 0.95 * mirror.albedo(&Incidence::in_air(0.0, 300e-9));
        assert!((tis - 0.015597).abs() < 1e-6, "{tis}");
        let smooth = 0.95 * smooth_tis(mirror.rms(1.0 / 300e-9), 2.0, 300e-9);
        assert!((smooth - 0.016122).abs() < 1e-6, "{smooth}");
        assert!((smooth_tis(5e-9, 2.0, 500e-9) - 0.015791).abs() < 1e-6);
    }

    /// B = 2 mm: all of it within 0.1 mrad of the specular ray.
    #[test]
    fn a_narrow_spectrum_is_a_smooth_surface_in_any_medium_and_on_either_side() {
        let psd = KCorrelation::new(1e-9, [0.0, f64::INFINITY], 2e-3, 5.0);
        for index in [[1.0, 1.0], [1.0, 1.5], [1.5, 1.0], [1.5, 4.0]] {
            for theta in [0.0, 0.3, 0.7f64] {
                let at = Incidence { index: index.map(|n| Complex64::new(n, 0.0)), ..Incidence::in_air(theta, 633e-9) };
                let back = Polish::new(psd, Side::Reflect).albedo(&at);
                let wanted = smooth_tis(1e-9, 2.0 * index[0] * theta.cos(), 633e-9);
                assert!((back / wanted - 1.0).abs() < 1e-3, "{index:?} {theta}: {back} {wanted}");
                let Some(ray) = refraction::refract(at.wi, index[0], index[1]) else { continue };
                let through = Polish::new(psd, Side::Transmit).albedo(&at);
                let wanted = smooth_tis(1e-9, index[0] * theta.cos() + index[1] * ray.z, 633e-9);
                assert!((through - wanted).abs() <= 1e-3 * wanted, "{index:?} {theta}: {through} {wanted}");
            }
        }
    }

    #[test]
    fn nothing_is_transmitted_beyond_the_critical_angle_and_never_more_than_all() {
        let lobe = Polish::new(KCorrelation::new(5e-9, [0.0, f64::INFINITY], 2e-3, 5.0), Side::Transmit);
        let glass = [1.5, 1.0].map(|n| Complex64::new(n, 0.0));
        let critical = (1.0f64 / 1.5).asin();
        let at = |theta: f64| Incidence { index: glass, ..Incidence::in_air(theta, 633e-9) };
        let mut rng = Rng::new(1, 0, 0);
        assert_eq!(lobe.albedo(&at(critical + 1e-9)), 0.0);
        assert!(lobe.sample(&at(critical + 1e-9), &mut rng).is_none());
        for below in [1e-3, 1e-8, 1e-14] {
            assert!(lobe.albedo(&at(critical - below)) <= 1.0, "{below}");
        }
    }
}
