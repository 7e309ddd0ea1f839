//! Plates: all internal orders, ghosts one by one, absorption, thin gaps.

use crate::support::case::number;
use crate::support::shapes::*;
use crate::support::trial::{bin, scaled};
use crate::support::{Model, Trial};
use glam::DVec3;
use straylight::tally::results::Results;

cases! { fre_03 fre_09 gho_01 vol_05 vol_05x rob_04 }

/// Every branch is followed until roulette at 1e-12: no chance in the result beyond 1e-11.
const ALL: u32 = 64;

/// Light that goes on (0) and that comes back (1): the two halves of the sky about +z.
const SKY: &str = "detectors: {\"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (1, 2))},";

/// Polarisations by name, counted from y: y is perpendicular to the plane of incidence.
const POLARIZATIONS: [(&str, &str); 3] =
    [("s", "Linear(angle: \"0 deg\")"), ("p", "Linear(angle: \"90 deg\")"), ("unpol", "Unpolarized")];

/// A beam of 1 W and 0.01 mm radius in the xz plane that meets the origin at an angle to +z.
fn beam(theta: f64, polarization: &str, line: &str) -> String {
    let (sin, cos) = theta.to_radians().sin_cos();
    format!(
        "sources: {{\"beam\": (flux: \"1 W\", extent: Disk(radius: \"0.01 mm\"), at: \"({}, 0, {}) mm\",
            x: \"(0, 1, 0)\", angular: Collimated(direction: \"({sin}, 0, {cos})\"), spectrum: Line(\"{line}\"),
            polarization: {polarization})}},",
        -50.0 * sin,
        -50.0 * cos
    )
}

fn plates(medium: &str) -> String {
    format!("media: {{\"glass\": {medium}}}, surfaces: [(on: Node(\"plate*\"), medium: \"glass\", specular: Fresnel)],")
}

fn tracing(splits: u32) -> String {
    format!("run: (splits: {splits}, paths: 0),")
}

/// From z to z + thickness, so wide that no order leaves by the side.
fn plate(z: f64, thickness: f64) -> crate::support::model::Mesh {
    let wide = 1e4;
    cuboid(DVec3::new(-wide, -wide, z), DVec3::new(wide, wide, z + thickness))
}

fn fre_03(trial: &mut Trial) {
    let (index, thickness) = (trial.case.given("/n"), 1.0);
    let model = Model::new().add("plate", plate(0.0, thickness));
    for value in trial.case.values() {
        let [theta, depth] = ["theta_deg", "alpha_d"].map(|name| number(&value, name));
        let glass = plates(&format!("Constant(n: {index}, absorption: \"{} /mm\")", depth / thickness));
        for (name, polarization) in POLARIZATIONS {
            let field = |what: &str| match name {
                "unpol" => number(&value, &format!("{what}_unpol")),
                other => number(&value, &format!("{what}{other}")),
            };
            // A short wavelength: k = alpha lambda / 4 pi does not touch Fresnel's equations.
            let text = |splits| format!("{glass} {} {SKY} {}", beam(theta, polarization, "1 nm"), tracing(splits));
            let label = |what: &str| format!("{what}{name} {theta} deg {depth}");
            let all = trial.run_exactly(&text(ALL), &model);
            trial.exact(label("T"), bin(&all, "sky", 0).mean, field("T"), 1e-8);
            trial.exact(label("R"), bin(&all, "sky", 1).mean, field("R"), 1e-8);
            let absorbed = 1.0 - field("T") - field("R");
            trial.exact(label("A"), all.ledger_w.absorbed.mean, absorbed, 1e-8);
            let drawn = trial.run(&text(0), &model, 20_000);
            trial.check(label("T drawn "), bin(&drawn, "sky", 0), field("T"), rare(&drawn));
            trial.check_too(label("R drawn "), bin(&drawn, "sky", 1), field("R"), rare(&drawn));
        }
    }
}

/// Where an outcome is so rare that it may never be drawn its error bar is too: twelve rays.
fn rare(results: &Results) -> f64 {
    12.0 / results.rays as f64
}

