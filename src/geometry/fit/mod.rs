//! What a face of a mesh truly is: the simplest form that its corners lie on.
//!
//! | form     | numbers sought                    | start                                                       |
//! |----------|-----------------------------------|-------------------------------------------------------------|
//! | plane    | normal, height                    | eigenvector of the covariance of the corners                |
//! | sphere   | centre, radius                    | linear: p^2 - 2 C.p = R^2 - C^2                             |
//! | cylinder | axis, radius                      | the direction across all normals                            |
//! | cone     | axis, radius, taper               | the direction at one angle to all normals; the apex is on all facets |
//! | conic    | axis, vertex, radius, conic       | the sphere, about axes of the quadric through the corners   |
//! | asphere  | as a conic, and the coefficients  | the conic                                                   |
//!
//! Then the sum of squared distances is made least (`math::least_squares`), in coordinates about the centroid and in units of the
//! face, so that no digits are lost. Every distinct corner counts once: facets and edges of a mesh lie beside its surface, its corners lie on it.
//!
//! An axis is preferred to be one of those given (the centre line of a circular rim, of the node's other faces), then a coordinate axis, if the
//! corners do not mind. Left out: faces that are of two forms (a fillet that runs into a plane), toroids.
//! Source: Ahn, Least Squares Orthogonal Distance Fitting of Curves and Surfaces in Space (2004).

mod asphere;
mod cloud;
mod cone;
mod conic;
mod line;
mod plane;
mod revolution;
mod rim;
mod sphere;

use super::exact::Shape;
use glam::DVec3;

pub use cloud::Cloud;
pub use line::Line;
pub use rim::{Circle, rims};

/// Forms, the simplest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Plane,
    Sphere,
    Cylinder,
    Cone,
    Conic,
    Asphere,
}

/// A form with its numbers.
#[derive(Clone, Debug)]
pub struct Fit {
    pub kind: Kind,
    /// In the coordinates of the vertex, m.
    pub shape: Shape,
    /// Vertex, m: of a cylinder or a cone, the point of the axis at the middle of the face; of a plane, the point on the axis.
    pub at: DVec3,
    /// Unit; its largest component is positive. Of a plane the normal.
    pub axis: DVec3,
    /// False if the axis could be any other: a sphere's, unless it was given.
    pub has_axis: bool,
    /// Root mean square of the distances of the corners, m.
    pub rms: f64,
    /// Largest distance of a corner, m.
    pub max: f64,
    /// Standard error of the radius, m, and of the conic constant (of a cone: the taper), dimensionless, if the corners of one
    /// ring about the axis share their error, as by rounding, and the axis, where it was given, is true.
    pub errors: [f64; 2],
}

impl Fit {
    /// Radius of curvature, m, > 0 if the centre lies towards +`axis`; of a cylinder, or of a cone at `at`, the radius. Infinite for a plane.
    pub fn radius(&self) -> f64 {
        match &self.shape {
            Shape::Conic(conic) => 1.0 / conic.curvature,
            Shape::Cone { radius, .. } => *radius,
            Shape::Sag { sag, .. } => 1.0 / sag.base().curvature,
        }
    }

    /// Its centre line.
    pub fn line(&self) -> Line {
        Line { through: self.at, direction: self.axis }
    }
}

/// What is looked for.
#[derive(Clone, Debug)]
pub struct Search<'a> {
    /// Axes that are preferred, the best first.
    pub lines: &'a [Line],
    /// Powers of an asphere; none is looked for if it is empty.
    pub powers: &'a [u32],
    /// The largest distance of a corner from its form, m.
    pub tolerance: f64,
    /// What the distance may be by the rounding of the corners, m.
    pub rounding: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The form, or the nearest of those that were tried.
    pub fit: Fit,
    /// True if the corners lie on it.
    pub found: bool,
    /// The nearest form that is simpler.
    pub simpler: Option<Fit>,
}

