//! Numbers as they are typeset.

use crate::report::measured::{Digits, below};
use crate::report::picture::superscript;
use crate::tally::results::Estimate;
use maud::{Markup, html};

/// mean ± error unit, powers of ten raised; the parts never break apart.
pub fn estimate(value: Estimate, unit: &str) -> Markup {
    let Digits { mean, error, exponent } = Digits::of(value.mean, value.error);
    let brackets = error.is_some() && exponent != 0;
    html! {
        span.number {
            @if brackets { "(" }
            (minus(&mean))
            @if let Some(error) = error { span.error { " ± " (error) } }
            @if brackets { ")" }
            @if exponent != 0 { " × 10" sup { (minus(&exponent.to_string())) } }
            @if !unit.is_empty() { span.unit { " " (power(unit)) } }
        }
    }
}

/// A number without error.
pub fn plain(value: f64, unit: &str) -> Markup {
    let rounded = format!("{value:.3e}").parse().unwrap_or(f64::NAN);
    estimate(Estimate { mean: rounded, error: 0.0 }, unit)
}

/// "< limit unit", rounded up.
pub fn limit(limit: f64, unit: &str) -> Markup {
    let text = below(limit);
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, ""));
    html! {
        span.number {
            (digits) @if !exponent.is_empty() { " × 10" sup { (minus(exponent)) } }
            span.unit { " " (power(unit)) }
        }
    }
}

/// "W/m2" as "W/m²".
pub fn power(unit: &str) -> String {
    unit.replace('2', "²")
}

/// A colour bar's power of ten.
pub fn ten(power: i32) -> String {
    format!("10{}", superscript(power))
}

/// A hyphen before a digit as a minus sign.
pub fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// Three coordinates in mm from metres, or a unit vector.
pub fn triple(vector: [f64; 3], factor: f64) -> String {
    let part = |x: f64| {
        let text = format!("{:.4}", factor * x);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" { "0".to_owned() } else { minus(text) }
    };
    format!("({}, {}, {})", part(vector[0]), part(vector[1]), part(vector[2]))
}

/// Colour of a class of light, the same wherever it appears.
pub fn tone(class: &str) -> &'static str {
    let order =
        class.rsplit(' ').next().and_then(|order| order.trim_end_matches('+').parse::<usize>().ok()).unwrap_or(1);
    let shade = |shades: [&'static str; 3]| shades[order.clamp(1, 3) - 1];
    match class.split(' ').next().unwrap_or_default() {
        "signal" => "#1f5c7a",
        "direct" => "#a3243b",
        "ghost" => shade(["#d9822b", "#e8a95c", "#f1cc98"]),
        "scatter" => shade(["#6a4c93", "#9479b8", "#bfaed6"]),
        _ => "#8b939c",
    }
}
