//! The next thing a ray meets.
//!
//! Two rules keep a ray that starts on a surface from meeting that surface again, without moving its origin:
//!
//! 1. The triangles it has just left are never met.
//! 2. A point on a surface is known to delta = 16 x 2^-52 (scene radius + |x| + |y| + |z|), in m: a few roundings of a
//!    coordinate. If the origin is within delta of the plane of a triangle of the object it left, t |d . n| <= delta,
//!    the ray meets that triangle only if it arrives on the side on which it travels: leaving from the front it must
//!    arrive on a front. So the coplanar or convex neighbour touched at a shared edge is passed over, and the
//!    neighbour in a concave corner (what was left rises above its plane) is met even if rounding has put it behind
//!    the origin; but no farther behind than 1024 delta, where the ray runs within 1e-3 rad of the plane and the
//!    origin need not be near the corner. Everything else must lie in front of the origin: t > 0.
//!
//! Triangles *coincide* with the nearest one (index 0, unit normal n0) if they are parallel to it and no farther
//! behind it than the corners of both may be misplaced:
//!
//!     (t_j - t_0) |d . n0| <= tolerance_0 + tolerance_j   [m]        |n0 . nj| >= 0.99   [1]
//!
//! The descent therefore looks 2 x greatest tolerance / |d . n0| beyond the nearest hit.

use super::Ray;
use super::bvh::Bvh;
use super::crossing::{Crossing, Hit, Left, MOST_COINCIDENT};
use super::exact::Touch;
use super::leaf::Line;
use super::shear::{Meeting, Shear};
use super::wide::{Descent, PAD, Probe};
use arrayvec::ArrayVec;
use glam::DVec3;
use smallvec::SmallVec;

/// Least |cosine| between the normals of coinciding triangles, dimensionless (8 degrees).
const PARALLEL: f64 = 0.99;

/// How far behind the origin a concave corner may be met, in units of delta.
const BEHIND: f64 = 1024.0;

/// A triangle that may be the nearest or coincide with it.
#[derive(Clone, Copy)]
struct Candidate {
    number: u32,
    /// Unit, out of the front.
    normal: DVec3,
    front: bool,
    /// |d . n|, dimensionless.
    cosine: f64,
    /// Along the ray, m, not negative.
    distance: f64,
    /// Where the ray meets it, m.
    place: Place,
    /// True if the origin may lie on its plane.
    touched: bool,
}

/// Where a ray meets something.
#[derive(Clone, Copy)]
enum Place {
    /// At these weights of three vertices.
    Between([u32; 3], [f64; 3]),
    /// At this point of an exact face, m.
    At(DVec3),
    /// At its origin, which rounding has put beyond what is met.
    Origin,
}

impl Candidate {
    /// By distance; equal distances by number.
    fn rank(&self) -> (f64, u32) {
        (self.distance, self.number)
    }
}

/// The plane in which a ray meets something.
struct Plane {
    /// Unit, out of the front.
    normal: DVec3,
    /// m
    point: DVec3,
    /// Along the ray, m, negative behind the origin.
    distance: f64,
    front: bool,
}

/// The nearest candidates of a descent, in order.
struct Found {
    list: ArrayVec<Candidate, { 2 * MOST_COINCIDENT }>,
    /// What lies farther cannot coincide with the nearest, m.
    limit: f64,
    /// The least limit there has been, m: nothing nearer than this was passed over.
    searched: f64,
    /// The limit is never less than this, m.
    floor: f64,
}

impl Found {
    /// Nothing yet; everything nearer than `floor` (m) is wanted.
    fn within(floor: f64) -> Found {
        Found { list: ArrayVec::new(), limit: f64::INFINITY, searched: f64::INFINITY, floor }
    }

