//! Ten scenes that plain tracing knows to about 1 %, each in every way to draw.

use crate::support::shapes::{cuboid, disk, facing, flipped, moved, rectangle};
use crate::support::{Model, compiled};
use crate::ways::{Way, agree_within, system};
use glam::DVec3;
use straylight::geometry::Frame;
use straylight::system::compile::Compiled;

/// The baffled tube with the sun at 10 degrees.
fn tube() -> Compiled {
    let mut tube = system("baffled_tube");
    let (sin, cos) = 10f64.to_radians().sin_cos();
    tube.scene.sources[0].angular.axis = Some(Frame::from_z(DVec3::new(sin, 0.0, cos)));
    tube
}

/// Two plates that face each other, one glossy and one white, lit and seen past their edges.
fn plates() -> Compiled {
    let model = Model::new()
        .add("glossy", rectangle(40.0, 40.0))
        .add("white", moved(flipped(rectangle(40.0, 40.0)), DVec3::new(0.0, 0.0, 30.0)));
    let text = r#"scatter: { "gloss": ABg(a: 0.01, b: 0.02, g: 1.8), "white": Lambertian(reflectance: 0.7) },
        surfaces: [(on: Node("glossy"), specular: Mirror(reflectance: 0.6), scatter: "gloss"),
            (on: Node("white"), specular: Absorb, scatter: "white")],
        sources: { "lamp": (flux: "1 W", extent: Disk(radius: "3 mm"), at: "(-40, 0, 25) mm",
            angular: Collimated(aim_at: "(-5, 0, 0) mm"), spectrum: Line("550 nm")) },
        detectors: { "eye": (on: Disk(at: "(30, 10, 20) mm", normal: "(-1, 0, 0)", radius: "8 mm"),
            quantity: Irradiance, pixels: (4, 4), side: Front) },"#;
    compiled(text, &model)
}

/// A dusty mirror that folds a beam past a detector.
fn dust() -> Compiled {
    let model = Model::new()
        .add("mirror", facing(rectangle(40.0, 40.0), DVec3::new(1.0, 0.0, 1.0)))
        .add("wall", moved(facing(rectangle(80.0, 80.0), DVec3::NEG_X), DVec3::new(60.0, 0.0, 0.0)));
    let text = r#"scatter: { "dust": Contamination(level: 800), "grey": Lambertian(reflectance: 0.2) },
        surfaces: [(on: Node("mirror"), specular: Mirror(reflectance: 0.9), scatter: "dust"),
            (on: Node("wall"), specular: Absorb, scatter: "grey")],
        sources: { "beam": (flux: "1 W", extent: Disk(radius: "4 mm"), at: "(0, 0, 50) mm",
            angular: Collimated(direction: "(0, 0, -1)"), spectrum: Line("550 nm")) },
        detectors: { "fpa": (on: Disk(at: "(40, 0, 18) mm", normal: "(-1, 0, 0)", radius: "6 mm"),
            quantity: Irradiance, pixels: (3, 3), side: Front) },"#;
    compiled(text, &model)
}

/// A white box with a window of glass, lit through it.
fn window() -> Compiled {
    let model = Model::new()
        .add("box", flipped(cuboid(DVec3::new(-20.0, -20.0, 0.0), DVec3::new(20.0, 20.0, 50.0))))
        .add("window", cuboid(DVec3::new(-10.0, -10.0, 20.0), DVec3::new(10.0, 10.0, 24.0)))
        .add("fpa", moved(disk(6.0, 32), DVec3::new(12.0, 12.0, 0.5)));
    let text = r#"media: { "glass": Constant(n: 1.6, absorption: "0.01 /mm") },
        scatter: { "white": Lambertian(reflectance: 0.5) },
        surfaces: [(on: Node("box"), specular: Absorb, scatter: "white"), (on: Node("window"), medium: "glass", specular: Fresnel),
            (on: Node("fpa"), specular: Absorb)],
        sources: { "lamp": (flux: "1 W", extent: Disk(radius: "4 mm"), at: "(0, 0, 40) mm",
            angular: Cone(half_angle: "40 deg"), spectrum: Line("550 nm")) },
        detectors: { "fpa": (on: Node("fpa"), quantity: Irradiance, pixels: (4, 4), side: Front) },"#;
    compiled(text, &model)
}

