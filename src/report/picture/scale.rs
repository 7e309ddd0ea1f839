//! From a value to a colour.
//!
//! Linear from zero where the lit pixels span less than a factor of 100, else logarithmic over whole decades. The largest and the floor are stated
//! in words, since a picture that hides them can show anything.

use super::ticks;
use crate::report::measured::measured;

/// Decades that a logarithmic scale shows at most; what is fainter takes the colour of the floor.
const DECADES: i32 = 8;

/// Ratio above which a linear scale would show most of a map as black.
const RANGE: f64 = 100.0;

/// No ray arrived: a grey that is not on the scale.
pub const DARK: [u8; 3] = [0xc6, 0xcb, 0xd1];

/// How values become colours. All values are in the map's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Nothing is lit.
    Empty,
    Linear {
        top: f64,
    },
    Log {
        floor: f64,
        top: f64,
    },
}

/// A mark on the colour bar: place 0..1 from the bottom, mantissa text, power of ten.
pub struct Mark {
    pub place: f64,
    pub text: String,
    /// `Some` where the text is a power of ten.
    pub power: Option<i32>,
}

impl Scale {
    /// The scale that suits these values.
    pub fn of(lit: impl Iterator<Item = f64>) -> Scale {
        let (mut low, mut top) = (f64::INFINITY, 0f64);
        for value in lit.filter(|value| *value > 0.0) {
            low = low.min(value);
            top = top.max(value);
        }
        if top == 0.0 {
            return Scale::Empty;
        }
        if top <= RANGE * low {
            return Scale::Linear { top };
        }
        let decade = (low.log10() + 1e-9).floor() as i32; // 1e-9: a low of exactly 1e-5 is its own floor
        let least = (top.log10() - 1e-9).ceil() as i32 - DECADES;
        Scale::Log { floor: 10f64.powi(decade.max(least)), top }
    }

    /// Place on the bar, 0..1.
    pub fn place(&self, value: f64) -> f64 {
        let place = match *self {
            Scale::Empty => 0.0,
            Scale::Linear { top } => value / top,
            Scale::Log { floor, top } if value > 0.0 => (value / floor).ln() / (top / floor).ln(),
            Scale::Log { .. } => 0.0,
        };
        place.clamp(0.0, 1.0)
    }

    pub fn marks(&self) -> Vec<Mark> {
        match *self {
            Scale::Empty => Vec::new(),
            Scale::Linear { top } => {
                let factor = 10f64.powi(-self.exponent());
                let mark = |(place, text)| Mark { place, text, power: None };
                ticks(0.0, top * factor, 5).into_iter().map(mark).collect()
            }
            Scale::Log { floor, top } => {
                let powers = floor.log10().round() as i32..=(top.log10() + 1e-9).floor() as i32;
                let mark = |power| Mark {
                    place: self.place(10f64.powi(power)),
                    text: format!("1e{power}"),
                    power: Some(power),
                };
                powers.map(mark).collect()
            }
        }
    }

    /// Power of ten by which the texts of a linear scale are to be multiplied.
    pub fn exponent(&self) -> i32 {
        match *self {
            Scale::Linear { top } if !(0.01..10_000.0).contains(&top) => top.log10().floor() as i32,
            _ => 0,
        }
    }

    /// What the scale shows and hides, in words; `unit` as printed.
    pub fn statement(&self, unit: &str) -> String {
        match *self {
            Scale::Empty => "no light arrived".into(),
            Scale::Linear { top } => format!("linear scale, 0 to {} {unit}", short(top)),
            Scale::Log { floor, top } => {
                format!(
                    "logarithmic scale, {} to {} {unit}; fainter light has the colour of the floor",
                    short(floor),
                    short(top)
                )
            }
        }
    }
}

/// Three digits are enough to read a colour bar.
fn short(value: f64) -> String {
    format!("{value:.2e}").parse().map_or_else(|_| "?".into(), |rounded: f64| measured(rounded, 0.0))
}

/// Which quantity the colours stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// Dark to bright: how much light.
    Light,
    /// Pale to dark blue: how uncertain.
    Error,
}

impl Palette {
    /// Colour at a place 0..1 on the bar, sRGB.
    pub fn colour(self, place: f64) -> [u8; 3] {
        let gradient = match self {
            Palette::Light => colorous::INFERNO,
            Palette::Error => colorous::YELLOW_GREEN_BLUE,
        };
        let colour = gradient.eval_continuous(place);
        [colour.r, colour.g, colour.b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_range_is_logarithmic_and_its_floor_a_whole_decade() {
        assert_eq!(Scale::of([1.0, 3.0].into_iter()), Scale::Linear { top: 3.0 });
        assert_eq!(Scale::of([2e-5, 3.0].into_iter()), Scale::Log { floor: 1e-5, top: 3.0 });
        assert_eq!(Scale::of([1e-30, 3.0].into_iter()), Scale::Log { floor: 1e-7, top: 3.0 });
        assert_eq!(Scale::of([0.0].into_iter()), Scale::Empty);
    }

    #[test]
    fn places_run_from_the_floor_to_the_top() {
        let scale = Scale::Log { floor: 1e-4, top: 1.0 };
        assert!((scale.place(1e-2) - 0.5).abs() < 1e-12);
        assert_eq!((scale.place(1e-9), scale.place(1.0), scale.place(0.0)), (0.0, 1.0, 0.0));
        assert_eq!(scale.marks().len(), 5);
    }

    #[test]
    fn the_statement_gives_floor_and_top() {
        let said = Scale::Log { floor: 1e-4, top: 12.34 }.statement("W/m2");
        assert!(said.starts_with("logarithmic scale, 1e-4 to 12.3 W/m2"), "{said}");
    }
}
