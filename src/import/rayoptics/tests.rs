use super::*;
use crate::prescription::{Curve, Material, Motion, Opening, Outline, Profile, Role, Term};
use glam::DVec3;

/// A singlet in inches, in the manner of the program.
const SINGLET: &str = r#"{"optical_model": {"attributes": {
"specsheet": {"s": -Infinity},
"system_spec": {"attributes": {"title": "A \"-Infinity\" lens", "_dimensions": "in"}},
"seq_model": {"attributes": {"stop_surface": 1, "ifcs": [
  {"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "dummy", "decenter": null, "profile_id": "0"}},
  {"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "transmit", "label": "front", "max_aperture": 0.5,
   "clear_apertures": [{"__instance_type__": ["m", "Circular"], "attributes": {"radius": 0.4, "y_offset": 0.1}}], "profile_id": "1"}},
  {"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "dummy", "profile_id": "0"}}],
 "gaps": [
  {"attributes": {"thi": 1e10, "medium": {"__instance_type__": ["m", "Air"], "attributes": {}}}},
  {"attributes": {"thi": 2.0, "medium": {"__instance_type__": ["m", "SchottGlass"], "attributes": {"gname": "N-BK7"}}}}]}},
"profile_dict": {"0": {"__instance_type__": ["m", "Spherical"], "attributes": {"cv": 0.0}},
 "1": {"__instance_type__": ["m", "EvenPolynomial"], "attributes": {"cv": 0.5, "cc": -1.0, "coefs": [0.0, 3e-3]}}},
"optical_spec": {"attributes": {
 "spectral_region": {"attributes": {"wavelengths": [550.0], "spectral_wts": [1.0], "reference_wvl": 0}},
 "pupil": {"attributes": {"_key": ["aperture", "object", "epd"], "value": 0.5}},
 "field_of_view": {"attributes": {"key": ["field", "object", "angle"], "is_relative": true, "value": 10.0,
  "fields": [{"attributes": {"x": 0.0, "y": 0.5, "vuy": 0.1}}]}}}}}}}"#;

fn changed(from: &str, to: &str) -> Result<Prescription, Vec<Problem>> {
    let text = SINGLET.replacen(from, to, 1);
    assert_ne!(text, SINGLET, "nothing changed by {from:?}");
    parse(&text)
}

#[test]
fn a_singlet_is_read_in_si_units() {
    let lens = parse(SINGLET).expect("a lens");
    assert_eq!((lens.name.as_str(), lens.stop), ("A \"-Infinity\" lens", Some(1)));
    assert_eq!(lens.aperture, Aperture::EntrancePupil(0.5 * 0.0254));
    assert_eq!(lens.fields[0].point, FieldPoint::ObjectAngle([0.0, 5.0_f64.to_radians()]));
    let front = &lens.surfaces[1];
    let terms = vec![Term { power: 4, coefficient: 3e-3 * 0.0254_f64.powi(-3) }];
    assert_eq!(front.profile, Profile::Revolved(Curve { curvature: 0.5 / 0.0254, conic: -1.0, terms }));
    assert_eq!((front.thickness, front.semi_diameter), (2.0 * 0.0254, Some(0.5 * 0.0254)));
    assert_eq!(front.material, Material::Glass { name: "N-BK7".into(), maker: Some("SCHOTT".into()) });
    let clear = Opening { role: Role::Clear, outline: Outline::Circle(0.4 * 0.0254), centre: [0.0, 0.1 * 0.0254] };
    assert_eq!(front.openings, [clear]);
    assert!(lens.notes.is_empty() && lens.surfaces[0].thickness.is_infinite());
}

#[test]
fn media_of_all_classes_are_read() {
    let glass = r#"{"__instance_type__": ["m", "SchottGlass"], "attributes": {"gname": "N-BK7"}}"#;
    let medium = |class: &str, attributes: &str| {
        let to = format!(r#"{{"__instance_type__": ["m", "{class}"], "attributes": {attributes}}}"#);
        changed(glass, &to).map(|lens| lens.surfaces[1].material.clone())
    };
    let model = medium("ModelGlass", r#"{"n": 1.5, "v": 60.0}"#).expect("a glass");
    assert_eq!(model, Material::Model { nd: 1.5, vd: 60.0 });
    let table =
        medium("InterpolatedMedium", r#"{"label": "x", "wvls": [600, 500], "rndx": [1.5, 1.6]}"#).expect("a glass");
    assert!(matches!(table, Material::Private { indices, .. } if indices[0].1 == 1.6));
    assert!(medium("Metal", "{}").is_err());
}

#[test]
fn a_bend_turns_twice() {
    let bend = r#""decenter": {"attributes": {"dtype": "bend", "dec": {"__ndarray__": [0, 1, 0]}, "euler": [45, 0, 0]}}, "label""#;
    let lens = changed(r#""label""#, bend).expect("a lens");
    let turn = Motion::turn(DVec3::new(-45_f64.to_radians(), 0.0, 0.0));
    assert_eq!(lens.surfaces[1].after, turn);
    assert_eq!(lens.surfaces[1].before, Motion::shift(DVec3::Y * 0.0254).then(turn));
}

#[test]
fn every_defect_is_named_with_its_path() {
    for (from, to, words) in [
        ("\"in\"", "\"ell\"", "optical_model.attributes.system_spec.attributes._dimensions: no unit \"ell\""),
        ("\"thi\": 2.0", "\"thi\": \"2\"", "gaps[1].attributes.thi: is no number"),
        ("EvenPolynomial", "Zernike", "profile_dict.1: no profile \"Zernike\""),
        ("\"reference_wvl\": 0", "\"reference_wvl\": 4", "reference wavelength"),
        ("\"epd\"", "\"f/#\"", "no f/# at the object"),
        ("\"angle\"", "\"colour\"", "no colour"),
        ("\"label\": \"front\"", "\"phase_element\": {}", "phase element"),
        ("\"specsheet\": {", "\"specsheet\": [", "is no JSON"),
    ] {
        let problem = changed(from, to).expect_err(to).remove(0);
        assert!(problem.to_string().contains(words), "{to:?}: {problem}");
    }
    let defocus = r#""defocus": {"attributes": {"focus_shift": 0.1}}, "pupil""#;
    assert!(changed("\"pupil\"", defocus).expect("a lens").notes[0].text.contains("focus shift"));
    let notes = changed("\"specsheet\"", "\"coatings\"").expect("a lens").notes;
    assert_eq!(notes[0].text, "coatings: not known here, not translated");
}
