use super::*;
use crate::prescription::{Aperture, FieldPoint, Material, Motion, Opening, Outline, Profile, Role, Term};
use glam::DVec3;

const SINGLET: &str = "rdm n;len 'v'\ntit 'A lens'\ndim m\nepd 10\nwl 650 550\nref 2\nyan 0 5\nvuy 0 0.2\nso 0 1e10\n\
s 0.02 4 nbk7_schott\nsto\ncir 5.5\ns -0.02 48\nsi 0 0\ngo\n";

fn changed(from: &str, to: &str) -> Result<Prescription, Vec<Problem>> {
    let text = SINGLET.replacen(from, to, 1);
    assert_ne!(text, SINGLET, "nothing changed by {from:?}");
    parse(&text)
}

#[test]
fn a_singlet_is_read_in_si_units() {
    let lens = parse(SINGLET).expect("a lens");
    assert_eq!((lens.name.as_str(), lens.stop, lens.primary), ("A lens", Some(1), 1));
    assert_eq!(lens.aperture, Aperture::EntrancePupil(0.01));
    assert!((lens.wavelength() - 550e-9).abs() < 1e-20);
    assert_eq!(lens.fields[1].point, FieldPoint::ObjectAngle([0.0, 5.0_f64.to_radians()]));
    assert_eq!((lens.fields[1].vignetting.upper, lens.fields[1].vignetting.lower), (0.2, 0.0));
    let front = &lens.surfaces[1];
    assert_eq!(front.profile, Profile::sphere(0.02 / 1e-3));
    assert_eq!((front.thickness, front.semi_diameter), (0.004, Some(0.0055)));
    assert_eq!(front.material, Material::Glass { name: "nbk7".into(), maker: Some("schott".into()) });
    assert!(lens.notes.is_empty() && lens.surfaces[0].thickness.is_infinite());
}

#[test]
fn longer_words_are_the_same_commands() {
    let long = SINGLET.replace("tit", "title").replace("sto\n", "stop\n").replace("dim m", "dim mm");
    assert_eq!(parse(&long), parse(SINGLET));
}

#[test]
fn radii_stand_where_rdm_says_so() {
    let lens = changed("rdm n", "rdm y").expect("a lens");
    assert_eq!(lens.surfaces[1].profile, Profile::sphere(1.0 / 0.02 / 1e-3));
    let inch = changed("dim m", "dim i").expect("a lens");
    assert_eq!(inch.surfaces[1].thickness, 4.0 * 0.0254);
}

#[test]
fn a_conic_with_terms_and_an_earlier_surface_are_reached() {
    let lens = changed("go", "asp s1; k s1 -1.2; b s1 2e-6\nthi s1 3; gla s1 517642").expect("a lens");
    let Profile::Revolved(curve) = &lens.surfaces[1].profile else { panic!("a surface of revolution") };
    assert_eq!(
        (curve.conic, &curve.terms[..]),
        (-1.2, &[Term { power: 6, coefficient: 2e-6 * 1e-3_f64.powi(-5) }][..])
    );
    assert_eq!(lens.surfaces[1].thickness, 0.003);
    assert_eq!(lens.surfaces[1].material, Material::Model { nd: 1.517, vd: 64.2 });
}

#[test]
fn pickups_are_evaluated() {
    let lens = changed("go", "pik rdy s2 z1 rdy s1 z1 -2.0; pik thi s2 thi s1 0.5 1").expect("a lens");
    assert_eq!(lens.surfaces[2].profile, Profile::sphere(-0.01 / 1e-3));
    assert_eq!(lens.surfaces[2].thickness, 0.003);
    assert!(changed("go", "pik cuy s2 cuy s9").is_err());
}

