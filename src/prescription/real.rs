//! Rays of finite angle, traced exactly through the surfaces in their order.
//!
//!     n' (d' - (d'.N) N) = n (d - (d.N) N)        Snell, vectorial; N the unit normal
//!     d' = d - 2 (d.N) N                          at a mirror
//!     u' = (n u - s y / f) / n'                   at an ideal thin lens, for both slopes; s = sign of d_z
//!
//! Surfaces are met wherever they are along the line, also behind: that is what sequential tracing means by a virtual surface.
//! Rays of a field are aimed at the paraxial entrance pupil.
//!
//! Left out: diffraction, polarisation, intensity; iterative aiming at the real stop; openings (vignetting factors are used).
//! Source: Born & Wolf, 7th ed., 3.2.2.

use super::paraxial::{FirstOrder, first_order};
use super::{Field, FieldPoint, Index, Material, Motion, Prescription, Profile, Surface};
use crate::error::Problem;
use glam::{DVec2, DVec3};

/// A line with a sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// A point of it, m.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

/// Why a ray ended early, with the index of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// It does not meet the surface.
    Missed(usize),
    /// It is totally reflected there.
    Reflected(usize),
}

/// Traces a ray that is given in the axes of surface 1 before they move. `indices` are those behind every surface
/// ([`Prescription::indices`]). Entry i of the result is the ray as it leaves surface i + 1, in its axes; the last is the image.
pub fn trace(lens: &Prescription, indices: &[f64], ray: Ray) -> Result<Vec<Ray>, Stopped> {
    let mut ray = ray;
    let mut rays = Vec::new();
    for (i, surface) in lens.surfaces.iter().enumerate().skip(1) {
        let local = ray.seen_from(&surface.before);
        let path = surface.profile.meet(local.origin, local.direction).ok_or(Stopped::Missed(i))?;
        let origin = local.origin + local.direction * path;
        let direction = bend(surface, Ray { origin, ..local }, indices[i - 1], indices[i]);
        let left = Ray { origin, direction: direction.ok_or(Stopped::Reflected(i))? };
        rays.push(left);
        ray = left.seen_from(&surface.after.then(Motion::shift(DVec3::Z * surface.thickness)));
    }
    Ok(rays)
}

impl Ray {
    fn seen_from(self, axes: &Motion) -> Ray {
        Ray { origin: axes.point(self.origin), direction: axes.direction(self.direction) }
    }
}

/// Direction behind the surface; `None`: total reflection.
fn bend(surface: &Surface, ray: Ray, n1: f64, n2: f64) -> Option<DVec3> {
    let d = ray.direction;
    if let Profile::Thin { power } = surface.profile {
        let slopes = (d.truncate() / d.z * n1 - ray.origin.truncate() * power * d.z.signum()) / n2;
        return Some(slopes.extend(1.0).normalize() * d.z.signum());
    }
    let slopes = surface.profile.at(ray.origin.truncate())?.1;
    let normal = DVec3::new(-slopes.x, -slopes.y, 1.0).normalize();
    let cosine = d.dot(normal);
    if surface.material == Material::Mirror {
        return Some(d - 2.0 * cosine * normal);
    }
    let ratio = n1 / n2;
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (square >= 0.0).then(|| ratio * d + (cosine.signum() * square.sqrt() - ratio * cosine) * normal)
}

