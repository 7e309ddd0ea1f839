//! The faces of a part as a person sees them: regions of triangles that pass smoothly into one another.
//!
//! Two neighbours belong to one face when their normals differ by at most a given angle. The normal of a sliver is
//! noise when its height is within the rounding of its corners, so slivers do not join faces: each is given to the
//! neighbour behind its longest edge, of which it is a stripe.

use super::edges::{Union, edges, runs};
use super::{Mesh, altitude};
use glam::DVec3;

/// Heights below this many tolerances make a sliver: its normal may be off by more than 1/16 rad.
const SLIVER: f64 = 16.0;

/// A partition of the triangles of a mesh.
#[derive(Clone, Debug)]
pub struct Faces {
    /// The face of each triangle; faces are numbered in the order of their first triangle.
    pub of: Vec<u32>,
    pub count: usize,
    /// Whether the normal of each triangle means something.
    pub sound: Vec<bool>,
}

impl Mesh {
    /// Faces bounded by edges where the normals differ by more than `smooth` (rad). Edges that do not join exactly two
    /// triangles bound a face. Needs about 80 bytes per triangle while it works.
    pub fn faces(&self, smooth: f64) -> Faces {
        let len = self.triangles.len();
        let runs = runs(&self.triangles);
        let sound: Vec<bool> = (0..len).map(|i| altitude(self.corners(i)) >= SLIVER * self.tolerance).collect();
        let normals: Vec<DVec3> = (0..len).map(|i| self.normal(i)).collect();
        let mut union = Union::new(len);
        let mut behind = vec![u32::MAX; len];
        for edge in edges(&runs) {
            let [one, other] = edge else { continue };
            let (i, j) = (one.triangle(), other.triangle());
            let agree = if one.backward() == other.backward() { -1.0 } else { 1.0 };
            if sound[i] && sound[j] && (agree * normals[i]).angle_between(normals[j]) <= smooth {
                union.join(i, j);
            }
            for (sliver, neighbour) in [(i, j), (j, i)] {
                if !sound[sliver] && self.longest(sliver) == one.edge {
                    behind[sliver] = neighbour as u32;
                }
            }
        }
        adopt(&mut union, &sound, &behind);
        number(union, sound)
    }

    /// The longest edge of triangle `i`, smaller vertex first.
    fn longest(&self, i: usize) -> [u32; 2] {
        let [a, b, c] = self.triangles[i];
        let length = |[p, q]: [u32; 2]| self.vertices[p as usize].distance_squared(self.vertices[q as usize]);
        let mut best = [a.min(b), a.max(b)];
        for next in [[b.min(c), b.max(c)], [c.min(a), c.max(a)]] {
            if length(next) > length(best) {
                best = next;
            }
        }
        best
    }
}

/// Gives each sliver to the first sound triangle behind it, through other slivers if need be. A sliver is joined once
/// only, so that it never connects two faces.
fn adopt(union: &mut Union, sound: &[bool], behind: &[u32]) {
    for start in 0..sound.len() {
        if sound[start] {
            continue;
        }
        let mut at = start;
        // A chain of slivers is as long as a fan has stripes at most; two that face each other would never end.
        for _ in 0..64 {
            match behind[at] {
                u32::MAX => break,
                next if sound[next as usize] => {
                    union.join(start, next as usize);
                    break;
                }
                next => at = next as usize,
            }
        }
    }
}

fn number(mut union: Union, sound: Vec<bool>) -> Faces {
    let mut of = vec![u32::MAX; sound.len()];
    let mut count = 0;
    for i in 0..of.len() {
        // The representative is the smallest member: it has been numbered before the others.
        let root = union.find(i);
        if root == i {
            of[i] = count;
            count += 1;
        } else {
            of[i] = of[root];
        }
    }
    Faces { of, count: count as usize, sound }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube, z = 0 below; one side cut by a stripe far thinner than the rounding of its corners.
    #[test]
    fn a_sliver_on_an_edge_joins_one_face_and_never_two() {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let mut vertices: Vec<DVec3> = (0..8).map(corner).collect();
        // Just inside the top, at the middle of its edge from 4 to 5; the sliver leans by 45 degrees.
        vertices.push(DVec3::new(0.5, 1e-9, 1.0 - 1e-9));
        let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
        let mut triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        triangles.extend([[4, 5, 8], [8, 5, 7], [8, 7, 6], [4, 8, 6]]);
        let labels = vec![0; triangles.len()];
        let (mesh, repairs) = Mesh::weld(vertices, triangles, labels, 1e-8);
        assert_eq!(repairs, Default::default());
        assert!(mesh.topology.closed());
        let faces = mesh.faces(0.3);
        assert_eq!(faces.count, 6);
        assert_eq!(faces.sound.iter().filter(|sound| !**sound).count(), 1);
    }
}
