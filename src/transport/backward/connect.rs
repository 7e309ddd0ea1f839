//! Where a ray that is followed backwards meets light.

use super::reverse::values;
use crate::geometry::{Crossing, Frame, Left, Ray};
use crate::medium::absorption;
use crate::optics::stokes::reframe;
use crate::packet::{Event, Packet};
use crate::scene::Scene;
use crate::source::Reach;
use crate::transport::interaction::{Bill, Meeting};
use crate::transport::walk::Walk;
use crate::transport::watch::Watch;

/// The light of every beam that reaches `crossing` straight and is scattered there to where the ray came from.
pub fn beams<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
) {
    let Some(trail) = &walk.trail else { return };
    if packet.film.is_some() || bill.scattered.iter().all(|scattered| *scattered <= 0.0) {
        return;
    }
    let (backward, sources) = (trail.backward, trail.sources);
    for &number in sources.iter().filter(|source| backward.reaches[**source as usize] == Reach::Beam) {
        let source = &walk.scene.sources[number as usize];
        let direction = source.direction(packet.rng.pair());
        let from = meeting.frame.to_local(-direction);
        // Beams start outside all solids.
        let inside = if from.z > 0.0 { &packet.solids } else { &meeting.crossed.beyond };
        let Some((way, irradiance)) = source.behind(packet.ray.origin, direction).filter(|_| inside.is_empty()) else {
            continue;
        };
        let Some((values, index)) = values(walk.scene, packet, crossing, meeting, from) else { continue };
        if values.iter().all(|value| *value <= 0.0) {
            continue;
        }
        let left = Left::after(crossing, from.z < 0.0, &packet.left);
        let ray = Ray { origin: packet.ray.origin, direction: -direction };
        walk.book.segments += 1;
        let Some(passes) = clear(walk.scene, ray, left, way, packet.wavelength) else { continue };
        let factor = irradiance * passes / (index * index);
        let flux = std::array::from_fn(|lane| {
            let alive = (bill.scattered[lane] > 0.0) as u8 as f64;
            alive * packet.light[lane].i * values[lane] * factor
        });
        let mut path = packet.ancestry.clone();
        path.step(meeting.part, Event::Scatter, false);
        path.optical_path += way * walk.scene.index(walk.scene.ambient, packet.wavelength).re;
        walk.found(&path.reversed(number), flux);
    }
}

/// What the ambient lets through over `way` (m) along a ray that nothing stops; `None` if something does.
fn clear(scene: &Scene, mut ray: Ray, mut left: Left, way: f64, wavelength: f64) -> Option<f64> {
    let mut rest = way;
    let mut solids = Default::default();
    while let Some(crossing) = scene.geometry.nearest(&ray, &left).filter(|crossing| crossing.distance < rest) {
        let crossed = scene.cross(&crossing.hits, &solids)?;
        if crossed.acting.is_some() {
            return None;
        }
        solids = crossed.beyond;
        rest -= crossing.distance;
        (ray.origin, left) = (crossing.point, Left::after(&crossing, true, &left));
    }
    let scattered = scene.media[scene.ambient as usize].medium.bulk().map_or(0.0, |bulk| bulk.coefficient(wavelength));
    let index = scene.index(scene.ambient, wavelength);
    Some((-(absorption(index, wavelength) + scattered) * way).exp())
}

/// The light of every plane that shines along the flight before it has gone `most` (m).
pub fn planes<const V: usize, W: Watch>(walk: &mut Walk<V, W>, packet: &Packet<V>, most: f64) {
    let Some(trail) = &walk.trail else { return };
    let (backward, sources, direction) = (trail.backward, trail.sources, -packet.ray.direction);
    for &number in sources.iter().filter(|source| backward.reaches[**source as usize] == Reach::Plane) {
        let source = &walk.scene.sources[number as usize];
        let Some((way, irradiance)) = source.behind(packet.ray.origin, direction).filter(|(way, _)| *way < most) else {
            continue;
        };
        let radiance = irradiance * source.towards(direction);
        if radiance <= 0.0 {
            continue;
        }
        let index = walk.scene.index(walk.scene.medium_in(&packet.solids), packet.wavelength);
        let passes = (-absorption(index, packet.wavelength) * way).exp();
        let mut carried = packet.light;
        let axis = Frame::from_z_x(direction, source.polarization.reference).x;
        if carried.iter().any(|light| light.is_polarised()) {
            reframe(&mut carried, direction, packet.transverse, axis);
        }
        let factor = radiance * passes / (index.re * index.re);
        let flux = carried.map(|carried| carried.dot(source.polarization.stokes) * factor);
        let mut path = packet.ancestry.clone();
        path.optical_path += way * index.re;
        walk.found(&path.reversed(number), flux);
    }
}
