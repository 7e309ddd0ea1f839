//! Columns of text that line up.

/// Rows of cells under a heading; columns are as wide as their widest cell.
pub struct Table {
    rows: Vec<Vec<String>>,
    /// Columns of numbers, which end together.
    right: &'static [usize],
}

/// Longer names are cut, characters.
const LONGEST: usize = 48;

impl Table {
    /// A table with this heading; the columns `right` are aligned to the right.
    pub fn new<const N: usize>(heading: [&str; N], right: &'static [usize]) -> Table {
        Table { rows: vec![heading.map(String::from).to_vec()], right }
    }

    /// Appends a row.
    pub fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(cells.to_vec());
    }

    /// The table, each line indented by two.
    pub fn text(&self) -> String {
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(|cell| shown(cell)).collect()).collect();
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width =
            |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
        let mut text = String::new();
        for row in &rows {
            let mut line = String::from("  ");
            for (column, cell) in row.iter().enumerate() {
                let width = widths[column];
                let cell =
                    if self.right.contains(&column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") };
                line.push_str(&cell);
                line.push_str("  ");
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// A cell without anything that commands a terminal, and not too wide.
fn shown(cell: &str) -> String {
    let plain = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut text: String = cell.chars().take(LONGEST).map(plain).collect();
    if cell.chars().nth(LONGEST).is_some() {
        text.push_str("...");
    }
    text
}

/// A number with at most `digits` significant digits.
pub fn digits(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if (-4..7).contains(&magnitude) {
        let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
        let text = format!("{value:.decimals$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        // What rounds to nothing has no sign.
        return if text == "-0" { "0".into() } else { text.into() };
    }
    format!("{value:.*e}", digits - 1)
}

/// A point in mm: "(0, -1.5, 20)".
pub fn millimetres(point: glam::DVec3) -> String {
    let [x, y, z] = point.to_array().map(|c| digits(clean(1e3 * c), 6));
    format!("({x}, {y}, {z})")
}

/// A direction: "(0, 0.2588, 0.9659)".
pub fn direction(unit: glam::DVec3) -> String {
    let [x, y, z] = unit.to_array().map(|c| digits(clean(c), 5));
    format!("({x}, {y}, {z})")
}

/// What is nothing but rounding (1e-9 mm, or 1e-9 of a unit vector) is shown as zero.
fn clean(value: f64) -> f64 {
    if value.abs() < 1e-9 { 0.0 } else { value }
}
