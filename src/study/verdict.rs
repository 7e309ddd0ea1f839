//! What a comparison comes to, in words.

use super::compare::Change;
use crate::math::statistics::student95;

/// Standard errors from which a change is called decisive; below it, but outside the 95 % interval, it is likely.
const DECISIVE: f64 = 5.0;

/// Part of a loss of stray light that the image must have lost, too, for it to be mere blocking.
const BLOCKING: f64 = 0.5;

/// True if the difference is outside its 95 % interval (Student's t over batches).
pub fn certain(change: &Change, batches: u64) -> bool {
    let apart = change.difference_w;
    apart.mean != 0.0 && apart.mean.abs() > student95(batches) * apart.error
}

/// Stray light against the baseline, with what became of the signal in the same run.
pub fn verdict(stray: &Change, signal: Option<&Change>, batches: u64) -> String {
    if stray.flux_w.mean <= 0.0 && stray.difference_w.mean == 0.0 {
        return "no stray light arrived".into();
    }
    let image = signal.and_then(|signal| told(signal, batches));
    if !certain(stray, batches) {
        let lost = image.map_or(String::new(), |(_, words)| format!("; {words}"));
        return format!("no change ({:.1} σ){lost}", stray.sigma);
    }
    let strength = if stray.sigma >= DECISIVE { "decisive" } else { "likely" };
    let Some(ratio) = stray.ratio else { return format!("{strength}: stray light where there was none") };
    let amount = match ratio.mean {
        r if r > 2.0 => format!("{} times the stray light", number(r, ratio.error)),
        r => {
            let more = if r > 1.0 { "more" } else { "less" };
            format!("{} % {more} stray", number(100.0 * (r - 1.0).abs(), 100.0 * ratio.error))
        }
    };
    match image {
        None => format!("{strength}: {amount}"),
        Some((lost, words)) if ratio.mean < 1.0 && lost >= BLOCKING * (1.0 - ratio.mean) => {
            format!("a gain by blocking: {amount}, {words} too")
        }
        Some((_, words)) => format!("{strength}: {amount}; {words}"),
    }
}

/// The part of the signal that was lost, and words for it; `None` if it is the same.
fn told(signal: &Change, batches: u64) -> Option<(f64, String)> {
    let ratio = signal.ratio.filter(|_| certain(signal, batches))?;
    let percent = number(100.0 * (1.0 - ratio.mean).abs(), 100.0 * ratio.error);
    Some(match ratio.mean {
        r if r < 1.0 => (1.0 - r, format!("the image lost {percent} %")),
        r => (1.0 - r, format!("the image gained {percent} %")),
    })
}

/// "38.2 ± 0.5": the error has one digit, two if it begins with 1.
fn number(value: f64, error: f64) -> String {
    if error <= 1e-9 * value.abs() {
        return format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let first = error.log10().floor();
    let extra = if error / 10f64.powf(first) < 1.95 { 1.0 } else { 0.0 };
    let places = (extra - first).clamp(0.0, 9.0) as usize;
    format!("{value:.places$} ± {error:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tally::results::Estimate;

    fn change(before: f64, after: f64, error: f64) -> Change {
        let difference_w = Estimate { mean: after - before, error };
        Change {
            flux_w: Estimate { mean: after, error },
            difference_w,
            ratio: Some(Estimate { mean: after / before, error: error / before }),
            sigma: difference_w.mean.abs() / error,
        }
    }

    #[test]
    fn a_verdict_names_what_was_gained_and_at_which_price() {
        let same = change(1.0, 1.0, 0.001);
        assert_eq!(verdict(&change(1.0, 0.62, 0.01), Some(&same), 64), "decisive: 38.0 ± 1.0 % less stray");
        assert_eq!(verdict(&change(1.0, 0.994, 0.01), Some(&same), 64), "no change (0.6 σ)");
        let blocked = verdict(&change(1.0, 0.88, 0.002), Some(&change(1.0, 0.88, 0.002)), 64);
        assert_eq!(blocked, "a gain by blocking: 12.0 ± 0.2 % less stray, the image lost 12.0 ± 0.2 % too");
        assert_eq!(verdict(&change(1.0, 1.03, 0.01), None, 64), "likely: 3.0 ± 1.0 % more stray");
        assert_eq!(verdict(&change(1.0, 3.0, 0.02), None, 64), "decisive: 3.00 ± 0.02 times the stray light");
    }
}
