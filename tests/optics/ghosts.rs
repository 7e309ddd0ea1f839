//! Two-reflection ghosts of singlets against paraxial optics and exact rays.

use crate::lab::{close, shot, system};
use crate::lenses::{around, form, singlet};
use crate::support::{Case, case::number};
use glam::DVec3;
use straylight::geometry::Ray;
use straylight::system::compile::Compiled;

/// The ray that leaves after reflections at rear and front, in mm, and its share of the flux.
fn ghost(compiled: &Compiled, height: f64) -> (Ray, f64) {
    let origin = 1e-3 * DVec3::new(0.0, height, -50.0);
    let mut out = shot(compiled, &[Ray { origin, direction: DVec3::Z }]).seen.escaped;
    // Forward: direct, ghost 2, ghost 4 .. by falling flux.
    out.retain(|(ray, _)| ray.direction.z > 0.0);
    out.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (ray, flux) = out[1];
    (Ray { origin: 1e3 * (ray.origin + compiled.scene.shift), ..ray }, flux)
}

fn singlet_ghost(id: &str) {
    let case = Case::load(id);
    let (thickness, beam) = (case.given("/thickness"), case.given("/beam_radius"));
    let lens = singlet(&form(case.setup("/R1")), &form(case.setup("/R2")), thickness, 6.0 * beam);
    let compiled = system(&around(&lens, case.given("/n")), "");
    let value = &case.values()[0];
    let crossing = |height: f64| {
        let (ray, _) = ghost(&compiled, height);
        ray.origin.z - ray.direction.z * ray.origin.y / ray.direction.y - thickness
    };
    let focus = number(value, "BFD_ghost");
    // Third-order aberration at this height is 1e-8 of the focus.
    close(crossing(1e-3), focus, 1e-6 * focus, &format!("{id} ghost focus"));
    close(
        crossing(beam),
        number(value, "marginal_ray_ghost_crossing"),
        1e-9 * focus,
        &format!("{id} marginal crossing"),
    );
    // Flux over the uniform beam: midpoints in r^2.
    let rays = 4000;
    let flux = (0..rays).map(|i| ghost(&compiled, beam * ((f64::from(i) + 0.5) / f64::from(rays)).sqrt()).1);
    let mean = flux.sum::<f64>() / f64::from(rays);
    let wanted = number(value, "ghost_flux_beam");
    close(mean, wanted, 1e-6 * wanted, &format!("{id} ghost flux"));
    close(
        ghost(&compiled, 1e-9).1,
        number(value, "ghost_flux_normal_incidence"),
        1e-9,
        &format!("{id} ghost flux on axis"),
    );
    // The footprint on the plane of the direct focus: where the marginal ray of the ghost lands.
    let distance = number(value, "BFD_direct") + thickness;
    let (ray, _) = ghost(&compiled, beam);
    let y = ray.origin.y + (distance - ray.origin.z) / ray.direction.z * ray.direction.y;
    let radius = number(value, "ghost_radius_at_direct_focus");
    close(y.abs(), radius, 1e-9 * radius, &format!("{id} ghost radius"));
}

#[test]
fn gho_02_singlet_ghost() {
    singlet_ghost("GHO-02");
    singlet_ghost("GHO-02b");
}

#[test]
fn gho_03_singlet_ghost() {
    singlet_ghost("GHO-03x");
}
