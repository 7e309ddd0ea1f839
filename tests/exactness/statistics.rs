//! What the error bars are worth: how often the 95 % interval holds the truth, and how errors shrink.

use crate::lab::*;
use crate::support::case::number;
use crate::support::shapes::{cuboid, moved, rectangle};
use crate::support::{Case, Model};
use glam::DVec3;
use straylight::math::statistics::student95;
use straylight::system::compile::Compiled;
use straylight::tally::results::{Estimate, Results};

/// A pixel is looked at if so many source rays reach it in the mean.
const FEWEST: f64 = 100.0;

/// Wanted share of intervals that hold the truth, and how far it may be off.
const WANTED: [f64; 2] = [0.95, 0.015];

/// One system run again and again with other random numbers.
struct Replicas {
    name: &'static str,
    /// Totals with their intervals.
    totals: Vec<[f64; 2]>,
    /// Pixel values with their intervals, by replica.
    pixels: Vec<Vec<[f64; 2]>>,
    /// Mean number of contributing rays of each pixel.
    rays: Vec<f64>,
}

impl Replicas {
    fn run(name: &'static str, mut compiled: Compiled, times: u64, total: impl Fn(&Results) -> Estimate) -> Replicas {
        let mut replicas = Replicas { name, totals: Vec::new(), pixels: Vec::new(), rays: Vec::new() };
        for seed in 0..times {
            compiled.settings.seed = 1000 + seed;
            let found = traced(&compiled);
            let student = student95(found.batches);
            let estimate = total(&found);
            replicas.totals.push([estimate.mean, student * estimate.error]);
            let map = &found.maps[0];
            replicas.pixels.push(map.mean.iter().zip(&map.error).map(|(m, e)| [*m, student * e]).collect());
            replicas.rays.resize(map.rays.len(), 0.0);
            replicas.rays.iter_mut().zip(&map.rays).for_each(|(sum, rays)| *sum += *rays as f64 / times as f64);
        }
        replicas
    }

    /// Share of intervals of the total that hold the truth (`None`: the mean of all replicas).
    fn total(&self, truth: Option<f64>) {
        let truth = truth.unwrap_or_else(|| mean(&self.totals));
        let held = self.totals.iter().filter(|&&interval| holds(interval, truth)).count();
        judge(&format!("{} total", self.name), held, self.totals.len());
    }

    /// The same for all pixels with enough rays together, each about its mean of all replicas.
    fn pixels(&self, fewest: usize) {
        let fed: Vec<usize> = (0..self.rays.len()).filter(|&i| self.rays[i] >= FEWEST).collect();
        assert!(fed.len() >= fewest, "{}: only {} pixels have enough rays", self.name, fed.len());
        let mut held = 0;
        for &pixel in &fed {
            let intervals: Vec<[f64; 2]> = self.pixels.iter().map(|map| map[pixel]).collect();
            let truth = mean(&intervals);
            held += intervals.iter().filter(|&&interval| holds(interval, truth)).count();
        }
        judge(&format!("{} {} pixels", self.name, fed.len()), held, fed.len() * self.pixels.len());
    }
}

fn mean(intervals: &[[f64; 2]]) -> f64 {
    intervals.iter().map(|interval| interval[0]).sum::<f64>() / intervals.len() as f64
}

fn holds([value, half]: [f64; 2], truth: f64) -> bool {
    // A pixel that a pencil fills has no spread at all: rounding is then all there is.
    (value - truth).abs() <= half + 1e-12 * truth
}

fn judge(what: &str, held: usize, of: usize) {
    let share = held as f64 / of as f64;
    let [wanted, tolerance] = WANTED;
    // With few replicas chance alone moves the share: four sigma of a binomial.
    let tolerance = tolerance.max(4.0 * (wanted * (1.0 - wanted) / of as f64).sqrt());
    println!("STA-01 {what}: {:.2} % of {of} intervals hold the truth", 100.0 * share);
    assert!((share - wanted).abs() <= tolerance, "{what}: {share} of {of}, wanted {wanted} +- {tolerance}");
}

