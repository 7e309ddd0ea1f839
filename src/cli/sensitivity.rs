//! `straylight sensitivity`: which surface to improve first.

use super::run::{Ticker, count, host, until, writable};
use super::stop::Stop;
use super::{Chosen, Ending, THREADS, load, say, tell};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::study::sensitivity::{Sensitivity, sensitivity as study};
use straylight::tally::results::RunInfo;
use straylight::transport::Progress;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct SensitivityArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Folder for the tables; made if it is not there
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
    /// Stop early at this relative standard error: "1 % on fpa"
    #[arg(long, value_name = "ERROR")]
    pub until: Option<String>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight sensitivity systems/double_gauss/system.ron -o levers --rays 1e6

One run: stray light arrives as often reflected, transmitted and scattered by a surface as its flux goes
with that surface's reflectance, transmittance and scatter. The folder gets sensitivity.csv and .json.";

/// Runs it.
pub fn sensitivity(args: &SensitivityArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.chosen)?;
    let mut settings = compiled.settings.clone();
    settings.rays = args.rays.unwrap_or(settings.rays);
    settings.seed = args.seed.unwrap_or(settings.seed);
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0) as usize).build();
    let pool = pool.map_err(|error| Error::Internal(format!("no threads: {error}")))?;
    let start = Instant::now();
    let ticker = Ticker::new(settings.batches() * settings.batch_rays());
    let tick = |p: &Progress<1>| ticker.tick(p.batches as f64 / p.of as f64, "");
    let found = pool.install(|| study(&compiled.scene, &settings, &stop.asked, &tick));
    ticker.finish();
    let Some(found) = found else {
        say("interrupted: too little for an error bar, nothing is written\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    let info = info(args, &found, pool.current_num_threads(), start.elapsed().as_secs_f64());
    tell(&report::sensitivity::text(&found, &info));
    report::sensitivity::write(&args.output, &found, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    Ok(if found.interrupted { Ending::Interrupted(stop.code()) } else { Ending::Done })
}

fn info(args: &SensitivityArgs, found: &Sensitivity, threads: usize, seconds: f64) -> RunInfo {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    RunInfo {
        version: env!("CARGO_PKG_VERSION").into(),
        threads,
        seconds,
        rays_per_s: found.rays as f64 / seconds,
        segments: found.segments,
        segments_per_s: found.segments as f64 / seconds,
        host: host(),
        interrupted: found.interrupted,
        command: format!(
            "straylight sensitivity {} -o {} --rays {} --seed {}{until}{}",
            args.system.display(),
            args.output.display(),
            found.rays_requested,
            found.seed,
            args.chosen.command()
        ),
    }
}
