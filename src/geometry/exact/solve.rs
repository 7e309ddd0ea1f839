//! All zeros of a smooth function on an interval, none missed and none invented.
//!
//! With |g''| <= b on an interval of half-width w about m: g is monotone if |g'(m)| > b w, and has no zero if
//! |g(m)| > |g'(m)| w + b w^2 / 2. Otherwise the interval is halved. A monotone piece whose ends differ in sign has one zero,
//! found by Newton steps that never leave the bracket.

use super::Root;
use arrayvec::ArrayVec;

/// Most zeros that are reported.
pub(super) const MOST: usize = 8;

/// Halvings after which a piece counts as touched, not crossed: 2^-48 of the interval.
const DEEPEST: u32 = 48;

/// g(t) -> [g, g'], bounded by |g''| <= `bend` on `from..to`. Zeros in order of t.
pub(super) fn zeros(g: &impl Fn(f64) -> [f64; 2], bend: f64, from: f64, to: f64, found: &mut ArrayVec<Root, MOST>) {
    let (at_from, at_to) = (g(from)[0], g(to)[0]);
    search(g, bend, (from, at_from), (to, at_to), DEEPEST, found);
}

fn search(
    g: &impl Fn(f64) -> [f64; 2],
    bend: f64,
    from: (f64, f64),
    to: (f64, f64),
    depth: u32,
    found: &mut ArrayVec<Root, MOST>,
) {
    let (middle, half) = (0.5 * (from.0 + to.0), 0.5 * (to.0 - from.0));
    let [value, slope] = g(middle);
    if slope.abs() > bend * half {
        if (from.1 < 0.0) != (to.1 < 0.0) && !found.is_full() {
            found.push(Root { t: bracketed(g, from, to), rises: from.1 < 0.0 });
        }
        return;
    }
    let reach = slope.abs() * half + 0.5 * bend * half * half;
    if value.abs() > reach || depth == 0 || found.is_full() {
        return;
    }
    search(g, bend, from, (middle, value), depth - 1, found);
    search(g, bend, (middle, value), to, depth - 1, found);
}

/// The zero between two ends of different sign.
fn bracketed(g: &impl Fn(f64) -> [f64; 2], from: (f64, f64), to: (f64, f64)) -> f64 {
    let rises = from.1 < 0.0;
    let (mut low, mut high) = (from.0, to.0);
    let mut t = from.0 - from.1 * (to.0 - from.0) / (to.1 - from.1);
    for _ in 0..100 {
        if !(low..=high).contains(&t) {
            t = 0.5 * (low + high);
        }
        let [value, slope] = g(t);
        if value == 0.0 {
            break;
        }
        if (value < 0.0) == rises {
            low = t
        } else {
            high = t
        }
        let next = t - value / slope;
        if next == t || high - low <= f64::EPSILON * (low.abs() + high.abs()) {
            break;
        }
        // A step of a few roundings goes to and fro for ever.
        if (next - t).abs() <= 2.0 * f64::EPSILON * t.abs() {
            t = next.clamp(low, high);
            break;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_zero_of_a_wave_is_found_and_none_is_invented() {
        for offset in [-0.999_999, -0.5, 0.0, 0.3, 0.999_999, 1.000_001] {
            let g = |t: f64| [t.sin() + offset, t.cos()];
            let mut found = ArrayVec::new();
            zeros(&g, 1.0, 0.1, 12.0, &mut found);
            let steps = 2_000_000;
            let value = |i: i32| g(0.1 + 11.9 * f64::from(i) / f64::from(steps))[0];
            let changes = (0..steps).filter(|&i| (value(i) < 0.0) != (value(i + 1) < 0.0)).count();
            assert_eq!(found.len(), changes, "{offset}");
            for root in found {
                assert!(g(root.t)[0].abs() < 1e-12);
                assert_eq!(g(root.t)[1] > 0.0, root.rises);
            }
        }
    }
}
