//! Least squares of any residuals: damped Gauss-Newton steps (Levenberg and Marquardt).
//!
//!     (J^T J + lambda diag(J^T J)) step = -J^T r        lambda falls while the sum of squares does, and rises otherwise
//!
//! J by central differences, so a model is one function. Values should be of the order of 1. Errors are those of the linear
//! theory: covariance = (J^T J)^-1 r^2 / (n - m), of m values and n residuals that are independent.
//! Source: Nocedal & Wright, Numerical Optimization, 2nd ed. (2006), section 10.3.

/// Values at the minimum.
#[derive(Clone, Debug)]
pub struct Minimum {
    pub values: Vec<f64>,
    /// One standard error each, in the unit of the value; infinite where the residuals do not determine it.
    pub errors: Vec<f64>,
    /// Sum of squares.
    pub squares: f64,
}

/// Step of the differences, of 1 + |value|: the error of J is 1e-10 from rounding and 1e-12 from the third derivative.
const STEP: f64 = 1e-6;
const MOST_STEPS: usize = 200;

/// The minimum of the sum of squares reached from `start`; `None` if the residuals are not finite there. Residuals that are not finite
/// elsewhere are a wall. Costs some 2 m evaluations for each of at most 200 steps, mostly 5 to 20.
pub fn minimise(start: Vec<f64>, residuals: &dyn Fn(&[f64]) -> Vec<f64>) -> Option<Minimum> {
    let mut values = start;
    let mut here = residuals(&values);
    let mut squares = sum(&here);
    if !squares.is_finite() {
        return None;
    }
    let mut normal = Normal::at(&values, &here, residuals);
    let mut lambda = 1e-3;
    for _ in 0..MOST_STEPS {
        let Some(step) = normal.step(lambda) else {
            lambda = f64::max(10.0 * lambda, 1e-12);
            if lambda > 1e12 {
                break;
            }
            continue;
        };
        let next: Vec<f64> = values.iter().zip(&step).map(|(value, step)| value + step).collect();
        let there = residuals(&next);
        let gained = squares - sum(&there);
        if gained >= 0.0 {
            let little = gained <= 1e-13 * squares && lambda <= 1e-6;
            (values, here, squares) = (next, there, squares - gained);
            if little {
                break;
            }
            normal = Normal::at(&values, &here, residuals);
            lambda *= 0.1;
        } else if lambda > 1e12 {
            break;
        } else {
            lambda = f64::max(10.0 * lambda, 1e-12);
        }
    }
    let errors = Normal::at(&values, &here, residuals).errors(squares, here.len());
    Some(Minimum { values, errors, squares })
}

