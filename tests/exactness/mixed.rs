//! A little of everything: glass that absorbs, a coating that does, mirrors, a metal, scatter of three kinds, two
//! sources, a band, polarised light, detectors of every sort.

use crate::support::Model;
use crate::support::shapes::{Equal, cuboid, facing, flipped, moved, rectangle, sphere};
use glam::DVec3;

pub fn model() -> Model {
    let tilted = facing(rectangle(30.0, 30.0), DVec3::new(0.3, 0.1, -1.0));
    Model::new()
        .add("ball", sphere(5.0, 2, Equal::Corners))
        .add("slab", cuboid(DVec3::new(-10.0, -10.0, 8.0), DVec3::new(10.0, 10.0, 11.0)))
        .add("mirror", moved(tilted, 25.0 * DVec3::Z))
        .add("metal", moved(flipped(rectangle(20.0, 20.0)), DVec3::new(0.0, 0.0, -15.0)))
        .add("wall", moved(facing(rectangle(40.0, 40.0), DVec3::X), -18.0 * DVec3::X))
        .add("chip", moved(facing(rectangle(12.0, 12.0), -DVec3::X), 18.0 * DVec3::X))
}

/// Everything but `run`; `scatter` may be turned off.
pub fn sections(run: &str) -> String {
    format!(
        "media: {{ \"grey\": Constant(n: 1.5, absorption: \"0.02 /mm\"), \"flint\": Tabulated(wavelength: [\"400 nm\", \"700 nm\"], n: [1.65, 1.6]) }},
        scatter: {{
            \"haze\": Sum([ABg(a: 0.002, b: 0.001, g: 2), ABg(a: 0.002, b: 0.001, g: 2, side: Transmit)]),
            \"paint\": Lambertian(reflectance: 0.6), \"polish\": ABg(a: 0.01, b: 0.01, g: 1.5),
        }},
        coatings: {{ \"lossy\": Ideal(reflectance: 0.1, transmittance: 0.85) }},
        surfaces: [
            (on: Node(\"ball\"), medium: \"grey\", specular: Fresnel, scatter: \"haze\"),
            (on: Node(\"slab\"), medium: \"flint\", coating: \"lossy\"),
            (on: Node(\"mirror\"), specular: Mirror(reflectance: 0.9), scatter: \"polish\"),
            (on: Node(\"metal\"), specular: Metal(n: 1.2, k: 6.5)),
            (on: Node(\"wall\"), specular: Absorb, scatter: \"paint\"),
            (on: Node(\"chip\"), specular: Mirror(reflectance: 0.3)),
        ],
        sources: {{
            \"lamp\": (flux: \"2 W\", extent: Disk(radius: \"2 mm\"), at: \"(0, 0, -12) mm\", angular: Lambertian,
                spectrum: Band(from: \"450 nm\", to: \"650 nm\")),
            \"laser\": (flux: \"1 W\", extent: Gaussian(waist: \"1 mm\"), at: \"(12, 3, 20) mm\",
                angular: Collimated(aim_at: \"(1, 0, 0) mm\"), spectrum: Line(\"550 nm\"), polarization: Linear(angle: \"30 deg\")),
        }},
        detectors: {{
            \"chip\": (on: Node(\"chip\"), quantity: Irradiance, pixels: (9, 7)),
            \"ball\": (on: Node(\"ball\"), quantity: Irradiance),
            \"plane\": (on: Disk(at: \"(0, 0, 15) mm\", normal: \"(0, 0, -1)\", radius: \"9 mm\"), quantity: Irradiance, pixels: (8, 8)),
            \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity, pixels: (12, 9)),
        }},
        run: ({run}),"
    )
}
