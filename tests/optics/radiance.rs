//! Etendue and radiance through exact surfaces.

use crate::lab::{close, shot, system};
use crate::lenses::{around, ball, form, singlet, through};
use crate::support::{Case, case::number};
use glam::DVec3;
use std::f64::consts::PI;
use straylight::geometry::Ray;
use straylight::system::compile::Compiled;

type Phase = [f64; 4];

/// A ray (x, y, L, M) from plane to plane, mm.
fn mapped(compiled: &Compiled, [x, y, l, m]: Phase, planes: [f64; 2]) -> Phase {
    let direction = DVec3::new(l, m, (1.0 - l * l - m * m).sqrt());
    let out = through(compiled, DVec3::new(x, y, planes[0]), direction);
    let p = out.origin + (planes[1] - out.origin.z) / out.direction.z * out.direction;
    [p.x, p.y, out.direction.x, out.direction.y]
}

/// Fourth-order central differences.
fn jacobian(map: impl Fn(Phase) -> Phase, at: Phase, h: f64) -> [Phase; 4] {
    std::array::from_fn(|column| {
        let shifted = |steps: f64| {
            let mut to = at;
            to[column] += steps * h;
            map(to)
        };
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(shifted);
        std::array::from_fn(|row| (a[row] - 8.0 * b[row] + 8.0 * c[row] - d[row]) / (12.0 * h))
    })
}

/// J^T W J - W, W the symplectic form of (x, y, L, M): zero if etendue is conserved in every plane.
fn asymmetry(j: &[Phase; 4]) -> f64 {
    let form = |a: &Phase, b: &Phase| a[0] * b[2] - a[2] * b[0] + a[1] * b[3] - a[3] * b[1];
    let mut worst = 0f64;
    for (i, k) in (0..4).flat_map(|i| (0..4).map(move |k| (i, k))) {
        let wanted = match (i, k) {
            (0, 2) | (1, 3) => 1.0,
            (2, 0) | (3, 1) => -1.0,
            _ => 0.0,
        };
        worst = worst.max((form(&j[i], &j[k]) - wanted).abs());
    }
    worst
}

fn determinant(j: &[Phase; 4]) -> f64 {
    glam::DMat4::from_cols_array_2d(j).determinant()
}

#[test]
fn rad_05_etendue_through_a_thick_lens() {
    let case = Case::load("RAD-05");
    let lens =
        singlet(&form(case.setup("/lens/R1")), &form(case.setup("/lens/R2")), case.given("/lens/thickness"), 30.0);
    let compiled = system(&around(&lens, case.given("/lens/n")), "");
    let planes = [case.given("/start_plane_z"), case.given("/end_plane_z")];
    for value in case.values() {
        let phase = |name: &str| -> Phase {
            let list = value[name].as_array().expect("a ray");
            std::array::from_fn(|i| list[i].as_f64().expect("a number"))
        };
        let (from, wanted) = (phase("ray_in"), phase("ray_out"));
        let found = mapped(&compiled, from, planes);
        (0..4).for_each(|i| close(found[i], wanted[i], 1e-9, &format!("RAD-05 {from:?} [{i}]")));
        let j = jacobian(|ray| mapped(&compiled, ray, planes), from, 1e-4);
        close(determinant(&j), 1.0, case.tolerance("abs"), &format!("RAD-05 {from:?} det"));
        close(asymmetry(&j), 0.0, case.tolerance("abs"), &format!("RAD-05 {from:?} symplectic"));
    }
}

/// Etendue through every form of surface, in skew rays.
#[test]
fn etendue_is_conserved_by_every_form() {
    let forms = [
        "Conic(radius: \"60 mm\", conic: -2.3)",
        "Conic(radius: \"-60 mm\", conic: 1.5)",
        "Asphere(radius: \"50 mm\", conic: -0.5, terms: [(4, \"2e-6 mm^-3\"), (3, \"1e-5 mm^-2\"), (6, \"-3e-9 mm^-5\")])",
        "Polynomial(radius: \"80 mm\", terms: [((2, 0), \"1e-3 mm^-1\"), ((1, 2), \"2e-5 mm^-2\"), ((0, 3), \"1e-5 mm^-2\")])",
        "Toroid(radius: \"50 mm\", conic: -0.4, terms: [(4, \"1e-6 mm^-3\")], rotation: \"90 mm\")",
        "Toroid(radius: \"50 mm\")",
    ];
    for front in forms {
        let compiled = system(&around(&singlet(front, "Sphere(radius: \"-70 mm\")", 12.0, 30.0), 1.5168), "");
        for from in [[2.0, -3.0, 0.02, 0.05], [-8.0, 6.0, 0.06, -0.03], [0.3, 0.2, -0.1, 0.1]] {
            let j = jacobian(|ray| mapped(&compiled, ray, [-20.0, 60.0]), from, 1e-4);
            assert!(
                (determinant(&j) - 1.0).abs() < 1e-6 && asymmetry(&j) < 1e-6,
                "{front} {from:?}: {} {}",
                determinant(&j),
                asymmetry(&j)
            );
        }
    }
}