    /// Takes a candidate within the limit, `tolerance` being the greatest of the scene, m.
    fn insert(&mut self, candidate: Candidate, tolerance: f64) {
        // A triangle may be in two leaves; an exact face is met twice only at two distances.
        if self.list.iter().any(|c| c.number == candidate.number && c.distance == candidate.distance) {
            return;
        }
        let nearest = self.list.first().is_none_or(|first| candidate.rank() < first.rank());
        if nearest {
            // The reach is at least the sum of the tolerances of any two.
            let behind = if tolerance > 0.0 { 2.0 * tolerance / candidate.cosine } else { 0.0 };
            let limit = (candidate.distance + behind).max(self.floor);
            self.list.retain(|c| c.distance <= limit);
            (self.limit, self.searched) = (limit, self.searched.min(limit));
        }
        let place = if nearest { 0 } else { self.list.partition_point(|c| c.rank() < candidate.rank()) };
        if place == self.list.capacity() {
            return;
        }
        if self.list.is_full() {
            self.list.pop();
        }
        self.list.insert(place, candidate);
    }
}

/// A ray and what it has left, ready to be compared with triangles.
struct Query<'a> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    left: &'a Left,
    line: Line,
    shear: Shear,
    /// Uncertainty of the origin, m.
    delta: f64,
}

impl Bvh {
    /// The nearest triangle in front of `ray` and those that coincide with it; None if the ray escapes.
    pub fn nearest(&self, ray: &Ray, left: &Left) -> Option<Crossing> {
        let (entry, advance) = self.entry(ray)?;
        let probe = Probe::new(entry.to_array(), ray.direction.to_array());
        let shear = Shear::new(ray);
        let query =
            Query { bvh: self, ray, left, line: Line::new(entry, &shear), shear, delta: self.delta(ray.origin) };
        let mut found = Found::within(0.0);
        query.search(&probe, advance, &mut found);
        if found.limit > found.searched {
            // An earlier, farther hit had a shorter reach than the nearest: look again, as far as the nearest reaches.
            found = Found::within(found.limit);
            query.search(&probe, advance, &mut found);
        }
        query.crossing(&found)
    }

    /// What a point on a surface is known to, m.
    fn delta(&self, point: DVec3) -> f64 {
        16.0 * f64::EPSILON * (self.radius() + point.abs().element_sum())
    }

    /// A point on the first triangle of `left`, moved by what it is known to (see the module) towards the triangle's centroid:
    /// a ray that was reflected on an edge may start beyond it by a rounding, and miss the face behind that edge.
    pub fn inward(&self, point: DVec3, left: &Left) -> DVec3 {
        let centroid = left.first().map(|foot| match self.face(foot) {
            Some(face) => face.inner(point),
            None => self.triangle(foot).centroid(),
        });
        let towards = centroid.and_then(|centroid| (centroid - point).try_normalize());
        towards.map_or(point, |towards| point + self.delta(point) * towards)
    }

    /// Where the ray enters the box of the scene, tree units, and how far that is from its origin, m; None if it misses it.
    fn entry(&self, ray: &Ray) -> Option<(DVec3, f64)> {
        let origin = self.units.point(ray.origin);
        if origin.abs().max_element() <= 1.0 {
            return Some((origin, 0.0));
        }
        let inverse = ray.direction.recip();
        let [least, greatest] = self.bounds().map(|corner| self.units.point(corner));
        let (a, b) = ((least - PAD as f64 - origin) * inverse, (greatest + PAD as f64 - origin) * inverse);
        let (enter, leave) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        (enter <= leave).then(|| (origin + enter * ray.direction, enter / self.units.scale))
    }
}

