//! A density over the sphere of directions, learned from weighted samples: a quadtree whose cells are fine where the light is.
//!
//! The sphere is mapped to the unit square by (azimuth, z), which keeps areas: a share s of the weight in a cell of area a is
//! the density s / (4 pi a). After Mueller, Gross, Novak, "Practical path guiding for efficient light-transport simulation",
//! Computer Graphics Forum 36(4), 2017.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A cell is divided while it holds more than this share of the weight ...
const SHARE: f64 = 0.02;
/// ... in at least so many samples ...
const SAMPLES: usize = 8;
/// ... and is not yet so deep.
const DEPTH: u32 = 12;

/// A density over all directions.
#[derive(Clone, Debug, Default)]
pub struct Directions {
    nodes: Vec<Node>,
}

/// A square divided in four: quarter 2 row + column.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Of the node's weight; they add up to 1.
    shares: [f64; 4],
    /// Node of each quarter; 0: not divided.
    below: [u32; 4],
}

/// A sample: place in the unit square, weight > 0.
type Sample = (DVec2, f64);

impl Directions {
    /// From unit directions with weights; `None` if they weigh nothing.
    pub fn learn(samples: impl Iterator<Item = (DVec3, f64)>) -> Option<Directions> {
        let mut samples: Vec<Sample> = samples.map(|(direction, weight)| (place(direction), weight)).collect();
        let whole: f64 = samples.iter().map(|sample| sample.1).sum();
        let mut directions = Directions::default();
        (whole > 0.0).then(|| {
            directions.divide(&mut samples, whole, 0);
            directions
        })
    }

    /// Divides the unit square; returns the number of its node.
    fn divide(&mut self, samples: &mut [Sample], whole: f64, depth: u32) -> u32 {
        let number = self.nodes.len();
        self.nodes.push(Node { shares: [0.0; 4], below: [0; 4] });
        let quarter = |place: DVec2| 2 * (place.y >= 0.5) as usize + (place.x >= 0.5) as usize;
        samples.sort_by_key(|(place, _)| quarter(*place));
        let own: f64 = samples.iter().map(|sample| sample.1).sum();
        let mut rest = samples;
        for at in 0..4 {
            let (here, others) = rest.split_at_mut(rest.partition_point(|(place, _)| quarter(*place) <= at));
            rest = others;
            let weight: f64 = here.iter().map(|sample| sample.1).sum();
            self.nodes[number].shares[at] = weight / own;
            if weight > SHARE * whole && here.len() >= SAMPLES && depth < DEPTH {
                let corner = DVec2::new((at & 1) as f64, (at >> 1) as f64);
                here.iter_mut().for_each(|(place, _)| *place = 2.0 * *place - corner);
                self.nodes[number].below[at] = self.divide(here, whole, depth + 1);
            }
        }
        number as u32
    }

    /// A unit direction at two coordinates in [0, 1).
    pub fn draw(&self, [mut u, mut v]: [f64; 2]) -> DVec3 {
        let (mut number, mut corner, mut side) = (0, DVec2::ZERO, 1.0);
        loop {
            let node = &self.nodes[number];
            let row = pick(&mut v, node.shares[0] + node.shares[1], 1.0);
            let column = pick(&mut u, node.shares[2 * row], node.shares[2 * row] + node.shares[2 * row + 1]);
            side *= 0.5;
            corner += side * DVec2::new(column as f64, row as f64);
            number = node.below[2 * row + column] as usize;
            if number == 0 {
                return direction(corner + side * DVec2::new(u, v));
            }
        }
    }

    /// Density at a unit direction, 1/sr.
    pub fn density(&self, direction: DVec3) -> f64 {
        let mut place = place(direction);
        let (mut number, mut density) = (0, 0.25 / PI);
        loop {
            let (row, column) = ((place.y >= 0.5) as usize, (place.x >= 0.5) as usize);
            let node = &self.nodes[number];
            density *= 4.0 * node.shares[2 * row + column];
            number = node.below[2 * row + column] as usize;
            if number == 0 || density == 0.0 {
                return density;
            }
            place = 2.0 * place - DVec2::new(column as f64, row as f64);
        }
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }
}

/// 0 with chance `first` / `both`, else 1; what is left of `u` is uniform again.
fn pick(u: &mut f64, first: f64, both: f64) -> usize {
    let target = *u * both;
    let second = (target >= first && both > first) as usize;
    let rest = if second == 1 { (target - first) / (both - first) } else { target / first };
    *u = rest.clamp(0.0, 1.0 - f64::EPSILON);
    second
}

fn place(direction: DVec3) -> DVec2 {
    let turn = direction.y.atan2(direction.x) / TAU + 0.5;
    DVec2::new(turn, 0.5 + 0.5 * direction.z).clamp(DVec2::ZERO, DVec2::splat(1.0 - f64::EPSILON))
}

fn direction(place: DVec2) -> DVec3 {
    let z = 2.0 * place.y - 1.0;
    let across = 2.0 * (place.y * (1.0 - place.y)).max(0.0).sqrt();
    (across * DVec2::from_angle(TAU * (place.x - 0.5))).extend(z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::statistics::chi_squared_tail;
    use crate::math::{Rng, sampling};

    fn learned() -> Directions {
        let mut rng = Rng::new(11, 0, 0);
        let mut sample = |i: usize| {
            let narrow = sampling::cone(rng.pair(), 0.01);
            (if i.is_multiple_of(3) { sampling::cosine_hemisphere(rng.pair()) } else { narrow }, 1.0 + (i % 5) as f64)
        };
        Directions::learn((0..4000).map(&mut sample)).expect("it has weight")
    }

    /// Counts in a grid of equal cells against the density, summed over a finer one.
    #[test]
    fn draws_have_the_density() {
        let directions = learned();
        let (cells, fine, draws) = (64, 64, 400_000);
        let mut expected = vec![0.0; cells * cells];
        let step = 1.0 / (cells * fine) as f64;
        for row in 0..cells * fine {
            for column in 0..cells * fine {
                let at = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * step;
                expected[row / fine * cells + column / fine] +=
                    directions.density(direction(at)) * 4.0 * PI * step * step;
            }
        }
        assert!((expected.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        let mut rng = Rng::new(12, 0, 0);
        let mut counts = vec![0u32; cells * cells];
        for _ in 0..draws {
            let at = place(directions.draw(rng.pair())) * cells as f64;
            counts[at.y as usize * cells + at.x as usize] += 1;
        }
        let (mut chi, mut freedom, mut pooled) = (0.0, -1.0, (0.0, 0.0));
        for (e, c) in expected.iter().map(|e| e * draws as f64).zip(&counts) {
            if e < 5.0 {
                pooled = (pooled.0 + e, pooled.1 + f64::from(*c));
            } else {
                chi += (f64::from(*c) - e).powi(2) / e;
                freedom += 1.0;
            }
        }
        if pooled.0 > 5.0 {
            chi += (pooled.1 - pooled.0).powi(2) / pooled.0;
            freedom += 1.0;
        }
        let p = chi_squared_tail(chi, freedom);
        assert!(freedom > 100.0 && p > 0.001, "chi-squared {chi} of {freedom}: p {p}");
    }

    #[test]
    fn it_is_finer_where_the_light_is() {
        let directions = learned();
        assert!(directions.density(DVec3::Z) > 100.0 * directions.density(DVec3::X));
        assert_eq!(directions.density(DVec3::NEG_Z), 0.0);
        assert!(Directions::learn(std::iter::empty()).is_none());
    }
}
