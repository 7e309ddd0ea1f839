//! Scatter models: from what the document says to the lobes that light meets.

use super::Shop;
use super::lights::Light;
use super::media::{self, load};
use crate::bsdf::contamination::{Deposit, distribution};
use crate::bsdf::klems::{Face, Matrix};
use crate::bsdf::tabulated::{Table, TooBright};
use crate::bsdf::{self, Bsdf, finish};
use crate::coating::Side;
use crate::error::{Problem, Span};
use crate::medium;
use crate::optics::Incidence;
use crate::system::document as written;
use crate::system::units::{Frequency, PowerDensity};
use glam::DVec2;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Wavelengths of a continuous spectrum at which particles are worked out: half a second each.
const DEPOSIT_POINTS: u32 = 6;

/// The lobes of a scatter model for light on one side of the surface; tables are read from their files.
pub fn lobes(shop: &mut Shop, written: &written::Scatter, side: Side, path: &str) -> Vec<Box<dyn Bsdf>> {
    match written {
        written::Scatter::Lambertian { reflectance, transmittance } => {
            // A diffuser that passes light is two lobes, one on each side: the coating may scale them apart.
            let lobe =
                |[r, t]: [f64; 2]| -> Box<dyn Bsdf> { Box::new(bsdf::Lambertian { reflectance: r, transmittance: t }) };
            let both = [[*reflectance, 0.0], [0.0, *transmittance]];
            both.into_iter().filter(|sides| *sides != [0.0; 2]).map(lobe).collect()
        }
        written::Scatter::Table { file, scale, unmeasured } => table(shop, file, *scale, *unmeasured, path),
        written::Scatter::Finish(name) => match finish::find(name).and_then(finish::Finish::lobes) {
            Ok(lobes) => lobes,
            Err(problem) => {
                shop.fault(path, problem);
                Vec::new()
            }
        },
        written::Scatter::Klems { file, scale, band } => {
            let face = if side == Side::Front { Face::Front } else { Face::Back };
            klems(shop, (file, band), *scale, face, path)
        }
        written::Scatter::Sum(parts) => {
            parts.iter().enumerate().flat_map(|(i, part)| lobes(shop, part, side, &format!("{path}[{i}]"))).collect()
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

/// The lobes of the scatter model `name`, at the level that the document wants it.
pub fn levelled(shop: &mut Shop, name: &str, written: &written::Scatter, side: Side) -> Vec<Box<dyn Bsdf>> {
    let path = format!("scatter[{name:?}]");
    let lobes = lobes(shop, written, side, &path);
    let factor = shop.document.system.level.of(name);
    if factor == 1.0 || written.has_facets() {
        return lobes;
    }
    let scaled = |lobe| -> Box<dyn Bsdf> { Box::new(bsdf::Scaled { lobe, factor }) };
    let lobes: Vec<Box<dyn Bsdf>> = lobes.into_iter().map(scaled).collect();
    // Every ten degrees, and close to grazing.
    let angles = (0..9).map(|step| 10.0 * f64::from(step)).chain([85.0]);
    for (wavelength, degrees) in
        media::light(shop.document, 2).into_iter().flat_map(|w| angles.clone().map(move |a| (w, a)))
    {
        let at = Incidence { lay: DVec2::X, ..Incidence::in_air(degrees.to_radians(), wavelength) };
        let tis: f64 = lobes.iter().map(|lobe| lobe.albedo(&at)).sum();
        if tis > 1.0 + 1e-9 {
            let what = format!("{factor} times this scatters {:.0} % of the light at {degrees} deg", 100.0 * tis);
            shop.fault(&path, Problem::error(what).expecting("a bracket whose factors keep it below 100 %"));
            break;
        }
    }
    lobes
}

/// The particles of a model, if it has some; made once for every name.
pub fn deposit(shop: &mut Shop, name: &str, written: &written::Scatter, path: &str) -> Option<Arc<Deposit>> {
    if let Some(known) = shop.deposits.get(name) {
        return Some(known.clone());
    }
    let light = media::light(shop.document, DEPOSIT_POINTS);
    let deposit = Arc::new(particles(written, &light, shop.document.system.level.of(name))?);
    if deposit.extinction(light[0]) > 0.5 {
        let covered = format!("these particles cover {:.0} % of the surface", 100.0 * deposit.coverage);
        let hint = "the layer is treated as dilute: no particle shades another";
        shop.fault(path, Problem::warning(covered).hinting(hint.to_owned()));
    }
    shop.deposits.insert(name.to_owned(), deposit.clone());
    Some(deposit)
}

/// The particles of a model, `factor` times as many as it says, worked out at these vacuum wavelengths (m, rising).
pub fn particles(written: &written::Scatter, light: &[f64], factor: f64) -> Option<Deposit> {
    let written::Scatter::Contamination { level, slope, smallest, largest, bins, n, k } = written.contamination()?
    else {
        return None;
    };
    let mut sizes: Vec<(f64, f64)> = match bins {
        // Counted, like the levels, on a tenth of a square metre.
        Some(bins) => bins.iter().map(|(diameter, number)| (diameter.0, 10.0 * number)).collect(),
        None => distribution(*level, *slope, [smallest.0, largest.0]),
    };
    sizes.iter_mut().for_each(|(_, number)| *number *= factor);
    let dust = medium::Constant { n: *n, loss: medium::Loss::Extinction(*k) };
    // Nothing lies on it: no deposit.
    sizes.iter().any(|(_, number)| *number > 0.0).then(|| Deposit::new(&dust, &sizes, light))
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
        written::Scatter::Finish(name) => {
            Some(bsdf::Polish::new(finish::find(name).ok()?.polish()?, reflect).rms(1.0 / wavelength))
        }
        written::Scatter::Sum(parts) => parts.iter().find_map(|part| rms(part, wavelength)),
        _ => None,
    }
}

/// What is assumed of the finishes of the library that a document names, each once.
pub fn assumptions(document: &written::Document) -> Vec<String> {
    let named = document.system.scatter.iter().flat_map(|(_, written)| written.finishes());
    let lines: BTreeSet<String> = named.map(finish::Finish::assumption).collect();
    lines.into_iter().collect()
}

/// Notes finishes of the library that are used beyond the wavelengths for which they hold.
pub fn ranges(shop: &mut Shop, lights: &[Light]) {
    let document = shop.document;
    for (name, written) in document.system.scatter.iter() {
        let low = lights.iter().map(|light| light.range[0]).fold(f64::INFINITY, f64::min);
        let high = lights.iter().map(|light| light.range[1]).fold(0.0, f64::max);
        let doubts = written.finishes().into_iter().filter_map(|finish| finish.doubt([low, high]));
        doubts.for_each(|doubt| shop.fault(&format!("scatter[{name:?}]"), doubt));
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

/// The lobes of a file: what is reflected, what is transmitted.
fn table(shop: &mut Shop, file: &Path, scale: f64, unmeasured: written::Unmeasured, path: &str) -> Vec<Box<dyn Bsdf>> {
    let rule = match unmeasured {
        written::Unmeasured::Zero => bsdf::reading::Unmeasured::Zero,
        written::Unmeasured::Hold => bsdf::reading::Unmeasured::Hold,
    };
    let Some(tables) = read(shop, file, path, |text| bsdf::reading::parse(text, rule)) else { return Vec::new() };
    tables.iter().for_each(|table| contradictions(shop, table, path));
    let (passed, reflected): (Vec<Table>, Vec<Table>) = tables.into_iter().partition(Table::is_transmitted);
    let made: Result<Vec<Box<dyn Bsdf>>, _> = [reflected, passed]
        .into_iter()
        .filter(|tables| !tables.is_empty())
        .map(|tables| measured_lobe(tables, scale))
        .collect();
    made.unwrap_or_else(|bright| {
        shop.fault(path, Problem::error(bright.to_string()));
        Vec::new()
    })
}

/// The lobe of tables (at least one) for light that goes one way.
fn measured_lobe(mut tables: Vec<Table>, scale: f64) -> Result<Box<dyn Bsdf>, TooBright> {
    Ok(if tables.len() == 1 {
        Box::new(bsdf::Tabulated::new(tables.remove(0), scale)?)
    } else {
        Box::new(bsdf::Anisotropic::new(tables, scale)?)
    })
}

/// What a reader makes of the text of a file; its complaints are noted.
fn read<T>(
    shop: &mut Shop,
    file: &Path,
    path: &str,
    parse: impl FnOnce(&str) -> Result<T, Vec<bsdf::reading::Problem>>,
) -> Option<T> {
    let resolved = shop.document.resolve(file);
    let bytes = load(shop, file, path)?;
    let noted = |fault: bsdf::reading::Problem| {
        let place = Span { line: fault.line as u32, column: 1, len: 1 };
        Problem::error(fault.message).expecting(fault.expected).at(place).in_file(&resolved)
    };
    parse(&String::from_utf8_lossy(&bytes)).map_err(|faults| shop.problems.extend(faults.into_iter().map(noted))).ok()
}

/// The lobes of a sheet for light on one face: what it reflects and what it passes.
fn klems(shop: &mut Shop, (file, band): (&Path, &str), scale: f64, face: Face, path: &str) -> Vec<Box<dyn Bsdf>> {
    let Some(mut matrices) = read(shop, file, path, |text| bsdf::klems_xml::parse(text, band)) else {
        return Vec::new();
    };
    matrices.retain(|matrix| matrix.face == face);
    let most = scale * brightest(&matrices);
    // As bright as the rounding of six decimals in each patch can make it.
    if most > 1.0 + 1e-5 {
        let what = format!("light on the {face:?} leaves with {:.1} % of its flux", 100.0 * most).to_lowercase();
        shop.fault(path, Problem::error(what).expecting("at most 100 %"));
        return Vec::new();
    }
    let lobe = |matrix| -> Box<dyn Bsdf> { Box::new(bsdf::Klems::new(matrix, scale / most.max(1.0))) };
    matrices.into_iter().map(lobe).collect()
}

/// Greatest scattered / incident flux of what a face reflects and passes together.
fn brightest(matrices: &[Matrix]) -> f64 {
    let greatest = |albedo: Vec<f64>| albedo.into_iter().fold(0.0, f64::max);
    match matrices {
        [one, other] if one.incident == other.incident => {
            greatest(one.albedo().iter().zip(other.albedo()).map(|(a, b)| a + b).collect())
        }
        _ => matrices.iter().map(|matrix| greatest(matrix.albedo())).sum(),
    }
}

/// Says where a file states another TIS than its values integrate to.
fn contradictions(shop: &mut Shop, table: &Table, path: &str) {
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
