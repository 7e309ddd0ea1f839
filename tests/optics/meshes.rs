//! The same lens as a mesh with exact surfaces, with circular rims, with plain facets, and as a prescription.

use crate::lab::{close, compile_gltf, system};
use crate::lenses::{around, crossing, form, singlet, through};
use crate::support::model::Mesh;
use crate::support::shapes::{Equal, quad, sphere};
use crate::support::{Case, Model, case::number};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use straylight::system::compile::Compiled;

/// A biconvex or meniscus singlet about z in mm.
#[derive(Clone, Copy)]
pub struct Singlet {
    /// Curvatures of front and back, 1/mm.
    pub curvature: [f64; 2],
    pub thickness: f64,
    pub half: f64,
}

impl Singlet {
    pub fn sag(&self, side: usize, r: f64) -> f64 {
        let c = self.curvature[side];
        c * r * r / (1.0 + (1.0 - c * c * r * r).sqrt()) + if side == 1 { self.thickness } else { 0.0 }
    }

    /// Rings and sectors of facets on each side; the edge is a prism.
    pub fn mesh(&self, rings: usize, sectors: usize) -> Mesh {
        let point = |side: usize, ring: usize, sector: usize| {
            let r = self.half * ring as f64 / rings as f64;
            (r * DVec2::from_angle(TAU * (sector % sectors) as f64 / sectors as f64)).extend(self.sag(side, r))
        };
        let mut mesh = Mesh::new();
        for s in 0..sectors {
            for (side, turned) in [(0, true), (1, false)] {
                let mut face = |[a, b, c]: [DVec3; 3]| mesh.push(if turned { [a, c, b] } else { [a, b, c] });
                face([point(side, 0, 0), point(side, 1, s), point(side, 1, s + 1)]);
                for ring in 1..rings {
                    let (a, b) = (point(side, ring, s), point(side, ring, s + 1));
                    let (c, d) = (point(side, ring + 1, s + 1), point(side, ring + 1, s));
                    quad([a, d, c, b]).into_iter().for_each(&mut face);
                }
            }
            mesh.extend(quad([point(0, rings, s), point(0, rings, s + 1), point(1, rings, s + 1), point(1, rings, s)]));
        }
        mesh
    }

    pub fn form(&self, side: usize) -> String {
        let c = self.curvature[side];
        if c == 0.0 { "Plane".into() } else { format!("Sphere(radius: \"{:?} mm\")", 1.0 / c) }
    }

    /// Entries that declare both sides of the node `lens`; `rim` as in ", semi_diameter: ..".
    pub fn exact(&self, rim: &str) -> String {
        let entry = |side: usize, z: f64| {
            format!(
                "(on: Faces(of: \"lens\", where: Nearest(point: \"(0, 0, {z:?}) mm\")), name: \"{}\", exact: (form: {}, \
                 vertex: \"(0, 0, {z:?}) mm\" {rim})),",
                ["front", "back"][side],
                self.form(side)
            )
        };
        entry(0, 0.0) + &entry(1, self.thickness)
    }

    /// The element.
    pub fn element(&self) -> String {
        singlet(&self.form(0), &self.form(1), self.thickness, 2.0 * self.half)
    }

