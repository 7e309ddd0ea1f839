//! Soup to mesh: one position per corner.
//!
//! 1. Vertices at exactly the same position become one.
//! 2. Along edges that are still open, vertices nearer to each other than the rounding of the file allows become one.
//! 3. Triangles that lost their area and triangles that occur twice are dropped, and counted.

use super::edges::{Run, edges, runs};
use super::{Mesh, Topology, altitude};
use glam::DVec3;
use std::collections::HashMap;

/// What welding had to change, in triangles and vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Triangles without area (two corners the same, or all three in line): dropped.
    pub degenerate: usize,
    /// Triangles with the same corners in the same order as an earlier one: dropped.
    pub duplicate: usize,
    /// Vertices on open edges moved by less than the tolerance onto an earlier one.
    pub closed_up: usize,
}

/// How many tolerances apart two roundings of one corner may be: each is rounded once by the exporter's own
/// conversion (to metres, say) and once on storing, and both corners can be off in opposite directions.
const REACH: f64 = 4.0;

impl Mesh {
    /// Welds `triangles` (indices into `vertices`, m, all finite); `labels`: one per triangle.
    /// Needs about 60 bytes per vertex and 60 per triangle while it works; n log n.
    pub fn weld(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>, labels: Vec<u16>, tolerance: f64) -> (Mesh, Repairs) {
        let mut mesh = Mesh { vertices, triangles, labels, tolerance, ..Mesh::default() };
        let mut repairs = Repairs::default();
        mesh.merge_equal_positions();
        mesh.drop_collapsed(&mut repairs);
        mesh.drop_duplicates(&mut repairs);
        let mut runs = runs(&mesh.triangles);
        repairs.closed_up = mesh.close_up(&runs);
        if repairs.closed_up > 0 {
            mesh.drop_collapsed(&mut repairs);
            mesh.drop_duplicates(&mut repairs);
            runs = super::edges::runs(&mesh.triangles);
        }
        // Counted before triangles in line are dropped: what they join stays joined, the gap they leave has no width.
        mesh.topology = Topology::count(&mesh, &runs);
        drop(runs);
        let flat = mesh.drop_flat(&mut repairs);
        if flat > 0 && !mesh.topology.closed() {
            // Unless they were stray: a solid does not open because a line was drawn on it.
            let without = Topology::count(&mesh, &super::edges::runs(&mesh.triangles));
            mesh.topology = if without.closed() { without } else { mesh.topology };
        }
        mesh.drop_unused_vertices();
        (mesh, repairs)
    }

