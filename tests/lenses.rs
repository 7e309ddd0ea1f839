//! Lens files that others wrote, read and traced: first-order data against ray-optics, places of tilted surfaces, damage.
//!
//! `tests/data/lenses/expected.json` says how its values were made; the indices of the glasses are those that ray-optics took.

use glam::{DVec2, DVec3};
use serde_json::Value;
use std::path::{Path, PathBuf};
use straylight::import;
use straylight::prescription::paraxial::{FirstOrder, first_order};
use straylight::prescription::real::{field_ray, semi_diameters, trace};
use straylight::prescription::{Curve, Field, FieldPoint, Material, Outline, Prescription, Profile, Role};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/lenses")
}

fn lens(name: &str) -> Prescription {
    import::read(&folder().join(name)).unwrap_or_else(|problems| panic!("{name}: {}", problems[0]))
}

/// Names and expected values of all files.
fn expected() -> Vec<(String, Value)> {
    let text = std::fs::read_to_string(folder().join("expected.json")).expect("expected.json");
    let table: serde_json::Map<String, Value> = serde_json::from_str(&text).expect("JSON");
    assert_eq!(table.len(), 15);
    table.into_iter().collect()
}

/// First-order data with the indices of the table.
fn optics(lens: &Prescription, table: &Value) -> FirstOrder {
    first_order(lens, &|material, _| index(lens, table, material)).expect("first-order data")
}

fn index(lens: &Prescription, table: &Value, material: &Material) -> Option<f64> {
    let space = (0..lens.surfaces.len()).find(|i| lens.medium(*i) == material)?;
    table["indices"].get(space)?.as_f64()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// To a millionth of the value or of `scale`: what ray-optics takes for an object at infinity is 1e7 to 1e11 units away.
fn assert_close(what: &str, found: f64, expected: f64, scale: f64) {
    assert!((found - expected).abs() <= 1e-6 * scale.max(expected.abs()), "{what}: found {found}, expected {expected}");
}

#[test]
fn first_order_data_are_those_of_ray_optics() {
    for (name, table) in expected() {
        let lens = lens(&name);
        assert_close(&name, lens.wavelength(), number(&table["wavelength"]), 0.0);
        let optics = optics(&lens, &table);
        let focal_length = number(&table["image_index"]).signum() * number(&table["focal_length"]);
        assert_close(&format!("{name}: focal length"), optics.focal_length, focal_length, 0.0);
        for (key, found) in [
            ("back_focal_length", optics.back_focal_length),
            ("front_focal_length", optics.front_focal_length),
            ("image_distance", optics.image_distance),
        ] {
            assert_close(&format!("{name}: {key}"), found, number(&table[key]), focal_length.abs());
        }
    }
}

/// The file with an aperture at the object is left out: ray-optics takes the sine for the slope.
#[test]
fn pupils_are_those_of_ray_optics() {
    for (name, table) in expected().into_iter().filter(|(name, _)| !name.starts_with("US05831776")) {
        let lens = lens(&name);
        let optics = optics(&lens, &table);
        let scale = optics.focal_length.abs();
        let (entrance, exit) = (&table["entrance_pupil"], &table["exit_pupil"]);
        assert_close(&name, optics.entrance_pupil.position, number(&entrance[0]), scale);
        assert_close(&name, optics.entrance_pupil.diameter / 2.0, number(&entrance[1]), 0.0);
        assert_close(&name, optics.exit_pupil.diameter / 2.0, number(&exit[1]), 0.0);
        // Its distance to the exit pupil is that from the image plane as written, laid off from the paraxial one.
        let plane = lens.surfaces[lens.surfaces.len() - 2].thickness;
        let expected = number(&exit[0]) - number(&table["image_distance"]) + plane;
        assert_close(&name, optics.exit_pupil.position, expected, scale);
        assert_close(&name, optics.working_f_number, number(&table["f_number"]), 0.0);
    }
}

/// Two files are left out: in one, ray-optics means a height in a plane out of focus; the other's only field is the axis.
#[test]
fn image_heights_are_those_of_ray_optics() {
    let out = ["US05831776-1.zmx", "telephoto.roa", "folded_lenses.seq"];
    for (name, table) in expected().into_iter().filter(|(name, _)| !out.contains(&name.as_str())) {
        let optics = optics(&lens(&name), &table);
        assert_close(&name, optics.image_height.abs(), number(&table["image_height"]).abs(), 0.0);
    }
}

/// ray-optics turns Zemax's coordinate breaks the other way round; `the_chief_ray_meets_the_detector` says which is right.
#[test]
fn surfaces_lie_where_ray_optics_puts_them() {
    let broken = ["HoO-V2C18Ex46.zmx", "HoO-V2C18Ex66.zmx"];
    for (name, table) in expected() {
        let mirror = if broken.contains(&name.as_str()) { DVec3::new(1.0, -1.0, 1.0) } else { DVec3::ONE };
        let frames = lens(&name).frames();
        for (i, place) in table["vertices"].as_array().expect("vertices").iter().enumerate() {
            let place = DVec3::from_array([0, 1, 2].map(|k| number(&place[k])));
            let found = frames[i + 1].shift;
            if !(broken[0] == name && i + 1 >= 10) {
                assert!((found - place * mirror).length() < 1e-12, "{name}: surface {}: {found} {place}", i + 1);
            }
        }
    }
}

/// Zemax found the decentre of the detector from the chief ray; so that ray says which way tilts turn.
#[test]
fn the_chief_ray_meets_the_detector() {
    for (name, table) in expected().into_iter().filter(|(name, _)| name.contains("Ex46") || name.contains("Ex66")) {
        let lens = lens(&name);
        let optics = optics(&lens, &table);
        let indices = vec![1.0; lens.surfaces.len()];
        let axis = Field { point: FieldPoint::ObjectAngle([0.0, 0.0]), vignetting: Default::default() };
        let ray = field_ray(&lens, &optics, &axis, DVec2::ZERO).expect("a pupil");
        let rays = trace(&lens, &indices, ray).expect("the chief ray gets through");
        let end = rays.last().expect("the image").origin;
        assert!(end.length() < 1e-6, "{name}: {end}");
    }
}

#[test]
fn radii_from_rays_are_those_of_the_file() {
    let (name, table) = expected().into_iter().find(|(name, _)| name == "sasian_triplet.roa").expect("the triplet");
    let lens = lens(&name);
    let radii = semi_diameters(&lens, &|material, _| index(&lens, &table, material)).expect("radii");
    for (i, (surface, radius)) in lens.surfaces.iter().zip(radii).enumerate().skip(1) {
        let written = surface.semi_diameter.expect("a radius");
        // ray-optics aims at the real stop, here rays go to the paraxial pupil.
        assert!((radius - written).abs() < 0.06 * written, "surface {i}: {radius} {written}");
    }
}

#[test]
fn the_questar_has_its_hole_and_its_obscuration() {
    let lens = lens("questar35.seq");
    let inch = 0.0254;
    let roles = |i: usize| lens.surfaces[i].openings.iter().map(|o| (o.role, o.outline)).collect::<Vec<_>>();
    assert_eq!(roles(1), [(Role::Clear, Outline::Circle(1.751968503937008 * inch))]);
    assert_eq!(roles(2), [(Role::Obscured, Outline::Circle(0.3825432833412954 * inch))]);
    assert_eq!(roles(3), [(Role::Hole, Outline::Circle(0.3757121532816294 * inch))]);
    assert_eq!((lens.name.as_str(), lens.stop), ("Questar 3.5\"", Some(3)));
    assert_eq!(lens.surfaces[0].thickness, f64::INFINITY);
    // The substrate of the primary is said by CUM and THM, and is not translated.
    assert_eq!(lens.notes.iter().map(|note| note.line).collect::<Vec<_>>(), [Some(25), Some(25)]);
}

#[test]
fn a_toroid_and_aspheres_are_read() {
    let ex46 = lens("HoO-V2C18Ex46.zmx");
    let toroid = Profile::Toroid { curve: Curve::sphere(0.000956278927437555 / 1e-3), radius: 1.035 };
    assert_eq!(ex46.surfaces[7].profile, toroid);
    let ex27 = lens("HoO-V2C18Ex27.zmx");
    let Profile::Revolved(curve) = &ex27.surfaces[1].profile else { panic!("a surface of revolution") };
    let (z, r) = (curve.at(0.005).expect("on the plate").0, 5.0_f64);
    assert!((z - 1e-3 * (-1.928e-5 * r.powi(4) + 2.98e-8 * r.powi(6))).abs() < 1e-17);
    assert_eq!(ex27.surfaces[1].material, Material::Model { nd: 1.489, vd: 57.4 });
}

#[test]
fn what_is_not_translated_is_noted() {
    let text = |name: &str| lens(name).notes.iter().map(|n| n.text.clone()).collect::<Vec<_>>().join("\n");
    let litho = text("US05831776-1.zmx");
    assert!(litho.contains("telecentric") && litho.contains("real image heights"), "{litho}");
    for (name, _) in expected().iter().filter(|(name, _)| !name.starts_with("US") && !name.starts_with("questar")) {
        assert_eq!(text(name), "", "{name}");
    }
}

#[test]
fn a_zemax_file_reads_the_same_in_every_encoding() {
    let name = "HoO-V2C18Ex66.zmx";
    let narrow = std::fs::read(folder().join(name)).expect("the file");
    let text = String::from_utf8(narrow).expect("ASCII");
    let wide = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(unit).collect()
    };
    for bytes in [wide(u16::to_le_bytes), wide(u16::to_be_bytes)] {
        assert_eq!(import::parse(&bytes, name).expect("a lens"), lens(name));
    }
}

