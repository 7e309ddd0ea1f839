//! Coatings: from what the document says to what light meets at the front and at the back of a face.
//!
//! A stack is written from the front of its face, which is the outside of a solid, to its back. Light that arrives at the
//! back meets it in reverse. So a lens is coated from its air side to its glass on both of its faces, in whatever
//! medium it stands; and on a cemented face the stack is counted from the outside of the solid that has the coating.

use super::Shop;
use super::lights::Light;
use super::media::{self, load};
use crate::coating::tabulated::{self, MIRROR, Tabulated};
use crate::coating::{self, Coating, Side, Stack, zemax};
use crate::error::Problem;
use crate::medium::{Medium, agf};
use crate::optics::stack::End;
use crate::scene::Filling;
use crate::system::document as written;
use crate::system::units::Wavelength;
use num_complex::Complex64;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Light does not come from a medium of a larger extinction k: nothing is left of it within micrometres.
const CLEAR: f64 = 0.01;

/// A coating for light that arrives at the front and at the back.
pub type Faces = [Arc<dyn Coating>; 2];

/// All coatings of the document by name.
pub type Coatings = BTreeMap<String, Faces>;

/// Medium and thickness (m) of each layer, from front to back.
type Films = Vec<(Arc<dyn Medium>, f64)>;

/// Makes every coating of the document; what is wrong with one is noted, and it is left out.
pub fn coatings(shop: &mut Shop, media: &[Filling]) -> Coatings {
    let document = shop.document;
    let mut coatings = Coatings::new();
    for (name, written) in document.system.coatings.iter() {
        let path = format!("coatings[{name:?}]");
        if let Some(faces) = faces(shop, written, media, &path) {
            coatings.insert(name.to_owned(), faces);
        }
    }
    coatings
}

/// Both faces of one coating; `path` is where it is written.
pub fn faces(shop: &mut Shop, written: &written::Coating, media: &[Filling], path: &str) -> Option<Faces> {
    // Every name is defined: the document has been checked.
    let filling = |name: &str| media.iter().find(|filling| filling.label == *name).unwrap_or(&media[0]).medium.clone();
    Some(match written {
        written::Coating::Fresnel => alike(coating::Bare),
        written::Coating::Ideal { reflectance, transmittance } => {
            alike(coating::Ideal { reflectance: *reflectance, transmittance: *transmittance })
        }
        written::Coating::Mirror { reflectance } => alike(coating::Mirror { reflectance: *reflectance }),
        written::Coating::Metal { n, k } => alike(coating::Metal { index: Complex64::new(*n, *k) }),
        written::Coating::Opaque { medium } => alike(coating::Opaque { medium: filling(medium) }),
        written::Coating::Splitter { reflectance: (rs, rp), transmittance: (ts, tp) } => {
            alike(coating::Splitter { reflectance: [*rs, *rp], transmittance: [*ts, *tp] })
        }
        written::Coating::Polarizer { axis, transmittance, leakage } => {
            alike(coating::Polarizer { axis: axis.0, transmittance: *transmittance, leakage: *leakage })
        }
        written::Coating::Retarder { axis, retardance } => {
            alike(coating::Retarder { axis: axis.0, retardance: retardance.0 })
        }
        written::Coating::Stack { layers, design, substrate } => {
            let films = films(shop, layers, *design, &filling, path)?;
            stack(shop, films, substrate.as_deref().map(filling), media)
        }
        written::Coating::Table { file, rows } => table(shop, file.as_deref(), rows.as_deref(), path)?,
        written::Coating::Zemax { file, coating, design, substrate } => match zemax_entry(shop, file, coating, path)? {
            zemax::Entry::Ideal { reflectance, transmittance } => alike(coating::Ideal { reflectance, transmittance }),
            zemax::Entry::Table(rows) => tabulated(shop, &rows, path)?,
            zemax::Entry::Films(films) => {
                let films = zemax_films(shop, films, *design, path)?;
                stack(shop, films, substrate.as_deref().map(filling), media)
            }
        },
    })
}

/// A coating of a COATING.DAT file, with what is worth a word about it noted.
fn zemax_entry(shop: &mut Shop, file: &Path, coating: &str, path: &str) -> Option<zemax::Entry> {
    let text = agf::decode(&load(shop, file, path)?);
    let found = media::read(shop, zemax::parse(&text, coating), file, path)?;
    found.warnings.into_iter().for_each(|warning| shop.fault(path, warning));
    Some(found.entry)
}

/// A coating that is the same from both sides.
fn alike(coating: impl Coating + 'static) -> Faces {
    let coating: Arc<dyn Coating> = Arc::new(coating);
    [coating.clone(), coating]
}

fn films(
    shop: &mut Shop,
    layers: &[written::Layer],
    design: Option<Wavelength>,
    filling: &impl Fn(&str) -> Arc<dyn Medium>,
    path: &str,
) -> Option<Films> {
    let mut written = Vec::new();
    layers.iter().for_each(|layer| layer.films(&mut |medium, thickness| written.push((medium, thickness))));
    let mut films = Films::new();
    for (name, thickness) in written {
        let medium = filling(name);
        let thickness = match thickness {
            written::Thickness::Length(thickness) => thickness,
            written::Thickness::Waves(waves) => waves * wave(shop, medium.as_ref(), name, design?.0, path)?,
        };
        films.push((medium, thickness));
    }
    Some(films)
}

