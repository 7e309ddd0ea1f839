//! Media: from what the document says to what fills a volume.

use super::Shop;
use crate::error::Problem;
use crate::medium::catalog::Shelf;
use crate::medium::{self, Medium, agf, page};
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
    for (name, written) in shop.document.system.media.iter() {
        // What cannot be read is noted, and the system refused; until then its place is kept.
        let medium = medium(shop, written, &format!("media[{name:?}]")).map_or_else(empty, Arc::from);
        media.push(Filling { label: name.into(), medium });
    }
    media
}

fn empty() -> Arc<dyn Medium> {
    Arc::new(medium::Constant::transparent(1.0))
}

/// `None`: what is wrong with it has been noted.
fn medium(shop: &mut Shop, written: &written::Medium, path: &str) -> Option<Box<dyn Medium>> {
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
        written::Medium::Tabulated { wavelength, n, k } => {
            let wavelength: Vec<f64> = wavelength.iter().map(|w| w.0).collect();
            let k = k.clone().unwrap_or_else(|| vec![0.0; n.len()]);
            let table = medium::Tabulated::new(wavelength, n, &k);
            if table.is_none() {
                shop.fault(path, Problem::error("this table cannot be interpolated"));
            }
            Box::new(table?)
        }
        written::Medium::Air { temperature, pressure } => Box::new(medium::Air::new(temperature.0, pressure.0)),
        written::Medium::Glass(name) => catalogued(shop, Shelf::Glass, name, path)?,
        written::Medium::Metal(name) => catalogued(shop, Shelf::Metal, name, path)?,
        written::Medium::Material(name) => catalogued(shop, Shelf::Material, name, path)?,
        written::Medium::RefractiveIndexInfo { file } => {
            let text = String::from_utf8_lossy(&load(shop, file, path)?).into_owned();
            let page = page::parse(&text, &file.display().to_string());
            Box::new(read(shop, page, file)?.medium)
        }
        written::Medium::Agf { file, glass } => {
            let text = agf::decode(&load(shop, file, path)?);
            let glass = agf::parse(&text, glass, &file.display().to_string());
            Box::new(read(shop, glass, file)?.medium)
        }
    })
}

/// A medium of the built-in catalogue.
fn catalogued(shop: &mut Shop, shelf: Shelf, name: &str, path: &str) -> Option<Box<dyn Medium>> {
    match shelf.medium(name) {
        Ok(medium) => Some(Box::new(medium)),
        Err(problem) => {
            shop.fault(path, problem);
            None
        }
    }
}

/// The bytes of a file that the document names at `path`, noted as an input.
pub fn load(shop: &mut Shop, file: &Path, path: &str) -> Option<Vec<u8>> {
    match shop.document.load(file) {
        Ok(bytes) => {
            shop.input(&file.display().to_string(), &bytes);
            Some(bytes)
        }
        Err(problem) => {
            shop.fault(path, problem);
            None
        }
    }
}

/// What was read from a file, or its problem noted.
fn read<T>(shop: &mut Shop, outcome: Result<T, Problem>, file: &Path) -> Option<T> {
    outcome.map_err(|problem| shop.problems.push(problem.in_file(shop.document.resolve(file)))).ok()
}

/// Index of the ambient medium.
pub fn ambient(document: &written::Document) -> u16 {
    let system = &document.system;
    // Vacuum stands before the media of the document.
    system.media.position(&system.ambient).map_or(0, |position| position as u16 + 1)
}
