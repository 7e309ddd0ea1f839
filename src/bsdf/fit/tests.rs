use super::*;
use crate::bsdf::reading::{Unmeasured, parse};
use glam::DVec3;

/// A table as a CSV, of a law at two incidences, every 5 by 30 deg.
fn table(f: impl Fn(&Incidence, DVec3) -> f64) -> Table {
    let mut text = String::from("theta_i_deg,theta_s_deg,phi_deg,bsdf_per_sr\n");
    for (incidence, theta, phi) in
        [5, 50].into_iter().flat_map(|i| (0..18).flat_map(move |t| (0..12).map(move |p| (i, 5 * t, 30 * p))))
    {
        if theta == 0 && phi > 0 {
            continue;
        }
        let [i, t, p] = [incidence, theta, phi].map(|angle| f64::from(angle).to_radians());
        // Light comes from +x; azimuth 0 is the specular side.
        let wo = DVec3::new(-t.sin() * p.cos(), t.sin() * p.sin(), t.cos());
        let value = f(&Incidence::in_air(i, 550e-9), wo);
        text.push_str(&format!("{incidence},{theta},{phi},{value:e}\n"));
    }
    parse(&text, Unmeasured::Zero).expect("a good table").remove(0)
}

fn laws() -> [(Law, [f64; 4]); 3] {
    let band = [1e4, 1e6];
    [
        (Law::Abg, [2e-3, 0.01, 2.3, 0.02]),
        (Law::Harvey, [0.4, 0.08, 1.7, 0.01]),
        (Law::KCorrelation { wavelength: 550e-9, band }, [5e-9, 10e-6, 2.4, 0.001]),
    ]
}

/// What scatters is what was fitted, and every coefficient comes back.
#[test]
fn a_law_is_recovered_from_its_own_table() {
    for (law, wanted) in laws() {
        let lobes = law.lobes(wanted, Side::Reflect);
        let points = points(&table(|at, wo| lobes.iter().map(|lobe| lobe.eval(at, wo)).sum()), 1.0);
        let fit = fit(&points, law).expect("a fit");
        for (found, wanted) in fit.values.iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-3, "{law:?}: {:?} for {wanted:?}", fit.values);
        }
        assert!(fit.rms < 1e-6 && fit.largest.0 < 1e-5, "{law:?}: {fit:?}");
        let at = Incidence::in_air(0.9, 550e-9);
        let tis: f64 = lobes.iter().map(|lobe| lobe.albedo(&at)).sum();
        assert!((fit.tis(&[0.9], Side::Reflect)[0] / tis - 1.0).abs() < 1e-3, "{law:?}");
    }
}

#[test]
fn each_law_fits_its_own_table_best() {
    for (own, values) in laws() {
        let lobes = own.lobes(values, Side::Reflect);
        let points = points(&table(|at, wo| lobes.iter().map(|lobe| lobe.eval(at, wo)).sum()), 1.0);
        let rms = |law: Law| fit(&points, law).map_or(f64::INFINITY, |fit| fit.rms);
        let others = laws().into_iter().map(|(law, _)| law).filter(|law| *law != own);
        assert!(others.into_iter().all(|law| rms(law) > 1e3 * rms(own)), "{own:?}");
    }
}

#[test]
fn few_points_are_not_fitted() {
    let point = Point { incidence: 0.0, x: 0.1, cosines: [1.0, 0.9], in_plane: None, value: 0.1 };
    assert!(fit(&[point; 4], Law::Abg).is_none());
    assert!(fit(&[], Law::Abg).is_none());
}
