//! First-order optics: what a lens does to rays close to its axis.
//!
//!     w' = w - y phi       phi = (n' - n) c        at a surface, w = n u
//!     y' = y + t w' / n'                           across the space behind it
//!
//! y height, m; u = dy/dz slope, dimensionless; n index, negative after an odd number of mirrors, where light runs towards
//! negative z; c vertex curvature, 1/m; t thickness, m; phi power, 1/m. Checked by the Lagrange invariant H = wbar y - w ybar, the
//! same at every surface.
//!
//! Left out: tilts and decentres (the axis is folded along with the chain of surfaces); toroids beyond their y-z section.
//! Sources: Born & Wolf, 7th ed., 4.4; Kingslake & Johnson, Lens Design Fundamentals (2010), ch. 3.

use super::{Aperture, Field, FieldPoint, Index, Material, Prescription, Profile};
use crate::error::Problem;

/// A paraxial ray at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Height at the surface, m.
    pub height: f64,
    /// dy/dz behind it, dimensionless.
    pub slope: f64,
}

/// A pupil: the image of the stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pupil {
    /// z of its plane, m; from the first surface behind the object (entrance) or from the last before the image (exit).
    /// Infinite in a telecentric space.
    pub position: f64,
    /// Diameter, m.
    pub diameter: f64,
}

/// First-order data at one wavelength. Distances are along the local z: behind an odd number of mirrors, what lies ahead of the
/// light is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstOrder {
    /// 1 / power, m: positive for a lens that converges; infinite if it is afocal.
    pub focal_length: f64,
    /// From the last surface to the rear focal point, m.
    pub back_focal_length: f64,
    /// From the first surface to the front focal point, m.
    pub front_focal_length: f64,
    /// From the last surface to the image of the object, m.
    pub image_distance: f64,
    /// Height of the image of the largest field, m.
    pub image_height: f64,
    /// Image height / object height, dimensionless; 0 for an object at infinity.
    pub magnification: f64,
    /// Where the beam seems to enter.
    pub entrance_pupil: Pupil,
    /// Where it seems to come from.
    pub exit_pupil: Pupil,
    /// Focal length / diameter of the entrance pupil, dimensionless.
    pub f_number: f64,
    /// 1 / (2 n' u') of the marginal ray at the image, dimensionless.
    pub working_f_number: f64,
    /// Sum of phi / (n n'), 1/m: the image of a plane has the radius -1 / (n' P).
    pub petzval: f64,
    /// H of the two rays below, m.
    pub invariant: f64,
    /// From the axis to the edge of the stop, at every surface. The object's height is that of surface 1 if it is at infinity.
    pub marginal: Vec<Ray>,
    /// From the largest field through the centre of the stop, drawn in the y-z plane. An object at infinity has infinite height.
    pub chief: Vec<Ray>,
}

/// First-order data of a lens at its reference wavelength. Fails if an index is not known, nothing lies between object
/// and image, or the aperture asks for what the object distance does not allow.
pub fn first_order(lens: &Prescription, index: Index) -> Result<FirstOrder, Problem> {
    let chain = Chain::new(lens, &lens.indices(index, lens.wavelength())?)?;
    let (last, stop) = (chain.last(), chain.stop);
    let parallel = chain.trace(1.0, 0.0);
    let from_vertex = chain.trace(0.0, 1.0);
    let power = -parallel[last].w;
    let unit = chain.object_ray();
    let axial = chain.trace(unit.0, unit.1);
    let image_distance = -axial[last].y * chain.n[last] / axial[last].w;

    // The ray through the centre of the stop; 0 = y_stop = y a_stop + w b_stop.
    let (y, w) = (-from_vertex[stop].y, parallel[stop].y);
    let entrance = -y * chain.n[0] / w;
    let through = chain.trace(y, w);
    let exit = -through[last].y * chain.n[last] / through[last].w;
    let at_pupil = |ray: &[State]| ray[0].y + entrance * ray[0].w / chain.n[0];

    let pupil = at_pupil(&axial);
    let scale = chain.marginal_scale(lens.aperture, &axial, pupil)?;
    let marginal: Vec<State> = axial.iter().map(|s| s.times(scale)).collect();
    let image = |ray: &[State]| ray[last].y + image_distance * ray[last].w / chain.n[last];
    let scale = chain.chief_scale(lens, &through, image(&through))?;
    let chief: Vec<State> = through.iter().map(|s| s.times(scale)).collect();

    let diameter = if unit.1 == 0.0 { 2.0 * marginal[0].y } else { 2.0 * at_pupil(&marginal) };
    let out = |z: f64| marginal[last].y + z * marginal[last].w / chain.n[last];
    Ok(FirstOrder {
        focal_length: 1.0 / power,
        back_focal_length: parallel[last].y * chain.n[last] / power,
        front_focal_length: -chain.n[0] * from_vertex[last].w / power,
        image_distance,
        image_height: image(&chief),
        magnification: if chain.infinite() { 0.0 } else { axial[0].w / axial[last].w },
        entrance_pupil: Pupil { position: entrance, diameter: diameter.abs() },
        exit_pupil: Pupil { position: exit, diameter: 2.0 * out(exit).abs() },
        f_number: (1.0 / power / diameter).abs(),
        working_f_number: 0.5 / marginal[last].w.abs(),
        petzval: (1..=last).map(|i| chain.power[i] / (chain.n[i] * chain.n[i - 1])).sum(),
        invariant: chief[0].w * marginal[0].y - marginal[0].w * chief[0].y,
        marginal: chain.rays(&marginal),
        chief: chain.rays(&chief),
    })
}

