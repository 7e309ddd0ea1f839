//! What a run found: plain numbers with names, ready to be written down.
//!
//! Everything here is the same bits for the same system, seed and rays, whatever the threads; times and hosts are kept apart.

use super::drawing::Drawing;
use super::required::Required;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use crate::detector::{Axis, MapKind};

/// A mean over batches with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Sample mean over the batches, in the unit of its context.
    pub mean: f64,
    /// Standard error of the mean (one sigma), same unit; from the scatter of the batch means.
    pub error: f64,
}

/// Where the watts went, W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LedgerResult {
    pub emitted: Estimate,
    /// In surfaces and in media.
    pub absorbed: Estimate,
    /// Left the scene.
    pub escaped: Estimate,
    /// Cut by roulette (net, zero on average) and by order limits.
    pub terminated: Estimate,
    /// Geometry faults, by cause in `Results::lost_w`.
    pub lost: Estimate,
    /// emitted - absorbed - escaped - terminated - lost: zero within its error.
    pub residual: Estimate,
}

impl LedgerResult {
    /// Whether the residual is one of chance or of rounding: within five sigma, which one run in two million exceeds, or 1e-12 of all,
    /// the rounding of a sum of many small terms.
    pub fn closes(&self) -> bool {
        self.residual.mean.abs() <= 5.0 * self.residual.error + 1e-12 * self.emitted.mean
    }
}

/// The brightest bin. A maximum is biased upward by noise: `error` is that of the bin, not of the maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peak {
    pub mean: f64,
    pub error: f64,
    /// [row, column].
    pub pixel: [usize; 2],
}

/// What one detector saw.
#[derive(Clone, Debug, Serialize)]
pub struct DetectorResult {
    /// Flux over the whole detector, W.
    pub flux_w: Estimate,
    /// Half-width of the 95 % interval of `flux_w` by Student's t, W.
    pub interval95_w: f64,
    /// Source rays that contributed.
    pub rays: u64,
    /// If nothing arrived: 3 x the largest flux that one source ray carries / N, W; else null.
    pub upper_limit_w: Option<f64>,
    /// Brightest bin, in `unit` (W/m2 or W/sr). Named by the unit of irradiance maps, the common case.
    pub peak_w_m2: Peak,
    /// Unit of the map.
    pub unit: String,
    /// What it counts where that is not all watts; else null.
    pub counted: Option<CountedResult>,
    /// What falls on its regions, in the unit of `counted`, else W.
    pub regions: BTreeMap<String, Estimate>,
    /// Share of the flux that the brightest batch brought: where it is large, the error is a guess.
    pub brightest_batch: f64,
    /// Relative variance of the variance of the mean, from the batches: about 2 / batches where they are normal, and more
    /// the fewer paths bring most of the flux.
    pub variance_of_variance: f64,
    /// The largest arrival; null if there was none.
    pub largest: Option<LargestResult>,
    /// Flux by class, W: "signal", "direct leak", "ghost 1", "scatter 1", ... All rows add up to `flux_w`.
    pub classes: BTreeMap<String, Estimate>,
    /// Flux by source, W.
    pub sources: BTreeMap<String, Estimate>,
    /// All light but what is meant to arrive.
    pub stray: StrayResult,
    /// How the flux became known.
    pub convergence: Convergence,
    /// Fraction of bins with fewer than 30 contributing source rays among those with any, 0..1.
    pub unresolved: f64,
}

/// What a detector counts, by wavelength and behind its filter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CountedResult {
    /// ph/s, e-/s, lm, or W behind a filter.
    pub unit: String,
    pub total: Estimate,
}

/// The largest arrival on a detector.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestResult {
    /// Share that it has of all flux that arrived, 0..1: where it is large, the error is a guess.
    pub share: f64,
    /// Its path, as in the table of paths.
    pub sequence: String,
}

