//! Scatter models and finishes: from what the document says to what light meets.

use super::Shop;
use super::coatings::{Coatings, faces};
use super::media::load;
use crate::bsdf::{self, Bsdf};
use crate::coating::Side;
use crate::error::{Problem, Span};
use crate::scene::Filling;
use crate::surface::{Order, Scattering, Surface};
use crate::system::document as written;
use std::path::Path;

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
    /// The side it is on, of a coating that is not the same from both.
    pub side: Option<Side>,
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
    pub fn surface(&self, shop: &mut Shop, media: &[Filling], coatings: &Coatings) -> Surface {
        let found = match &self.coating {
            Some(name) => coatings.get(name).cloned(),
            None => {
                let written = self.specular.and_then(written::Specular::coating);
                written.and_then(|written| faces(shop, &written, media, "surfaces"))
            }
        };
        let specular = found.map(|[front, back]| if self.side == Some(Side::Back) { back } else { front });
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
        Surface::new(self.label(), specular, lobes, order, scattering)
    }
}
