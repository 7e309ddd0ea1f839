//! A coefficient over the wavelength.

use crate::math::table::linear;

/// Values over vacuum wavelength: linear between, the end values held outside.
#[derive(Clone, Debug)]
pub struct Spectrum {
    wavelength: Vec<f64>,
    value: Vec<f64>,
}

impl Spectrum {
    /// The same at every wavelength.
    pub fn constant(value: f64) -> Spectrum {
        Spectrum { wavelength: vec![0.0], value: vec![value] }
    }

    /// Rows of (vacuum wavelength m, value). `None` if there is no row or the wavelengths do not rise.
    pub fn new(rows: &[(f64, f64)]) -> Option<Spectrum> {
        let (wavelength, value): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
        let rises = wavelength.windows(2).all(|w| w[0] < w[1]);
        (!rows.is_empty() && rises).then_some(Spectrum { wavelength, value })
    }

    pub fn at(&self, wavelength: f64) -> f64 {
        linear(&self.wavelength, &self.value, wavelength)
    }

    /// First and last wavelength, m; `None` if it is the same everywhere.
    pub fn range(&self) -> Option<[f64; 2]> {
        let last = self.wavelength.len() - 1;
        (last > 0).then(|| [self.wavelength[0], self.wavelength[last]])
    }
}