/// Light on a detector apart from what is meant to arrive: the class "signal", or "direct" where nothing makes an image.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StrayResult {
    pub flux_w: Estimate,
    /// What is meant to arrive, W; null if none of it did.
    pub signal_w: Option<Estimate>,
    /// Stray over signal, dimensionless; the error is that of the ratio, from batches. Null without signal.
    pub to_signal: Option<Estimate>,
    /// Source rays that brought stray light, at least: those of the class that has most.
    pub rays: u64,
    /// Share of it that its brightest batch brought.
    pub brightest_batch: f64,
    /// 3 x the largest flux that one source ray carries / N, W: what may be hidden where nothing arrived.
    pub upper_limit_w: f64,
}

/// The flux on a detector as the run went on.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Convergence {
    /// After 4, 8, 16, ... batches, and after all.
    pub stages: Vec<Stage>,
    /// Of the first and of the second half of the batches, W: independent of each other.
    pub halves_w: [Estimate; 2],
}

/// What was known after some batches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stage {
    pub batches: u64,
    pub flux_w: Estimate,
}

/// What is required of the stray light on a detector, and whether it holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementResult {
    pub name: String,
    pub detector: String,
    /// "stray / signal", "stray flux" or "stray irradiance".
    pub quantity: String,
    /// "", "W" or "W/m2".
    pub unit: String,
    /// Null without signal, where the ratio to it is asked for.
    pub value: Option<Estimate>,
    /// One-sided probability with which the verdict holds, 0.5..1.
    pub confidence: f64,
    pub required: Required,
}

/// What a run learned of importance before it began.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GuidanceResult {
    /// Whether the run was drawn by it: where the trial showed a gain.
    pub used: bool,
    /// Figure of merit 1 / (relative error^2 x cost in flights) with it over that without, geometric mean over the flux on all detectors by
    /// class and by source, in a trial before the run.
    pub gain: f64,
    /// Patches of surfaces for which it knows what light is worth.
    pub patches: u64,
    /// What light is aimed at: detectors, and the last surfaces before them.
    pub targets: Vec<String>,
}

/// The light on a detector that a filter means, whatever rows the path table has.
#[derive(Clone, Debug, Serialize)]
pub struct FilterResult {
    /// Name of the filter.
    pub filter: String,
    /// As written: see [`filter`](crate::filter).
    pub expression: String,
    pub detector: String,
    pub flux_w: Estimate,
    /// Of the detector's total, %.
    pub percent: f64,
    /// Contributing source rays.
    pub rays: u64,
    /// If nothing arrived: 3 x the largest flux that one source ray carries / N, W; else null.
    pub upper_limit_w: Option<f64>,
    /// Flux on paths of more steps than are spelled out, of which it is open whether they are meant, W; it is not in `flux_w`.
    pub open_w: Estimate,
    /// Brightest bin, in the unit of the map.
    pub peak_w_m2: Peak,
    #[serde(skip)]
    pub map: MapResult,
}

/// One row of the path table.
#[derive(Clone, Debug, Serialize)]
pub struct PathResult {
    pub detector: String,
    pub source: String,
    /// "sun > Lens_1.front:T > ... > Barrel:S"; "other" for what had no row of its own.
    pub sequence: String,
    pub class: String,
    /// Contributing source rays.
    pub rays: u64,
    pub flux_w: Estimate,
    /// Of the detector's total, %.
    pub percent: f64,
    pub ghost_order: u32,
    pub scatter_order: u32,
    /// Names of the surfaces that reflected what they should not, in the order of the light.
    pub reflectors: Vec<String>,
    /// Name of the last surface that scattered, empty if none did.
    pub last_scatter: String,
    /// Flux-weighted mean optical path, m.
    pub optical_path_m: f64,
    /// Largest irradiance in a cell of the coarse grid (see `Results::path_grid`), W/m2.
    pub peak_w_m2: f64,
    /// Irradiance in every cell of that grid, W/m2, row by row; empty if the path has none of its own.
    #[serde(skip)]
    pub cells: Vec<f64>,
}

