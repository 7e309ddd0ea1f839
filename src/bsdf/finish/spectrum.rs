//! Total reflectance of black finishes over the wavelength, as measured (`ua-loft/README.md`).

use crate::math::table::linear;

const TEXT: &str = include_str!("ua-loft/total-reflectance.csv");

/// A column of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Black {
    Ultrapol,
    Anodize,
    Kameralack,
    Krylon,
    Latex,
}

/// Vacuum wavelengths (m, rising) and the total reflectance (0..1) there.
pub fn spectrum(of: Black) -> (Vec<f64>, Vec<f64>) {
    let column = match of {
        Black::Ultrapol => 1,
        Black::Anodize => 2,
        Black::Kameralack => 3,
        Black::Krylon => 4,
        Black::Latex => 5,
    };
    let row = |line: &str| {
        let mut cells = line.split(',').map(|cell| cell.parse::<f64>());
        let wavelength = cells.next()?.ok()?;
        Some((1e-9 * wavelength, cells.nth(column - 1)?.ok()?))
    };
    TEXT.lines().skip(1).filter_map(row).unzip()
}

/// Total reflectance at a vacuum wavelength (m), 0..1; `None` where it was not measured.
pub fn total(of: Black, wavelength: f64) -> Option<f64> {
    let (wavelengths, reflectance) = spectrum(of);
    let known = wavelengths.first()? <= &wavelength && &wavelength <= wavelengths.last()?;
    known.then(|| linear(&wavelengths, &reflectance, wavelength))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read() {
        let (wavelength, reflectance) = spectrum(Black::Latex);
        assert_eq!(wavelength.len(), TEXT.lines().count() - 1);
        assert!(wavelength.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(reflectance.iter().all(|r| (0.0..=1.0).contains(r)));
    }

    #[test]
    fn black_anodize_is_bright_in_the_infrared() {
        let ratio = total(Black::Anodize, 1064e-9).zip(total(Black::Anodize, 550e-9)).map(|(far, near)| far / near);
        assert!(ratio.is_some_and(|ratio| ratio > 10.0), "{ratio:?}");
        assert_eq!(total(Black::Anodize, 10e-6), None);
    }
}
