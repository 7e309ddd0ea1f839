//! Shares that add up on paper, not only in the computer.

/// Per cent of `total` for each row, with as many decimals (2 or 3) as the smallest row needs. What rounding leaves over goes to the
/// largest row, where it is least visible, so that the printed rows add up to exactly 100. Without a positive total: dashes.
///
/// What is not zero but rounds to it is "≈ 0". `rows` must add up to `total`.
pub fn shares(rows: &[f64], total: f64) -> Vec<String> {
    if !(total > 0.0 && total.is_finite() && rows.iter().all(|row| row.is_finite())) {
        return vec!["–".into(); rows.len()];
    }
    let decimals = decimals(rows, total);
    let unit = 10f64.powi(decimals as i32);
    let mut steps: Vec<i64> = rows.iter().map(|row| (100.0 * row / total * unit).round() as i64).collect();
    let left = (100.0 * unit) as i64 - steps.iter().sum::<i64>();
    if let Some(largest) = steps.iter_mut().max_by_key(|step| **step) {
        *largest += left;
    }
    let printed = |(&step, &row): (&i64, &f64)| match step {
        0 if row != 0.0 => "≈ 0".into(),
        _ => format!("{:.decimals$}", step as f64 / unit),
    };
    steps.iter().zip(rows).map(printed).collect()
}

fn decimals(rows: &[f64], total: f64) -> usize {
    let smallest = rows.iter().map(|row| (100.0 * row / total).abs()).filter(|&row| row > 1e-6).fold(100.0, f64::min);
    (-smallest.log10().floor()).clamp(2.0, 3.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_shares_add_up_to_a_hundred() {
        let rows = [1.0, 1.0, 1.0, 3.3e-5];
        let printed = shares(&rows, rows.iter().sum());
        let sum: f64 = printed.iter().map(|share| share.parse::<f64>().unwrap()).sum();
        assert!((sum - 100.0).abs() < 1e-9, "{printed:?}");
        assert_eq!(printed[3], "0.001");
    }

    #[test]
    fn a_trace_is_not_called_nothing() {
        assert_eq!(shares(&[1.0, 1e-12, 0.0], 1.0), ["100.00", "≈ 0", "0.00"]);
    }

    #[test]
    fn nothing_has_no_shares() {
        assert_eq!(shares(&[0.0, 0.0], 0.0), ["–", "–"]);
    }
}