/// A ray as it leaves a surface: height (m) and w = n u. Entry 0 of a trace is the ray as it comes to surface 1.
#[derive(Clone, Copy, Debug)]
struct State {
    y: f64,
    w: f64,
}

impl State {
    fn times(self, scale: f64) -> State {
        State { y: self.y * scale, w: self.w * scale }
    }
}

/// The lens as powers and distances. Entry i belongs to surface i and the space behind it; index signed.
struct Chain {
    stop: usize,
    n: Vec<f64>,
    power: Vec<f64>,
    thickness: Vec<f64>,
}

impl Chain {
    fn new(lens: &Prescription, index: &[f64]) -> Result<Chain, Problem> {
        if lens.surfaces.len() < 3 {
            return Err(Problem::error("nothing lies between object and image").expecting("at least one surface"));
        }
        let stop = lens.stop.filter(|s| (1..lens.surfaces.len() - 1).contains(s)).unwrap_or(1);
        let mut chain = Chain { stop, n: Vec::new(), power: Vec::new(), thickness: Vec::new() };
        let mut sign = 1.0;
        for (surface, index) in lens.surfaces.iter().zip(index) {
            if surface.material == Material::Mirror {
                sign = -sign;
            }
            let (before, behind) = (*chain.n.last().unwrap_or(index), sign * index);
            chain.power.push(match &surface.profile {
                Profile::Revolved(curve) | Profile::Toroid { curve, .. } => {
                    (behind - before) * curve.vertex_curvature()
                }
                Profile::Thin { power } => *power,
            });
            chain.n.push(behind);
            chain.thickness.push(surface.thickness);
        }
        Ok(chain)
    }

    /// The last surface before the image.
    fn last(&self) -> usize {
        self.n.len() - 2
    }

    fn infinite(&self) -> bool {
        self.thickness[0].is_infinite()
    }

    /// The ray that comes to surface 1 with height y (m) and w, behind every surface up to the image.
    fn trace(&self, y: f64, w: f64) -> Vec<State> {
        let mut ray = State { y, w };
        let mut states = vec![ray];
        for i in 1..self.n.len() {
            if i > 1 {
                ray.y += self.thickness[i - 1] * ray.w / self.n[i - 1];
            }
            ray.w -= ray.y * self.power[i];
            states.push(ray);
        }
        states
    }

    /// Height and w at surface 1 of a ray from the object's axial point.
    fn object_ray(&self) -> (f64, f64) {
        if self.infinite() { (1.0, 0.0) } else { (self.thickness[0], self.n[0]) }
    }

