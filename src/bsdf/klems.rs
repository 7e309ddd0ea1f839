//! A sheet measured or computed patch by patch: a matrix of BSDF between the patches of two hemispheres (Klems basis).
//!
//! A hemisphere is cut into rings of polar angle and these into sectors of equal azimuth, the first of which is centred on
//! azimuth 0. With patch i of the incident and patch o of the outgoing direction, the BSDF is the entry of the matrix:
//!
//!     f = F_oi    [1/sr]        albedo_i = sum over o of F_oi L_o        L_o = (sin^2 theta_2 - sin^2 theta_1) pi / n    [sr]
//!
//! with L_o the projected solid angle of patch o in a ring of n sectors. This function itself is drawn from - a patch by F_oi L_o,
//! then a direction uniform in projected solid angle - so that every draw carries the same weight.
//!
//! *Azimuths.* Patches of either hemisphere are known by the part of the light's *travel* along the sheet, in one pair of axes for
//! arriving and leaving light on both faces: light that goes straight on, and light that is mirrored, keeps its patch. Axis x is the
//! lay; seen from the back (towards which WINDOW's light from outside travels) azimuths rise counter-clockwise.
//!
//! Left out: polarisation, and what happens within a patch: a lobe narrower than a patch is as wide as the patch.
//! Source: Klems, ASHRAE Trans. 100(1), 1065 (1994). Azimuths as in Ward's Radiance (`bsdf_m.c`), whose z axis is the normal of WINDOW's back.

use super::Bsdf;
use crate::math::Rng;
use crate::math::alias::Alias;
use crate::optics::Incidence;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Patches of a hemisphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    rings: Vec<Ring>,
}

#[derive(Clone, Debug, PartialEq)]
struct Ring {
    /// sin^2 of the polar angles between which it lies.
    square: [f64; 2],
    sectors: usize,
    /// Index of its first patch.
    first: usize,
}

impl Basis {
    /// Rings up to each polar angle (rad, rising, the last pi/2) with a number of sectors (>= 1). `None` if they are not a hemisphere.
    pub fn new(rings: &[(f64, usize)]) -> Option<Basis> {
        let closed = rings.last().is_some_and(|(to, _)| (to - FRAC_PI_2).abs() < 1e-9);
        let rises = rings.first().is_some_and(|(to, _)| *to > 0.0) && rings.windows(2).all(|w| w[0].0 < w[1].0);
        if !closed || !rises || rings.iter().any(|(_, sectors)| *sectors == 0) {
            return None;
        }
        let (mut from, mut first) = (0.0, 0);
        let ring = |(at, &(to, sectors)): (usize, &(f64, usize))| {
            let edge = if at + 1 == rings.len() { 1.0 } else { to.sin().powi(2) };
            let ring = Ring { square: [from, edge], sectors, first };
            (from, first) = (edge, first + sectors);
            ring
        };
        Some(Basis { rings: rings.iter().enumerate().map(ring).collect() })
    }

    /// Number of patches.
    pub fn patches(&self) -> usize {
        self.rings.iter().map(|ring| ring.sectors).sum()
    }

    /// Projected solid angle of every patch, sr; together pi.
    pub fn areas(&self) -> Vec<f64> {
        let areas = |ring: &Ring| {
            let area = PI * (ring.square[1] - ring.square[0]) / ring.sectors as f64;
            std::iter::repeat_n(area, ring.sectors)
        };
        self.rings.iter().flat_map(areas).collect()
    }

    /// The patch of a unit vector with this part along the surface.
    pub fn patch(&self, along: DVec2) -> usize {
        let square = along.length_squared();
        let ring = self.rings.iter().find(|ring| square < ring.square[1]).unwrap_or(&self.rings[self.rings.len() - 1]);
        let turn = (along.y.atan2(along.x) / TAU).rem_euclid(1.0);
        ring.first + (turn * ring.sectors as f64 + 0.5) as usize % ring.sectors
    }

    /// Part along the surface of a direction uniform in the projected solid angle of a patch, by two numbers uniform in 0..1.
    fn draw(&self, patch: usize, uniform: [f64; 2]) -> DVec2 {
        // Turning a direction between axes moves it by 1e-15, which must not carry it into a patch that gets no light.
        let [u, v] = uniform.map(|u| u.clamp(1e-12, 1.0 - 1e-12));
        let ring = self.rings.iter().rfind(|ring| ring.first <= patch).unwrap_or(&self.rings[0]);
        let radius = (ring.square[0] + u * (ring.square[1] - ring.square[0])).sqrt();
        let azimuth = TAU * ((patch - ring.first) as f64 + v - 0.5) / ring.sectors as f64;
        DVec2::from_angle(azimuth) * radius
    }
}

/// The face of the sheet on which light arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Outside, in a window.
    Front,
    Back,
}

/// Where light goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Reflection,
    Transmission,
}

/// The matrix for light on one face that goes one way.
#[derive(Clone, Debug)]
pub struct Matrix {
    pub face: Face,
    pub way: Way,
    pub incident: Basis,
    pub outgoing: Basis,
    /// \[patch of incidence\]\[outgoing patch\], 1/sr, >= 0.
    pub value: Vec<f64>,
}

impl Matrix {
    /// Scattered / incident flux for every patch of incidence.
    pub fn albedo(&self) -> Vec<f64> {
        let areas = self.outgoing.areas();
        self.value.chunks(areas.len()).map(|row| row.iter().zip(&areas).map(|(f, area)| f * area).sum()).collect()
    }
}

