//! Ghosts: every sequence of unintended reflections by itself, traced without chance.
//!
//! Light is emitted as in a run. At every interface both branches are followed, with their exact parts of the flux and without
//! roulette, until a path has as many unintended reflections as asked for; what scatters is left out. So each ghost has every source
//! ray that can make it, and its relative error does not depend on how faint it is: the flux of a ghost is a product of R and T along
//! the rays, and only the vignetting is sampled.
//!
//! An unintended reflection is one at a surface that can transmit, or at a part that the detector itself watches; mirrors are meant.
//!
//! Left out: light that scatters (a run has it); detectors at infinity, on which nothing has a place.

mod arrivals;
mod bundle;
mod result;

pub use bundle::Bundle;
pub use result::{Ghost, Ghosts};

use crate::scene::Scene;
use crate::settings::{Guidance, Roulette, Settings, Trace};
use crate::tally::{Fold, Live, Sums};
use crate::transport::book::Book;
use crate::transport::importance::Importance;
use crate::transport::paths::Rows;
use crate::transport::walk::{Walk, quotas};
use arrivals::{Arrivals, Caught};
use rayon::prelude::*;
use result::Ledger;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most unintended reflections that may be asked for: a path spells out so many beside those of two mirrors.
pub const MOST_ORDER: u16 = 6;

/// Batches handed to the threads at a time.
const CHUNK: u64 = 16;

/// Share of a source ray below which roulette decides: far below any product of four coatings, so that it only ends light that is caught
/// between mirrors.
const FAINTEST: f64 = 1e-30;

/// A guard against light that is caught between mirrors without loss; booked if it ever cuts.
const MOST_EVENTS: u32 = 10_000;

/// Traces all ghosts of up to `order` unintended reflections with the rays and the seed of `settings`. `progress` is told which part
/// (0..1) is done. `None` if it was stopped.
pub fn ghosts(
    scene: &Scene,
    settings: &Settings,
    order: u16,
    stop: &AtomicBool,
    progress: &dyn Fn(f64),
) -> Option<Ghosts> {
    let settings = certain(settings, order);
    let batch_rays = settings.batch_rays().max((scene.sources.len() as u64).next_power_of_two());
    let (mut ledger, mut fold) = (Ledger::new(scene), Fold::default());
    let all: Vec<u64> = (0..settings.batches()).collect();
    for (done, chunk) in all.chunks(CHUNK as usize).enumerate() {
        let traced: Vec<_> = chunk
            .par_iter()
            .with_max_len(1)
            .map(|&number| (!stop.load(Ordering::Relaxed)).then(|| batch(scene, &settings, order, batch_rays, number)))
            .collect();
        for (number, finished) in chunk.iter().zip(traced) {
            let (caught, sums) = finished?;
            ledger.take(*number as usize, caught);
            fold.push(sums);
        }
        progress(((done as u64 + 1) * CHUNK).min(settings.batches()) as f64 / settings.batches() as f64);
    }
    Some(ledger.result(&settings, order, batch_rays, &fold.total()))
}

/// Settings that leave nothing to chance but where light starts.
fn certain(settings: &Settings, order: u16) -> Settings {
    Settings {
        splits: order + 1,
        roulette: Roulette { below: FAINTEST, ..settings.roulette },
        max_scatters: Some(0),
        max_reflections: None,
        max_ghosts: Some(order),
        max_events: MOST_EVENTS,
        until: None,
        paths: 0,
        importance: Guidance::Off,
        trace: Trace::Forward,
        ..settings.clone()
    }
}

/// What arrives in one batch, and its ledger.
fn batch(scene: &Scene, settings: &Settings, order: u16, batch_rays: u64, number: u64) -> (Caught, Sums<1>) {
    let (layout, rows) = (scene.layout(0), Rows::default());
    let importance = Importance::declared(scene);
    let book = Book::new(&layout, Live::new(layout.len()), Some(&rows));
    let mut walk = Walk::new(scene, settings, &importance, book, Arrivals::new(scene, order));
    walk.batch(number, &quotas(scene, batch_rays));
    (walk.watch.caught, walk.book.finish())
}
