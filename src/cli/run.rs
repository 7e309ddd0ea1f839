//! `straylight run`: trace a system and write a report.

use super::stop::Stop;
use super::{Chosen, Ending, THREADS, load, say, tell};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use straylight::error::Error;
use straylight::filter::Filter;
use straylight::report;
use straylight::scene::Scene;
use straylight::settings::{Settings, Until};
use straylight::system::compile::Compiled;
use straylight::tally::results::{Results, RunInfo};
use straylight::transport::{self, Counts, Progress, summary};

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
    /// Count light apart by its way, beside the system's own `filters`: "scatters == 1 and Barrel*"; may be repeated
    #[arg(long, value_name = "EXPRESSION")]
    pub filter: Vec<String>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight run systems/triplet/system.ron -o report --rays 1e6 --until \"1 % on fpa\"

The folder gets report.html (start there), summary.json, paths.csv, and for each detector its map as
FITS, NPY and PNG. Ctrl-C writes what is finished; a second one ends at once.

Exit code: 0 done, 3 done but not to be trusted (the report says why), 64 usage, 65 bad input,
66 missing file, 74 report not writable, 130 Ctrl-C, 143 terminated.";

/// A number of rays: 1000000, 1_000_000 or 1e6.
pub fn count(text: &str) -> Result<u64, String> {
    let plain = text.replace('_', "");
    let number = plain.parse::<f64>().map_err(|_| "expected a number such as 1000000 or 1e6".to_string())?;
    if number >= 1.0 && number <= (1u64 << 48) as f64 && number.fract() == 0.0 {
        Ok(number as u64)
    } else {
        Err("expected a whole number from 1 to 2.8e14".into())
    }
}

/// Runs it.
pub fn run(args: &RunArgs) -> Result<Ending, Error> {
    let mut compiled = load(&args.system, &args.chosen)?;
    compiled.scene.filters.extend(filters(args, &compiled.scene)?);
    let settings = settings(args, &compiled)?;
    // Before the work, not after it.
    writable(&args.output)?;
    let stop = Stop::listen();
    let threads = args.threads.unwrap_or(0) as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Error::Internal(format!("no threads: {error}")))?;
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
    let seconds = start.elapsed().as_secs_f64();
    let warnings = compiled.warnings.iter().map(ToString::to_string).collect();
    let results = summary::results(&compiled.scene, &settings, &counts, 0, compiled.inputs, warnings);
    let results = Results { parameters: compiled.parameters, finishes: compiled.finishes, ..results };
    let info = info(args, &settings, &counts, &results, pool.current_num_threads(), seconds);
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

/// Makes the folder and tries it with a file that vanishes.
pub fn writable(folder: &Path) -> Result<(), Error> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    tried.map(drop).map_err(|source| Error::Io { path: folder.into(), source })
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

fn info(
    args: &RunArgs,
    settings: &Settings,
    counts: &Counts<V>,
    results: &Results,
    threads: usize,
    seconds: f64,
) -> RunInfo {
    RunInfo {
        version: env!("CARGO_PKG_VERSION").into(),
        threads,
        seconds,
        rays_per_s: results.rays as f64 / seconds,
        segments: counts.segments,
        segments_per_s: counts.segments as f64 / seconds,
        host: host(),
        interrupted: counts.interrupted,
        command: command(args, settings),
    }
}

fn settings(args: &RunArgs, compiled: &Compiled) -> Result<Settings, Error> {
    let mut settings = compiled.settings.clone();
    settings.rays = args.rays.unwrap_or(settings.rays);
    settings.seed = args.seed.unwrap_or(settings.seed);
    if let Some(text) = &args.until {
        settings.until = Some(until(text, &compiled.scene)?);
    }
    Ok(settings)
}

/// "1 % on fpa".
pub fn until(text: &str, scene: &Scene) -> Result<Until, Error> {
    let refuse = |what: String| Error::Usage(format!("--until {text:?}: {what}"));
    let wanted: straylight::system::document::Until =
        straylight::system::units::FromText::from_text(text).map_err(refuse)?;
    let detector = scene.detectors.iter().position(|d| d.label == wanted.detector);
    let names = || scene.detectors.iter().map(|d| d.label.as_str()).collect::<Vec<_>>().join(", ");
    let detector = detector.ok_or_else(|| refuse(format!("no such detector; there are: {}", names())))?;
    Ok(Until { detector, relative: wanted.relative })
}

/// System and cores.
pub fn host() -> String {
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    format!("{} {}, {cores} cores", std::env::consts::OS, std::env::consts::ARCH)
}

fn command(args: &RunArgs, settings: &Settings) -> String {
    let until = args.until.as_ref().map(|text| format!(" --until {text:?}")).unwrap_or_default();
    let filters: String = args.filter.iter().map(|text| format!(" --filter {text:?}")).collect();
    format!(
        "straylight run {} -o {} --rays {} --seed {}{until}{filters}{}",
        args.system.display(),
        args.output.display(),
        settings.rays,
        settings.seed,
        args.chosen.command()
    )
}

/// Shows how far it is: a bar on a terminal, else a plain line every ten seconds.
pub struct Ticker {
    bar: ProgressBar,
    start: Instant,
    last: Mutex<Instant>,
}

impl Ticker {
    /// A bar of so many source rays.
    pub fn new(rays: u64) -> Ticker {
        let bar = if std::io::stderr().is_terminal() { ProgressBar::new(rays) } else { ProgressBar::hidden() };
        let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {eta:>6} left  {msg}");
        bar.set_style(style.unwrap_or(ProgressStyle::default_bar()));
        Ticker { bar, start: Instant::now(), last: Mutex::new(Instant::now()) }
    }

    /// The part `done` (0..1) is traced.
    pub fn tick(&self, done: f64, message: &str) {
        self.bar.set_position((done * self.bar.length().unwrap_or(0) as f64) as u64);
        self.bar.set_message(message.to_owned());
        let Ok(mut last) = self.last.lock() else { return };
        if self.bar.is_hidden() && last.elapsed() >= Duration::from_secs(10) {
            *last = Instant::now();
            let left = self.start.elapsed().as_secs_f64() * (1.0 - done) / done;
            say(&format!("{:.0} % done, {left:.0} s left; {message}\n", 100.0 * done));
        }
    }

    /// Wipes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The first detector's flux so far.
fn so_far(scene: &Scene, progress: &Progress<V>) -> String {
    let estimate = scene.detectors.first().map(|detector| {
        let estimate = progress.sums.estimate(progress.layout.detector(0), 0);
        format!("{}: {} W", detector.label, report::measured(estimate.mean, estimate.error))
    });
    estimate.unwrap_or_default()
}
