//! `straylight ghosts`: every ghost by the surfaces that make it.

use super::stop::Stop;
use super::tracing::{Ticker, Tracing, info, writable};
use super::{Ending, load, say, tell};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::settings::Settings;
use straylight::study::ghost::{Ghosts, MOST_ORDER, ghosts as study};

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
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight ghosts systems/double_gauss/system.ron -o ghosts --rays 1e5

Every sequence of unintended reflections is followed with exact coefficients: a ghost of 1e-9 is known as
well as one of 1e-2. The folder gets ghosts.html (start there), ghosts.json, ghosts.csv, matrix.csv
(surface by surface), and the map of each ghost as NPY and PNG. Scattered light is left out.";

/// Traces the ghosts and says what they come to.
pub fn ghosts(args: &GhostsArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.tracing.chosen)?;
    let settings = args.tracing.settings(&compiled.settings);
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
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
    let info = info(command(args, &settings), &pool, start, found.rays, found.segments, false);
    tell(&report::ghosts::text(&found, &info));
    report::ghosts::write(&args.output, &found, &info)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    tell(&format!("\nreport: {}\n", args.output.join("ghosts.html").display()));
    Ok(if found.trusted { Ending::Done } else { Ending::Doubtful })
}

fn command(args: &GhostsArgs, settings: &Settings) -> String {
    let (system, output, order) = (args.system.display(), args.output.display(), args.order);
    let traced = args.tracing.command(settings.rays, settings.seed, "");
    format!("straylight ghosts {system} -o {output} --order {order}{traced}")
}