    /// Sections for the mesh, with entries beside the medium.
    pub fn sections(&self, entries: &str, n: f64) -> String {
        let surfaces = format!(
            "geometry: [(file: \"parts.gltf\", unit: \"mm\")],
            surfaces: [(on: Node(\"lens\"), medium: \"glass\", specular: Fresnel), {entries}], default:"
        );
        around("", n).replace("geometry: [], elements: {  },", "").replace("default:", &surfaces)
    }

    pub fn compiled(&self, rings: usize, sectors: usize, entries: &str, n: f64) -> Compiled {
        system(&self.sections(entries, n), &Model::new().add("lens", self.mesh(rings, sectors)).gltf())
    }
}

pub const BICONVEX: Singlet = Singlet { curvature: [0.02, -0.025], thickness: 6.0, half: 10.0 };
pub const MENISCUS: Singlet = Singlet { curvature: [0.03, 0.012], thickness: 3.0, half: 9.0 };

/// Same rays, same places, whatever the mesh: within the rounding of its f32 corners nowhere.
#[test]
fn a_mesh_with_exact_surfaces_sends_every_ray_where_the_prescription_does() {
    for lens in [BICONVEX, MENISCUS] {
        let prescribed = system(&around(&lens.element(), 1.5168), "");
        let rim = format!(", semi_diameter: \"{:?} mm\"", lens.half);
        for (rings, sectors, rim) in [(2, 24, ""), (2, 24, rim.as_str()), (12, 96, "")] {
            let meshed = lens.compiled(rings, sectors, &lens.exact(rim), 1.5168);
            for i in 0..60 {
                // Inside the polygon of 24 sides.
                let r = 0.98 * lens.half * (f64::from(i) / 60.0).sqrt();
                let from = (r * DVec2::from_angle(2.4 * f64::from(i))).extend(-30.0);
                let direction = DVec3::new(1e-3 * f64::from(i), -0.02, 1.0).normalize();
                let from = from - 30.0 / direction.z * DVec3::new(direction.x, direction.y, 0.0);
                let [a, b] = [&prescribed, &meshed].map(|system| through(system, from, direction));
                assert!(
                    (a.origin - b.origin).length() < 1e-12 && (a.direction - b.direction).length() < 1e-14,
                    "{a:?} {b:?}"
                );
            }
        }
    }
}

#[test]
fn the_ball_lens_mesh_has_its_focal_length_at_any_subdivision() {
    let case = Case::load("LEN-01");
    let (radius, n) = (case.given("/radius"), case.given("/n"));
    let efl = number(&case.values()[0], "EFL");
    for levels in 0..4 {
        let model = Model::new().add("ball", sphere(radius, levels, Equal::Corners));
        let entry = format!(
            "surfaces: [(on: Node(\"ball\"), medium: \"glass\", specular: Fresnel, exact: (form: Sphere(radius: \"{radius:?} mm\"), \
             vertex: \"(0, 0, {:?}) mm\"))], default:",
            -radius
        );
        let sections =
            around("", n).replace("geometry: [], elements: {  },", "geometry: [(file: \"parts.gltf\", unit: \"mm\")],");
        let compiled = system(&sections.replace("default:", &entry), &model.gltf());
        for y in [1e-4, 2.0, 4.9] {
            let out = through(&compiled, DVec3::new(0.6 * y, 0.8 * y, -50.0), DVec3::Z);
            let exact = y / (2.0 * ((y / radius).asin() - (y / (n * radius)).asin())).sin();
            close(crossing(&out), exact, 1e-9 * exact, &format!("subdivision {levels}, y {y}"));
            if y < 1e-3 {
                close(y / (out.direction.truncate().length()), efl, 2e-9 * efl, "EFL");
            }
        }
    }
}

/// r.m.s. distance from the axis on the plane z, mm, of light that goes straight through.
fn spot(compiled: &Compiled, radius: f64, z: f64, count: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..count {
        let r = radius * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        let from = (r * DVec2::from_angle(2.399_963 * f64::from(i))).extend(-20.0);
        let out = through(compiled, from, DVec3::Z);
        let p = out.origin + (z - out.origin.z) / out.direction.z * out.direction;
        sum += p.truncate().length_squared();
    }
    (sum / f64::from(count)).sqrt()
}

/// LEN-07: icospheres against the exact ball.
#[test]
fn len_07_faceted_ball_lens() {
    let case = Case::load("LEN-07");
    let (radius, n) = (case.given("/ball/R"), case.given("/ball/n"));
    let z = case.given("/detector_z_from_centre");
    let (exact, faceted) = (crate::lenses::ball(radius), case.values());
    let found = spot(&system(&around(&exact, n), ""), case.given("/beam/radius"), z + radius, 2000);
    close(found, number(&faceted[0], "rms_spot"), 2e-6, "LEN-07 exact");
    for value in &faceted[1..] {
        let levels = value["subdivision"].as_u64().expect("a number") as u32;
        let model = Model::new().add("ball", sphere(radius, levels, Equal::Corners));
        let entry = "surfaces: [(on: Node(\"ball\"), medium: \"glass\", specular: Fresnel)], default:";
        let sections =
            around("", n).replace("geometry: [], elements: {  },", "geometry: [(file: \"parts.gltf\", unit: \"mm\")],");
        let found =
            spot(&system(&sections.replace("default:", entry), &model.gltf()), case.given("/beam/radius"), z, 4000);
        let wanted = number(value, "rms_spot");
        close(found, wanted, 4.0 * number(value, "sigma") + case.sys(), &format!("LEN-07 subdivision {levels}"));
    }
}

/// LEN-05: the spot of flat facets is proportional to their edge; exact surfaces have none of it.
#[test]
fn len_05_tessellation_blurs_in_first_order() {
    let case = Case::load("LEN-05");
    let text = "plano-convex";
    let values: Vec<_> =
        case.values().into_iter().filter(|v| v["case"].as_str().is_some_and(|c| c.starts_with(text))).collect();
    let (radius, thickness, half, n) = (51.68, 5.0, 5.0, 1.5168);
    let case_2 = Case::load("LEN-02");
    assert_eq!((case_2.given("/R1"), case_2.given("/thickness"), case_2.given("/n")), (radius, thickness, n));
    let focus = thickness + number(&case_2.values()[0], "BFD");
    let mut last: Option<(f64, f64)> = None;
    for value in values.iter().take(3) {
        let h = number(value, "h");
        let mesh = lattice(radius, thickness, half, h);
        let compiled = {
            let model = Model::new().add("lens", mesh);
            let lens = Singlet { curvature: [1.0 / radius, 0.0], thickness, half };
            system(&lens.sections("", n), &model.gltf())
        };
        let found = spot(&compiled, 0.9 * half, focus, 4000);
        let wanted = number(value, "rms_spot");
        println!("LEN-05 h {h}: {found:.6} mm, reference {wanted:.6}");
        assert!((found / wanted - 1.0).abs() < case.tolerance("rel") + 0.02, "{found} {wanted}");
        if let Some((h0, s0)) = last {
            let order = (s0 / found).ln() / (h0 / h).ln();
            assert!((order - 1.0).abs() < 0.05, "order {order}");
        }
        last = Some((h, found));
    }
    let exact = system(&around(&singlet(&form(&serde_json::json!(radius)), "Plane", thickness, 2.0 * half), n), "");
    let sharp = spot(&exact, half, focus, 4000);
    println!("LEN-05 exact: {sharp:.6} mm");
    assert!((sharp / 0.00683 - 1.0).abs() < 2e-3, "{sharp}");
}

/// A plano-convex lens whose front is an equilateral lattice of edge `h` in (x, y), corners on the sphere; its sides are steps.
fn lattice(radius: f64, thickness: f64, half: f64, h: f64) -> Mesh {
    let point = |i: i32, j: i32| DVec2::new(h * (f64::from(i) + 0.5 * f64::from(j)), h * 0.75f64.sqrt() * f64::from(j));
    let sag = |p: DVec2| p.length_squared() / (radius * (1.0 + (1.0 - p.length_squared() / radius / radius).sqrt()));
    let many = (2.0 * half / h) as i32 + 2;
    let mut top: Vec<[(i32, i32); 3]> = Vec::new();
    for (i, j) in (-many..many).flat_map(|i| (-many..many).map(move |j| (i, j))) {
        for triangle in [[(i, j), (i + 1, j), (i, j + 1)], [(i + 1, j), (i + 1, j + 1), (i, j + 1)]] {
            let inside = triangle.iter().any(|&(i, j)| point(i, j).length() < half + h);
            if inside {
                top.push(triangle);
            }
        }
    }
    let edges: std::collections::HashSet<_> = top.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
    let front = |(i, j): (i32, i32)| point(i, j).extend(sag(point(i, j)));
    let rear = |(i, j): (i32, i32)| point(i, j).extend(thickness);
    let mut mesh = Mesh::new();
    for [a, b, c] in &top {
        mesh.push([front(*a), front(*c), front(*b)]);
        mesh.push([rear(*a), rear(*b), rear(*c)]);
    }
    for &(a, b) in edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))) {
        mesh.extend(quad([front(a), front(b), rear(b), rear(a)]));
    }
    mesh
}

