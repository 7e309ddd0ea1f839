//! Scattered light goes on: how many branches, where to, and what each weighs.

use super::backward::reverse;
use super::importance::{Advice, Occasion};
use super::interaction::{Bill, Meeting, depart, each};
use super::walk::Walk;
use super::watch::Watch;
use crate::bsdf::Weighed;
use crate::geometry::{Crossing, Frame};
use crate::math::Rng;
use crate::math::rng::mix;
use crate::optics::{Stokes, refraction};
use crate::packet::{Event, Packet};
use crate::surface::Surface;
use crate::tally::layout::Cut;

/// Lobes that are nowhere denser than this (1/sr) in the specular direction are broad; a Lambertian one has 0.32.
const BROAD: f64 = 4.0;

/// The branches that scattered light goes on in.
pub struct Plan<'a> {
    pub branches: u32,
    advice: Advice<'a>,
    /// On the flux of each.
    factor: f64,
    /// Flux below which a branch that was aimed will be drawn for, W.
    level: f64,
    /// Where the draws of the branches begin, 0..1: they take turns among the ways to draw a direction.
    turn: f64,
}

/// Decides in how many branches the scattered light (`factor` times what the bill says) goes on, and books what that cuts.
pub fn plan<'a, const V: usize, W: Watch>(
    walk: &mut Walk<'a, V, W>,
    packet: &mut Packet<V>,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
    factor: f64,
) -> Plan<'a> {
    let importance = walk.importance;
    let surface = meeting.surfaces[0];
    let flux = factor * bill.scattered.iter().fold(0.0, |most: f64, flux| most.max(*flux));
    let specular = refraction::reflect(meeting.at[0].wi);
    let broad = importance.map.is_none() || surface.weigh(&meeting.at[0], &meeting.shares[0], specular).density < BROAD;
    let occasion = Occasion {
        source: packet.ancestry.source,
        part: meeting.part,
        front: meeting.front,
        triangle: meeting.triangle,
        point: packet.ray.origin,
        flux,
        start: walk.start,
        level: packet.level,
        broad,
        opaque: surface.opaque(),
    };
    let mut advice = importance.advise(walk.scene, &occasion);
    if advice.is_plain() && walk.trail.is_none() {
        return Plan { branches: 1, advice, factor, level: 0.0, turn: 0.0 };
    }
    walk.book.guided += 1;
    if importance.map.is_some() && advice.lobes < 1.0 {
        let turn = advice.lobes + (1.0 - advice.lobes) * packet.rng.uniform();
        if let Some(world) = advice.aim(turn, &mut packet.rng) {
            let lobes = surface.weigh(&meeting.at[0], &meeting.shares[0], meeting.frame.to_local(world)).density;
            let aimed = advice.density(world, 0.0) / (1.0 - advice.lobes);
            advice.balance(lobes, aimed);
        }
    }
    if walk.trail.is_some() {
        advice.spread();
    }
    let (whole, part) = (advice.branches.floor(), advice.branches.fract());
    let branches = whole + (part > 0.0 && packet.rng.uniform() < part) as u8 as f64;
    let left = 1.0 - branches / advice.branches;
    walk.book.cut(Cut::Roulette, bill.scattered.map(|flux| factor * flux * left));
    let level = if importance.map.is_none() { flux } else { 0.0 };
    let factor = factor / advice.branches;
    Plan { branches: branches as u32, advice, factor, level, turn: packet.rng.uniform() }
}

/// Sends the branches off: the last that lives goes on in `packet`, the others wait. False if none lives.
pub fn scatter<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
    plan: &Plan,
) -> bool {
    for branch in 1..plan.branches {
        let mut child = packet.clone();
        let address = mix((child.ancestry.events as u64) << 32 | (branch as u64) << 2 | 3);
        child.ancestry.branch = mix(child.ancestry.branch ^ address);
        child.rng = Rng::new(walk.seed, child.ancestry.history, child.ancestry.branch);
        if one(walk, &mut child, crossing, meeting, bill, plan, branch) {
            walk.waiting.push(child);
        }
    }
    one(walk, packet, crossing, meeting, bill, plan, 0)
}