fn sum(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

/// The normal equations, scaled so that the diagonal of the matrix is 1.
struct Normal {
    matrix: Vec<Vec<f64>>,
    /// -J^T r
    downhill: Vec<f64>,
    /// Length of each column of J.
    scale: Vec<f64>,
}

impl Normal {
    fn at(values: &[f64], here: &[f64], residuals: &dyn Fn(&[f64]) -> Vec<f64>) -> Normal {
        let columns: Vec<Vec<f64>> = (0..values.len()).map(|i| slope(values, i, here, residuals)).collect();
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        // A value on which nothing depends stays where it is.
        let scale: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
        let count = columns.len();
        let element =
            |i: usize, j: usize| if i == j { 1.0 } else { dot(&columns[i], &columns[j]) / (scale[i] * scale[j]) };
        Normal {
            matrix: (0..count).map(|i| (0..count).map(|j| element(i, j)).collect()).collect(),
            downhill: columns.iter().zip(&scale).map(|(column, scale)| -dot(column, here) / scale).collect(),
            scale,
        }
    }

    fn step(&self, lambda: f64) -> Option<Vec<f64>> {
        let mut matrix = self.matrix.clone();
        (0..matrix.len()).for_each(|i| matrix[i][i] += lambda);
        let step = solve(&cholesky(matrix)?, &self.downhill);
        Some(step.iter().zip(&self.scale).map(|(step, scale)| step / scale).collect())
    }

    fn errors(&self, squares: f64, residuals: usize) -> Vec<f64> {
        let count = self.scale.len();
        let Some(root) = cholesky(self.matrix.clone()) else { return vec![f64::INFINITY; count] };
        let variance = if residuals > count { squares / (residuals - count) as f64 } else { f64::INFINITY };
        let unit = |i: usize| (0..count).map(|j| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
        (0..count).map(|i| (solve(&root, &unit(i))[i] * variance).sqrt() / self.scale[i]).collect()
    }
}

/// d residuals / d value i; one-sided at a wall.
fn slope(values: &[f64], i: usize, here: &[f64], residuals: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let step = STEP * (1.0 + values[i].abs());
    let moved = |by: f64| {
        let mut moved = values.to_vec();
        moved[i] += by;
        residuals(&moved)
    };
    let (ahead, behind) = (moved(step), moved(-step));
    let difference = |((ahead, behind), here): ((&f64, &f64), &f64)| match (ahead.is_finite(), behind.is_finite()) {
        (true, true) => (ahead - behind) / (2.0 * step),
        (true, false) => (ahead - here) / step,
        (false, true) => (here - behind) / step,
        (false, false) => 0.0,
    };
    ahead.iter().zip(&behind).zip(here).map(difference).collect()
}

/// L with L L^T = the matrix; `None` if that is not positive definite.
fn cholesky(mut a: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    for i in 0..a.len() {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            a[i][j] = if i > j { rest / a[j][j] } else { rest.sqrt() };
            if !a[i][j].is_finite() || i == j && a[i][j] <= 0.0 {
                return None;
            }
        }
    }
    Some(a)
}

/// x with L L^T x = b.
fn solve(root: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let count = b.len();
    let mut x = b.to_vec();
    for i in 0..count {
        x[i] = (x[i] - (0..i).map(|k| root[i][k] * x[k]).sum::<f64>()) / root[i][i];
    }
    for i in (0..count).rev() {
        x[i] = (x[i] - (i + 1..count).map(|k| root[k][i] * x[k]).sum::<f64>()) / root[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn rosenbrocks_valley_is_followed_to_its_end() {
        let valley = |v: &[f64]| vec![10.0 * (v[1] - v[0] * v[0]), 1.0 - v[0]];
        let minimum = minimise(vec![-1.2, 1.0], &valley).expect("finite");
        assert!((minimum.values[0] - 1.0).abs() < 1e-9 && (minimum.values[1] - 1.0).abs() < 1e-9, "{minimum:?}");
    }

    /// The pull of a straight line's slope over many draws of the noise has variance 1: 4 sigma of 400 draws are 0.28.
    #[test]
    fn errors_are_standard_errors() {
        let mut rng = Rng::new(7, 0, 0);
        let mut pulls = 0.0;
        for _ in 0..400 {
            let noisy: Vec<f64> =
                (0..50).map(|i| 2.0 * f64::from(i) / 50.0 + (12f64.sqrt() * (rng.uniform() - 0.5))).collect();
            let line = |v: &[f64]| -> Vec<f64> {
                noisy.iter().enumerate().map(|(i, y)| v[0] + v[1] * i as f64 / 50.0 - y).collect()
            };
            let minimum = minimise(vec![0.0, 0.0], &line).expect("finite");
            pulls += ((minimum.values[1] - 2.0) / minimum.errors[1]).powi(2);
        }
        assert!((pulls / 400.0 - 1.0).abs() < 0.28, "{}", pulls / 400.0);
    }

    #[test]
    fn what_is_not_determined_has_no_finite_error() {
        let blind = |v: &[f64]| vec![v[0] - 1.0, v[0] - 1.1, v[0] - 0.9];
        let sum = |v: &[f64]| blind(&[v[0] + v[1]]);
        let minimum = minimise(vec![0.0, 0.0], &sum).expect("finite");
        assert!((minimum.values[0] + minimum.values[1] - 1.0).abs() < 1e-9);
        assert!(minimum.errors[0] > 1e3, "{minimum:?}");
    }
}
