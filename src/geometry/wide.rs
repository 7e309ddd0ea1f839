//! A tree of boxes, several to a node, in single precision: it only proposes what the exact test decides.
//!
//! Lengths are in tree units: the scene is centred and scaled by a power of two so that coordinates lie in -1..1.
//! The box faces of a node are stored in steps of 1/255 of its extent, rounded outwards, q = 0..255 (Ylitie, Karras,
//! Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", HPG 2017): two cache lines a node.
//!
//! With u = 2^-24, the distance to a face, (q s + b - o) / d, is computed as fl(fl(q A) + B), A = fl(s / d) and
//! B = fl(fl(b - o) / d): 6u from q A on a length of at most 2, 4u from B, 2u from the sum and u for rounding the origin;
//! so a box face errs by at most 13u. Rounding the vertices adds u. The boxes are made larger by `PAD` = 32u on every
//! side; what remains of it covers rays that come from up to 1e7 scene sizes away, whose double-precision positions err
//! by some 1e-16 of their distance.

use arrayvec::ArrayVec;

/// Boxes in one node.
pub(super) const WIDTH: usize = 8;

/// By how much every box is larger than what it holds, in tree units: 32 x 2^-24.
pub(super) const PAD: f32 = 1.907_348_6e-6;

/// The deepest tree that is accepted; it bounds the stack of the descent.
pub(super) const DEEPEST: usize = 64;

/// The pending boxes of a descent: all but one of each node on the way down.
const STACK: usize = DEEPEST * (WIDTH - 1) + 1;

/// What is in a box: a leaf or another node, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    pub fn leaf(index: usize) -> Child {
        Child(index as u32 | Child::LEAF)
    }

    pub fn node(index: usize) -> Child {
        Child(index as u32)
    }
}

/// Least and greatest corner, tree units.
pub(super) type Extent = [[f32; 3]; 2];

/// Up to `WIDTH` boxes and what they hold.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Least x, greatest x, least y, greatest y, least z, greatest z of each box, steps from `base`.
    faces: [[u8; WIDTH]; 6],
    children: [Child; WIDTH],
    /// Least corner of all boxes, tree units.
    base: [f32; 3],
    /// Tree units.
    step: [f32; 3],
    count: u32,
}

impl Node {
    /// These boxes and what they hold.
    pub fn new(held: &[(Extent, Child)]) -> Node {
        let mut node = Node {
            faces: [[0; WIDTH]; 6],
            children: [Child(0); WIDTH],
            base: [0.0; 3],
            step: [0.0; 3],
            count: held.len().min(WIDTH) as u32,
        };
        for axis in 0..3 {
            let least = held.iter().fold(f32::INFINITY, |least, (extent, _)| least.min(extent[0][axis]));
            let greatest = held.iter().fold(f32::NEG_INFINITY, |greatest, (extent, _)| greatest.max(extent[1][axis]));
            node.base[axis] = least;
            node.step[axis] = ((greatest - least) / 255.0).next_up();
            // The quotients of doubles are good to 1e-14 of a step: far below what `PAD` allows.
            let steps = |x: f32| (x as f64 - least as f64) / node.step[axis] as f64;
            for (place, (extent, _)) in held.iter().enumerate().take(WIDTH) {
                node.faces[2 * axis][place] = steps(extent[0][axis]).floor() as u8;
                node.faces[2 * axis + 1][place] = steps(extent[1][axis]).ceil() as u8;
            }
        }
        node.children.iter_mut().zip(held).for_each(|(place, (_, child))| *place = *child);
        node
    }

