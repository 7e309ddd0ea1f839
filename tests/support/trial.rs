//! One case being tried: how large it runs, what it found, and the bill at the end.

use super::{Case, Model, run};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Instant;
use straylight::math::statistics::mean_and_error;
use straylight::tally::results::{Estimate, Results};

/// How many rays a trial may spend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A second or two.
    Quick,
    /// As many as the case asks for (ten times the quick ones if it does not say), at most [`MOST`] times the quick.
    Full,
}

/// Full size over quick size at most, so that the longest case takes a minute or two.
const MOST: u64 = 64;

/// Tolerance of a Monte-Carlo number in its own standard errors.
const SIGMAS: f64 = 4.0;

/// One number against its reference.
#[derive(Clone, Debug)]
pub struct Check {
    pub id: String,
    pub name: String,
    pub value: f64,
    /// Standard error of the run; 0 if the number is not a random one.
    pub error: f64,
    pub reference: f64,
    /// What may separate value and reference besides the error.
    pub sys: f64,
    /// False if the number follows from others of the list: it says nothing new about error bars.
    pub independent: bool,
}

impl Check {
    /// (value - reference) / error.
    pub fn pull(&self) -> f64 {
        (self.value - self.reference) / self.error
    }

    #[track_caller]
    pub fn assert(&self) {
        let Check { id, name, value, error, reference, sys, .. } = self;
        let off = value - reference;
        match *error > 0.0 {
            true => println!(
                "{id:8} {name:32} {value:.7e} +- {error:.1e}, reference {reference:.7e}: {:+.2} sigma",
                off / error
            ),
            false => println!("{id:8} {name:32} {value:.12e}, reference {reference:.12e}: off by {off:+.1e}"),
        }
        assert!(
            off.abs() <= SIGMAS * error + sys,
            "{id} {name}: {value:e} +- {error:e}, reference {reference:e}, off by {off:e}, allowed {:e}",
            SIGMAS * error + sys
        );
    }
}

/// A case being tried.
pub struct Trial {
    pub case: Case,
    pub size: Size,
    pub checks: Vec<Check>,
    runs: u64,
}

impl Trial {
    fn new(name: &str, size: Size) -> Trial {
        let (group, rest) = name.split_once('_').expect("a case is called like rad_03x");
        let case = Case::load(&format!("{}-{rest}", group.to_uppercase()));
        Trial { case, size, checks: Vec::new(), runs: 0 }
    }

    /// Runs a system with `quick` source rays, or more at full size; every run has its own random numbers.
    pub fn run(&mut self, sections: &str, model: &Model, quick: u64) -> Results {
        let rays = match self.size {
            Size::Quick => quick,
            Size::Full => self.case.rays().unwrap_or(10 * quick).clamp(quick, quick * MOST),
        };
        self.trace(sections, model, rays)
    }

    /// Runs a system in which nothing is left to chance: a few rays say it all.
    pub fn run_exactly(&mut self, sections: &str, model: &Model) -> Results {
        self.trace(sections, model, 64)
    }

    fn trace(&mut self, sections: &str, model: &Model, rays: u64) -> Results {
        self.runs += 1;
        // FNV-1a over the case and the number of the run.
        let seed = self.case.id.bytes().chain(self.runs.to_le_bytes());
        let seed = seed.fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ b as u64).wrapping_mul(0x100_0000_01b3));
        let results = run(sections, model, rays, seed >> 1);
        assert!(results.trusted, "{}: {:?}", self.case.id, results.warnings);
        results
    }

    /// A random number against its reference; `sys` as [`Case::sys`] or derived where it is given.
    pub fn check(&mut self, name: impl Into<String>, found: Estimate, reference: f64, sys: f64) {
        self.push(name.into(), found, reference, sys, true);
    }

    /// As `check`, for a number that follows from others of the same run (R beside T of a lossless plate).
    pub fn check_too(&mut self, name: impl Into<String>, found: Estimate, reference: f64, sys: f64) {
        self.push(name.into(), found, reference, sys, false);
    }

    /// A number without chance in it, to `tolerance`.
    pub fn exact(&mut self, name: impl Into<String>, value: f64, reference: f64, tolerance: f64) {
        self.push(name.into(), Estimate { mean: value, error: 0.0 }, reference, tolerance, false);
    }

    fn push(&mut self, name: String, found: Estimate, reference: f64, sys: f64, independent: bool) {
        let (id, Estimate { mean: value, error }) = (self.case.id.clone(), found);
        self.checks.push(Check { id, name, value, error, reference, sys, independent });
    }
}

/// `estimate` times a number without error.
pub fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate { mean: estimate.mean * factor, error: estimate.error * factor.abs() }
}

/// Tries a case at quick size.
pub fn quick(name: &str, case: fn(&mut Trial)) {
    let start = Instant::now();
    let mut trial = Trial::new(name, Size::Quick);
    case(&mut trial);
    println!("{name}: {:.2} s", start.elapsed().as_secs_f64());
    assert!(!trial.checks.is_empty(), "{name} checks nothing");
    trial.checks.iter().for_each(Check::assert);
}

/// What a case finds at full size; tried once however often it is asked for.
pub fn full(name: &'static str, case: fn(&mut Trial)) -> Vec<Check> {
    type Known = Mutex<HashMap<&'static str, Arc<OnceLock<Vec<Check>>>>>;
    static KNOWN: OnceLock<Known> = OnceLock::new();
    let known = KNOWN.get_or_init(Known::default);
    let cell = known.lock().expect("no test panics here").entry(name).or_default().clone();
    let found = cell.get_or_init(|| {
        let start = Instant::now();
        let mut trial = Trial::new(name, Size::Full);
        case(&mut trial);
        println!("{name}: {:.2} s", start.elapsed().as_secs_f64());
        trial.checks
    });
    found.clone()
}

/// Flux in one bin of a detector's map, W.
pub fn bin(results: &Results, detector: &str, bin: usize) -> Estimate {
    let map = results.maps.iter().find(|map| map.detector == detector).unwrap_or_else(|| panic!("no {detector}"));
    scaled(Estimate { mean: map.mean[bin], error: map.error[bin] }, map.extent[bin])
}

/// Mean and standard error of independent runs.
pub fn spread(values: &[f64]) -> Estimate {
    let sum: f64 = values.iter().sum();
    let mean = sum / values.len() as f64;
    let spread = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let (mean, error) = mean_and_error(sum, spread, values.len() as u64);
    Estimate { mean, error }
}
