//! The lay of a surface, from the text to the ray: a sheet that turns slanted light by a quarter of the azimuth.

use crate::lab::{compile_gltf, shot};
use crate::support::Model;
use crate::support::shapes::{facing, rectangle};
use glam::DVec3;
use straylight::error::Error;
use straylight::geometry::Ray;
use straylight::system::compile::Compiled;

/// A square across z, its front towards `normal`, with this lay.
fn sheet(normal: DVec3, lay: &str) -> Result<Compiled, Error> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bsdf/klems/quarter.xml");
    let sections = format!(
        "scatter: {{ \"quarter\": Klems(file: {file:?}) }},
         surfaces: [(on: Node(\"sheet\"), specular: Absorb, scatter: \"quarter\"{lay})],
         sources: {{ \"beam\": (flux: \"1 W\", extent: Point, at: \"(0, 0, 100) mm\", \
                     angular: Collimated(direction: \"(0, 0, -1)\"), spectrum: Line(\"550 nm\")) }},
         detectors: {{ \"sky\": (on: FarField(axis: \"(0, 0, 1)\"), quantity: Intensity) }},"
    );
    compile_gltf(&sections, &Model::new().add("sheet", facing(rectangle(200.0, 200.0), normal)).gltf())
}

/// Azimuths (deg, about the world's z) into which rays that travel along `travel` (z included) leave the sheet.
fn azimuths(compiled: &Compiled, travel: DVec3) -> Vec<f64> {
    let direction = travel.normalize();
    let ray = Ray { origin: -0.01 * direction, direction };
    let trace = shot(compiled, &vec![ray; 400]);
    trace.seen.escaped.iter().map(|(ray, _)| ray.direction.y.atan2(ray.direction.x).to_degrees()).collect()
}

#[test]
fn a_lay_in_the_world_is_met_on_both_faces() {
    // Patches of light and of what it becomes are quarters about the lay, those of the second lay 30 deg on.
    for (lay, from, to) in [("(1, 0, 0)", -135.0, -45.0), ("(0.8660254037844386, 0.5, 3)", -105.0, -15.0)] {
        for (side, normal) in [(1.0, DVec3::Z), (-1.0, DVec3::NEG_Z)] {
            let compiled =
                sheet(normal, &format!(", lay: \"{lay}\"")).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
            for z in [-1.0, 1.0] {
                // Seen from the back, which looks along the normal, a quarter on; the world's z may look the other way.
                let turned: Vec<f64> = azimuths(&compiled, DVec3::new(1.0, 0.0, z)).iter().map(|a| side * a).collect();
                let (from, to) = if side > 0.0 || lay.starts_with("(1") { (from, to) } else { (-165.0, -75.0) };
                let [least, most] = [
                    turned.iter().copied().fold(f64::INFINITY, f64::min),
                    turned.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                ];
                assert!(turned.len() > 100, "{} rays", turned.len());
                assert!(
                    least > from && least < from + 5.0 && most < to && most > to - 5.0,
                    "{least} {most} {lay} {side}"
                );
            }
        }
    }
}

#[test]
fn scatter_that_counts_azimuths_needs_a_lay() {
    let error = sheet(DVec3::Z, "").expect_err("no lay");
    let said: Vec<String> = error.problems().iter().map(ToString::to_string).collect();
    assert!(said.iter().any(|line| line.contains("no lay") && line.contains("quarter")), "{said:?}");
}
