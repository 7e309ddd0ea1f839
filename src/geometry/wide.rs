//! A tree of boxes, several to a node, in single precision: it only proposes what the exact test decides.
//!
//! Lengths are in tree units: the scene is centred and scaled by a power of two so that coordinates lie in -1..1.
//! With u = 2^-24, the entry distance of a slab, (b - o) / d, is computed as fl(fl(b - o) fl(1/d)): relative error
//! 3u on a length of at most 2, plus u for rounding the origin; so a box face errs by at most 7u. Rounding the
//! vertices (u) and clipping large triangles to several boxes (10u) add to that. The boxes are made larger by
//! `PAD` = 32u on every side; what remains of it covers rays that come from up to 1e7 scene sizes away, whose
//! double-precision positions err by some 1e-16 of their distance.

use arrayvec::ArrayVec;

/// Boxes in one node.
pub(super) const WIDTH: usize = 4;

/// By how much every box is larger than what it holds, in tree units: 32 x 2^-24.
pub(super) const PAD: f32 = 1.907_348_6e-6;

/// The deepest tree that is accepted; it bounds the stack of the descent.
pub(super) const DEEPEST: usize = 64;

/// The pending boxes of a descent: all but one of each node on the way down.
const STACK: usize = DEEPEST * (WIDTH - 1) + 1;

/// `WIDTH` boxes and what they hold. An empty place has a box that nothing meets.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Least x, greatest x, least y, greatest y, least z, greatest z of each box.
    pub bounds: [[f32; WIDTH]; 6],
    /// Of a leaf the first slot, else the index of a node.
    pub first: [u32; WIDTH],
    /// Slots of a leaf; 0 for a node.
    pub count: [u32; WIDTH],
}

impl Node {
    /// No box at all.
    pub const EMPTY: Node = Node {
        bounds: [
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        first: [0; WIDTH],
        count: [0; WIDTH],
    };

    pub fn set(&mut self, place: usize, least: [f32; 3], greatest: [f32; 3]) {
        for axis in 0..3 {
            self.bounds[2 * axis][place] = least[axis];
            self.bounds[2 * axis + 1][place] = greatest[axis];
        }
    }

    /// Entry distance into each box, tree units, and a bit for each that the ray meets before `limit`.
    #[inline(always)]
    fn entries(&self, probe: &Probe, limit: f32) -> ([f32; WIDTH], u32) {
        let near = |axis: usize| &self.bounds[2 * axis + probe.backward[axis] as usize];
        let far = |axis: usize| &self.bounds[2 * axis + 1 - probe.backward[axis] as usize];
        let (xn, yn, zn) = (near(0), near(1), near(2));
        let (xf, yf, zf) = (far(0), far(1), far(2));
        let ([ox, oy, oz], [ix, iy, iz]) = (probe.origin, probe.inverse);
        let mut entries = [0f32; WIDTH];
        let mut met = 0;
        for i in 0..WIDTH {
            let enter = greater(greater((xn[i] - ox) * ix, (yn[i] - oy) * iy), greater((zn[i] - oz) * iz, 0.0));
            let leave = lesser(lesser((xf[i] - ox) * ix, (yf[i] - oy) * iy), lesser((zf[i] - oz) * iz, limit));
            entries[i] = enter;
            met |= ((enter <= leave) as u32) << i;
        }
        (entries, met)
    }
}

/// As one machine instruction; no NaN occurs (see `Probe`).
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// A ray in tree units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    origin: [f32; 3],
    /// 1 / direction, finite: a zero component becomes the greatest finite number, so that 0 x inf cannot occur.
    /// A ray within a box face of width zero is safe: the face is `PAD` away from anything real.
    inverse: [f32; 3],
    /// Whether the ray runs towards lesser coordinates.
    backward: [bool; 3],
}

impl Probe {
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Probe {
        let inverse = direction.map(|d| {
            let inverse = (1.0 / d.abs()).min(f32::MAX as f64) as f32;
            inverse.copysign(d as f32)
        });
        Probe { origin: origin.map(|x| x as f32), inverse, backward: direction.map(|d| d.is_sign_negative()) }
    }
}

/// A box still to be visited.
#[derive(Clone, Copy)]
struct Pending {
    entry: f32,
    first: u32,
    count: u32,
}

/// Visits the leaves the ray meets within `limit` (tree units), nearest boxes first. `visit(first)` tests the
/// slots of a leaf and returns the new limit.
#[inline(always)]
pub(super) fn descend(nodes: &[Node], probe: &Probe, mut limit: f32, mut visit: impl FnMut(u32) -> f32) {
    let mut stack = ArrayVec::<Pending, STACK>::new();
    let mut current = Pending { entry: 0.0, first: 0, count: 0 };
    loop {
        if current.count > 0 {
            limit = visit(current.first);
        } else if let Some(node) = nodes.get(current.first as usize)
            && let Some(nearest) = enter(node, probe, limit, &mut stack)
        {
            current = nearest;
            continue;
        }
        loop {
            let Some(next) = stack.pop() else { return };
            if next.entry <= limit {
                current = next;
                break;
            }
        }
    }
}

/// The nearest box of the node that the ray meets before `limit`; the others go on the stack, nearer ones last.
#[inline(always)]
fn enter(node: &Node, probe: &Probe, limit: f32, stack: &mut ArrayVec<Pending, STACK>) -> Option<Pending> {
    let (entries, mut met) = node.entries(probe, limit);
    let floor = stack.len();
    let mut next = || {
        let i = met.trailing_zeros() as usize;
        met &= met.wrapping_sub(1);
        (i < WIDTH).then(|| Pending { entry: entries[i], first: node.first[i], count: node.count[i] })
    };
    let mut nearest = next()?;
    while let Some(mut other) = next() {
        if other.entry < nearest.entry {
            std::mem::swap(&mut nearest, &mut other);
        }
        // The stack holds all that a tree of the accepted depth can leave pending, so no push fails.
        let Ok(()) = stack.try_push(other) else { continue };
        let mut place = stack.len() - 1;
        while place > floor && stack[place - 1].entry < stack[place].entry {
            stack.swap(place - 1, place);
            place -= 1;
        }
    }
    Some(nearest)
}
