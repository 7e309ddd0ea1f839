//! Eight functions of two variables on a square: polynomials of total degree [`DEGREE`], in half the memory of doubles.
//!
//!     f(u, v) = middle + sum over i + j <= DEGREE of c_ij u^i v^j,    u, v = -1..1
//!
//! They are Chebyshev's series through 8 x 8 nodes without its terms of higher total degree. The middle and the c_ij are stored in
//! single precision and c_00 is what the rounding of the middle leaves, so that f is off by some 1e-7 of its way from the middle, not
//! of itself. Horner's scheme runs in single precision, too, and the last sum in double; there are no fused operations, so the bits
//! are the same everywhere.
//!
//! Source: Trefethen, Approximation Theory and Approximation Practice (2013), ch. 3 (the coefficients from the nodes); Trefethen,
//! Cubature, approximation, and isotropy in the hypercube, SIAM Review 59 (2017) 469 (what the total degree leaves out).

use glam::Vec4;
use std::f64::consts::PI;

/// Greatest i + j.
pub const DEGREE: usize = 7;
/// Nodes along either side.
pub const NODES: usize = DEGREE + 1;

/// A value of each function.
pub type Values = [f64; 8];
/// The same in single precision.
pub type Row = [Vec4; 2];

/// Rows of a patch of a degree: the middle and the terms.
pub const fn rows(degree: usize) -> usize {
    1 + (degree + 1) * (degree + 2) / 2
}

/// The nodes along a side, -1..1.
pub fn nodes() -> [f64; NODES] {
    std::array::from_fn(|k| (PI * (k as f64 + 0.5) / NODES as f64).cos())
}

/// Coefficients c_ij of u^i v^j; those of i + j > [`DEGREE`] are 0.
pub struct Terms([[Values; NODES]; NODES]);

impl Terms {
    /// From the values at the [`nodes`] of u, then v.
    pub fn through(values: &[[Values; NODES]; NODES]) -> Terms {
        let (chebyshev, powers) = (chebyshev(), powers());
        let mut series = across(&across(values, &chebyshev), &chebyshev);
        for (k, line) in series.iter_mut().enumerate() {
            line.iter_mut().skip(NODES - k).for_each(|term| *term = [0.0; 8]);
        }
        Terms(across(&across(&series, &powers), &powers))
    }

    /// Most that the terms of i + j > `degree` come to in any of the functions.
    pub fn beyond(&self, degree: usize) -> f64 {
        let mut sums = [0.0; 8];
        for (i, line) in self.0.iter().enumerate() {
            for term in line.iter().skip((degree + 1).saturating_sub(i)) {
                sums.iter_mut().zip(term).for_each(|(sum, term)| *sum += term.abs());
            }
        }
        largest(&sums)
    }

    /// Size of the middle and of all that leads away from it.
    pub fn size(&self) -> f64 {
        largest(&self.0[0][0]) + self.beyond(0)
    }

    /// Sizes of the highest powers of u and of v.
    pub fn highest(&self) -> [f64; 2] {
        [largest(&self.0[DEGREE][0]), largest(&self.0[0][DEGREE])]
    }

    /// Writes the [`rows`] of a patch of `degree`, in the order in which [`sum`] and [`sum_of`] read them.
    pub fn store(&self, degree: usize, rows: &mut Vec<Row>) {
        let middle = row(&self.0[0][0]);
        rows.push(middle);
        for i in (0..=degree).rev() {
            rows.extend(self.0[i][..=degree - i].iter().rev().map(row));
        }
        // The last is c_00.
        if let Some(last) = rows.last_mut() {
            let middle = values(middle);
            *last = row(&std::array::from_fn(|f| self.0[0][0][f] - middle[f]));
        }
    }
}

/// The functions at (u, v) from the [`rows`] of a patch of [`DEGREE`]: [`sum_of`], without a loop whose length changes.
pub fn sum(patch: &[Row; rows(DEGREE)], [u, v]: [f64; 2]) -> Values {
    let (v, mut terms) = (v as f32, &patch[1..]);
    let lines = [
        line::<1>(&mut terms, v),
        line::<2>(&mut terms, v),
        line::<3>(&mut terms, v),
        line::<4>(&mut terms, v),
        line::<5>(&mut terms, v),
        line::<6>(&mut terms, v),
        line::<7>(&mut terms, v),
        line::<8>(&mut terms, v),
    ];
    from(patch[0], horner(&lines, u as f32))
}

/// The same of any degree.
pub fn sum_of(degree: usize, patch: &[Row], [u, v]: [f64; 2]) -> Values {
    let mut way = [Vec4::ZERO; 2];
    let mut terms = &patch[1..];
    for count in 1..=degree + 1 {
        let (first, others) = terms.split_at(count);
        terms = others;
        way = horner(&[way, horner(first, v as f32)], u as f32);
    }
    from(patch[0], way)
}

