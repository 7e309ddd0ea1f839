//! The next thing a ray meets.
//!
//! Two rules keep a ray that starts on a surface from meeting that surface again, without moving its origin:
//!
//! 1. The triangles it has just left are never met.
//! 2. A point on a surface is known to delta = 16 x 2^-52 (scene radius + |origin|), in m: a few roundings of a
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
//! The descent therefore looks (tolerance_0 + greatest tolerance) / |d . n0| beyond the nearest hit.

use super::Ray;
use super::bvh::Bvh;
use super::crossing::{Crossing, Hit, Left, MOST_COINCIDENT};
use super::shear::{LEAF, Meeting, Shear};
use super::wide::{PAD, Probe, descend};
use arrayvec::ArrayVec;
use glam::DVec3;

/// Least |cosine| between the normals of coinciding triangles, dimensionless (8 degrees).
const PARALLEL: f64 = 0.99;

/// How far behind the origin a concave corner may be met, in units of delta.
const BEHIND: f64 = 1024.0;

/// A triangle that may be the nearest or coincide with it.
#[derive(Clone, Copy)]
struct Candidate {
    slot: u32,
    triangle: u32,
    /// Along the ray, m, not negative.
    distance: f64,
    meeting: Meeting,
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

/// A ray and what it has left, ready to be compared with triangles.
struct Query<'a> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    left: &'a Left,
    shear: Shear,
    /// Uncertainty of the origin, m.
    delta: f64,
}

impl Bvh {
    /// The nearest triangle in front of `ray` and those that coincide with it; None if the ray escapes.
    pub fn nearest(&self, ray: &Ray, left: &Left) -> Option<Crossing> {
        let (probe, advance) = self.probe(ray)?;
        let query = Query { bvh: self, ray, left, shear: Shear::new(ray), delta: self.delta(ray.origin) };
        let mut found = query.search(&probe, advance, 0.0);
        if found.limit > found.searched {
            // An earlier, farther hit had a shorter reach than the nearest: look again, as far as the nearest reaches.
            found = query.search(&probe, advance, found.limit);
        }
        query.crossing(&found)
    }

    /// What a point on a surface is known to, m.
    fn delta(&self, point: DVec3) -> f64 {
        16.0 * f64::EPSILON * (self.radius() + point.length())
    }

    /// A point on the first triangle of `left`, moved by what it is known to (see the module) towards the triangle's centroid:
    /// a ray that was reflected on an edge may start beyond it by a rounding, and miss the face behind that edge.
    pub fn inward(&self, point: DVec3, left: &Left) -> DVec3 {
        let centroid = left.first().map(|triangle| self.triangle(triangle).centroid());
        let towards = centroid.and_then(|centroid| (centroid - point).try_normalize());
        towards.map_or(point, |towards| point + self.delta(point) * towards)
    }

    /// The ray in tree units, and how far (m) its origin was moved to the box of the scene; None if it misses that.
    fn probe(&self, ray: &Ray) -> Option<(Probe, f64)> {
        let origin = self.units.point(ray.origin);
        if origin.abs().max_element() <= 1.0 {
            return Some((Probe::new(origin.to_array(), ray.direction.to_array()), 0.0));
        }
        let inverse = ray.direction.recip();
        let [least, greatest] = self.bounds().map(|corner| self.units.point(corner));
        let (a, b) = ((least - PAD as f64 - origin) * inverse, (greatest + PAD as f64 - origin) * inverse);
        let (enter, leave) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        let entered = origin + enter * ray.direction;
        (enter <= leave).then(|| (Probe::new(entered.to_array(), ray.direction.to_array()), enter / self.units.scale))
    }
}