/// RAD-09, first item, 1 = 100 mm, with a map on the receiving disc.
fn disks() -> (Compiled, f64) {
    let value = &Case::load("RAD-09").values()[0];
    let length = |key: &str| 100.0 * number(value, key);
    let sections = format!(
        "sources: {{ \"disk\": (flux: \"1 W\", extent: Disk(radius: \"{:?} mm\"), angular: Lambertian, spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"disk\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, -1)\", radius: \"{:?} mm\"),
            quantity: Irradiance, pixels: (3, 3)) }},
        run: (rays: 10000, paths: 0),",
        length("r1"),
        length("a"),
        length("r2")
    );
    // Nothing stands in the way; a system has geometry all the same.
    let far = Model::new().add("far", moved(rectangle(1.0, 1.0), -1e3 * DVec3::Z));
    (
        system(&format!("surfaces: [(on: Node(\"far\"), specular: Absorb)], {sections}"), &far.gltf()),
        number(value, "F12"),
    )
}

/// STR-06 within ten degrees: a scattering mirror, both branches followed, every ray with its scattered child.
fn cone() -> (Compiled, f64) {
    let case = Case::load("STR-06");
    let value = case.values().into_iter().find(|v| number(v, "t_deg") == 10.0).expect("10 degrees");
    let sections = format!(
        "surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1), scatter: \"polish\")],
        scatter: {{ \"polish\": ABg(a: {:?}, b: {:?}, g: {:?}) }},
        detectors: {{ \"cone\": (on: Disk(at: \"(0, 0, 50) mm\", normal: \"(0, 0, -1)\", radius: \"{:?} mm\"),
            quantity: Irradiance, pixels: (6, 6)) }},
        {} run: (rays: 10000, splits: 2, scatter_splits: 1, paths: 0),",
        case.given("/A"),
        case.given("/B"),
        case.given("/g"),
        50.0 * 10f64.to_radians().tan(),
        pencil_from(10.0 * DVec3::Z, -DVec3::Z, "Unpolarized", "550 nm")
    );
    (system(&sections, &Model::new().add("mirror", rectangle(20.0, 20.0)).gltf()), number(&value, "flux"))
}

/// A hazy plate before a screen that reflects: trees of correlated children, ghosts and scatter of several orders.
fn hazy(rays: u64) -> Compiled {
    let sections = "media: { \"glass\": Constant(n: 1.5) },
        scatter: { \"haze\": Sum([Lambertian(reflectance: 0.15, transmittance: 0.15), ABg(a: 0.01, b: 0.01, g: 2, side: Transmit)]) },
        surfaces: [(on: Node(\"plate\"), medium: \"glass\", specular: Fresnel, scatter: \"haze\"), (on: Node(\"screen\"), specular: Mirror(reflectance: 0.4))],
        sources: { \"lamp\": (flux: \"1 W\", extent: Disk(radius: \"4 mm\"), at: \"(0, 0, -20) mm\", angular: Cone(half_angle: \"15 deg\"), spectrum: Line(\"550 nm\")) },
        detectors: { \"screen\": (on: Node(\"screen\"), quantity: Irradiance, pixels: (3, 3), side: Front) },
        run: (splits: 2, scatter_splits: 1, roulette: (below: 1e-2, survive: 0.5), paths: 0),";
    let plate = |z: f64| cuboid(DVec3::new(-15.0, -15.0, z), DVec3::new(15.0, 15.0, z + 2.0));
    let screen = crate::support::shapes::flipped(moved(rectangle(30.0, 30.0), 10.0 * DVec3::Z));
    let model = Model::new().add("plate", plate(2.0)).add("screen", screen);
    let mut compiled = system(sections, &model.gltf());
    compiled.settings.rays = rays;
    compiled
}

/// `rays` per replica of the expensive system; the others have those of the case.
fn coverage(times: u64, rays: u64) {
    let (disks, truth) = disks();
    let replicas = Replicas::run("RAD-09", disks, times, |r| r.detectors["disk"].flux_w);
    replicas.total(Some(truth));
    replicas.pixels(3);
    let (cone, truth) = cone();
    let replicas = Replicas::run("STR-06", cone, times, |r| r.detectors["cone"].classes["scatter 1"]);
    replicas.total(Some(truth));
    replicas.pixels(10);
    let replicas = Replicas::run("hazy plate", hazy(rays), times, |r| r.detectors["screen"].flux_w);
    replicas.total(None);
    replicas.pixels(9);
}

#[test]
fn sta_01_intervals_of_95_percent_hold_the_truth_so_often() {
    coverage(300, 1024);
}

#[test]
#[ignore = "2000 replicas: cargo test --release --test exactness -- --ignored"]
fn sta_01_intervals_of_95_percent_hold_the_truth_so_often_in_full() {
    coverage(2000, 4096);
}

/// RAD-01 in independent batches of 32 rays, so that the low-discrepancy points of a batch gain the same at every N.
fn on_axis() -> (Compiled, f64) {
    let case = Case::load("RAD-01");
    let sections = format!(
        "sources: {{ \"disk\": (flux: \"1 W\", extent: Disk(radius: \"{:?} mm\"), angular: Lambertian, spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"spot\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, -1)\", radius: \"{:?} mm\"), quantity: Irradiance) }},
        surfaces: [(on: Node(\"far\"), specular: Absorb)],
        run: (rays: 1000, batch: 32, paths: 0),",
        case.given("/source/radius"),
        case.given("/detector/center/2"),
        case.given("/detector/radius")
    );
    let far = Model::new().add("far", moved(rectangle(1.0, 1.0), -1e3 * DVec3::Z));
    (system(&sections, &far.gltf()), case.named("flux_fraction"))
}

/// Slope of log r.m.s. error against log N over `(rays, seeds)`, and the mean error in its own standard errors.
fn convergence(plan: &[(u64, u64)]) {
    let case = Case::load("STA-04");
    let value = &case.values()[0];
    let (mut compiled, truth) = on_axis();
    let (mut weights, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (k, &(rays, seeds)) in plan.iter().enumerate() {
        compiled.settings.rays = rays;
        let errors = (0..seeds).map(|seed| {
            compiled.settings.seed = 1 + 1_000_000 * k as u64 + seed;
            traced(&compiled).detectors["spot"].flux_w.mean - truth
        });
        let errors: Vec<f64> = errors.collect();
        let bias = errors.iter().sum::<f64>() / seeds as f64;
        let square = errors.iter().map(|e| e * e).sum::<f64>() / seeds as f64;
        let z = bias / (square / seeds as f64).sqrt();
        println!("STA-04 N = {rays}: r.m.s. error {:.3e}, mean error {z:+.2} sigma", square.sqrt());
        assert!(z.abs() <= number(value, "mean_z_max"), "N = {rays}: mean error {z} sigma");
        // log10 of an r.m.s. value from n seeds is known to 0.434 / sqrt(2 n), and better the fewer the seeds matter.
        let weight = 2.0 * seeds as f64 / 0.434f64.powi(2);
        let (log_n, log_error) = ((rays as f64).log10(), square.sqrt().log10());
        (weights, x, y) = (weights + weight, x + weight * log_n, y + weight * log_error);
        (xx, xy) = (xx + weight * log_n * log_n, xy + weight * log_n * log_error);
    }
    let spread = xx - x * x / weights;
    let (slope, error) = ((xy - x * y / weights) / spread, spread.sqrt().recip());
    println!("STA-04 slope {slope:.4} +- {error:.4}");
    let tolerance = number(value, "slope_tol").max(4.0 * error);
    assert!((slope - number(value, "slope")).abs() <= tolerance, "slope {slope} +- {error}");
}

#[test]
fn sta_04_errors_shrink_with_the_root_of_the_number_of_rays() {
    convergence(&[(1024, 1000), (10_240, 300), (102_400, 50)]);
}

#[test]
#[ignore = "3.6e8 rays: cargo test --release --test exactness -- --ignored"]
fn sta_04_errors_shrink_with_the_root_of_the_number_of_rays_in_full() {
    convergence(&[(1024, 4000), (10_240, 1000), (102_400, 300), (1_024_000, 64), (10_240_000, 32)]);
}

/// STA-05: many small hits in one pixel add up to 1 W.
fn accumulate(rays: u64) {
    let case = Case::load("STA-05");
    let value = &case.values()[0];
    let sections = format!(
        "surfaces: [(on: Node(\"*\"), specular: Absorb)],
        detectors: {{ \"pixel\": (on: Node(\"pixel\"), quantity: Irradiance) }},
        {} run: (rays: {rays}, batch: 65536, paths: 0),",
        pencil(DVec3::new(0.1, 0.2, 0.0), -DVec3::Z, "Unpolarized", "550 nm")
    );
    let found = results(&sections, &Model::new().add("pixel", rectangle(1.0, 1.0)));
    let pixel = found.maps[0].mean[0] * found.maps[0].extent[0];
    assert_eq!(found.maps[0].rays[0], found.rays);
    close(pixel, number(value, "value"), case.tolerance("rel"), "STA-05");
}

#[test]
fn sta_05_many_small_hits_add_up() {
    accumulate(2_000_000);
}

#[test]
#[ignore = "10^8 rays: cargo test --release --test exactness -- --ignored"]
fn sta_05_many_small_hits_add_up_in_full() {
    accumulate(100_000_000);
}
