//! Angles of incidence at which a table's function is known, found by sine and cosine alone.
//!
//!     sin(theta - theta_j) = sin(theta) cos_j - cos(theta) sin_j
//!
//! so that the way past a node is an arc sine of a small number, a short series.

use super::grid::angle_about;

/// Steps up to this sine are measured by the series, whose next term is 0.03 x^9: 1e-16.
const SMALL: f64 = 0.03;

/// Angles of incidence, strictly rising from 0 to pi/2.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// rad
    angle: Vec<f64>,
    /// Sine and cosine of each.
    axes: Vec<[f64; 2]>,
    /// Nodes per rad, on the average.
    density: f64,
}

impl Nodes {
    /// Two angles (rad) or more.
    pub fn new(angle: Vec<f64>) -> Nodes {
        let density = (angle.len() - 1) as f64 / angle[angle.len() - 1];
        let axes = angle.iter().map(|a| [a.sin(), a.cos()]).collect();
        Nodes { angle, axes, density }
    }

    /// The node at or before the angle of this sine and cosine, and the way to the next, 0..1.
    pub fn bracket(&self, [sin, cos]: [f64; 2]) -> (usize, f64) {
        let last = self.angle.len() - 2;
        let past = |j: usize| sin * self.axes[j][1] - cos * self.axes[j][0];
        let mut j = ((angle_about(sin * sin, cos) * self.density) as usize).min(last);
        while j > 0 && past(j) < 0.0 {
            j -= 1;
        }
        while j < last && past(j + 1) >= 0.0 {
            j += 1;
        }
        let way = small_arc_sine(past(j)) / (self.angle[j + 1] - self.angle[j]);
        (j, way.clamp(0.0, 1.0))
    }
}

/// asin(`x`), rad.
fn small_arc_sine(x: f64) -> f64 {
    if x.abs() > SMALL {
        return x.asin();
    }
    let x2 = x * x;
    x * (1.0 + x2 * (1.0 / 6.0 + x2 * (3.0 / 40.0 + x2 * (5.0 / 112.0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::table::bracket;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn nodes_are_found_as_by_the_angle() {
        for nodes in [vec![0.0, FRAC_PI_2], vec![0.0, 0.01, 0.02, 0.4, 1.2, 1.3, FRAC_PI_2]] {
            let table = Nodes::new(nodes.clone());
            for theta in (0..=1000).map(|k| FRAC_PI_2 * f64::from(k) / 1000.0) {
                let ((j, way), (k, wanted)) = (table.bracket([theta.sin(), theta.cos()]), bracket(&nodes, theta));
                // The sum tells one node from the end of the interval before it.
                assert!((j as f64 + way - (k as f64 + wanted)).abs() < 1e-12, "{theta}: {j} {way}, {k} {wanted}");
            }
        }
    }
}
