//! Fewer triangles for a picture: corners of a part that lie in one cell of a grid become one, and what has no area left is dropped.
//!
//! Source: J. Rossignac, P. Borrel, Multi-resolution 3D approximations for rendering complex scenes (Springer, 1993), sec. 3.

use super::single;
use glam::DVec3;
use std::collections::HashMap;

/// Triangles of all parts with shared corners.
#[derive(Debug, Default)]
pub struct Soup {
    pub corners: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// Triangles of each part.
    pub counts: Vec<usize>,
    /// Largest distance that a corner was moved by, m.
    pub moved: f64,
}

/// First size of a cell, and how it grows, in radii of the scene.
const FIRST: f64 = 1.0 / 2048.0;
const GROWTH: f64 = 1.4;

/// At most `most` triangles of parts within `radius` (m) of the origin; as they are if they are no more.
pub fn merged(parts: &[Vec<[DVec3; 3]>], radius: f64, most: usize) -> Soup {
    let mut soup = gathered(parts, None);
    let mut cell = FIRST * radius;
    while soup.triangles.len() > most && cell < radius {
        soup = gathered(parts, Some(cell));
        cell *= GROWTH;
    }
    soup
}

fn gathered(parts: &[Vec<[DVec3; 3]>], cell: Option<f64>) -> Soup {
    let mut soup = Soup::default();
    // One place for each cell, whatever the part: faces that were joined stay so.
    let mut places: HashMap<[i64; 3], DVec3> = HashMap::new();
    for triangles in parts {
        let mut known: HashMap<[i64; 3], u32> = HashMap::new();
        let before = soup.triangles.len();
        for corners in triangles {
            let indices = corners.map(|corner| {
                let key = key(corner, cell);
                let there = *places.entry(key).or_insert(corner);
                if cell.is_some() {
                    soup.moved = soup.moved.max((corner - there).length());
                }
                *known.entry(key).or_insert_with(|| {
                    soup.corners.push(single(there));
                    soup.corners.len() as u32 - 1
                })
            });
            let [a, b, c] = indices;
            if a != b && b != c && c != a {
                soup.triangles.push(indices);
            }
        }
        soup.counts.push(soup.triangles.len() - before);
    }
    soup
}

/// Whether triangles close up: every edge is gone along as often one way as the other.
pub fn closed<'a>(triangles: impl Iterator<Item = &'a [DVec3; 3]>) -> bool {
    let mut open: HashMap<[[i64; 3]; 2], i32> = HashMap::new();
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| key(corner, None));
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *open.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    open.values().all(|balance| *balance == 0)
}

/// The cell of a corner, or the corner itself in single precision.
fn key(corner: DVec3, cell: Option<f64>) -> [i64; 3] {
    match cell {
        Some(cell) => (corner / cell).floor().to_array().map(|x| x as i64),
        None => single(corner).map(|x| i64::from(x.to_bits())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of n x n small ones, each of two triangles.
    fn square(n: u32) -> Vec<[DVec3; 3]> {
        let at = |x: u32, y: u32| DVec3::new(f64::from(x) / f64::from(n), f64::from(y) / f64::from(n), 0.0);
        let both =
            |x: u32, y: u32| [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]];
        (0..n * n).flat_map(|i| both(i % n, i / n)).collect()
    }

    fn area(soup: &Soup) -> f64 {
        let corner = |i: u32| DVec3::from(soup.corners[i as usize].map(f64::from));
        let doubled = |[a, b, c]: &[u32; 3]| (corner(*b) - corner(*a)).cross(corner(*c) - corner(*a)).length();
        soup.triangles.iter().map(|triangle| 0.5 * doubled(triangle)).sum()
    }

    #[test]
    fn few_triangles_stay_as_they_are_and_share_their_corners() {
        let soup = merged(&[square(10), square(3)], 1.0, 1000);
        assert_eq!((soup.triangles.len(), soup.corners.len(), soup.moved), (218, 121 + 16, 0.0));
        assert_eq!(soup.counts, [200, 18]);
    }

    #[test]
    fn a_body_is_closed_until_a_face_is_missing() {
        let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let tetrahedron = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
        assert!(closed(tetrahedron.iter()));
        assert!(!closed(tetrahedron[1..].iter()) && !closed(square(2).iter()));
    }

    #[test]
    fn many_triangles_become_few_and_cover_the_same() {
        let soup = merged(&[square(200)], 1.0, 5000);
        assert!(soup.triangles.len() <= 5000 && soup.triangles.len() > 500, "{}", soup.triangles.len());
        assert!((area(&soup) - 1.0).abs() < 2.0 * soup.moved + 0.02, "{} {}", area(&soup), soup.moved);
        assert!(soup.moved > 0.0 && soup.moved < 0.05, "{}", soup.moved);
    }
}