/// Scatter by a [`Matrix`].
#[derive(Clone, Debug)]
pub struct Klems {
    matrix: Matrix,
    /// Scattered / incident flux of every patch of incidence.
    albedo: Vec<f64>,
    /// Outgoing patches in proportion to their flux, for every patch of incidence.
    flux: Vec<Alias>,
}

impl Klems {
    /// The matrix with every value multiplied by `scale` (>= 0). The caller sees to it that no more light leaves than arrives.
    pub fn new(mut matrix: Matrix, scale: f64) -> Klems {
        matrix.value.iter_mut().for_each(|f| *f *= scale);
        let areas = matrix.outgoing.areas();
        let row = |row: &[f64]| Alias::new(&row.iter().zip(&areas).map(|(f, area)| f * area).collect::<Vec<f64>>());
        let flux = matrix.value.chunks(areas.len()).map(row).collect();
        Klems { albedo: matrix.albedo(), flux, matrix }
    }

    /// Between the axes of the lay as the light sees them and those of the sheet: the light on the front sees its azimuths mirrored.
    fn mirrored(&self, d: DVec2) -> DVec2 {
        if self.matrix.face == Face::Front { DVec2::new(d.x, -d.y) } else { d }
    }

    /// The patch in which light arrives.
    fn incident(&self, at: &Incidence) -> usize {
        self.matrix.incident.patch(self.mirrored(at.along_lay(-at.wi.truncate())))
    }

    /// Sign of z where the light goes.
    fn side(&self) -> f64 {
        if self.matrix.way == Way::Transmission { -1.0 } else { 1.0 }
    }
}

impl Bsdf for Klems {
    fn eval(&self, at: &Incidence, wo: DVec3) -> f64 {
        if wo.z * self.side() <= 0.0 {
            return 0.0;
        }
        let outgoing = &self.matrix.outgoing;
        let patch = outgoing.patch(self.mirrored(at.along_lay(wo.truncate())));
        self.matrix.value[self.incident(at) * outgoing.patches() + patch]
    }

    fn pdf(&self, at: &Incidence, wo: DVec3) -> f64 {
        let f = self.eval(at, wo);
        if f > 0.0 { f * wo.z.abs() / self.albedo(at) } else { 0.0 }
    }

    fn sample(&self, at: &Incidence, rng: &mut Rng) -> Option<DVec3> {
        let incident = self.incident(at);
        let [first, second] = rng.pair();
        // What the choice of the patch leaves of the first number is uniform again.
        let (patch, rest) = self.flux[incident].draw(first);
        let along = at.from_lay(self.mirrored(self.matrix.outgoing.draw(patch, [rest, second])));
        let z = (1.0 - along.length_squared()).max(f64::MIN_POSITIVE).sqrt();
        (self.albedo[incident] > 0.0).then(|| along.extend(self.side() * z))
    }

    fn albedo(&self, at: &Incidence) -> f64 {
        self.albedo[self.incident(at)]
    }

    fn anisotropic(&self) -> bool {
        true
    }

    fn transmits(&self) -> bool {
        self.matrix.way == Way::Transmission
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn basis() -> Basis {
        Basis::new(&[(0.5, 1), (1.0, 4), (FRAC_PI_2, 8)]).expect("a hemisphere")
    }

    #[test]
    fn a_patch_holds_what_is_drawn_in_it() {
        let basis = basis();
        assert!((basis.areas().iter().sum::<f64>() - PI).abs() < 1e-14);
        for patch in 0..basis.patches() {
            for uv in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.3, 0.7]] {
                assert_eq!(basis.patch(basis.draw(patch, uv)), patch, "{uv:?}");
            }
        }
    }

    #[test]
    fn what_is_no_hemisphere_is_none() {
        for rings in [vec![], vec![(1.0, 4)], vec![(1.0, 4), (0.5, 1), (FRAC_PI_2, 2)], vec![(1.0, 0), (FRAC_PI_2, 2)]]
        {
            assert_eq!(Basis::new(&rings), None);
        }
    }

    /// A sheet that turns all light by a quarter counter-clockwise as seen from its back.
    fn quarter(face: Face, way: Way) -> Klems {
        let basis = Basis::new(&[(FRAC_PI_2, 4)]).expect("a hemisphere");
        let mut value = vec![0.0; 16];
        (0..4).for_each(|i| value[i * 4 + (i + 1) % 4] = 1.0);
        Klems::new(Matrix { face, way, incident: basis.clone(), outgoing: basis, value }, 1.0)
    }

    #[test]
    fn azimuths_rise_counter_clockwise_as_seen_from_the_back() {
        let at = Incidence { lay: DVec2::from_angle(1.0), ..Incidence::in_air(0.7, 550e-9) };
        let travel = -at.wi.truncate();
        for (face, turn) in [(Face::Front, -FRAC_PI_2), (Face::Back, FRAC_PI_2)] {
            for (way, side) in [(Way::Reflection, 0.7), (Way::Transmission, -0.7)] {
                let model = quarter(face, way);
                let turned = |angle: f64| DVec2::from_angle(angle).rotate(travel).extend(side);
                assert_eq!(model.eval(&at, turned(turn)), 1.0);
                assert_eq!(model.eval(&at, turned(-turn)), 0.0);
                assert_eq!(model.eval(&at, turned(0.0)), 0.0);
                assert_eq!(model.eval(&at, turned(turn) * DVec3::new(1.0, 1.0, -1.0)), 0.0);
                assert!((model.albedo(&at) - FRAC_PI_2 / 2.0).abs() < 1e-15);
            }
        }
    }
}
