//! A whole report of a made-up but plausible run: every file is there, complete and consistent.
//!
//! The files stay under the build folder (`target/tmp/report`) to be looked at.

use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use straylight::report;
use straylight::tally::drawing::{Drawing, DrawnPart, Way};
use straylight::tally::required::Required;
use straylight::tally::results::{
    Axis, Convergence, DetectorResult, Estimate, FilterResult, GuidanceResult, LedgerResult, MapKind, MapResult,
    PathResult, Peak, RequirementResult, Results, RunInfo, Stage, StrayResult,
};

fn estimate(mean: f64, error: f64) -> Estimate {
    Estimate { mean, error }
}

fn named(rows: &[(&str, f64, f64)]) -> BTreeMap<String, Estimate> {
    rows.iter().map(|&(name, mean, error)| (name.into(), estimate(mean, error))).collect()
}

/// Even noise in 0..1 from a bin number: a picture, not a simulation.
fn noise(bin: usize) -> f64 {
    let mixed = (bin as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1u64 << 53) as f64
}

fn map(
    detector: &str,
    kind: MapKind,
    shape: [usize; 2],
    axes: Option<[Axis; 2]>,
    value: impl Fn(usize) -> f64,
) -> MapResult {
    let bins = shape[0] * shape[1];
    let mean: Vec<f64> = (0..bins).map(value).collect();
    let rays: Vec<u64> = mean.iter().map(|mean| (mean * 4e2).ceil() as u64).collect();
    MapResult {
        detector: detector.into(),
        filter: None,
        kind,
        shape,
        axes,
        unit: if matches!(kind, MapKind::Plane | MapKind::Triangles) { "W/m2" } else { "W/sr" },
        error: mean
            .iter()
            .zip(&rays)
            .map(|(mean, &rays)| if rays > 0 { mean / (rays as f64).sqrt() } else { 0.0 })
            .collect(),
        upper: rays.iter().map(|&rays| if rays > 0 { 0.0 } else { 7.5e-3 }).collect(),
        mean,
        rays,
        extent: vec![2.5e-9; bins],
        origin: [-6.4e-3, -6.4e-3, 0.1137],
        column_direction: [1.0, 0.0, 0.0],
        row_direction: [0.0, 1.0, 0.0],
        stray: None,
        side: "front",
    }
}

fn axis(name: &str, unit: &'static str, start: f64, step: f64) -> Axis {
    Axis { name: name.into(), unit, start, step }
}

/// An image spot with a ghost disc, a scatter skirt and the corners in the dark.
fn focal_plane() -> MapResult {
    let axes = [axis("x", "m", -6.4e-3, 50e-6), axis("y", "m", -6.4e-3, 50e-6)];
    map("fpa", MapKind::Plane, [256, 256], Some(axes), |bin| {
        let (x, y) = ((bin % 256) as f64 - 150.0, (bin / 256) as f64 - 170.0);
        let spot = 2.4e3 * (-(x * x + y * y) / 12.0).exp();
        let ghost = if (x + 60.0).hypot(y + 84.0) < 38.0 { 0.55 + 0.25 * noise(bin) } else { 0.0 };
        let faint = if x.hypot(y) < 6.0 + 190.0 * noise(bin) { 40.0 / (40.0 + x * x + y * y) } else { 0.0 };
        spot + ghost + faint * (0.6 + 0.8 * noise(bin + 77))
    })
}

fn far_field() -> MapResult {
    let axes = [axis("azimuth", "rad", 0.0, TAU / 120.0), axis("polar angle", "rad", 0.0, PI / 2.0 / 45.0)];
    map("far field", MapKind::Polar, [45, 120], Some(axes), |bin| {
        let (theta, phi) = ((bin / 120) as f64 / 45.0 * PI / 2.0, (bin % 120) as f64 / 120.0 * TAU);
        0.05 * theta.cos() * (1.0 + 0.6 * (2.0 * phi).cos())
            + 0.6 * (-(theta - 0.5).powi(2) / 0.004).exp() * (0.5 + 0.5 * phi.sin())
    })
}

