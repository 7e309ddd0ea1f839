//! Which of the old shapes is which of the new ones.

use crate::geometry::mesh::Mesh;
use glam::DVec3;

/// Lengths of one shape agree within this share of its size: new facets of a curved face end a little elsewhere.
const NEAR: f64 = 1e-3;
/// Areas of one shape agree within this share.
const AREA: f64 = 1e-2;
/// Mean normals of one shape agree within this, of their length of 1 on a plane.
const NORMAL: f64 = 2e-2;

/// What some triangles look like from afar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// m2
    pub area: f64,
    /// Mean over the area, m.
    pub centroid: DVec3,
    /// Mean over the area: a unit vector for a plane, 0 for what is closed.
    pub normal: DVec3,
    /// Least and greatest coordinates, m.
    pub bounds: [DVec3; 2],
}

impl Shape {
    /// The shape of some triangles of a mesh.
    pub fn of(mesh: &Mesh, triangles: impl Iterator<Item = usize>) -> Shape {
        let (mut area, mut moment, mut normal) = (0.0, DVec3::ZERO, DVec3::ZERO);
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for i in triangles {
            let corners = mesh.corners(i);
            let own = mesh.area(i);
            area += own;
            moment += own / 3.0 * corners.iter().sum::<DVec3>();
            normal += 0.5 * mesh.cross(i);
            bounds = corners.iter().fold(bounds, |[low, high], v| [low.min(*v), high.max(*v)]);
        }
        // Slivers have no area; their faces still have a place.
        let of_area = |sum: DVec3, none: DVec3| if area > 0.0 { sum / area } else { none };
        Shape { area, centroid: of_area(moment, bounds[0]), normal: of_area(normal, DVec3::ZERO), bounds }
    }

    fn moved(self, by: DVec3) -> Shape {
        Shape { centroid: self.centroid + by, bounds: self.bounds.map(|corner| corner + by), ..self }
    }

    fn size(&self) -> f64 {
        (self.bounds[1] - self.bounds[0]).length()
    }

    /// The same form in the same orientation, anywhere.
    fn is_like(&self, other: &Shape) -> bool {
        let near = NEAR * self.size().max(other.size());
        let extent = |shape: &Shape| shape.bounds[1] - shape.bounds[0];
        let centre = |shape: &Shape| shape.centroid - shape.bounds[0];
        (self.area - other.area).abs() <= AREA * self.area.max(other.area)
            && (extent(self) - extent(other)).length() <= near
            && (centre(self) - centre(other)).length() <= near
            && (self.normal - other.normal).length() <= NORMAL
    }

    /// The same form in the same place.
    fn is(&self, other: &Shape) -> bool {
        let near = NEAR * self.size().max(other.size());
        self.is_like(other) && (self.bounds[0] - other.bounds[0]).length() <= near
    }
}

/// Something with a name and a shape.
#[derive(Clone, Debug)]
pub struct Thing {
    pub name: String,
    pub shape: Shape,
}

/// What became of a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// The same name and form in the same place.
    Same,
    /// Another name for the same.
    Renamed,
    /// The same form elsewhere, by this displacement, m.
    Moved(DVec3),
    /// Another name, elsewhere.
    RenamedAndMoved(DVec3),
    /// The same name, another form.
    Changed,
    Lost,
    New,
}

/// An old and a new thing that are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    pub old: Option<usize>,
    pub new: Option<usize>,
    pub fate: Fate,
}

/// Pairs old and new, each once, the surest first; `named`: things of one name are one, whatever their form. `by` (m) is how the old
/// ones have moved together.
pub fn pair(old: &[Thing], new: &[Thing], by: DVec3, named: bool) -> Vec<Pair> {
    let old: Vec<Thing> = old.iter().map(|one| Thing { shape: one.shape.moved(by), ..one.clone() }).collect();
    let (mut lost, mut found): (Vec<usize>, Vec<usize>) = ((0..old.len()).collect(), (0..new.len()).collect());
    let mut pairs = Vec::new();
    let mut take = |fits: &dyn Fn(&Thing, &Thing) -> Option<Fate>| {
        lost.retain(|&was| {
            let known = found.iter().enumerate().find_map(|(at, &is)| Some((at, fits(&old[was], &new[is])?)));
            if let Some((at, fate)) = known {
                pairs.push(Pair { old: Some(was), new: Some(found.remove(at)), fate });
            }
            known.is_none()
        });
    };
    let apart = |was: &Thing, is: &Thing| is.shape.bounds[0] - was.shape.bounds[0];
    take(&|was, is| (was.name == is.name && was.shape.is(&is.shape)).then_some(Fate::Same));
    take(&|was, is| was.shape.is(&is.shape).then_some(Fate::Renamed));
    take(&|was, is| (was.name == is.name && was.shape.is_like(&is.shape)).then(|| Fate::Moved(apart(was, is))));
    take(&|was, is| (named && was.name == is.name).then_some(Fate::Changed));
    take(&|was, is| was.shape.is_like(&is.shape).then(|| Fate::RenamedAndMoved(apart(was, is))));
    pairs.extend(lost.into_iter().map(|was| Pair { old: Some(was), new: None, fate: Fate::Lost }));
    pairs.extend(found.into_iter().map(|is| Pair { old: None, new: Some(is), fate: Fate::New }));
    pairs.sort_by_key(|pair| (pair.new.is_none(), pair.new, pair.old));
    pairs
}
