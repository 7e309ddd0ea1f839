//! A number and its error, as one writes them by hand.
//!
//! The error is rounded to two significant digits and the mean to the same decimal place:
//! `0.02267 ± 0.00015`, `(2.267 ± 0.015)e-6`. An error of zero, or of the rounding of a sum, means that the number is not an
//! estimate.

/// "mean ± error" in the caller's unit. Without error: up to six digits; an error that is not a number is shown as "?".
#[must_use]
pub fn measured(mean: f64, error: f64) -> String {
    Digits::of(mean, error).plain()
}

/// "< limit" with two digits, rounded *up*, so that what is printed is still a limit.
#[must_use]
pub fn below(limit: f64) -> String {
    format!("< {}", ceiling(limit))
}

/// Relative error of a sum of equal terms.
const ROUNDING: f64 = 1e-14;

/// A mean and its error in digits that share one power of ten.
pub(super) struct Digits {
    pub mean: String,
    /// `None` for an exact number.
    pub error: Option<String>,
    /// Power of ten that multiplies both; 0 when none is needed.
    pub exponent: i32,
}

impl Digits {
    pub fn of(mean: f64, error: f64) -> Digits {
        if !mean.is_finite() {
            return Digits { mean: "?".into(), error: Some("?".into()), exponent: 0 };
        }
        if !error.is_finite() {
            return Digits { error: Some("?".into()), ..Digits::exact(mean, 4) };
        }
        if error <= ROUNDING * mean.abs() {
            return Digits::exact(mean, 6);
        }
        let largest = decade(mean.abs().max(error), 17);
        let place = decade(error, 2) - 1; // of the error's second digit
        let exponent = if (-3..6).contains(&largest) && place <= 0 { 0 } else { largest };
        let decimals = (exponent - place).clamp(0, 17) as usize;
        let scaled = |value: f64| format!("{:.decimals$}", shifted(value, -exponent));
        Digits { mean: scaled(mean), error: Some(scaled(error)), exponent }
    }

    /// At most `digits` significant digits, trailing zeros dropped.
    fn exact(value: f64, digits: usize) -> Digits {
        if value == 0.0 {
            return Digits { mean: "0".into(), error: None, exponent: 0 };
        }
        let largest = decade(value.abs(), digits);
        let exponent = if (-3..6).contains(&largest) { 0 } else { largest };
        let decimals = (exponent - largest + digits as i32 - 1).clamp(0, 17) as usize;
        let mut mean = format!("{:.decimals$}", shifted(value, -exponent));
        if mean.contains('.') {
            mean.truncate(mean.trim_end_matches('0').trim_end_matches('.').len());
        }
        Digits { mean, error: None, exponent }
    }

    /// With the power of ten as `e-6`, for terminals and tables.
    fn plain(&self) -> String {
        let Digits { mean, error, exponent } = self;
        match (error, exponent) {
            (None, 0) => mean.clone(),
            (None, e) => format!("{mean}e{e}"),
            (Some(error), 0) => format!("{mean} ± {error}"),
            (Some(error), e) => format!("({mean} ± {error})e{e}"),
        }
    }
}

/// Power of ten of the first digit after rounding to `digits` digits. `value` is positive and finite.
fn decade(value: f64, digits: usize) -> i32 {
    let written = format!("{value:.*e}", digits - 1);
    written.rsplit_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// value x 10^power, also where 10^power alone would overflow.
fn shifted(value: f64, power: i32) -> f64 {
    value * 10f64.powi(power / 2) * 10f64.powi(power - power / 2)
}

/// Two digits, never below `limit`.
fn ceiling(limit: f64) -> String {
    if !(limit.is_finite() && limit > 0.0) {
        return "?".into();
    }
    let power = decade(limit, 17);
    let tenths = (shifted(limit, 1 - power) - 1e-9).ceil(); // 1e-9: 3.2 must not become 3.3 by the rounding of the shift
    Digits::exact(shifted(tenths, power - 1), 2).plain()
}

/// 1048576 as "1 048 576", with `gap` between groups of three.
pub(super) fn grouped(count: u64, gap: &str) -> String {
    let digits = count.to_string();
    let mut out = String::with_capacity(digits.len() * 2);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push_str(gap);
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_has_two_digits_and_the_mean_ends_at_the_same_place() {
        assert_eq!(measured(0.022_668_4, 0.000_151_2), "0.02267 ± 0.00015");
        assert_eq!(measured(0.973_123_4, 0.009_96), "0.973 ± 0.010");
        assert_eq!(measured(2.2668e-6, 1.512e-8), "(2.267 ± 0.015)e-6");
        assert_eq!(measured(12_345.678, 35.2), "12346 ± 35");
        assert_eq!(measured(123_456.0, 1234.0), "(1.235 ± 0.012)e5");
        assert_eq!(measured(-1.2e-9, 4.0e-8), "(-0.1 ± 4.0)e-8");
    }

    #[test]
    fn an_exact_number_carries_no_error_and_an_unknown_error_is_said() {
        assert_eq!(measured(1.0, 0.0), "1");
        assert_eq!(measured(0.0, 0.0), "0");
        assert_eq!(measured(0.04, 3e-18), "0.04");
        assert_eq!(measured(0.5, f64::NAN), "0.5 ± ?");
        assert_eq!(measured(f64::NAN, 1.0), "? ± ?");
        assert_eq!(measured(1.25e-300, 0.0), "1.25e-300");
    }

    #[test]
    fn a_limit_is_never_rounded_below_itself() {
        assert_eq!(below(3.2e-9), "< 3.2e-9");
        assert_eq!(below(3.21e-9), "< 3.3e-9");
        assert_eq!(below(9.99e-9), "< 1e-8");
        assert_eq!(below(0.0213), "< 0.022");
        assert_eq!(below(f64::NAN), "< ?");
    }

    #[test]
    fn thousands_are_grouped() {
        assert_eq!(grouped(1_048_576, " "), "1 048 576");
        assert_eq!(grouped(576, " "), "576");
    }
}
