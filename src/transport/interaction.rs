//! Light meets a surface: the bill of what is reflected, transmitted, scattered and absorbed, and the branches that go on.

use super::backward::{connect, reverse};
use super::film;
use super::scatter;
use super::walk::Walk;
use super::watch::{Sight, Watch};
use crate::geometry::{Crossing, Frame, Hit};
use crate::math::Rng;
use crate::math::rng::mix;
use crate::optics::stokes::reframe;
use crate::optics::{Amplitudes, Incidence, Stokes, refraction};
use crate::packet::{Event, Packet};
use crate::scene::{Crossed, Scene};
use crate::surface::{Scattering, Shares, Surface};
use crate::tally::layout::{Cut, Loss};
use glam::{DVec2, DVec3};

/// What one arrival comes to, per lane. Stokes vectors are in the frame whose x is s, W.
pub(super) struct Bill<const V: usize> {
    pub(super) reflected: [Stokes; V],
    pub(super) transmitted: [Stokes; V],
    /// Scattered flux, W.
    pub(super) scattered: [f64; V],
}

impl<const V: usize> Bill<V> {
    pub(super) fn nothing() -> Bill<V> {
        Bill { reflected: [Stokes::ZERO; V], transmitted: [Stokes::ZERO; V], scattered: [0.0; V] }
    }
}

/// The meeting: geometry and models.
pub(super) struct Meeting<'a, const V: usize> {
    pub(super) crossed: Crossed,
    /// Whether light arrives at the front of the acting face.
    pub(super) front: bool,
    pub(super) part: u32,
    pub(super) surfaces: [&'a Surface; V],
    pub(super) shares: [Shares; V],
    pub(super) frame: Frame,
    /// The same for all lanes but for the lay of their surfaces.
    pub(super) at: [Incidence; V],
    /// Local direction of the refracted ray, if there is one.
    pub(super) refracted: Option<DVec3>,
}

/// Lets the packet meet what it has reached. Branches to follow later go to `walk.waiting`; true if `packet` itself goes on.
pub fn interact<const V: usize, W: Watch>(walk: &mut Walk<V, W>, packet: &mut Packet<V>, crossing: &Crossing) -> bool {
    let Some(crossed) = walk.scene.cross(&crossing.hits, &packet.solids) else {
        walk.book.lost(Loss::Crossing, packet.fluxes());
        return false;
    };
    packet.ray.origin = crossing.point;
    let Some(acting) = crossed.acting else {
        film::depart(packet, crossing, true);
        packet.solids = crossed.beyond;
        return true;
    };
    let meeting = meet(walk.scene, packet.ray.direction, packet.wavelength, crossed, acting);
    let backwards = walk.trail.is_some();
    let mut bill =
        if backwards { reverse::bill(walk.scene, packet, crossing, &meeting) } else { bill(&meeting, packet) };
    absorb(walk, packet, &meeting, &bill);
    watch(walk, packet, crossing, &meeting, &bill);
    limit(walk, packet, &meeting, &mut bill);
    if backwards {
        connect::beams(walk, packet, crossing, &meeting, &bill);
    }
    branch(walk, packet, crossing, &meeting, &bill)
}

/// Light of a direction and a vacuum wavelength (m) at a face.
pub(super) fn meet<const V: usize>(
    scene: &Scene,
    direction: DVec3,
    wavelength: f64,
    crossed: Crossed,
    hit: Hit,
) -> Meeting<'_, V> {
    let normal = if hit.front { hit.normal } else { -hit.normal };
    // x lies in the plane of incidence, so y is the direction of s.
    let frame = Frame::from_z_x(normal, -direction);
    let mut wi = frame.to_local(-direction);
    // At grazing incidence the sign of d.n may round the other way; the hit knows better.
    wi.z = wi.z.max(f64::MIN_POSITIVE);
    let index = crossed.media.map(|medium| scene.index(medium, wavelength));
    let surfaces: [&Surface; V] = std::array::from_fn(|lane| scene.surface(hit, lane));
    let at = surfaces.map(|surface| Incidence { wi, wavelength, index, lay: lay(surface, &frame) });
    let shares = each(&surfaces, |lane| surfaces[lane].shares(&at[lane]));
    let refracted = refraction::refract(wi, index[0].re, index[1].re);
    let part = scene.part_of[hit.triangle as usize];
    Meeting { crossed, front: hit.front, part, surfaces, shares, frame, at, refracted }
}

/// A value for every lane, worked out once for those that have the same surface.
pub(super) fn each<T: Clone, const V: usize>(surfaces: &[&Surface; V], value: impl Fn(usize) -> T) -> [T; V] {
    let mut all: [Option<T>; V] = [const { None }; V];
    for lane in 0..V {
        let known = surfaces[..lane].iter().rposition(|known| std::ptr::eq(*known, surfaces[lane]));
        all[lane] = known.and_then(|known| all[known].clone()).or_else(|| Some(value(lane)));
    }
    let mut lane = 0;
    all.map(|found| {
        lane += 1;
        found.unwrap_or_else(|| value(lane - 1))
    })
}

