//! A lens as lens-design programs write it: surfaces one after another, each with what fills the space behind it.
//!
//! *Axes.* Every surface has its own: z along the optical axis, the vertex at the origin. The vertex of the next one lies at
//! z = thickness; behind a mirror thicknesses are negative. A decentred or tilted surface moves the axes by
//! [`Surface::before`] on the way in and by [`Surface::after`] on the way out, so that
//!
//!     axes of surface i+1 = axes of surface i . after_i . (shift by thickness_i) . before_(i+1)
//!
//! Every program's way of writing tilts is translated to that: a coordinate break is a surface with a `before` alone, "decentre and
//! return" has after = before^-1, a bend has after = its tilt once more.
//!
//! *Units.* SI. Wavelengths are what the file says, taken as vacuum wavelengths, as glass catalogues take them: 0.03 % between
//! air and vacuum stay with the author of the file.

// A problem is large because it says much; it is made once, and ends the reading.
#![allow(clippy::result_large_err)]

mod motion;
pub mod paraxial;
mod profile;
pub mod real;

pub use motion::Motion;
pub use profile::{Curve, Profile, Term};

use crate::error::Problem;

/// A whole lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescription {
    /// Title of the file, may be empty.
    pub name: String,
    /// From the object (first) to the image (last): two or more.
    pub surfaces: Vec<Surface>,
    /// Index of the aperture stop; `None`: the first surface behind the object limits the beam.
    pub stop: Option<usize>,
    /// How wide the beam is.
    pub aperture: Aperture,
    /// Points of the field, in the file's order; empty: the axis.
    pub fields: Vec<Field>,
    /// Wavelength (m) and weight (dimensionless), one or more.
    pub wavelengths: Vec<(f64, f64)>,
    /// Index of the reference wavelength.
    pub primary: usize,
    /// What the file says and this does not hold, in the file's order.
    pub notes: Vec<Note>,
}

/// Something in a file that was not translated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Line, counted from 1; `None` in files whose lines mean nothing.
    pub line: Option<u32>,
    /// What it says and what was made of it.
    pub text: String,
}

/// One surface and the space behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its name or comment, may be empty.
    pub label: String,
    /// Its form.
    pub profile: Profile,
    /// Distance to the next vertex along z, m, negative behind an odd number of mirrors; infinite for an object at infinity.
    pub thickness: f64,
    /// What it does and what fills the space behind it.
    pub material: Material,
    /// Radius of the part that is used, m, if the file says it.
    pub semi_diameter: Option<f64>,
    /// What the file says of holes, rims and masks.
    pub openings: Vec<Opening>,
    /// Motion of the axes on the way in.
    pub before: Motion,
    /// Motion of the axes on the way out, before the thickness.
    pub after: Motion,
}

/// What is behind a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Air, or vacuum.
    Air,
    /// The surface reflects; the light stays in the medium it came from.
    Mirror,
    /// The medium goes on: the surface has no optical effect (coordinate breaks).
    Previous,
    /// A catalogue glass, its name as the file writes it (CODE V leaves hyphens out).
    Glass {
        /// Name, `N-BK7` or `NBK7`.
        name: String,
        /// Whose catalogue, if said.
        maker: Option<String>,
    },
    /// A glass of which only two numbers are known.
    Model {
        /// Index at 587.6 nm, dimensionless.
        nd: f64,
        /// Abbe number, dimensionless; infinite: no dispersion.
        vd: f64,
    },
    /// A glass whose indices the file lists.
    Private {
        /// Name in the file.
        name: String,
        /// Wavelength (m) and index (dimensionless), rising.
        indices: Vec<(f64, f64)>,
    },
}

/// A boundary drawn on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// What it bounds.
    pub role: Role,
    /// Its outline.
    pub outline: Outline,
    /// Its centre in the surface's x and y, m.
    pub centre: [f64; 2],
}

/// What a boundary bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Light passes inside only.
    Clear,
    /// Light is stopped inside.
    Obscured,
    /// There is no material inside.
    Hole,
    /// There is no material outside: the rim of the part.
    Edge,
}

/// The outline of a boundary, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// Radius.
    Circle(f64),
    /// Half sides along x and y.
    Rectangle(f64, f64),
    /// Half axes along x and y.
    Ellipse(f64, f64),
}