/// What a sphere passes on the direct way at half its radius: T^2, and the radiance behind it is T^2 of that before.
#[test]
fn rad_06_basic_radiance_through_a_sphere() {
    let case = Case::load("RAD-06");
    let value = case.values().into_iter().find(|v| v["kind"] == "sphere").expect("a sphere");
    let n = number(&value, "n");
    let compiled = system(&around(&ball(10.0), n), "");
    let height = 10.0 * number(&value, "b_over_R");
    let trace = shot(&compiled, &[Ray { origin: 1e-3 * DVec3::new(0.0, height, -50.0), direction: DVec3::Z }]);
    let sights = trace.at(&compiled, "lens.front");
    close(sights[0].angle.to_degrees(), number(&value, "theta_i_deg"), 1e-9, "RAD-06 angle");
    let direct = trace.seen.escaped.iter().map(|(_, flux)| *flux).fold(0.0, f64::max);
    close(direct, number(&value, "L_exit_direct_pass"), 1e-9, "RAD-06 sphere T^2");
    // The bundle keeps its etendue, so radiance is flux: det = 1 through the ball, n^2 inside.
    let j = jacobian(|ray| mapped(&compiled, ray, [-20.0, 40.0]), [0.0, height, 0.0, 0.0], 1e-4);
    close(direct * n * n / determinant(&j), number(&value, "L_inside_no_loss") * direct, 1e-6, "RAD-06 n^2 L");
}

/// A slab of plane faces, straight and at 45 degrees: n^2 T L inside, T^2 L behind.
#[test]
fn rad_06_basic_radiance_through_a_slab() {
    for value in Case::load("RAD-06").values().into_iter().filter(|v| v["kind"] == "slab") {
        let (n, angle) = (number(&value, "n"), number(&value, "theta").to_radians());
        let compiled = system(&around(&singlet("Plane", "Plane", 10.0, 80.0), n), "");
        let direction = DVec3::new(0.0, angle.sin(), angle.cos());
        let trace = shot(&compiled, &[Ray { origin: -0.05 * direction, direction }]);
        let inside = trace.at(&compiled, "lens.back")[0].flux;
        close(n * n * inside, number(&value, "L_inside_single_pass"), 1e-9, "RAD-06 slab, inside");
        let direct = trace.seen.escaped.iter().map(|(_, flux)| *flux).fold(0.0, f64::max);
        close(direct, number(&value, "L_exit_with_TsTp_avg"), 1e-9, "RAD-06 slab, behind");
    }
}

/// A wedge turns the beam and makes it wider or narrower as the cosines say; its radiance stays T^2 L.
#[test]
fn rad_06_basic_radiance_through_a_wedge() {
    let case = Case::load("RAD-06");
    let value = case.values().into_iter().find(|v| v["kind"] == "wedge").expect("a wedge");
    let (apex, angle) = (number(&value, "apex").to_radians(), number(&value, "theta").to_radians());
    let element = format!(
        "\"wedge\": (body: Prism(corners: [(\"0 mm\", \"0 mm\"), (\"-40 mm\", \"0 mm\"), (\"-40 mm\", \"{:?} mm\")], \
         length: \"12 mm\", medium: \"glass\")),",
        40.0 * apex.tan()
    );
    let compiled = system(&around(&element, number(&value, "n")), "");
    let direction = DVec3::new(0.0, angle.sin(), angle.cos());
    let across = DVec3::new(0.0, angle.cos(), -angle.sin());
    let sent = |offset: f64| {
        let origin = DVec3::new(0.0, -0.02, 0.0) - 0.05 * direction + offset * across;
        let out = shot(&compiled, &[Ray { origin, direction }]).seen.escaped;
        out.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("it passes")
    };
    let (ray, flux) = sent(0.0);
    close(flux, number(&value, "L_exit"), 1e-9, "RAD-06 wedge, behind");
    let deviation = ray.direction.angle_between(direction).to_degrees();
    close(deviation, number(&value, "deviation_deg"), 1e-9, "RAD-06 wedge, deviation");
    let normal = DVec3::new(0.0, apex.sin(), apex.cos());
    let exit = ray.direction.angle_between(normal).to_degrees();
    close(exit, number(&value, "theta_exit_deg").abs(), 1e-9, "RAD-06 wedge, exit angle");
    // Two rays 1 mm apart before; behind, their distance across the beam.
    let apart = (sent(0.001).0.origin - ray.origin).cross(ray.direction).length();
    close(apart / 0.001, number(&value, "anamorphic_beam_compression"), 1e-9, "RAD-06 wedge, width");
}