/// The lay of a surface along its tangent plane, local; x where it has none or stands upright.
fn lay(surface: &Surface, frame: &Frame) -> DVec2 {
    let along = surface.lay.and_then(|lay| frame.to_local(lay).truncate().try_normalize());
    along.unwrap_or(DVec2::X)
}

fn bill<const V: usize>(meeting: &Meeting<V>, packet: &Packet<V>) -> Bill<V> {
    let mut bill = Bill::nothing();
    let mut light = packet.light;
    if light.iter().any(|light| light.is_polarised()) {
        reframe(&mut light, packet.ray.direction, packet.transverse, meeting.frame.y);
    }
    for (lane, (light, shares)) in light.into_iter().zip(&meeting.shares).enumerate() {
        bill.scattered[lane] = light.i * shares.scattered;
        let Some(split) = shares.split else { continue };
        let reflected = split.reflected.apply(light) * shares.specular[0];
        let transmitted = transmit(meeting, lane, packet.ray.direction, split.transmitted, light) * shares.specular[1];
        if meeting.refracted.is_some() {
            bill.reflected[lane] = reflected;
            bill.transmitted[lane] = transmitted;
        } else {
            // Beyond the critical angle nothing passes (founding note, eq. 21): an ideal coating reflects it all.
            bill.reflected[lane] = reflected + transmitted;
        }
    }
    bill
}

/// What passes the surface of a lane, in the frame of s; some surfaces act along an axis of their own.
pub(super) fn transmit<const V: usize>(
    meeting: &Meeting<V>,
    lane: usize,
    direction: DVec3,
    passes: Amplitudes,
    light: Stokes,
) -> Stokes {
    // The axis as the ray sees it; one that it runs along acts like any other across it.
    let across = meeting.surfaces[lane].axis.and_then(|axis| axis.reject_from_normalized(direction).try_normalize());
    let Some(across) = across else { return passes.apply(light) };
    let mut lanes = [light];
    reframe(&mut lanes, direction, meeting.frame.y, across);
    lanes = lanes.map(|light| passes.apply(light));
    reframe(&mut lanes, direction, across, meeting.frame.y);
    lanes[0]
}

/// Books what stays here, from the models: a wrong sampler shows up in the residual.
fn absorb<const V: usize, W: Watch>(walk: &mut Walk<V, W>, packet: &Packet<V>, meeting: &Meeting<V>, bill: &Bill<V>) {
    let absorbed: [f64; V] =
        std::array::from_fn(|l| packet.light[l].i - bill.reflected[l].i - bill.transmitted[l].i - bill.scattered[l]);
    walk.book.absorbed_in_part(meeting.part, absorbed);
}

/// Books and removes what the user's limits cut.
fn limit<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &Packet<V>,
    meeting: &Meeting<V>,
    bill: &mut Bill<V>,
) {
    let ancestry = &packet.ancestry;
    let settings = walk.settings;
    let spent = ancestry.events >= settings.max_events;
    for (lane, surface) in meeting.surfaces.iter().enumerate() {
        if surface.scattering == Scattering::Off && bill.scattered[lane] > 0.0 {
            let mut cut = [0.0; V];
            cut[lane] = std::mem::take(&mut bill.scattered[lane]);
            walk.book.cut(Cut::ScatterOff, cut);
        }
    }
    if spent || settings.max_scatters.is_some_and(|most| ancestry.scatters >= most) {
        let cut = std::mem::replace(&mut bill.scattered, [0.0; V]);
        walk.book.cut(if spent { Cut::Events } else { Cut::Scatters }, cut);
    }
    if spent || settings.max_reflections.is_some_and(|most| ancestry.reflections >= most) {
        let cut = std::mem::replace(&mut bill.reflected, [Stokes::ZERO; V]);
        walk.book.cut(if spent { Cut::Events } else { Cut::Reflections }, cut.map(|light| light.i));
    }
    if settings.max_ghosts.is_some_and(|most| ancestry.ghosts >= most) && !meeting.surfaces[0].opaque() {
        let cut = std::mem::replace(&mut bill.reflected, [Stokes::ZERO; V]);
        walk.book.cut(Cut::Ghosts, cut.map(|light| light.i));
    }
    if spent {
        let cut = std::mem::replace(&mut bill.transmitted, [Stokes::ZERO; V]);
        walk.book.cut(Cut::Events, cut.map(|light| light.i));
    }
}

/// The specular ways on, in the order of the arrays below; the third is scatter.
const WAYS: [Event; 2] = [Event::Reflect, Event::Transmit];