fn detector(flux: Estimate, unit: &str, classes: &[(&str, f64, f64)]) -> DetectorResult {
    DetectorResult {
        flux_w: flux,
        interval95_w: 1.969 * flux.error,
        rays: 812_345,
        upper_limit_w: None,
        peak_w_m2: Peak { mean: 2.4e3, error: 31.0, pixel: [170, 150] },
        unit: unit.into(),
        classes: named(classes),
        brightest_batch: 0.004,
        variance_of_variance: 0.03,
        largest: None,
        counted: None,
        regions: Default::default(),
        sources: BTreeMap::new(),
        stray: stray(classes),
        convergence: convergence(flux),
        unresolved: 0.124,
    }
}

fn stray(classes: &[(&str, f64, f64)]) -> StrayResult {
    let stray = classes.iter().filter(|class| class.0 != "signal");
    let flux_w = estimate(stray.clone().map(|class| class.1).sum(), stray.clone().map(|class| class.2 / 2.0).sum());
    let signal = classes.iter().find(|class| class.0 == "signal");
    StrayResult {
        flux_w,
        signal_w: signal.map(|class| estimate(class.1, class.2)),
        to_signal: signal.map(|class| estimate(flux_w.mean / class.1, flux_w.error / class.1)),
        rays: 21_208,
        brightest_batch: 0.02,
        upper_limit_w: 2.86e-9,
    }
}

fn convergence(flux: Estimate) -> Convergence {
    let stage = |batches: u64| {
        let worse = (245.0 / batches as f64).sqrt();
        Stage { batches, flux_w: estimate(flux.mean + 0.4 * worse * flux.error, worse * flux.error) }
    };
    let halves_w = [1.0, -1.0].map(|sign| estimate(flux.mean + sign * flux.error, 1.4 * flux.error));
    Convergence { stages: [4, 8, 16, 32, 64, 128, 245].map(stage).to_vec(), halves_w }
}

fn detectors() -> BTreeMap<String, DetectorResult> {
    let fpa = [
        ("signal", 0.893_21, 0.000_62),
        ("ghost 1", 3.1e-7, 2.0e-8),
        ("ghost 2", 1.613e-3, 1.1e-5),
        ("scatter 1", 4.27e-3, 4.0e-5),
        ("scatter 2", 2.62e-4, 9.0e-6),
        ("direct leak", 3.4e-5, 2.8e-6),
    ];
    let total = fpa.iter().map(|class| class.1).sum();
    let dark = DetectorResult { upper_limit_w: Some(2.86e-9), rays: 0, ..detector(estimate(0.0, 0.0), "W/m2", &[]) };
    let far = detector(
        estimate(0.022_668, 0.000_151),
        "W/sr",
        &[("scatter 1", 0.0212, 0.000_13), ("scatter 2", 0.001_468, 0.000_04)],
    );
    BTreeMap::from([
        ("fpa".into(), detector(estimate(total, 0.000_63), "W/m2", &fpa)),
        ("far field".into(), DetectorResult { unresolved: 0.0, ..far }),
        ("guide port".into(), dark),
    ])
}

fn path(sequence: &str, class: &str, rays: u64, flux: Estimate, length: f64) -> PathResult {
    let order = |kind: &str| class.strip_prefix(kind).and_then(|order| order.trim().parse().ok()).unwrap_or(0);
    PathResult {
        detector: "fpa".into(),
        source: "sun".into(),
        sequence: sequence.into(),
        class: class.into(),
        rays,
        flux_w: flux,
        percent: 100.0 * flux.mean / 0.899_391,
        ghost_order: order("ghost"),
        scatter_order: order("scatter"),
        reflectors: Vec::new(),
        last_scatter: if class.starts_with("scatter") { "Barrel".into() } else { String::new() },
        optical_path_m: length,
        peak_w_m2: 3.1e4 * flux.mean,
        cells: (0..256).map(|cell| 3.1e4 * flux.mean * noise(cell)).collect(),
    }
}