/// The simplest form within the tolerance; `None` for a face of fewer than three corners.
pub fn fit(cloud: &Cloud, search: &Search) -> Option<Outcome> {
    let good = |fit: &Fit| fit.max <= search.tolerance;
    let mut tried: Vec<Fit> = Vec::new();
    for kind in [Kind::Plane, Kind::Sphere, Kind::Cylinder, Kind::Cone, Kind::Conic, Kind::Asphere] {
        tried.extend(search.form(cloud, kind));
        if kind == Kind::Sphere && cloud.is_strip() && tried.last().is_some_and(good) {
            tried.extend(search.ruled(cloud, tried.last().map_or(0.0, |sphere| sphere.rms)));
        }
        if tried.last().is_some_and(good) {
            break;
        }
    }
    let fits = tried.last().is_some_and(good);
    let best = if fits { tried.pop() } else { nearest(&mut tried) }?;
    let simpler = nearest(&mut tried.into_iter().filter(|fit| fit.kind < best.kind).collect());
    Some(Outcome { fit: best, found: fits, simpler })
}

/// The simplest of those that are hardly farther off than the best.
fn nearest(tried: &mut Vec<Fit>) -> Option<Fit> {
    let least = tried.iter().map(|fit| fit.rms).fold(f64::INFINITY, f64::min);
    let best = tried.iter().position(|fit| fit.rms <= 2.0 * least)?;
    Some(tried.swap_remove(best))
}

impl Search<'_> {
    /// The best of one kind: about a preferred axis if the corners do not mind, else about its own.
    fn form(&self, cloud: &Cloud, kind: Kind) -> Option<Fit> {
        let powers = self.powers;
        match kind {
            Kind::Plane => self.about(cloud, 3, &|line| plane::fit(cloud, line)),
            Kind::Sphere => self.about(cloud, 4, &|line| sphere::fit(cloud, line)),
            Kind::Cylinder => self.about(cloud, 5, &|line| cone::cylinder(cloud, line)),
            Kind::Cone => self.about(cloud, 6, &|line| cone::cone(cloud, line)),
            Kind::Conic => self.about(cloud, 7, &|line| conic::fit(cloud, line)),
            Kind::Asphere if powers.is_empty() => None,
            Kind::Asphere => self.about(cloud, 7 + powers.len(), &|line| asphere::fit(cloud, line, powers)),
        }
    }

    /// The cylinder or cone that is meant where a sphere fits as well: two circles are on all of them, but the facets between
    /// them are straight.
    fn ruled(&self, cloud: &Cloud, sphere: f64) -> Option<Fit> {
        let good = |fit: &Fit| fit.max <= self.tolerance && fit.rms <= sphere.max(self.rounding);
        [Kind::Cylinder, Kind::Cone].into_iter().filter_map(|kind| self.form(cloud, kind)).find(good)
    }

    /// `solve`: about a given axis, or a free one. `numbers`: how many are sought with a free axis.
    fn about(&self, cloud: &Cloud, numbers: usize, solve: &dyn Fn(Option<&Line>) -> Option<Fit>) -> Option<Fit> {
        // Corners that cannot contradict prove nothing. A plane is three corners, or more.
        if cloud.len() < if numbers == 3 { 3 } else { numbers + 3 } {
            return None;
        }
        let exact = |line: &Line| solve(Some(line)).filter(|fit| fit.max <= self.rounding);
        if let Some(fit) = self.lines.iter().find_map(exact) {
            return Some(fit);
        }
        let free = solve(None)?;
        if free.max > self.tolerance {
            return Some(free);
        }
        // A fixed axis costs four numbers: the sum of squares rises by 4 +- 2.8 times the variance of a corner.
        let most = free.rms * (1.0 + 12.0 / cloud.len() as f64).sqrt();
        let neat = free.line().neat(cloud.centre(), cloud.reach());
        let noisy = |line: &Line| solve(Some(line)).filter(|fit| fit.rms <= most || fit.max <= self.rounding);
        let better = self.lines.iter().chain(&neat).find_map(noisy);
        better.or(Some(free))
    }
}