    /// What the ray from the axial point must be multiplied by to fill the aperture; `pupil` is its height in the entrance pupil, m.
    fn marginal_scale(&self, aperture: Aperture, axial: &[State], pupil: f64) -> Result<f64, Problem> {
        let last = self.last();
        // A parallel beam is as wide in the pupil as anywhere, also where the pupil is infinitely far.
        let pupil = if self.infinite() { axial[0].y } else { pupil };
        let slope = |na: f64, n: f64| (na / n.abs()).asin().tan();
        let scale = match aperture {
            Aperture::EntrancePupil(diameter) => diameter / 2.0 / pupil,
            Aperture::ImageFNumber(number) => 0.5 / (number * self.trace(1.0, 0.0)[last].w.abs() * pupil),
            Aperture::WorkingFNumber(number) => 0.5 / number / axial[last].w.abs(),
            Aperture::ObjectNa(na) => slope(na, self.n[0]) * self.n[0] / axial[0].w,
            Aperture::ImageNa(na) => slope(na, self.n[last]) * (self.n[last] / axial[last].w).abs(),
            Aperture::Stop(radius) => radius / axial[self.stop].y.abs(),
        };
        if scale.is_finite() && scale != 0.0 {
            return Ok(scale);
        }
        Err(Problem::error(format!("the aperture {aperture:?} fits no beam of this lens"))
            .expecting("an aperture that goes with the object distance, the focal length and the stop"))
    }

    /// What the ray through the centre of the stop must be multiplied by to come from the largest field. `image` is its height in the
    /// image, m.
    fn chief_scale(&self, lens: &Prescription, through: &[State], image: f64) -> Result<f64, Problem> {
        let Some(field) = lens.fields.iter().map(Field::size).max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return Ok(0.0);
        };
        let slope = through[0].w / self.n[0];
        let scale = match field {
            (0.0, _) => 0.0,
            (size, FieldPoint::ObjectAngle(_)) => size / slope,
            (size, FieldPoint::ObjectHeight(_)) => size / (through[0].y - self.thickness[0] * slope),
            (size, FieldPoint::ImageHeight(_)) => size / image,
        };
        if scale.is_finite() && (scale != 0.0 || field.0 == 0.0) {
            return Ok(scale);
        }
        Err(Problem::error("the field fits no ray through the stop of this lens")
            .expecting("object angles, or heights with an object or image at a finite distance"))
    }

    fn rays(&self, states: &[State]) -> Vec<Ray> {
        let mut rays: Vec<Ray> = states.iter().zip(&self.n).map(|(s, n)| Ray { height: s.y, slope: s.w / n }).collect();
        // From surface 1 back to the object; a parallel ray keeps its height over any distance.
        if rays[0].slope != 0.0 {
            rays[0].height -= self.thickness[0] * rays[0].slope;
        }
        rays
    }
}

impl Field {
    /// Distance from the axis: tan of the angle, or m.
    fn size(&self) -> (f64, FieldPoint) {
        let size = match self.point {
            FieldPoint::ObjectAngle([x, y]) => x.tan().hypot(y.tan()),
            FieldPoint::ObjectHeight([x, y]) | FieldPoint::ImageHeight([x, y]) => x.hypot(y),
        };
        (size, self.point)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Surface, Vignetting};
    use super::*;

    fn surface(curvature: f64, thickness: f64, material: Material) -> Surface {
        Surface { profile: Profile::sphere(curvature), thickness, material, ..Surface::plane() }
    }

    /// Object, the surfaces and an image plane, half a degree of field, a beam of 10 mm.
    fn lens(distance: f64, surfaces: &[Surface]) -> Prescription {
        let mut all = vec![surface(0.0, distance, Material::Air)];
        all.extend_from_slice(surfaces);
        all.push(Surface::plane());
        let point = FieldPoint::ObjectAngle([0.3_f64.to_radians(), 0.4_f64.to_radians()]);
        Prescription {
            name: String::new(),
            surfaces: all,
            stop: None,
            aperture: Aperture::EntrancePupil(0.01),
            fields: vec![Field { point, vignetting: Vignetting::default() }],
            wavelengths: vec![(550e-9, 1.0)],
            primary: 0,
            notes: Vec::new(),
        }
    }

    fn glass() -> Material {
        Material::Model { nd: 1.5168, vd: 64.17 }
    }

    fn optics(lens: &Prescription) -> FirstOrder {
        let index = |material: &Material, _: f64| match material {
            Material::Model { nd, .. } => Some(*nd),
            _ => Some(1.0),
        };
        first_order(lens, &index).expect("a lens")
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
    }