    /// Entry distance into each box, tree units, and a bit for each that the ray meets before `limit`.
    #[inline(always)]
    fn entries(&self, probe: &Probe, limit: f32) -> ([f32; WIDTH], u32) {
        let near = |axis: usize| &self.faces[2 * axis + probe.backward[axis] as usize];
        let far = |axis: usize| &self.faces[2 * axis + 1 - probe.backward[axis] as usize];
        let (xn, yn, zn) = (near(0), near(1), near(2));
        let (xf, yf, zf) = (far(0), far(1), far(2));
        let [(xa, xb), (ya, yb), (za, zb)] = [self.line(0, probe), self.line(1, probe), self.line(2, probe)];
        let (mut entries, mut met) = ([0f32; WIDTH], [0u32; WIDTH]);
        for i in 0..WIDTH {
            let (x, y, z) = (xn[i] as f32 * xa + xb, yn[i] as f32 * ya + yb, zn[i] as f32 * za + zb);
            let enter = greater(greater(x, y), greater(z, 0.0));
            let (x, y, z) = (xf[i] as f32 * xa + xb, yf[i] as f32 * ya + yb, zf[i] as f32 * za + zb);
            let leave = lesser(lesser(x, y), lesser(z, limit));
            entries[i] = enter;
            met[i] = ((enter <= leave) as u32) << i;
        }
        (entries, met.iter().fold(0, |all, met| all | met) & ((1 << self.count) - 1))
    }

    /// A and B of the module's formula along one axis.
    #[inline(always)]
    fn line(&self, axis: usize, probe: &Probe) -> (f32, f32) {
        (self.step[axis] * probe.inverse[axis], (self.base[axis] - probe.origin[axis]) * probe.inverse[axis])
    }
}

/// As one machine instruction; no NaN occurs in a ray of numbers (see `Probe`).
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Greatest 1 / direction.
const STEEPEST: f64 = 1e30;

/// A ray in tree units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    origin: [f32; 3],
    /// 1 / direction, finite: a zero component becomes a number so great that any length, times it, is beyond the scene, and
    /// so small that no product overflows: 0 x inf and inf - inf cannot occur.
    /// A ray within a box face of width zero is safe: the face is `PAD` away from anything real.
    inverse: [f32; 3],
    /// Whether the ray runs towards lesser coordinates.
    backward: [bool; 3],
}

impl Probe {
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Probe {
        let inverse = direction.map(|d| {
            let inverse = (1.0 / d.abs()).min(STEEPEST) as f32;
            inverse.copysign(d as f32)
        });
        Probe { origin: origin.map(|x| x as f32), inverse, backward: direction.map(|d| d.is_sign_negative()) }
    }
}

/// A box still to be visited.
#[derive(Clone, Copy)]
struct Pending {
    entry: f32,
    child: Child,
}

/// A descent through the tree: the leaves that a ray meets, nearest boxes first.
pub(super) struct Descent<'a> {
    nodes: &'a [Node],
    probe: &'a Probe,
    stack: ArrayVec<Pending, STACK>,
}

impl<'a> Descent<'a> {
    #[inline(always)]
    pub fn new(nodes: &'a [Node], probe: &'a Probe) -> Descent<'a> {
        let mut stack = ArrayVec::new();
        stack.push(Pending { entry: 0.0, child: Child::node(0) });
        Descent { nodes, probe, stack }
    }

    /// The next leaf within `limit` (tree units), which must not grow.
    #[inline(always)]
    pub fn next(&mut self, limit: f32) -> Option<usize> {
        loop {
            let Pending { entry, child: Child(mut child) } = self.stack.pop()?;
            if entry > limit {
                continue;
            }
            loop {
                if child & Child::LEAF != 0 {
                    return Some((child ^ Child::LEAF) as usize);
                }
                let Some(Child(nearest)) = enter(&self.nodes[child as usize], self.probe, limit, &mut self.stack)
                else {
                    break;
                };
                child = nearest;
            }
        }
    }
}

/// The nearest box of the node that the ray meets before `limit`; the others go on the stack, nearer ones last.
#[inline(always)]
fn enter(node: &Node, probe: &Probe, limit: f32, stack: &mut ArrayVec<Pending, STACK>) -> Option<Child> {
    let (entries, mut met) = node.entries(probe, limit);
    if met == 0 {
        return None;
    }
    let floor = stack.len();
    let i = met.trailing_zeros() as usize % WIDTH;
    let mut nearest = Pending { entry: entries[i], child: node.children[i] };
    met &= met - 1;
    while met != 0 {
        let i = met.trailing_zeros() as usize % WIDTH;
        met &= met - 1;
        let mut other = Pending { entry: entries[i], child: node.children[i] };
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
    Some(nearest.child)
}
