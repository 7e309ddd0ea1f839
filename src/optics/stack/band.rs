//! The characteristic matrix of a whole stack over a band of wavelengths and all angles, looked up instead of multiplied.
//!
//! It has two [zones](super::zone) in x = (n1 sin theta1)^2: below 1, where light from and into vacuum is, and above, where it is caught
//! in denser media and films guide it. Where a zone is not good the layers are multiplied out.
//!
//! Of a stack that is met from its other side the matrix is the same with its diagonal turned round, for that of each layer is.

use super::Around;
use super::zone::{End, Seen, Zone};
use crate::optics::Split;

/// The matrix of a stack over wavelength and angle.
#[derive(Clone, Debug)]
pub struct Band(Vec<Zone>);

impl Band {
    /// The table from the first to the second vacuum wavelength (m). `None` if no zone of it can be had.
    pub fn new(stack: &Seen, [from, to]: [f64; 2]) -> Option<Band> {
        if from >= to {
            return None;
        }
        let reach = [from, 0.5 * (from + to), to].map(stack.highest).into_iter().fold(1.0, f64::max).powi(2);
        let zones: Vec<Zone> =
            [[0.0, 1.0], [1.0, reach]].into_iter().filter_map(|x| Zone::new(stack, [from, to], x)).collect();
        (!zones.is_empty()).then_some(Band(zones))
    }

    /// What the stack does to light of a vacuum wavelength (m) that meets `end` of it; `None` where the table is not made for it.
    pub fn split(&self, around: &Around, wavelength: f64, end: End) -> Option<Split> {
        let x = around.tangential_squared();
        let (zone, place) = self.0.iter().find_map(|zone| Some((zone, zone.column(x)?)))?;
        zone.split(around, 1.0 / wavelength, place, end)
    }
}
