//! Media: from what the document says to what fills a volume.

use super::Shop;
use crate::error::Problem;
use crate::medium::catalog::Shelf;
use crate::medium::{self, Medium, Remembered, agf, bulk, page};
use crate::scene::Filling;
use crate::system::document as written;
use std::path::Path;
use std::sync::Arc;

/// The medium that is always there.
pub const VACUUM: &str = "vacuum";

/// Every medium of the document, after vacuum.
pub fn media(shop: &mut Shop) -> Vec<Filling> {
    let vacuum = Filling { label: VACUUM.into(), medium: empty() };
    let mut media = vec![vacuum];
    let lines = lines(shop.document);
    let light = light(shop.document, BULK_POINTS);
    let band = band(shop.document);
    for (name, written) in shop.document.system.media.iter() {
        // What cannot be read is noted, and the system refused; until then its place is kept.
        let medium = medium(shop, written, &light, &format!("media[{name:?}]"));
        let medium = medium.map_or_else(empty, |medium| Arc::new(Remembered::new(medium, &lines, band)));
        media.push(Filling { label: name.into(), medium });
    }
    media
}

/// Vacuum wavelengths (m) that the sources have as lines; none if they are too many to be searched one by one.
pub fn lines(document: &written::Document) -> Vec<f64> {
    const MOST: usize = 8;
    let mut lines = Vec::new();
    for spectrum in document.system.spectra() {
        match spectrum {
            written::Spectrum::Line(wavelength) => lines.push(wavelength.0),
            written::Spectrum::Lines(shares) => lines.extend(shares.iter().map(|(wavelength, _)| wavelength.0)),
            _ => {}
        }
    }
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    if lines.len() > MOST { Vec::new() } else { lines }
}

/// Wavelengths of a continuous spectrum at which scatter in media is worked out.
const BULK_POINTS: u32 = 48;

