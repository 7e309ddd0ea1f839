//! Scatter by one homogeneous sphere of any size (Mie).
//!
//! With size parameter x = pi D n_host / lambda and relative index m = (n + ik) / n_host, the coefficients are
//!
//!     a_n = ((D_n(mx) / m + n / x) psi_n(x) - psi_(n-1)(x)) / ((D_n(mx) / m + n / x) xi_n(x) - xi_(n-1)(x))
//!     b_n = ((m D_n(mx) + n / x) psi_n(x) - psi_(n-1)(x)) / ((m D_n(mx) + n / x) xi_n(x) - xi_(n-1)(x))
//!
//! n = 1 .. x + 4.05 x^(1/3) + 2; D_n, the logarithmic derivative of psi_n, by downward recurrence, psi and xi by upward recurrence.
//! Efficiencies are cross-sections over pi D^2 / 4. Source: C. F. Bohren, D. R. Huffman, Absorption and Scattering of Light by Small
//! Particles, 1983, sections 4.4 and 4.8; number of terms: W. J. Wiscombe, Appl. Opt. 19, 1505 (1980).
//! Left out: coatings on the sphere, a host that absorbs, near fields.

use num_complex::Complex64;
use std::f64::consts::PI;

/// What one sphere does to light.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Size parameter, dimensionless.
    pub x: f64,
    /// Extinction efficiency, dimensionless.
    pub extinction: f64,
    /// Scattering efficiency, dimensionless.
    pub scattering: f64,
    /// Mean cosine of the scattering angle.
    pub asymmetry: f64,
    /// a_n and b_n.
    coefficients: Vec<[Complex64; 2]>,
}

impl Sphere {
    /// A sphere of diameter `diameter` (m) and index `index` (n + ik) in a clear medium of index `host`, at vacuum wavelength
    /// `wavelength` (m).
    pub fn new(diameter: f64, index: Complex64, host: f64, wavelength: f64) -> Sphere {
        let (x, m) = (PI * diameter * host / wavelength, index / host);
        let coefficients = coefficients(x, m);
        let number = |k: usize| (k + 1) as f64;
        let (mut extinction, mut scattering, mut asymmetry) = (0.0, 0.0, 0.0);
        for (k, [a, b]) in coefficients.iter().enumerate() {
            let n = number(k);
            extinction += (2.0 * n + 1.0) * (a + b).re;
            scattering += (2.0 * n + 1.0) * (a.norm_sqr() + b.norm_sqr());
            asymmetry += (2.0 * n + 1.0) / (n * (n + 1.0)) * (a * b.conj()).re;
            if let Some([next_a, next_b]) = coefficients.get(k + 1) {
                asymmetry += n * (n + 2.0) / (n + 1.0) * (a * next_a.conj() + b * next_b.conj()).re;
            }
        }
        let scale = 2.0 / (x * x);
        Sphere {
            x,
            extinction: scale * extinction,
            scattering: scale * scattering,
            asymmetry: 2.0 * asymmetry / scattering,
            coefficients,
        }
    }

    /// Backscattering efficiency: 4 pi times the differential cross-section straight back, over pi D^2 / 4.
    pub fn backscattering(&self) -> f64 {
        let term = |(k, [a, b]): (usize, &[Complex64; 2])| {
            let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
            (a - b) * (sign * (2 * k + 3) as f64)
        };
        self.coefficients.iter().enumerate().map(term).sum::<Complex64>().norm_sqr() / (self.x * self.x)
    }

    /// Differential scattering cross-section of unpolarised light over pi D^2 / 4, 1/sr, at the cosine of the scattering angle.
    pub fn differential(&self, cosine: f64) -> f64 {
        let [mut s1, mut s2] = [Complex64::ZERO; 2];
        // pi_n and tau_n by upward recurrence.
        let [mut before, mut here] = [0.0, 1.0];
        for (k, [a, b]) in self.coefficients.iter().enumerate() {
            let n = (k + 1) as f64;
            let tau = n * cosine * here - (n + 1.0) * before;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            s1 += weight * (a * here + b * tau);
            s2 += weight * (a * tau + b * here);
            let next = ((2.0 * n + 1.0) * cosine * here - (n + 1.0) * before) / n;
            (before, here) = (here, next);
        }
        0.5 * (s1.norm_sqr() + s2.norm_sqr()) / (PI * self.x * self.x)
    }
}