/// Light polarised at `angle` (deg) in the source, a quarter-wave plate, a metal, glass and a polariser.
pub fn polarised(angle: f64) -> Compiled {
    let upright = |x: f64| moved(facing(rectangle(60.0, 60.0), DVec3::X), DVec3::new(x, 0.0, 20.0));
    let model = Model::new()
        .add("plate", moved(rectangle(60.0, 60.0), DVec3::new(0.0, 0.0, 5.0)))
        .add("mirror", moved(facing(rectangle(60.0, 80.0), DVec3::new(1.0, 0.0, -1.0)), DVec3::new(0.0, 0.0, 20.0)))
        .add("window", cuboid(DVec3::new(40.0, -40.0, -20.0), DVec3::new(43.0, 40.0, 60.0)))
        .add("polarizer", upright(48.0));
    let text = format!(
        r#"media: {{ "glass": Constant(n: 1.8) }},
            coatings: {{ "quarter": Retarder(axis: "(1, 0.3, 0)", retardance: "90 deg"),
                "metal": Metal(n: 0.3, k: 1.5), "sheet": Polarizer(axis: "(0, 1, 0.6)") }},
            surfaces: [(on: Node("plate"), coating: "quarter"), (on: Node("mirror"), coating: "metal"),
                (on: Node("window"), medium: "glass", specular: Fresnel), (on: Node("polarizer"), coating: "sheet")],
            sources: {{ "lamp": (flux: "1 W", extent: Disk(radius: "6 mm"), at: "(0, 0, 0) mm",
                angular: Cone(half_angle: "15 deg"), spectrum: Line("550 nm"), polarization: Linear(angle: "{angle} deg")) }},
            detectors: {{ "fpa": (on: Disk(at: "(50, 0, 20) mm", normal: "(-1, 0, 0)", radius: "6 mm"),
                quantity: Irradiance, pixels: (4, 4), side: Front) }},"#
    );
    compiled(&text, &model)
}

const TARGET: Way = Way::Aimed([0.0, 0.0, 0.06], [0.0125, 0.0125, 0.0]);
const WRONG: Way = Way::Aimed([0.0, 0.3, 0.0], [0.02; 3]);

/// Name, how it is made, rays, and in which ways it is traced.
type Scene<'a> = (&'a str, fn() -> Compiled, u64, &'a [Way]);

/// Plain against aimed, aimed at the wrong place, learned, backwards and both, over all detectors, classes and pixels, at the 1 %
/// level for all of them together.
#[test]
#[ignore = "ten scenes in five ways, a quarter of an hour: cargo test --release --test importance -- --ignored ten_scenes"]
fn ten_scenes_in_five_ways() {
    let both = [Way::Learned, WRONG, TARGET, Way::Backward, Way::LearnedBackward];
    // From the detector, what is glossy at grazing angles has contributions too rare for errors of pixels.
    let forward = [Way::Learned, WRONG, TARGET];
    let scenes: [Scene; 10] = [
        ("sphere", || system("integrating_sphere"), 200_000, &both),
        ("tube at 10 deg", tube, 1_000_000, &both),
        ("triplet", || system("triplet"), 300_000, &forward),
        ("fast lens", || system("fast_lens"), 300_000, &forward),
        ("Questar", || system("questar"), 300_000, &both),
        ("double Gauss", || system("double_gauss"), 200_000, &forward),
        ("plates", plates, 300_000, &both),
        ("dust", dust, 300_000, &both),
        ("window", window, 300_000, &both),
        ("polarised", || polarised(20.0), 300_000, &both),
    ];
    let count: usize = scenes.iter().map(|(.., ways)| ways.len()).sum();
    for (name, make, rays, ways) in scenes {
        agree_within(0.01 / count as f64, name, make, rays, ways);
    }
}
