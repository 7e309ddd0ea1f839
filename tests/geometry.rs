//! From glTF to parts: transforms, topology, selection, on generated files and on the triplet.

use glam::DVec3;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use straylight::geometry::mesh::Mesh;
use straylight::system::gltf::{self, GltfFile, Node};
use straylight::system::select::{Picked, Predicate, Selector, select};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A verification case by its id.
fn case(id: &str) -> Value {
    fn find<'a>(value: &'a Value, id: &str) -> Option<&'a Value> {
        match value {
            Value::Object(map) if map.get("id").and_then(Value::as_str) == Some(id) => Some(value),
            Value::Object(map) => map.values().find_map(|value| find(value, id)),
            Value::Array(list) => list.iter().find_map(|value| find(value, id)),
            _ => None,
        }
    }
    let text = fs::read_to_string(format!("{ROOT}/tests/data/verification/public.json")).expect("cases");
    find(&serde_json::from_str(&text).expect("JSON"), id).expect("case").clone()
}

fn point(value: &Value) -> DVec3 {
    DVec3::new(value[0].as_f64().expect("x"), value[1].as_f64().expect("y"), value[2].as_f64().expect("z"))
}

/// Writes a .gltf and its buffer into a folder and reads it. `nodes` use mesh 0 with these points and triangles.
fn read(nodes: Value, points: &[DVec3], triangles: &[[u32; 3]]) -> GltfFile {
    let folder = tempfile::tempdir().expect("folder");
    let path = write(folder.path(), nodes, points, triangles);
    gltf::read(&path).unwrap_or_else(|problems| panic!("{problems:#?}"))
}

fn write(folder: &Path, nodes: Value, points: &[DVec3], triangles: &[[u32; 3]]) -> std::path::PathBuf {
    let mut bytes: Vec<u8> = points.iter().flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes).collect();
    let split = bytes.len();
    bytes.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    fs::write(folder.join("a b.bin"), &bytes).expect("buffer");
    let document = json!({
        "asset": {"version": "2.0"}, "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "glass"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": points.len(), "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5125, "count": 3 * triangles.len(), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": split},
                        {"buffer": 0, "byteOffset": split, "byteLength": bytes.len() - split}],
        "buffers": [{"byteLength": bytes.len(), "uri": "a%20b.bin"}]});
    let path = folder.join("test.gltf");
    fs::write(&path, document.to_string()).expect("document");
    path
}

/// GEO-01 and GEO-02: a chain of nodes, the last with the triangle.
fn chain(id: &str) {
    let case = case(id);
    let mut nodes = case["setup"]["nodes_root_to_leaf"].as_array().expect("nodes").clone();
    let last = nodes.len() - 1;
    for (i, node) in nodes.iter_mut().enumerate() {
        match i == last {
            true => node["mesh"] = json!(0),
            false => node["children"] = json!([i + 1]),
        }
    }
    let local: Vec<DVec3> = case["setup"]["triangle_local"].as_array().expect("triangle").iter().map(point).collect();
    let file = read(json!(nodes), &local, &[[0, 1, 2]]);
    let expected = &case["reference"]["values"][0];
    let world: Vec<DVec3> = expected["world"].as_array().expect("world").iter().map(point).collect();
    let mesh = &file.nodes[0].mesh;
    let flipped = expected["winding_must_flip"].as_bool().expect("flip");
    let order = if flipped { [0, 2, 1] } else { [0, 1, 2] };
    let scale = world.iter().fold(0f64, |most, v| most.max(v.length()));
    for (corner, k) in file.nodes[0].triangle(0).into_iter().zip(order) {
        assert!(corner.distance(world[k]) <= 1e-12 * scale, "{id}: {corner} {}", world[k]);
    }
    assert!((mesh.area(0) / expected["area"].as_f64().expect("area") - 1.0).abs() < 1e-12);
    assert!(mesh.normal(0).distance(point(&expected["correct_outward_normal"])) < 1e-12);
}

#[test]
fn geo_01_a_chain_of_nodes_places_its_triangle() {
    chain("GEO-01");
}

#[test]
fn geo_02_a_mirrored_chain_keeps_its_front_outside() {
    chain("GEO-02");
}