#[test]
fn decentred_axes_stay_return_bend_or_go_back() {
    let moved = |kind: &str| {
        let lens = changed("cir 5.5", &format!("yde 2; ade 30\n{kind}")).expect("a lens");
        (lens.surfaces[1].before, lens.surfaces[1].after)
    };
    let there =
        Motion::shift(DVec3::new(0.0, 0.002, 0.0)).then(Motion::turn(DVec3::new(-30_f64.to_radians(), 0.0, 0.0)));
    assert_eq!(moved("bas"), (there, Motion::NONE));
    assert_eq!(moved("dar"), (there, there.inverse()));
    assert_eq!(moved("ben"), (there, Motion { shift: DVec3::ZERO, ..there }));
    assert_eq!(moved("rev"), (Motion::NONE, there.inverse()));
}

#[test]
fn openings_have_roles_sides_and_centres() {
    let lens = changed("sto\n", "sto\nrex obs l'A' 1; rey obs l'A' 2; adx obs 0.5; cir edg 7; elx 3; ely 4\n")
        .expect("a lens");
    let opening = |role, outline, x| Opening { role, outline, centre: [x, 0.0] };
    let expected = [
        opening(Role::Obscured, Outline::Rectangle(0.001, 0.002), 0.5e-3),
        opening(Role::Edge, Outline::Circle(0.007), 0.0),
        opening(Role::Clear, Outline::Ellipse(0.003, 0.004), 0.0),
        opening(Role::Clear, Outline::Circle(0.0055), 0.0),
    ];
    assert_eq!(lens.surfaces[1].openings, expected);
}

#[test]
fn private_glasses_are_tables() {
    let lens = changed("so 0", "prv; pwl 650 550\n'mine' 1.51 1.52\nend\nso 0").expect("a lens");
    assert_eq!(lens.surfaces[1].thickness, 0.004);
    let lens = changed("4 nbk7_schott", "4 mine\nprv; pwl 650 550\n'mine' 1.51 1.52\nend").expect("a lens");
    let Material::Private { indices, .. } = &lens.surfaces[1].material else { panic!("a private glass") };
    assert!((indices[0].0 - 550e-9).abs() < 1e-20 && indices[0].1 == 1.52);
}

#[test]
fn a_solved_distance_is_used_if_it_stands_there() {
    assert_eq!(changed("si 0", "pim\nsi 0").expect("a lens").surfaces[2].thickness, 0.048);
    let problem = changed("-0.02 48", "-0.02 0\npim").expect_err("no distance").remove(0);
    assert!(problem.to_string().contains("solve"), "{problem}");
}

#[test]
fn what_is_left_out_is_noted_with_its_line() {
    for (text, words) in [
        ("zoo 3\ngo", "zoom"),
        ("thm 0.6\ngo", "not translated"),
        ("xyz 5\ngo", "not known"),
        ("tem 40\ngo", "temperature"),
    ] {
        let notes = changed("go", text).expect("a lens").notes;
        assert_eq!((notes.len(), notes[0].line), (1, Some(15)), "{notes:?}");
        assert!(notes[0].text.contains(words), "{notes:?}");
    }
}

#[test]
fn every_defect_is_named_with_its_place() {
    for (from, to, line, words) in [
        ("dim m", "dim x", Some(3), "unit"),
        ("epd 10\n", "", None, "aperture"),
        ("ref 2", "ref 5", None, "reference wavelength"),
        ("yan 0 5", "yan 0 5\nxob 1", Some(8), "two kinds"),
        ("s 0.02", "s abc", Some(10), "abc"),
        ("cir 5.5", "cuy umy 0.1", Some(12), "solves"),
        ("cir 5.5", "glb s1", Some(12), "GLB"),
        ("cir 5.5", "cyl", Some(12), "CYL"),
        ("cir 5.5", "ade 10; bde 5; ben", Some(10), "several axes"),
        ("cir 5.5", "adx 1", Some(12), "opening"),
        ("si 0 0\n", "", None, "image"),
        ("go", "s 0 0", Some(15), "behind the image"),
        ("sto", "s7 1 2", Some(11), "follows"),
    ] {
        let problem = changed(from, to).expect_err(to).remove(0);
        assert!(problem.to_string().contains(words), "{to:?}: {problem}");
        assert_eq!(problem.span.map(|span| span.line), line, "{to:?}: {problem}");
    }
}
