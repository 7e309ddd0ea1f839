//! Black bodies: what a surface of emissivity 1 sends out.
//!
//!     L_lambda = c_1L / (lambda^5 (exp(c_2 / (lambda T)) - 1))    [W/(m2 sr m)],      c_1L = 2 h c^2,  c_2 = h c / k_B
//!
//! lambda is the vacuum wavelength (m), T the temperature (K); in a medium of index n the radiance is n^2 times that. Its integral
//! up to lambda, with x = c_2 / (lambda T):
//!
//!     L = (c_1L T^4 / c_2^4) sum over n of exp(-n x) (x^3 / n + 3 x^2 / n^2 + 6 x / n^3 + 6 / n^4)
//!
//! Source: Chang, Rhee, Int. Comm. Heat Mass Transfer 11 (1984) 451; constants CODATA 2018.

/// Second radiation constant h c / k_B, m K.
pub(super) const C2: f64 = 1.438_776_877e-2;
/// First radiation constant for radiance 2 h c^2, W m2/sr.
const C1L: f64 = 1.191_042_972e-16;
/// h c, J m: a photon of vacuum wavelength lambda has h c / lambda.
const HC: f64 = 1.986_445_857e-25;

/// Spectral radiance of a black body in vacuum, W/(m2 sr m); 0 at 0 K.
pub fn radiance(temperature: f64, wavelength: f64) -> f64 {
    C1L / (wavelength.powi(5) * (C2 / (wavelength * temperature)).exp_m1())
}

/// Photons per joule at a vacuum wavelength (m), 1/J.
pub fn photons(wavelength: f64) -> f64 {
    wavelength / HC
}

/// Radiance of a black body between two vacuum wavelengths (m), W/(m2 sr). Some 40 c_2 / (lambda T) terms, at least one.
pub fn band(temperature: f64, [from, to]: [f64; 2]) -> f64 {
    below(temperature, to) - below(temperature, from)
}

/// Radiance below a vacuum wavelength (m), W/(m2 sr).
fn below(temperature: f64, wavelength: f64) -> f64 {
    if temperature <= 0.0 {
        return 0.0;
    }
    let x = C2 / (wavelength * temperature);
    let term =
        |n: f64| (-n * x).exp() * (x.powi(3) / n + 3.0 * (x / n).powi(2) + 6.0 * x / n.powi(3) + 6.0 / n.powi(4));
    let mut sum = 0.0;
    for n in 1.. {
        let next = term(f64::from(n));
        sum += next;
        // What follows adds up to less than n times this.
        if next * f64::from(n) <= 1e-16 * sum {
            break;
        }
    }
    C1L * (temperature / C2).powi(4) * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn all_wavelengths_together_are_stefan_and_boltzmann() {
        let sigma = 5.670_374_419e-8;
        let all = PI * band(300.0, [1e-7, 0.1]);
        assert!((all / (sigma * 300f64.powi(4)) - 1.0).abs() < 1e-6, "{all}");
    }

    /// Simpson's rule over the closed form of the spectral radiance.
    #[test]
    fn the_series_is_the_integral_of_the_spectral_radiance() {
        for (temperature, from, to) in [(300.0, 3e-6, 5e-6), (77.0, 8e-6, 12e-6), (5778.0, 0.4e-6, 0.7e-6)] {
            let n = 2000;
            let step = (to - from) / f64::from(n);
            let value = |i: i32| radiance(temperature, from + step * f64::from(i));
            let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            let simpson: f64 = (0..=n).map(|i| weight(i) * value(i)).sum::<f64>() * step / 3.0;
            assert!((band(temperature, [from, to]) / simpson - 1.0).abs() < 1e-9);
        }
        assert_eq!((band(0.0, [1e-6, 2e-6]), radiance(0.0, 1e-6)), (0.0, 0.0));
    }
}
