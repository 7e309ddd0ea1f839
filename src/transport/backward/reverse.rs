//! An event seen from its end: the ray has come the way that light will leave, and asks what light from each direction would give.
//!
//! The ray carries, as a Stokes vector a, what light of Stokes vector S would bring the detector: a . S watts. a stands in the frame of
//! the *light*, whose direction is against the ray's. Light passes an event by a Mueller matrix M, so before it a' = M^T a, with M for
//! light that comes from the new direction; scatter depolarises, so it keeps a_I only.

use crate::geometry::{Crossing, Hit};
use crate::optics::refraction;
use crate::optics::stokes::reframe;
use crate::packet::Packet;
use crate::scene::Scene;
use crate::surface::Scattering;
use crate::transport::interaction::{Bill, Meeting, meet, transmit};
use glam::DVec3;

/// The meeting of light that arrives from the local direction `from` (away from the surface) with what is at `crossing`; it may then
/// leave as the ray came. `None`: it meets nothing there.
fn opposite<'a, const V: usize>(
    scene: &'a Scene,
    packet: &Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    from: DVec3,
) -> Option<Meeting<'a, V>> {
    let direction = -meeting.frame.to_world(from);
    let crossed = if from.z > 0.0 {
        scene.cross(&crossing.hits, &packet.solids)
    } else {
        let turned: Vec<Hit> = crossing.hits.iter().map(|hit| Hit { front: !hit.front, ..*hit }).collect();
        scene.cross(&turned, &meeting.crossed.beyond)
    }?;
    let acting = crossed.acting?;
    Some(meet(scene, direction, packet.wavelength, crossed, acting))
}

/// What the event makes of what the ray carries, by the ways that light may come; the scattered share only guides the choice of a way.
pub fn bill<const V: usize>(scene: &Scene, packet: &Packet<V>, crossing: &Crossing, meeting: &Meeting<V>) -> Bill<V> {
    let mut bill = Bill::nothing();
    let mut carried = packet.light;
    if carried.iter().any(|light| light.is_polarised()) {
        reframe(&mut carried, -packet.ray.direction, packet.transverse, meeting.frame.y);
    }
    let mirrored = refraction::reflect(meeting.at[0].wi);
    let same = opposite(scene, packet, crossing, meeting, mirrored);
    let beyond = meeting.refracted.map(|local| (local, opposite(scene, packet, crossing, meeting, local)));
    for (lane, carried) in carried.into_iter().enumerate() {
        bill.scattered[lane] = carried.i * scattered(scene, packet, crossing, meeting, lane);
        if let Some(met) = &same
            && let Some(split) = met.shares[lane].split
        {
            let [reflected, transmitted] = met.shares[lane].specular;
            bill.reflected[lane] = split.reflected.transposed().apply(carried) * reflected;
            if met.refracted.is_none() {
                // What would pass is reflected beyond the critical angle.
                let turned = transmit(met, lane, travel(meeting, mirrored), split.transmitted.transposed(), carried);
                bill.reflected[lane] += turned * transmitted;
            }
        }
        bill.transmitted[lane] = match &beyond {
            Some((local, Some(met))) if met.refracted.is_some() => match met.shares[lane].split {
                Some(split) => {
                    let direction = travel(meeting, *local);
                    transmit(met, lane, direction, split.transmitted.transposed(), carried)
                        * met.shares[lane].specular[1]
                }
                None => continue,
            },
            // Light meets nothing on its way here.
            Some((_, None)) => carried,
            _ => continue,
        };
    }
    bill
}

/// Direction of travel of light that arrives from the local direction `from`.
fn travel<const V: usize>(meeting: &Meeting<V>, from: DVec3) -> DVec3 {
    -meeting.frame.to_world(from)
}

/// Share of the events that are followed as scatter: what the surface scatters from this side, or the other if that is more.
fn scattered<const V: usize>(
    scene: &Scene,
    packet: &Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    lane: usize,
) -> f64 {
    let own = meeting.shares[lane].scattered;
    let sides = &scene.parts[meeting.part as usize].surface;
    if sides[lane.min(sides.len() - 1)][0] == sides[lane.min(sides.len() - 1)][1] {
        return own;
    }
    let behind = opposite(scene, packet, crossing, meeting, DVec3::NEG_Z);
    behind.map_or(own, |met| own.max(met.surfaces[lane].albedo(&met.at[lane])[1].min(1.0 - own)))
}

/// (n'^2 / n^2) f cos(theta') of every lane for light from the local direction `from`, 1/sr; and its index n'.
pub fn values<const V: usize>(
    scene: &Scene,
    packet: &Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    from: DVec3,
) -> Option<([f64; V], f64)> {
    let met = opposite(scene, packet, crossing, meeting, from)?;
    let mut leaves = met.frame.to_local(-packet.ray.direction);
    // The event decides on which side light leaves, not the rounding of grazing directions.
    leaves.z = leaves.z.abs().max(f64::MIN_POSITIVE) * from.z.signum();
    let [here, there] = [meeting.at[0].index[0].re, met.at[0].index[0].re];
    let factor = (there / here).powi(2) * met.at[0].wi.z / leaves.z.abs();
    let value = |lane: usize| {
        let surface = met.surfaces[lane];
        let traced = surface.scattering == Scattering::On && !surface.lobes.is_empty();
        if traced { factor * surface.weigh(&met.at[lane], &met.shares[lane], leaves).value } else { 0.0 }
    };
    Some((std::array::from_fn(value), there))
}
