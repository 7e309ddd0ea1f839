//! `straylight sensitivity`: which surface to improve first.

use super::stop::Stop;
use super::tracing::{Ticker, Tracing, info, until, writable};
use super::{Ending, load, say, tell};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::study::sensitivity::{Sensitivity, sensitivity as study};
use straylight::transport::Progress;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct SensitivityArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Folder for the tables; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Stop early at this relative standard error: "1 % on fpa"
    #[arg(long, value_name = "ERROR")]
    pub until: Option<String>,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight sensitivity systems/double_gauss/system.ron -o levers --rays 1e6

One run: stray light arrives as often reflected, transmitted and scattered by a surface as its flux goes
with that surface's reflectance, transmittance and scatter. The folder gets sensitivity.csv and .json.";

/// Runs it.
pub fn sensitivity(args: &SensitivityArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.tracing.chosen)?;
    let mut settings = args.tracing.settings(&compiled.settings);
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
    let start = Instant::now();
    let ticker = Ticker::new(settings.batches() * settings.batch_rays());
    let tick = |p: &Progress<1>| ticker.tick(p.batches as f64 / p.of as f64, "");
    let found = pool.install(|| study(&compiled.scene, &settings, &stop.asked, &tick));
    ticker.finish();
    let Some(found) = found else {
        say("interrupted: too little for an error bar, nothing is written\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    let info = info(command(args, &found), &pool, start, found.rays, found.segments, found.interrupted);
    tell(&report::sensitivity::text(&found, &info));
    report::sensitivity::write(&args.output, &found, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    Ok(if found.interrupted { Ending::Interrupted(stop.code()) } else { Ending::Done })
}

fn command(args: &SensitivityArgs, found: &Sensitivity) -> String {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    let traced = args.tracing.command(found.rays_requested, found.seed, &until);
    format!("straylight sensitivity {} -o {}{traced}", args.system.display(), args.output.display())
}
