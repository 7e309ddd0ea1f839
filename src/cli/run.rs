//! `straylight run`: trace a system and write a report.

use super::stop::Stop;
use super::tracing::{Ticker, Tracing, info, until, writable};
use super::{Ending, load, say, tell};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::filter::Filter;
use straylight::report;
use straylight::scene::Scene;
use straylight::settings::Settings;
use straylight::study::assumption::assumptions;
use straylight::study::drawing::{draw, followed};
use straylight::study::requirement::judge;
use straylight::system::compile::Compiled;
use straylight::tally::drawing::Drawing;
use straylight::tally::results::Results;
use straylight::transport::{self, Progress, summary};

/// Lanes of a run without variants.
const V: usize = 1;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct RunArgs {
    /// System file (RON); `straylight schema` prints its grammar
    pub system: PathBuf,
    /// Folder for the report; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Stop early at this relative standard error: "1 % on fpa"
    #[arg(long, value_name = "ERROR")]
    pub until: Option<String>,
    /// Count light apart by its way: "scatters == 1 and Barrel*"; may be repeated
    #[arg(long, value_name = "EXPRESSION")]
    pub filter: Vec<String>,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight run systems/triplet/system.ron -o report --rays 1e6 --until \"1 % on fpa\"

The folder gets report.html (start there), summary.json, paths.csv, and for each detector its map as
FITS, NPY and PNG. Ctrl-C writes what is finished; a second one ends at once.

Exit code: 0 done, 3 done but not to be trusted (the report says why), 64 usage, 65 bad input,
66 missing file, 74 report not writable, 130 Ctrl-C, 143 terminated.";

/// Runs it.
pub fn run(args: &RunArgs) -> Result<Ending, Error> {
    let mut compiled = load(&args.system, &args.tracing.chosen)?;
    compiled.scene.filters.extend(filters(args, &compiled.scene)?);
    let settings = settings(args, &compiled)?;
    // Before the work, not after it.
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
    let start = Instant::now();
    let ticker = Ticker::new(settings.batches() * settings.batch_rays());
    let tick = |p: &Progress<V>| ticker.tick(p.batches as f64 / p.of as f64, &so_far(&compiled.scene, p));
    let counts = pool.install(|| transport::run::<V>(&compiled.scene, &settings, &stop.asked, &tick));
    ticker.finish();
    if counts.interrupted {
        let all = settings.batches();
        say(&format!("interrupted: {} of {all} batches are finished\n", counts.sums.batches));
        if counts.sums.batches < 2 {
            say("that is too little for an error bar: nothing is written\n");
            return Ok(Ending::Interrupted(stop.code()));
        }
    }
    let warnings = compiled.warnings.iter().map(ToString::to_string).collect();
    let results = summary::results(&compiled.scene, &settings, &counts, 0, compiled.inputs, warnings);
    let scene = &compiled.scene;
    let results = Results {
        requirements: judge(&compiled.requirements, scene, &results),
        assumptions: assumptions(scene, &settings, &compiled.finishes),
        drawing: Some(Drawing { ways: followed(scene, &counts), ..draw(scene) }),
        parameters: compiled.parameters,
        finishes: compiled.finishes,
        ..results
    };
    let info = info(command(args, &settings), &pool, start, results.rays, counts.segments, counts.interrupted);
    tell(&report::text(&results, &info));
    let written = report::write(&args.output, &results, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    if let Some(page) = written.iter().find(|path| path.extension().is_some_and(|e| e == "html")) {
        tell(&format!("\nreport: {}\n", page.display()));
    }
    Ok(match (counts.interrupted, results.trusted) {
        (true, _) => Ending::Interrupted(stop.code()),
        (false, false) => Ending::Doubtful,
        (false, true) => Ending::Done,
    })
}

/// The filters of the command line, each called as it is written.
fn filters(args: &RunArgs, scene: &Scene) -> Result<Vec<Filter>, Error> {
    let (names, mut filters, mut wrong) = (scene.names(), Vec::new(), Vec::new());
    for text in &args.filter {
        match Filter::parse(text, text, &names) {
            Ok(filter) => filters.push(filter),
            Err(problems) => wrong.extend(problems.into_iter().map(|problem| problem.on(format!("--filter {text:?}")))),
        }
    }
    if wrong.is_empty() { Ok(filters) } else { Err(Error::Input(wrong)) }
}

fn settings(args: &RunArgs, compiled: &Compiled) -> Result<Settings, Error> {
    let mut settings = Settings { ways: true, ..args.tracing.settings(&compiled.settings) };
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    Ok(settings)
}

fn command(args: &RunArgs, settings: &Settings) -> String {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    let filters: String = args.filter.iter().map(|text| format!(" --filter {text:?}")).collect();
    let traced = args.tracing.command(settings.rays, settings.seed, &format!("{until}{filters}"));
    format!("straylight run {} -o {}{traced}", args.system.display(), args.output.display())
}

/// The first detector's flux so far.
fn so_far(scene: &Scene, progress: &Progress<V>) -> String {
    let estimate = scene.detectors.first().map(|detector| {
        let estimate = progress.sums.estimate(progress.layout.detector(0), 0);
        format!("{}: {} W", detector.label, report::measured(estimate.mean, estimate.error))
    });
    estimate.unwrap_or_default()
}
