//! A stack of thin films between the two media of a surface, or on an opaque substrate.
//!
//!     r, t of [`crate::optics::stack`] with the index n + ik of every layer at the wavelength of the light
//!
//! On an opaque substrate (a mirror) what enters it is absorbed, whatever lies beyond.
//!
//! At the wavelengths of spectral lines the product of the layers' matrices is tabulated beforehand
//! ([`Table`]): R and T differ from the layers' own by less than 1e-9. In a continuous spectrum it is over all of its band ([`Band`]),
//! where R and T differ by less than 1e-6. At all others, and where a table would be too large, they are multiplied out.

use super::Coating;
use crate::medium::Medium;
use crate::optics::stack::{Around, Band, End, Layer, Seen, Table, split};
use crate::optics::{Amplitudes, Incidence, Split};
use arrayvec::ArrayVec;
use num_complex::Complex64;
use std::sync::Arc;

/// Media whose index is asked for once for all layers; of a stack with more, again for each layer.
const SHARED: usize = 8;

/// Up to this many layers are multiplied faster than looked up.
const FEW: usize = 1;

/// Layers in the order that light meets them.
#[derive(Debug)]
pub struct Stack {
    media: Vec<Arc<dyn Medium>>,
    /// Medium and thickness (m) of each layer.
    layers: Vec<(usize, f64)>,
    substrate: Option<Arc<dyn Medium>>,
    /// Tables at some vacuum wavelengths, m.
    tables: Vec<(f64, Table)>,
    /// Over a band of wavelengths, and which end of its layers light meets.
    band: Option<(Arc<Band>, End)>,
}

impl Stack {
    /// Layers of thickness (m, >= 0) in the order that light meets them; each names one of `media`. `substrate`: what lies
    /// under them, opaque; `None`: the medium beyond the surface.
    pub fn new(media: Vec<Arc<dyn Medium>>, layers: Vec<(usize, f64)>, substrate: Option<Arc<dyn Medium>>) -> Stack {
        Stack { media, layers, substrate, tables: Vec::new(), band: None }
    }

    /// The same, looked up at these vacuum wavelengths (m) for light from media of index up to `highest`.
    pub fn tabulated(mut self, wavelengths: &[f64], highest: impl Fn(f64) -> f64) -> Stack {
        if self.layers.len() > FEW {
            let table = |&wavelength: &f64| {
                let layers: Vec<Layer> = self.films(wavelength).collect();
                Some((wavelength, Table::new(&layers, wavelength, highest(wavelength))?))
            };
            self.tables = wavelengths.iter().filter_map(table).collect();
        }
        self
    }

    /// The table of this stack over a band of vacuum wavelengths (m), for light from media of index up to `highest`; `None` if it is
    /// not worth one.
    pub fn over(&self, band: [f64; 2], highest: impl Fn(f64) -> f64 + Sync) -> Option<Arc<Band>> {
        let seen = Seen {
            layers: &|wavelength| self.films(wavelength).collect(),
            highest: &highest,
            beyond: &|wavelength| self.substrate.as_ref().map(|substrate| substrate.index(wavelength)),
        };
        let table = (self.layers.len() > FEW).then(|| Band::new(&seen, band))?;
        table.map(Arc::new)
    }

    /// The same, looked up in a table made for these layers, or for them in reverse.
    pub fn looked_up(self, table: Option<Arc<Band>>, end: End) -> Stack {
        Stack { band: table.map(|table| (table, end)), ..self }
    }

    /// The layers as light of this wavelength (m) meets them.
    fn films(&self, wavelength: f64) -> impl DoubleEndedIterator<Item = Layer> + '_ {
        let known: ArrayVec<Complex64, SHARED> =
            self.media.iter().take(SHARED).map(|medium| medium.index(wavelength)).collect();
        let index = move |medium: usize| known.get(medium).copied();
        let film = move |&(medium, thickness): &(usize, f64)| Layer {
            index: index(medium).unwrap_or_else(|| self.media[medium].index(wavelength)),
            thickness,
        };
        self.layers.iter().map(film)
    }
}

impl Coating for Stack {
    fn split(&self, at: &Incidence) -> Split {
        let n2 = self.substrate.as_ref().map_or(at.index[1], |substrate| substrate.index(at.wavelength));
        let around = Around { n1: at.index[0].re, n2, cos1: at.cos() };
        let table = self.tables.iter().find(|(wavelength, _)| *wavelength == at.wavelength);
        let over = || self.band.as_ref().and_then(|(band, end)| band.split(&around, at.wavelength, *end));
        let looked_up = table.and_then(|(_, table)| table.split(&around)).or_else(over);
        let split = looked_up.unwrap_or_else(|| split(&around, at.wavelength, self.films(at.wavelength)));
        if self.opaque() { Split { transmitted: Amplitudes::ZERO, ..split } } else { split }
    }

    fn opaque(&self) -> bool {
        self.substrate.is_some()
    }

    fn range(&self) -> Option<[f64; 2]> {
        let ranges = self.media.iter().chain(&self.substrate).filter_map(|medium| medium.range());
        ranges.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }
}
