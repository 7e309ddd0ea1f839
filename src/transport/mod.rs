//! Transport: batches of source rays over all cores, folded in a fixed order.

pub mod backward;
pub mod book;
mod bulk;
mod film;
pub mod importance;
mod interaction;
mod largest;
pub mod paths;
mod scatter;
pub mod summary;
mod trial;
pub mod walk;
pub mod watch;
mod ways;

use crate::math::rng::mix;
use crate::packet::Class;
use crate::scene::Scene;
use crate::settings::{Booking, Guidance, Settings, Trace};
use crate::tally::results::GuidanceResult;
use crate::tally::{Fold, Layout, Live, Sums};
use backward::Backward;
use book::Book;
use importance::{Importance, Lit};
use largest::Largest;
use paths::{Candidates, Rows};
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use trial::trial;
use walk::{Quota, Walk, quotas};
use watch::Unwatched;
pub use ways::Followed;

/// Batches handed to the threads at a time: progress is reported, interruptions are seen and sums are folded in between.
const CHUNK: u64 = 64;

/// Everything a run counted.
#[derive(Debug)]
pub struct Counts<const V: usize> {
    pub layout: Layout,
    pub rows: Rows,
    pub sums: Sums<V>,
    /// Flux on every detector in every batch, W.
    pub fluxes: Vec<Vec<[f64; V]>>,
    /// Of it, stray light and what is meant to arrive, W.
    pub parted: Vec<Vec<[[f64; V]; 2]>>,
    /// Some of the ways that the light took, if they were asked for.
    pub ways: Vec<Followed>,
    pub batch_rays: u64,
    /// The largest single contributions.
    pub largest: Largest<V>,
    /// Flights from event to event, pilot not included.
    pub segments: u64,
    /// True if it was told to stop.
    pub interrupted: bool,
    /// What was learned before the run, if anything.
    pub guidance: Option<GuidanceResult>,
}

/// How far a run is.
pub struct Progress<'a, const V: usize> {
    pub batches: u64,
    /// Of so many; fewer if the wanted precision is reached before.
    pub of: u64,
    pub batch_rays: u64,
    pub layout: &'a Layout,
    pub sums: &'a Sums<V>,
}

/// Traces `scene` on the current rayon pool. `progress` is called between chunks of batches; once `stop` is set the
/// finished, contiguous batches are the result. The result does not depend on the number of threads.
pub fn run<const V: usize>(
    scene: &Scene,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &dyn Fn(&Progress<V>),
) -> Counts<V> {
    batchwise(scene, settings, stop, progress, &mut |_, _, _| ())
}

/// The same; `batch` is shown every batch before it is folded in, in order.
pub fn batchwise<const V: usize>(
    scene: &Scene,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &dyn Fn(&Progress<V>),
    batch: &mut dyn FnMut(&Layout, &Rows, &Sums<V>),
) -> Counts<V> {
    // Every source has a ray in every batch.
    let batch_rays = settings.batch_rays().max((scene.sources.len() as u64).next_power_of_two());
    let quotas = quotas(scene, batch_rays);
    let declared = Importance::declared(scene);
    let plain = Plan { scene, settings, importance: &declared, backward: None, quotas: &quotas, batch_rays };
    let learns = match settings.importance {
        Guidance::Auto => settings.rays >= FEWEST_TO_LEARN,
        Guidance::On => true,
        Guidance::Off => false,
    };
    let learned = learns.then(|| importance::learn(scene, settings, &quotas, batch_rays, stop));
    let guidance = learned.as_ref().map(|learned| {
        let gain = trial::<V>(&plain, &learned.importance, stop);
        guided(scene, settings, &learned.importance, gain)
    });
    let used = guidance.as_ref().is_some_and(|guidance| guidance.used);
    let (learned, lit) = learned.map_or((None, Lit::default()), |learned| (Some(learned.importance), learned.lit));
    let importance = learned.as_ref().filter(|_| used).unwrap_or(&declared);
    let backward = (settings.trace == Trace::Backward).then(|| Backward::new(scene, lit));
    let plan = Plan { importance, backward: backward.as_ref(), ..plain };
    let rows = pilot::<V>(&plan, stop);
    let layout = match settings.booking {
        Booking::Flux => scene.layout(rows.rows.len()),
        Booking::Events => scene.layout(rows.rows.len()).with_events(),
    };
    let pool = Mutex::new(Vec::new());
    let mut taken = Taken::new(scene);
    let stages = stages(settings);
    'stages: for &stage in &stages {
        while taken.batches < stage {
            let end = (taken.batches + CHUNK).min(stage);
            let batches: Vec<u64> = (taken.batches..end).collect();
            let chunk: Vec<_> = batches
                .into_par_iter()
                .with_max_len(1)
                .map(|batch| (!stop.load(Ordering::Relaxed)).then(|| plan.counted(&layout, &rows, &pool, batch)))
                .collect();
            for finished in chunk {
                let Some(finished) = finished else { break 'stages };
                batch(&layout, &rows, &finished.sums);
                taken.take(&layout, finished);
            }
            progress(&Progress {
                batches: taken.batches,
                of: settings.batches(),
                batch_rays,
                layout: &layout,
                sums: &taken.fold.total(),
            });
        }
        if precise_enough(settings, &layout, &taken.fold.total()) {
            break;
        }
    }
    let interrupted = stop.load(Ordering::Relaxed) && taken.batches < settings.batches();
    let Taken { fold, fluxes, parted, largest, segments, .. } = taken;
    let sums = fold.total();
    let ways = if settings.ways && !interrupted { ways::follow(&plan, &layout, &rows, &sums) } else { Vec::new() };
    Counts { layout, rows, sums, fluxes, parted, ways, batch_rays, largest, segments, interrupted, guidance }
}