fn zemax_films(shop: &mut Shop, films: Vec<zemax::Film>, design: Option<Wavelength>, path: &str) -> Option<Films> {
    let needed = films.iter().any(|film| matches!(film.thickness, zemax::Thickness::Waves(_)));
    if needed && design.is_none() {
        let problem = Problem::error("thicknesses of this coating are in waves, but not of which wavelength");
        shop.fault(path, problem.expecting("`design: \"550 nm\"`, the primary wavelength of the lens file"));
        return None;
    }
    let thick = |film: zemax::Film| {
        let medium: Arc<dyn Medium> = Arc::new(film.material);
        let thickness = match film.thickness {
            zemax::Thickness::Length(thickness) => thickness,
            zemax::Thickness::Waves(waves) => waves * wave(shop, medium.as_ref(), "a material", design?.0, path)?,
        };
        Some((medium, thickness))
    };
    films.into_iter().map(thick).collect()
}

/// Thickness (m) of one wave of the design wavelength (m) in a medium: lambda / n.
fn wave(shop: &mut Shop, medium: &dyn Medium, name: &str, design: f64, path: &str) -> Option<f64> {
    let known = medium.range().is_none_or(|[low, high]| (low..=high).contains(&design));
    let n = medium.index(design).re;
    if known && n > 0.0 && n.is_finite() {
        return Some(design / n);
    }
    let problem = Problem::error(format!("the data of `{name}` do not cover the design wavelength"));
    let already = shop.problems.iter().any(|told| told.message == problem.message);
    if !already {
        shop.fault(&format!("{path}.design"), problem.expecting("a wavelength at which its index is known"));
    }
    None
}

/// The stack as light meets it at the front, and in reverse.
fn stack(shop: &Shop, films: Films, substrate: Option<Arc<dyn Medium>>, media: &[Filling]) -> Faces {
    let mut known: Vec<Arc<dyn Medium>> = Vec::new();
    let mut layers = Vec::new();
    for (medium, thickness) in films {
        let place = known.iter().position(|other| Arc::ptr_eq(other, &medium)).unwrap_or_else(|| {
            known.push(medium);
            known.len() - 1
        });
        layers.push((place, thickness));
    }
    let lines = media::lines(shop.document);
    let clear = |index: &Complex64| index.im < CLEAR;
    let highest = |wavelength: f64| {
        let indices = media.iter().map(|filling| filling.medium.index(wavelength)).filter(clear);
        indices.map(|index| index.re).fold(1.0, f64::max)
    };
    let plain = |layers| Stack::new(known.clone(), layers, substrate.clone());
    let band = media::band(shop.document).and_then(|band| plain(layers.clone()).over(band, highest));
    let ready = |layers, end| -> Arc<dyn Coating> {
        Arc::new(plain(layers).tabulated(&lines, highest).looked_up(band.clone(), end))
    };
    let front = ready(layers.clone(), End::First);
    if substrate.is_some() {
        // Under an opaque substrate there is no light: what arrives from either side meets the layers first.
        return [front.clone(), front];
    }
    [front, ready(layers.into_iter().rev().collect(), End::Last)]
}

fn table(shop: &mut Shop, file: Option<&Path>, rows: Option<&[written::Row]>, path: &str) -> Option<Faces> {
    let Some(file) = file else {
        let row = |&(wavelength, angle, rs, rp, ts, tp): &written::Row| tabulated::Row {
            wavelength: wavelength.0,
            angle: angle.0,
            power: [rs, rp, ts, tp],
            phase: MIRROR,
        };
        let rows: Vec<tabulated::Row> = rows.unwrap_or_default().iter().map(row).collect();
        return tabulated(shop, &rows, path);
    };
    let text = String::from_utf8_lossy(&load(shop, file, path)?).into_owned();
    match tabulated::parse(text.trim_start_matches('\u{feff}')) {
        Ok(rows) => {
            let whole = |problem: Problem| {
                let message = format!("{:?}: {}", file.display().to_string(), problem.message);
                Problem { message, ..problem }
            };
            made(shop, Tabulated::new(&rows, Side::Front).map_err(whole), path)
        }
        Err(problems) => {
            let resolved = shop.document.resolve(file);
            shop.problems.extend(problems.into_iter().map(|problem| problem.in_file(&resolved)));
            None
        }
    }
}

fn tabulated(shop: &mut Shop, rows: &[tabulated::Row], path: &str) -> Option<Faces> {
    made(shop, Tabulated::new(rows, Side::Front), path)
}

fn made(shop: &mut Shop, table: Result<Tabulated, Problem>, path: &str) -> Option<Faces> {
    match table {
        Ok(table) => Some([Arc::new(table.from(Side::Front)), Arc::new(table.from(Side::Back))]),
        Err(problem) => {
            shop.fault(path, problem);
            None
        }
    }
}

/// Notes coatings from files and tables whose data end before the light of the sources does.
pub fn ranges(shop: &mut Shop, coatings: &Coatings, lights: &[Light]) {
    let document = shop.document;
    for (name, written) in document.system.coatings.iter() {
        let own = matches!(written, written::Coating::Table { .. } | written::Coating::Zemax { .. });
        let range = coatings.get(name).filter(|_| own).and_then(|faces| faces[0].range());
        let Some([low, high]) = range else { continue };
        for Light { label, range: light } in lights {
            // The rounding of wavelengths that are typed in other units.
            if light[0] < low * (1.0 - 1e-6) || light[1] > high * (1.0 + 1e-6) {
                let nm = |m: f64| (m * 1e10).round() / 10.0;
                let what = format!("the data of coating `{name}` do not cover the light of `{label}`");
                let expected = format!("wavelengths from {} nm to {} nm", nm(low), nm(high));
                shop.fault(&format!("coatings[{name:?}]"), Problem::error(what).expecting(expected));
            }
        }
    }
}