impl Query<'_> {
    /// Descends the tree for all that can matter.
    fn search(&self, probe: &Probe, advance: f64, found: &mut Found) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            // SAFETY: the processor has just said that it has both.
            unsafe { self.search_avx2(probe, advance, found) };
        } else {
            self.descend(probe, advance, found);
        }
        #[cfg(not(target_arch = "x86_64"))]
        self.descend(probe, advance, found);
        if !self.bvh.faces.is_empty() {
            self.search_faces(probe, advance, found);
        }
    }

    /// Descends the tree of exact faces.
    fn search_faces(&self, probe: &Probe, advance: f64, found: &mut Found) {
        let mut descent = Descent::new(&self.bvh.face_tree.nodes, probe);
        while let Some(leaf) = descent.next(self.tree_limit(found.limit, advance)) {
            let face = self.bvh.face_tree.leaves[leaf];
            let number = (self.bvh.len() + face as usize) as u32;
            for touch in self.bvh.faces[face as usize].meet(self.ray) {
                if touch.distance <= found.limit {
                    let Touch { distance, point, normal, front } = touch;
                    // One that was left together with others may still lie ahead, by what they may be apart.
                    let apart = if self.left.has(number) { 2.0 * self.bvh.tolerance } else { 0.0 };
                    self.consider(number, Plane { normal, point, distance, front }, Place::At(point), apart, found);
                }
            }
        }
    }

    /// A distance (m) in tree units from the entry, rounded up; not below zero, where all entries begin.
    #[inline(always)]
    fn tree_limit(&self, limit: f64, advance: f64) -> f32 {
        (((limit - advance) * self.bvh.units.scale).max(0.0) as f32).next_up()
    }

    /// The same code compiled for processors of 2013 and later; the same bits, since nothing is contracted.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn search_avx2(&self, probe: &Probe, advance: f64, found: &mut Found) {
        self.descend(probe, advance, found);
    }

    #[inline(always)]
    fn descend(&self, probe: &Probe, advance: f64, found: &mut Found) {
        let mut descent = Descent::new(&self.bvh.tree.nodes, probe);
        let mut limit = f32::MAX;
        while let Some(leaf) = descent.next(limit) {
            let leaf = &self.bvh.tree.leaves[leaf];
            let mut met = leaf.proposes(&self.line);
            while met != 0 {
                self.test(leaf.triangle(met.trailing_zeros() as usize), found);
                met &= met - 1;
                limit = self.tree_limit(found.limit, advance);
            }
        }
    }

    /// The exact test: the only place that knows it to be a triangle.
    #[inline(always)]
    fn test(&self, (number, vertices): (u32, [u32; 3]), found: &mut Found) {
        if self.left.has(number) {
            return;
        }
        let triangle = self.bvh.between(vertices);
        let Some(meeting) = self.shear.meet(&triangle.vertices) else { return };
        if meeting.distance <= found.limit {
            let Meeting { distance, weights, front } = meeting;
            let plane = Plane { normal: triangle.normal(), point: triangle.vertices[0], distance, front };
            self.consider(number, plane, Place::Between(vertices, weights), 0.0, found);
        }
    }

    /// `apart`: how far beyond rounding it may still be what the ray stands on, m.
    fn consider(&self, number: u32, plane: Plane, place: Place, apart: f64, found: &mut Found) {
        let Plane { normal, distance, front, .. } = plane;
        let cosine = normal.dot(self.ray.direction).abs();
        let near = distance.abs() * cosine <= self.delta + apart;
        let foot = if near { self.left.on(number, self.bvh.object(number)) } else { None };
        let ahead = match foot {
            Some(foot) => self.goes_on(number, &plane, foot),
            None => distance > 0.0,
        };
        if ahead {
            let place = if distance < 0.0 { Place::Origin } else { place };
            let distance = distance.max(0.0) + 0.0; // never -0.0
            let touched = foot.is_some();
            found.insert(Candidate { number, normal, front, cosine, distance, place, touched }, self.bvh.tolerance);
        }
    }

    /// Whether the ray meets something on whose plane its origin may lie, given what it stands on.
    fn goes_on(&self, number: u32, plane: &Plane, foot: (u32, bool)) -> bool {
        let (left, side) = foot;
        let turned = self.left.turned(number, !plane.front);
        let behind = -plane.distance;
        // In a concave corner what was left rises above the plane, on the side where the ray arrives.
        let upward = if plane.front { plane.normal } else { -plane.normal };
        let rises = |v: DVec3| (v - plane.point).dot(upward) > self.delta;
        let concave = || match self.bvh.face(left) {
            Some(face) => rises(face.inner(self.ray.origin)),
            None => self.bvh.triangle(left).vertices.into_iter().any(rises),
        };
        let ahead = behind < 0.0 || (behind <= BEHIND * self.delta && concave());
        plane.front == side && !turned && ahead
    }

    /// The nearest candidate with those that coincide with it.
    fn crossing(&self, found: &Found) -> Option<Crossing> {
        let (nearest, others) = found.list.split_first()?;
        let hit = |c: &Candidate| {
            let object = self.bvh.object(c.number);
            Hit { triangle: c.number, object, front: c.front, normal: c.normal }
        };
        let first = hit(nearest);
        let mut hits: SmallVec<[Hit; 2]> = SmallVec::from_buf_and_len([first, first], 1);
        if !others.is_empty() {
            let tolerance = self.bvh.tolerance(first.triangle);
            let coincides = |c: &&Candidate| {
                let parallel = nearest.normal.dot(c.normal).abs() >= PARALLEL;
                let gap = (c.distance - nearest.distance) * nearest.cosine;
                parallel && gap <= tolerance + self.bvh.tolerance(c.number)
            };
            for other in others.iter().filter(coincides).map(hit).take(MOST_COINCIDENT - 1) {
                // An object cannot be met twice in the same sense without being left in between, and a curved face that is
                // met twice is met in two places.
                let last = hits.iter().rfind(|met: &&Hit| met.object == other.object);
                let itself = hits.iter().any(|met| met.triangle == other.triangle);
                if !itself && last.is_none_or(|met| met.front != other.front) {
                    hits.push(other);
                }
            }
        }
        let point = match nearest.place {
            Place::Between(vertices, weights) => self.bvh.between(vertices).at(weights),
            Place::At(point) => point,
            Place::Origin => self.ray.origin,
        };
        Some(Crossing { distance: nearest.distance, point, hits, cornered: nearest.touched })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Body;

    const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    const TURNED: [[u32; 3]; 2] = [[0, 2, 1], [0, 3, 2]];

    fn corners(z: f64) -> [DVec3; 4] {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z))
    }

    fn down(z: f64) -> Ray {
        Ray { origin: DVec3::new(0.5, -0.25, z), direction: -DVec3::Z }
    }

    #[test]
    fn surfaces_nearer_than_their_tolerances_coincide() {
        let [top, touching, below] = [0.0, -1.5e-7, -1e-3].map(corners);
        let bvh = Bvh::build(&[
            Body { vertices: &top, triangles: &SQUARE, tolerance: 1e-7, faces: &[], replaced: &[] },
            Body { vertices: &touching, triangles: &TURNED, tolerance: 1e-7, faces: &[], replaced: &[] },
            Body { vertices: &below, triangles: &SQUARE, tolerance: 1e-7, faces: &[], replaced: &[] },
        ]);
        let crossing = bvh.nearest(&down(2.0), &Left::nothing()).unwrap();
        let met: Vec<_> = crossing.hits.iter().map(|hit| (bvh.object(hit.triangle), hit.front)).collect();
        assert_eq!(met, [(0, true), (1, false)]);
        assert_eq!((crossing.distance, crossing.point), (2.0, DVec3::new(0.5, -0.25, 0.0)));
        let next = bvh.nearest(&down(0.0), &Left::after(&crossing, true, &Left::nothing())).unwrap();
        assert_eq!(bvh.object(next.hits[0].triangle), 2);
        assert_eq!(bvh.nearest(&down(-2.0), &Left::nothing()), None);
    }

    #[test]
    fn a_ray_that_starts_on_a_surface_it_did_not_leave_does_not_meet_it() {
        let bvh = Bvh::build(&[Body {
            vertices: &corners(0.0),
            triangles: &SQUARE,
            tolerance: 0.0,
            faces: &[],
            replaced: &[],
        }]);
        assert_eq!(bvh.nearest(&down(0.0), &Left::nothing()), None);
        assert_eq!(bvh.nearest(&Ray { origin: DVec3::NAN, direction: DVec3::NAN }, &Left::nothing()), None);
        assert_eq!(Bvh::build(&[]).nearest(&down(1.0), &Left::nothing()), None);
    }
}
