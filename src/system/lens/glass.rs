//! Glasses of a lens file: in the catalogue by whatever spelling, or by the few numbers that the file gives.

use crate::error::Problem;
use crate::medium::air::{Air, ROOM};
use crate::medium::catalog::{Entry, Shelf};
use crate::prescription::Material;

/// What lens files call materials that are no glasses, and their entries.
const CRYSTALS: [(&str, &str); 9] = [
    ("SILICA", "SiO2:Malitson"),
    ("FSILICA", "SiO2:Malitson"),
    ("CAF2", "CaF2"),
    ("MGF2", "MgF2"),
    ("SAPPHIRE", "Al2O3"),
    ("GERMANIUM", "Ge"),
    ("ZNSE", "ZnSe"),
    ("ZNS", "ZnS"),
    ("ZNSBROAD", "ZnS"),
];

/// Wavelengths of the C, d and F lines, m.
const LINES: [f64; 3] = [656.272_5e-9, 587.561_8e-9, 486.132_7e-9];

/// Real index relative to air at a wavelength (m) as lens files write it; `None` if the glass is not known.
pub fn index(material: &Material, wavelength: f64) -> Option<f64> {
    match material {
        Material::Air => Some(1.0),
        Material::Mirror | Material::Previous => None,
        Material::Glass { name, maker } => {
            let medium = find(name, maker.as_deref()).ok()?.medium().ok()?;
            // Only glasses and crystals measured in air are printed relative to it.
            Some(medium.printed(wavelength).re)
        }
        Material::Model { nd, vd } => Some(model(*nd, *vd, wavelength)),
        Material::Private { indices, .. } => {
            let above = indices.partition_point(|(w, _)| *w <= wavelength).clamp(1, indices.len().max(2) - 1);
            let (low, high) = (indices.get(above - 1)?, indices.get(above).or(indices.last())?);
            let t = if high.0 > low.0 { (wavelength - low.0) / (high.0 - low.0) } else { 0.0 };
            Some(low.1 + t * (high.1 - low.1))
        }
    }
}

/// The vacuum wavelength (m) of light that has this wavelength in air, and the index of that air: design programs and glass
/// catalogues count wavelengths in air.
pub fn vacuum(wavelength: f64) -> (f64, f64) {
    let air = Air::at(ROOM);
    // The index changes by 1e-8 over the difference: two rounds are enough.
    let index = (0..3).fold(1.0, |n, _| 1.0 + air.refractivity(wavelength * n));
    (wavelength * index, index)
}

/// n_d + (n_d - 1) / V_d times the share of the dispersion between F and C, linear in 1 / lambda^2 (Cauchy's first term).
pub fn model(nd: f64, vd: f64, wavelength: f64) -> f64 {
    let inverse = |w: f64| 1.0 / (w * w);
    let [c, d, f] = LINES.map(inverse);
    let slope = if vd.is_finite() && vd != 0.0 { (nd - 1.0) / vd } else { 0.0 };
    nd + slope * (inverse(wavelength) - d) / (f - c)
}

/// The catalogue entry of a glass; hyphens, blanks and case do not count, as design programs leave them out.
pub fn find(name: &str, maker: Option<&str>) -> Result<Entry, Problem> {
    let plain = |text: &str| -> String {
        text.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_ascii_uppercase()
    };
    let wanted = plain(name);
    let same = |entry: &Entry| {
        let made = entry.name.split_once(':').map_or("", |(maker, _)| maker);
        plain(entry.short()) == wanted && maker.is_none_or(|maker| plain(made) == plain(maker))
    };
    let found = || Shelf::Glass.entries().filter(same);
    // Several makers: the first of Schott, Hoya, Ohara, as the glass was named first by Schott in most cases.
    let first = ["SCHOTT", "HOYA", "OHARA"].into_iter().find_map(|maker| found().find(|e| e.name.starts_with(maker)));
    let crystal =
        || CRYSTALS.iter().find(|(alias, _)| *alias == wanted).and_then(|(_, name)| Shelf::Material.find(name).ok());
    first.or_else(|| found().next()).or_else(crystal).ok_or_else(|| {
        Problem::error(format!("the built-in catalogue has no glass {name}"))
            .expecting("a glass of SCHOTT, OHARA or HOYA, or its index in the file")
    })
}
