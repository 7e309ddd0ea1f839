//! A look from a detector: rays that go backwards and ask for no source.
//!
//! What a detector of area A gets of the radiance L of things, in units of L / n^2 (n where the light starts), is
//!
//!     F = A sum of (L / n^2) omega,      omega = (1 / A) integral of tau n_d^2 cos(theta) dw dA      [sr]
//!
//! with tau what the way from the thing lets through and n_d the index at the detector: the projected solid angle in which a thing is
//! seen, weighed with what arrives of its light and averaged over the detector. All directions together have pi n_d^2. Every ray
//! carries its share of that. What becomes of it - absorbed, escaped, cut - is in the ledger, in sr.

use super::{Backward, choose};
use crate::scene::Scene;
use crate::transport::importance::Lit;
use crate::transport::walk::Walk;
use crate::transport::watch::Watch;
use std::f64::consts::PI;

/// Which ray of a look.
#[derive(Clone, Copy, Debug)]
pub struct Glance {
    pub detector: usize,
    /// Number of the ray among all of the look.
    pub history: u64,
    /// Rays that share the solid angle.
    pub share: u64,
    /// Vacuum wavelength, m.
    pub wavelength: f64,
}

impl Backward {
    /// What looks need to know: nothing but where the detectors are.
    pub fn looking(scene: &Scene) -> Backward {
        Backward::new(scene, Lit::default())
    }

    /// Area with which a detector looks, m2, both sides if it looks to both; 0 if it is at infinity.
    pub fn area(&self, detector: usize) -> f64 {
        self.detectors[detector].iter().map(|side| side.extent.area()).sum()
    }

    /// Follows one ray, which has the coordinates `u`. The detector is not at infinity.
    pub fn look<'a, W: Watch>(&'a self, walk: &mut Walk<'a, 1, W>, glance: Glance, u: &mut dyn FnMut(u32) -> f64) {
        let sides = &self.detectors[glance.detector];
        let side = &sides[choose(u(5), sides.len())];
        let mut birth = side.emit(u);
        birth.wavelength = glance.wavelength;
        let (mut packet, index) = self.sets_off(walk, side, birth, (glance.detector, glance.history), &[]);
        let weight = PI * index * index / glance.share as f64;
        packet.light = packet.light.map(|light| light * weight);
        walk.history(&mut packet);
    }
}