/// What one batch counted.
struct Counted<const V: usize> {
    sums: Sums<V>,
    largest: Largest<V>,
    /// Flights.
    segments: u64,
}

/// What all batches so far counted, in their order.
struct Taken<const V: usize> {
    image: Class,
    batches: u64,
    fold: Fold<V>,
    /// By detector and batch, as in [`Counts`].
    fluxes: Vec<Vec<[f64; V]>>,
    parted: Vec<Vec<[[f64; V]; 2]>>,
    largest: Largest<V>,
    segments: u64,
}

impl<const V: usize> Taken<V> {
    fn new(scene: &Scene) -> Taken<V> {
        let detectors = scene.detectors.len();
        Taken {
            image: scene.image(),
            batches: 0,
            fold: Fold::default(),
            fluxes: vec![Vec::new(); detectors],
            parted: vec![Vec::new(); detectors],
            largest: Largest::new(detectors),
            segments: 0,
        }
    }

    /// The next batch.
    fn take(&mut self, layout: &Layout, batch: Counted<V>) {
        let sums = &batch.sums;
        for (d, fluxes) in self.fluxes.iter_mut().enumerate() {
            fluxes.push(sums.values(layout.detector(d)));
            self.parted[d].push(stray_and_image(layout, d, self.image, sums));
        }
        self.largest.merge(batch.largest);
        self.fold.push(batch.sums);
        self.segments += batch.segments;
        self.batches += 1;
    }
}

/// Flux on a detector, W: of all classes but that of what is meant to arrive, and of that class.
pub fn stray_and_image<const V: usize>(
    layout: &Layout,
    detector: usize,
    image: Class,
    batch: &Sums<V>,
) -> [[f64; V]; 2] {
    // A sum of classes: all light less the image would be rounding where stray light is faint.
    let stray = (0..Class::COUNT).filter(|class| *class != image.index());
    let stray = stray.map(|class| batch.values(layout.class(detector, class)));
    let sum = stray.fold([0.0; V], |sum, part| std::array::from_fn(|lane| sum[lane] + part[lane]));
    [sum, batch.values(layout.class(detector, image.index()))]
}

/// Runs of fewer source rays learn nothing: it would take longer than they do.
const FEWEST_TO_LEARN: u64 = 16_384;

/// What is told of what was learned; it is used where the trial says that it pays.
fn guided(scene: &Scene, settings: &Settings, importance: &Importance, gain: f64) -> GuidanceResult {
    let declared = scene.targets.len();
    let wanted = gain > 1.0 || settings.importance == Guidance::On;
    GuidanceResult {
        used: wanted && importance.map.is_some(),
        gain,
        patches: importance.map.as_ref().map_or(0, |map| map.patches.len() as u64),
        targets: importance.targets.iter().skip(declared).map(|target| target.label.clone()).collect(),
    }
}