/// The ray of a field through a point of the paraxial entrance pupil, in the axes of surface 1: (0, 0) its centre, (0, 1) its upper edge before
/// vignetting. `None` if the pupil is infinitely far.
pub fn field_ray(lens: &Prescription, optics: &FirstOrder, field: &Field, pupil: DVec2) -> Option<Ray> {
    let plane = optics.entrance_pupil.position;
    let cut = |p: f64, below: f64, above: f64| p * (1.0 - if p < 0.0 { below } else { above });
    let v = field.vignetting;
    let aim = DVec2::new(cut(pupil.x, v.left, v.right), cut(pupil.y, v.lower, v.upper));
    let target = (aim * optics.entrance_pupil.diameter / 2.0).extend(plane);
    let distance = lens.surfaces[0].thickness;
    let chief = optics.chief[0];
    let from_image = |[x, y]: [f64; 2], object: f64| DVec2::new(x, y) * object / optics.image_height;
    let slopes = match field.point {
        FieldPoint::ObjectAngle([x, y]) => DVec2::new(x.tan(), y.tan()),
        FieldPoint::ObjectHeight([x, y]) => -DVec2::new(x, y) / (distance + plane),
        FieldPoint::ImageHeight([0.0, 0.0]) => DVec2::ZERO,
        FieldPoint::ImageHeight(image) => from_image(image, chief.slope),
    };
    let direction = if distance.is_infinite() {
        slopes.extend(1.0)
    } else {
        target - (slopes * -(distance + plane)).extend(-distance)
    };
    (direction.is_finite() && target.is_finite())
        .then(|| Ray { origin: target, direction: direction.normalize() * direction.z.signum() })
}

/// Radius (m) that the beams of all fields use on every surface, the object's 0: of the chief ray and the four
/// rays at the edge of the vignetted pupil, at the reference wavelength. Rays that do not get through do not count. Fails if an
/// index is not known or the lens has no first order.
pub fn semi_diameters(lens: &Prescription, index: Index) -> Result<Vec<f64>, Problem> {
    let optics = first_order(lens, index)?;
    let indices = lens.indices(index, lens.wavelength())?;
    let axis = Field { point: FieldPoint::ObjectAngle([0.0, 0.0]), vignetting: Default::default() };
    let mut radii = vec![0.0_f64; lens.surfaces.len()];
    for field in lens.fields.iter().chain([&axis]) {
        for pupil in [DVec2::ZERO, DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
            let Some(ray) = field_ray(lens, &optics, field, pupil) else { continue };
            let Ok(rays) = trace(lens, &indices, ray) else { continue };
            for (radius, at) in radii[1..].iter_mut().zip(rays) {
                *radius = radius.max(at.origin.truncate().length());
            }
        }
    }
    Ok(radii)
}

#[cfg(test)]
mod tests {
    use super::super::{Aperture, Curve, Vignetting};
    use super::*;

    fn index(material: &Material, _: f64) -> Option<f64> {
        Some(if *material == Material::Air { 1.0 } else { 1.6 })
    }

    fn surface(curvature: f64, thickness: f64, material: Material) -> Surface {
        Surface { profile: Profile::sphere(curvature), thickness, material, ..Surface::plane() }
    }

    fn lens(surfaces: Vec<Surface>, diameter: f64, angle: f64) -> Prescription {
        let field = Field { point: FieldPoint::ObjectAngle([0.0, angle]), vignetting: Vignetting::default() };
        let mut all = vec![surface(0.0, f64::INFINITY, Material::Air)];
        all.extend(surfaces);
        all.push(Surface::plane());
        Prescription {
            name: String::new(),
            surfaces: all,
            stop: None,
            aperture: Aperture::EntrancePupil(diameter),
            fields: vec![field],
            wavelengths: vec![(550e-9, 1.0)],
            primary: 0,
            notes: Vec::new(),
        }
    }

    /// Edge and centre of the beam at the last surface, traced.
    fn heights(lens: &Prescription) -> [f64; 2] {
        let optics = first_order(lens, &index).expect("a lens");
        let indices = lens.indices(&index, 550e-9).expect("indices");
        let axis = Field { point: FieldPoint::ObjectAngle([0.0, 0.0]), vignetting: Vignetting::default() };
        [(axis, DVec2::Y), (lens.fields[0], DVec2::ZERO)].map(|(field, pupil)| {
            let ray = field_ray(lens, &optics, &field, pupil).expect("a pupil at a finite distance");
            trace(lens, &indices, ray).expect("it gets through")[lens.surfaces.len() - 2].origin.y
        })
    }

