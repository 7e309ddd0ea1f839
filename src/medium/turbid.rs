//! A clear medium with something in it that scatters.
//!
//! The index is the host's; what the scatterers absorb is added to its imaginary part, k = alpha lambda / (4 pi).

use super::bulk::Bulk;
use super::{Medium, extinction};
use num_complex::Complex64;

/// A host and its scatterers.
#[derive(Debug)]
pub struct Turbid {
    pub host: Box<dyn Medium>,
    pub bulk: Box<dyn Bulk>,
}

impl Medium for Turbid {
    fn index(&self, wavelength: f64) -> Complex64 {
        let lost = extinction(self.bulk.absorption(wavelength), wavelength);
        self.host.index(wavelength) + Complex64::new(0.0, lost)
    }

    fn range(&self) -> Option<[f64; 2]> {
        let ranges = [self.host.range(), self.bulk.range()];
        ranges.into_iter().flatten().reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    fn absorption_range(&self) -> Option<[f64; 2]> {
        self.host.absorption_range()
    }

    fn origin(&self) -> Option<&str> {
        self.host.origin()
    }

    fn bulk(&self) -> Option<&dyn Bulk> {
        Some(self.bulk.as_ref())
    }
}
