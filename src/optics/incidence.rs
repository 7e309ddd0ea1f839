//! The geometry of one arrival at a surface, in the surface's own frame.

use glam::{DVec2, DVec3};
use num_complex::Complex64;

/// Light arriving at a surface. Local frame: z is the surface normal on the side the light comes from, so `wi.z > 0`.
#[derive(Clone, Copy, Debug)]
pub struct Incidence {
    /// Unit, local, pointing *away* from the surface towards where the light comes from; z > 0.
    pub wi: DVec3,
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// Complex index n + ik on the side of the light and beyond the surface, dimensionless.
    pub index: [Complex64; 2],
    /// Unit, local, along the surface: the direction from which anisotropic models count azimuths; any where there is none.
    pub lay: DVec2,
}

impl Incidence {
    /// cos of the angle of incidence, (0, 1].
    pub fn cos(&self) -> f64 {
        self.wi.z
    }

    /// A direction's part along the surface in the axes of the lay: along it and, a quarter turn on as the light sees it, across.
    pub fn along_lay(&self, d: DVec2) -> DVec2 {
        DVec2::new(self.lay.dot(d), self.lay.perp_dot(d))
    }

    /// Inverse of [`Incidence::along_lay`].
    pub fn from_lay(&self, d: DVec2) -> DVec2 {
        self.lay.rotate(d)
    }

    /// The same arrival at normal incidence's polar angle `theta` (rad) in the xz plane, air to air, the lay along x: for tables and tests.
    pub fn in_air(theta: f64, wavelength: f64) -> Incidence {
        let wi = DVec3::new(theta.sin(), 0.0, theta.cos());
        Incidence { wi, wavelength, index: [Complex64::ONE; 2], lay: DVec2::X }
    }
}