    #[test]
    fn a_thick_lens_follows_the_lens_makers_formula() {
        let (r1, r2, t, n) = (0.05_f64, -0.08_f64, 0.012, 1.5168);
        let of = optics(&lens(f64::INFINITY, &[surface(1.0 / r1, t, glass()), surface(1.0 / r2, 0.1, Material::Air)]));
        let power = (n - 1.0) * (1.0 / r1 - 1.0 / r2 + (n - 1.0) * t / (n * r1 * r2));
        close(of.focal_length, 1.0 / power);
        close(of.back_focal_length, (1.0 - (n - 1.0) * t / (n * r1)) / power);
        close(of.front_focal_length, -(1.0 + (n - 1.0) * t / (n * r2)) / power);
        close(of.petzval, (n - 1.0) / n * (1.0 / r1 - 1.0 / r2));
        let plano = optics(&lens(f64::INFINITY, &[surface(1.0 / 0.05168, 0.005, glass()), Surface::plane()]));
        close(plano.focal_length, 0.1);
    }

    #[test]
    fn two_mirrors_make_a_telescope() {
        let (r1, r2, d) = (-1.0, -0.5_f64, 0.35);
        let mirrors = [surface(1.0 / r1, -d, Material::Mirror), surface(1.0 / r2, 0.5, Material::Mirror)];
        let of = optics(&lens(f64::INFINITY, &mirrors));
        let (f1, f2) = (-r1 / 2.0, r2 / 2.0);
        let focal = f1 * f2 / (f1 + f2 - d);
        close(of.focal_length, focal);
        close(of.back_focal_length, focal * (f1 - d) / f1);
        close(of.petzval, 1.0 / -f1 + 1.0 / -f2);
        let one = optics(&lens(f64::INFINITY, &mirrors[..1]));
        close(one.focal_length, 0.5);
        close(one.back_focal_length, -0.5);
    }

    #[test]
    fn the_invariant_is_the_same_everywhere() {
        let mirror = surface(-2.0, -0.1, Material::Mirror);
        let rear = surface(-8.0, 0.05, Material::Air);
        for distance in [f64::INFINITY, 0.4] {
            let lens = lens(distance, &[surface(12.0, 0.01, glass()), rear.clone(), mirror.clone()]);
            let of = optics(&Prescription { stop: Some(2), ..lens });
            for (i, n) in [1.0, 1.5168, 1.0, -1.0].into_iter().enumerate().skip(1) {
                let (m, c) = (of.marginal[i], of.chief[i]);
                assert!((n * (c.slope * m.height - m.slope * c.height) - of.invariant).abs() < 1e-15);
            }
            assert!(of.chief[2].height.abs() < 1e-18);
        }
    }

    #[test]
    fn a_finite_object_is_imaged_by_newtons_formula() {
        let thin = Surface { profile: Profile::Thin { power: 10.0 }, thickness: 0.1, ..Surface::plane() };
        let lens = lens(0.3, &[thin]);
        let of = optics(&lens);
        close(of.image_distance, 0.15);
        close(of.magnification, -0.5);
        close(of.marginal[0].height, 0.0);
        close(of.marginal[1].height, 0.005);
        close(of.image_height, 0.15 * 0.3_f64.to_radians().tan().hypot(0.4_f64.to_radians().tan()));
        close(of.working_f_number, 0.15 / 0.01);
    }

    #[test]
    fn every_way_to_state_the_aperture_gives_the_same_beam() {
        let lens = lens(0.3, &[surface(12.0, 0.01, glass()), surface(-8.0, 0.05, Material::Air)]);
        let lens = Prescription { stop: Some(2), ..lens };
        let of = optics(&lens);
        let sine = |ray: Ray| ray.slope.abs().atan().sin();
        for aperture in [
            Aperture::ImageFNumber(of.f_number),
            Aperture::WorkingFNumber(of.working_f_number),
            Aperture::ObjectNa(sine(of.marginal[0])),
            Aperture::ImageNa(sine(of.marginal[2])),
            Aperture::Stop(of.marginal[2].height),
        ] {
            let again = optics(&Prescription { aperture, ..lens.clone() });
            close(again.entrance_pupil.diameter, of.entrance_pupil.diameter);
            close(again.exit_pupil.diameter, of.exit_pupil.diameter);
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let index = |_: &Material, _: f64| Some(1.0);
        let telescope = lens(f64::INFINITY, &[Surface::plane()]);
        let na = Prescription { aperture: Aperture::ObjectNa(0.1), ..telescope.clone() };
        assert!(first_order(&na, &index).is_err());
        let unknown = first_order(&telescope, &|_, _| None).expect_err("no index");
        assert!(unknown.to_string().contains("air"), "{unknown}");
        assert!(first_order(&lens(0.1, &[]), &index).is_err());
    }
}
