//! Point source transmittance: closed forms, both ways of tracing, the same bits however it is asked for, verdicts, messages.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[macro_use]
mod support;

use glam::DVec3;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::AtomicBool;
use straylight::study::glare::index;
use straylight::study::pst::{Curve, Plan, Point, Round, Verdict, trace};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::Document;
use straylight::tally::results::Estimate;
use support::case::number;
use support::shapes::*;
use support::{Case, Model};

/// Standard errors that a difference may come to.
const SIGMAS: f64 = 4.0;

/// Traces the first sweep with so many rays a direction, on top of what is `kept`; the rounds, and how many were traced now.
fn rounds(compiled: &mut Compiled, most: u64, until: f64, kept: &[Round]) -> (Vec<Round>, usize) {
    let sweep = compiled.sweeps[0].clone();
    let plan = Plan { sweep: &sweep, settings: &compiled.settings, most, until };
    let mut traced = 0;
    let rounds = trace(&mut compiled.scene, &plan, kept, &AtomicBool::new(false), &mut |_| traced += 1);
    (rounds, traced)
}

fn curve_of(compiled: &Compiled, rounds: &[Round]) -> Curve {
    let plan = Plan { sweep: &compiled.sweeps[0], settings: &compiled.settings, most: 0, until: 0.0 };
    Curve::of(&compiled.scene, &plan, rounds)
}

fn curve(compiled: &mut Compiled, most: u64, until: f64) -> Curve {
    let rounds = rounds(compiled, most, until, &[]).0;
    curve_of(compiled, &rounds)
}

fn agrees(what: &str, found: Estimate, wanted: f64, allowed: f64) {
    let off = (found.mean - wanted).abs();
    assert!(found.error > 0.0 || found.mean == wanted, "{what}: {found:?}");
    assert!(off <= SIGMAS * found.error + allowed, "{what}: {found:?} instead of {wanted}");
}

fn at(curve: &Curve, angle: f64, azimuth: f64) -> &Point {
    let found = curve.points.iter().find(|point| point.angle_deg == angle && point.azimuth_deg == azimuth);
    found.unwrap_or_else(|| panic!("no direction {angle} deg, {azimuth} deg"))
}

