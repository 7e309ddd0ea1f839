//! Same system, same seed, same rays: same bits, whatever the threads and in whatever order batches are traced.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[macro_use]
mod support;
#[path = "exactness/mixed.rs"]
mod mixed;

use std::sync::atomic::AtomicBool;
use straylight::system::compile::Compiled;
use straylight::tally::results::Results;
use straylight::tally::{Fold, Live};
use straylight::transport::book::Book;
use straylight::transport::importance::Importance;
use straylight::transport::walk::{Walk, quotas};
use straylight::transport::watch::Unwatched;
use straylight::transport::{self, Counts, summary};

fn compiled(run: &str) -> Compiled {
    support::compiled(&mixed::sections(run), &mixed::model())
}

fn counts(compiled: &Compiled, threads: usize) -> Counts<1> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| transport::run::<1>(&compiled.scene, &compiled.settings, &AtomicBool::new(false), &|_| ()))
}

fn results(compiled: &Compiled, counts: &Counts<1>) -> Results {
    summary::results(&compiled.scene, &compiled.settings, counts, 0, compiled.inputs.clone(), Vec::new())
}

/// Every number, written so that it reads back to the same bits.
fn bits(results: &Results) -> [String; 3] {
    let summary = serde_json::to_string(results).expect("JSON");
    [summary, format!("{:?}", results.maps), format!("{:?}", results.paths)]
}

#[test]
fn sta_03_the_same_bits_on_one_two_and_three_threads() {
    for run in ["rays: 2000, seed: 7", "rays: 2000, seed: 7, batch: 32", "rays: 300, splits: 3, scatter_splits: 2"] {
        let compiled = compiled(run);
        let one = bits(&results(&compiled, &counts(&compiled, 1)));
        assert!(one[2].len() > 10_000, "a path table of some size");
        for threads in [2, 3, 3] {
            let other = bits(&results(&compiled, &counts(&compiled, threads)));
            assert!(one == other, "{run}: {threads} threads");
        }
    }
}

#[test]
fn sta_03_compiling_again_changes_nothing() {
    let [first, second] = [(), ()].map(|()| {
        let mut compiled = compiled("rays: 2000");
        // Both stand in a folder of their own, after which a system without a name is called.
        compiled.scene.name = "mixed".into();
        bits(&results(&compiled, &counts(&compiled, 2)))
    });
    assert!(first == second);
}

#[test]
fn sta_03_another_seed_gives_other_numbers_and_another_batch_size_the_same_mean() {
    let flux = |run: &str| {
        let compiled = compiled(run);
        results(&compiled, &counts(&compiled, 2)).detectors["chip"].flux_w
    };
    let (a, b, c) = (flux("rays: 3000"), flux("rays: 3000, seed: 2"), flux("rays: 3000, batch: 128"));
    for other in [b, c] {
        assert_ne!(a.mean, other.mean);
        assert!((a.mean - other.mean).abs() < 4.0 * a.error.hypot(other.error), "{a:?} {other:?}");
    }
}

/// Batches traced backwards, in a shuffled order, and by bookkeepers that have seen other batches before.
#[test]
fn sta_03_the_order_in_which_batches_are_traced_does_not_matter() {
    let compiled = compiled("rays: 1600, batch: 16");
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    let whole = counts(&compiled, 2);
    let quotas = quotas(scene, settings.batch_rays());
    let importance = Importance::declared(scene);
    let batches = settings.batches();
    let backwards: Vec<u64> = (0..batches).rev().collect();
    // 37 has no divisor in common with the number of batches.
    let shuffled: Vec<u64> = (0..batches).map(|i| i * 37 % batches).collect();
    for order in [backwards, shuffled] {
        let mut live = Some(Live::<1>::new(whole.layout.len()));
        let mut done: Vec<_> = order
            .into_iter()
            .map(|batch| {
                let book = Book::new(&whole.layout, live.take().expect("a bookkeeper"), Some(&whole.rows));
                let mut walk = Walk::new(scene, settings, &importance, book, Unwatched);
                walk.batch(batch, &quotas);
                let sums = walk.book.finish();
                live = Some(walk.book.live);
                (batch, sums)
            })
            .collect();
        done.sort_by_key(|(batch, _)| *batch);
        let mut fold = Fold::default();
        done.into_iter().for_each(|(_, sums)| fold.push(sums));
        assert!(fold.total() == whole.sums);
    }
}
