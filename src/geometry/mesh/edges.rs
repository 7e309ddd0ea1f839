//! The edges of a mesh: which triangles meet where, and what follows from it.
//!
//! Each triangle runs along each of its edges in one direction. Where every edge is run equally often in both
//! directions the mesh bounds a solid, and its volume is (divergence theorem)
//!
//!     V = 1/6 sum over triangles of a . (b x c)    [m3]    positive when the normals look outwards

use super::{Mesh, cross};
use glam::DVec3;

/// What the edges of a welded mesh tell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Topology {
    /// Edges that an odd number of triangles share: the border of a sheet, or a hole.
    pub open_edges: usize,
    /// Edges whose triangles disagree about which side is the front.
    pub twisted_edges: usize,
    /// Edges of more than two triangles.
    pub branched_edges: usize,
    /// Parts connected across edges.
    pub pieces: usize,
    /// m2
    pub area: f64,
    /// m3; negative when the normals look inwards, meaningless unless closed.
    pub volume: f64,
}

impl Topology {
    /// Whether the mesh bounds a solid: no open edge, and front sides that agree.
    pub fn closed(&self) -> bool {
        self.open_edges == 0 && self.twisted_edges == 0 && self.area > 0.0
    }

    /// Whether a closed mesh shows its front to the inside.
    pub fn inverted(&self) -> bool {
        self.closed() && self.volume < 0.0
    }
}

/// One triangle's run along one edge; sorts by edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Run {
    /// Vertices, the smaller first.
    pub edge: [u32; 2],
    /// Triangle * 2 + direction (1: from the larger vertex to the smaller).
    tag: u32,
}

impl Run {
    pub fn triangle(&self) -> usize {
        (self.tag >> 1) as usize
    }

    pub fn backward(&self) -> bool {
        self.tag & 1 == 1
    }
}

/// All runs in order of edge, 12 bytes each, three per triangle.
pub(super) fn runs(triangles: &[[u32; 3]]) -> Vec<Run> {
    let mut runs = Vec::with_capacity(3 * triangles.len());
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let tag = 2 * i as u32 + u32::from(from > to);
            runs.push(Run { edge: [from.min(to), from.max(to)], tag });
        }
    }
    runs.sort_unstable();
    runs
}

/// The runs of one edge after the other.
pub(super) fn edges(runs: &[Run]) -> impl Iterator<Item = &[Run]> {
    runs.chunk_by(|a, b| a.edge == b.edge)
}

impl Topology {
    /// Counts over all edges; cost: one pass over the sorted runs.
    pub(super) fn count(mesh: &Mesh, runs: &[Run]) -> Topology {
        let mut topology = Topology::default();
        let mut pieces = Union::new(mesh.triangles.len());
        for edge in edges(runs) {
            let backward = edge.iter().filter(|run| run.backward()).count();
            topology.open_edges += edge.len() % 2;
            topology.twisted_edges += usize::from(edge.len() % 2 == 0 && 2 * backward != edge.len());
            topology.branched_edges += usize::from(edge.len() > 2);
            for pair in edge.windows(2) {
                pieces.join(pair[0].triangle(), pair[1].triangle());
            }
        }
        topology.pieces = pieces.count();
        (topology.area, topology.volume) = area_and_volume(mesh);
        topology
    }
}

/// m2 and m3; measured from the middle of the mesh, so that a part far from the origin loses no digits.
pub(super) fn area_and_volume(mesh: &Mesh) -> (f64, f64) {
    let middle = mesh.bounds().map_or(DVec3::ZERO, |[low, high]| 0.5 * (low + high));
    let (mut area, mut volume) = (0.0, 0.0);
    for i in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(i).map(|corner| corner - middle);
        area += 0.5 * cross([a, b, c]).length();
        volume += a.dot(b.cross(c)) / 6.0;
    }
    (area, volume)
}

/// Disjoint sets of triangles (union by smaller index, path halving); the representative is the smallest member.
pub(super) struct Union(Vec<u32>);

impl Union {
    pub fn new(len: usize) -> Union {
        Union((0..len as u32).collect())
    }

    pub fn find(&mut self, i: usize) -> usize {
        let mut i = i;
        while self.0[i] as usize != i {
            self.0[i] = self.0[self.0[i] as usize];
            i = self.0[i] as usize;
        }
        i
    }

    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }

    fn count(&self) -> usize {
        self.0.iter().enumerate().filter(|&(i, &parent)| i == parent as usize).count()
    }
}
