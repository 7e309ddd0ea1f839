//! A density over the directions from any point, learned from places: it goes to where they are, whichever point it is seen from.
//!
//! What matters may be small and near - the edge of a vane - so that its direction turns from one end of a patch to the other, and
//! a density of directions learned for the whole patch must be wide. Places do not turn. They are divided into flat rectangles; a
//! draw falls evenly on one of them, which from distance t has the density t^2 / (A |cos|), t and cos taken where the direction meets it.

use crate::math::{Rng, eigen};
use glam::{DMat3, DVec3};

/// Places on a stone, at least, and about so many stones at most.
const FEWEST: usize = 8;
const MOST: usize = 32;
/// Least ratio of its sides.
const SLENDER: f64 = 0.02;
/// Least cosine to its normal at which a stone is stepped on: below it digits go.
const GRAZING: f64 = 1e-4;

/// Rectangles and their shares.
#[derive(Clone, Debug)]
pub struct Stones {
    /// The shares add up to 1.
    stones: Vec<(f64, Stone)>,
}

#[derive(Clone, Copy, Debug)]
struct Stone {
    centre: DVec3,
    /// Half sides, m.
    sides: [DVec3; 2],
    normal: DVec3,
    /// m2
    area: f64,
    /// Square of half a diagonal, m2.
    reach: f64,
}

impl Stones {
    /// From places (m) with weights > 0, as stones whose half sides are at least `least` (m); `None` if there are too few.
    pub fn learn(mut places: Vec<(DVec3, f64)>, least: f64) -> Option<Stones> {
        let crowd = FEWEST.max(places.len() / MOST);
        let mut stones = Vec::new();
        divide(&mut places, crowd, least, &mut stones);
        let whole: f64 = stones.iter().map(|(weight, _)| weight).sum();
        stones.iter_mut().for_each(|(weight, _)| *weight /= whole);
        (!stones.is_empty()).then_some(Stones { stones })
    }

    /// A unit direction from `point`; `None` if the stone is seen from its edge.
    pub fn draw(&self, point: DVec3, rng: &mut Rng) -> Option<DVec3> {
        let mut rest = rng.uniform();
        let chosen = self.stones.iter().find(|(share, _)| {
            rest -= share;
            rest < 0.0
        });
        let (_, stone) = chosen.or(self.stones.last())?;
        let [u, v] = rng.pair().map(|u| 2.0 * u - 1.0);
        let direction = (stone.centre + u * stone.sides[0] + v * stone.sides[1] - point).try_normalize()?;
        (direction.dot(stone.normal).abs() > GRAZING).then_some(direction)
    }

    /// Density at a unit direction from `point`, 1/sr.
    pub fn density(&self, point: DVec3, direction: DVec3) -> f64 {
        self.stones.iter().map(|(share, stone)| share * stone.density(stone.centre - point, direction)).sum()
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.stones[..])
    }
}

