//! What a detector counts instead of watts: photons, electrons, lumens.
//!
//! A watt of vacuum wavelength lambda counts as
//!
//!     photons     lambda / (h c)            1/s
//!     electrons   lambda / (h c) QE         1/s
//!     lumens      683.002 V                 lm
//!
//! times what a filter in front of it lets through, with QE the electrons per photon. Source: BIPM, The International System of
//! Units, 9th ed. 2019 (h, c, K_cd at 540 THz); V: CIE 1924 photopic luminous efficiency, the y of the CIE 1931 observer
//! (CIE 018:2019), every 5 nm, linear between.

use crate::math::table::linear;

/// Planck constant, J s; speed of light in vacuum, m/s.
const H: f64 = 6.626_070_15e-34;
const C: f64 = 299_792_458.0;
/// Luminous efficacy where V is 1, lm/W.
const MOST_LUMENS: f64 = 683.002;

/// V from 380 nm to 780 nm.
#[rustfmt::skip]
const PHOTOPIC: [f64; 81] = [
    0.000039, 0.000064, 0.000120, 0.000217, 0.000396, 0.000640, 0.001210, 0.002180, 0.004000, 0.007300,
    0.011600, 0.016840, 0.023000, 0.029800, 0.038000, 0.048000, 0.060000, 0.073900, 0.090980, 0.112600,
    0.139020, 0.169300, 0.208020, 0.258600, 0.323000, 0.407300, 0.503000, 0.608200, 0.710000, 0.793200,
    0.862000, 0.914850, 0.954000, 0.980300, 0.994950, 1.000000, 0.995000, 0.978600, 0.952000, 0.915400,
    0.870000, 0.816300, 0.757000, 0.694900, 0.631000, 0.566800, 0.503000, 0.441200, 0.381000, 0.321000,
    0.265000, 0.217000, 0.175000, 0.138200, 0.107000, 0.081600, 0.061000, 0.044580, 0.032000, 0.023200,
    0.017000, 0.011920, 0.008210, 0.005723, 0.004102, 0.002929, 0.002091, 0.001484, 0.001047, 0.000740,
    0.000520, 0.000361, 0.000249, 0.000172, 0.000120, 0.000085, 0.000060, 0.000042, 0.000030, 0.000021,
    0.000015,
];

/// What is counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Count {
    #[default]
    Watts,
    Photons,
    /// By electrons per photon.
    Electrons(Efficiency),
    Lumens,
}

/// A share over the wavelength: vacuum wavelengths (m, rising) and shares, linear between and nothing outside; one row alone
/// holds everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Efficiency {
    wavelengths: Vec<f64>,
    shares: Vec<f64>,
}

impl Efficiency {
    /// From rows, at least one.
    pub fn new(rows: &[(f64, f64)]) -> Efficiency {
        Efficiency {
            wavelengths: rows.iter().map(|row| row.0).collect(),
            shares: rows.iter().map(|row| row.1).collect(),
        }
    }

    /// The share at a vacuum wavelength (m).
    pub fn at(&self, wavelength: f64) -> f64 {
        let ends = [self.wavelengths[0], self.wavelengths[self.wavelengths.len() - 1]];
        let inside = self.shares.len() == 1 || (ends[0]..=ends[1]).contains(&wavelength);
        if inside { linear(&self.wavelengths, &self.shares, wavelength) } else { 0.0 }
    }
}

/// What a watt counts as.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    pub count: Count,
    pub filter: Option<Efficiency>,
}

impl Response {
    /// True if what is counted is all watts.
    pub fn is_flux(&self) -> bool {
        self.count == Count::Watts && self.filter.is_none()
    }

    /// What a watt of a vacuum wavelength (m) counts as, in [`unit`](Response::unit) per W.
    pub fn of(&self, wavelength: f64) -> f64 {
        let photons = wavelength / (H * C);
        let counted = match &self.count {
            Count::Watts => 1.0,
            Count::Photons => photons,
            Count::Electrons(efficiency) => photons * efficiency.at(wavelength),
            Count::Lumens => MOST_LUMENS * photopic(wavelength),
        };
        counted * self.filter.as_ref().map_or(1.0, |filter| filter.at(wavelength))
    }

    /// Unit of the whole.
    pub fn unit(&self) -> &'static str {
        match self.count {
            Count::Watts => "W",
            Count::Photons => "ph/s",
            Count::Electrons(_) => "e-/s",
            Count::Lumens => "lm",
        }
    }

    /// Unit of a bin of a map whose own is `unit`, W/m2 or W/sr: what is counted one by one is counted by the pixel.
    pub fn of_bins(&self, unit: &'static str) -> &'static str {
        match (&self.count, unit) {
            (Count::Watts, _) => unit,
            (Count::Photons, _) => "ph/s/px",
            (Count::Electrons(_), _) => "e-/s/px",
            (Count::Lumens, "W/sr") => "cd",
            (Count::Lumens, _) => "lx",
        }
    }

    /// True if a bin's value is not divided by its size.
    pub fn by_the_pixel(&self) -> bool {
        matches!(self.count, Count::Photons | Count::Electrons(_))
    }
}

/// V at a vacuum wavelength (m); 0 outside of 380 nm to 780 nm.
fn photopic(wavelength: f64) -> f64 {
    let place = (wavelength * 1e9 - 380.0) / 5.0;
    if !(0.0..=80.0).contains(&place) {
        return 0.0;
    }
    let first = (place as usize).min(79);
    let rest = place - first as f64;
    PHOTOPIC[first] + rest * (PHOTOPIC[first + 1] - PHOTOPIC[first])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The candela: 540 THz, that is 555.17 nm, has 683 lm/W; a photon at 1 um has 1.986e-19 J.
    #[test]
    fn units_are_those_of_the_si() {
        let lumens = Response { count: Count::Lumens, filter: None };
        assert!((lumens.of(C / 540e12) - 683.0).abs() < 0.2);
        assert_eq!([lumens.of(379e-9), lumens.of(800e-9)], [0.0; 2]);
        assert!((lumens.of(507.5e-9) / MOST_LUMENS - 0.45515).abs() < 1e-9);
        let photons = Response { count: Count::Photons, filter: None };
        assert!((1.0 / photons.of(1e-6) / 1.986_445_857e-19 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn efficiencies_multiply_and_end_with_their_tables() {
        let table = Efficiency::new(&[(400e-9, 0.2), (600e-9, 0.6)]);
        let filter = Efficiency::new(&[(0.0, 0.5)]);
        let photons = Response { count: Count::Photons, filter: None };
        let both = Response { count: Count::Electrons(table), filter: Some(filter) };
        assert!((both.of(500e-9) / photons.of(500e-9) - 0.2).abs() < 1e-12);
        assert_eq!(both.of(601e-9), 0.0);
        assert!(Response::default().is_flux() && !both.is_flux());
    }
}