/// Least and greatest vacuum wavelength (m) of the continuous spectra of the sources, and of lines that are too many.
pub fn band(document: &written::Document) -> Option<[f64; 2]> {
    let lines = lines(document);
    let ends = |spectrum: &written::Spectrum| match spectrum {
        written::Spectrum::Line(_) => Vec::new(),
        written::Spectrum::Lines(_) if !lines.is_empty() => Vec::new(),
        written::Spectrum::Lines(shares) => shares.iter().map(|(wavelength, _)| wavelength.0).collect(),
        written::Spectrum::Band { from, to } | written::Spectrum::BlackBody { from, to, .. } => vec![from.0, to.0],
        written::Spectrum::Table { wavelength, .. } => wavelength.iter().map(|wavelength| wavelength.0).collect(),
    };
    let ends = document.system.spectra().flat_map(ends);
    ends.map(|end| [end; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// Vacuum wavelengths (m, rising) at which what is costly is worked out: the lines of the sources, and of continuous spectra as many
/// `points` from the least to the greatest wavelength of all of them.
pub fn light(document: &written::Document, points: u32) -> Vec<f64> {
    let mut light = lines(document);
    if let Some([from, to]) = band(document) {
        light.extend((0..points).map(|i| from + (to - from) * f64::from(i) / f64::from(points - 1)));
    }
    light.sort_by(f64::total_cmp);
    light.dedup();
    light
}

fn empty() -> Arc<dyn Medium> {
    Arc::new(medium::Constant::transparent(1.0))
}

/// `None`: what is wrong with it has been noted.
fn medium(shop: &mut Shop, written: &written::Medium, light: &[f64], path: &str) -> Option<Box<dyn Medium>> {
    Some(match written {
        written::Medium::Constant { n, k, absorption } => {
            let loss = match (k, absorption) {
                (_, Some(alpha)) => medium::Loss::Absorption(alpha.0),
                (k, None) => medium::Loss::Extinction(k.unwrap_or(0.0)),
            };
            Box::new(medium::Constant { n: *n, loss })
        }
        written::Medium::Sellmeier { b, c } => {
            let terms = b.iter().zip(c).map(|(b, c)| (*b, c.0)).collect();
            Box::new(medium::Sellmeier { terms, range: None })
        }
        written::Medium::Tabulated { wavelength, n, k, absorption } => {
            let wavelength: Vec<f64> = wavelength.iter().map(|w| w.0).collect();
            let k = match (k, absorption) {
                (_, Some(alpha)) => alpha.iter().zip(&wavelength).map(|(a, w)| medium::extinction(a.0, *w)).collect(),
                (k, None) => k.clone().unwrap_or_else(|| vec![0.0; n.len()]),
            };
            let table = medium::Tabulated::new(wavelength, n, &k);
            if table.is_none() {
                shop.fault(path, Problem::error("this table cannot be interpolated"));
            }
            Box::new(table?)
        }
        written::Medium::Air { temperature, pressure } => Box::new(medium::Air::new(temperature.0, pressure.0)),
        written::Medium::Glass(name) => Box::new(noted(shop, Shelf::Glass.medium(name), path)?),
        written::Medium::Metal(name) => Box::new(noted(shop, Shelf::Metal.medium(name), path)?),
        written::Medium::Material(name) => Box::new(noted(shop, Shelf::Material.medium(name), path)?),
        written::Medium::RefractiveIndexInfo { file } => {
            let text = String::from_utf8_lossy(&load(shop, file, path)?).into_owned();
            let page = page::parse(&text, &file.display().to_string());
            Box::new(read(shop, page, file, path)?.medium)
        }
        written::Medium::Agf { file, glass } => {
            let text = agf::decode(&load(shop, file, path)?);
            let glass = agf::parse(&text, glass, &file.display().to_string());
            Box::new(read(shop, glass, file, path)?.medium)
        }
        written::Medium::Turbid { host, scatter } => {
            let host = medium(shop, host, light, &format!("{path}.host"))?;
            let bulk = bulk(shop, scatter, host.as_ref(), light, &format!("{path}.scatter"))?;
            Box::new(medium::Turbid { host, bulk })
        }
    })
}

/// What scatters in a host; `None`: what is wrong with it has been noted.
fn bulk(
    shop: &mut Shop,
    written: &written::Bulk,
    host: &dyn Medium,
    light: &[f64],
    path: &str,
) -> Option<Box<dyn bulk::Bulk>> {
    let spectrum = |rows: &written::OverWavelength| bulk::Spectrum::new(&rows.0);
    Some(match written {
        written::Bulk::HenyeyGreenstein { coefficient, g } => {
            Box::new(bulk::HenyeyGreenstein { coefficient: spectrum(coefficient)?, g: *g })
        }
        written::Bulk::Rayleigh { coefficient, at } => {
            Box::new(bulk::Rayleigh { coefficient: coefficient.0, at: at.0 })
        }
        written::Bulk::PhaseTable { coefficient, values } => {
            let mut rows: Vec<(f64, f64)> = values.iter().map(|(angle, value)| (angle.0.cos(), *value)).collect();
            rows.reverse();
            let cosines = bulk::Cosines::new(&rows);
            if cosines.is_none() {
                shop.fault(path, Problem::error("this phase function cannot be normalised"));
            }
            Box::new(bulk::Tabulated { coefficient: spectrum(coefficient)?, cosines: cosines? })
        }
        written::Bulk::Spheres { medium: spheres, diameter, fraction } => {
            let spheres = medium(shop, spheres, light, &format!("{path}.medium"))?;
            Box::new(bulk::Spheres::filling(spheres.as_ref(), host, diameter.0, *fraction, light))
        }
    })
}

/// The bytes of a file that the document names at `path`, noted as an input.
pub fn load(shop: &mut Shop, file: &Path, path: &str) -> Option<Vec<u8>> {
    let bytes = noted(shop, shop.document.load(file), path)?;
    shop.input(&file.display().to_string(), &bytes);
    Some(bytes)
}

/// What was made of the written medium at `path`, or its problem noted.
fn noted<T>(shop: &mut Shop, outcome: Result<T, Problem>, path: &str) -> Option<T> {
    outcome.map_err(|problem| shop.fault(path, problem)).ok()
}

/// What was made of the content of a file, or its problem noted: in the file, or where the document names the file.
pub fn read<T>(shop: &mut Shop, outcome: Result<T, Problem>, file: &Path, path: &str) -> Option<T> {
    let whole = |problem: Problem| {
        let message = format!("{:?}: {}", file.display().to_string(), problem.message);
        Problem { message, ..problem }
    };
    let note = |problem: Problem| match problem.span {
        Some(_) => shop.problems.push(problem.in_file(shop.document.resolve(file))),
        None => shop.fault(path, whole(problem)),
    };
    outcome.map_err(note).ok()
}

/// Index of the ambient medium.
pub fn ambient(document: &written::Document) -> u16 {
    let system = &document.system;
    // Vacuum stands before the media of the document.
    system.media.position(&system.ambient).map_or(0, |position| position as u16 + 1)
}