/// Turns `packet` into branch `branch`; false if it carries nothing.
fn one<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &mut Packet<V>,
    crossing: &Crossing,
    meeting: &Meeting<V>,
    bill: &Bill<V>,
    plan: &Plan,
    branch: u32,
) -> bool {
    let (at, surfaces, shares) = (&meeting.at, &meeting.surfaces, &meeting.shares);
    // The direction comes from the mixture of all lanes; each lane weighs its own value against the mixture's density.
    let mixture = mixture(bill, surfaces);
    let turn = (f64::from(branch) + plan.turn) / f64::from(plan.branches);
    let aimed = turn >= plan.advice.lobes;
    let drawn = if aimed {
        plan.advice.aim(turn, &mut packet.rng).map(|world| meeting.frame.to_local(world))
    } else {
        let lane = lane(&mixture, &mut packet.rng);
        surfaces[lane].draw(&at[lane], &shares[lane], &mut packet.rng)
    };
    let Some(wo) = drawn else { return false };
    let weighed: [Weighed; V] = each(surfaces, |l| surfaces[l].weigh(&at[l], &shares[l], wo));
    let lobes: f64 = (0..V).map(|l| mixture[l] * weighed[l].density).sum();
    let density = if plan.advice.is_plain() { lobes } else { plan.advice.density(meeting.frame.to_world(wo), lobes) };
    let values = match &walk.trail {
        None => weighed.map(|weighed| weighed.value),
        Some(_) => reverse::values(walk.scene, packet, crossing, meeting, wo).map_or([0.0; V], |(values, _)| values),
    };
    for (l, value) in values.into_iter().enumerate() {
        // `scattered` may have been cut to zero by a limit in this lane only.
        let alive = (bill.scattered[l] > 0.0) as u8 as f64;
        let flux = alive * packet.light[l].i * value / density;
        packet.light[l] = Stokes::unpolarised(flux * plan.factor);
    }
    if packet.flux() == 0.0 || !plan.advice.is_plain() && !survives(walk, packet, plan, wo.z.abs(), [density, lobes]) {
        return false;
    }
    packet.level = if aimed { plan.level } else { 0.0 };
    depart(packet, crossing, meeting, wo, Event::Scatter);
    packet.transverse = Frame::from_z(packet.ray.direction).x;
    true
}

/// Draws for a branch whose flux is worth less than a whole one; false if it ends. The mean is unchanged.
fn survives<const V: usize, W: Watch>(
    walk: &mut Walk<V, W>,
    packet: &mut Packet<V>,
    plan: &Plan,
    cosine: f64,
    densities: [f64; 2],
) -> bool {
    let chance = plan.advice.survival(packet.flux(), cosine, densities, walk.start);
    if chance >= 1.0 {
        return true;
    }
    let alive = packet.rng.uniform() < chance;
    let kept = if alive { 1.0 / chance } else { 0.0 };
    walk.book.cut(Cut::Roulette, packet.fluxes().map(|flux| flux * (1.0 - kept)));
    packet.light = packet.light.map(|light| light * kept);
    alive
}

/// Shares of the lanes in the lobes that are drawn from: every surface that scatters has as much as any other, however little light it
/// scatters, so that no lane is drawn from another's lobes alone.
fn mixture<const V: usize>(bill: &Bill<V>, surfaces: &[&Surface; V]) -> [f64; V] {
    let scatters = |lane: &usize| bill.scattered[*lane] > 0.0;
    let twins = |lane: usize| (0..V).filter(scatters).filter(|&l| std::ptr::eq(surfaces[l], surfaces[lane])).count();
    let shares: [f64; V] = std::array::from_fn(|lane| if scatters(&lane) { 1.0 / twins(lane) as f64 } else { 0.0 });
    let total: f64 = shares.iter().sum();
    shares.map(|share| share / total)
}

/// A lane by its share.
fn lane<const V: usize>(shares: &[f64; V], rng: &mut Rng) -> usize {
    let mut rest = if V == 1 { 0.0 } else { rng.uniform() };
    let lane = (0..V).find(|&lane| {
        rest -= shares[lane];
        rest < 0.0
    });
    // Rounding may leave a rest of zero: the last that scatters then.
    lane.or((0..V).rev().find(|&lane| shares[lane] > 0.0)).unwrap_or(V - 1)
}
