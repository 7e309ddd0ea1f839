//! `straylight objects`: what the detectors see, what the sources light, what is both, what glows.

use super::run::{count, host, writable};
use super::stop::Stop;
use super::{Chosen, Ending, THREADS, say, tell, warn};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use straylight::detector::Place;
use straylight::error::{Error, Problem};
use straylight::report;
use straylight::settings::Settings;
use straylight::study::objects::{Objects, Question, objects as study};
use straylight::system::compile::compile_warm;
use straylight::tally::results::RunInfo;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct ObjectsArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Folder for the report; made if it is not there. Without it, text only
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Rays of each trace, instead of the system's own number: 1000000, 1_000_000 or 1e6
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
  straylight objects systems/questar/system.ron -o objects

Critical objects are those that a detector sees, illuminated ones those that the sources light; what is
both is one scatter away from the detector. With `thermal`, what warm objects send to it by themselves.
The folder gets objects.html (start there), objects.csv and objects.json.";

/// Looks.
pub fn objects(args: &ObjectsArgs) -> Result<Ending, Error> {
    let compiled = compile_warm(&args.chosen.read(&args.system)?)?;
    warn(&compiled.warnings);
    let (scene, thermal) = (&compiled.scene, compiled.thermal.as_ref());
    if scene.detectors.iter().all(|detector| matches!(detector.place, Place::FarField)) {
        let problem = Problem::error("no detector to look from").in_file(&args.system);
        return Err(Error::Input(vec![problem.expecting("one on a node, or a `Rectangle` or `Disk`")]));
    }
    let settings = Settings {
        rays: args.rays.unwrap_or(compiled.settings.rays),
        seed: args.seed.unwrap_or(compiled.settings.seed),
        ..compiled.settings.clone()
    };
    args.output.as_deref().map_or(Ok(()), writable)?;
    let stop = Stop::listen();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0) as usize).build();
    let pool = pool.map_err(|error| Error::Internal(format!("no threads: {error}")))?;
    let start = Instant::now();
    let question = Question { scene, thermal, settings: &settings };
    let Some(mut found) = pool.install(|| study(question, &stop.asked)) else {
        say("interrupted: nothing is told of what was not finished\n");
        return Ok(Ending::Interrupted(stop.code()));
    };
    found.inputs = compiled.inputs;
    let info = info(args, &found, pool.current_num_threads(), start.elapsed().as_secs_f64());
    tell(&report::objects::text(&found, &info));
    if let Some(folder) = &args.output {
        report::objects::write(folder, &found, &info)
            .map_err(|error| Error::Io { path: error.path, source: error.source })?;
        tell(&format!("\nreport: {}\n", folder.join("objects.html").display()));
    }
    Ok(if found.trusted { Ending::Done } else { Ending::Doubtful })
}

fn info(args: &ObjectsArgs, found: &Objects, threads: usize, seconds: f64) -> RunInfo {
    let output = args.output.as_ref().map(|folder| format!(" -o {}", folder.display())).unwrap_or_default();
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
            "straylight objects {}{output} --rays {} --seed {}{}",
            args.system.display(),
            found.rays,
            found.seed,
            args.chosen.command()
        ),
    }
}