/// The diffuse tube of STR-02 with a detector in its bottom, and a sweep about its axis.
fn diffuse_tube(angles: &str) -> Compiled {
    const SIDES: usize = 256;
    let case = Case::load("STR-02");
    let [radius, length, rho] = ["radius", "length", "wall_rho"].map(|p| case.given(&format!("/tube/{p}")));
    let detector = 10.0;
    let model = Model::new()
        .add("wall", tube(radius, [0.0, length], SIDES))
        .add("bottom", moved(flipped(annulus(detector, radius, SIDES)), length * DVec3::Z))
        .add("detector", moved(flipped(disk(detector, SIDES)), length * DVec3::Z));
    let text = format!(
        "scatter: {{\"wall\": Lambertian(reflectance: {rho})}},
        surfaces: [(on: Node(\"*\"), specular: Absorb), (on: Node(\"wall\"), scatter: \"wall\")],
        sweeps: {{\"sky\": (irradiance: \"2 W/m2\", extent: Polygon(radius: \"{} mm\", sides: {SIDES}),
            axis: \"(0, 0, 1)\", x: \"(1, 0, 0)\", spectrum: Line(\"550 nm\"), {angles})}},
        detectors: {{\"detector\": (on: Node(\"detector\"), quantity: Irradiance)}},",
        equal_area(radius, SIDES)
    );
    support::compiled(&text, &model)
}

#[test]
fn a_diffuse_tube_has_the_pst_of_quadrature_at_every_azimuth() {
    let case = Case::load("STR-02");
    assert!(case.setup("/source").as_str().is_some_and(|text| text.contains("30 deg")));
    let value = &case.values()[0];
    let mut tube = diffuse_tube("angles: List([\"30 deg\"]), azimuths: [\"0 deg\", \"100 deg\"]");
    let curve = curve(&mut tube, 1 << 17, 0.002);
    assert_eq!((curve.points.len(), curve.trusted), (2, true));
    for point in &curve.points {
        let what = format!("azimuth {} deg", point.azimuth_deg);
        agrees(&what, point.groups[3], number(value, "PST_single_detector_mean"), 0.0);
        agrees(&what, point.stray, number(value, "PST_all_orders"), case.sys());
        assert!(point.pst.error < 0.05 * point.pst.mean, "{what}: {:?}", point.pst);
        assert_eq!(point.pst, point.stray, "{what}: nothing came straight");
    }
}

/// STR-04: a rough paraboloid, seen from its focus; the beam covers it whatever the angle.
fn paraboloid(angles: &str, way: &str) -> Compiled {
    let case = Case::load("STR-04");
    let (diameter, f) = (case.given("/mirror/D"), case.given("/mirror/focal_length"));
    let [a, b, g] = ["A", "B", "g"].map(|p| case.given(&format!("/mirror/ABg/{p}")));
    let text = format!(
        "geometry: [], elements: {{
            \"mirror\": (body: Mirror(form: Conic(radius: \"{:?} mm\", conic: -1), diameter: \"{diameter:?} mm\")),
        }},
        scatter: {{ \"rough\": ABg(a: {a:?}, b: {b:?}, g: {g:?}) }},
        surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1), scatter: \"rough\")],
        sweeps: {{ \"star\": (irradiance: \"1 W/m2\", extent: Cover(nodes: [\"mirror\"]), spectrum: Line(\"550 nm\"),
            up: \"(1, 0, 0)\", angles: List([{angles}])) }},
        detectors: {{ \"focus\": (on: Disk(at: \"(0, 0, {:?}) mm\", normal: \"(0, 0, 1)\", radius: \"5 mm\"),
            quantity: Irradiance, side: Front) }},
        run: (trace: {way}),",
        -2.0 * f,
        -f
    );
    support::compiled(&text, &Model::new())
}

#[test]
fn a_rough_mirror_has_the_pst_of_quadrature_forwards_and_backwards() {
    // At 1 deg the irradiance changes over a disc of 5 mm.
    let values: Vec<_> = Case::load("STR-04").values().into_iter().filter(|v| number(v, "theta_deg") > 2.0).collect();
    let angles: Vec<String> = values.iter().map(|value| format!("\"{} deg\"", number(value, "theta_deg"))).collect();
    let curves = ["Forward", "Backward"].map(|way| curve(&mut paraboloid(&angles.join(", "), way), 1 << 17, 0.01));
    for value in &values {
        let (angle, wanted) = (number(value, "theta_deg"), number(value, "PST"));
        let [forward, backward] = curves.each_ref().map(|curve| at(curve, angle, 0.0).groups[3]);
        agrees(&format!("forwards at {angle} deg"), forward, wanted, 0.02 * wanted);
        agrees(&format!("backwards at {angle} deg"), backward, wanted, 0.02 * wanted);
        let error = forward.error.hypot(backward.error);
        assert!((forward.mean - backward.mean).abs() <= SIGMAS * error, "{angle} deg: {forward:?}, {backward:?}");
    }
}

/// A wall to the right of the instrument, which looks along -z: it hides what is at the azimuth of 90 deg.
#[test]
fn what_stands_on_the_right_hides_the_azimuth_of_ninety_degrees() {
    let wall = cuboid(DVec3::new(5.0, -50.0, -50.0), DVec3::new(6.0, 50.0, 50.0));
    let model = Model::new().add("wall", wall).add("sensor", flipped(rectangle(2.0, 2.0)));
    let text = "surfaces: [(on: Node(\"*\"), specular: Absorb)],
        sweeps: {\"sky\": (irradiance: \"3 W/m2\", extent: Cover(nodes: [\"wall\", \"sensor\"]), spectrum: Line(\"550 nm\"),
            angles: Linear(from: \"0 deg\", to: \"45 deg\", count: 2), azimuths: [\"0 deg\", \"90 deg\", \"180 deg\", \"270 deg\"])},
        detectors: {\"sensor\": (on: Node(\"sensor\"), quantity: Irradiance, side: Front)},";
    let curve = curve(&mut support::compiled(text, &model), 1 << 16, 0.05);
    // Nothing between source and sensor: the cosine of the angle.
    for azimuth in [0.0, 180.0, 270.0] {
        agrees("at 45 deg", at(&curve, 45.0, azimuth).pst, 0.5f64.sqrt(), 0.0);
        agrees("on the axis", at(&curve, 0.0, azimuth).pst, 1.0, 0.0);
        let ratio = at(&curve, 45.0, azimuth).psrr.expect("the sweep holds the axis");
        agrees("over that on the axis", ratio, 0.5f64.sqrt(), 0.0);
        // Where nothing makes an image, what comes straight is meant.
        assert_eq!(at(&curve, 45.0, azimuth).stray.mean, 0.0);
    }
    let hidden = at(&curve, 45.0, 90.0);
    assert_eq!((hidden.pst.mean, hidden.contributing), (0.0, 0));
    assert!(hidden.upper_limit.is_some_and(|upper| upper > 0.0));
}

/// Angles that differ by so much that some are known before others.
fn slow() -> Compiled {
    diffuse_tube("angles: List([\"10 deg\", \"30 deg\", \"60 deg\"])")
}

#[test]
fn going_on_gives_the_same_bits_as_one_go_on_any_number_of_threads() {
    let pool = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let (whole, all) = pool(1).install(|| rounds(&mut slow(), 1 << 15, 0.02, &[]));
    assert!(all >= 3 && whole.len() == all, "{all} rounds");
    let first = &whole[0].seen;
    assert!(whole.iter().any(|round| round.seen.len() < first.len()), "no direction was known before the others");
    let (part, _) = pool(2).install(|| rounds(&mut slow(), 1 << 13, 0.02, &[]));
    assert_eq!(part.len(), 1);
    let (more, traced) = pool(2).install(|| rounds(&mut slow(), 1 << 15, 0.02, &part));
    assert_eq!((&more, traced), (&whole, all - 1), "other bits, or traced twice");
    // Another error asked for: the rounds that trace other directions are traced anew.
    let loose = rounds(&mut slow(), 1 << 15, 0.2, &whole).0;
    assert_eq!(loose, rounds(&mut slow(), 1 << 15, 0.2, &[]).0);
    assert!(loose.len() < whole.len());
}

#[test]
fn a_direction_that_is_known_is_no_longer_traced() {
    let mut tube = slow();
    let rounds = rounds(&mut tube, 1 << 17, 0.05, &[]).0;
    let curve = curve_of(&tube, &rounds);
    for point in &curve.points {
        assert!(point.pst.error <= 0.05 * point.pst.mean && point.contributing >= 100, "{point:?}");
        assert!(point.rays < 1 << 17, "{} rays at {} deg", point.rays, point.angle_deg);
        let sum: f64 = point.groups.iter().map(|part| part.mean).sum();
        assert!((sum / point.pst.mean - 1.0).abs() < 1e-12);
    }
}

/// A sensor of 2 mm under the open sky, beside a black wall, in a file of its own.
const OPEN: &str = r#"System(
    elements: { "plate": (body: Aperture(diameter: "4 mm", outer: "20 mm")) },
    scatter: { "white": Lambertian(reflectance: 0.5) },
    default: (specular: Absorb, scatter: "white"),
    sweeps: {
        "sky": (irradiance: "1 W/m2", extent: Disk(radius: "20 mm"), at: "(0, 0, -30) mm", spectrum: Line("550 nm"),
            angles: List(["0 deg", "10 deg", "20 deg"]), mask: (file: "mask.csv")),
    },
    detectors: {
        "sensor": (on: Rectangle(at: "(0, 0, -10) mm", normal: "(0, 0, 1)", x: "(1, 0, 0)", width: "2 mm", height: "2 mm"),
            quantity: Irradiance, side: Front),
    },
)
"#;

fn folder(system: &str, mask: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("folder");
    fs::write(folder.path().join("system.ron"), system).expect("system");
    fs::write(folder.path().join("mask.csv"), mask).expect("mask");
    folder
}

fn problems(system: &str, mask: &str) -> Vec<String> {
    let folder = folder(system, mask);
    let document = Document::read(&folder.path().join("system.ron"));
    let error = document.and_then(|document| compile(&document).map(drop)).expect_err("refused");
    let place = format!("{}/", folder.path().display());
    error.problems().iter().map(|problem| problem.to_string().replace(&place, "")).collect()
}

/// The plate scatters back to the sensor about a tenth of the light: limits of 1 and of 1e-6 leave no doubt.
#[test]
fn a_requirement_is_met_or_not_and_a_failure_is_an_answer() {
    let run = |mask: &str| {
        let folder = folder(OPEN, mask);
        let mut program = Command::new(env!("CARGO_BIN_EXE_straylight"));
        program.current_dir(folder.path()).args(["pst", "system.ron", "-o", "out", "--rays", "8192", "--threads", "1"]);
        let output = program.output().expect("the program runs");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        (folder, String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (kept, text) = run("angle_deg,limit\n0,1\n20,1\n");
    assert!(text.contains("sky: PASS (mask.csv"), "{text}");
    let (_, text) = run("angle_deg,limit\n0,1\n10,1\n10,1e-6\n20,1e-6\n");
    assert!(text.contains("sky: FAIL (mask.csv"), "{text}");
    let (_, text) = run("angle_deg,limit\n30,1\n40,1\n");
    assert!(text.contains("requires nothing at these angles"), "{text}");
    // Another requirement: the rounds that are kept stand.
    files(kept.path());
}

/// What a command leaves, and what the next one takes up.
fn files(folder: &Path) {
    let read = |name: &str| fs::read_to_string(folder.join("out").join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let (json, page) = (read("pst.json"), read("pst.html"));
    let results = serde_json::from_str::<serde_json::Value>(&json).expect("JSON")["results"].clone();
    assert_eq!(results["curves"][0]["verdict"], "PASS");
    let own = page.replace("http://www.w3.org/2000/svg", "").replace("http-equiv", "");
    assert!(page.contains("<svg") && !own.contains("http"), "the page asks for something");
    assert_eq!(read("pst.csv").lines().count(), 4);
    assert!(read("pst_sky.svg").starts_with("<svg"));
    fs::write(folder.join("mask.csv"), "angle_deg,limit\n0,1e-6\n20,1e-6\n").expect("mask");
    let mut program = Command::new(env!("CARGO_BIN_EXE_straylight"));
    program.current_dir(folder).args(["pst", "system.ron", "-o", "out", "--rays", "8192"]);
    let output = program.output().expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("round"), "traced again: {said}");
    let other = serde_json::from_str::<serde_json::Value>(&read("pst.json")).expect("JSON")["results"].clone();
    assert_eq!(other["curves"][0]["verdict"], "FAIL");
    assert_eq!(other["curves"][0]["points"][1]["pst"], results["curves"][0]["points"][1]["pst"]);
}

#[test]
fn all_that_is_wrong_with_a_sweep_is_said_at_once() {
    let good = "angle_deg,limit\n0,1\n20,1\n";
    let wrong =
        OPEN.replace("\"1 W/m2\"", "\"0 W/m2\"").replace("\"10 deg\", \"20 deg\"", "\"200 deg\", \"20 deg\"").replace(
            "spectrum: Line(\"550 nm\"),\n",
            "spectrum: Line(\"550 nm\"), up: \"(0, 0, 1)\", detector: \"sensr\",\n",
        );
    assert_eq!(
        problems(&wrong, good),
        [
            "system.ron:6:29: sweeps[\"sky\"].irradiance: \"0 W/m2\" is out of range; expected a value above 0",
            "system.ron:6:122: sweeps[\"sky\"].up: `up` is parallel to the boresight; expected another direction",
            "system.ron:6:145: sweeps[\"sky\"].detector: no detector \"sensr\"; did you mean \"sensor\"?",
            "system.ron:7:21: sweeps[\"sky\"].angles: an angle is out of range; expected angles from the boresight, 0 deg to 180 deg",
        ]
    );
    let steep = OPEN.replace("at: \"(0, 0, -30) mm\"", "axis: \"(0, 0, 1)\"").replace("20 deg", "90 deg");
    let said = problems(&steep, good);
    assert!(said.len() == 1 && said[0].contains("at 90 deg the beam does not leave the front"), "{said:?}");
}

#[test]
fn a_mask_is_read_or_refused_with_its_line() {
    let said = problems(OPEN, "angle_deg,limit\n0,1\n20,-1\n");
    assert_eq!(said, ["mask.csv:3:1: a limit of -1; expected a number above 0"]);
    let said = problems(&OPEN.replace("\"mask.csv\"", "\"none.csv\""), "");
    assert!(said.len() == 1 && said[0].contains("sweeps[\"sky\"].mask.file: \"none.csv\" does not exist"), "{said:?}");
}

#[test]
fn verdicts_are_ordered_from_good_to_bad() {
    assert!(Verdict::Pass < Verdict::NotResolved && Verdict::NotResolved < Verdict::Fail);
}

/// A patch of 40 deg in a field of 100 deg, over a sensor that everything reaches: the cosine integrals, pi (sin^2 outer - sin^2 inner).
#[test]
fn without_optics_the_glare_index_is_a_ratio_of_projected_solid_angles() {
    let sections = "geometry: [], elements: { \"base\": (body: Aperture(diameter: \"0 mm\", outer: \"4 mm\")) },
        default: (specular: Absorb),
        sources: { \"lamp\": (flux: \"1 W\", extent: Point, at: \"(0, 0, -1) m\", angular: Isotropic, spectrum: Line(\"550 nm\")) },
        glare: { \"veil\": (extent: Disk(radius: \"30 mm\"), at: \"(0, 0, -10) mm\", field: \"100 deg\", patch: \"40 deg\",
            spectrum: Line(\"550 nm\")) },
        detectors: { \"sensor\": (on: Rectangle(at: \"(0, 0, -5) mm\", normal: \"(0, 0, -1)\", x: \"(1, 0, 0)\", width: \"2 mm\", height: \"2 mm\"),
            quantity: Irradiance, side: Front) },
        run: (rays: 200_000, importance: Off),";
    let mut compiled = support::compiled(sections, &Model::new());
    let glare = compiled.glare[0].clone();
    let stop = AtomicBool::new(false);
    let found = index(&mut compiled.scene, &glare, &compiled.settings, &stop).expect("finished");
    let squared = |degrees: f64| degrees.to_radians().sin().powi(2);
    agrees("the index", found.index, 1.0 - squared(20.0) / squared(50.0), 0.0);
    agrees("by the field", found.field_w_m2, PI * (squared(50.0) - squared(20.0)), 0.0);
    agrees("by the patch", found.patch_w_m2, PI * squared(20.0), 0.0);
    // The sensor sees the field itself: that is said.
    assert_eq!((found.image, found.trusted), (1.0, true));
    assert_eq!(compiled.scene.sources.len(), 1, "the sources of the system are its own again");
}
