//! `straylight pst`: point source transmittance over the sweeps of a system, held against what is required.

use super::stop::Stop;
use super::tracing::{Tracing, host, writable};
use super::{Ending, load, say, tell};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;
use straylight::error::{Error, Problem, did_you_mean};
use straylight::report;
use straylight::report::pst::Went;
use straylight::settings::Settings;
use straylight::study::pst::{Curve, Kept, Plan, Round, Sweeps, fingerprint, trace};
use straylight::system::compile::{Compiled, Sweep};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct PstArgs {
    /// System file (RON) with `sweeps`; `straylight schema` prints its grammar
    pub system: PathBuf,
    /// Folder for the report; made if it is not there. What was traced before is kept there and used again
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// One of the sweeps; all of them if not given
    #[arg(long, value_name = "NAME")]
    pub sweep: Option<String>,
    /// Relative standard error of the PST at which a direction is known well enough
    #[arg(long, value_name = "ERROR", default_value = "10 %", value_parser = percent)]
    pub until: f64,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight pst systems/star_tracker/system.ron -o report --until \"10 %\"

PST = mean irradiance on the detector / irradiance across the beam. All directions are traced in rounds; each
round doubles the rays of those that are not yet known well enough, up to --rays of a direction. The same command with more --rays or a smaller
--until goes on where this one ended, to the same bits as if it had been asked for at once.

The folder gets pst.html (start there), pst.csv, pst.json, and a picture of each sweep. Ctrl-C writes the rounds
that are finished; a second one ends at once.

Exit code: 0 done, whatever the requirement comes to; 3 done but not to be trusted, 64 usage, 65 bad input,
66 missing file, 74 report not writable, 130 Ctrl-C, 143 terminated.";

/// Where rounds are kept in the folder of a report.
const KEPT: &str = "rounds.json";

fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
    let valid = number.filter(|percent| *percent > 0.0 && percent.is_finite());
    valid.map(|percent| percent / 100.0).ok_or_else(|| "expected an error above 0 %, such as \"10 %\"".into())
}

/// Traces the sweeps and writes what they come to.
pub fn pst(args: &PstArgs) -> Result<Ending, Error> {
    let mut compiled = load(&args.system, &args.tracing.chosen)?;
    let sweeps = chosen(args, &compiled)?;
    let settings = args.tracing.settings(&compiled.settings);
    // Before the work, not after it.
    writable(&args.output)?;
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
    let start = Instant::now();
    let file = args.output.join(KEPT);
    let text = std::fs::read_to_string(&file).unwrap_or_default();
    // A variant is in the system's file beside the others: the hash of the file does not tell which it is.
    let of = format!("{} {:?}", fingerprint(&compiled, &settings), args.tracing.chosen.variant);
    let mut kept = Kept::read(&text, of);
    if kept.sweeps.is_empty() && !text.is_empty() {
        say("what the folder keeps is of another system, variant, seed or version: it is traced anew\n");
    }
    let mut curves = Vec::new();
    for sweep in &sweeps {
        let plan = Plan { sweep, settings: &settings, most: settings.rays, until: args.until };
        let known = kept.sweeps.get(&sweep.label).cloned().unwrap_or_default();
        let mut failed = None;
        let mut done = |rounds: &[Round]| {
            kept.keep(&sweep.label, rounds);
            failed = report::create(&file, |out| kept.write(out)).err().or(failed.take());
            say(&so_far(&plan, rounds));
        };
        let scene = &mut compiled.scene;
        let rounds = pool.install(|| trace(scene, &plan, &known, &stop.asked, &mut done));
        if let Some(source) = failed {
            return Err(Error::Io { path: file, source });
        }
        if !rounds.is_empty() {
            curves.push(Curve::of(&compiled.scene, &plan, &rounds));
        }
    }
    let interrupted = stop.asked.load(std::sync::atomic::Ordering::Relaxed);
    if curves.is_empty() {
        say("interrupted before the end of the first round: nothing is written\n");
        return Ok(Ending::Interrupted(stop.code()));
    }
    let trusted = curves.iter().all(|curve| curve.trusted);
    let went = Went {
        version: env!("CARGO_PKG_VERSION").into(),
        threads: pool.current_num_threads(),
        seconds: start.elapsed().as_secs_f64(),
        host: host(),
        interrupted,
        command: command(args, &settings),
    };
    let Compiled { inputs, parameters, scene, .. } = compiled;
    conclude(&args.output, &Sweeps { system: scene.name, curves, inputs, parameters }, &went)?;
    Ok(match (interrupted, trusted) {
        (true, _) => Ending::Interrupted(stop.code()),
        (false, false) => Ending::Doubtful,
        (false, true) => Ending::Done,
    })
}

/// Prints and writes it all.
fn conclude(folder: &Path, sweeps: &Sweeps, went: &Went) -> Result<(), Error> {
    tell(&report::pst::text(sweeps, went));
    let written = report::pst::write(folder, sweeps, went)
        .map_err(|error| Error::Io { path: error.path, source: error.source })?;
    if let Some(page) = written.last() {
        tell(&format!("\nreport: {}\n", page.display()));
    }
    Ok(())
}

/// The sweeps that are asked for.
fn chosen(args: &PstArgs, compiled: &Compiled) -> Result<Vec<Sweep>, Error> {
    if compiled.sweeps.is_empty() {
        let problem = Problem::error("the system has no sweep").in_file(&args.system).expecting("`sweeps: {..}`");
        return Err(Error::Input(vec![problem]));
    }
    let Some(name) = &args.sweep else { return Ok(compiled.sweeps.clone()) };
    let names: Vec<&str> = compiled.sweeps.iter().map(|sweep| &*sweep.label).collect();
    let found = compiled.sweeps.iter().find(|sweep| sweep.label == *name);
    found.map(|sweep| vec![sweep.clone()]).ok_or_else(|| {
        let close = did_you_mean(name, names.iter().copied()).map(|close| format!("; did you mean {close:?}?"));
        let known = format!("; there are: {}", names.join(", "));
        Error::Usage(format!("--sweep {name:?}: no such sweep{}", close.unwrap_or(known)))
    })
}

/// How far a sweep is, in a line.
fn so_far(plan: &Plan, rounds: &[Round]) -> String {
    let open = plan.open(rounds).len();
    let all = plan.sweep.directions();
    format!("{}: round {}, {} of {all} directions known\n", plan.sweep.label, rounds.len(), all - open)
}

fn command(args: &PstArgs, settings: &Settings) -> String {
    let sweep = args.sweep.as_ref().map_or(String::new(), |name| format!(" --sweep {name:?}"));
    let until = format!("{sweep} --until \"{} %\"", report::measured(100.0 * args.until, 0.0));
    let traced = args.tracing.command(settings.rays, settings.seed, &until);
    format!("straylight pst {} -o {}{traced}", args.system.display(), args.output.display())
}
