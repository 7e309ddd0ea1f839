//! `straylight objects`: what the detectors see, what the sources light, what is both, what glows.

use super::stop::Stop;
use super::tracing::{Tracing, info, writable};
use super::{Ending, say, tell, warn};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::detector::Place;
use straylight::error::{Error, Problem};
use straylight::report;
use straylight::study::objects::{Objects, Question, objects as study};
use straylight::system::compile::compile_warm;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct ObjectsArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Folder for the report; made if it is not there. Without it, text only
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight objects systems/questar/system.ron -o objects

Critical objects are those that a detector sees, illuminated ones those that the sources light; what is
both is one scatter away from the detector. With `thermal`, what warm objects send to it by themselves.
Every trace has so many rays. The folder gets objects.html (start there), objects.csv and objects.json.";

/// Looks.
pub fn objects(args: &ObjectsArgs) -> Result<Ending, Error> {
    let compiled = compile_warm(&args.tracing.chosen.read(&args.system)?)?;
    warn(&compiled.warnings);
    let (scene, thermal) = (&compiled.scene, compiled.thermal.as_ref());
    if scene.detectors.iter().all(|detector| matches!(detector.place, Place::FarField)) {
        let problem = Problem::error("no detector to look from").in_file(&args.system);
        return Err(Error::Input(vec![problem.expecting("one on a node, or a `Rectangle` or `Disk`")]));
    }
    let settings = args.tracing.settings(&compiled.settings);
    args.output.as_deref().map_or(Ok(()), writable)?;
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
    let start = Instant::now();
    let question = Question { scene, thermal, settings: &settings };
    let Some(mut found) = pool.install(|| study(question, &stop.asked)) else {
        say("interrupted: nothing is told of what was not finished\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    found.inputs = compiled.inputs;
    let info = info(command(args, &found), &pool, start, found.rays, found.segments, false);
    tell(&report::objects::text(&found, &info));
    if let Some(folder) = &args.output {
        report::objects::write(folder, &found, &info)
            .map_err(|error| Error::Io { path: error.path, source: error.source })?;
        tell(&format!("\nreport: {}\n", folder.join("objects.html").display()));
    }
    Ok(if found.trusted { Ending::Done } else { Ending::Doubtful })
}

fn command(args: &ObjectsArgs, found: &Objects) -> String {
    let output = args.output.as_ref().map(|folder| format!(" -o {}", folder.display())).unwrap_or_default();
    let traced = args.tracing.command(found.rays, found.seed, "");
    format!("straylight objects {}{output}{traced}", args.system.display())
}
