//! `straylight ghosts`: every ghost by the surfaces that make it.

use super::run::{Ticker, count, host, writable};
use super::stop::Stop;
use super::{Chosen, Ending, THREADS, load, say, tell};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::settings::Settings;
use straylight::study::ghost::{Ghosts, MOST_ORDER, ghosts as study};
use straylight::tally::results::RunInfo;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct GhostsArgs {
    /// System file (RON); `straylight schema` prints its grammar
    pub system: PathBuf,
    /// Folder for the report; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Most unintended reflections, 1 to 6: beyond 2 it takes long
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST_ORDER)))]
    pub order: u16,
    /// Source rays, instead of the system's own number: 1000000, 1_000_000 or 1e6
    #[arg(long, value_name = "N", value_parser = count)]
    pub rays: Option<u64>,
    /// Seed of the random numbers: same seed, same bits
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Threads, from 1 up; all cores if not given. The result does not depend on it
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(THREADS))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight ghosts systems/double_gauss/system.ron -o ghosts --rays 1e5

Every sequence of unintended reflections is followed with exact coefficients: a ghost of 1e-9 is known as
well as one of 1e-2. The folder gets ghosts.html (start there), ghosts.json, ghosts.csv, matrix.csv
(surface by surface), and the map of each ghost as NPY and PNG. Scattered light is left out.";

/// Traces the ghosts and says what they come to.
pub fn ghosts(args: &GhostsArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.chosen)?;
    let settings = Settings {
        rays: args.rays.unwrap_or(compiled.settings.rays),
        seed: args.seed.unwrap_or(compiled.settings.seed),
        ..compiled.settings.clone()
    };
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0) as usize).build();
    let pool = pool.map_err(|error| Error::Internal(format!("no threads: {error}")))?;
    let start = Instant::now();
    let ticker = Ticker::new(settings.batches() * settings.batch_rays());
    let tick = |done: f64| ticker.tick(done, "");
    let found = pool.install(|| study(&compiled.scene, &settings, args.order, &stop.asked, &tick));
    ticker.finish();
    let Some(found) = found else {
        say("interrupted: nothing is told of what was not finished\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    let found = Ghosts { inputs: compiled.inputs, ..found };
    let info = info(args, &settings, &found, pool.current_num_threads(), start.elapsed().as_secs_f64());
    tell(&report::ghosts::text(&found, &info));
    report::ghosts::write(&args.output, &found, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    tell(&format!("\nreport: {}\n", args.output.join("ghosts.html").display()));
    Ok(if found.trusted { Ending::Done } else { Ending::Doubtful })
}

fn info(args: &GhostsArgs, settings: &Settings, found: &Ghosts, threads: usize, seconds: f64) -> RunInfo {
    RunInfo {
        version: env!("CARGO_PKG_VERSION").into(),
        threads,
        seconds,
        rays_per_s: found.rays as f64 / seconds,
        segments: found.segments,
        segments_per_s: found.segments as f64 / seconds,
        host: host(),
        interrupted: false,
        command: format!(
            "straylight ghosts {} -o {} --order {} --rays {} --seed {}{}",
            args.system.display(),
            args.output.display(),
            args.order,
            settings.rays,
            settings.seed,
            args.chosen.command()
        ),
    }
}
