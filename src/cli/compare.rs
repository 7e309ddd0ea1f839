//! `straylight compare`: trace the variants of a system and say what they change.

use super::stop::Stop;
use super::tracing::{Ticker, Tracing, info, until, writable};
use super::{Ending, say, tell, warn};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::error::Error;
use straylight::report;
use straylight::settings::Settings;
use straylight::study::compare::{Comparison, Step, compare as study};
use straylight::system::compile::variants::{Lineup, lineup};
use straylight::system::document::Document;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct CompareArgs {
    /// System file (RON) with a section `variants`
    pub system: PathBuf,
    /// Folder for the report; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Stop early at this relative standard error of all lanes: "1 % on fpa"
    #[arg(long, value_name = "ERROR")]
    pub until: Option<String>,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight compare systems/double_gauss/coatings.ron -o coatings --rays 1e6

All variants that share shapes and indices are one trace, up to 16 of them; their differences are
paired. The folder gets compare.html (start there), compare.json, compare.csv, and for each variant
a folder with the report of it alone. `straylight run --variant NAME` traces one variant by itself.";

/// Compares.
pub fn compare(args: &CompareArgs) -> Result<Ending, Error> {
    if args.tracing.chosen.variant.is_some() {
        return Err(Error::Usage("--variant: all variants are compared; `straylight run` traces one".into()));
    }
    let documents = Document::lineup(&args.system, &args.tracing.chosen.choice())?;
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
    let pool = args.tracing.pool()?;
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
    let rays = comparison.rays * comparison.traces as u64;
    let command = command(args, &comparison);
    let info = info(command, &pool, start, rays, comparison.segments, comparison.interrupted);
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
    let mut settings = args.tracing.settings(&compiled.settings);
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    Ok(settings)
}

fn command(args: &CompareArgs, comparison: &Comparison) -> String {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    let traced = args.tracing.command(comparison.rays_requested, comparison.seed, &until);
    format!("straylight compare {} -o {}{traced}", args.system.display(), args.output.display())
}
