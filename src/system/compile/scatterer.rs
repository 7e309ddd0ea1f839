//! One scatter model by itself, for who wants to see what it does.

use super::scatter::{lobes, particles, rms};
use super::{Shop, media};
use crate::bsdf::Bsdf;
use crate::bsdf::contamination::Deposit;
use crate::coating::{Mirror, Side};
use crate::error::{Error, Problem, did_you_mean, printable};
use crate::optics::Incidence;
use crate::surface::dust::Dust;
use crate::system::document::Document;
use glam::DVec3;
use num_complex::Complex64;
use std::sync::Arc;

/// A scatter model between two media at one wavelength.
#[derive(Debug)]
pub struct Scatterer {
    pub lobes: Vec<Box<dyn Bsdf>>,
    /// Indices on the side of the light and beyond, dimensionless.
    pub index: [Complex64; 2],
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// Rms height over the spatial frequencies 0 to 1/wavelength of a polished surface, m.
    pub rms: Option<f64>,
    /// Particles, drawn as they would lie on a perfect mirror.
    pub particles: Option<Arc<Deposit>>,
}

impl Scatterer {
    /// Light that arrives at `theta` (rad) from the normal, in the xz plane, along which the lay is.
    pub fn arrival(&self, theta: f64) -> Incidence {
        Incidence { index: self.index, ..Incidence::in_air(theta, self.wavelength) }
    }

    /// BSDF of all lobes together, 1/sr.
    pub fn value(&self, at: &Incidence, wo: DVec3) -> f64 {
        self.lobes.iter().map(|lobe| lobe.eval(at, wo)).sum()
    }

    /// Reflected and transmitted TIS of all lobes together, 0..1.
    pub fn tis(&self, at: &Incidence) -> [f64; 2] {
        let mut tis = [0.0; 2];
        self.lobes.iter().for_each(|lobe| tis[usize::from(lobe.transmits())] += lobe.albedo(at));
        tis
    }

    /// True if some lobe lies on the transmitted (else the reflected) side.
    pub fn reaches(&self, transmitted: bool) -> bool {
        self.lobes.iter().any(|lobe| lobe.transmits() == transmitted)
    }
}

/// The scatter model `name` of a document, on its front, between the named media (else the ambient medium), and warnings.
pub fn scatterer(
    document: &Document,
    name: &str,
    names: [Option<&str>; 2],
    wavelength: f64,
) -> Result<(Scatterer, Vec<Problem>), Error> {
    let mut shop = Shop::new(document, document.warnings.clone());
    let models = &document.system.scatter;
    let written =
        models.get(name).ok_or_else(|| unknown("scatter model", name, &models.names().collect::<Vec<_>>()))?;
    let media = media::media(&mut shop);
    let mut lobes = lobes(&mut shop, written, Side::Front, &format!("scatter[{name:?}]"));
    if shop.problems.iter().any(Problem::is_error) {
        return Err(Error::Input(shop.problems));
    }
    let medium = |name: Option<&str>| match name {
        None => Ok(&media[usize::from(media::ambient(document))]),
        Some(name) => {
            let labels: Vec<&str> = media.iter().map(|filling| filling.label.as_str()).collect();
            media.iter().find(|filling| filling.label == name).ok_or_else(|| unknown("medium", name, &labels))
        }
    };
    let [here, beyond] = names;
    let index = [medium(here)?, medium(beyond)?].map(|filling| filling.medium.index(wavelength));
    let particles = particles(written, &[wavelength], 1.0).map(Arc::new);
    if let Some(deposit) = &particles {
        let mirror = Arc::new(Mirror { reflectance: 1.0 });
        lobes.extend(Dust { deposit: deposit.clone(), coating: Some(mirror), behind: false }.lobes());
    }
    Ok((Scatterer { lobes, index, wavelength, rms: rms(written, wavelength), particles }, shop.problems))
}

fn unknown(what: &str, name: &str, known: &[&str]) -> Error {
    let hint = match did_you_mean(name, known.iter().copied()) {
        Some(close) => format!("did you mean {close:?}?"),
        None => format!("expected one of {}", known.join(", ")),
    };
    Error::Usage(printable(&format!("no {what} {name:?}; {hint}")))
}
