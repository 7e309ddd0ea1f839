//! Whole runs against known answers: reference cases, generated geometry, the chain from text to results, and the bill.
//!
//! A case of `tests/data/verification/public.json` is one function of a [`Trial`]: it writes the system, runs it, and
//! hands every number with its reference to [`Trial::check`]. `cases!` makes two tests of it: a quick one, and one at
//! full size for `cargo test --release --test verification -- --ignored`.

#![allow(dead_code, unused_macros, reason = "each test target uses its own part")]

pub mod case;
pub mod model;
pub mod shapes;
pub mod trial;

pub use case::Case;
pub use model::Model;
pub use trial::{Check, Trial, full, quick};

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::Results;
use straylight::transport::{self, summary};
use tempfile::TempDir;

/// Writes `system.ron` and `parts.gltf` (mm) into a new folder and compiles them as the binary does. `sections` is what
/// stands between the brackets of `System(..)`, without `geometry`.
pub fn compiled(sections: &str, model: &Model) -> Compiled {
    let folder = TempDir::new().expect("a folder for the system");
    let path: PathBuf = folder.path().join("system.ron");
    let geometry = "geometry: [(file: \"parts.gltf\", unit: \"mm\")],";
    let geometry = if sections.contains("geometry:") { "" } else { geometry };
    std::fs::write(folder.path().join("parts.gltf"), model.gltf()).expect("written");
    std::fs::write(&path, format!("System(\n{geometry}\n{sections}\n)")).expect("written");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{e}\n{:#?}\n{sections}", e.problems()));
    compile(&document).unwrap_or_else(|e| panic!("{e}\n{:#?}\n{sections}", e.problems()))
}

/// Traces `rays` source rays of a system with random numbers of `seed`; other settings as the text says.
pub fn run(sections: &str, model: &Model, rays: u64, seed: u64) -> Results {
    let mut compiled = compiled(sections, model);
    (compiled.settings.rays, compiled.settings.seed) = (rays, seed);
    let (scene, settings) = (&compiled.scene, &compiled.settings);
    let counts = transport::run::<1>(scene, settings, &AtomicBool::new(false), &|_| ());
    let warnings = compiled.warnings.iter().map(ToString::to_string).collect();
    summary::results(scene, settings, &counts, 0, compiled.inputs, warnings)
}

/// Two tests for each case: `quick::NAME` and, ignored, `full::NAME`; and the list of them all. A function `rad_03x`
/// stands for the case RAD-03x.
macro_rules! cases {
    ($($name:ident)*) => {
        pub const CASES: &[(&str, fn(&mut crate::support::Trial))] = &[$((stringify!($name), $name)),*];

        mod quick {
            $(#[test] fn $name() { crate::support::quick(stringify!($name), super::$name); })*
        }

        mod full {
            $(
                #[test]
                #[ignore = "full size; cargo test --release --test verification -- --ignored"]
                fn $name() {
                    crate::support::full(stringify!($name), super::$name).iter().for_each(|check| check.assert());
                }
            )*
        }
    };
}