fn paths() -> Vec<PathResult> {
    let lens = |n: u32| format!("Lens_{n}.front:T > Lens_{n}.back:T");
    let all = format!("{} > {} > {}", lens(1), lens(2), lens(3));
    let mut rows = vec![
        path(&format!("sun > {all} > Detector"), "signal", 787_221, estimate(0.893_21, 0.000_62), 0.1523),
        path(&format!("sun > {all} > Barrel:S > Detector"), "scatter 1", 21_208, estimate(2.91e-3, 3.1e-5), 0.1618),
        path(
            &format!(
                "sun > {} > {} > Lens_3.front:T > Lens_3.back:R > Lens_3.front:R > Lens_3.back:T > Detector",
                lens(1),
                lens(2)
            ),
            "ghost 2",
            8_112,
            estimate(1.204e-3, 9.0e-6),
            0.1634,
        ),
        path(
            &format!("sun > {} > Spacer_12:S > {} > {} > Detector", lens(1), lens(2), lens(3)),
            "scatter 1",
            9_400,
            estimate(1.36e-3, 2.4e-5),
            0.171,
        ),
        path(
            &format!("sun > {all} > Detector_window:R > Lens_3.back:R > Detector"),
            "ghost 2",
            2_933,
            estimate(4.09e-4, 6.0e-6),
            0.158,
        ),
        path("sun > Baffle_2:S > Barrel:S > Detector", "scatter 2", 402, estimate(2.62e-4, 9.0e-6), 0.144),
        path("sun > Detector", "direct leak", 24, estimate(3.4e-5, 2.8e-6), 0.1537),
    ];
    let rest = 0.899_391_31 - rows.iter().map(|row| row.flux_w.mean).sum::<f64>();
    rows.push(path("other", "other", 311, estimate(rest, 2.0e-8), 0.2));
    rows
}

/// Scatter at the barrel in the lower half of the focal plane, and a little that came on paths too long to be spelled.
fn filtered() -> FilterResult {
    let whole = focal_plane();
    let mean =
        whole.mean.iter().enumerate().map(|(bin, mean)| if bin < 128 * 256 { 0.1 * mean } else { 0.0 }).collect();
    FilterResult {
        filter: "off the barrel".into(),
        expression: "sun > ... > Barrel*:S > ... > fpa".into(),
        detector: "fpa".into(),
        flux_w: estimate(2.91e-3, 3.1e-5),
        percent: 0.3236,
        rays: 21_208,
        upper_limit_w: None,
        open_w: estimate(1.2e-9, 4.0e-10),
        peak_w_m2: Peak { mean: 2.4e2, error: 31.0, pixel: [70, 150] },
        map: MapResult { filter: Some("off the barrel".into()), mean, ..whole },
    }
}

fn results() -> Results {
    Results {
        system: "Cooke triplet f/4 in a black barrel".into(),
        rays: 1_003_520,
        rays_requested: 1_000_000,
        seed: 20_260_412,
        batch_rays: 4096,
        batches: 245,
        detectors: detectors(),
        ledger_w: LedgerResult {
            emitted: estimate(1.0, 0.0),
            absorbed: estimate(0.984_213, 0.000_041),
            escaped: estimate(0.015_778_9, 0.000_041),
            terminated: estimate(8.1e-6, 7.0e-6),
            lost: estimate(1.2e-9, 4.0e-10),
            residual: estimate(-1.2e-9, 6.0e-9),
        },
        absorbed_w: named(&[
            ("Detector", 0.899_391, 0.000_63),
            ("Barrel", 0.061_2, 0.000_21),
            ("Baffle_1", 0.013_4, 0.000_11),
            ("Baffle_2", 0.006_11, 0.000_07),
            ("Lens_2 rim", 0.002_902, 0.000_03),
            ("Spacer_12", 0.000_871, 0.000_02),
            ("medium N-SK16", 0.000_339, 0.000_001),
        ]),
        lost_w: named(&[("open edge of Baffle_2", 1.2e-9, 4.0e-10)]),
        terminated_w: named(&[("roulette", 1.1e-6, 7.0e-6), ("max_scatters", 7.0e-6, 2.0e-7)]),
        trusted: true,
        warnings: vec![
            "Baffle_2 has 4 open edges: light can leak through the seam".into(),
            "scatter \"anodize\": fitted for x = 0.01 .. 0.9, used from 0.002".into(),
        ],
        inputs: BTreeMap::from([
            ("triplet.ron".into(), "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".into()),
            ("triplet.glb".into(), "60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752".into()),
        ]),
        parameters: BTreeMap::from([("hood.length".into(), "120 mm".into())]),
        finishes: vec!["generic black paint: generic, not measured".into()],
        requirements: requirements(),
        assumptions: vec![["Band".into(), "550 nm (vacuum)".into()], ["Left out".into(), "diffraction".into()]],
        filters: vec![filtered()],
        importance: Some(GuidanceResult {
            used: true,
            gain: 12.6,
            patches: 812,
            targets: vec!["fpa".into(), "Lens_2.front".into()],
        }),
        path_grid: 16,
        paths: paths(),
        maps: maps(),
        drawing: Some(drawing()),
    }
}

