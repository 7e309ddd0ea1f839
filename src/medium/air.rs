//! Dry air: its index against vacuum wavelength, temperature and pressure.
//!
//!     n - 1 = (n_s - 1) rho / rho_s
//!     1e8 (n_s - 1) = 5792105 / (238.0185 - s^2) + 167917 / (57.362 - s^2)       s = 1 / lambda in um^-1
//!     rho ~ p / (Z T),    Z = 1 - (p / T) (a0 + a1 t + a2 t^2) + (p / T)^2 d     t = T - 273.15 K
//!
//! n_s holds at 15 C, 101325 Pa and 450 ppm of CO2. Standard error 1e-8 from 300 to 1690 nm; the fit itself begins at 185 nm,
//! and towards the infrared n is constant within 1e-6 outside the absorption bands of water and CO2.
//! Check: at 633 nm, 20 C, 100 kPa 1e8 (n - 1) = 26824.4. At the d line, 20 C and one atmosphere n = 1.0002724.
//!
//! Left out: humidity (50 % at 20 C lower n by 4e-7), absorption.
//! Source: Ciddor, Appl. Opt. 35, 1566 (1996), eq. (1), table 1 and appendix A; within 3e-8 of Edlen, Metrologia 2, 71 (1966),
//! on which the formula of glass catalogues rests (Schott, TIE-29, Refractive index and dispersion, 2016).

use super::Medium;
use num_complex::Complex64;

/// One atmosphere, Pa.
pub const ATMOSPHERE: f64 = 101_325.0;
/// 20 C, K: the reference of Schott's catalogue, and of every catalogue that names none.
pub const ROOM: f64 = 293.15;
/// 0 C, K.
pub const ICE: f64 = 273.15;

/// Vacuum wavelengths (m) at which the index is given.
const RANGE: [f64; 2] = [185e-9, 1e-3];

/// Dry air of 450 ppm CO2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    temperature: f64,
    /// Density over that of standard air, dimensionless.
    density: f64,
}

impl Air {
    /// Air of `temperature` (K, > 0) and `pressure` (Pa).
    pub fn new(temperature: f64, pressure: f64) -> Air {
        Air { temperature, density: density(temperature, pressure) / density(ICE + 15.0, ATMOSPHERE) }
    }

    /// Air of one atmosphere at `temperature` (K): what catalogues are relative to.
    pub fn at(temperature: f64) -> Air {
        Air::new(temperature, ATMOSPHERE)
    }

    /// K.
    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// n - 1 at vacuum wavelength `wavelength` (m), dimensionless. Below 185 nm that of 185 nm.
    pub fn refractivity(&self, wavelength: f64) -> f64 {
        let wavenumber = 1e-6 / wavelength.max(RANGE[0]);
        let square = wavenumber * wavenumber;
        let standard = 1e-8 * (5_792_105.0 / (238.0185 - square) + 167_917.0 / (57.362 - square));
        standard * self.density
    }
}

/// p / (Z T), Pa/K: proportional to the density of dry air (BIPM equation of 1981/91, Ciddor's appendix A).
fn density(temperature: f64, pressure: f64) -> f64 {
    let (ratio, celsius) = (pressure / temperature, temperature - ICE);
    let virial = 1.58123e-6 - 2.9331e-8 * celsius + 1.1043e-10 * celsius * celsius;
    ratio / (1.0 - ratio * virial + ratio * ratio * 1.83e-11)
}

impl Medium for Air {
    fn index(&self, wavelength: f64) -> Complex64 {
        Complex64::new(1.0 + self.refractivity(wavelength), 0.0)
    }

    fn range(&self) -> Option<[f64; 2]> {
        Some(RANGE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ciddor (1996), table 1: dry air with 450 ppm of CO2 at 633 nm.
    #[test]
    fn the_table_of_ciddor_is_met() {
        let rows = [
            (20.0, 80e3, 21458.0),
            (20.0, 100e3, 26824.4),
            (20.0, 120e3, 32191.6),
            (10.0, 100e3, 27774.7),
            (30.0, 100e3, 25937.2),
        ];
        for (celsius, pressure, wanted) in rows {
            let got = 1e8 * Air::new(ICE + celsius, pressure).refractivity(633e-9);
            assert!((got - wanted).abs() < 0.06, "{celsius} C, {pressure} Pa: {got}, table {wanted}");
        }
    }

    /// Edlen (1966) at 15 C: 1e8 (n - 1) = 8342.13 + 2406030 / (130 - s^2) + 15997 / (38.9 - s^2).
    #[test]
    fn edlen_agrees_within_three_parts_in_1e8() {
        for um in [0.365, 0.4861, 0.5876, 0.6563, 1.014] {
            let square = f64::powi(um, -2);
            let edlen = 8342.13 + 2_406_030.0 / (130.0 - square) + 15_997.0 / (38.9 - square);
            let ciddor = 1e8 * Air::at(ICE + 15.0).refractivity(um * 1e-6);
            assert!((ciddor - edlen).abs() < 3.0, "{um} um: {ciddor} and {edlen}");
        }
    }

    #[test]
    fn without_pressure_air_is_vacuum() {
        assert_eq!(Air::new(ROOM, 0.0).index(550e-9), Complex64::new(1.0, 0.0));
    }
}