impl Stone {
    /// The rectangle in the plane of places that holds them all; `None` if it has no area.
    fn around(places: &[(DVec3, f64)], least: f64) -> Option<Stone> {
        let n = places.len() as f64;
        let mean = places.iter().map(|place| place.0).sum::<DVec3>() / n;
        let outer = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let spread = places.iter().fold(DMat3::ZERO, |sum, place| sum + outer(place.0 - mean));
        let [normal, short, long] = eigen::symmetric(spread).map(|(_, axis)| axis);
        let extent = |axis: DVec3| {
            let along = places.iter().map(|place| (place.0 - mean).dot(axis));
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        let ends = [extent(long), extent(short)];
        // So many places leave about as much uncovered beyond the last of them as lies between two.
        let [length, width] = ends.map(|[low, high]| 0.5 * (high - low) * (n + 1.0) / (n - 1.0));
        let [length, width] = [length.max(least), width.max(SLENDER * length).max(least)];
        let middle = ends.map(|[low, high]| 0.5 * (low + high));
        (length > 0.0).then(|| Stone {
            centre: mean + middle[0] * long + middle[1] * short,
            sides: [length * long, width * short],
            normal,
            area: 4.0 * length * width,
            reach: length * length + width * width,
        })
    }

    /// Density at a unit direction from a point from which the centre lies at `away` (m), 1/sr.
    fn density(&self, away: DVec3, direction: DVec3) -> f64 {
        // The way across is a difference of vectors: that of squares would lose a small stone that is far away.
        if (away - away.dot(direction) * direction).length_squared() > self.reach {
            return 0.0;
        }
        let cosine = direction.dot(self.normal);
        let distance = away.dot(self.normal) / cosine;
        if cosine.abs() <= GRAZING || distance <= 0.0 {
            return 0.0;
        }
        let place = distance * direction - away;
        let inside = self.sides.iter().all(|side| place.dot(*side).abs() <= side.length_squared());
        if inside { distance * distance / (self.area * cosine.abs()) } else { 0.0 }
    }
}

/// Divides places in halves across where they spread most.
fn divide(places: &mut [(DVec3, f64)], crowd: usize, least: f64, stones: &mut Vec<(f64, Stone)>) {
    if places.len() < FEWEST {
        return;
    }
    if places.len() < 2 * crowd {
        let weight: f64 = places.iter().map(|place| place.1).sum();
        stones.extend(Stone::around(places, least).map(|stone| (weight, stone)));
        return;
    }
    let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = places.iter().fold(ends, |(low, high), place| (low.min(place.0), high.max(place.0)));
    let axis = (high - low).max_position();
    places.sort_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (low, high) = places.split_at_mut(places.len() / 2);
    divide(low, crowd, least, stones);
    divide(high, crowd, least, stones);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling;
    use std::f64::consts::PI;

    /// On an arc, a plate and a line, as seen from near them.
    fn stones(rng: &mut Rng) -> Stones {
        let mut place = |i: usize| {
            let [u, v] = rng.pair();
            let place = match i % 3 {
                0 => DVec3::new(u.cos(), u.sin(), 0.05 * v),
                1 => DVec3::new(2.0 * u, 1.0, 3.0 * v),
                _ => DVec3::new(0.2 * u, -2.0, 0.0),
            };
            (place, 1.0 + (i % 5) as f64)
        };
        Stones::learn((0..600).map(&mut place).collect(), 1e-9).expect("they are many")
    }

    /// What is drawn weighs 1 / density and adds up to the same as even draws over all directions do.
    #[test]
    fn draws_have_the_density() {
        let mut rng = Rng::new(5, 0, 0);
        let stones = stones(&mut rng);
        let point = DVec3::new(0.3, -0.4, 0.9);
        let n = 2_000_000;
        let halves = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mut sums = [[[0.0f64; 2]; 2]; 4];
        for _ in 0..n {
            let even = sampling::sphere(rng.pair());
            let own = stones.draw(point, &mut rng);
            for (half, sums) in halves.iter().zip(&mut sums) {
                let counts = |w: DVec3| (*half == DVec3::ZERO || w.dot(*half) > 0.6) as u8 as f64;
                // Few directions have most of the density: both sums take its square root.
                let one = 4.0 * PI * stones.density(point, even).sqrt() * counts(even);
                let other = own.map_or(0.0, |own| counts(own) / stones.density(point, own).sqrt());
                for (sum, value) in sums.iter_mut().zip([one, other]) {
                    *sum = [sum[0] + value, sum[1] + value * value];
                }
            }
        }
        for (half, sums) in halves.iter().zip(&sums) {
            let [a, b] = sums.map(|[sum, squares]| {
                let mean = sum / n as f64;
                (mean, ((squares / n as f64 - mean * mean) / n as f64).sqrt())
            });
            let sigma = a.1.hypot(b.1);
            assert!((a.0 - b.0).abs() < 4.0 * sigma && sigma < 0.02 * a.0.max(0.1), "{half}: {a:?} {b:?}");
        }
    }

    /// A sharp image: places apart by roundings, far away.
    #[test]
    fn a_stone_of_the_least_size_has_the_density_of_its_draws() {
        let mut rng = Rng::new(6, 0, 0);
        let places = (0..64).map(|_| (DVec3::new(0.3, 0.1, 0.2) + 1e-15 * sampling::sphere(rng.pair()), 1.0)).collect();
        let stones = Stones::learn(places, 1e-9).expect("they are many");
        for point in [DVec3::new(0.3, 0.1, 1.2), DVec3::new(-0.9, 0.4, 0.8)] {
            let drawn: Vec<DVec3> = (0..1000).filter_map(|_| stones.draw(point, &mut rng)).collect();
            let seen = drawn.iter().filter(|direction| stones.density(point, **direction) > 0.0).count();
            assert!(seen + 1 >= drawn.len() && drawn.len() > 900, "{seen} of {}", drawn.len());
        }
    }

    #[test]
    fn places_in_one_point_or_too_few_are_no_stones() {
        assert!(Stones::learn(vec![(DVec3::ONE, 1.0); 20], 0.0).is_none());
        assert!(Stones::learn(vec![(DVec3::ONE, 1.0), (DVec3::X, 1.0)], 0.0).is_none());
    }
}
