//! Where light goes on each surface: mirrored, passed, scattered, absorbed, at a few angles.

use crate::optics::{Incidence, refraction};
use crate::scene::Scene;
use crate::surface::Surface;
use glam::DVec3;
use std::collections::BTreeSet;

/// Angles of incidence that are shown, deg.
pub const ANGLES: [f64; 4] = [0.0, 45.0, 75.0, 85.0];

/// The budget of a surface between two media.
#[derive(Clone, Debug)]
pub struct Budget {
    pub surface: String,
    /// Names of the media on the side of the light and beyond.
    pub media: [String; 2],
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// At each of `ANGLES`.
    pub shares: [Share; ANGLES.len()],
}

/// Fractions of unpolarised incident flux.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// Specular reflectance.
    pub mirrored: f64,
    /// Scattered back.
    pub diffuse: f64,
    /// Specular transmittance.
    pub passed: f64,
    /// Scattered through.
    pub spread: f64,
}

impl Share {
    /// What stays, 0..1; negative if more leaves than arrives.
    pub fn absorbed(&self) -> f64 {
        1.0 - self.mirrored - self.diffuse - self.passed - self.spread
    }
}

/// A surface in use: its index and the media on the side of the light and beyond.
pub(super) type Use = (u32, [u16; 2]);

/// Every surface in use with the media around it, each once.
pub(super) fn uses(scene: &Scene) -> BTreeSet<Use> {
    let both = |part| {
        let [front, back] = scene.sides(part);
        let [ahead, behind] = part.surface[0];
        [(ahead, [front, back]), (behind, [back, front])]
    };
    scene.parts.iter().flat_map(both).collect()
}

/// Unpolarised light that arrives at angle `theta` (rad) with vacuum wavelength `wavelength` (m).
pub(super) fn share(scene: &Scene, surface: &Surface, media: [u16; 2], theta: f64, wavelength: f64) -> Share {
    let index = media.map(|medium| scene.index(medium, wavelength));
    let wi = DVec3::new(theta.sin(), 0.0, theta.cos());
    let at = Incidence { index, ..Incidence::in_air(theta, wavelength) };
    let shares = surface.shares(&at);
    let [back, through] = if surface.lobes.is_empty() { [0.0; 2] } else { surface.albedo(&at) };
    let power = |of: fn(&crate::optics::Split) -> f64| shares.split.as_ref().map_or(0.0, of);
    let mut share = Share {
        mirrored: shares.specular[0] * power(|split| split.reflected.unpolarised()),
        passed: shares.specular[1] * power(|split| split.transmitted.unpolarised()),
        diffuse: shares.lobes[0] * back,
        spread: shares.lobes[1] * through,
    };
    if refraction::refract(wi, index[0].re, index[1].re).is_none() {
        share.mirrored += std::mem::take(&mut share.passed);
    }
    share
}

pub(super) fn budgets(scene: &Scene) -> Vec<Budget> {
    let range = scene.sources.first().map_or([550e-9; 2], |source| source.spectrum.range());
    let wavelength = 0.5 * (range[0] + range[1]);
    let budget = |(index, media): Use| {
        let surface = &scene.surfaces[index as usize];
        Budget {
            surface: surface.label.clone(),
            media: media.map(|medium| scene.media[medium as usize].label.clone()),
            wavelength,
            shares: ANGLES.map(|angle| share(scene, surface, media, angle.to_radians(), wavelength)),
        }
    };
    uses(scene).into_iter().map(budget).collect()
}
