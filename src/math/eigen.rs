//! Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix, by Jacobi's rotations.
//!
//! Source: Golub & Van Loan, Matrix Computations, 4th ed. (2013), section 8.5.

use glam::{DMat3, DVec3};

/// Sweeps over the three elements off the diagonal; convergence is quadratic, six reach the rounding.
const SWEEPS: usize = 12;

/// Eigenvalues in increasing order, each with its unit vector; only symmetric matrices.
pub fn symmetric(matrix: DMat3) -> [(f64, DVec3); 3] {
    let (mut a, mut v) = (matrix, DMat3::IDENTITY);
    for (p, q) in (0..SWEEPS).flat_map(|_| [(0, 1), (0, 2), (1, 2)]) {
        let off = a.col(q)[p];
        if off == 0.0 {
            continue;
        }
        // The smaller of the two angles whose rotation makes the element vanish.
        let theta = (a.col(q)[q] - a.col(p)[p]) / (2.0 * off);
        let tan = 1f64.copysign(theta) / (theta.abs() + theta.hypot(1.0));
        let cos = 1.0 / tan.hypot(1.0);
        let mut turn = DMat3::IDENTITY;
        turn.col_mut(p)[p] = cos;
        turn.col_mut(q)[q] = cos;
        turn.col_mut(q)[p] = tan * cos;
        turn.col_mut(p)[q] = -tan * cos;
        a = turn.transpose() * a * turn;
        v *= turn;
    }
    let mut pairs = [0, 1, 2].map(|i| (a.col(i)[i], v.col(i).normalize()));
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn every_pair_solves_the_equation_and_the_vectors_are_orthonormal() {
        let mut rng = Rng::new(1, 2, 3);
        for _ in 0..500 {
            let mut draw = || 2.0 * rng.uniform() - 1.0;
            let (x, y, z, u, v, w) = (draw(), draw(), draw(), draw(), draw(), draw());
            let matrix = DMat3::from_cols(DVec3::new(x, u, v), DVec3::new(u, y, w), DVec3::new(v, w, z));
            let pairs = symmetric(matrix);
            for (value, vector) in pairs {
                assert!((matrix * vector - value * vector).length() < 1e-14);
            }
            let [a, b, c] = pairs.map(|(_, vector)| vector);
            assert!(a.dot(b).abs() < 1e-14 && (a.cross(b).dot(c).abs() - 1.0).abs() < 1e-14);
            assert!(pairs[0].0 <= pairs[1].0 && pairs[1].0 <= pairs[2].0);
        }
    }
}
