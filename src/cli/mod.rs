//! The command line: one file per verb. The only place that prints.

mod against;
pub mod bsdf;
pub mod check;
pub mod coating;
pub mod compare;
pub mod export;
pub mod finishes;
pub mod fit;
pub mod fit_bsdf;
pub mod ghosts;
pub mod glare;
pub mod import;
pub mod objects;
mod optics;
pub mod pst;
pub mod ray;
pub mod run;
pub mod schema;
pub mod sensitivity;
mod stop;
mod table;
mod tracing;
pub mod view;

use clap::{Args, Parser, Subcommand};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use straylight::error::{Error, Problem};
use straylight::report::problems;
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::{Choice, Document};

/// Threads that may be asked for.
const THREADS: std::ops::RangeInclusive<i64> = 1..=4096;

/// Stray light of optical systems: watts on the detector with error bars, by path, in a ledger that closes
#[derive(Parser)]
#[command(version, max_term_width = 100, after_help = EXAMPLE)]
pub struct Cli {
    #[command(subcommand)]
    pub verb: Verb,
}

const EXAMPLE: &str = "\
Example:
  straylight check systems/triplet/system.ron
  straylight run systems/triplet/system.ron -o report";

/// What to do.
#[derive(Subcommand)]
pub enum Verb {
    /// Trace a system and write a report
    Run(run::RunArgs),
    /// Trace the variants of a system together and say what they change
    Compare(compare::CompareArgs),
    /// Say which surface to improve first
    Sensitivity(sensitivity::SensitivityArgs),
    /// Trace the sweeps of a system: point source transmittance over angle, against what is required
    Pst(pst::PstArgs),
    /// Trace every ghost by itself, by the pair of surfaces that makes it: flux, peak, size, focus
    Ghosts(ghosts::GhostsArgs),
    /// Trace a uniform field with a black patch: veiling glare index
    Glare(glare::GlareArgs),
    /// Say what the detectors see and the sources light, and what warm objects send by themselves
    Objects(objects::ObjectsArgs),
    /// Say what was understood of a system, without tracing it
    Check(check::CheckArgs),
    /// Show a system in 3-D in a browser, with some of its rays, before it is traced
    View(view::ViewArgs),
    /// Trace one packet of 1 W and print every event
    Ray(ray::RayArgs),
    /// Print and draw what a scatter model does: BSDF and TIS
    Bsdf(bsdf::BsdfArgs),
    /// Write the geometry of a system as glTF
    Export(export::ExportArgs),
    /// Turn a lens of a design program into a system
    Import(import::ImportArgs),
    /// Find the planes, spheres, conics and cylinders that a mesh was made from
    Fit(fit::FitArgs),
    /// Fit ABg, Harvey-Shack and K-correlation laws to a measured table of scatter
    FitBsdf(fit_bsdf::FitBsdfArgs),
    /// Print and draw what a coating reflects, transmits and absorbs
    Coating(coating::CoatingArgs),
    /// Print the built-in finishes: names, wavelengths, sources
    #[command(after_help = "Example:\n  straylight finishes")]
    Finishes,
    /// Print the grammar of a system file, as a commented example
    #[command(after_help = "Example:\n  straylight schema > system.ron")]
    Schema,
}

/// What is chosen of a system.
#[derive(Args)]
pub struct Chosen {
    /// Set a parameter of the system: hood.length="120 mm"; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
    /// Choose one of the system's `configurations`
    #[arg(long, value_name = "NAME")]
    pub configuration: Option<String>,
    /// Choose one of the system's `variants`, by itself
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, such as hood.length=\"120 mm\"")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

impl Chosen {
    /// Reads a system with its parameters so chosen.
    pub fn read(&self, system: &Path) -> Result<Document, Error> {
        Document::choose(system, &self.choice())
    }

    /// What is chosen.
    pub fn choice(&self) -> Choice {
        let Chosen { set, configuration, variant } = self;
        Choice { configuration: configuration.clone(), set: set.clone(), variant: variant.clone() }
    }

    /// As arguments of a command line.
    pub fn command(&self) -> String {
        let set = self.set.iter().map(|(name, value)| format!(" --set {name}={value:?}"));
        let named = self.configuration.iter().map(|name| format!(" --configuration {name:?}"));
        let variant = self.variant.iter().map(|name| format!(" --variant {name:?}"));
        named.chain(variant).chain(set).collect()
    }
}

/// How a verb ended.
pub enum Ending {
    Done,
    /// Finished, but not to be trusted.
    Doubtful,
    /// Told to stop; the exit code that says by what.
    Interrupted(u8),
}

/// Prints the error, if any; the exit code.
pub fn conclude(done: Result<Ending, Error>) -> ExitCode {
    match done {
        Ok(Ending::Done) => ExitCode::SUCCESS,
        Ok(Ending::Doubtful) => ExitCode::from(3),
        Ok(Ending::Interrupted(code)) => ExitCode::from(code),
        Err(error) => {
            let told = problems::render(error.problems(), &text_of);
            // The problems begin with the same one line.
            say(&if told.is_empty() { format!("{error}\n") } else { told });
            ExitCode::from(error.exit_code())
        }
    }
}

/// Arguments that clap refused, or its help.
pub fn usage(error: clap::Error) -> ExitCode {
    let asked = !error.use_stderr();
    // Nobody is left to tell if the terminal is gone.
    let _ = error.print();
    ExitCode::from(if asked { 0 } else { 64 })
}

/// Writes to standard error, whatever happens to it.
pub fn say(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Writes to standard output; a closed pipe is not an error.
pub fn tell(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// The text of a file that a problem is in, if it is one to show lines of.
fn text_of(path: &Path) -> Option<String> {
    const LARGEST: u64 = 1 << 20;
    let small = std::fs::metadata(path).is_ok_and(|meta| meta.is_file() && meta.len() <= LARGEST);
    small.then(|| std::fs::read_to_string(path).ok()).flatten()
}

/// Reads and compiles a system; warnings go to standard error.
pub fn load(system: &Path, chosen: &Chosen) -> Result<Compiled, Error> {
    let compiled = compile(&chosen.read(system)?)?;
    warn(&compiled.warnings);
    Ok(compiled)
}

/// Warnings, a line each.
pub fn warn(warnings: &[Problem]) {
    for warning in warnings {
        say(&format!("{warning}\n"));
    }
}
