//! Forms that meshes were made from, found again: generated faces, the lenses of the shipped triplet, and what the program prints.

#[allow(dead_code, reason = "one model, several test targets")]
#[path = "support/model.rs"]
mod model;

use glam::{DQuat, DVec2, DVec3};
use model::{Mesh, Model};
use std::f64::consts::TAU;
use std::path::Path;
use std::process::{Command, Output};
use straylight::geometry::exact::{Conic, Sag, Shape};
use straylight::geometry::fit::Kind;
use straylight::system::compile::{compile, parts_of_file};
use straylight::system::document::Document;
use straylight::system::fit::{Face, Wish, faces};
use straylight::system::select::{Predicate, Selector, select};
use straylight::system::units::{FromText, LengthUnit};
use tempfile::TempDir;

/// Faces of 20 degrees; what the file's rounding explains.
const WISH: Wish = Wish { smooth: 20.0 / 180.0 * std::f64::consts::PI, powers: Vec::new(), tolerance: None };

/// A height of revolution, mm, between two distances from the axis; looks to -z.
fn revolved(height: &dyn Fn(f64) -> f64, r: [f64; 2], rings: usize, sectors: usize) -> Mesh {
    let at = |ring: usize, sector: usize| {
        let r = r[0] + (r[1] - r[0]) * ring as f64 / rings as f64;
        (r * DVec2::from_angle(TAU * (sector % sectors) as f64 / sectors as f64)).extend(height(r))
    };
    grid(&at, rings, sectors)
}