/// The immersed detector sees n^2 T of the hemisphere's radiance: by reversing rays from it, exact surface and all.
#[test]
fn rad_07_hemispherical_immersion_lens() {
    let case = Case::load("RAD-07");
    let (n, radius) = (case.given("/lens/n"), case.given("/lens/R"));
    let side = format!("Sphere(radius: \"{radius:?} mm\")");
    let elements = format!(
        "{}\"fpa\": (body: Aperture(diameter: \"0 mm\", outer: \"{:?} mm\"), at: \"(0, 0, {radius:?}) mm\"),
        \"flat\": (body: Aperture(diameter: \"{:?} mm\", outer: \"{:?} mm\"), at: \"(0, 0, {radius:?}) mm\"),
        \"sky\": (body: Mirror(form: Sphere(radius: \"22 mm\"), diameter: \"44 mm\"), at: \"(0, 0, {:?}) mm\"),",
        singlet(&side, "Plane", radius, 2.0 * radius),
        2.0 * case.given("/detector/radius"),
        2.0 * case.given("/detector/radius"),
        2.0 * radius,
        radius - 22.0,
    );
    // A sky close to the lens: its radiance is the same from everywhere, so its size does not matter.
    let sections = around(&elements, n)
        .replace("extent: Point, at: \"(0, 0, -1000) mm\",", "extent: Node(name: \"sky\", side: Back),")
        .replace("Collimated(direction: \"(0, 0, 1)\")", "Lambertian")
        .replace(crate::lab::CERTAIN, "run: (rays: 600000, seed: 3, paths: 0),")
        .replace(
            "default:",
            "detectors: { \"fpa\": (on: Node(\"fpa\"), quantity: Irradiance, side: Front) }, default:",
        );
    let compiled = system(&sections, "");
    let results = crate::lab::traced(&compiled);
    let flux = &results.detectors["fpa"].flux_w;
    let (sky, detector) = (2.0 * PI * 22.0 * 22.0, PI * case.given("/detector/radius").powi(2));
    // Exitance pi L = 1 W / sky.
    let gain = sky / detector;
    let (found, error) = (flux.mean * gain, flux.error * gain);
    let wanted = case.named("E/(pi L)");
    println!("RAD-07 E/(pi L) {found:.4} +- {error:.4}, reference {wanted:.4}");
    assert!(error < 0.03 * wanted && (found - wanted).abs() < 4.0 * error, "{found} +- {error}");
}

