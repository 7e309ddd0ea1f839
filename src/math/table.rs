//! Tables in one variable: finding the interval, interpolating in it, and drawing an entry in proportion to its mass.

/// Interval of the strictly rising `grid` (at least one value) that holds `x`: its index and the fraction of the way through it,
/// 0..1. Beyond the ends the nearest end is returned. Cost: log2 of the length,
/// less on an even grid.
pub fn bracket(grid: &[f64], x: f64) -> (usize, f64) {
    if grid.len() < 2 {
        return (0, 0.0);
    }
    let last = grid.len() - 2;
    // Most tables are even: look where an even one would hold x before searching.
    let guess = ((x - grid[0]) / (grid[last + 1] - grid[0]) * (last + 1) as f64) as usize;
    let found = guess <= last && grid[guess] <= x && x < grid[guess + 1];
    let at = if found { guess } else { grid.partition_point(|&g| g <= x).clamp(1, last + 1) - 1 };
    (at, ((x - grid[at]) / (grid[at + 1] - grid[at])).clamp(0.0, 1.0))
}

/// `values` over the strictly rising `grid` (as many, at least one): linear between, the end values held outside.
pub fn linear(grid: &[f64], values: &[f64], x: f64) -> f64 {
    let (k, w) = bracket(grid, x);
    if w == 0.0 { values[k] } else { values[k] + w * (values[k + 1] - values[k]) }
}

/// First of the four entries about `x` (in steps) in an even table of `count` >= 4, and Lagrange's weights of the cubic through them.
pub fn cubic(x: f64, count: usize) -> (usize, [f64; 4]) {
    let first = (x as usize).saturating_sub(1).min(count - 4);
    let t = x - first as f64;
    let (a, b, c, d) = (t, t - 1.0, t - 2.0, t - 3.0);
    (first, [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0])
}

/// A smooth function at even steps, cubic between: error 0.024 step^4 of its fourth derivative.
#[derive(Clone, Debug)]
pub struct Even {
    from: f64,
    step: f64,
    values: Vec<f64>,
}

impl Even {
    /// `f` at `count` >= 4 places from `from` to `to`.
    pub fn new(from: f64, to: f64, count: usize, f: impl Fn(f64) -> f64) -> Even {
        let step = (to - from) / (count - 1) as f64;
        Even { from, step, values: (0..count).map(|k| f(from + step * k as f64)).collect() }
    }

    /// The function at `x`; outside of the table the nearest cubic goes on.
    pub fn at(&self, x: f64) -> f64 {
        let (first, weights) = cubic((x - self.from) / self.step, self.values.len());
        self.values[first..first + 4].iter().zip(weights).map(|(v, w)| v * w).sum()
    }
}

/// A discrete distribution, drawn by inverting its cumulated masses.
#[derive(Clone, Debug)]
pub struct Discrete {
    /// Sum of the masses up to and with each entry; the last is 1 exactly.
    cumulated: Vec<f64>,
}

impl Discrete {
    /// Entries in proportion to `mass` (>= 0, finite). `None` if all are zero.
    pub fn new(mass: &[f64]) -> Option<Discrete> {
        let total: f64 = mass.iter().sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let mut sum = 0.0;
        let mut cumulated: Vec<f64> = mass
            .iter()
            .map(|m| {
                sum += m;
                sum
            })
            .collect();
        cumulated.iter_mut().for_each(|c| *c /= sum);
        Some(Discrete { cumulated })
    }

    /// Entry drawn by `u` in [0, 1), and a number uniform in [0, 1) left over in it. Never an entry of zero mass.
    pub fn draw(&self, u: f64) -> (usize, f64) {
        let at = self.cumulated.partition_point(|&c| c <= u);
        let from = if at > 0 { self.cumulated[at - 1] } else { 0.0 };
        // u < 1 = last value, so `at` exists and its mass is positive; a rounded quotient of 1 is one step below it.
        (at, ((u - from) / (self.cumulated[at] - from)).min(1.0 - f64::EPSILON / 2.0))
    }

    /// Probability with which [`Discrete::draw`] returns `entry`.
    pub fn probability(&self, entry: usize) -> f64 {
        self.cumulated[entry] - if entry > 0 { self.cumulated[entry - 1] } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bracket_holds_its_value() {
        let grid = [0.0, 1.0, 4.0];
        assert_eq!(bracket(&grid, 0.25), (0, 0.25));
        assert_eq!(bracket(&grid, 1.0), (1, 0.0));
        assert_eq!(bracket(&grid, 2.5), (1, 0.5));
        assert_eq!(bracket(&grid, -1.0), (0, 0.0));
        assert_eq!(bracket(&grid, 9.0), (1, 1.0));
        assert_eq!(bracket(&[5.0], 9.0), (0, 0.0));
        assert_eq!(linear(&grid, &[2.0, 3.0, 6.0], 2.0), 4.0);
        assert_eq!(linear(&[5.0], &[2.0], 9.0), 2.0);
    }

    #[test]
    fn a_cubic_is_met_exactly() {
        let f = |x: f64| 1.0 + x - 2.0 * x * x + 0.5 * x * x * x;
        let even = Even::new(-1.0, 2.0, 13, f);
        for x in [-1.0, -0.93, 0.1, 0.25, 1.99, 2.0] {
            assert!((even.at(x) - f(x)).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn entries_of_no_mass_are_never_drawn() {
        let d = Discrete::new(&[0.0, 1.0, 0.0, 3.0, 0.0]).expect("mass 4");
        assert_eq!(d.draw(0.0), (1, 0.0));
        assert_eq!(d.draw(0.25), (3, 0.0));
        assert_eq!(d.draw(1.0 - f64::EPSILON / 2.0).0, 3);
        assert_eq!([d.probability(0), d.probability(1), d.probability(3)], [0.0, 0.25, 0.75]);
        assert!(Discrete::new(&[0.0, 0.0]).is_none());
    }
}
