//! Point source transmittance over the directions of a sweep.
//!
//!     PST(theta, phi) = E_detector / E_incident,        PSRR = PST / PST on the axis
//!
//! E_detector is the mean irradiance over the whole detector, W/m2, E_incident the irradiance on a plane across the beam at the entrance,
//! W/m2; theta and phi are those of [`Sweep`](crate::system::document::Sweep). The PST holds all light, the image with it; what is *stray*
//! leaves out the signal (light through the optics as designed; in a system without optics, the direct light). Requirements are
//! about stray light. A sweep with a spectrum weights the PST by it.
//!
//! Source: E. Fest, Stray Light Analysis and Control (SPIE, 2013), sec. 1.4.

mod kept;
mod rounds;
mod sky;

pub use crate::tally::required::{Required, Verdict};
pub use kept::{Kept, fingerprint};
pub use rounds::{Plan, Round, Seen, trace};
pub use sky::Sky;

use crate::packet::Class;
use crate::scene::Scene;
use crate::system::compile::Sweep;
use crate::system::document::degrees;
use crate::tally::results::Estimate;
use serde::Serialize;
use std::collections::BTreeMap;

/// Classes as a curve shows them; direct light is a leak where there are optics.
pub const GROUPS: [&str; 5] = ["signal", "direct", "ghosts", "one scatter", "more scatters"];

/// The transmittance in one direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Point {
    /// From the boresight.
    pub angle_deg: f64,
    /// From up, clockwise as seen along the boresight.
    pub azimuth_deg: f64,
    /// Source rays traced in this direction.
    pub rays: u64,
    /// Of them, those that contributed.
    pub contributing: u64,
    /// All light, dimensionless.
    pub pst: Estimate,
    /// Without the signal, dimensionless; where there is a signal, its error is an upper bound.
    pub stray: Estimate,
    /// PST over that on the axis, if the sweep holds it.
    pub psrr: Option<Estimate>,
    /// If nothing arrived: 3 x the largest part that one source ray can carry / N; else null.
    pub upper_limit: Option<f64>,
    /// Share of the PST that the brightest batch brought: where it is large, the error is a guess.
    pub brightest_batch: f64,
    /// The PST by class: "signal", "direct leak", "ghost 1", "scatter 1", ... All rows add up to it.
    pub classes: BTreeMap<String, Estimate>,
    /// The PST by [`GROUPS`]; errors of sums are upper bounds.
    pub groups: [Estimate; 5],
    /// What is required here, if anything.
    pub required: Option<Required>,
}

/// The transmittance over a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    pub sweep: String,
    /// The detector over which the irradiance is averaged, and its area, m2.
    pub detector: String,
    pub area_m2: f64,
    /// On a plane across the beam, W/m2.
    pub irradiance_w_m2: f64,
    /// Relative standard error at which a direction was no longer traced.
    pub until: f64,
    pub seed: u64,
    pub rounds: u64,
    /// Source rays of all directions.
    pub rays: u64,
    /// Angle by angle, azimuth by azimuth.
    pub points: Vec<Point>,
    /// Stray light of a uniform sky between the first and the last angle; null if there is one angle.
    pub sky: Option<Sky>,
    /// File of what is required.
    pub mask: Option<String>,
    /// Rows of that file: angle, deg, and limit.
    pub mask_points: Vec<[f64; 2]>,
    /// Of the whole sweep; null if nothing is required.
    pub verdict: Option<Verdict>,
    /// Reasons not to trust a number, in words.
    pub warnings: Vec<String>,
    /// False if light was lost or the ledger of a round did not close.
    pub trusted: bool,
}

/// All curves of a system: the same bits for the same files, seed and rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sweeps {
    pub system: String,
    pub curves: Vec<Curve>,
    /// SHA-256 of every file that was read, by name as written.
    pub inputs: BTreeMap<String, String>,
    /// Values of the system's parameters by name.
    pub parameters: BTreeMap<String, String>,
}

/// Student's t, one-sided 95 %, of 63 degrees of freedom: a round has 64 batches at least.
const ONE_SIDED: f64 = 1.669;

/// Share of the PST in one batch above which its error is a guess.
const BRIGHTEST: f64 = 0.25;

impl Curve {
    /// What the rounds of a sweep come to. `scene` holds all sources of the sweep.
    pub fn of(scene: &Scene, plan: &Plan, rounds: &[Round]) -> Curve {
        let Plan { sweep, settings, until, .. } = plan;
        let detector = &scene.detectors[sweep.detector];
        let bins = detector.grid.shape().iter().product();
        let area: f64 = (0..bins).map(|bin| detector.grid.extent(bin)).sum();
        let scale = 1.0 / (area * sweep.irradiance);
        let mut points: Vec<Point> =
            (0..sweep.directions()).map(|direction| point(scene, sweep, rounds, direction, scale)).collect();
        refer_to_axis(&mut points);
        let mut warnings: Vec<String> = rounds.iter().flat_map(|round| round.warnings.clone()).collect();
        let several = sweep.azimuths.len() > 1;
        warnings.extend(points.iter().filter_map(|point| caution(point, several)));
        let verdict = sweep.mask.as_ref().and_then(|_| worst(&points));
        let sky = Sky::of(&cuts(&points));
        Curve {
            sky,
            sweep: sweep.label.clone(),
            detector: detector.label.clone(),
            area_m2: area,
            irradiance_w_m2: sweep.irradiance,
            until: *until,
            seed: settings.seed,
            rounds: rounds.len() as u64,
            rays: points.iter().map(|point| point.rays).sum(),
            mask: sweep.mask.as_ref().map(|mask| mask.file.clone()),
            mask_points: sweep.mask.as_ref().map_or(Vec::new(), |mask| mask.points.clone()),
            points,
            verdict,
            warnings,
            trusted: rounds.iter().all(|round| round.warnings.is_empty()),
        }
    }

