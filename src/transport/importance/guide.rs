//! What a patch knows of where to: some draws go by direction, some by place.

use super::directions::Directions;
use super::stones::Stones;
use crate::math::Rng;
use glam::DVec3;

/// Share of the draws that go by place, where places are known.
const BY_PLACE: f64 = 0.4;

/// A learned density over directions, for points of a patch.
#[derive(Clone, Debug)]
pub struct Guide {
    directions: Directions,
    stones: Option<Stones>,
}

impl Guide {
    /// From directions, and places (m) with weights that they lead to, known to `least` (m).
    pub fn learn(directions: Directions, places: Vec<(DVec3, f64)>, least: f64) -> Guide {
        Guide { directions, stones: Stones::learn(places, least) }
    }

    /// A unit direction from a point of the patch; `None` if there is none.
    pub fn draw(&self, point: DVec3, rng: &mut Rng) -> Option<DVec3> {
        match &self.stones {
            Some(stones) if rng.uniform() < BY_PLACE => stones.draw(point, rng),
            _ => Some(self.directions.draw(rng.pair())),
        }
    }

    /// Density at a unit direction from a point of the patch, 1/sr.
    pub fn density(&self, point: DVec3, direction: DVec3) -> f64 {
        let by_direction = self.directions.density(direction);
        match &self.stones {
            Some(stones) => (1.0 - BY_PLACE) * by_direction + BY_PLACE * stones.density(point, direction),
            None => by_direction,
        }
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        self.directions.bytes() + self.stones.as_ref().map_or(0, Stones::bytes)
    }
}