impl Query<'_> {
    /// Descends the tree for all that can matter, and for everything nearer than `floor` (m).
    fn search(&self, probe: &Probe, advance: f64, floor: f64) -> Found {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            // SAFETY: the processor has just said that it has both.
            return unsafe { self.search_avx2(probe, advance, floor) };
        }
        self.descend(probe, advance, floor)
    }

    /// The same code compiled for processors of 2013 and later; the same bits, since nothing is contracted.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn search_avx2(&self, probe: &Probe, advance: f64, floor: f64) -> Found {
        self.descend(probe, advance, floor)
    }

    #[inline(always)]
    fn descend(&self, probe: &Probe, advance: f64, floor: f64) -> Found {
        let mut found = Found { list: ArrayVec::new(), limit: f64::INFINITY, searched: f64::INFINITY, floor };
        let scale = self.bvh.units.scale;
        // Rounded up; not below zero, where all entries begin.
        let tree_limit = |limit: f64| (((limit - advance) * scale).max(0.0) as f32).next_up();
        descend(&self.bvh.nodes, probe, f32::MAX, |first| {
            let mut met = self.shear.proposes(&self.bvh.leaves[first as usize / LEAF]);
            while met != 0 {
                self.test(first + met.trailing_zeros(), &mut found);
                met &= met - 1;
            }
            tree_limit(found.limit)
        });
        found
    }

    /// The exact test of what stands in one slot: the only place that knows it to be a triangle.
    #[inline(always)]
    fn test(&self, slot: u32, found: &mut Found) {
        let Some(meeting) = self.shear.meet(&self.bvh.corners(slot)) else { return };
        if meeting.distance <= found.limit {
            self.consider(slot, meeting, found);
        }
    }

    fn consider(&self, slot: u32, meeting: Meeting, found: &mut Found) {
        let triangle = self.bvh.triangles[slot as usize];
        if self.left.has(triangle) {
            return;
        }
        let ahead = match self.touches(slot, triangle, meeting.distance) {
            Some(foot) => self.goes_on(slot, triangle, foot, &meeting),
            None => meeting.distance > 0.0,
        };
        if ahead {
            let distance = meeting.distance.max(0.0) + 0.0; // never -0.0
            self.insert(Candidate { slot, triangle, distance, meeting }, found);
        }
    }

    fn insert(&self, candidate: Candidate, found: &mut Found) {
        let rank = |c: &Candidate| (c.distance, c.triangle);
        if found.list.iter().any(|c| c.triangle == candidate.triangle) {
            return;
        }
        let place = found.list.iter().position(|c| rank(&candidate) < rank(c)).unwrap_or(found.list.len());
        if place == found.list.capacity() {
            return;
        }
        if found.list.is_full() {
            found.list.pop();
        }
        found.list.insert(place, candidate);
        if place == 0 {
            let cosine = self.cosine(candidate.slot);
            let reach = self.bvh.tolerance(candidate.triangle) + self.bvh.tolerance;
            let behind = if reach > 0.0 { reach / cosine } else { 0.0 };
            let limit = (candidate.distance + behind).max(found.floor);
            found.list.retain(|c| c.distance <= limit);
            (found.limit, found.searched) = (limit, found.searched.min(limit));
        }
    }

    /// If the origin may lie on the plane of a triangle of an object it left: the triangle of that object it stands on, and
    /// the side it leaves from.
    fn touches(&self, slot: u32, triangle: u32, distance: f64) -> Option<(u32, bool)> {
        let foot = self.left.on(self.bvh.object(triangle))?;
        (distance.abs() * self.cosine(slot) <= self.delta).then_some(foot)
    }

    /// Whether the ray meets a triangle on whose plane its origin may lie.
    fn goes_on(&self, slot: u32, triangle: u32, (left, side): (u32, bool), meeting: &Meeting) -> bool {
        let turned = self.left.turned(triangle, !meeting.front);
        let behind = -meeting.distance;
        let ahead = behind < 0.0 || (behind <= BEHIND * self.delta && self.concave(slot, left, meeting.front));
        meeting.front == side && !turned && ahead
    }

    /// Whether what was left rises above the plane of a triangle on the side where the ray arrives.
    fn concave(&self, slot: u32, left: u32, front: bool) -> bool {
        let corners = self.bvh.corners(slot);
        let (at, normal) = (corners.vertices()[0], if front { corners.normal() } else { -corners.normal() });
        self.bvh.triangle(left).vertices.iter().any(|&v| (v - at).dot(normal) > self.delta)
    }

    /// |d . n|, dimensionless.
    fn cosine(&self, slot: u32) -> f64 {
        self.bvh.corners(slot).normal().dot(self.ray.direction).abs()
    }

    /// The nearest candidate with those that coincide with it.
    fn crossing(&self, found: &Found) -> Option<Crossing> {
        let nearest = found.list.first()?;
        let corners = self.bvh.corners(nearest.slot);
        let (cosine, tolerance) = (self.cosine(nearest.slot), self.bvh.tolerance(nearest.triangle));
        let coincides = |c: &Candidate| {
            let parallel = corners.normal().dot(self.bvh.corners(c.slot).normal()).abs() >= PARALLEL;
            let gap = (c.distance - nearest.distance) * cosine;
            parallel && gap <= tolerance + self.bvh.tolerance(c.triangle)
        };
        let hit =
            |c: &Candidate| Hit { triangle: c.triangle, object: self.bvh.object(c.triangle), front: c.meeting.front };
        let others = found.list.iter().skip(1).filter(|c| coincides(c)).map(hit);
        let hits = std::iter::once(hit(nearest)).chain(others).take(MOST_COINCIDENT).collect();
        let point = if nearest.meeting.distance < 0.0 { self.ray.origin } else { corners.at(nearest.meeting.weights) };
        let cornered = self.touches(nearest.slot, nearest.triangle, nearest.meeting.distance).is_some();
        Some(Crossing { distance: nearest.distance, point, hits, cornered })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Facet, Triangle};

    fn square(z: f64, object: u32, tolerance: f64, up: bool) -> [Facet; 2] {
        let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
        [[a, b, c], [a, c, d]].map(|[a, b, c]| {
            let vertices = if up { [a, b, c] } else { [a, c, b] };
            Facet { triangle: Triangle { vertices }, object, tolerance }
        })
    }

    fn down(z: f64) -> Ray {
        Ray { origin: DVec3::new(0.5, -0.25, z), direction: -DVec3::Z }
    }

    #[test]
    fn surfaces_nearer_than_their_tolerances_coincide() {
        let facets = [square(0.0, 0, 1e-7, true), square(-1.5e-7, 1, 1e-7, false), square(-1e-3, 2, 1e-7, true)];
        let bvh = Bvh::build(&facets.concat());
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
        let bvh = Bvh::build(&square(0.0, 0, 0.0, true));
        assert_eq!(bvh.nearest(&down(0.0), &Left::nothing()), None);
        assert_eq!(bvh.nearest(&Ray { origin: DVec3::NAN, direction: DVec3::NAN }, &Left::nothing()), None);
        assert_eq!(Bvh::build(&[]).nearest(&down(1.0), &Left::nothing()), None);
    }
}