/// Batch counts at which the precision is looked at: doublings only, so that looking does not bias the result.
fn stages(settings: &Settings) -> Vec<u64> {
    let all = settings.batches();
    let doublings = (0..).map(|k| Settings::FEWEST_BATCHES << k).take_while(|&n| n < all);
    let early: Vec<u64> = if settings.until.is_some() { doublings.collect() } else { Vec::new() };
    early.into_iter().chain([all]).collect()
}

/// Fewest contributing source rays for which a wanted precision counts as reached.
const FEWEST_RAYS: u64 = 100;

fn precise_enough<const V: usize>(settings: &Settings, layout: &Layout, sums: &Sums<V>) -> bool {
    settings.until.is_some_and(|until| {
        let slot = layout.detector(until.detector);
        let known = |lane: usize| {
            let estimate = sums.estimate(slot, lane);
            estimate.error <= until.relative * estimate.mean
        };
        sums.rays(slot) >= FEWEST_RAYS && (0..V).all(known)
    })
}

/// What every batch of a run needs.
#[derive(Clone, Copy)]
struct Plan<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    importance: &'a Importance,
    backward: Option<&'a Backward>,
    quotas: &'a [Quota],
    batch_rays: u64,
}

impl<'a> Plan<'a> {
    /// Traces a batch by the random numbers of `seed`, from both ends, into a book.
    fn trace<const V: usize>(&self, mut book: Book<'a, V>, seed: u64, batch: u64) -> Book<'a, V> {
        book.backward = self.backward;
        let mut walk = Walk::new(self.scene, self.settings, self.importance, book, Unwatched);
        walk.seed = seed;
        walk.batch(batch, self.quotas);
        match self.backward {
            None => walk.book,
            Some(backward) => backward.batch(self.scene, self.settings, walk.book, seed, (batch, self.batch_rays)),
        }
    }

    /// Traces a batch of the run.
    fn counted<const V: usize>(
        &self,
        layout: &'a Layout,
        rows: &'a Rows,
        pool: &Mutex<Vec<Live<V>>>,
        batch: u64,
    ) -> Counted<V> {
        let idle = pool.lock().ok().and_then(|mut pool| pool.pop());
        let live = idle.unwrap_or_else(|| Live::new(layout.len()));
        let mut book = self.trace(Book::new(layout, live, Some(rows)), self.settings.seed, batch);
        let sums = book.finish();
        let Book { largest, segments, live, .. } = book;
        if let Ok(mut pool) = pool.lock() {
            pool.push(live);
        }
        Counted { sums, largest, segments }
    }
}

/// Parts of the run that the pilot may trace; it goes on to the next while it has seen too little.
const PILOT: [u64; 3] = [16, 8, 4];

/// Effective arrivals on every detector that are enough to choose rows from.
const ENOUGH: f64 = 256.0;

/// Chooses the rows of the path table with random numbers of their own: from a sixteenth of the run, up to a quarter where
/// little arrives; at most 2^20 and 2^22 rays.
fn pilot<const V: usize>(plan: &Plan, stop: &AtomicBool) -> Rows {
    let settings = plan.settings;
    if settings.paths == 0 {
        return Rows::default();
    }
    let layout = plan.scene.layout(0);
    let seed = mix(settings.seed ^ 0x7069_6c6f_7421);
    let trace = |batch: u64| {
        let book = Book::new(&layout, Live::<V>::new(layout.len()), None);
        let stopped = stop.load(Ordering::Relaxed);
        if stopped { Candidates::default() } else { plan.trace(book, seed, batch).candidates }
    };
    let (mut seen, mut done) = (Candidates::default(), 0);
    for part in PILOT {
        let rays = (settings.rays / part).clamp(256, (1 << 24) / part);
        let end = rays.div_ceil(plan.batch_rays);
        let round: Vec<Candidates> = (done..end).into_par_iter().map(trace).collect();
        seen = round.into_iter().fold(seen, Candidates::merge);
        done = end;
        if seen.effective(plan.scene.detectors.len()) >= ENOUGH {
            break;
        }
    }
    seen.admit(settings.paths)
}
