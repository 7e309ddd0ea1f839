//! Light followed from the detector: the étendue that a detector in glass sends out.

use crate::support::case::number;
use crate::support::shapes::cuboid;
use crate::support::{Model, Trial};
use glam::DVec3;
use straylight::tally::results::Estimate;

cases! { adj_01 }

/// A lamp of `lamp` mm radius 1 mm before a plane of glass, and a detector of `detector` mm radius 1 mm behind it; what is reflected
/// is cut.
fn immersed(index: f64, lamp: f64, detector: f64, trace: &str) -> String {
    format!(
        "media: {{ \"glass\": Constant(n: {index}) }},
        surfaces: [(on: Node(\"glass\"), medium: \"glass\", specular: Fresnel)],
        sources: {{ \"lamp\": (flux: \"1 W\", extent: Disk(radius: \"{lamp} mm\"), at: \"(0, 0, -1) mm\", angular: Lambertian,
            spectrum: Line(\"550 nm\")) }},
        detectors: {{ \"fpa\": (on: Disk(at: \"(0, 0, 1) mm\", normal: \"(0, 0, -1)\", radius: \"{detector} mm\"),
            quantity: Irradiance, side: Front) }},
        run: (trace: {trace}, max_reflections: 0, paths: 0),"
    )
}

fn adj_01(trial: &mut Trial) {
    let [outside, inside] = [0, 1].map(|i| trial.case.list("/media")[i]);
    assert_eq!(
        (outside, trial.case.setup("/geometry").as_str()),
        (1.0, Some("parallel plane interfaces, first pass only (absorb reflected)"))
    );
    let (small, wide) = (1.0, 4000.0);
    let model = Model::new().add("glass", cuboid(DVec3::new(-1e4, -1e4, 0.0), DVec3::new(1e4, 1e4, 100.0)));
    for value in trial.case.values() {
        let reference = |name| number(&value, name);
        let times = |flux: Estimate, factor: f64| Estimate { mean: factor * flux.mean, error: factor * flux.error };
        let rays = 100_000;
        let forward = trial.run(&immersed(inside, small, wide, "Forward"), &model, rays).detectors["fpa"].flux_w;
        trial.check("T forward", forward, reference("diffuse_T_forward"), 1e-6);
        // A lamp of 1 W and area A has the radiance L = 1 / (pi A); the detector sends out the étendue pi n^2 a.
        let backward = trial.run(&immersed(inside, wide, small, "Backward"), &model, rays).detectors["fpa"].flux_w;
        let irradiance = times(backward, (wide / small).powi(2));
        trial.check("E / (pi L) backward", irradiance, reference("diffuse_T_forward"), 1e-6);
        let through = times(irradiance, (outside / inside).powi(2));
        trial.check_too("T backward", through, reference("diffuse_T_backward"), 1e-6);
        assert!((reference("ratio_B_over_F") - (outside / inside).powi(2)).abs() < 1e-12);
    }
}