/// A pair of stigmatic lenses images a Lambertian disc: E = pi L sin^2 u', whatever is between.
fn image_irradiance(id: &str) {
    let case = Case::load(id);
    let (object, image, n) = (case.given("/object_distance"), case.given("/image_distance"), 1.5168f64);
    let wanted = number(&case.values()[0], "E_over_piL_aplanatic");
    let tangent = (wanted / (1.0 - wanted)).sqrt();
    let hyperboloid = |f: f64| format!("Conic(radius: \"{:?} mm\", conic: {:?})", (n - 1.0) * f, -n * n);
    let stop = 0.8 * image;
    let elements = format!(
        "\"first\": (body: Lens(surfaces: [(form: {}), (form: Plane)], thickness: [\"15 mm\"], media: [\"glass\"], diameter: \"64 mm\")),
         \"second\": (body: Lens(surfaces: [(form: Plane), (form: {})], thickness: [\"15 mm\"], media: [\"glass\"], diameter: \"64 mm\"),
            at: \"(0, 0, 20) mm\"),
         \"stop\": (body: Aperture(diameter: \"{:?} mm\", outer: \"200 mm\"), at: \"(0, 0, {:?}) mm\"),
         \"fpa\": (body: Aperture(diameter: \"0 mm\", outer: \"1 mm\"), at: \"(0, 0, {:?}) mm\"),
         \"lamp\": (body: Aperture(diameter: \"0 mm\", outer: \"6 mm\"), at: \"(0, 0, {:?}) mm\"),",
        hyperboloid(object),
        hyperboloid(-image),
        2.0 * tangent * stop,
        35.0 + image - stop,
        35.0 + image,
        -object
    );
    let half: f64 = 9.0;
    let sections = around(&elements, n)
        .replace("extent: Point, at: \"(0, 0, -1000) mm\",", "extent: Node(name: \"lamp\", side: Back),")
        .replace("Collimated(direction: \"(0, 0, 1)\")", &format!("AngularDiameter(\"{} deg\")", 2.0 * half))
        .replace(crate::lab::CERTAIN, "run: (rays: 1000000, seed: 5, paths: 0),")
        .replace(
            "default:",
            "surfaces: [(on: Any([Tag(\"*.front\"), Tag(\"*.back\")]), specular: Absorb),
                (on: Any([Tag(\"first.front\"), Tag(\"first.back\"), Tag(\"second.front\"), Tag(\"second.back\")]),
                    specular: Ideal(reflectance: 0, transmittance: 1))],
             detectors: { \"fpa\": (on: Node(\"fpa\"), quantity: Irradiance, side: Front) }, default:",
        );
    let compiled = system(&sections, "");
    let flux = &crate::lab::traced(&compiled).detectors["fpa"].flux_w;
    // pi L = 1 W / (lamp area x sin^2 of the half angle); areas 9 pi and pi / 4 mm2.
    let gain = 9.0 * half.to_radians().sin().powi(2) / 0.25;
    let (found, error) = (flux.mean * gain, flux.error * gain);
    println!("{id} E/(pi L) {found:.6} +- {error:.6}, reference {wanted:.6}");
    // The polygon that the lamp's facets are is 0.07 % smaller than its disc.
    assert!(error < 0.02 * wanted && (found - wanted).abs() < 4.0 * error + 1e-3 * wanted, "{found} +- {error}");
}

#[test]
fn len_06_image_irradiance() {
    image_irradiance("LEN-06");
    image_irradiance("LEN-06x");
}

/// The plano-convex lens of LEN-02 turned over by a mirrored node, and the light with it: the same rays, mirrored.
#[test]
fn geo_04_mirrored_instance() {
    use crate::meshes::Singlet;
    use crate::support::Model;
    let case = Case::load("LEN-02");
    assert_eq!(Case::load("GEO-04").values()[0]["same_as"], "LEN-02");
    let lens = Singlet { curvature: [1.0 / case.given("/R1"), 0.0], thickness: case.given("/thickness"), half: 12.0 };
    let entry = |side: usize, z: f64| {
        format!(
            "(on: Faces(of: \"lens\", where: Normal(direction: \"(0, 0, {})\", within: \"20 deg\")), exact: (form: {}, \
             vertex: \"(0, 0, {z:?}) mm\", relative: Node)),",
            if side == 0 { -1 } else { 1 },
            lens.form(side)
        )
    };
    let mirrored = |entries: &str| {
        entries.replace("(0, 0, -1)", "(0, 0, 9)").replace("(0, 0, 1)", "(0, 0, -1)").replace("(0, 0, 9)", "(0, 0, 1)")
    };
    let entries = entry(0, 0.0) + &entry(1, lens.thickness);
    let gltf = Model::new().add("lens", lens.mesh(6, 64)).gltf();
    let plain = system(&lens.sections(&entries, case.given("/n")), &gltf);
    let turned = crate::lab::scaled_node(&gltf, "lens", DVec3::new(1.0, 1.0, -1.0));
    // The form is written in the node's coordinates; its radius counts along the node's mirrored axis.
    let turned = system(&lens.sections(&mirrored(&entries), case.given("/n")), &turned);
    for y in case.list("/ray_heights") {
        let a = through(&plain, DVec3::new(0.3, y, -50.0), DVec3::Z);
        let b = through(&turned, DVec3::new(0.3, y, 50.0), -DVec3::Z);
        let back = DVec3::new(1.0, 1.0, -1.0);
        assert!(
            (a.origin - back * b.origin).length() < 1e-9 && (a.direction - back * b.direction).length() < 1e-12,
            "{a:?} {b:?}"
        );
    }
}