    #[test]
    fn a_narrow_beam_is_the_paraxial_one() {
        let glass = Material::Model { nd: 1.6, vd: 50.0 };
        let surfaces = vec![
            surface(15.0, 0.006, glass),
            surface(-4.0, 0.03, Material::Air),
            surface(-3.0, -0.02, Material::Mirror),
        ];
        for scale in [1e-4, 1e-5] {
            let lens = Prescription { stop: Some(2), ..lens(surfaces.clone(), scale, scale) };
            let optics = first_order(&lens, &index).expect("a lens");
            let image = lens.surfaces.len() - 1;
            let paraxial = [optics.marginal[image].height, optics.chief[image].height];
            for (real, paraxial) in heights(&lens).into_iter().zip(paraxial) {
                // What is left out is of third order in aperture and field: curvature^2 x scale^3.
                assert!((real - paraxial).abs() < 3e3 * scale.powi(3), "{real} {paraxial}");
            }
        }
    }

    #[test]
    fn a_parabola_focuses_a_beam_of_any_width() {
        let parabola = Profile::Revolved(Curve { curvature: -1.0, conic: -1.0, terms: Vec::new() });
        let mirror = Surface { profile: parabola, ..surface(0.0, -0.5, Material::Mirror) };
        assert!(heights(&lens(vec![mirror], 1.2, 0.0))[0].abs() < 1e-15);
    }

    #[test]
    fn a_tilted_mirror_turns_the_beam_by_twice_its_angle() {
        let tilt = Motion::turn(DVec3::new(0.1, 0.0, 0.0));
        let bend = Surface { before: tilt, after: tilt, ..surface(0.0, -0.3, Material::Mirror) };
        assert!(heights(&lens(vec![bend.clone()], 1e-3, 0.0))[1].abs() < 1e-16);
        let back = Surface { after: tilt.inverse(), ..bend };
        assert!((heights(&lens(vec![back], 1e-3, 0.0))[1].abs() - 0.3 * 0.2_f64.tan()).abs() < 1e-15);
    }

    #[test]
    fn an_ideal_lens_keeps_its_focus_off_the_axis() {
        let thin = Surface { profile: Profile::Thin { power: 5.0 }, thickness: 0.2, ..Surface::plane() };
        let lens = lens(vec![thin], 0.1, 0.3);
        let optics = first_order(&lens, &index).expect("a lens");
        for pupil in [DVec2::X, DVec2::Y, DVec2::NEG_Y] {
            let ray = field_ray(&lens, &optics, &lens.fields[0], pupil).expect("finite");
            let end = trace(&lens, &[1.0; 3], ray).expect("through")[1].origin;
            assert!((end - DVec3::new(0.0, 0.2 * 0.3_f64.tan(), 0.0)).length() < 1e-15);
        }
    }

    #[test]
    fn used_radii_hold_beam_and_field() {
        let plates = vec![surface(0.0, 0.1, Material::Air), surface(0.0, 0.1, Material::Air)];
        let radii = semi_diameters(&lens(plates, 0.02, 0.1), &index).expect("radii");
        for (radius, z) in radii[1..].iter().zip([0.0, 0.1, 0.2]) {
            assert!((radius - (0.01 + z * 0.1_f64.tan())).abs() < 1e-15);
        }
    }

    #[test]
    fn a_ray_that_ends_early_says_where() {
        let glass = Material::Model { nd: 1.6, vd: 50.0 };
        let ball = lens(vec![surface(0.0, 0.01, glass), surface(-100.0, 0.1, Material::Air)], 0.01, 0.0);
        let at = |y: f64| Ray { origin: DVec3::new(0.0, y, 0.0), direction: DVec3::Z };
        let indices = ball.indices(&index, 550e-9).expect("indices");
        assert_eq!(trace(&ball, &indices, at(0.009)), Err(Stopped::Reflected(2)));
        assert_eq!(trace(&ball, &indices, at(0.011)), Err(Stopped::Missed(2)));
    }
}