fn requirements() -> Vec<RequirementResult> {
    let stray = detectors()["fpa"].stray.clone();
    let required = |limit: f64, value: Estimate| Required::of(limit, value, stray.rays, stray.upper_limit_w, 1.65);
    let ratio = stray.to_signal.unwrap();
    let one = |name: &str, quantity: &str, unit: &str, value: Estimate, limit: f64| RequirementResult {
        name: name.into(),
        detector: "fpa".into(),
        quantity: quantity.into(),
        unit: unit.into(),
        value: Some(value),
        confidence: 0.95,
        required: required(limit, value),
    };
    vec![one("veil", "stray / signal", "", ratio, 1e-2), one("floor", "stray flux", "W", stray.flux_w, 1e-3)]
}

/// A square tube and a ray through it.
fn drawing() -> Drawing {
    let corners = [-1.0f32, 1.0].into_iter().flat_map(|z| {
        [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3], [-0.3, 0.3]].map(|[x, y]: [f32; 2]| [0.05 * x, 0.05 * y, 0.05 * z])
    });
    let triangles = (0..4u32).flat_map(|i| {
        let [a, b] = [i, (i + 1) % 4];
        [[a, b, b + 4], [a, b + 4, a + 4]]
    });
    let absorb = [(); 2].map(|()| "Absorb".to_owned());
    let part = DrawnPart { label: "Barrel".into(), triangles: 8, speculars: absorb, ..DrawnPart::default() };
    let path = paths()[1].sequence.clone();
    let way = Way {
        source: "sun".into(),
        class: "scatter 1".into(),
        path: Some(["fpa".into(), path]),
        points: vec![DVec3::new(0.0, 0.0, -0.08), DVec3::new(0.0, 0.015, 0.0), DVec3::new(0.0, 0.0, 0.05)],
        flux: 1e-6,
    };
    Drawing {
        radius: 0.06,
        corners: corners.collect(),
        triangles: triangles.collect(),
        parts: vec![part],
        all_triangles: 8,
        ways: vec![way],
        ..Drawing::default()
    }
}

fn maps() -> Vec<MapResult> {
    let dark = MapResult {
        detector: "guide port".into(),
        rays: vec![0; 64 * 32],
        mean: vec![0.0; 64 * 32],
        error: vec![0.0; 64 * 32],
        upper: vec![7.5e-3; 64 * 32],
        ..map(
            "",
            MapKind::Plane,
            [32, 64],
            Some([axis("x", "m", -2e-3, 62.5e-6), axis("y", "m", -1e-3, 62.5e-6)]),
            |_| 0.0,
        )
    };
    let row =
        map("slit", MapKind::Plane, [1, 101], Some([axis("x", "m", 0.0, 1e-4), axis("y", "m", 0.0, 1e-3)]), |bin| {
            1.0 + noise(bin)
        });
    let mesh = map("dome/inner", MapKind::Triangles, [1, 1280], None, |bin| 5.0 * noise(bin));
    vec![focal_plane(), far_field(), dark, row, mesh]
}

