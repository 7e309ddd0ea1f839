//! Numbers, vectors and forms as a system file writes them.

use super::glass::vacuum;
use crate::error::Problem;
use crate::prescription::{Profile, Term};
use glam::DVec3;

/// A number with 14 digits, as short as it goes.
pub fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.13e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}

/// A length in millimetres.
pub fn mm(metres: f64) -> String {
    format!("\"{} mm\"", number(1e3 * metres))
}

/// Three numbers, scaled.
pub fn vector(v: DVec3, scale: f64) -> String {
    let [x, y, z] = (scale * v).to_array().map(|x| number(if x == 0.0 { 0.0 } else { x }));
    format!("({x}, {y}, {z})")
}

/// Indices relative to air over wavelengths in air, as a table of absolute ones over those in vacuum.
pub fn tabulated(indices: &[(f64, f64)]) -> String {
    let wavelengths: Vec<String> =
        indices.iter().map(|(w, _)| format!("\"{} nm\"", number(1e9 * vacuum(*w).0))).collect();
    let n: Vec<String> = indices.iter().map(|(w, n)| number(n * vacuum(*w).1)).collect();
    format!("Tabulated(wavelength: [{}], n: [{}])", wavelengths.join(", "), n.join(", "))
}

/// The form of a surface in RON.
pub fn form(profile: &Profile) -> Result<String, Problem> {
    let radius = |c: f64| if c == 0.0 { String::new() } else { format!("radius: {}, ", mm(1.0 / c)) };
    let conic = |k: f64| if k == 0.0 { String::new() } else { format!("conic: {}, ", number(k)) };
    // In mm, as lens designers read them.
    let term = |power: u32, a: f64| {
        format!("({power}, \"{} mm^{}\")", number(a * 1e3f64.powi(1 - power as i32)), 1 - power as i32)
    };
    let terms = |terms: &[Term]| {
        let written: Vec<String> = terms.iter().map(|t| term(t.power, t.coefficient)).collect();
        format!("terms: [{}]", written.join(", "))
    };
    Ok(match profile {
        Profile::Revolved(curve) if !curve.terms.is_empty() => {
            format!("Asphere({}{}{})", radius(curve.curvature), conic(curve.conic), terms(&curve.terms))
        }
        Profile::Revolved(curve) if curve.curvature == 0.0 => "Plane".to_owned(),
        Profile::Revolved(curve) if curve.conic == 0.0 => {
            format!("Sphere({})", radius(curve.curvature).trim_end_matches(", "))
        }
        Profile::Revolved(curve) => format!("Conic({}conic: {})", radius(curve.curvature), number(curve.conic)),
        Profile::Toroid { curve, radius: turned } => {
            let rotation = if turned.is_infinite() { String::new() } else { format!(", rotation: {}", mm(*turned)) };
            format!("Toroid({}{}{}{rotation})", radius(curve.curvature), conic(curve.conic), terms(&curve.terms))
        }
        Profile::Thin { .. } => return Err(Problem::error("an ideal thin lens has no form")),
    })
}
