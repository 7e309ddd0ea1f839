//! A medium whose index is worked out beforehand at the light of the sources: a formula costs 60 to 200 ns, four times per event.
//!
//! At spectral lines the bits are the same as without: the index is looked up at equal wavelengths. In a continuous spectrum it is a
//! cubic in each of many even pieces of the band (`Band`), within `BOUND` of itself; elsewhere it is asked for.

use super::Medium;
use super::bulk::Bulk;
use num_complex::Complex64;
use std::f64::consts::FRAC_PI_4;

/// Largest error of n and of k in a band, relative to the largest of its piece.
const BOUND: f64 = 1e-12;
/// Pieces of a band, at first and at most.
const PIECES: [usize; 2] = [64, 4096];

/// A medium and its index at the wavelengths of the light.
#[derive(Debug)]
pub struct Remembered {
    medium: Box<dyn Medium>,
    /// Vacuum wavelengths, m, and the index there.
    known: Vec<(f64, Complex64)>,
    band: Option<Band>,
}

impl Remembered {
    /// `medium` with its index at `wavelengths` (m, vacuum; a handful, as they are searched one by one) and from the first to the
    /// second of `band`.
    pub fn new(medium: Box<dyn Medium>, wavelengths: &[f64], band: Option<[f64; 2]>) -> Remembered {
        let known = wavelengths.iter().map(|&wavelength| (wavelength, medium.index(wavelength))).collect();
        let band = band.and_then(|band| Band::new(medium.as_ref(), band));
        Remembered { medium, known, band }
    }
}

/// The index over a band of wavelengths, piece by piece.
#[derive(Debug)]
struct Band {
    /// First wavelength, m, and pieces per m.
    from: f64,
    density: f64,
    /// Coefficients of 1, t, t^2 and t^3, t = -1..1 along the piece; `None` where a cubic does not do, as at the rows of a table.
    pieces: Vec<Option<[Complex64; 4]>>,
}

impl Band {
    /// Twice as many pieces until a cubic does in all but a fiftieth of them; `None` if it fails in a quarter of the most.
    fn new(medium: &dyn Medium, [from, to]: [f64; 2]) -> Option<Band> {
        let mut count = PIECES[0];
        loop {
            let edge = |piece: usize| from + (to - from) * piece as f64 / count as f64;
            let pieces: Vec<_> = (0..count).map(|piece| cubic(medium, edge(piece), edge(piece + 1))).collect();
            let failed = pieces.iter().filter(|piece| piece.is_none()).count();
            if 50 * failed <= count || count == PIECES[1] {
                let density = count as f64 / (to - from);
                return (4 * failed < count && density.is_finite()).then_some(Band { from, density, pieces });
            }
            count *= 2;
        }
    }

    fn index(&self, wavelength: f64) -> Option<Complex64> {
        let place = (wavelength - self.from) * self.density;
        let piece = if place >= 0.0 { place as usize } else { return None };
        let coefficients = self.pieces.get(piece)?.as_ref()?;
        Some(along(coefficients, 2.0 * (place - piece as f64) - 1.0))
    }
}

fn along([a, b, c, d]: &[Complex64; 4], t: f64) -> Complex64 {
    a + t * (b + t * (c + t * d))
}

/// The cubic through the index at the four nodes of Chebyshev between two wavelengths (m), if it is good between them and at both ends.
fn cubic(medium: &dyn Medium, from: f64, to: f64) -> Option<[Complex64; 4]> {
    let at = |t: f64| medium.index(0.5 * (from + to) + 0.5 * (to - from) * t);
    // cos(pi / 8) and cos(3 pi / 8); even and odd parts about the middle.
    let [outer, inner] = [(0.5 * FRAC_PI_4).cos(), (1.5 * FRAC_PI_4).cos()];
    let [[even_outer, odd_outer], [even_inner, odd_inner]] =
        [outer, inner].map(|t| [0.5 * (at(t) + at(-t)), 0.5 * (at(t) - at(-t)) / t]);
    let width = outer * outer - inner * inner;
    let [c, d] = [(even_outer - even_inner) / width, (odd_outer - odd_inner) / width];
    let coefficients = [even_inner - c * inner * inner, odd_inner - d * inner * inner, c, d];
    let size = even_outer.im.abs().max(even_inner.im.abs());
    let good = |t: f64| {
        let off = along(&coefficients, t) - at(t);
        off.re.abs() <= BOUND * even_inner.re.abs() && off.im.abs() <= BOUND * size
    };
    [-1.0, -0.7, 0.0, 0.7, 1.0].into_iter().all(good).then_some(coefficients)
}

impl Medium for Remembered {
    fn index(&self, wavelength: f64) -> Complex64 {
        let known = self.known.iter().find(|(at, _)| *at == wavelength);
        let known = known.map(|(_, index)| *index).or_else(|| self.band.as_ref()?.index(wavelength));
        known.unwrap_or_else(|| self.medium.index(wavelength))
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.medium.range()
    }

    fn absorption_range(&self) -> Option<[f64; 2]> {
        self.medium.absorption_range()
    }

    fn bulk(&self) -> Option<&dyn Bulk> {
        self.medium.bulk()
    }

    fn origin(&self) -> Option<&str> {
        self.medium.origin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::Tabulated;
    use crate::medium::catalog::Shelf;

    #[test]
    fn what_is_remembered_has_the_same_bits() {
        let glass = || Box::new(Shelf::Glass.medium("N-BK7").expect("a glass"));
        let (plain, remembered) = (glass(), Remembered::new(glass(), &[550e-9], None));
        for wavelength in [550e-9, 551e-9] {
            assert_eq!(plain.index(wavelength), remembered.index(wavelength));
        }
        assert_eq!((plain.range(), plain.origin()), (remembered.range(), remembered.origin()));
    }
    #[test]
    fn a_band_is_the_index_within_its_bound() {
        let table = || Tabulated::new(vec![4e-7, 5e-7, 7e-7], &[1.6, 1.5, 1.4], &[0.0, 1e-7, 3e-6]).expect("rising");
        let media: [fn() -> Box<dyn Medium>; 3] = [
            || Box::new(Shelf::Glass.medium("N-SF6").expect("a glass")),
            || Box::new(Shelf::Metal.medium("Ag").expect("a metal")),
            || Box::new(crate::medium::Air::at(293.15)),
        ];
        let tabled: Box<dyn Medium> = Box::new(table());
        let all =
            media.iter().map(|medium| (medium(), medium())).chain([(tabled, Box::new(table()) as Box<dyn Medium>)]);
        for (plain, medium) in all {
            let remembered = Remembered::new(medium, &[], Some([4.2e-7, 6.8e-7]));
            for step in 0..10_000 {
                let wavelength = 4.15e-7 + 2.7e-7 * f64::from(step) / 1e4;
                let (found, wanted) = (remembered.index(wavelength), plain.index(wavelength));
                let apart = [found.re - wanted.re, found.im - wanted.im];
                assert!(apart[0].abs() < 2e-12 * wanted.re, "{plain:?} {wavelength:e}: {found} {wanted}");
                assert!(apart[1].abs() < 1e-9 * wanted.im + 1e-20, "{plain:?} {wavelength:e}: {found} {wanted}");
            }
        }
    }
}
