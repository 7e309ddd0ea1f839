use super::*;
use crate::prescription::{Aperture, FieldPoint, Material, Motion, Opening, Outline, Profile, Role, Term};
use glam::{DMat3, DVec3};

const SINGLET: &str = "VERS 1\nMODE SEQ\nNAME A lens\nUNIT MM X\nENPD 10\nENVD 20 1 0\nGCAT SCHOTT\nFTYP 0 0 2 1\nXFLN 0 0\nYFLN 0 5\n\
WAVM 1 0.55 1\nWAVM 2 0.65 1\nPWAV 1\nSURF 0\n  TYPE STANDARD\n  DISZ INFINITY\nSURF 1\n  STOP\n  TYPE STANDARD\n  CURV 0.02\n  DISZ 4\n  \
GLAS N-BK7 0 0 1.5 40\n  DIAM 5.5 1\nSURF 2\n  CURV -0.02\n  DISZ 48\nSURF 3\n  DISZ 0\nEFFL 0 1 2 3\nMNUM 1 1\n";

fn changed(from: &str, to: &str) -> Result<Prescription, Vec<Problem>> {
    let text = SINGLET.replacen(from, to, 1);
    assert_ne!(text, SINGLET, "nothing changed by {from:?}");
    parse(&text)
}

#[test]
fn a_singlet_is_read_in_si_units() {
    let lens = parse(SINGLET).expect("a lens");
    assert_eq!((lens.name.as_str(), lens.stop, lens.primary), ("A lens", Some(1), 0));
    assert_eq!(lens.aperture, Aperture::EntrancePupil(0.01));
    assert_eq!(lens.wavelengths, [(0.55e-6, 1.0)]);
    assert_eq!(lens.fields[1].point, FieldPoint::ObjectAngle([0.0, 5.0_f64.to_radians()]));
    let front = &lens.surfaces[1];
    assert_eq!(front.profile, Profile::sphere(0.02 / 1e-3));
    assert_eq!((front.thickness, front.semi_diameter), (0.004, Some(0.0055)));
    assert_eq!(front.material, Material::Glass { name: "N-BK7".into(), maker: Some("SCHOTT".into()) });
    assert!(lens.notes.is_empty() && lens.surfaces[0].thickness.is_infinite());
}

#[test]
fn the_unit_scales_every_length() {
    let inch = changed("UNIT MM", "UNIT IN").expect("a lens");
    assert_eq!(inch.surfaces[1].thickness, 4.0 * 0.0254);
    assert_eq!(inch.aperture, Aperture::EntrancePupil(0.254));
    let metre = changed("UNIT MM", "UNIT METER").expect("a lens");
    assert_eq!(metre.surfaces[1].profile, Profile::sphere(0.02));
}

#[test]
fn every_kind_of_aperture_is_read() {
    for (line, aperture) in [
        ("FNUM 4 0", Aperture::ImageFNumber(4.0)),
        ("FNUM 4 1", Aperture::WorkingFNumber(4.0)),
        ("OBNA 0.1 0", Aperture::ObjectNa(0.1)),
        ("OBNA 30 1", Aperture::ObjectNa(30.0_f64.to_radians().sin())),
        ("FLOA", Aperture::Stop(0.0055)),
    ] {
        assert_eq!(changed("ENPD 10", line).expect("a lens").aperture, aperture, "{line}");
    }
}

#[test]
fn vignetting_is_the_share_of_each_side() {
    let lens = changed("PWAV", "VDYN 0 0.1\nVCYN 0 0.3\nPWAV").expect("a lens");
    let v = lens.fields[1].vignetting;
    assert!((v.upper - 0.2).abs() < 1e-15 && (v.lower - 0.4).abs() < 1e-15 && v.left == 0.0);
}

#[test]
fn coordinate_breaks_turn_and_turn_back() {
    let broken = |order: u32, sign: f64| {
        let tilts = [10.0, 20.0, 30.0].map(|a: f64| a * sign);
        let values = [sign, 2.0 * sign, tilts[0], tilts[1], tilts[2], f64::from(order)];
        let lines: Vec<String> = (1..).zip(values).map(|(i, v)| format!("  PARM {i} {v}\n")).collect();
        let lens = changed("SURF 2\n", &format!("SURF 2\n  TYPE COORDBRK\n{}", lines.concat())).expect("a lens");
        assert_eq!(lens.surfaces[2].material, Material::Previous);
        lens.surfaces[2].before
    };
    let there = broken(0, 1.0);
    assert_eq!(there.shift, DVec3::new(0.001, 0.002, 0.0));
    let home: Motion = there.then(broken(1, -1.0));
    assert!(home.shift.length() < 1e-18);
    assert!((home.turn - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-15));
}

