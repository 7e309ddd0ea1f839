//! What a ray meets, and what it has just left.

use glam::DVec3;
use smallvec::SmallVec;

/// Most triangles reported at one place; of more, the nearest.
pub const MOST_COINCIDENT: usize = 8;

/// One triangle or exact face met by a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Its number.
    pub triangle: u32,
    /// The object it is part of.
    pub object: u32,
    /// True if the ray arrives on the front, against the normal. Within some 1e-15 rad of grazing the sign of
    /// direction . normal may differ, since this one follows from the exact test: every closed surface is
    /// entered as often as it is left.
    pub front: bool,
    /// Unit, out of the front; zero for triangles above some 1e77 m.
    pub normal: DVec3,
}

/// The nearest thing a ray meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// Of the first hit, m.
    pub distance: f64,
    /// On the first triangle, m: from its corners, so as accurate as they are however far the ray came. The origin of
    /// the ray if rounding has put the triangle behind it.
    pub point: DVec3,
    /// The nearest hit, then those that coincide with it within their tolerances, in order of distance (equal
    /// distances: of index). Never empty.
    pub hits: SmallVec<[Hit; 2]>,
    /// True if the ray started within rounding of the first triangle and that is of the object it had left: it has
    /// gone from one triangle of a corner to another without moving.
    pub cornered: bool,
}

/// The triangles a ray starts on, so that it does not meet them again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Left {
    /// What it stands on, the nearest first.
    feet: SmallVec<[Foot; 2]>,
    /// Triangles of the same corner that were left before without moving, and on which side: not met from the other
    /// side, or a ray through a concave edge would pass from one to the other and back for ever.
    corner: SmallVec<[(u32, bool); 1]>,
}

/// A triangle that a ray starts on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Foot {
    /// Never met if it is flat: it cannot be met twice in a row.
    triangle: u32,
    object: u32,
    /// Whether the ray leaves from its front: direction . normal > 0.
    front: bool,
}

impl Left {
    /// A ray that starts in free space.
    pub fn nothing() -> Left {
        Left::default()
    }

    /// A ray that starts on one triangle of an object, from its front or its back.
    pub fn one(triangle: u32, object: u32, front: bool) -> Left {
        Left { feet: SmallVec::from_iter([Foot { triangle, object, front }]), corner: SmallVec::new() }
    }

    /// A ray that goes on from `crossing`: to the other side (`passes`), or back to the side it came from. `before` is
    /// what it had left when it arrived there.
    pub fn after(crossing: &Crossing, passes: bool, before: &Left) -> Left {
        let mut corner = SmallVec::new();
        if crossing.cornered {
            let latest = before.feet.first().map(|foot| (foot.triangle, foot.front));
            corner.extend(latest.into_iter().chain(before.corner.iter().copied()).take(MOST_COINCIDENT));
        }
        let foot = |hit: &Hit| Foot { triangle: hit.triangle, object: hit.object, front: hit.front != passes };
        let first = foot(&crossing.hits[0]);
        let mut feet = SmallVec::from_buf_and_len([first, first], 1);
        feet.extend(crossing.hits[1..].iter().map(foot));
        Left { feet, corner }
    }

    /// The nearest triangle that the ray starts on.
    pub fn first(&self) -> Option<u32> {
        self.feet.first().map(|foot| foot.triangle)
    }

    /// Whether the ray starts on this triangle.
    pub fn has(&self, triangle: u32) -> bool {
        self.feet.iter().any(|foot| foot.triangle == triangle)
    }

    /// Where the ray stands on `object`: on `number` itself or else on the first of its triangles, and whether it leaves from
    /// the front.
    pub fn on(&self, number: u32, object: u32) -> Option<(u32, bool)> {
        let own = self.feet.iter().find(|foot| foot.triangle == number);
        let foot = own.or_else(|| self.feet.iter().find(|foot| foot.object == object));
        foot.map(|foot| (foot.triangle, foot.front))
    }

    /// Whether the ray has left this triangle on this side earlier in the same corner.
    pub fn turned(&self, triangle: u32, front: bool) -> bool {
        self.corner.contains(&(triangle, front))
    }
}
