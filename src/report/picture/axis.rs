//! Axes and their round numbers.

/// A labelled interval, from the first pixel's outer edge to the last one's.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    pub name: String,
    /// Empty if dimensionless.
    pub unit: &'static str,
    pub from: f64,
    pub to: f64,
}

impl Span {
    /// Quantity and unit, "x, mm".
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{}, {}", self.name, self.unit) }
    }
}

/// Round values (1, 2 or 5 times a power of ten apart) within from..to, about `count` of them, with their text and place 0..1.
pub fn ticks(from: f64, to: f64, count: usize) -> Vec<(f64, String)> {
    let width = to - from;
    if !(width.is_finite() && width != 0.0) {
        return Vec::new();
    }
    let step = round_step(width.abs() / count.max(1) as f64);
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let (low, high) = (from.min(to), from.max(to));
    let slack = 1e-9 * step; // an edge on a round number keeps its tick in spite of rounding
    let first = ((low - slack) / step).ceil() as i64;
    let last = ((high + slack) / step).floor() as i64;
    (first..=last)
        .take(100)
        .map(|index| index as f64 * step)
        .map(|value| (((value - from) / width).clamp(0.0, 1.0), minus(&format!("{value:.decimals$}"))))
        .collect()
}

/// Smallest of 1, 2, 5, 10 times a power of ten that is not far below `wanted`.
fn round_step(wanted: f64) -> f64 {
    let least = 0.66 * wanted;
    let decade = 10f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * decade >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * decade
}

/// Without the sign of a rounded -0.
fn minus(text: &str) -> String {
    let zero = text.chars().all(|c| "-0.".contains(c));
    if zero { text.trim_start_matches('-').into() } else { text.into() }
}

/// -6 as "⁻⁶".
pub fn superscript(power: i32) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    power.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |from, to| ticks(from, to, 5).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
        assert_eq!(texts(-6.4, 6.4), ["-6", "-4", "-2", "0", "2", "4", "6"]);
        assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(10.0, -10.0), ["-10", "-5", "0", "5", "10"]);
        assert!(ticks(1.0, 1.0, 5).is_empty());
        assert_eq!(ticks(0.0, 1.0, 5)[1].0, 0.2);
    }

    #[test]
    fn powers_are_raised() {
        assert_eq!(superscript(-120), "⁻¹²⁰");
        assert_eq!(superscript(45), "⁴⁵");
    }
}
