//! Numbers with a dimension.

use crate::system::units::Powers;
use glam::DVec3;

/// A number in SI and what it measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// In m, rad, W, K and Pa to their powers.
    pub value: f64,
    pub powers: Powers,
    /// As somebody wrote it, if nothing was computed: `120 mm`.
    pub written: Option<String>,
}

/// What an expression comes to.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Scalar(Quantity),
    Triple([Quantity; 3]),
}

impl Quantity {
    /// A number without unit.
    pub fn plain(value: f64) -> Quantity {
        Quantity { value, powers: Powers::default(), written: None }
    }

    /// A computed number.
    pub(super) fn computed(value: f64, powers: Powers) -> Quantity {
        Quantity { value, powers, written: None }
    }

    /// As written, or in SI with as many digits as it takes to read the same number again: `0.12 m`.
    pub fn text(&self) -> String {
        if let Some(written) = &self.written {
            return written.clone();
        }
        format!("{} {}", digits(self.value), unit(self.powers)).trim_end().to_owned()
    }

    /// Its kind for a message: `a length`, `a number`.
    pub(super) fn kind(&self) -> String {
        match unit(self.powers).as_str() {
            "" => "a number".into(),
            "m" => "a length".into(),
            "rad" => "an angle".into(),
            "W" => "a flux".into(),
            other => format!("in {other}"),
        }
    }
}

impl Value {
    /// As RON: a number, or a quantity or three in quotes, as one writes them where they are wanted.
    pub fn ron(&self) -> String {
        match self {
            Value::Scalar(quantity) if quantity.powers == Powers::default() => {
                quantity.written.clone().unwrap_or_else(|| digits(quantity.value))
            }
            Value::Scalar(quantity) => format!("\"{}\"", quantity.text()),
            Value::Triple(three) => {
                let powers = three.iter().map(|one| one.powers).find(|powers| *powers != Powers::default());
                let DVec3 { x, y, z } = DVec3::from_array(three.each_ref().map(|one| one.value));
                let text =
                    format!("({}, {}, {}) {}", digits(x), digits(y), digits(z), unit(powers.unwrap_or_default()));
                format!("\"{}\"", text.trim_end())
            }
        }
    }
}

/// The shortest decimal number that reads as this double.
fn digits(value: f64) -> String {
    let plain = value == 0.0 || (1e-5..1e9).contains(&value.abs());
    if plain { format!("{value}") } else { format!("{value:e}") }
}

/// The SI unit: `m`, `m^2`, `W/m2`, `m*rad`; nothing for a number.
fn unit(powers: Powers) -> String {
    if powers == [-2, 0, 1, 0, 0] {
        return "W/m2".into();
    }
    let one = |(name, power): (&str, i8)| match power {
        0 => None,
        1 => Some(name.to_owned()),
        power => Some(format!("{name}^{power}")),
    };
    let units: Vec<String> = ["m", "rad", "W", "K", "Pa"].into_iter().zip(powers).filter_map(one).collect();
    units.join("*")
}