/// Two triangles for each cell, without those that have no area.
fn grid(at: &dyn Fn(usize, usize) -> DVec3, rows: usize, columns: usize) -> Mesh {
    let cells = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let quads = cells.map(|(i, j)| [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
    let halves = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.filter(|[a, b, c]| (*b - *a).cross(*c - *a).length() > 1e-12).collect()
}

/// Standard conic, mm.
fn conic(radius: f64, k: f64) -> impl Fn(f64) -> f64 {
    move |r| Conic { curvature: 1.0 / radius, conic: k }.sag(r)
}

/// Corners moved by up to `most` (mm) in each coordinate; equal corners equally.
fn shaken(mesh: Mesh, most: f64) -> Mesh {
    let hash = |v: DVec3, salt: u64| {
        let bits = v
            .to_array()
            .iter()
            .fold(salt, |h, x| (h ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29));
        ((bits ^ (bits >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    let moved = |v: DVec3| v + most * DVec3::new(hash(v, 1), hash(v, 2), hash(v, 3));
    mesh.into_iter().map(|t| t.map(moved)).collect()
}

/// The faces of one node in mm.
fn found(mesh: Mesh, rotation: DQuat, at: DVec3, wish: &Wish) -> Vec<Face> {
    found_in(&Model::new().add_at("part", mesh, rotation, at), wish)
}

fn found_in(model: &Model, wish: &Wish) -> Vec<Face> {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("parts.gltf");
    std::fs::write(&path, model.gltf()).expect("written");
    let (nodes, _) = parts_of_file(&path, LengthUnit::from_text("mm").expect("a unit")).expect("a model");
    nodes.iter().flat_map(|node| faces(node, wish)).collect()
}

fn only(faces: Vec<Face>) -> Face {
    assert_eq!(faces.len(), 1, "{faces:#?}");
    faces.into_iter().next().expect("a face")
}

#[track_caller]
fn close(found: f64, wanted: f64, allowed: f64) {
    assert!(
        (found - wanted).abs() <= allowed,
        "{found:e}, wanted {wanted:e}, off by {:e} of {allowed:e}",
        found - wanted
    );
}

/// Places in which the same face must be the same.
fn places() -> [(DQuat, DVec3); 3] {
    let turned = |axis: DVec3, angle: f64| DQuat::from_axis_angle(axis.normalize(), angle);
    [
        (DQuat::IDENTITY, DVec3::ZERO),
        (turned(DVec3::new(1.0, 2.0, -0.5), 0.7), DVec3::new(30.0, -20.0, 110.0)),
        (turned(DVec3::new(-1.0, 0.3, 0.2), 1.2), DVec3::new(0.0, 4.0, -7.0)),
    ]
}

/// Checks kind, vertex and axis (mm) and gives R in mm, positive if the centre lies towards the +z of the mesh.
#[track_caller]
fn placed(face: &Face, kind: Kind, (rotation, at): (DQuat, DVec3), slack: f64) -> f64 {
    let fit = &face.outcome.fit;
    assert!(face.outcome.found && fit.kind == kind, "{:#?}", face.outcome);
    let axis = rotation * DVec3::Z;
    let side = fit.axis.dot(axis).signum();
    assert!(fit.axis.distance(side * axis) * 10.0 <= slack, "{:?} {axis:?}", fit.axis);
    assert!((1e3 * fit.at).distance(at) <= slack, "{:?} {at:?}", 1e3 * fit.at);
    1e3 * side * fit.radius()
}

/// Corners are rounded to 2^-24 of at most 130 mm: 8e-6 mm. A radius follows from the sag s, dR = R ds / s.
#[test]
fn spheres_have_their_radius_and_the_axis_of_their_rim() {
    for (radius, half) in [(20.0, 8.0), (-352.5, 8.1), (-12.0, 11.0), (1000.0, 12.0)] {
        for (rings, sectors) in [(4, 16), (30, 120)] {
            for place in places() {
                let face =
                    only(found(revolved(&conic(radius, 0.0), [0.0, half], rings, sectors), place.0, place.1, &WISH));
                let sag = conic(radius, 0.0)(half).abs();
                close(placed(&face, Kind::Sphere, place, 1e-3), radius, 8e-6 * radius.abs() / sag);
                close(face.semi_diameter().expect("a round rim"), 1e-3 * half, 1e-8);
                assert!(
                    face.outcome.simpler.as_ref().is_some_and(|plane| plane.kind == Kind::Plane && plane.max > 1e-6)
                );
            }
        }
    }
}

#[test]
fn conics_have_their_radius_and_constant() {
    for (radius, k) in [(50.0, -1.0), (-40.0, -2.3), (30.0, 0.6), (-60.0, -0.5), (20.0, -8.0)] {
        for (rings, sectors) in [(6, 16), (25, 90)] {
            for place in places() {
                let face =
                    only(found(revolved(&conic(radius, k), [0.0, 15.0], rings, sectors), place.0, place.1, &WISH));
                close(placed(&face, Kind::Conic, place, 1e-3), radius, 2e-3);
                let Shape::Conic(conic) = face.outcome.fit.shape else { panic!("a conic") };
                close(conic.conic, k, 1e-3);
                assert_eq!(face.outcome.simpler.map(|simpler| simpler.kind), Some(Kind::Sphere));
            }
        }
    }
}

/// A piece of a paraboloid far from its axis, without a round rim.
#[test]
fn an_off_axis_paraboloid_finds_its_axis() {
    let (focal, k) = (100.0, -1.0);
    let at = |i: usize, j: usize| {
        let p = DVec2::new(40.0 + 2.0 * i as f64, -20.0 + 2.0 * j as f64);
        p.extend(conic(2.0 * focal, k)(p.length()))
    };
    for place in places() {
        let face = only(found(grid(&at, 20, 20), place.0, place.1, &WISH));
        close(placed(&face, Kind::Conic, place, 1e-2), 2.0 * focal, 1e-2);
        assert_eq!(face.semi_diameter(), None);
    }
}

#[test]
fn planes_have_their_normal_and_a_round_rim_if_there_is_one() {
    for place in places() {
        let disc = only(found(revolved(&|_| 0.0, [3.0, 10.0], 2, 48), place.0, place.1, &WISH));
        placed(&disc, Kind::Plane, place, 1e-4);
        close(disc.semi_diameter().expect("a ring"), 1e-2, 1e-8);
        let square = only(found(revolved(&|_| 0.0, [0.0, 10.0], 3, 4), place.0, place.1, &WISH));
        assert!(square.outcome.found && square.outcome.fit.kind == Kind::Plane);
        assert_eq!((square.semi_diameter(), square.entry()), (None, None));
    }
}

/// Two rings of corners lie on a sphere as well.
#[test]
fn tubes_are_cylinders_and_not_spheres_however_they_are_cut() {
    for (rows, sectors, part) in [(1, 24, 1.0), (6, 60, 1.0), (1, 40, 0.4), (5, 30, 0.2)] {
        let at = |i: usize, j: usize| {
            let j = if part == 1.0 { j % sectors } else { j };
            (7.0 * DVec2::from_angle(part * TAU * j as f64 / sectors as f64)).extend(9.0 * i as f64 / rows as f64 - 4.5)
        };
        for place in places() {
            let face = only(found(grid(&at, rows, sectors), place.0, place.1, &WISH));
            let fit = &face.outcome.fit;
            assert!(face.outcome.found && fit.kind == Kind::Cylinder, "{rows} {sectors} {part} {:#?}", face.outcome);
            close(1e3 * fit.radius(), 7.0, 1e-4);
            let line = straylight::geometry::fit::Line::new(1e-3 * place.1, place.0 * DVec3::Z);
            assert!(line.distance(fit.at) < 1e-7 && fit.axis.distance(line.direction) < 1e-5, "{fit:?}");
        }
    }
}

#[test]
fn tapered_tubes_are_cones_and_their_entry_is_a_cone_about_the_apex() {
    for (rows, taper) in [(1, 0.3), (7, 0.02), (3, 2.0)] {
        for place in places() {
            let tube = revolved(&|r| (r - 9.0) / taper, [6.0, 9.0], rows, 40);
            let face = only(found(tube, place.0, place.1, &WISH));
            let fit = &face.outcome.fit;
            let Shape::Cone { taper: t, .. } = fit.shape else { panic!("{:#?}", face.outcome) };
            assert!(face.outcome.found && fit.kind == Kind::Cone);
            close(t.abs(), taper, 1e-5);
            assert!(face.entry().is_some_and(|entry| entry.contains("Asphere(terms: [(1,")), "{:?}", face.entry());
        }
    }
}

#[test]
fn aspheres_of_known_powers_are_found_where_they_are_asked_for() {
    let terms = vec![(4, 2e-6), (6, -1.5e-8)];
    let sag = |k: f64| Sag::Asphere { base: Conic { curvature: 1.0 / 25.0, conic: k }, terms: terms.clone() };
    let mesh = |k: f64| revolved(&|r| sag(k).at(r, 0.0)[0], [0.0, 9.0], 30, 48);
    for place in places() {
        assert!(!only(found(mesh(0.0), place.0, place.1, &WISH)).outcome.found);
        let wish = Wish { powers: vec![4, 6], ..WISH };
        let face = only(found(mesh(-0.7), place.0, place.1, &wish));
        close(placed(&face, Kind::Asphere, place, 1e-3), 25.0, 1e-2);
        // Constant and coefficients may trade; the surface may not.
        let fit = &face.outcome.fit;
        let turned = if fit.axis.dot(place.0 * DVec3::Z) > 0.0 { 1.0 } else { -1.0 };
        for i in 0..=90 {
            let r = 0.1 * f64::from(i);
            let level = fit.shape.level(1e-3 * DVec3::new(r, 0.0, turned * sag(-0.7).at(r, 0.0)[0]));
            close(1e3 * level, 0.0, 4e-5);
        }
    }
}

#[test]
fn noise_widens_the_errors_and_is_found_within_a_tolerance() {
    let mesh = || shaken(revolved(&conic(80.0, 0.0), [0.0, 12.0], 20, 64), 2e-3);
    for place in places() {
        assert!(!only(found(mesh(), place.0, place.1, &WISH)).outcome.found);
        let wish = Wish { tolerance: Some(5e-6), ..WISH };
        let face = only(found(mesh(), place.0, place.1, &wish));
        let fit = &face.outcome.fit;
        assert!(face.outcome.found && fit.kind == Kind::Sphere, "{fit:?}");
        let [error, _] = fit.errors.map(|error| 1e3 * error);
        close((1e3 * fit.radius()).abs(), 80.0, 4.0 * error);
        assert!(error < 0.2, "{error}");
        assert!(fit.rms > 0.5e-6 && fit.rms < 2e-6 && fit.max < 4e-6, "{fit:?}");
    }
}

/// As STEP converters write a lens: each half of a face a primitive of its own, no corner shared, stripes as thin as rounding.
#[test]
fn halves_that_share_no_corner_are_one_face() {
    let radius = -45.0;
    let cap = revolved(&conic(radius, 0.0), [0.0, 10.0], 12, 40);
    let (left, right): (Mesh, Mesh) = cap.into_iter().partition(|[a, b, c]| (*a + *b + *c).x < 0.0);
    // The right half as another conversion would round it, and a sliver on the seam.
    let again = |v: DVec3| DVec3::from_array(v.to_array().map(|x| x + 2e-8 * x));
    let [a, b, _] = right[0];
    let sliver = [a, b, 0.5 * (a + b) + 1e-9 * DVec3::X];
    let mesh: Mesh = left.into_iter().chain(right.into_iter().map(|t| t.map(again))).chain([sliver]).collect();
    let faces = found(mesh, DQuat::IDENTITY, DVec3::ZERO, &WISH);
    let largest = faces.iter().max_by_key(|face| face.triangles.len()).expect("a face");
    close(placed(largest, Kind::Sphere, (DQuat::IDENTITY, DVec3::ZERO), 1e-4), radius, 1e-3);
    assert!(largest.triangles.len() >= 40 * 23, "{}", largest.triangles.len());
}

/// Where the halves of a face are divided differently they stay two faces of one sphere; the edge of the lens is their axis.
#[test]
fn halves_whose_seams_do_not_match_share_the_axis_of_the_edge() {
    let radius = 45.0;
    let half = |rings: usize, sectors: usize, start: f64| {
        let at = move |i: usize, j: usize| {
            let (r, angle) = (10.0 * i as f64 / rings as f64, start + 0.5 * TAU * j as f64 / sectors as f64);
            (r * DVec2::from_angle(angle)).extend(conic(radius, 0.0)(r))
        };
        grid(&at, rings, sectors)
    };
    let edge =
        |i: usize, j: usize| (10.0 * DVec2::from_angle(TAU * (j % 54) as f64 / 54.0)).extend(2.0 + 3.0 * i as f64);
    for place in places() {
        let lens = half(8, 20, 0.0).into_iter().chain(half(11, 27, 0.5 * TAU)).chain(grid(&edge, 1, 54)).collect();
        let faces = found(lens, place.0, place.1, &WISH);
        assert_eq!(faces.len(), 3);
        faces[..2].iter().for_each(|face| close(placed(face, Kind::Sphere, place, 1e-3), radius, 1e-3));
    }
}

/// A face that is two forms is neither.
#[test]
fn nothing_is_found_where_there_is_nothing() {
    let wave =
        only(found(revolved(&|r| 0.2 * (0.7 * r).sin(), [0.0, 12.0], 24, 40), DQuat::IDENTITY, DVec3::ZERO, &WISH));
    assert!(!wave.outcome.found && wave.entry().is_none());
}

/// A lens without a round rim has the axis through its centres of curvature.
#[test]
fn two_spheres_have_the_axis_through_their_centres() {
    let face = |radius: f64, z: f64| {
        let at = move |i: usize, j: usize| {
            let p = DVec2::new(i as f64 - 6.0, j as f64 - 6.0);
            p.extend(z + conic(radius, 0.0)(p.length()))
        };
        grid(&at, 12, 12)
    };
    for place in places() {
        let lens = face(40.0, 0.0).into_iter().chain(face(-30.0, 9.0)).collect();
        let faces = found(lens, place.0, place.1, &WISH);
        assert_eq!(faces.len(), 2);
        close(placed(&faces[0], Kind::Sphere, place, 1e-3), 40.0, 1e-3);
        close(
            placed(&faces[1], Kind::Sphere, (place.0, place.1 + place.0 * DVec3::new(0.0, 0.0, 9.0)), 1e-3),
            -30.0,
            1e-3,
        );
    }
}

const TRIPLET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/systems/triplet/triplet.glb");

/// Radii and vertices of the published prescription, mm. The mesh is in metres in single precision: the prescription is met within
/// four standard errors, and the errors are small.
#[test]
fn the_triplet_has_the_radii_of_its_prescription() {
    let published = [
        ("Lens_1", 20.735168, 0.0),
        ("Lens_1", -352.519657, 3.0),
        ("Lens_2", -20.904350, 10.222805),
        ("Lens_2", 16.773995, 11.422805),
        ("Lens_3", 61.524958, 16.844387),
        ("Lens_3", -17.208143, 20.344387),
    ];
    let (nodes, _) = parts_of_file(Path::new(TRIPLET), LengthUnit(1.0)).expect("the triplet");
    let all: Vec<Face> =
        nodes.iter().filter(|node| node.name.starts_with("Lens_")).flat_map(|node| faces(node, &WISH)).collect();
    assert!(all.iter().all(|face| face.outcome.found) && all.len() == 9, "{all:#?}");
    let spheres: Vec<&Face> = all.iter().filter(|face| face.outcome.fit.kind == Kind::Sphere).collect();
    assert_eq!(spheres.len(), published.len());
    for (node, radius, vertex) in published {
        let near = |face: &&&Face| face.node == node && (1e3 * face.outcome.fit.at.z - vertex).abs() < 1e-3;
        let face = spheres.iter().find(near).unwrap_or_else(|| panic!("no sphere of {node} at {vertex} mm"));
        let fit = &face.outcome.fit;
        let (found, error) = (1e3 * fit.radius(), 1e3 * fit.errors[0]);
        println!(
            "{node}: {found:.7} +- {error:.1e} mm, published {radius}: off by {:+.1e}, rms {:.2e} mm",
            found - radius,
            1e3 * fit.rms
        );
        close(found, radius, 4.0 * error);
        assert!(error < 2e-6 * radius.powi(2) / 20.0 && fit.axis == DVec3::Z && fit.max < 2e-9, "{fit:?}");
        close(1e3 * fit.at.z, vertex, 1e-6);
    }
}

fn program(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_straylight")).args(arguments).output().expect("the program runs")
}

/// What follows the heading of the entries.
fn pasted(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout.clone()).expect("text");
    text.split_once("To paste at the end of `surfaces`:").unwrap_or_else(|| panic!("{text}")).1.to_owned()
}

#[test]
fn what_is_printed_of_the_triplet_can_be_pasted_into_its_system() {
    let folder = TempDir::new().expect("a folder");
    let source = Path::new(TRIPLET).parent().expect("a folder");
    for name in ["triplet.glb", "black-anodize-plausible.anisotropicbsdf"] {
        std::fs::copy(source.join(name), folder.path().join(name)).expect("copied");
    }
    let entries = pasted(&program(&["fit", TRIPLET]));
    assert_eq!((entries.matches("semi_diameter").count(), entries.matches("Cylinder").count()), (6, 17));
    let system = std::fs::read_to_string(source.join("system.ron")).expect("a system");
    // Without the surfaces that it declares itself.
    let (before, rest) = system.split_once("        // The true surfaces").expect("exact surfaces");
    let (_, after) = rest.split_once("        (on: Tag(\"wall_*\")").expect("walls");
    let system = format!("{before}        (on: Tag(\"wall_*\"){after}");
    let last = "(on: Tag(\"detector\"), specular: Absorb),\n";
    let path = folder.path().join("system.ron");
    std::fs::write(&path, system.replacen(last, &format!("{last}{entries}"), 1)).expect("written");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    assert_eq!(document.system.surfaces.iter().filter(|surface| surface.exact.is_some()).count(), 6 + 17);
    let compiled = compile(&document).unwrap_or_else(|e| panic!("{:#?}", e.problems()));
    assert!(compiled.warnings.is_empty(), "{:?}", compiled.warnings);
}

#[test]
fn the_point_of_an_entry_selects_its_face_alone() {
    let (nodes, _) = parts_of_file(Path::new(TRIPLET), LengthUnit(1.0)).expect("the triplet");
    for face in nodes.iter().flat_map(|node| faces(node, &WISH)) {
        let nearest = Predicate::Nearest { point: face.point };
        let selector = Selector::Faces { of: face.node.clone(), predicate: nearest, smooth: face.smooth };
        let picked = select(&selector, &nodes);
        assert!(picked.len() == 1 && picked[0].triangles == face.triangles, "{} {}", face.node, face.number);
        assert_eq!(nodes[picked[0].node].name, face.node);
    }
}

/// R = 20 mm in front, flat behind, 16 mm across.
fn plano_convex() -> Mesh {
    let front = conic(20.0, 0.0);
    let edge = |i: usize, j: usize| {
        let z = if i == 0 { front(8.0) } else { 5.0 };
        (8.0 * DVec2::from_angle(TAU * (j % 32) as f64 / 32.0)).extend(z)
    };
    let back = revolved(&|_| 5.0, [0.0, 8.0], 1, 32).into_iter().map(|[a, b, c]| [a, c, b]);
    revolved(&front, [0.0, 8.0], 8, 32).into_iter().chain(grid(&edge, 1, 32)).chain(back).collect()
}

/// Every form that can be printed is read back and lies on the face that its point selects.
#[test]
fn entries_of_all_forms_compile() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, -1.0, 0.4).normalize(), 0.5);
    let sag = Sag::Asphere { base: Conic { curvature: 0.03, conic: -0.4 }, terms: vec![(4, 3e-6)] };
    let model = [
        ("lens", plano_convex()),
        ("conic", revolved(&conic(-40.0, -1.0), [3.0, 12.0], 12, 32)),
        ("cone", revolved(&|r| 3.0 * r, [6.0, 9.0], 3, 40)),
        ("asphere", revolved(&|r| sag.at(r, 0.0)[0], [0.0, 9.0], 12, 32)),
        ("disc", revolved(&|_| 0.0, [0.0, 9.0], 2, 32)),
        ("tube", grid(&|i, j| (5.0 * DVec2::from_angle(TAU * (j % 30) as f64 / 30.0)).extend(6.0 * i as f64), 2, 30)),
    ];
    let model = model.into_iter().enumerate().fold(Model::new(), |model, (i, (name, mesh))| {
        model.add_at(name, mesh, turn, DVec3::new(40.0 * i as f64, 10.0, -5.0))
    });
    let folder = TempDir::new().expect("a folder");
    let [gltf, path] = ["parts.gltf", "system.ron"].map(|name| folder.path().join(name));
    std::fs::write(&gltf, model.gltf()).expect("written");
    let system = |entries: &str| {
        format!(
            "System(geometry: [(file: \"parts.gltf\", unit: \"mm\", at: \"(0, 0, 3) mm\", rotate: \"(0, 30, 0) deg\")],
            surfaces: [(on: Node(\"*\"), specular: Absorb), {entries}],
            sources: {{\"sun\": (flux: \"1 W\", extent: Disk(radius: \"9 mm\"), at: \"(0, 0, -200) mm\",
                angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\"))}},
            detectors: {{\"disc\": (on: Node(\"disc\"), quantity: Irradiance, pixels: (4, 4))}},)"
        )
    };
    std::fs::write(&path, system("")).expect("written");
    let written = path.to_str().expect("a path");
    let entries = pasted(&program(&["fit", written, "--form", "asphere:4", "--smooth", "15 deg"]));
    for form in ["Sphere(", "Conic(", "Asphere(terms", "Asphere(radius", "Plane", "Cylinder("] {
        assert!(entries.contains(&format!("form: {form}")), "{form} in {entries}");
    }
    std::fs::write(&path, system(&entries)).expect("written");
    let compiled = compile(&Document::read(&path).unwrap_or_else(|e| panic!("{entries}\n{:#?}", e.problems())));
    compiled.unwrap_or_else(|e| panic!("{entries}\n{:#?}", e.problems()));
}

#[test]
fn what_cannot_be_meant_is_told() {
    let code = |arguments: &[&str]| {
        let output = program(arguments);
        (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (status, text) = code(&["fit", TRIPLET, "--node", "Lens_9"]);
    assert!(
        status == 64 && text.contains("--node \"Lens_9\": no node matches; did you mean \"Lens_1\"?"),
        "{status} {text}"
    );
    assert_eq!(code(&["fit", "gone.glb"]).0, 66);
    assert_eq!(code(&["fit", "gone.ron"]).0, 66);
    assert_eq!(code(&["fit", "gone.ron", "--unit", "mm"]).0, 64);
    for wrong in [
        ["--form", "sphere"],
        ["--form", "asphere:4,4"],
        ["--form", "asphere:0"],
        ["--tolerance", "-1 um"],
        ["--unit", "kg"],
    ] {
        assert_eq!(code(&[&["fit", TRIPLET][..], &wrong].concat()).0, 64, "{wrong:?}");
    }
}
