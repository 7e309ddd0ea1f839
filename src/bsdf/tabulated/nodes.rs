//! Angles of incidence at which a table's function is known, found by sine and cosine alone.
//!
//!     sin(theta - theta_j) = sin(theta) cos_j - cos(theta) sin_j
//!     w = sin(theta - theta_j) / (sin(theta - theta_j) + sin(theta_(j+1) - theta))
//!
//! so that the way from one node to the next takes no inverse function; it is linear in theta to step^2 / 50, 1.4e-5 at 1.5 deg.

use super::grid::angle_about;

/// Angles of incidence, strictly rising from 0 to pi/2.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Sine and cosine of each.
    axes: Vec<[f64; 2]>,
    /// Nodes per rad, on the average.
    density: f64,
}

impl Nodes {
    /// Two angles (rad) or more.
    pub fn new(angle: &[f64]) -> Nodes {
        let density = (angle.len() - 1) as f64 / angle[angle.len() - 1];
        Nodes { axes: angle.iter().map(|a| [a.sin(), a.cos()]).collect(), density }
    }

    /// The node at or before the angle of this sine and cosine, and the way to the next, 0..1.
    pub fn bracket(&self, [sin, cos]: [f64; 2]) -> (usize, f64) {
        let last = self.axes.len() - 2;
        let past = |j: usize| sin * self.axes[j][1] - cos * self.axes[j][0];
        let mut j = ((angle_about(cos) * self.density) as usize).min(last);
        while j > 0 && past(j) < 0.0 {
            j -= 1;
        }
        while j < last && past(j + 1) >= 0.0 {
            j += 1;
        }
        let (from, to) = (past(j).max(0.0), -past(j + 1).min(0.0));
        (j, from / (from + to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::table::bracket;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn nodes_are_found_as_by_the_angle() {
        for nodes in [vec![0.0, FRAC_PI_2], vec![0.0, 0.01, 0.02, 0.4, 1.2, 1.3, FRAC_PI_2]] {
            let table = Nodes::new(&nodes);
            for theta in (0..=1000).map(|k| FRAC_PI_2 * f64::from(k) / 1000.0) {
                let ((j, way), (k, wanted)) = (table.bracket([theta.sin(), theta.cos()]), bracket(&nodes, theta));
                let step = nodes[j + 1] - nodes[j];
                // The sum tells one node from the end of the interval before it.
                let error = (j as f64 + way - (k as f64 + wanted)).abs();
                assert!(error < 1e-12 + step * step / 50.0, "{theta}: {j} {way}, {k} {wanted}");
            }
        }
    }
}