/// One detector's map. Bins are row-major: index = row * columns + column.
#[derive(Clone, Debug)]
pub struct MapResult {
    pub detector: String,
    /// Name of the filter whose light it is; `None`: all light.
    pub filter: Option<String>,
    pub kind: MapKind,
    /// [rows, columns]; triangles as bins: [1, n].
    pub shape: [usize; 2],
    /// Physical lengths (m) or angles (rad) of the first bin's lower edge and the step, along columns then rows; None for triangles.
    pub axes: Option<[Axis; 2]>,
    /// "W/m2" or "W/sr".
    pub unit: &'static str,
    /// Per bin, in `unit`.
    pub mean: Vec<f64>,
    pub error: Vec<f64>,
    /// Contributing source rays per bin.
    pub rays: Vec<u64>,
    /// Where no ray arrived: 3 x the largest flux one source ray carries / (N x bin size), in `unit`; else 0.
    pub upper: Vec<f64>,
    /// Bin sizes, m2 or sr.
    pub extent: Vec<f64>,
    /// Stray light alone, mean and error per bin, in `unit`; `None` where there is no other light to tell it from.
    pub stray: Option<[Vec<f64>; 2]>,
    /// World position (m) of the grid's origin corner and unit vectors of columns and rows: for captions.
    pub origin: [f64; 3],
    pub column_direction: [f64; 3],
    pub row_direction: [f64; 3],
    /// Seen from this side (front: looking against the detector's normal).
    pub side: &'static str,
}

impl MapResult {
    /// What it shows, by its unit.
    pub fn quantity(&self) -> &'static str {
        match self.unit {
            "W/sr" => "Radiant intensity",
            "cd" => "Luminous intensity",
            "lx" => "Illuminance",
            "ph/s/px" => "Photon rate",
            "e-/s/px" => "Electron rate",
            _ => "Irradiance",
        }
    }
}

/// Everything that depends only on system, seed and rays.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    pub system: String,
    /// Source rays traced: the request rounded up to whole batches, or what an interrupted run finished.
    pub rays: u64,
    pub rays_requested: u64,
    pub seed: u64,
    pub batch_rays: u64,
    pub batches: u64,
    pub detectors: BTreeMap<String, DetectorResult>,
    pub ledger_w: LedgerResult,
    /// Absorbed flux by surface, W; bulk absorption as "medium NAME".
    pub absorbed_w: BTreeMap<String, Estimate>,
    /// Flux lost to geometry faults by cause, W.
    pub lost_w: BTreeMap<String, Estimate>,
    /// Flux cut by cause ("roulette", "max_scatters", ...), W.
    pub terminated_w: BTreeMap<String, Estimate>,
    pub warnings: Vec<String>,
    /// False if flux was lost beyond the limit or the ledger does not close: see `warnings`.
    pub trusted: bool,
    /// SHA-256 of every file that was read, by name as written.
    pub inputs: BTreeMap<String, String>,
    /// Values of the system's parameters by name (`120 mm`), as the file or the command line gives them.
    pub parameters: BTreeMap<String, String>,
    /// What is assumed of the finishes of the built-in library: source, kind and wavelengths, a line each.
    pub finishes: Vec<String>,
    /// What is required, and whether it holds.
    pub requirements: Vec<RequirementResult>,
    /// What the run assumes and leaves out, a line each under its heading.
    pub assumptions: Vec<[String; 2]>,
    /// What was learned of importance before the run; null if nothing was.
    pub importance: Option<GuidanceResult>,
    /// Cells along each side of the grid on which a path's peak is given.
    pub path_grid: usize,
    /// For every detector, what each filter means.
    pub filters: Vec<FilterResult>,
    #[serde(skip)]
    pub paths: Vec<PathResult>,
    #[serde(skip)]
    pub maps: Vec<MapResult>,
    /// What the system looks like, if pictures of it are wanted.
    #[serde(skip)]
    pub drawing: Option<Drawing>,
}

/// How the run went: differs from machine to machine.
#[derive(Clone, Debug, Serialize)]
pub struct RunInfo {
    pub version: String,
    pub threads: usize,
    pub seconds: f64,
    pub rays_per_s: f64,
    pub segments: u64,
    pub segments_per_s: f64,
    pub host: String,
    /// True if a signal or a limit ended it early; the finished prefix is in the results.
    pub interrupted: bool,
    /// The command line to repeat it.
    pub command: String,
}
