//! `straylight compare`: trace the variants of a system and say what they change.

use super::run::{Ticker, count, host, until, writable};
use super::stop::Stop;
use super::{Chosen, Ending, THREADS, say, tell, warn};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::settings::Settings;
use straylight::study::compare::{Comparison, Step, compare as study};
use straylight::system::compile::variants::{Lineup, lineup};
use straylight::system::document::Document;
use straylight::tally::results::RunInfo;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct CompareArgs {
    /// System file (RON) with a section `variants`
    pub system: PathBuf,
    /// Folder for the report; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Source rays, instead of the system's own number: 1000000, 1_000_000 or 1e6
    #[arg(long, value_name = "N", value_parser = count)]
    pub rays: Option<u64>,
    /// Seed of the random numbers: same seed, same bits
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Threads, from 1 up; all cores if not given. The result does not depend on it
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(THREADS))]
    pub threads: Option<u16>,
    /// Stop early at this relative standard error of all lanes: "1 % on fpa"
    #[arg(long, value_name = "ERROR")]
    pub until: Option<String>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight compare systems/double_gauss/coatings.ron -o coatings --rays 1e6

All variants that share shapes and indices are one trace, up to 16 of them; their differences are
paired. The folder gets compare.html (start there), compare.json, compare.csv, and for each variant
a folder with the report of it alone. `straylight run --variant NAME` traces one variant by itself.";

/// Compares.
pub fn compare(args: &CompareArgs) -> Result<Ending, Error> {
    if args.chosen.variant.is_some() {
        return Err(Error::Usage("--variant: all variants are compared; `straylight run` traces one".into()));
    }
    let documents = Document::lineup(&args.system, &args.chosen.choice())?;
    if documents.len() < 2 {
        let what = format!("{} has no `variants` to compare", args.system.display());
        return Err(Error::Usage(format!("{what}; `straylight schema` shows how they are written")));
    }
    let names: Vec<String> = std::iter::once("baseline".to_owned()).chain(documents[0].variants.clone()).collect();
    let lineup = lineup(&documents)?;
    warn(&lineup.warnings);
    let settings = settings(args, &lineup)?;
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0) as usize).build();
    let pool = pool.map_err(|error| Error::Internal(format!("no threads: {error}")))?;
    let start = Instant::now();
    let ticker = Ticker::new(settings.batches() * settings.batch_rays() * lineup.traces.len() as u64);
    let tick = |step: &Step| {
        let done = (step.trace as f64 + step.batches as f64 / step.of as f64) / step.traces as f64;
        ticker.tick(done, &format!("trace {} of {}", step.trace + 1, step.traces));
    };
    let found = pool.install(|| study(lineup, &names, &settings, &stop.asked, &tick));
    ticker.finish();
    let Some(comparison) = found else {
        say("interrupted: too little for an error bar, nothing is written\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    let info = info(args, &comparison, pool.current_num_threads(), start.elapsed().as_secs_f64());
    tell(&report::compare::text(&comparison, &info));
    report::compare::comparison(&args.output, &comparison, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    tell(&format!("\nreport: {}\n", args.output.join("compare.html").display()));
    Ok(match (comparison.interrupted, comparison.trusted) {
        (true, _) => Ending::Interrupted(stop.code()),
        (false, false) => Ending::Doubtful,
        (false, true) => Ending::Done,
    })
}

fn settings(args: &CompareArgs, lineup: &Lineup) -> Result<Settings, Error> {
    let compiled = &lineup.traces[0].compiled;
    let mut settings = compiled.settings.clone();
    settings.rays = args.rays.unwrap_or(settings.rays);
    settings.seed = args.seed.unwrap_or(settings.seed);
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    Ok(settings)
}

fn info(args: &CompareArgs, comparison: &Comparison, threads: usize, seconds: f64) -> RunInfo {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    RunInfo {
        version: env!("CARGO_PKG_VERSION").into(),
        threads,
        seconds,
        rays_per_s: comparison.rays as f64 * comparison.traces as f64 / seconds,
        segments: comparison.segments,
        segments_per_s: comparison.segments as f64 / seconds,
        host: host(),
        interrupted: comparison.interrupted,
        command: format!(
            "straylight compare {} -o {} --rays {} --seed {}{until}{}",
            args.system.display(),
            args.output.display(),
            comparison.rays_requested,
            comparison.seed,
            args.chosen.command()
        ),
    }
}
