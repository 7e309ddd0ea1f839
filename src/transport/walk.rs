//! One source ray from birth to the last of its branches: emit, fly, arrive, interact.

use super::backward::{Trail, connect};
use super::book::Book;
use super::bulk;
use super::film;
use super::importance::Importance;
use super::interaction::interact;
use super::watch::Watch;
use crate::detector::{Arrival, Place};
use crate::geometry::{Crossing, Left};
use crate::math::Rng;
use crate::math::lowdiscrepancy::Block;
use crate::medium::absorption;
use crate::packet::{Ancestry, Packet, Solids};
use crate::scene::{PartKind, Scene};
use crate::settings::Settings;
use crate::source::{Birth, Source};
use crate::tally::layout::{Cut, Loss};
use glam::DVec3;

/// Everything a history needs.
pub struct Walk<'a, const V: usize, W: Watch> {
    pub scene: &'a Scene,
    pub settings: &'a Settings,
    pub importance: &'a Importance,
    /// Key of all random numbers.
    pub seed: u64,
    pub book: Book<'a, V>,
    pub watch: W,
    /// Branches that wait.
    pub waiting: Vec<Packet<V>>,
    /// Flux of the source ray in hand, W.
    pub start: f64,
    /// Where the ray in hand comes from, if it goes backwards.
    pub trail: Option<Trail<'a>>,
}

/// Which rays of a batch a source has: `first..first + count`.
#[derive(Clone, Copy, Debug)]
pub struct Quota {
    pub first: u64,
    pub count: u64,
}

/// Shares `batch` rays out among sources in proportion to their flux, at least one each (largest remainder first).
pub fn quotas(scene: &Scene, batch: u64) -> Vec<Quota> {
    let total: f64 = scene.sources.iter().map(|s| s.flux).sum();
    let mut counts: Vec<u64> = scene.sources.iter().map(|s| ((s.flux / total * batch as f64) as u64).max(1)).collect();
    while counts.iter().sum::<u64>() < batch {
        let lack = |i: usize| scene.sources[i].flux / total * batch as f64 - counts[i] as f64;
        let neediest = (0..counts.len()).max_by(|&a, &b| lack(a).total_cmp(&lack(b)).then(b.cmp(&a)));
        neediest.into_iter().for_each(|i| counts[i] += 1);
    }
    while counts.iter().sum::<u64>() > batch {
        let richest = (0..counts.len()).max_by_key(|&i| counts[i]);
        richest.into_iter().for_each(|i| counts[i] -= 1);
    }
    let mut first = 0;
    counts
        .into_iter()
        .map(|count| {
            first += count;
            Quota { first: first - count, count }
        })
        .collect()
}

/// Where a flight ends.
enum End {
    Face(Crossing),
    /// Light is scattered in this medium.
    Bulk(u16),
    Escaped,
}

