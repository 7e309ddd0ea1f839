//! Media, coatings and scatter models: from what the document says to what light meets.

use super::Shop;
use crate::bsdf::{self, Bsdf};
use crate::coating::{self, Coating};
use crate::error::{Problem, Span};
use crate::medium::catalog::Shelf;
use crate::medium::{self, Medium, agf, page};
use crate::scene::Filling;
use crate::surface::{Order, Scattering, Surface};
use crate::system::document as written;
use num_complex::Complex64;
use std::path::Path;

/// The medium that is always there.
pub const VACUUM: &str = "vacuum";

/// Every medium of the document, after vacuum.
pub fn media(shop: &mut Shop) -> Vec<Filling> {
    let vacuum = Filling { label: VACUUM.into(), medium: Box::new(medium::Constant::transparent(1.0)) };
    let mut media = vec![vacuum];
    for (name, written) in shop.document.system.media.iter() {
        media.extend(
            medium(shop, written, &format!("media[{name:?}]")).map(|medium| Filling { label: name.into(), medium }),
        );
    }
    media
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
        written::Medium::Air { temperature, pressure } => {
            Box::new(medium::Air { temperature: temperature.0, pressure: pressure.0 })
        }
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
    match shelf.find(name).and_then(|entry| entry.medium()) {
        Ok(medium) => Some(Box::new(medium)),
        Err(problem) => {
            shop.fault(path, problem);
            None
        }
    }
}

/// The bytes of a file that the document names at `path`, noted as an input.
fn load(shop: &mut Shop, file: &Path, path: &str) -> Option<Vec<u8>> {
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

/// The interface that a coating names.
pub fn coating(written: written::Coating) -> Box<dyn Coating> {
    match written {
        written::Coating::Fresnel => Box::new(coating::Bare),
        written::Coating::Ideal { reflectance, transmittance } => {
            Box::new(coating::Ideal { reflectance, transmittance })
        }
        written::Coating::Mirror { reflectance } => Box::new(coating::Mirror { reflectance }),
        written::Coating::Metal { n, k } => Box::new(coating::Metal { index: Complex64::new(n, k) }),
    }
}

/// The lobes of a scatter model; tables are read from their files.
pub fn lobes(shop: &mut Shop, written: &written::Scatter, path: &str) -> Vec<Box<dyn Bsdf>> {
    match written {
        written::Scatter::Lambertian { reflectance, transmittance } => {
            // A diffuser that passes light is two lobes, one on each side: the coating may scale them apart.
            let lobe =
                |[r, t]: [f64; 2]| -> Box<dyn Bsdf> { Box::new(bsdf::Lambertian { reflectance: r, transmittance: t }) };
            let both = [[*reflectance, 0.0], [0.0, *transmittance]];
            both.into_iter().filter(|sides| *sides != [0.0; 2]).map(lobe).collect()
        }
        written::Scatter::ABg { a, .. } if *a == 0.0 => Vec::new(),
        written::Scatter::ABg { a, b, g, side } => {
            let side = match side {
                written::ScatterSide::Reflect => bsdf::Side::Reflect,
                written::ScatterSide::Transmit => bsdf::Side::Transmit,
            };
            vec![Box::new(bsdf::Abg::new(*a, *b, *g, side))]
        }
        written::Scatter::Table { file, scale } => table(shop, file, *scale, path).into_iter().collect(),
        written::Scatter::Sum(parts) => {
            parts.iter().enumerate().flat_map(|(i, part)| lobes(shop, part, &format!("{path}[{i}]"))).collect()
        }
    }
}

fn table(shop: &mut Shop, file: &Path, scale: f64, path: &str) -> Option<Box<dyn Bsdf>> {
    let resolved = shop.document.resolve(file);
    let text = String::from_utf8_lossy(&load(shop, file, path)?).into_owned();
    let table = match bsdf::speos::parse(&text) {
        Ok(table) => table,
        Err(faults) => {
            let place = |line: usize| Span { line: line as u32, column: 1, len: 1 };
            let problem = |fault: bsdf::speos::Problem| {
                Problem::error(fault.message).expecting(fault.expected).at(place(fault.line)).in_file(&resolved)
            };
            shop.problems.extend(faults.into_iter().map(problem));
            return None;
        }
    };
    match bsdf::Tabulated::new(table, scale) {
        Ok(table) => Some(Box::new(table)),
        Err(bright) => {
            shop.fault(path, Problem::error(bright.to_string()));
            None
        }
    }
}

/// What one side of a part is, with every field settled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finish {
    /// `None`: nothing was said.
    pub specular: Option<written::Specular>,
    pub coating: Option<String>,
    pub scatter: Option<String>,
    pub order: written::Order,
    pub scattering: written::Scattering,
}

impl Finish {
    /// True if nothing was said about what the surface does.
    pub fn is_unsaid(&self) -> bool {
        self.specular.is_none() && self.coating.is_none() && self.scatter.is_none()
    }

    /// "Fresnel", "coating ar + scatter black", ... for people.
    pub fn label(&self) -> String {
        let specular = match (&self.specular, &self.coating) {
            (_, Some(name)) => format!("coating {name}"),
            (Some(specular), None) => format!("{specular:?}"),
            (None, None) => "Absorb".into(),
        };
        let scatter = self.scatter.as_ref().map(|name| format!(" + scatter {name}")).unwrap_or_default();
        specular + &scatter
    }

    /// The surface that light meets.
    pub fn surface(&self, shop: &mut Shop) -> Surface {
        let named = |name: &String| shop.document.system.coatings.get(name).copied();
        let specular = match &self.coating {
            Some(name) => named(name),
            None => self.specular.and_then(written::Specular::coating),
        };
        let document = shop.document;
        let scatter = self.scatter.as_ref().and_then(|name| Some((name, document.system.scatter.get(name)?)));
        let lobes = scatter.map_or(Vec::new(), |(name, model)| lobes(shop, model, &format!("scatter[{name:?}]")));
        let order = match self.order {
            written::Order::ScatterFirst => Order::ScatterFirst,
            written::Order::Scaled => Order::Scaled,
            written::Order::Total => Order::Total,
        };
        let scattering = match self.scattering {
            written::Scattering::On => Scattering::On,
            written::Scattering::Off => Scattering::Off,
        };
        Surface::new(self.label(), specular.map(coating), lobes, order, scattering)
    }
}

/// Index of the ambient medium.
pub fn ambient(document: &written::Document) -> u16 {
    let system = &document.system;
    // Vacuum stands before the media of the document.
    system.media.position(&system.ambient).map_or(0, |position| position as u16 + 1)
}
