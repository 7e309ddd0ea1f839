//! Straight lines: axes of surfaces.

use glam::DVec3;

/// A line without ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point of it, m.
    pub through: DVec3,
    /// Unit; its largest component is positive.
    pub direction: DVec3,
}

/// Leanings (rad) and offsets (of the size) below which a coordinate axis is worth a try.
const NEAR: f64 = 1e-3;

/// The unit vector, or the opposite one, whose largest component is positive.
pub(super) fn oriented(direction: DVec3) -> DVec3 {
    let [x, y, z] = direction.to_array();
    // z before y before x where two are equal but for rounding.
    let largest =
        [z, y, x].into_iter().reduce(|a, b| if b.abs() > a.abs() * (1.0 + 1e-9) { b } else { a }).unwrap_or(z);
    if largest < 0.0 { -direction } else { direction }
}

impl Line {
    /// Through a point (m) along a unit vector.
    pub fn new(through: DVec3, direction: DVec3) -> Line {
        Line { through, direction: oriented(direction) }
    }

    /// The point of the line that is nearest to `p`, m.
    pub fn foot(&self, p: DVec3) -> DVec3 {
        self.through + (p - self.through).dot(self.direction) * self.direction
    }

    /// How far a point is from the line, m.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.foot(p).distance(p)
    }

    /// Whether two lines are one within `slack` (m), as far as `reach` (m) from `near`.
    pub fn same(&self, other: &Line, near: DVec3, reach: f64, slack: f64) -> bool {
        [-reach, reach].into_iter().all(|t| self.distance(other.foot(near) + t * other.direction) <= slack)
    }

    /// The round numbers beside this line: along a coordinate axis if it leans by less than 1e-3, through the origin or a
    /// coordinate axis if it passes that by less than 1e-3 of `reach` (m), the size of the face about `near`. `None` if there are none.
    pub fn neat(&self, near: DVec3, reach: f64) -> Option<Line> {
        let lean = |axis: &DVec3| self.direction.cross(*axis).length();
        let direction = DVec3::AXES.into_iter().find(|axis| lean(axis) < NEAR).unwrap_or(self.direction);
        let at = self.foot(near);
        let across = at - at.dot(direction) * direction;
        let rounded = across.to_array().map(|x| if x.abs() < NEAR * reach { 0.0 } else { x });
        let through = DVec3::from_array(rounded);
        // What was rounded must still be the point nearest to the origin.
        let line = Line { through: through - through.dot(direction) * direction, direction };
        (direction != self.direction || through != across).then_some(line)
    }
}