fn fre_09(trial: &mut Trial) {
    let [index, theta] = ["/n", "/theta_deg"].map(|p| trial.case.given(p));
    assert_eq!(trial.case.setup("/spacing"), "parallel air gaps 0.1 mm, plates 1 mm, beam diameter << width");
    for value in trial.case.values() {
        let count = number(&value, "plates") as usize;
        let model =
            (0..count).fold(Model::new(), |model, i| model.add(&format!("plate_{i}"), plate(1.1 * i as f64, 1.0)));
        let glass = plates(&format!("Constant(n: {index})"));
        let mut found = Vec::new();
        for (name, polarization) in POLARIZATIONS {
            let text = |splits| format!("{glass} {} {SKY} {}", beam(theta, polarization, "550 nm"), tracing(splits));
            let reference =
                number(&value, if name == "unpol" { "T_unpol" } else { ["Ts", "Tp"][(name == "p") as usize] });
            let drawn = trial.run(&text(0), &model, 40_000);
            let passed = bin(&drawn, "sky", 0);
            trial.check(format!("T{name} {count} plates"), passed, reference, rare(&drawn));
            found.push(passed);
            if count == 1 {
                let all = trial.run_exactly(&text(ALL), &model);
                trial.exact(format!("T{name} one plate, all orders"), bin(&all, "sky", 0).mean, reference, 1e-9);
            }
        }
        let (s, p) = (found[0], found[1]);
        let polarised = scaled(s, -2.0 * p.mean / (s.mean + p.mean).powi(2));
        let degree = straylight::tally::results::Estimate { mean: (p.mean - s.mean) / (p.mean + s.mean), ..polarised };
        trial.check_too(format!("DoP {count} plates"), degree, number(&value, "DoP_transmitted"), 0.0);
    }
}

