//! What the commands that trace have in common: arguments, threads, progress, and how it went.

use super::{Chosen, THREADS, say};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::ThreadPool;
use std::io::IsTerminal;
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use straylight::error::Error;
use straylight::scene::Scene;
use straylight::settings::{Settings, Until};
use straylight::tally::results::RunInfo;

/// How to trace.
#[derive(Args)]
pub struct Tracing {
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

impl Tracing {
    /// The system's settings with rays and seed as chosen.
    pub fn settings(&self, system: &Settings) -> Settings {
        Settings { rays: self.rays.unwrap_or(system.rays), seed: self.seed.unwrap_or(system.seed), ..system.clone() }
    }

    /// The threads.
    pub fn pool(&self) -> Result<ThreadPool, Error> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0).into()).build();
        pool.map_err(|error| Error::Internal(format!("no threads: {error}")))
    }

    /// As arguments of a command line that gives the same bits; `more` are those of the command's own.
    pub fn command(&self, rays: u64, seed: u64, more: &str) -> String {
        format!(" --rays {rays} --seed {seed}{more}{}", self.chosen.command())
    }
}

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

/// Makes the folder and tries it with a file that vanishes.
pub fn writable(folder: &Path) -> Result<(), Error> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    tried.map(drop).map_err(|source| Error::Io { path: folder.into(), source })
}

/// System and cores.
pub fn host() -> String {
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    format!("{} {}, {cores} cores", std::env::consts::OS, std::env::consts::ARCH)
}

/// How a command went that traced so many rays and flights since `start`.
pub fn info(
    command: String,
    pool: &ThreadPool,
    start: Instant,
    rays: u64,
    segments: u64,
    interrupted: bool,
) -> RunInfo {
    let seconds = start.elapsed().as_secs_f64();
    RunInfo {
        version: env!("CARGO_PKG_VERSION").into(),
        threads: pool.current_num_threads(),
        seconds,
        rays_per_s: rays as f64 / seconds,
        segments,
        segments_per_s: segments as f64 / seconds,
        host: host(),
        interrupted,
        command,
    }
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
        // The first batches come after what is learned of importance.
        bar.set_message("looking where the light goes");
        bar.enable_steady_tick(Duration::from_millis(200));
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