fn coefficients(x: f64, m: Complex64) -> Vec<[Complex64; 2]> {
    let count = (x + 4.05 * x.cbrt() + 2.0).ceil() as usize;
    let derivatives = derivatives(m * x, count);
    let [mut psi_before, mut psi] = [x.cos(), x.sin()];
    let [mut chi_before, mut chi] = [-x.sin(), x.cos()];
    let mut list = Vec::with_capacity(count);
    for (k, derivative) in derivatives.into_iter().enumerate() {
        let n = (k + 1) as f64;
        let step = (2.0 * n - 1.0) / x;
        (psi_before, psi) = (psi, step * psi - psi_before);
        (chi_before, chi) = (chi, step * chi - chi_before);
        let (xi_before, xi) = (Complex64::new(psi_before, -chi_before), Complex64::new(psi, -chi));
        let ratio = |factor: Complex64| {
            let factor = factor + n / x;
            (factor * psi - psi_before) / (factor * xi - xi_before)
        };
        list.push([ratio(derivative / m), ratio(derivative * m)]);
    }
    list
}

/// Logarithmic derivatives D_1 .. D_count of the Riccati-Bessel function psi at z, downward from where the start is forgotten.
fn derivatives(z: Complex64, count: usize) -> Vec<Complex64> {
    let start = count.max(z.norm().ceil() as usize) + 16;
    let mut list = vec![Complex64::ZERO; start + 1];
    for n in (1..=start).rev() {
        let ratio = n as f64 / z;
        list[n - 1] = ratio - (list[n] + ratio).inv();
    }
    list[1..=count].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The differential cross-section integrates to the scattering efficiency, and its first moment to the mean cosine.
    #[test]
    fn the_angles_add_up_to_the_efficiencies() {
        for (diameter, k) in [(0.02e-6, 0.0), (0.5e-6, 0.0), (5e-6, 0.01), (20e-6, 0.0)] {
            let sphere = Sphere::new(diameter, Complex64::new(1.5, k), 1.0, 0.55e-6);
            let (mut total, mut moment) = (0.0, 0.0);
            // Midpoints in the angle: the integrand is periodic and smooth.
            let count = 40_000;
            for i in 0..count {
                let theta = PI * (i as f64 + 0.5) / count as f64;
                let weight = 2.0 * PI * theta.sin() * PI / count as f64 * sphere.differential(theta.cos());
                total += weight;
                moment += weight * theta.cos();
            }
            assert!((total / sphere.scattering - 1.0).abs() < 1e-6, "{total} {sphere:?}");
            assert!((moment / total - sphere.asymmetry).abs() < 1e-6);
            let back = 4.0 * PI * sphere.differential(-1.0);
            assert!((back / sphere.backscattering() - 1.0).abs() < 1e-9);
            let absorbed = sphere.extinction - sphere.scattering;
            assert!(if k == 0.0 { absorbed.abs() < 1e-9 } else { absorbed > 1e-3 }, "{absorbed}");
        }
    }

    /// Far below the wavelength: Q_sca = 8/3 x^4 |(m^2 - 1) / (m^2 + 2)|^2.
    #[test]
    fn a_small_sphere_is_rayleighs() {
        let m = Complex64::new(1.33, 0.0);
        let sphere = Sphere::new(2e-9, m, 1.0, 0.55e-6);
        let polarisability = ((m * m - 1.0) / (m * m + 2.0)).norm_sqr();
        let wanted = 8.0 / 3.0 * sphere.x.powi(4) * polarisability;
        assert!((sphere.scattering / wanted - 1.0).abs() < 1e-4, "{} {wanted}", sphere.scattering);
    }
}
