//! Whether a requirement is met.
//!
//! With a limit L, a value m and its standard error e,
//!
//!     PASS   m + t e <= L        FAIL   m - t e > L        NOT RESOLVED   neither
//!
//! t being the quantile of Student's t on one side: with 95 % a PASS is wrong in one of twenty at most. Where nothing arrived, the
//! upper limit must be below L. A value from fewer than 30 source rays, or of which one batch brought more than a quarter, is not resolved:
//! its error is itself a guess.
//! What no source ray has found yet is in no error bar: a PASS is as good as the search was.

use super::results::Estimate;
use serde::Serialize;
use std::fmt;

/// Fewest contributing source rays of a verdict.
const FEWEST: u64 = 30;

/// An answer to a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Verdict {
    #[serde(rename = "PASS")]
    Pass,
    #[serde(rename = "NOT RESOLVED")]
    NotResolved,
    #[serde(rename = "FAIL")]
    Fail,
}

impl fmt::Display for Verdict {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(["PASS", "NOT RESOLVED", "FAIL"][*self as usize])
    }
}

/// What is required of a point, and whether it holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Required {
    /// Largest value of stray light allowed, such as a PST or a ratio to the signal.
    pub limit: f64,
    /// Limit over the value, or over its upper limit where nothing arrived; above 1 there is room.
    pub margin: f64,
    pub verdict: Verdict,
}

impl Required {
    /// Of a value from so many source rays that brought stray light, or of its `upper` limit if there are none; `quantile` is t.
    pub fn of(limit: f64, stray: Estimate, contributing: u64, upper: f64, quantile: f64) -> Required {
        let reach = quantile * stray.error;
        // No stray light, though light came: its upper limit stands for it.
        let nothing = contributing == 0 || stray.mean <= 0.0;
        let verdict = match () {
            () if nothing && upper <= limit => Verdict::Pass,
            () if nothing || contributing < FEWEST => Verdict::NotResolved,
            () if stray.mean + reach <= limit => Verdict::Pass,
            () if stray.mean - reach > limit => Verdict::Fail,
            () => Verdict::NotResolved,
        };
        Required { limit, margin: limit / if nothing { upper } else { stray.mean }, verdict }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_needs_the_whole_interval_on_one_side() {
        let of =
            |limit: f64, rays: u64| Required::of(limit, Estimate { mean: 1.0, error: 0.1 }, rays, 5.0, 1.669).verdict;
        assert_eq!(of(1.2, 100), Verdict::Pass);
        assert_eq!(of(1.1, 100), Verdict::NotResolved);
        assert_eq!(of(0.9, 100), Verdict::NotResolved);
        assert_eq!(of(0.8, 100), Verdict::Fail);
        assert_eq!([of(1.2, 29), of(0.8, 29)], [Verdict::NotResolved; 2]);
    }

    #[test]
    fn where_nothing_came_the_upper_limit_decides() {
        let of = |upper: f64| Required::of(1.0, Estimate::default(), 0, upper, 1.669);
        assert_eq!((of(0.5).verdict, of(0.5).margin), (Verdict::Pass, 2.0));
        assert_eq!(of(1.5).verdict, Verdict::NotResolved);
    }

    #[test]
    fn the_worst_point_decides() {
        let mut all = [Verdict::NotResolved, Verdict::Fail, Verdict::Pass];
        all.sort();
        assert_eq!(all, [Verdict::Pass, Verdict::NotResolved, Verdict::Fail]);
    }
}