/// Cut short, with bytes overwritten, with lines left out: read or refused, never a panic.
#[test]
fn damage_is_refused_not_suffered() {
    for (name, table) in expected() {
        let bytes = std::fs::read(folder().join(&name)).expect("the file");
        let step = (bytes.len() / 150).max(1);
        let try_out = |bytes: &[u8]| match import::parse(bytes, &name) {
            Ok(lens) => {
                let _ = semi_diameters(&lens, &|material, _| index(&lens, &table, material));
                let _ = lens.frames();
            }
            Err(problems) => assert!(!problems.is_empty(), "{name}: refused without a reason"),
        };
        for at in (0..bytes.len()).step_by(step) {
            try_out(&bytes[..at]);
            for (k, garbage) in
                [b"\0\xff\xfe".as_slice(), b"-1e999", b"\"", b"9999999999", b" S ;\n"].iter().enumerate()
            {
                let mut damaged = bytes.clone();
                let end = (at + k + garbage.len()).min(bytes.len());
                damaged.splice((at + k).min(end)..end, garbage.iter().copied());
                try_out(&damaged);
            }
        }
        let lines: Vec<&[u8]> = bytes.split(|b| *b == b'\n').collect();
        for left_out in (0..lines.len()).step_by((lines.len() / 100).max(1)) {
            let kept: Vec<&[u8]> = lines.iter().enumerate().filter(|(i, _)| *i != left_out).map(|(_, l)| *l).collect();
            try_out(&kept.join(&b'\n'));
        }
    }
}