    /// The points of each azimuth, in the order of the angles.
    pub fn cuts(&self) -> Vec<&[Point]> {
        cuts(&self.points)
    }
}

/// Of all points that something is required of: the worst verdict; `None` if there are none.
fn worst(points: &[Point]) -> Option<Verdict> {
    points.iter().filter_map(|point| point.required.map(|required| required.verdict)).max()
}

fn cuts(points: &[Point]) -> Vec<&[Point]> {
    points.chunk_by(|a, b| a.azimuth_deg == b.azimuth_deg).collect()
}

fn point(scene: &Scene, sweep: &Sweep, rounds: &[Round], direction: usize, scale: f64) -> Point {
    let [theta, phi] = sweep.direction(direction);
    let seen = Seen::of_all(rounds, direction);
    let scaled = |flux: Estimate| Estimate { mean: scale * flux.mean, error: scale * flux.error };
    let classes: BTreeMap<usize, Estimate> = seen.classes.iter().map(|(class, flux)| (*class, scaled(*flux))).collect();
    let mut groups = [Estimate::default(); 5];
    for (class, part) in &classes {
        let group = &mut groups[group(Class::from_index(*class))];
        *group = Estimate { mean: group.mean + part.mean, error: group.error + part.error };
    }
    let pst = scaled(seen.flux_w);
    // What is meant to arrive: the image, or where nothing makes one, the light that comes straight.
    let image = group(scene.image());
    let signal = groups[image];
    let stray = if signal.mean == 0.0 {
        pst
    } else {
        let rest = groups.iter().enumerate().filter(|(group, _)| *group != image);
        rest.fold(Estimate::default(), |sum, (_, part)| Estimate {
            mean: sum.mean + part.mean,
            error: sum.error + part.error,
        })
    };
    let source = &scene.sources[sweep.first + direction];
    let upper = 3.0 * scale * source.flux / seen.rays.max(1) as f64;
    let angle_deg = degrees(theta);
    let limit = sweep.mask.as_ref().and_then(|mask| mask.limit(angle_deg));
    Point {
        angle_deg,
        azimuth_deg: degrees(phi),
        rays: seen.rays,
        contributing: seen.contributing,
        pst,
        stray,
        psrr: None,
        upper_limit: (seen.contributing == 0).then_some(upper),
        brightest_batch: seen.brightest,
        classes: classes.into_iter().map(|(class, part)| (label(scene, class), part)).collect(),
        groups,
        required: limit.map(|limit| Required::of(limit, stray, seen.resolved(BRIGHTEST), upper, ONE_SIDED)),
    }
}

fn label(scene: &Scene, class: usize) -> String {
    Class::from_index(class).label(scene.has_optics)
}

/// Index into [`GROUPS`].
fn group(class: Class) -> usize {
    match class {
        Class::Signal => 0,
        Class::Direct => 1,
        Class::Ghost(_) => 2,
        Class::Scatter(1) => 3,
        Class::Scatter(_) => 4,
    }
}

/// Every PST over that on the axis, if there is one: the two are independent.
fn refer_to_axis(points: &mut [Point]) {
    let Some(axis) = points.iter().find(|point| point.angle_deg == 0.0 && point.pst.mean > 0.0) else { return };
    let axis = axis.pst;
    for point in points.iter_mut() {
        let ratio = point.pst.mean / axis.mean;
        let independent = point.angle_deg > 0.0;
        let error = (point.pst.error / axis.mean).hypot(ratio * axis.error / axis.mean);
        let itself = Estimate { mean: 1.0, error: 0.0 };
        let known = point.pst.mean > 0.0;
        point.psrr = known.then_some(if independent { Estimate { mean: ratio, error } } else { itself });
    }
}

/// Why the error of a point is a guess, in words.
fn caution(point: &Point, several: bool) -> Option<String> {
    (point.brightest_batch > BRIGHTEST).then(|| {
        let azimuth = if several { format!(", azimuth {} deg", point.azimuth_deg) } else { String::new() };
        format!(
            "at {} deg{azimuth}, one batch brought {:.0} % of the light, the error bar cannot be trusted: more rays are needed",
            point.angle_deg,
            100.0 * point.brightest_batch
        )
    })
}