/// How wide the beam is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aperture {
    /// Diameter of the entrance pupil, m.
    EntrancePupil(f64),
    /// Focal length / diameter of the entrance pupil, whatever the object distance.
    ImageFNumber(f64),
    /// 1 / (2 n' u') at the image of the object.
    WorkingFNumber(f64),
    /// n sin of the marginal ray's angle at the object.
    ObjectNa(f64),
    /// n' sin of the marginal ray's angle at the image.
    ImageNa(f64),
    /// Radius of the stop, m.
    Stop(f64),
}

/// One point of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Where.
    pub point: FieldPoint,
    /// What is cut off its beam.
    pub vignetting: Vignetting,
}

/// A point of the field, along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldPoint {
    /// Angles to the axis, rad: the ray runs along (tan x, tan y, 1).
    ObjectAngle([f64; 2]),
    /// Place on the object, m.
    ObjectHeight([f64; 2]),
    /// Place in the paraxial image, m.
    ImageHeight([f64; 2]),
}

/// Parts of the pupil's radius that are cut off on each side, dimensionless: at `upper` the pupil ends at y = 1 - upper, at `lower`
/// at y = -(1 - lower).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vignetting {
    /// At negative x.
    pub left: f64,
    /// At positive x.
    pub right: f64,
    /// At negative y.
    pub lower: f64,
    /// At positive y.
    pub upper: f64,
}

/// The real index of a material at a wavelength (m), `None` if it is not known. It is asked for [`Material::Air`], but
/// not for mirrors and what goes on.
pub type Index<'a> = &'a dyn Fn(&Material, f64) -> Option<f64>;

impl Surface {
    /// A plane in air of no thickness and without name.
    pub fn plane() -> Surface {
        Surface {
            label: String::new(),
            profile: Profile::sphere(0.0),
            thickness: 0.0,
            material: Material::Air,
            semi_diameter: None,
            openings: Vec::new(),
            before: Motion::NONE,
            after: Motion::NONE,
        }
    }
}

impl Prescription {
    /// The reference wavelength, m.
    pub fn wavelength(&self) -> f64 {
        self.wavelengths[self.primary].0
    }

    /// What fills the space behind surface `i`: a mirror's and a coordinate break's is that before it.
    pub fn medium(&self, i: usize) -> &Material {
        let fills = |s: &&Surface| !matches!(s.material, Material::Mirror | Material::Previous);
        self.surfaces[..=i].iter().rev().find(fills).map_or(&Material::Air, |s| &s.material)
    }

    /// Index behind every surface at `wavelength` (m), dimensionless, positive. Fails with the first material that `index`
    /// does not know.
    pub fn indices(&self, index: Index, wavelength: f64) -> Result<Vec<f64>, Problem> {
        let one = |i: usize| {
            let medium = self.medium(i);
            index(medium, wavelength).filter(|n| n.is_finite() && *n > 0.0).ok_or_else(|| {
                Problem::error(format!("no index of {medium} at {:.1} nm", wavelength * 1e9))
                    .on(format!("surface {i}"))
                    .expecting("a material whose data reach that wavelength")
            })
        };
        (0..self.surfaces.len()).map(one).collect()
    }

    /// Axes of every surface in those of surface 1 before it moves: where things are. The object's are its own if it is
    /// at infinity.
    pub fn frames(&self) -> Vec<Motion> {
        let (mut frames, mut at) = (Vec::new(), Motion::NONE);
        for (i, surface) in self.surfaces.iter().enumerate() {
            let object = i == 0;
            if object && surface.thickness.is_finite() {
                at = Motion::shift(glam::DVec3::Z * -surface.thickness);
            }
            at = at.then(surface.before);
            frames.push(at);
            let way = if object && surface.thickness.is_infinite() { 0.0 } else { surface.thickness };
            at = at.then(surface.after).then(Motion::shift(glam::DVec3::Z * way));
        }
        frames
    }
}

/// `N-BK7 (SCHOTT)`, `glass 1.517/64.2`.
impl std::fmt::Display for Material {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Material::Air => out.write_str("air"),
            Material::Mirror => out.write_str("mirror"),
            Material::Previous => out.write_str("the medium before"),
            Material::Glass { name, maker: Some(maker) } => write!(out, "{name} ({maker})"),
            Material::Glass { name, maker: None } | Material::Private { name, .. } => out.write_str(name),
            Material::Model { nd, vd } => write!(out, "glass {nd}/{vd}"),
        }
    }
}