/// A screen across the transmitted beam, 60 mm wide with pixels of 0.002 mm; what comes back in one bin.
fn ghost_system(trial: &Trial, theta: f64, run: &str) -> String {
    let (sin, cos) = theta.to_radians().sin_cos();
    let screen = format!(
        "Rectangle(at: \"({}, 0, {}) mm\", normal: \"({}, 0, {})\", x: \"({cos}, 0, {})\", width: \"60 mm\",
            height: \"4 mm\")",
        100.0 * sin,
        100.0 * cos,
        -sin,
        -cos,
        -sin
    );
    format!(
        "{} {} run: ({run}),
        detectors: {{\"screen\": (on: {screen}, quantity: Irradiance, pixels: (30000, 1), side: Front),
            \"back\": (on: FarField(axis: \"(0, 0, -1)\"), quantity: Intensity, bins: Projected, pixels: (1, 1))}},",
        plates(&format!("Constant(n: {})", trial.case.given("/n"))),
        beam(theta, "Unpolarized", "550 nm"),
    )
}

fn gho_01(trial: &mut Trial) {
    let model = Model::new().add("plate", plate(0.0, trial.case.given("/thickness")));
    for theta in trial.case.list("/angles_deg") {
        let all = trial.run_exactly(&ghost_system(trial, theta, &format!("splits: {ALL}")), &model);
        let drawn = trial.run(&ghost_system(trial, theta, "splits: 0, paths: 0"), &model, 100_000);
        let spots = spots(&all);
        for value in trial.case.values().iter().filter(|v| v["theta_deg"] == theta) {
            let [flux, shift] = ["flux_unpol", "lateral_shift_mm_perp_to_beam"].map(|name| number(value, name));
            let Some(order) = value["order"].as_u64() else {
                let second = all.paths.iter().find(|path| {
                    path.detector == "back" && path.sequence.matches(":T").count() == 2 && path.ghost_order == 1
                });
                let second = second.unwrap_or_else(|| panic!("no second-surface ghost among {:#?}", all.paths));
                trial.exact(format!("{theta} deg second surface"), second.flux_w.mean, flux, 1e-12);
                continue;
            };
            let class = ["signal", "ghost 2", "ghost 4"][order as usize];
            trial.exact(format!("{theta} deg order {order}"), all.detectors["screen"].classes[class].mean, flux, 1e-12);
            if let Some(found) = drawn.detectors["screen"].classes.get(class) {
                trial.check(format!("{theta} deg order {order} drawn"), *found, flux, rare(&drawn));
            }
            if theta > 0.0 {
                // The spot is 0.02 mm wide; its middle is that of the rays drawn.
                let moved = (spots[order as usize] - spots[0]).abs();
                trial.exact(format!("{theta} deg order {order} shift"), moved, shift, 0.004);
            }
        }
    }
}

/// Middles (mm) of the three brightest spots on the screen, brightest first.
fn spots(results: &Results) -> Vec<f64> {
    let map = results.maps.iter().find(|map| map.detector == "screen").expect("a screen");
    let step = map.axes.as_ref().expect("a plane")[0].step * 1e3;
    let mut spots: Vec<[f64; 2]> = Vec::new();
    let mut last = f64::NEG_INFINITY;
    for (pixel, flux) in map.mean.iter().enumerate().filter(|(_, flux)| **flux > 0.0) {
        let x = (pixel as f64 + 0.5) * step;
        if x - last > 0.1 {
            spots.push([0.0; 2]);
        }
        last = x;
        if let Some(spot) = spots.last_mut() {
            (spot[0], spot[1]) = (spot[0] + flux, spot[1] + flux * x);
        }
    }
    spots.sort_by(|a, b| b[0].total_cmp(&a[0]));
    spots.iter().map(|[flux, moment]| moment / flux).collect()
}

/// Fresnel's equations know k: at 1 nm it is far below the tolerance, at 550 nm it is 1e-6.
fn absorbing_plate(trial: &mut Trial) {
    for value in trial.case.values() {
        let [index, alpha, depth, theta] = ["n", "alpha_per_mm", "d_mm", "theta_deg"].map(|name| number(&value, name));
        let model = Model::new().add("plate", plate(0.0, depth));
        let medium = plates(&format!("Constant(n: {index}, absorption: \"{alpha} /mm\")"));
        let relative = trial.case.tolerance("rel");
        let clear = medium.replace("specular: Fresnel", "specular: Ideal(reflectance: 0, transmittance: 1)");
        for (what, system) in [("first_pass_T_unpol", &medium), ("internal_transmittance", &clear)] {
            let text = format!("{system} {} {SKY} {}", beam(theta, "Unpolarized", "1 nm"), tracing(ALL));
            let results = trial.run_exactly(&text, &model);
            let reference = number(&value, what);
            let passed = results.detectors["sky"].classes["signal"].mean;
            trial.exact(format!("{what} {theta} deg"), passed, reference, relative * reference);
        }
        let text = format!("{medium} {} {SKY} {}", beam(theta, "Unpolarized", "550 nm"), tracing(ALL));
        let results = trial.run_exactly(&text, &model);
        let reference = number(&value, "first_pass_T_unpol");
        let passed = results.detectors["sky"].classes["signal"].mean;
        trial.exact(format!("first_pass_T_unpol {theta} deg 550 nm"), passed, reference, 1e-9 * reference);
    }
}

fn vol_05(trial: &mut Trial) {
    absorbing_plate(trial);
}

fn vol_05x(trial: &mut Trial) {
    absorbing_plate(trial);
}

/// Black sheets inside both blocks take what has crossed the gap and what has come back from it.
fn rob_04(trial: &mut Trial) {
    let index = 1.5168;
    assert!(trial.case.setup("/scene").as_str().is_some_and(|scene| scene.contains("n=1.5168")));
    for value in trial.case.values() {
        let [gap, theta] = ["gap_m", "theta_in_glass_deg"].map(|name| number(&value, name));
        let reference = number(&value, "T_slab_gap_unpol");
        let (sin, cos) = f64::to_radians(theta).sin_cos();
        for offset in [0.0, 10.0] {
            let block = |z: [f64; 2]| cuboid(DVec3::new(-500.0, -500.0, z[0]), DVec3::new(500.0, 500.0, z[1]));
            let model = Model::new()
                .add("plate_1", block([-500.0, 0.0]))
                .add_at("plate_2", block([0.0, 500.0]), glam::DQuat::IDENTITY, 1e3 * gap * DVec3::Z)
                .add("returned", moved(rectangle(999.0, 999.0), -400.0 * DVec3::Z))
                .add("passed", moved(rectangle(999.0, 999.0), 400.0 * DVec3::Z));
            let text = |splits| {
                format!(
                    "geometry: [(file: \"parts.gltf\", unit: \"mm\", at: \"({offset}, {offset}, {offset}) m\")],
                    {}
                    default: (specular: Absorb),
                    sources: {{\"beam\": (flux: \"1 W\", extent: Disk(radius: \"1 mm\"),
                        at: \"({offset}, {offset}, {}) m\", angular: Collimated(direction: \"({sin}, 0, {cos})\"),
                        spectrum: Line(\"550 nm\"))}},
                    detectors: {{\"passed\": (on: Node(\"passed\"), quantity: Irradiance)}},
                    {}",
                    plates(&format!("Constant(n: {index})")),
                    offset - 0.1,
                    tracing(splits)
                )
            };
            let name = format!("gap {gap} at {offset} m");
            let all = trial.run_exactly(&text(ALL), &model);
            trial.exact(format!("{name}, all orders"), all.detectors["passed"].flux_w.mean, reference, 1e-10);
            let drawn = trial.run(&text(0), &model, 60_000);
            trial.check(name, drawn.detectors["passed"].flux_w, reference, 0.0);
        }
    }
}