#[test]
fn openings_keep_their_role_and_centre() {
    let lines = "  CLAP 1 5 0\n  OBDC 0.5 -0.5\n  SQOB 2 3 0\n  MEMA 7 0 0 0 1 \"\"\nSURF 2";
    let openings = changed("SURF 2", lines).expect("a lens").surfaces[1].openings.clone();
    let off = [0.5e-3, -0.5e-3];
    let opening = |role, outline, centre| Opening { role, outline, centre };
    let expected = [
        opening(Role::Clear, Outline::Circle(0.005), off),
        opening(Role::Obscured, Outline::Circle(0.001), off),
        opening(Role::Obscured, Outline::Rectangle(0.002, 0.003), off),
        opening(Role::Edge, Outline::Circle(0.007), [0.0; 2]),
    ];
    assert_eq!(openings, expected);
}

#[test]
fn polynomial_terms_have_their_powers() {
    let terms = |kind: &str| {
        let lens =
            changed("  TYPE STANDARD\n  CURV", &format!("  TYPE {kind}\n  PARM 3 2e-6\n  CURV")).expect("a lens");
        match &lens.surfaces[1].profile {
            Profile::Revolved(curve) => curve.terms.clone(),
            other => panic!("{other:?}"),
        }
    };
    let of = |power: u32| [Term { power, coefficient: 2e-6 * 1e-3_f64.powi(1 - power as i32) }];
    assert_eq!(terms("EVENASPH"), of(6));
    assert_eq!(terms("ODDASPHE"), of(3));
    let extended = changed("TYPE STANDARD\n  CURV", "TYPE XASPHERE\n  XDAT 1 2\n  XDAT 2 10\n  XDAT 4 0.5\n  CURV")
        .expect("a lens");
    let Profile::Revolved(curve) = &extended.surfaces[1].profile else { panic!("a surface of revolution") };
    let plain = Profile::sphere(20.0).at(glam::DVec2::X * 0.005).expect("on the sphere").0;
    assert!((curve.at(0.005).expect("on the surface").0 - plain - 0.5e-3 * 0.5_f64.powi(4)).abs() < 1e-18);
    let ideal = changed("  TYPE STANDARD\n  CURV", "  TYPE PARAXIAL\n  PARM 1 50\n  CURV").expect("a lens");
    assert_eq!(ideal.surfaces[1].profile, Profile::Thin { power: 1.0 / (50.0 * 1e-3) });
}

#[test]
fn what_is_left_out_is_noted_with_its_line() {
    let noted = |from: &str, to: &str| {
        let notes = changed(from, to).expect("a lens").notes;
        assert_eq!(notes.len(), 1, "{notes:?}");
        notes[0].clone()
    };
    let note = noted("  DIAM", "  COAT AR\n  DIAM");
    assert_eq!((note.line, note.text.as_str()), (Some(23), "COAT AR: not translated"));
    assert!(noted("MNUM 1 1", "MNUM 3 1").text.contains("several configurations"));
    assert!(noted("ENVD 20 1", "ENVD 40 1").text.contains("temperature"));
    assert_eq!(noted("  DIAM", "  XYZW 5\n  DIAM").line, Some(23));
    assert_eq!(noted("PWAV", "XYZW 5\nPWAV").line, Some(13));
    assert!(noted("  DIAM", "  PARM 4 1\n  DIAM").text.contains("no such parameter"));
}

#[test]
fn every_defect_is_named_with_its_place() {
    for (from, to, line, words) in [
        ("MODE SEQ", "MODE NSC", Some(2), "not sequential"),
        ("UNIT MM", "UNIT FURLONG", Some(4), "FURLONG"),
        ("UNIT MM X\n", "", None, "unit"),
        ("ENPD 10\n", "", None, "aperture"),
        ("ENPD 10", "ENPD -1", Some(5), "-1"),
        ("FTYP 0", "FTYP 4", Some(8), "kind 4"),
        ("PWAV 1", "PWAV 7", None, "reference wavelength"),
        ("SURF 2", "SURF 5", Some(24), "surface 5"),
        ("CURV 0.02", "CURV abc", Some(20), "abc"),
        ("CURV 0.02", "CURV NaN", Some(20), "NaN"),
        ("CURV 0.02", "CURV", Some(20), "ends too early"),
        ("TYPE STANDARD\n  CURV", "TYPE BINARY_2\n  CURV", Some(17), "BINARY_2"),
        ("TYPE STANDARD\n  CURV", "TYPE PARAXIAL\n  CURV", Some(17), "focal length"),
        ("  DIAM", "  XDAT 1 3\n  DIAM", Some(17), "further terms"),
        ("TYPE STANDARD\n  CURV", "TYPE XASPHERE\n  XDAT 1 3\n  CURV", Some(17), "radius of 0"),
        ("  DIAM", "  SCBD 1 0 0 0 0 90 0 0\n  DIAM", Some(23), "properties"),
        ("  DIAM", "  IGNR 1\n  DIAM", Some(23), "ignored"),
    ] {
        let problem = changed(from, to).expect_err(to).remove(0);
        assert!(problem.to_string().contains(words), "{to:?}: {problem}");
        assert_eq!(problem.span.map(|span| span.line), line, "{to:?}: {problem}");
    }
}
