//! Scatter models: from what the document says to the lobes that light meets.

use super::Shop;
use super::media::load;
use crate::bsdf::{self, Bsdf};
use crate::error::{Problem, Span};
use crate::system::document as written;
use crate::system::units::{Frequency, PowerDensity};
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
        written::Scatter::Table { file, scale } => table(shop, file, *scale, path).into_iter().collect(),
        written::Scatter::Sum(parts) => {
            parts.iter().enumerate().flat_map(|(i, part)| lobes(shop, part, &format!("{path}[{i}]"))).collect()
        }
        written::Scatter::Microfacet { distribution, alpha, facets, side, energy } => {
            let distribution = match distribution {
                written::FacetLaw::Ggx => bsdf::Distribution::Ggx,
                written::FacetLaw::Beckmann => bsdf::Distribution::Beckmann,
            };
            let facets = match facets {
                written::Facets::Interface => bsdf::Facets::Interface,
                written::Facets::Perfect => bsdf::Facets::Perfect,
            };
            let single = bsdf::Microfacet::new(distribution, *alpha, facets, half_space(*side));
            let mut lobes: Vec<Box<dyn Bsdf>> = vec![Box::new(single)];
            if *energy == written::FacetEnergy::Compensated {
                lobes.push(Box::new(bsdf::Compensation::new(distribution, *alpha, facets)));
            }
            lobes
        }
        formula => lobe(formula).into_iter().collect(),
    }
}

/// The lobe of a model that is one formula; `None` if it scatters nothing.
fn lobe(formula: &written::Scatter) -> Option<Box<dyn Bsdf>> {
    Some(match formula {
        written::Scatter::ABg { a, b, g, side } if *a > 0.0 => Box::new(bsdf::Abg::new(*a, *b, *g, half_space(*side))),
        written::Scatter::HarveyShack { b0, l, s, side } if *b0 > 0.0 => {
            Box::new(bsdf::Harvey::new(*b0, *l, *s, half_space(*side)))
        }
        written::Scatter::Gaussian { a, sigma, side } if *a > 0.0 => {
            Box::new(bsdf::Gaussian::new(*a, *sigma, half_space(*side)))
        }
        written::Scatter::CosinePower { a, n, about } if *a > 0.0 => {
            Box::new(bsdf::CosinePower::new(*a, *n, axis(*about)))
        }
        written::Scatter::OrenNayar { reflectance, sigma } if *reflectance > 0.0 => {
            Box::new(bsdf::OrenNayar::new(*reflectance, sigma.0))
        }
        written::Scatter::KCorrelation { rms, b, s, side } => {
            Box::new(bsdf::Polish::new(correlation(rms, b.0, *s)?, half_space(*side)))
        }
        written::Scatter::Psd { frequency, density, side } => {
            Box::new(bsdf::Polish::new(measured(frequency, density), half_space(*side)))
        }
        _ => return None,
    })
}

/// `None` for a perfect surface.
fn correlation(rms: &written::Roughness, b: f64, s: f64) -> Option<bsdf::KCorrelation> {
    let (rms, band) = match rms {
        written::Roughness::Total(rms) => (rms.0, [0.0, f64::INFINITY]),
        written::Roughness::Band { rms, from, to } => (rms.0, [from.0, to.0]),
    };
    (rms > 0.0).then(|| bsdf::KCorrelation::new(rms, band, b, s))
}

fn measured(frequency: &[Frequency], density: &[PowerDensity]) -> bsdf::PsdTable {
    let entries: Vec<(f64, f64)> = frequency.iter().map(|f| f.0).zip(density.iter().map(|d| d.0)).collect();
    bsdf::PsdTable::new(&entries)
}

/// Rms height over the spatial frequencies 0 to 1/`wavelength` (m) of the first polished part of a model, m.
pub fn rms(written: &written::Scatter, wavelength: f64) -> Option<f64> {
    let reflect = bsdf::Side::Reflect;
    match written {
        written::Scatter::KCorrelation { rms, b, s, .. } => {
            Some(bsdf::Polish::new(correlation(rms, b.0, *s)?, reflect).rms(1.0 / wavelength))
        }
        written::Scatter::Psd { frequency, density, .. } => {
            Some(bsdf::Polish::new(measured(frequency, density), reflect).rms(1.0 / wavelength))
        }
        written::Scatter::Sum(parts) => parts.iter().find_map(|part| rms(part, wavelength)),
        _ => None,
    }
}

fn half_space(side: written::ScatterSide) -> bsdf::Side {
    match side {
        written::ScatterSide::Reflect => bsdf::Side::Reflect,
        written::ScatterSide::Transmit => bsdf::Side::Transmit,
    }
}

fn axis(about: written::ScatterAxis) -> bsdf::Axis {
    match about {
        written::ScatterAxis::Specular => bsdf::Axis::Specular,
        written::ScatterAxis::Source => bsdf::Axis::Source,
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
