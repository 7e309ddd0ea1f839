//! The entry of `surfaces` that declares a face.

use super::Face;
use crate::geometry::exact::{Sag, Shape};
use crate::geometry::fit::{Fit, Kind};
use crate::system::document::default_smooth;
use glam::DVec3;

impl Face {
    /// RON to paste into `surfaces`; `None` if no form was found, or if it would change nothing: flat facets are a plane already, but on a
    /// lens with round rims the flat side has one, too.
    pub fn entry(&self) -> Option<String> {
        let fit = &self.outcome.fit;
        let rim = self.semi_diameter();
        if !self.outcome.found || fit.kind == Kind::Plane && (rim.is_none() || !self.of_lens) {
            return None;
        }
        let smooth = match self.smooth == default_smooth().0 {
            true => String::new(),
            false => format!(", smooth: \"{} deg\"", plain(self.smooth.to_degrees(), 9)),
        };
        let on = format!(
            "Faces(of: {:?}, where: Nearest(point: \"{} mm\"{smooth}))",
            self.node,
            point(self.point, 1e-3 * self.tolerance)
        );
        let rim = rim.map_or(String::new(), |r| format!(", semi_diameter: \"{} mm\"", millimetres(r, self.step())));
        let (form, vertex) = (form(fit, self.step()), point(vertex(fit), self.step()));
        Some(format!(
            "(on: {on},\n exact: (form: {form}, vertex: \"{vertex} mm\", axis: \"{}\"{rim})),",
            triple(fit.axis, |x| plain(x, 13))
        ))
    }

    /// To what lengths are rounded, m: a thousandth of what is allowed.
    fn step(&self) -> f64 {
        1e-3 * self.tolerance
    }
}

/// The vertex as `exact` means it, m: of a cone its apex.
fn vertex(fit: &Fit) -> DVec3 {
    match (fit.kind, &fit.shape) {
        (Kind::Cone, Shape::Cone { radius, taper }) => fit.at - radius / taper * fit.axis,
        _ => fit.at,
    }
}

fn form(fit: &Fit, step: f64) -> String {
    // The sag of a radius R changes by dR (r / R)^2 / 2 at most, so that dR may be as large as its own error.
    let error = if fit.errors[0].is_finite() { fit.errors[0] } else { step };
    let radius = millimetres(fit.radius(), 0.01 * error.max(1e-3 * step));
    match (fit.kind, &fit.shape) {
        (Kind::Plane, _) => "Plane".into(),
        (Kind::Sphere, _) => format!("Sphere(radius: \"{radius} mm\")"),
        (Kind::Cylinder, _) => format!("Cylinder(radius: \"{radius} mm\")"),
        (Kind::Conic, Shape::Conic(conic)) => format!("Conic(radius: \"{radius} mm\", conic: {})", float(conic.conic)),
        // r = t z from the apex is the height z = r / t.
        (_, Shape::Cone { taper, .. }) => format!("Asphere(terms: [(1, \"{:e}\")])", 1.0 / taper),
        (_, Shape::Sag { sag: Sag::Asphere { base, terms }, .. }) => {
            let term = |&(p, a): &(u32, f64)| {
                let power = 1 - p as i32;
                format!("({p}, \"{:e} mm^{power}\")", a * 1e3f64.powi(power))
            };
            let terms: Vec<String> = terms.iter().map(term).collect();
            format!(
                "Asphere(radius: \"{:?} mm\", conic: {}, terms: [{}])",
                1e3 / base.curvature,
                float(base.conic),
                terms.join(", ")
            )
        }
        _ => String::new(),
    }
}

/// With a decimal point, as RON wants it.
fn float(value: f64) -> String {
    format!("{value:?}")
}

/// A length (m) in mm, rounded to about `step` (m).
fn millimetres(length: f64, step: f64) -> String {
    let decimals = (-(1e3 * step).log10()).ceil().clamp(0.0, 15.0);
    plain(1e3 * length, decimals as usize)
}

fn point(p: DVec3, step: f64) -> String {
    triple(p, |x| millimetres(x, step))
}

fn triple(v: DVec3, written: impl Fn(f64) -> String) -> String {
    let [x, y, z] = v.to_array().map(written);
    format!("({x}, {y}, {z})")
}

/// At most so many decimals, without zeros at the end.
fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}