#[test]
fn a_shape_that_the_mesh_does_not_have_is_refused_with_the_distance() {
    let lens = BICONVEX;
    let wrong = lens.exact("").replacen("50.0 mm", "-50.0 mm", 1);
    let gltf = Model::new().add("lens", lens.mesh(3, 24)).gltf();
    let error = compile_gltf(&lens.sections(&wrong, 1.5), &gltf).expect_err("refused");
    let text = format!("{:?}", error.problems());
    assert!(text.contains("from this shape") && text.contains("surfaces[1].exact"), "{text}");
}

/// A coarse mesh and a fine one with exact surfaces and circular rims, and the prescription: the same map, pixel by pixel.
#[test]
fn coarse_and_fine_meshes_and_the_prescription_give_one_map() {
    let lens = BICONVEX;
    let screen = "\"fpa\": (body: Aperture(diameter: \"0 mm\", outer: \"40 mm\"), at: \"(0, 0, 38) mm\"),";
    let lit = |sections: String, seed: u64| {
        sections
            .replace("extent: Point, at: \"(0, 0, -1000) mm\",", "extent: Disk(radius: \"11 mm\"), at: \"(0, 0, -20) mm\",")
            .replace("direction: \"(0, 0, 1)\"", "direction: \"(0.05, 0.02, 1)\"")
            .replace(crate::lab::CERTAIN, &format!("run: (rays: 60000, seed: {seed}),"))
            .replace(
                "default:",
                "detectors: { \"fpa\": (on: Node(\"fpa\"), quantity: Irradiance, pixels: (16, 16), side: Front) }, default:",
            )
    };
    let rim = format!(", semi_diameter: \"{:?} mm\"", lens.half);
    let meshed = |rings: usize, sectors: usize, seed: u64| {
        let sections = lens.sections(&lens.exact(&rim), 1.5168).replacen(
            "geometry:",
            &format!("elements: {{ {screen} }}, geometry:"),
            1,
        );
        let gltf = Model::new().add("lens", lens.mesh(rings, sectors)).gltf();
        crate::lab::traced(&system(&lit(sections, seed), &gltf))
    };
    let prescribed = crate::lab::traced(&system(&lit(around(&(lens.element() + screen), 1.5168), 1), ""));
    for results in [meshed(2, 68, 2), meshed(100, 500, 3)] {
        let maps = [&prescribed, &results]
            .map(|results| results.maps.iter().find(|map| map.detector == "fpa").expect("a map"));
        let (mut chi, mut pixels) = (0.0, 0);
        for i in (0..maps[0].mean.len()).filter(|&i| maps.iter().all(|map| map.rays[i] >= 30)) {
            let variance = maps[0].error[i].powi(2) + maps[1].error[i].powi(2);
            chi += (maps[0].mean[i] - maps[1].mean[i]).powi(2) / variance;
            pixels += 1;
        }
        println!("{pixels} pixels, chi-squared {chi:.1}");
        // 4.5 sigma of chi-squared.
        let n = f64::from(pixels);
        assert!(pixels > 30 && (chi - n).abs() < 4.5 * (2.0 * n).sqrt(), "{chi} over {pixels} pixels");
        let [a, b] = [&prescribed, &results].map(|results| &results.detectors["fpa"].flux_w);
        assert!((a.mean - b.mean).abs() < 4.0 * a.error.hypot(b.error), "{a:?} {b:?}");
    }
}