impl<'a, const V: usize, W: Watch> Walk<'a, V, W> {
    /// A walk with the seed of the settings.
    pub fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        importance: &'a Importance,
        book: Book<'a, V>,
        watch: W,
    ) -> Walk<'a, V, W> {
        Walk {
            scene,
            settings,
            importance,
            seed: settings.seed,
            book,
            watch,
            waiting: Vec::new(),
            start: 0.0,
            trail: None,
        }
    }

    /// Traces every source ray of batch `batch`.
    pub fn batch(&mut self, batch: u64, quotas: &[Quota]) {
        let size = quotas.last().map_or(0, |q| q.first + q.count);
        let block = Block::new(self.seed, batch);
        for (source, quota) in quotas.iter().enumerate() {
            for index in quota.first..quota.first + quota.count {
                let mut rng = Rng::new(self.seed, batch * size + index, 0);
                let shining = &self.scene.sources[source];
                let flux = shining.flux / quota.count as f64;
                let birth = shining.emit(&mut |d| block.coordinate(index as u32, d, rng.uniform()));
                let mut packet = self.born(shining, (source as u16, batch * size + index), birth, flux, rng);
                self.history(&mut packet);
            }
        }
    }

    /// A packet at its source, which is called by `(source, history)`.
    pub fn born(
        &self,
        shining: &Source,
        (source, history): (u16, u64),
        birth: Birth,
        flux: f64,
        rng: Rng,
    ) -> Packet<V> {
        let (left, solids) = start_of(self.scene, shining, &birth);
        Packet {
            ray: birth.ray,
            light: [shining.polarization.stokes * flux; V],
            transverse: birth.transverse,
            wavelength: birth.wavelength,
            solids,
            left,
            film: None,
            rng,
            level: 0.0,
            ancestry: Ancestry::born(source, history),
        }
    }

    /// Follows a packet and all branches it grows.
    pub fn history(&mut self, packet: &mut Packet<V>) {
        self.book.live.next_ray();
        self.book.emitted(packet.fluxes());
        self.start = packet.flux();
        self.follow(packet);
        while let Some(branch) = self.waiting.pop() {
            *packet = branch;
            self.follow(packet);
        }
    }

    fn follow(&mut self, packet: &mut Packet<V>) {
        while self.survives(packet) {
            self.watch.follows(&packet.ancestry, packet.flux());
            let goes_on = match &packet.film {
                Some(film) => self.meet(packet, film.next()),
                None => match self.fly(packet) {
                    End::Face(crossing) => {
                        let crossing = film::open(self.scene, packet, crossing);
                        self.meet(packet, crossing)
                    }
                    End::Bulk(medium) => bulk::scatter(self, packet, medium),
                    End::Escaped => false,
                },
            };
            if !goes_on {
                return;
            }
        }
    }

    /// A face is reached; true if `packet` itself goes on.
    fn meet(&mut self, packet: &mut Packet<V>, crossing: Crossing) -> bool {
        if self.trail.is_none() {
            self.arrive(packet, &crossing);
        }
        interact(self, packet, &crossing)
    }

    /// Russian roulette: the mean is unchanged, the ledger books the difference.
    fn survives(&mut self, packet: &mut Packet<V>) -> bool {
        let roulette = self.settings.roulette;
        // The largest flux of all lanes takes no notice of what is not a number.
        if packet.light.iter().any(|light| light.i.is_nan()) {
            self.book.lost(Loss::Number, packet.fluxes());
            return false;
        }
        let flux = packet.flux();
        if flux >= roulette.below * self.start && flux > 0.0 {
            return true;
        }
        let alive = flux > 0.0 && packet.rng.uniform() < roulette.survive;
        let factor = if alive { 1.0 - 1.0 / roulette.survive } else { 1.0 };
        self.book.cut(Cut::Roulette, packet.fluxes().map(|f| f * factor));
        if alive {
            packet.light = packet.light.map(|light| light * (1.0 / roulette.survive));
        }
        alive
    }

    /// To the next event, through what absorbs and past detectors in free space.
    fn fly(&mut self, packet: &mut Packet<V>) -> End {
        self.book.segments += 1;
        self.watch.flight(&packet.ray, &packet.left);
        let geometry = &self.scene.geometry;
        let mut crossing = geometry.nearest(&packet.ray, &packet.left);
        if crossing.is_none() && !packet.solids.is_empty() {
            // No way leads out of a closed solid: a rounding has put the ray beyond an edge of the face that it left.
            packet.ray.origin = geometry.inward(packet.ray.origin, &packet.left);
            crossing = geometry.nearest(&packet.ray, &packet.left);
        }
        let medium = self.scene.medium_in(&packet.solids);
        let most = crossing.as_ref().map_or(f64::INFINITY, |crossing| crossing.distance);
        if let Some(distance) = bulk::free_path(self.scene, medium, packet, most) {
            let end = packet.ray.at(distance);
            self.pass(packet, Some(end));
            self.pass_medium(packet, medium, distance);
            packet.ray.origin = end;
            return End::Bulk(medium);
        }
        self.pass(packet, crossing.as_ref().map(|crossing| crossing.point));
        let Some(crossing) = crossing else {
            self.escape(packet);
            return End::Escaped;
        };
        self.pass_medium(packet, medium, crossing.distance);
        End::Face(crossing)
    }

    /// What there is in free space on a flight to `end`: detectors, or for a ray that goes backwards, sources.
    fn pass(&mut self, packet: &Packet<V>, end: Option<DVec3>) {
        if self.trail.is_none() {
            return self.pass_windows(packet, end);
        }
        let most = end.map_or(f64::INFINITY, |end| (end - packet.ray.origin).length());
        connect::planes(self, packet, most);
    }

    /// The ray in hand, which goes backwards, has met light that will come to its detector on this path.
    pub fn found(&mut self, path: &Ancestry, flux: [f64; V]) {
        let Some(trail) = &self.trail else { return };
        let (detector, arrival) = (trail.detector, trail.arrival);
        self.watch.arrives(detector, &arrival, flux.iter().fold(0.0, |most: f64, flux| most.max(*flux)));
        self.book.counted(self.scene, detector, path, flux, &arrival);
    }

    /// Absorption and optical path over `distance` (m) in a medium.
    fn pass_medium(&mut self, packet: &mut Packet<V>, medium: u16, distance: f64) {
        let index = self.scene.index(medium, packet.wavelength);
        packet.ancestry.optical_path += index.re * distance;
        if index.im > 0.0 {
            let lost = -(-absorption(index, packet.wavelength) * distance).exp_m1();
            self.book.absorbed_in_medium(medium, packet.fluxes().map(|f| f * lost));
            packet.light = packet.light.map(|light| light * (1.0 - lost));
        }
    }

    /// Free-space detectors on the way. The light is recorded as it is at the crossing, absorption up to there included.
    fn pass_windows(&mut self, packet: &Packet<V>, end: Option<DVec3>) {
        for (detector, watched) in self.scene.detectors.iter().enumerate() {
            let Place::Window(window) = &watched.place else { continue };
            let Some((front, point)) = window.crossing(&packet.ray, end) else { continue };
            if !watched.side.sees(front) {
                continue;
            }
            let index = self.scene.index(self.scene.medium_in(&packet.solids), packet.wavelength);
            let distance = (point - packet.ray.origin).length();
            let mut here = packet.clone();
            here.ancestry.optical_path += index.re * distance;
            if index.im > 0.0 {
                let left = (-absorption(index, packet.wavelength) * distance).exp();
                here.light = here.light.map(|light| light * left);
            }
            let arrival = Arrival { point, direction: packet.ray.direction, triangle: None };
            self.watch.arrives(detector, &arrival, here.flux());
            self.book.arrived(self.scene, detector, &here.ancestry, here.fluxes(), &arrival);
        }
    }

    /// Detectors on the faces it meets, before anything happens to it.
    fn arrive(&mut self, packet: &Packet<V>, crossing: &Crossing) {
        for hit in &crossing.hits {
            for &detector in &self.scene.part(*hit).detectors {
                if self.scene.detectors[detector as usize].side.sees(hit.front) {
                    let arrival = Arrival {
                        point: crossing.point,
                        direction: packet.ray.direction,
                        triangle: Some(hit.triangle),
                    };
                    self.watch.arrives(detector as usize, &arrival, packet.flux());
                    self.book.arrived(self.scene, detector as usize, &packet.ancestry, packet.fluxes(), &arrival);
                }
            }
        }
    }

    fn escape(&mut self, packet: &Packet<V>) {
        for (detector, watched) in self.scene.detectors.iter().enumerate() {
            if self.trail.is_none() && matches!(watched.place, Place::FarField) {
                let arrival = Arrival { point: packet.ray.origin, direction: packet.ray.direction, triangle: None };
                self.book.arrived(self.scene, detector, &packet.ancestry, packet.fluxes(), &arrival);
            }
        }
        self.watch.escaped(packet.ray, packet.flux());
        if packet.solids.is_empty() {
            self.book.escaped(packet.fluxes());
        } else {
            self.book.lost(Loss::Inside, packet.fluxes());
        }
    }
}

/// What a newborn ray leaves and the solids it starts in.
fn start_of(scene: &Scene, shining: &Source, birth: &Birth) -> (Left, Solids) {
    let left = birth
        .from
        .map_or_else(Left::nothing, |(triangle, front)| Left::one(triangle, scene.geometry.object(triangle), front));
    if shining.outside {
        return (left, Solids::default());
    }
    let mut solids = scene.solids_at(birth.ray.origin);
    if let Some((triangle, front)) = birth.from
        && let PartKind::Face(solid) = scene.parts[scene.part_of[triangle as usize] as usize].kind
    {
        // On its own face parity is a matter of rounding: the shining side decides.
        solids.leave(solid);
        if !front {
            solids.enter(solid);
        }
    }
    (left, solids)
}