/// Icosahedron, each triangle split in four `depth` times, corners pushed out to radius 1.
fn icosphere(depth: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let t = (1.0 + 5f64.sqrt()) / 2.0;
    let mut points: Vec<DVec3> = (0..3)
        .flat_map(|axis| [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)].map(|(a, b)| (axis, a, b)))
        .map(|(axis, a, b)| match axis {
            0 => DVec3::new(a, b, 0.0),
            1 => DVec3::new(0.0, a, b),
            _ => DVec3::new(b, 0.0, a),
        })
        .map(DVec3::normalize)
        .collect();
    let mut triangles = Vec::new();
    let edge = points[0].distance(points[1]) * 1.01;
    for a in 0..12u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|i| points[i as usize]);
                if p.distance(q) < edge && q.distance(r) < edge && r.distance(p) < edge {
                    triangles.push(if (q - p).cross(r - p).dot(p) > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..depth {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        let split = |[a, b, c]: [u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    (points, triangles)
}

/// Every triangle with its own corners, as facetted exporters write them.
fn soup(points: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corners = triangles.iter().flatten().map(|&i| points[i as usize]).collect();
    (corners, (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

#[test]
fn geo_06_area_and_volume_of_an_inscribed_icosphere() {
    for expected in case("GEO-06")["reference"]["values"].as_array().expect("values") {
        let depth = expected["subdiv"].as_u64().expect("depth") as usize;
        let (points, triangles) = icosphere(depth);
        let (corners, alone) = soup(&points, &triangles);
        let labels = vec![0; alone.len()];
        let (mesh, repairs) = Mesh::weld(corners, alone, labels, 0.0);
        assert_eq!(mesh.vertices.len(), points.len(), "one position per corner");
        assert_eq!(repairs, Default::default());
        assert!(mesh.topology.closed() && !mesh.topology.inverted() && mesh.topology.pieces == 1);
        let number = |key: &str| expected[key].as_f64().expect("a number");
        let area = mesh.topology.area / (4.0 * PI);
        let volume = mesh.topology.volume / (4.0 / 3.0 * PI);
        assert!((area / number("area_ratio") - 1.0).abs() < 1e-9, "{depth}: {area}");
        assert!((volume / number("volume_ratio") - 1.0).abs() < 1e-9, "{depth}: {volume}");
        let tilt = |i: usize| {
            mesh.corners(i).into_iter().map(|v| mesh.normal(i).angle_between(v)).fold(0f64, f64::max).to_degrees()
        };
        let worst = (0..mesh.triangles.len()).map(tilt).fold(0f64, f64::max);
        assert!((worst / number("max_normal_error_deg") - 1.0).abs() < 1e-9, "{depth}: {worst}");
    }
}

#[test]
fn instances_are_copied_and_named_apart() {
    let (points, triangles) = icosphere(1);
    let nodes = json!([{"name": "ball", "mesh": 0}, {"name": "ball", "mesh": 0, "scale": [-2, 1, 1]},
                       {"name": "group", "children": [3]}, {"name": "ball", "mesh": 0, "extras": {"finish": "black"}}]);
    let file = read(nodes, &points, &triangles);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let paths: Vec<&str> = file.nodes.iter().map(|node| node.path.as_str()).collect();
    assert_eq!(paths, ["ball", "ball#2", "group/ball"]);
    for node in &file.nodes {
        assert!(node.mesh.topology.closed() && node.mesh.topology.volume > 0.0, "front outside, mirrored or not");
    }
    let count =
        |selector: Selector| select(&selector, &file.nodes).iter().map(|picked| picked.node).collect::<Vec<_>>();
    assert_eq!(count(Selector::Node("ball*".into())), [0, 1, 2]);
    assert_eq!(count(Selector::Node("group".into())), [2], "a node stands for what is below it");
    assert_eq!(count(Selector::Extras { key: "finish".into(), value: "black".into() }), [2]);
    assert_eq!(count(Selector::Tag("gl?ss".into())), [0, 1, 2]);
    assert_eq!(count(Selector::Any(vec![Selector::Node("group/*".into()), Selector::Node("ball".into())])), [0, 1, 2]);
    assert_eq!(count(Selector::Node("nothing".into())), [0usize; 0]);
}

#[test]
fn corners_apart_by_rounding_are_joined_and_nothing_else() {
    let (points, triangles) = icosphere(3);
    let (mut corners, alone) = soup(&points, &triangles);
    // Every third corner moved by one unit in the last place of its f32.
    for (i, corner) in corners.iter_mut().enumerate() {
        *corner = corner.as_vec3().as_dvec3();
        if i % 3 == 0 {
            corner.x = f64::from(f32::from_bits((corner.x as f32).to_bits() + 1));
        }
    }
    let file = read(json!([{"name": "ball", "mesh": 0}]), &corners, &alone);
    let node = &file.nodes[0];
    assert!(node.repairs.closed_up > 0 && node.mesh.topology.closed(), "{:?}", node.mesh.topology);
    assert_eq!(node.mesh.vertices.len(), points.len());
    // The same sphere with a hole of one triangle stays open.
    let file = read(json!([{"name": "ball", "mesh": 0}]), &points, &triangles[1..]);
    assert_eq!(file.nodes[0].mesh.topology.open_edges, 3);
    // One triangle turned over is noticed, one repeated is dropped.
    let mut turned = triangles.clone();
    turned[5].swap(0, 1);
    turned.push([triangles[9][1], triangles[9][2], triangles[9][0]]);
    let file = read(json!([{"name": "ball", "mesh": 0}]), &points, &turned);
    let node = &file.nodes[0];
    assert_eq!((node.mesh.topology.twisted_edges, node.repairs.duplicate), (3, 1));
    assert!(!node.mesh.topology.closed());
}

fn triplet() -> Vec<Node> {
    let path = format!("{ROOT}/systems/triplet/triplet.glb");
    let file = gltf::read(Path::new(&path)).unwrap_or_else(|problems| panic!("{problems:#?}"));
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    file.nodes
}

fn of(lens: &str, predicate: Predicate) -> Selector {
    Selector::Faces { of: lens.into(), predicate, smooth: 20f64.to_radians() }
}

fn area(nodes: &[Node], picked: &[Picked]) -> f64 {
    picked.iter().flat_map(|p| p.triangles.iter().map(|&i| nodes[p.node].mesh.area(i as usize))).sum()
}

/// Area of a spherical cap of radius `r` and aperture radius `a`.
fn cap(r: f64, a: f64) -> f64 {
    2.0 * PI * r * (r - (r * r - a * a).sqrt())
}

#[test]
fn the_lenses_of_the_triplet_fall_into_front_rear_and_rim() {
    let nodes = triplet();
    // Radii and semi-diameters of both surfaces of each lens, mm.
    let lenses = [
        ("Lens_1", [20.735168, 352.519657], [8.096249596588601, 8.096249596588601]),
        ("Lens_2", [20.904350, 16.773995], [3.7664579882609086, 3.7664579882609086]),
        ("Lens_3", [61.524958, 17.208143], [6.704330517287458, 6.704330517287458]),
    ];
    let within = 30f64.to_radians();
    for (name, radii, semi) in lenses {
        let node = nodes.iter().find(|node| node.name == name).expect("lens");
        assert!(node.mesh.topology.closed() && node.mesh.topology.volume > 0.0, "{name}");
        assert_eq!(node.mesh.faces(20f64.to_radians()).count, 3, "{name} has three faces");
        let front = select(&of(name, Predicate::Normal { direction: -DVec3::Z, within }), &nodes);
        let rear = select(&of(name, Predicate::Normal { direction: DVec3::Z, within }), &nodes);
        let rim = select(&of(name, Predicate::Radial { axis: DVec3::Z, through: None, within }), &nodes);
        let about = Some(DVec3::ZERO);
        assert_eq!(rim, select(&of(name, Predicate::Radial { axis: DVec3::Z, through: about, within }), &nodes));
        let aside = Some(DVec3::new(0.01, 0.0, 0.0));
        assert!(select(&of(name, Predicate::Radial { axis: DVec3::Z, through: aside, within }), &nodes).is_empty());
        for (picked, side) in [(&front, 0), (&rear, 1)] {
            let expected = cap(radii[side], semi[side]) * 1e-6;
            assert!((area(&nodes, picked) / expected - 1.0).abs() < 1e-3, "{name} side {side}");
        }
        let total: usize = [&front, &rear, &rim].iter().map(|picked| picked[0].triangles.len()).sum();
        assert_eq!(total, node.mesh.triangles.len(), "{name}: nothing twice, nothing left");
    }
    let rims = select(&of("Lens_*", Predicate::Radial { axis: DVec3::Z, through: None, within }), &nodes);
    assert_eq!(rims.len(), 3);
}

#[test]
fn the_nearest_face_and_the_faces_in_a_box_are_found() {
    let nodes = triplet();
    let nearest = |of_: &str, point| select(&of(of_, Predicate::Nearest { point }), &nodes);
    let front = nearest("*", DVec3::new(0.0, 0.0, -0.001));
    let looks = Predicate::Normal { direction: -DVec3::Z, within: 0.5 };
    assert_eq!(front, select(&of("Lens_1", looks.clone()), &nodes));
    let last = DVec3::new(0.0, 0.0, 0.03);
    let both = Predicate::All(vec![Predicate::Nearest { point: last }, looks]);
    let third = select(&of("Lens_*", both), &nodes);
    assert_eq!(nodes[third[0].node].name, "Lens_3", "nearest of the fronts, although the rear is nearer");
    let everything = Predicate::Box { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
    assert_eq!(select(&of("*", everything), &nodes).len(), nodes.len());
    let detector = Predicate::Box { min: DVec3::new(-1.0, -1.0, 0.0616), max: DVec3::new(1.0, 1.0, 0.0618) };
    let found = select(&of("Detector", detector), &nodes);
    assert_eq!(found[0].triangles.len(), 2);
}

#[test]
#[ignore = "a measurement: cargo test --release --test geometry -- --ignored --nocapture"]
fn a_million_triangles_are_read_in_seconds() {
    let folder = tempfile::tempdir().expect("folder");
    let (points, triangles) = icosphere(8);
    let (corners, alone) = soup(&points, &triangles);
    for (what, points, triangles) in [("indexed", &points, &triangles), ("soup", &corners, &alone)] {
        let path = write(folder.path(), json!([{"mesh": 0}]), points, triangles);
        let start = std::time::Instant::now();
        let file = gltf::read(&path).expect("reads");
        let read = start.elapsed();
        let faces = file.nodes[0].mesh.faces(0.3).count;
        println!("{what}: {} triangles read in {read:?}, {faces} face after {:?}", triangles.len(), start.elapsed());
        assert!(read.as_secs_f64() < 5.0 && file.nodes[0].mesh.topology.closed());
    }
}
