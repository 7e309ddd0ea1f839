//! What is required of a sweep: the largest value allowed at each angle.
//!
//!     angle_deg,limit
//!
//! One row per angle, rising; between two rows log(limit) is linear in the angle:
//!
//!     log L(a) = log L1 + (log L2 - log L1) (a - a1) / (a2 - a1)
//!
//! Two rows of one angle are a step, at which the lower limit holds. Nothing is required outside of the rows. Lines that begin with `#`
//! are comments.

use super::Shop;
use crate::error::{Problem, Span};
use crate::system::document as written;

const HEADER: [&str; 2] = ["angle_deg", "limit"];
/// More faults of one file made one mistake many times.
const MOST: usize = 20;
/// What conversions of an angle may change in it, deg.
const ROUNDING: f64 = 1e-9;

/// A requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// The file, as written.
    pub file: String,
    /// Angle from the boresight, deg, not falling, and limit, dimensionless, > 0; at least two.
    pub points: Vec<[f64; 2]>,
}

impl Mask {
    /// The largest value allowed at an angle (deg); `None` where nothing is required.
    pub fn limit(&self, angle: f64) -> Option<f64> {
        let inside = |pair: &&[[f64; 2]]| (pair[0][0] - ROUNDING..=pair[1][0] + ROUNDING).contains(&angle);
        let limits = self.points.windows(2).filter(inside).map(|pair| {
            let ([from, low], [to, high]) = (pair[0], pair[1]);
            let part = if to > from { ((angle - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
            let between = (low.ln() + part * (high / low).ln()).exp();
            // The ends are as written; a step has both.
            let ends = [(from, low), (to, high)].into_iter().filter(|end| (end.0 - angle).abs() <= ROUNDING);
            ends.map(|end| end.1).reduce(f64::min).unwrap_or(between)
        });
        limits.reduce(f64::min)
    }
}

/// The mask of a sweep; what is wrong with its file is noted.
pub fn read(shop: &mut Shop, path: &str, written: &written::Mask) -> Option<Mask> {
    let name = written.file.display().to_string();
    let bytes = match shop.document.load(&written.file) {
        Ok(bytes) => bytes,
        Err(problem) => {
            shop.fault(&format!("{path}.mask.file"), problem);
            return None;
        }
    };
    shop.input(&name, &bytes);
    match points(&String::from_utf8_lossy(&bytes)) {
        Ok(points) => Some(Mask { file: name, points }),
        Err(problems) => {
            let place = shop.document.resolve(&written.file);
            shop.problems.extend(problems.into_iter().map(|problem| problem.in_file(&place)));
            None
        }
    }
}

/// The rows of a file; fails with what is wrong, each with its line.
fn points(text: &str) -> Result<Vec<[f64; 2]>, Vec<Problem>> {
    let text = text.trim_start_matches('\u{feff}');
    let lines = (1..).zip(text.lines()).map(|(number, line)| (number, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (first, header) = lines.next().unwrap_or((1, ""));
    if !header.split(',').map(str::trim).eq(HEADER) {
        let problem = Problem::error("this is not the header of a mask").at(span(first, header));
        return Err(vec![problem.expecting(HEADER.join(","))]);
    }
    let (mut points, mut problems) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        match point(line, points.last()) {
            Ok(point) => points.push(point),
            Err(problem) if problems.len() < MOST => problems.push(problem.at(span(number, line))),
            Err(_) => break,
        }
    }
    if problems.is_empty() && points.len() < 2 {
        let problem = Problem::error(format!("{} rows are no mask", points.len())).at(span(first, header));
        problems.push(problem.expecting("at least two rows"));
    }
    if problems.is_empty() { Ok(points) } else { Err(problems) }
}

fn point(line: &str, before: Option<&[f64; 2]>) -> Result<[f64; 2], Problem> {
    let numbers: Vec<Option<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
    let [Some(angle), Some(limit)] = numbers[..] else {
        return Err(Problem::error("this is not an angle and a limit").expecting("two numbers, such as `10,1e-6`"));
    };
    if !(0.0..=180.0).contains(&angle) {
        return Err(Problem::error(format!("an angle of {angle} deg")).expecting("0 to 180"));
    }
    if !(limit > 0.0 && limit.is_finite()) {
        return Err(Problem::error(format!("a limit of {limit}")).expecting("a number above 0"));
    }
    if before.is_some_and(|before| before[0] > angle) {
        return Err(Problem::error("the angles fall here").expecting("rising angles"));
    }
    Ok([angle, limit])
}

fn span(line: u32, text: &str) -> Span {
    Span { line, column: 1, len: text.chars().count() as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_log_linear_between_rows_and_the_lower_one_holds_at_a_step() {
        let text = "\u{feff}# required\nangle_deg, limit\n5, 1e-2\r\n10, 1e-4\n10, 1e-6\n20, 1e-6\n";
        let mask = Mask { file: String::new(), points: points(text).expect("a mask") };
        assert_eq!(mask.limit(4.9), None);
        assert_eq!(mask.limit(20.1), None);
        assert_eq!(mask.limit(5.0), Some(1e-2));
        assert_eq!(mask.limit(10.0), Some(1e-6));
        let near = |angle: f64, limit: f64| (mask.limit(angle).expect("inside") / limit - 1.0).abs() < 1e-12;
        assert!(near(7.5, 1e-3) && near(9.999_999, 1e-4 * 10f64.powf(0.4e-6)) && near(15.0, 1e-6));
    }

    #[test]
    fn a_bad_mask_is_refused_with_its_lines() {
        let said = |text: &str| points(text).expect_err(text).iter().map(ToString::to_string).collect::<Vec<_>>();
        let header = "line 1, column 1: this is not the header of a mask; expected angle_deg,limit";
        assert_eq!(said(""), [header]);
        assert_eq!(said("angle,limit\n1,2\n"), [header]);
        let few = "line 1, column 1: 1 rows are no mask; expected at least two rows";
        assert_eq!(said("angle_deg,limit\n1,2\n"), [few]);
        let all = said("angle_deg,limit\n5,1\n4,1\n6\n6,0\n181,1\nx,1\n");
        let lines: Vec<&str> = all.iter().map(|line| &line[..6]).collect();
        assert_eq!(lines, ["line 3", "line 4", "line 5", "line 6", "line 7"], "{all:?}");
    }
}
