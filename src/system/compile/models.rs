//! Coatings and scatter models: from what the document says to what light meets.

use super::Shop;
use super::media::load;
use crate::bsdf::{self, Bsdf};
use crate::coating::{self, Coating};
use crate::error::{Problem, Span};
use crate::scene::Filling;
use crate::surface::{Order, Scattering, Surface};
use crate::system::document as written;
use num_complex::Complex64;
use std::path::Path;

/// The interface that a coating names.
pub fn coating(written: &written::Coating, media: &[Filling]) -> Box<dyn Coating> {
    match written {
        written::Coating::Fresnel => Box::new(coating::Bare),
        written::Coating::Ideal { reflectance, transmittance } => {
            Box::new(coating::Ideal { reflectance: *reflectance, transmittance: *transmittance })
        }
        written::Coating::Mirror { reflectance } => Box::new(coating::Mirror { reflectance: *reflectance }),
        written::Coating::Metal { n, k } => Box::new(coating::Metal { index: Complex64::new(*n, *k) }),
        written::Coating::Opaque { medium } => {
            // Every name is defined: the document has been checked.
            let filling = media.iter().find(|filling| filling.label == *medium).unwrap_or(&media[0]);
            Box::new(coating::Opaque { medium: filling.medium.clone() })
        }
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
        written::Scatter::Table { file, scale, unmeasured } => {
            table(shop, file, *scale, *unmeasured, path).into_iter().collect()
        }
        written::Scatter::Sum(parts) => {
            parts.iter().enumerate().flat_map(|(i, part)| lobes(shop, part, &format!("{path}[{i}]"))).collect()
        }
    }
}

fn table(
    shop: &mut Shop,
    file: &Path,
    scale: f64,
    unmeasured: written::Unmeasured,
    path: &str,
) -> Option<Box<dyn Bsdf>> {
    let resolved = shop.document.resolve(file);
    let text = String::from_utf8_lossy(&load(shop, file, path)?).into_owned();
    let rule = match unmeasured {
        written::Unmeasured::Zero => bsdf::reading::Unmeasured::Zero,
        written::Unmeasured::Hold => bsdf::reading::Unmeasured::Hold,
    };
    let table = match bsdf::reading::parse(&text, rule) {
        Ok(table) => table,
        Err(faults) => {
            let place = |line: usize| Span { line: line as u32, column: 1, len: 1 };
            let problem = |fault: bsdf::reading::Problem| {
                Problem::error(fault.message).expecting(fault.expected).at(place(fault.line)).in_file(&resolved)
            };
            shop.problems.extend(faults.into_iter().map(problem));
            return None;
        }
    };
    contradictions(shop, &table, path);
    match bsdf::Tabulated::new(table, scale) {
        Ok(table) => Some(Box::new(table)),
        Err(bright) => {
            shop.fault(path, Problem::error(bright.to_string()));
            None
        }
    }
}

/// Says where a file states another TIS than its values integrate to.
fn contradictions(shop: &mut Shop, table: &bsdf::tabulated::Table, path: &str) {
    const APART: f64 = 0.05;
    let apart = |[stated, found]: [f64; 2]| (stated - found).abs() > APART * stated.max(found);
    let said: Vec<String> = table
        .totals()
        .filter(|(_, totals)| apart(*totals))
        .map(|(incidence, [stated, found])| {
            let percent = |share: f64| format!("{:.1}", 100.0 * share);
            format!("{} % at {:.0} deg (integral {} %)", percent(stated), incidence.to_degrees(), percent(found))
        })
        .collect();
    if !said.is_empty() {
        let what = format!("the file states a TIS that its values do not integrate to: {}", said.join(", "));
        shop.fault(path, Problem::warning(what).hinting("the stated TIS is used, the values are its shape".to_owned()));
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
    pub fn surface(&self, shop: &mut Shop, media: &[Filling]) -> Surface {
        let named = |name: &String| shop.document.system.coatings.get(name).cloned();
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
        Surface::new(self.label(), specular.map(|written| coating(&written, media)), lobes, order, scattering)
    }
}