/// The sum of the next terms, which have one power of u.
#[inline(always)]
fn line<const COUNT: usize>(terms: &mut &[Row], v: f32) -> Row {
    let Some((first, others)) = terms.split_first_chunk::<COUNT>() else { return [Vec4::ZERO; 2] };
    *terms = others;
    horner(first, v)
}

/// The polynomial of these coefficients, the highest first.
#[inline(always)]
fn horner(terms: &[Row], t: f32) -> Row {
    terms[1..].iter().fold(terms[0], |sum, term| [sum[0] * t + term[0], sum[1] * t + term[1]])
}

/// A middle and the way from it.
fn from(middle: Row, way: Row) -> Values {
    let (middle, way) = (values(middle), values(way));
    std::array::from_fn(|f| middle[f] + way[f])
}

fn row(values: &Values) -> Row {
    let [a, b, c, d, e, f, g, h] = values.map(|value| value as f32);
    [Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)]
}

fn values([front, back]: Row) -> Values {
    let ([a, b, c, d], [e, f, g, h]) = (front.to_array(), back.to_array());
    [a, b, c, d, e, f, g, h].map(f64::from)
}

/// Applies a matrix to the first index and puts it last: twice, both indices have been seen to.
fn across(table: &[[Values; NODES]; NODES], matrix: &[[f64; NODES]; NODES]) -> [[Values; NODES]; NODES] {
    let mut found = [[[0.0; 8]; NODES]; NODES];
    for (line, factors) in table.iter().zip(0..NODES) {
        for (column, values) in line.iter().enumerate() {
            for (k, row) in matrix.iter().enumerate() {
                found[column][k].iter_mut().zip(values).for_each(|(sum, value)| *sum += row[factors] * value);
            }
        }
    }
    found
}

/// Coefficients of Chebyshev's polynomials (rows) from values at the nodes (columns).
fn chebyshev() -> [[f64; NODES]; NODES] {
    let weight = |k: usize| if k == 0 { 1.0 } else { 2.0 } / NODES as f64;
    let polynomial = |k: usize, node: usize| (PI * k as f64 * (node as f64 + 0.5) / NODES as f64).cos();
    std::array::from_fn(|k| std::array::from_fn(|node| weight(k) * polynomial(k, node)))
}

/// Coefficients of powers (rows) from those of Chebyshev's polynomials (columns): T_k+1 = 2 t T_k - T_k-1.
fn powers() -> [[f64; NODES]; NODES] {
    let mut powers = [[0.0; NODES]; NODES];
    [powers[0][0], powers[1][1]] = [1.0; 2];
    for k in 2..NODES {
        for power in 0..NODES {
            let before = if power == 0 { 0.0 } else { powers[power - 1][k - 1] };
            powers[power][k] = 2.0 * before - powers[power][k - 2];
        }
    }
    powers
}

fn largest(values: &Values) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored(f: impl Fn(f64, f64) -> f64, degree: usize) -> Vec<Row> {
        let value = |u: f64, v: f64| std::array::from_fn(|k| (k + 1) as f64 * f(u, v));
        let mut patch = Vec::new();
        Terms::through(&nodes().map(|u| nodes().map(|v| value(u, v)))).store(degree, &mut patch);
        patch
    }

    fn worst(f: impl Fn(f64, f64) -> f64 + Copy, degree: usize) -> f64 {
        let patch = stored(f, degree);
        assert_eq!(patch.len(), rows(degree));
        let mut worst = 0.0f64;
        for step in 0..441 {
            let [u, v] = [f64::from(step % 21) / 10.0 - 1.0, f64::from(step / 21) / 10.0 - 1.0];
            if let Some(patch) = patch.first_chunk().filter(|_| degree == DEGREE) {
                assert_eq!(sum(patch, [u, v]), sum_of(degree, patch, [u, v]));
            }
            let off = |(k, found): (usize, f64)| (found / (k + 1) as f64 - f(u, v)).abs();
            worst = sum_of(degree, &patch, [u, v]).into_iter().enumerate().map(off).fold(worst, f64::max);
        }
        worst
    }

    #[test]
    fn a_polynomial_is_itself() {
        let f = |u: f64, v: f64| 1.0 - 0.5 * u + 0.25 * u * v - 0.125 * u.powi(2) * v;
        assert!(worst(f, 3) < 1e-7 && worst(f, DEGREE) < 1e-7);
        assert!(worst(f, 2) > 0.1);
    }

    /// Waves of 0.3 radians to either side: the terms left out come to 2 (0.3)^8 / 8! = 3e-9.
    #[test]
    fn a_short_way_from_a_large_middle_is_exact_to_its_own_size() {
        let f = |u: f64, v: f64| 1.0 + 1e-3 * (0.3 * u + 0.3 * v).sin();
        let worst = worst(f, DEGREE);
        assert!(worst < 1e-10, "{worst:e}");
    }
}