    /// Every index becomes that of the first vertex with the same coordinates.
    fn merge_equal_positions(&mut self) {
        let mut order: Vec<(u64, u32)> = self.vertices.iter().enumerate().map(|(i, v)| (hash(*v), i as u32)).collect();
        order.sort_unstable();
        let mut first: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            for (k, &(_, i)) in group.iter().enumerate().skip(1) {
                let same = |&&(_, j): &&(u64, u32)| self.vertices[j as usize] == self.vertices[i as usize];
                // A group is one position, but for collisions of the hash: the first candidate almost always matches.
                if let Some(&(_, j)) = group[..k].iter().find(same) {
                    first[i as usize] = j;
                }
            }
        }
        drop(order);
        self.renumber(&first);
    }

    fn renumber(&mut self, to: &[u32]) {
        for triangle in &mut self.triangles {
            *triangle = triangle.map(|v| to[v as usize]);
        }
    }

    /// Keeps the triangles that `keep` accepts; returns how many went.
    fn retain(&mut self, keep: impl Fn(&Mesh, usize) -> bool) -> usize {
        let mut kept = 0;
        for i in 0..self.triangles.len() {
            if keep(self, i) {
                self.triangles[kept] = self.triangles[i];
                self.labels[kept] = self.labels[i];
                kept += 1;
            }
        }
        let dropped = self.triangles.len() - kept;
        self.triangles.truncate(kept);
        self.labels.truncate(kept);
        dropped
    }

    /// Two corners the same: nothing is left of the triangle, and its other two edges have become one.
    fn drop_collapsed(&mut self, repairs: &mut Repairs) {
        repairs.degenerate += self.retain(|mesh, i| {
            let [a, b, c] = mesh.triangles[i];
            a != b && b != c && c != a
        });
    }

    /// Corners in line within the rounding of the f64 transform: 2^-49 of the coordinates, where `tolerance` is at
    /// least 2^-23 of the coordinates before, and `reach` is the largest after the transform.
    fn drop_flat(&mut self, repairs: &mut Repairs) -> usize {
        let reach = self.vertices.iter().fold(0f64, |most, v| most.max(v.abs().max_element()));
        let least = self.tolerance * 2f64.powi(-26) + reach * 2f64.powi(-49);
        let dropped = self.retain(|mesh, i| altitude(mesh.corners(i)) > least);
        repairs.degenerate += dropped;
        dropped
    }

    /// Same corners in the same cyclic order as an earlier triangle.
    fn drop_duplicates(&mut self, repairs: &mut Repairs) {
        let cyclic = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
            least if least == a => [a, b, c],
            least if least == b => [b, c, a],
            _ => [c, a, b],
        };
        let mut order: Vec<([u32; 3], u32)> =
            self.triangles.iter().enumerate().map(|(i, t)| (cyclic(*t), i as u32)).collect();
        order.sort_unstable();
        let mut again: Vec<u32> = order.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
        if again.is_empty() {
            return;
        }
        again.sort_unstable();
        repairs.duplicate += self.retain(|_, i| again.binary_search(&(i as u32)).is_err());
    }

    /// Joins vertices of open edges within `REACH` tolerances; returns how many moved.
    fn close_up(&mut self, runs: &[Run]) -> usize {
        let mut border: Vec<u32> = edges(runs).filter(|e| e.len() % 2 == 1).flat_map(|e| e[0].edge).collect();
        border.sort_unstable();
        border.dedup();
        let cell = REACH * self.tolerance;
        if border.is_empty() || cell <= 0.0 {
            return 0;
        }
        let mut grid = Grid { cell, places: HashMap::new() };
        let mut to: Vec<u32> = (0..self.vertices.len() as u32).collect();
        let mut moved = 0;
        for v in border {
            match grid.near(self.vertices[v as usize], &self.vertices) {
                Some(earlier) => {
                    to[v as usize] = earlier;
                    moved += 1;
                }
                None => grid.put(v, self.vertices[v as usize]),
            }
        }
        if moved > 0 {
            self.renumber(&to);
        }
        moved
    }

    fn drop_unused_vertices(&mut self) {
        const UNUSED: u32 = u32::MAX;
        let mut to = vec![UNUSED; self.vertices.len()];
        let mut kept = 0;
        for v in self.triangles.iter().flatten() {
            to[*v as usize] = 0;
        }
        for (i, new) in to.iter_mut().enumerate().filter(|(_, new)| **new != UNUSED) {
            self.vertices[kept as usize] = self.vertices[i];
            *new = kept;
            kept += 1;
        }
        self.vertices.truncate(kept as usize);
        self.vertices.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.labels.shrink_to_fit();
        self.renumber(&to);
    }
}

/// Positions on a grid of cubes, so that neighbours within one cell width are found in 27 cubes. As no two of them are
/// nearer to each other than a cell, a cube holds a handful at most.
struct Grid {
    /// m
    cell: f64,
    places: HashMap<[i64; 3], Vec<u32>>,
}

impl Grid {
    fn cube(&self, at: DVec3) -> [i64; 3] {
        // Coordinates are at most 2^23 tolerances: far inside i64.
        (at / self.cell).floor().to_array().map(|x| x as i64)
    }

    fn put(&mut self, v: u32, at: DVec3) {
        self.places.entry(self.cube(at)).or_default().push(v);
    }

    /// The earliest vertex within one cell width of `at`.
    fn near(&self, at: DVec3, vertices: &[DVec3]) -> Option<u32> {
        let [x, y, z] = self.cube(at);
        let around = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k])));
        around
            .filter_map(|[i, j, k]| self.places.get(&[x + i, y + j, z + k]))
            .flatten()
            .copied()
            .filter(|&v| vertices[v as usize].distance(at) <= self.cell)
            .min()
    }
}

/// A number that is equal for equal positions (0 and -0 are the same position).
fn hash(v: DVec3) -> u64 {
    // Adding +0 turns -0 into +0. The multiplier is the 64-bit golden ratio (Knuth, TAOCP 3, sec. 6.4).
    v.to_array().iter().fold(0u64, |h, x| {
        let h = (h ^ (x + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        h ^ (h >> 29)
    })
}