/// Sends the branches off; the last one that lives goes on in `packet`, the others wait.
fn branch<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
) -> bool {
    let mut factors = choose(walk, packet, bill);
    let plan = (factors[2] > 0.0).then(|| scatter::plan(walk, packet, meeting, bill, factors[2]));
    if plan.as_ref().is_some_and(|plan| plan.branches == 0) {
        factors[2] = 0.0;
    }
    let Some(last) = (0..3).rev().find(|&way| factors[way] > 0.0) else { return false };
    for way in (0..last).filter(|&way| factors[way] > 0.0) {
        let mut child = packet.clone();
        child.ancestry.branch =
            mix(child.ancestry.branch ^ mix((child.ancestry.events as u64) << 2 | (way as u64 + 1)));
        child.rng = Rng::new(walk.seed, child.ancestry.history, child.ancestry.branch);
        if leave(&mut child, crossing, meeting, bill, WAYS[way], factors[way]) {
            walk.waiting.push(child);
        }
    }
    match plan.filter(|_| last == 2) {
        Some(plan) => scatter::scatter(walk, packet, crossing, meeting, bill, &plan),
        None => leave(packet, crossing, meeting, bill, WAYS[last], factors[last]),
    }
}

/// Factor on each way's flux: 0 where it is not followed, 1 where it is followed beside others, 1 / probability where it
/// was drawn in proportion to its part of the light. Specular ways are followed apart while the path has fewer than `splits` reflections
/// at interfaces, scatter while it has fewer than `scatter_splits` scatters.
fn choose<const V: usize, W: Watch>(walk: &Walk<V, W>, packet: &mut Packet<V>, bill: &Bill<V>) -> [f64; 3] {
    // The largest part that any lane has of its own light, so that no lane's way is drawn too rarely because another is brighter.
    let part = |flux: f64, lane: usize| if flux > 0.0 { flux / packet.light[lane].i } else { 0.0 };
    let most = |flux: [f64; V]| (0..V).map(|lane| part(flux[lane], lane)).fold(0.0, f64::max);
    let flux = [most(bill.reflected.map(|s| s.i)), most(bill.transmitted.map(|s| s.i)), most(bill.scattered)];
    let mut factors = flux.map(|f| (f > 0.0) as u8 as f64);
    if factors.iter().sum::<f64>() < 2.0 {
        return factors;
    }
    let specular_apart = packet.ancestry.ghosts < walk.settings.splits;
    let scatter_apart = packet.ancestry.scatters < walk.settings.scatter_splits;
    let pool: &[usize] = match (specular_apart, scatter_apart) {
        (true, true) => &[],
        (true, false) => &[1, 2],
        (false, true) => &[0, 1],
        (false, false) => &[0, 1, 2],
    };
    if pool.iter().filter(|&&way| flux[way] > 0.0).count() < 2 {
        return factors;
    }
    let total: f64 = pool.iter().map(|&way| flux[way]).sum();
    let mut rest = packet.rng.uniform() * total;
    let chosen = pool.iter().copied().filter(|&way| flux[way] > 0.0).find(|&way| {
        rest -= flux[way];
        rest < 0.0
    });
    // Rounding may leave a rest of zero: the last live way then.
    let chosen = chosen.or(pool.iter().copied().rev().find(|&way| flux[way] > 0.0));
    for &way in pool {
        factors[way] = if Some(way) == chosen { total / flux[way] } else { 0.0 };
    }
    factors
}

/// Turns `packet` into the specular branch that leaves by `way`; false if there is none.
fn leave<const V: usize>(
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
    way: Event,
    factor: f64,
) -> bool {
    let wi = meeting.at[0].wi;
    let (local, light) = match way {
        Event::Reflect => (Some(refraction::reflect(wi)), &bill.reflected),
        _ => (meeting.refracted, &bill.transmitted),
    };
    let Some(local) = local else { return false };
    packet.light = light.map(|light| light * factor);
    packet.transverse = meeting.frame.y;
    depart(packet, crossing, meeting, local, way);
    true
}

/// Sets off in local direction `local`.
pub(super) fn depart<const V: usize>(
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    local: DVec3,
    way: Event,
) {
    packet.ray.direction = meeting.frame.to_world(local).normalize();
    let passes = local.z < 0.0;
    film::depart(packet, crossing, passes);
    if passes {
        packet.solids = meeting.crossed.beyond;
    }
    packet.ancestry.step(meeting.part, way, meeting.surfaces[0].opaque());
}

fn watch<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
) {
    walk.watch.event(|| {
        let flux = packet.light[0].i;
        let leaving = [bill.reflected[0].i / flux, bill.transmitted[0].i / flux, bill.scattered[0] / flux];
        let wi = meeting.at[0].wi;
        Sight {
            depth: packet.ancestry.events,
            point: crossing.point,
            distance: crossing.distance,
            part: meeting.part,
            front: meeting.front,
            normal: meeting.frame.z,
            angle: wi.x.hypot(wi.y).atan2(wi.z),
            media: meeting.crossed.media,
            flux,
            fractions: [leaving[0], leaving[1], leaving[2], 1.0 - leaving.iter().sum::<f64>()],
            direction: packet.ray.direction,
            leaves: [
                Some(meeting.frame.to_world(refraction::reflect(wi))),
                meeting.refracted.map(|local| meeting.frame.to_world(local)),
            ],
        }
    });
}
