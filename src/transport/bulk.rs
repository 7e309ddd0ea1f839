//! Light is scattered on its way through a medium.

use super::walk::Walk;
use super::watch::Watch;
use crate::geometry::{Frame, Left};
use crate::optics::Stokes;
use crate::packet::{Event, Packet};
use crate::scene::Scene;
use crate::tally::layout::Cut;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Where light that could fly `most` (m) in a medium is scattered, m; `None` if it flies so far. The distance has density
/// c exp(-c s), c being the scattering coefficient (1/m).
pub fn free_path<const V: usize>(scene: &Scene, medium: u16, packet: &mut Packet<V>, most: f64) -> Option<f64> {
    let coefficient = scene.media[medium as usize].medium.bulk()?.coefficient(packet.wavelength);
    if coefficient <= 0.0 {
        return None;
    }
    let distance = -packet.rng.positive().ln() / coefficient;
    (distance < most).then_some(distance)
}

/// The packet is scattered where it is; true if it goes on.
pub fn scatter<const V: usize, W: Watch>(walk: &mut Walk<V, W>, packet: &mut Packet<V>, medium: u16) -> bool {
    let Some(bulk) = walk.scene.media[medium as usize].medium.bulk() else { return false };
    walk.watch.scattered(&packet.ray, medium, packet.flux());
    let spent = packet.ancestry.events >= walk.settings.max_events;
    if spent || walk.settings.max_scatters.is_some_and(|most| packet.ancestry.scatters >= most) {
        walk.book.cut(if spent { Cut::Events } else { Cut::Scatters }, packet.fluxes());
        return false;
    }
    let cosine = bulk.draw(packet.wavelength, &mut packet.rng);
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let across: DVec2 = sine * DVec2::from_angle(TAU * packet.rng.uniform());
    let towards: DVec3 = Frame::from_z(packet.ray.direction).to_world(across.extend(cosine)).normalize();
    packet.ray.direction = towards;
    packet.light = packet.light.map(|light| Stokes::unpolarised(light.i));
    packet.transverse = Frame::from_z(towards).x;
    packet.left = Left::nothing();
    packet.ancestry.step(medium.into(), Event::Bulk, false);
    true
}