fn run() -> RunInfo {
    RunInfo {
        version: "0.1.0".into(),
        threads: 16,
        seconds: 12.84,
        rays_per_s: 78_155.7,
        segments: 31_204_551,
        segments_per_s: 2_430_260.0,
        host: "bench-7".into(),
        interrupted: false,
        command: "straylight run triplet.ron --rays 1000000 --seed 20260412 -o out/".into(),
    }
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

#[test]
fn a_report_is_complete_and_leaves_nothing_else() {
    let dir = folder("report");
    let _ = std::fs::remove_dir_all(&dir);
    let written = report::write(&dir, &results(), &run()).unwrap();
    let mut found: Vec<PathBuf> = std::fs::read_dir(&dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.sort();
    let mut told = written.clone();
    told.sort();
    assert_eq!(found, told);
    assert_eq!(written.len(), 6 * 4 + 4);
    assert!(dir.join("dome_inner_error.npy").exists() && dir.join("far_field.fits").exists());
    assert!(dir.join("fpa_off_the_barrel.fits").exists());
    assert!(written.last().unwrap().ends_with("summary.json"));
}

#[test]
fn the_same_results_are_the_same_bytes() {
    let [a, b] = ["report-a", "report-b"].map(|name| report::write(&folder(name), &results(), &run()).unwrap());
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap(), "{}", a.display());
    }
}

#[test]
fn the_summary_reads_back_with_results_and_run() {
    let dir = folder("report-summary");
    report::write(&dir, &results(), &run()).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&std::fs::read(dir.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["results"]["detectors"]["fpa"]["classes"]["signal"]["mean"], 0.893_21);
    assert_eq!(summary["results"]["ledger_w"]["emitted"]["mean"], 1.0);
    assert_eq!(summary["results"]["filters"][0]["flux_w"]["mean"], 2.91e-3);
    assert_eq!(summary["run"]["threads"], 16);
}

#[test]
fn the_page_asks_for_nothing_and_names_everything() {
    let dir = folder("report-page");
    let evil = Results { system: "<script>alert(1)</script> & Co".into(), ..results() };
    report::write(&dir, &evil, &run()).unwrap();
    let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;alert(1)&lt;/script&gt; &amp; Co"));
    let outside = ["http://", "https://", "src=", "@import", "url(h", "url(/"];
    assert!(outside.iter().all(|link| !page.contains(link)), "one file, no network");
    for word in [
        "guide port",
        "badge pass",
        "badge fail",
        "one scatter off Barrel",
        "Baffle_2 has 4 open edges",
        "60303ae22b998861",
        "lower left corner",
        "No ray arrived",
        "sun &gt; ... &gt; Barrel*:S &gt; ... &gt; fpa",
        "paths of more than 24 steps",
        "--seed 20260412",
    ] {
        assert!(page.contains(word), "{word}");
    }
}

#[test]
fn the_terminal_hears_the_key_numbers_with_their_errors() {
    let text = report::text(&results(), &run());
    std::fs::write(folder("report.txt"), &text).unwrap();
    for word in [
        "fpa: 0.89939 ± 0.00063 W",
        "guide port: < 2.9e-9 W",
        "far field: 0.02267 ± 0.00015 W",
        "The ledger closes",
        "filter \"off the barrel\": 0.002910 ± 0.000031 W, 0.32 %  (sun > ... > Barrel*:S > ... > fpa)",
        "! (1.20 ± 0.40)e-9 W more may be meant",
        "warning: Baffle_2",
    ] {
        assert!(text.contains(word), "{word} in\n{text}");
    }
}

#[test]
fn a_map_of_the_wrong_size_is_refused_with_its_name() {
    let mut results = results();
    results.maps[0].error.pop();
    let failure = report::write(&folder("report-broken"), &results, &run()).unwrap_err();
    assert!(failure.to_string().contains("fpa.fits") && failure.to_string().contains("65536 bins"), "{failure}");
}

#[test]
fn an_empty_run_is_reported_without_panic() {
    let nothing = Results {
        rays: 0,
        batches: 0,
        detectors: BTreeMap::new(),
        ledger_w: LedgerResult::default(),
        absorbed_w: BTreeMap::new(),
        filters: Vec::new(),
        paths: Vec::new(),
        maps: Vec::new(),
        ..results()
    };
    report::write(&folder("report-empty"), &nothing, &run()).unwrap();
    assert!(report::text(&nothing, &run()).contains("0 source rays"));
}
