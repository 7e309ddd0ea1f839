//! A medium of a catalogue: an index by formula or table, its absorption, and the air they are relative to.
//!
//!     n + ik = n_a (m(lambda / n_a) + i k(lambda / n_a))       n_a = n of air at the catalogue's temperature, one atmosphere
//!
//! lambda vacuum wavelength, m; m, k as the catalogue gives them. A glass catalogue measures in air: its wavelengths are those
//! in air and its indices ratios to the index of air. So the absolute index is larger by n_a = 1.00027, and the wavelength
//! to look up shorter by as much. k takes the factor too: it is alpha lambda / (4 pi) at the wavelength in air. The result is
//! absolute; in a system whose ambient is [`Air`] every ratio of indices is the catalogue's again.
//!
//! The range is the one printed in the catalogue. That its wavelengths are those in air shifts it by 3e-4 of themselves,
//! less than its rounding; it is not converted.
//!
//! Left out: a temperature of the glass other than the catalogue's. Where the index is known and the absorption is not, the end
//! value of its table is held ([`Medium::absorption_range`] says where that begins).
//!
//! Source: Schott, TIE-29, Refractive index and dispersion (2016), on relative and absolute indices.

use super::{Air, Medium, Tabulated};
use num_complex::Complex64;

/// What a page of a catalogue describes.
#[derive(Debug)]
pub struct Catalogued {
    /// Where the data come from: "SCHOTT:N-BK7", "schott.agf, N-BK7".
    pub origin: String,
    /// Index, with its absorption if one table gives both.
    pub index: Box<dyn Medium>,
    /// 0 + ik over the catalogue's wavelengths, if a table of its own gives it.
    pub extinction: Option<Tabulated>,
    /// Wavelengths (m) of the index as printed.
    pub range: [f64; 2],
    /// Air that the index is a ratio to; `None`: absolute.
    pub relative_to: Option<Air>,
    /// Air that the wavelengths are measured in; `None`: vacuum.
    pub wavelengths_in: Option<Air>,
}

/// A medium with what its catalogue states of it.
#[derive(Debug)]
pub struct Stated {
    pub medium: Catalogued,
    /// Index at the d line (587.5618 nm in air), dimensionless.
    pub n_d: Option<f64>,
    /// Abbe number (n_d - 1) / (n_F - n_C), dimensionless.
    pub abbe: Option<f64>,
}

impl Catalogued {
    /// n + ik as the catalogue gives it, at its own wavelength (m).
    pub fn printed(&self, wavelength: f64) -> Complex64 {
        let absorbed = self.extinction.as_ref().map_or(Complex64::ZERO, |k| k.index(wavelength));
        self.index.index(wavelength) + absorbed
    }

    /// A wavelength (m, as printed) within the range at which there is no index: looked for at 65 points.
    pub fn gap(&self) -> Option<f64> {
        let [low, high] = self.range;
        let at = |step: i32| low * (high / low).powf(f64::from(step) / 64.0);
        let valid = |n: Complex64| n.re.is_finite() && n.re > 0.0 && n.im.is_finite() && n.im >= 0.0;
        (0..=64).map(at).find(|&wavelength| !valid(self.printed(wavelength)))
    }
}

impl Medium for Catalogued {
    fn index(&self, wavelength: f64) -> Complex64 {
        let factor = |air: Option<Air>| air.map_or(1.0, |air| 1.0 + air.refractivity(wavelength));
        factor(self.relative_to) * self.printed(wavelength / factor(self.wavelengths_in))
    }

    fn range(&self) -> Option<[f64; 2]> {
        Some(self.range)
    }

    fn absorption_range(&self) -> Option<[f64; 2]> {
        self.extinction.as_ref().and_then(Medium::range)
    }

    fn origin(&self) -> Option<&str> {
        Some(&self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::air::ROOM;
    use crate::medium::{Constant, absorption};

    fn glass(air: Option<Air>) -> Catalogued {
        let extinction = Tabulated::new(vec![4e-7, 6e-7], &[0.0; 2], &[1e-8, 3e-8]);
        let index = Box::new(Constant::transparent(1.5));
        let origin = "a test".into();
        Catalogued { origin, index, extinction, range: [3e-7, 1e-6], relative_to: air, wavelengths_in: air }
    }

    #[test]
    fn the_ratio_to_air_is_the_catalogues() {
        let air = Air::at(ROOM);
        let [relative, absolute] = [Some(air), None].map(|air| glass(air).index(500e-9));
        assert!((relative.re / air.index(500e-9).re - 1.5).abs() < 1e-15);
        assert_eq!(absolute.re, 1.5);
    }

    #[test]
    fn absorption_per_metre_is_that_at_the_wavelength_in_air() {
        let (air, wavelength) = (Air::at(ROOM), 500e-9);
        let in_air = wavelength / air.index(wavelength).re;
        let glass = glass(Some(air));
        let wanted = absorption(glass.printed(in_air), in_air);
        assert!((absorption(glass.index(wavelength), wavelength) / wanted - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_pole_within_the_range_is_a_gap() {
        assert_eq!(glass(None).gap(), None);
        let mut glass = glass(None);
        glass.index = Box::new(Constant { n: -1.0, ..Constant::transparent(1.0) });
        assert_eq!(glass.gap(), Some(3e-7));
    }
}
