//! How warm every part and solid is.

use super::Shop;
use super::assembly::Assembly;
use crate::error::Problem;
use crate::source::{Density, planck};
use crate::system::document as written;

/// Temperatures, and the wavelengths in which they are seen.
#[derive(Clone, Debug)]
pub struct Thermal {
    /// Least and greatest vacuum wavelength, m.
    pub band: [f64; 2],
    /// Of every part of the scene, K; 0: it sends out nothing.
    pub parts: Vec<f64>,
    /// Of every solid of the scene, K.
    pub solids: Vec<f64>,
    /// Planck's law at the highest temperature within the band.
    pub hottest: Density,
}

/// What the document says of temperatures; `None`: nothing, or what is wrong has been noted.
pub fn thermal(shop: &mut Shop, assembly: &Assembly, parts: usize, solids: usize) -> Option<Thermal> {
    let written = shop.document.system.thermal.as_ref()?;
    let written::Spectrum::Band { from, to } = written.band else { return None };
    let band = [from.0, to.0];
    let (mut parts, mut solids) = (vec![0.0; parts], vec![0.0; solids]);
    for (at, (glob, temperature)) in written.temperatures.iter().enumerate() {
        let nodes = assembly.matching(glob);
        if nodes.is_empty() {
            shop.nothing_matches(&format!("thermal.temperatures[{at}][0]"), glob, &assembly.names());
        }
        assembly.parts_of(&nodes).into_iter().for_each(|part| parts[part] = temperature.0);
        let filled = assembly.solid_nodes.iter().enumerate().filter(|(_, node)| nodes.contains(node));
        filled.for_each(|(solid, _)| solids[solid] = temperature.0);
    }
    let hottest = parts.iter().chain(&solids).fold(0.0_f64, |most, kelvin| most.max(*kelvin));
    if planck::band(hottest, band) < LEAST {
        let what = format!("at {hottest} K nothing glows in this band");
        shop.fault("thermal.band", Problem::error(what).expecting("longer wavelengths or higher temperatures"));
        return None;
    }
    let hottest = Density::black_body(hottest, band[0], band[1]);
    Some(Thermal { band, parts, solids, hottest })
}

/// Radiance (W/m2/sr) that is no light: a photon from a square metre in the age of the universe is 1e-37 W.
const LEAST: f64 = 1e-50;
