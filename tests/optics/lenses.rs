//! Focal lengths, crossings and spots of exact surfaces written as elements.

use crate::lab::{close, shot, system};
use crate::support::{Case, case::number};
use glam::DVec3;
use serde_json::Value;
use straylight::geometry::Ray;
use straylight::system::compile::Compiled;

/// Sections around elements: one glass of index `n`, a lamp that is not used, rays followed without chance.
pub fn around(elements: &str, n: f64) -> String {
    format!(
        "geometry: [], elements: {{ {elements} }},
        media: {{ \"glass\": Constant(n: {n:?}) }},
        default: (specular: Absorb),
        sources: {{ \"lamp\": (flux: \"1 W\", extent: Point, at: \"(0, 0, -1000) mm\",
            angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"550 nm\")) }},
        {}",
        crate::lab::CERTAIN
    )
}

/// `Sphere(..)` or `Plane` for a radius in mm, or "inf".
pub fn form(radius: &Value) -> String {
    radius.as_f64().map_or("Plane".into(), |r| format!("Sphere(radius: \"{r:?} mm\")"))
}

/// A lens of two surfaces; lengths in mm.
pub fn singlet(front: &str, back: &str, thickness: f64, diameter: f64) -> String {
    format!(
        "\"lens\": (body: Lens(surfaces: [(form: {front}), (form: {back})], thickness: [\"{thickness:?} mm\"], \
         media: [\"glass\"], diameter: \"{diameter:?} mm\")),"
    )
}

pub fn ball(radius: f64) -> String {
    let side = |r: f64| format!("Sphere(radius: \"{r:?} mm\")");
    singlet(&side(radius), &side(-radius), 2.0 * radius, 2.0 * radius)
}

/// The brightest ray that comes out of one sent from `from` (mm), in mm.
pub fn through(compiled: &Compiled, from: DVec3, direction: DVec3) -> Ray {
    let out = shot(compiled, &[Ray { origin: 1e-3 * from, direction }]).brightest();
    Ray { origin: 1e3 * (out.origin + compiled.scene.shift), ..out }
}

/// Where a ray in the xz or yz plane crosses the z axis, mm.
pub fn crossing(ray: &Ray) -> f64 {
    let (o, d) = (ray.origin, ray.direction);
    o.z - d.z * o.truncate().dot(d.truncate()) / d.truncate().length_squared()
}

fn ball_lens(id: &str) {
    let case = Case::load(id);
    let (radius, n) = (case.given("/radius"), case.given("/n"));
    let compiled = system(&around(&ball(radius), n), "{\"asset\": {\"version\": \"2.0\"}}");
    for value in case.values() {
        match value.get("y") {
            Some(y) => {
                let y = y.as_f64().expect("a height");
                let out = through(&compiled, DVec3::new(0.6 * y, 0.8 * y, -50.0), DVec3::Z);
                let wanted = number(&value, "z_cross_from_centre");
                close(crossing(&out) - radius, wanted, 1e-9 * wanted, &format!("{id} y {y}"));
            }
            None => {
                let height = 1e-4;
                let out = through(&compiled, DVec3::new(height, 0.0, -50.0), DVec3::Z);
                let (efl, bfl) = (number(&value, "EFL"), number(&value, "BFL"));
                // Third-order aberration at this height is 1e-9 of the focal length.
                close(-height / out.direction.x, efl, 2e-9 * efl, &format!("{id} EFL"));
                close(crossing(&out) - 2.0 * radius, bfl, 2e-9 * efl, &format!("{id} BFL"));
            }
        }
    }
}

#[test]
fn len_01_ball_lens() {
    ball_lens("LEN-01");
    ball_lens("LEN-01x");
}

fn thick_singlet(id: &str) {
    let case = Case::load(id);
    let thickness = case.given("/thickness");
    let lens = singlet(&form(case.setup("/R1")), &form(case.setup("/R2")), thickness, 24.0);
    let compiled = system(&around(&lens, case.given("/n")), "");
    for value in case.values() {
        let height = value.get("y").map_or(1e-4, |y| y.as_f64().expect("a height"));
        let out = through(&compiled, DVec3::new(0.0, height, -50.0), DVec3::Z);
        let found = crossing(&out) - thickness;
        match value.get("y") {
            Some(_) => {
                let wanted = number(&value, "z_from_rear_vertex");
                close(found, wanted, 1e-9 * wanted, &format!("{id} y {height}"));
            }
            None => {
                close(-height / out.direction.y, number(&value, "EFL"), 1e-7, &format!("{id} EFL"));
                close(found, number(&value, "BFD"), 1e-7, &format!("{id} BFD"));
            }
        }
    }
}

#[test]
fn len_02_thick_singlet() {
    thick_singlet("LEN-02");
    thick_singlet("LEN-02b");
}

fn aplanatic(id: &str) {
    let case = Case::load(id);
    let (radius, n) = (case.given("/sphere_R"), case.given("/n_inside"));
    let values = case.values();
    let (from, image) = (number(&values[0], "object_distance"), number(&values[0], "image_distance"));
    let compiled = system(&around(&ball(radius), n), "");
    for value in &values[1..] {
        let u = number(value, "u_deg").to_radians();
        let origin = DVec3::new(0.0, 0.0, radius - from);
        // A packet that starts inside knows that it is in the glass from the scene itself.
        let direction = DVec3::new(u.sin(), 0.0, u.cos());
        let mut inside = shot_inside(&compiled, origin, direction);
        inside.origin *= 1e3;
        close(crossing(&inside) - radius, -image, 1e-9, &format!("{id} u {u}"));
        let out = inside.direction.x.atan2(inside.direction.z).to_degrees();
        close(out, number(value, "u_out_deg"), 1e-9, &format!("{id} u' {u}"));
    }
}

/// As [`through`] for a start inside a solid: mm in, m out.
fn shot_inside(compiled: &Compiled, from: DVec3, direction: DVec3) -> Ray {
    let out = crate::lab::shot_from(compiled, Ray { origin: 1e-3 * from, direction }).brightest();
    Ray { origin: out.origin + compiled.scene.shift, ..out }
}

#[test]
fn len_03_aplanatic_points() {
    aplanatic("LEN-03");
    aplanatic("LEN-03x");
}

#[test]
fn len_04_stigmatic_conics() {
    let case = Case::load("LEN-04");
    let (f, diameter) = (case.given("/paraboloid/f"), case.given("/paraboloid/D"));
    let mirror = format!(
        "\"mirror\": (body: Mirror(form: Conic(radius: \"{:?} mm\", conic: -1), diameter: \"{diameter:?} mm\")),",
        -2.0 * f
    );
    let sections = around(&mirror, 1.5)
        .replace("default:", "surfaces: [(on: Node(\"mirror\"), specular: Mirror(reflectance: 1))], default:");
    let compiled = system(&sections, "");
    let (n, radius) = (case.given("/plano_hyperbolic/n"), case.given("/plano_hyperbolic/R"));
    let back = format!("Conic(radius: \"{radius:?} mm\", conic: {:?})", case.given("/plano_hyperbolic/conic"));
    let lens = system(&around(&singlet("Plane", &back, 12.0, case.given("/plano_hyperbolic/D")), n), "");
    let (mut worst, mut count) = ([0f64; 2], 0);
    for i in 0..200 {
        let r = (f64::from(i) + 0.5) / 200.0;
        let at = |size: f64| {
            let (sin, cos) = (2.4 * f64::from(i)).sin_cos();
            size * r.sqrt() * DVec3::new(cos, sin, 0.0)
        };
        let spot =
            |ray: Ray, z: f64| (ray.origin + (z - ray.origin.z) / ray.direction.z * ray.direction).truncate().length();
        let reflected = through(&compiled, at(0.5 * diameter) - 200.0 * DVec3::Z, DVec3::Z);
        let refracted = through(&lens, at(0.5 * case.given("/plano_hyperbolic/D")) - 50.0 * DVec3::Z, DVec3::Z);
        worst[0] = worst[0].max(spot(reflected, -f));
        worst[1] = worst[1].max(spot(refracted, 12.0 + case.given("/plano_hyperbolic/f_back")));
        count += 1;
    }
    println!("LEN-04: {count} rays, farthest from the focus {:.1e} and {:.1e} mm", worst[0], worst[1]);
    assert!(worst.iter().all(|spot| *spot < case.tolerance("abs")));
}
