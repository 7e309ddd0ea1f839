//! Quantities as text: `"2.5 mm"`, `"550 nm"`, `"0.05 deg"`, `"1361 W/m2"`, `"(0, 0, 120) mm"`.
//!
//! Each type holds SI and is converted once, while it is read. Powers of ten are applied to the decimal exponent before
//! the number becomes binary, so that `"550 nm"` is the double nearest to 550e-9. A bare number where a unit is needed
//! is an error that says what to write. Spelling is free where it cannot be misread: `um`, `µm`; `W/m2`, `W/m^2`, `W/m²`.

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};
use std::f64::consts::PI;
use std::{fmt, marker::PhantomData};

/// A unit: its spelling, and its size `factor * 10^exponent` in SI.
type Unit = (&'static str, f64, i32);

const LENGTH: &[Unit] = &[
    ("mm", 1.0, -3),
    ("m", 1.0, 0),
    ("cm", 1.0, -2),
    ("um", 1.0, -6),
    ("nm", 1.0, -9),
    ("km", 1.0, 3),
    ("in", 254.0, -4),
    ("inch", 254.0, -4),
];
const WAVELENGTH: &[Unit] = &[("nm", 1.0, -9), ("um", 1.0, -6), ("mm", 1.0, -3), ("m", 1.0, 0)];
const WAVELENGTH_SQUARED: &[Unit] = &[("um2", 1.0, -12), ("nm2", 1.0, -18), ("m2", 1.0, 0)];
const ABSORPTION: &[Unit] = &[
    ("/mm", 1.0, 3),
    ("/m", 1.0, 0),
    ("/cm", 1.0, 2),
    ("/um", 1.0, 6),
    ("1/mm", 1.0, 3),
    ("1/m", 1.0, 0),
    ("1/cm", 1.0, 2),
    ("mm-1", 1.0, 3),
    ("m-1", 1.0, 0),
    ("cm-1", 1.0, 2),
];
const POWER_DENSITY: &[Unit] =
    &[("nm2um2", 1.0, -30), ("nm2mm2", 1.0, -24), ("um4", 1.0, -24), ("nm4", 1.0, -36), ("m4", 1.0, 0)];
const ANGLE: &[Unit] = &[
    ("deg", PI / 180.0, 0),
    ("rad", 1.0, 0),
    ("mrad", 1.0, -3),
    ("urad", 1.0, -6),
    ("arcmin", PI / 10_800.0, 0),
    ("arcsec", PI / 648_000.0, 0),
];
const FLUX: &[Unit] =
    &[("W", 1.0, 0), ("mW", 1.0, -3), ("uW", 1.0, -6), ("nW", 1.0, -9), ("pW", 1.0, -12), ("kW", 1.0, 3)];
const IRRADIANCE: &[Unit] = &[
    ("W/m2", 1.0, 0),
    ("mW/m2", 1.0, -3),
    ("uW/m2", 1.0, -6),
    ("kW/m2", 1.0, 3),
    ("W/cm2", 1.0, 4),
    ("mW/cm2", 1.0, 1),
    ("uW/cm2", 1.0, -2),
    ("W/mm2", 1.0, 6),
    ("mW/mm2", 1.0, 3),
];
const TEMPERATURE: &[Unit] = &[("K", 1.0, 0)];
const PRESSURE: &[Unit] = &[("Pa", 1.0, 0), ("hPa", 1.0, 2), ("kPa", 1.0, 3), ("mbar", 1.0, 2), ("bar", 1.0, 5)];

/// Powers of m, rad, W, K and Pa in a unit.
pub type Powers = [i8; 5];

/// All units by what they measure; [`Coefficient`] adds the powers of lengths.
const ALL: [(&[Unit], Powers); 9] = [
    (LENGTH, [1, 0, 0, 0, 0]),
    (WAVELENGTH_SQUARED, [2, 0, 0, 0, 0]),
    (ABSORPTION, [-1, 0, 0, 0, 0]),
    (POWER_DENSITY, [4, 0, 0, 0, 0]),
    (ANGLE, [0, 1, 0, 0, 0]),
    (FLUX, [0, 0, 1, 0, 0]),
    (IRRADIANCE, [-2, 0, 1, 0, 0]),
    (TEMPERATURE, [0, 0, 0, 1, 0]),
    (PRESSURE, [0, 0, 0, 0, 1]),
];

/// A number with any unit in SI, and what it measures; `None` if there is no such unit, an error if it is too large.
pub fn measured(number: &str, unit: &str) -> Option<Result<(f64, Powers), String>> {
    if let Some((unit, powers)) = ALL.iter().find_map(|(units, powers)| Some((find(unit, units).ok()?, *powers))) {
        return Some(convert(number, unit).map(|value| (value, powers)));
    }
    let power = Coefficient::from_text(&format!("{number} {unit}")).ok()?;
    Some(Ok((power.value, [power.exponent as i8, 0, 0, 0, 0])))
}

/// True if this is the spelling of a unit.
pub fn is_unit(spelling: &str) -> bool {
    ALL.iter().any(|(units, _)| find(spelling, units).is_ok())
}

/// What can be read from the text of one RON string.
pub trait FromText: Sized {
    /// What to write, with an example: `a length with its unit, such as "12.7 mm"`.
    const EXPECTED: &'static str;

    /// The value in SI, or what is wrong with the text (without repeating what was expected).
    fn from_text(text: &str) -> Result<Self, String>;
}

/// Reads a [`FromText`] value; anything but a string is refused with [`FromText::EXPECTED`].
pub fn from_string<'de, T: FromText, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    struct Text<T>(PhantomData<T>);
    impl<T: FromText> de::Visitor<'_> for Text<T> {
        type Value = T;
        fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
            out.write_str(T::EXPECTED)
        }
        fn visit_str<E: de::Error>(self, text: &str) -> Result<T, E> {
            T::from_text(text).map_err(|what| E::custom(format!("{what}{EXPECTED}{}", T::EXPECTED)))
        }
        fn visit_f64<E: de::Error>(self, _: f64) -> Result<T, E> {
            Err(E::custom(format!("{BARE_NUMBER}{EXPECTED}{}", T::EXPECTED)))
        }
        fn visit_u64<E: de::Error>(self, _: u64) -> Result<T, E> {
            self.visit_f64(0.0)
        }
        fn visit_i64<E: de::Error>(self, _: i64) -> Result<T, E> {
            self.visit_f64(0.0)
        }
    }
    deserializer.deserialize_any(Text(PhantomData))
}

/// What is wrong with a number where text is wanted, in the messages of [`from_string`].
pub const BARE_NUMBER: &str = "this is a bare number";

/// Stands between what is wrong and what was expected in the messages of [`from_string`].
pub const EXPECTED: &str = "; expected ";

/// Newtypes over SI values and how each is written: one list for the type, its units and its message.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident($inner:ty) = $read:ident($units:expr), $expected:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name(pub $inner);

        impl FromText for $name {
            const EXPECTED: &'static str = $expected;
            fn from_text(text: &str) -> Result<Self, String> {
                $read(text, $units).map($name)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                from_string(deserializer)
            }
        }
    )*};
}

quantities! {
    /// A length, m.
    Length(f64) = scalar(LENGTH), "a length with its unit, such as \"12.7 mm\"";
    /// A vacuum wavelength, m.
    Wavelength(f64) = scalar(WAVELENGTH), "a wavelength with its unit, such as \"550 nm\"";
    /// A squared wavelength (a Sellmeier resonance), m2.
    WavelengthSquared(f64) = scalar(WAVELENGTH_SQUARED), "a squared wavelength with its unit, such as \"0.006 um2\"";
    /// An absorption coefficient, 1/m.
    Absorption(f64) = scalar(ABSORPTION), "an absorption coefficient with its unit, such as \"0.1 /mm\"";
    /// A spatial frequency, 1/m.
    Frequency(f64) = scalar(ABSORPTION), "a spatial frequency with its unit, such as \"10 /mm\"";
    /// A two-dimensional power spectral density of heights, m4.
    PowerDensity(f64) = scalar(POWER_DENSITY), "a two-dimensional power spectral density, such as \"2.5 nm2 um2\"";
    /// An angle, rad.
    Angle(f64) = scalar(ANGLE), "an angle with its unit, such as \"0.05 deg\"";
    /// A radiant flux, W.
    Flux(f64) = scalar(FLUX), "a flux with its unit, such as \"1 W\"";
    /// An irradiance, W/m2.
    Irradiance(f64) = scalar(IRRADIANCE), "an irradiance with its unit, such as \"1361 W/m2\"";
    /// A temperature, K.
    Temperature(f64) = scalar(TEMPERATURE), "a temperature in kelvin, such as \"5778 K\"";
    /// A pressure, Pa.
    Pressure(f64) = scalar(PRESSURE), "a pressure with its unit, such as \"1013.25 hPa\"";
    /// A point or a displacement, m.
    Position(DVec3) = triple(LENGTH), "three lengths with one unit, such as \"(0, 0, 120) mm\"";
    /// Three angles about x, y and z, rad.
    Angles(DVec3) = triple(ANGLE), "three angles with one unit, such as \"(0, 90, 0) deg\"";
    /// A unit vector, dimensionless.
    Direction(DVec3) = unit_vector(&[]), "a direction without unit, such as \"(0, 0, 1)\"";
    /// One unit of length of a file, m.
    LengthUnit(f64) = unit_alone(LENGTH), "a unit of length, such as \"mm\"";
}

/// A coefficient of a power series in a length: `"1.2e-5 mm^-3"`, in m^`exponent`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    pub value: f64,
    /// Power of the unit of length.
    pub exponent: i32,
}

impl FromText for Coefficient {
    const EXPECTED: &'static str = "a coefficient with a power of a length as its unit, such as \"1.2e-5 mm^-3\"";
    fn from_text(text: &str) -> Result<Self, String> {
        let (number, rest) =
            split_number(text.trim()).ok_or_else(|| format!("{text:?} does not begin with a number"))?;
        let value = convert(number, ("", 1.0, 0))?;
        let rest = rest.trim().replace('^', "");
        if rest.is_empty() {
            return Ok(Coefficient { value, exponent: 0 });
        }
        let letters = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
        let (name, power) = rest.split_at(letters);
        let (_, factor, tens) = find(name, LENGTH).map_err(|what| format!("{text:?}: {what}"))?;
        let exponent = if power.trim().is_empty() { Some(1) } else { power.trim().parse::<i32>().ok() };
        let exponent = exponent.filter(|e| e.abs() <= 64).ok_or_else(|| format!("{text:?}: {power:?} is no power"))?;
        // Powers of ten go to the decimal exponent, so that they cost no digit.
        let scaled = convert(number, ("", 1.0, tens * exponent))? * factor.powi(exponent);
        Ok(Coefficient { value: scaled, exponent })
    }
}

impl<'de> Deserialize<'de> for Coefficient {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        from_string(deserializer)
    }
}

/// A number and its unit.
fn scalar(text: &str, units: &[Unit]) -> Result<f64, String> {
    let (number, rest) = split_number(text.trim())
        .ok_or_else(|| format!("{text:?} does not begin with a number{}", decimal_comma(text)))?;
    let unit = rest.trim();
    if unit.is_empty() {
        return Err(format!("{text:?} has no unit"));
    }
    convert(number, find(unit, units).map_err(|what| format!("{text:?}: {what}{}", decimal_comma(text)))?)
}

/// Three numbers in parentheses and their common unit.
fn triple(text: &str, units: &[Unit]) -> Result<DVec3, String> {
    let (numbers, rest) = split_triple(text)?;
    let unit = rest.trim();
    if unit.is_empty() {
        return Err(format!("{text:?} has no unit"));
    }
    let unit = find(unit, units).map_err(|what| format!("{text:?}: {what}"))?;
    Ok(DVec3::new(convert(numbers[0], unit)?, convert(numbers[1], unit)?, convert(numbers[2], unit)?))
}

/// Three numbers in parentheses, scaled to length 1.
fn unit_vector(text: &str, _: &[Unit]) -> Result<DVec3, String> {
    let (numbers, rest) = split_triple(text)?;
    if !rest.trim().is_empty() {
        return Err(format!("{text:?}: a direction has no unit"));
    }
    let one = ("", 1.0, 0);
    let vector = DVec3::new(convert(numbers[0], one)?, convert(numbers[1], one)?, convert(numbers[2], one)?);
    // Scaled by the largest component first, so that the squares neither overflow nor underflow.
    let largest = vector.abs().max_element();
    if largest < f64::MIN_POSITIVE {
        return Err(format!("{text:?} has no length, so it points nowhere"));
    }
    Ok((vector / largest).normalize())
}

/// A unit without a number.
fn unit_alone(text: &str, units: &[Unit]) -> Result<f64, String> {
    convert("1", find(text.trim(), units).map_err(|what| format!("{text:?}: {what}"))?)
}

/// The unit of this spelling.
fn find(spelling: &str, units: &[Unit]) -> Result<Unit, String> {
    let plain: String = spelling
        .chars()
        .filter(|c| !c.is_whitespace() && *c != '^')
        .map(|c| if matches!(c, 'µ' | 'μ') { 'u' } else { c })
        .collect();
    let plain = plain.replace('²', "2").replace('°', "deg").replace("⁻¹", "-1");
    let same = |unit: &&Unit| unit.0 == plain;
    units.iter().find(same).copied().ok_or_else(|| {
        let names: Vec<&str> = units.iter().map(|unit| unit.0).collect();
        format!("no such unit here: {spelling:?}; one of {}", names.join(", "))
    })
}

/// `number * factor * 10^exponent`, rounded once for a power of ten; refused if it is not finite.
fn convert(number: &str, (_, factor, exponent): Unit) -> Result<f64, String> {
    let (mantissa, written) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let power = written.parse::<i32>().ok().and_then(|power| power.checked_add(exponent));
    let value = power.and_then(|power| format!("{mantissa}e{power}").parse::<f64>().ok()).map(|value| value * factor);
    match value {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{number} is too large a number")),
    }
}

/// The longest decimal number at the start of the text (`-1.5e-3`), and what follows it.
pub(super) fn split_number(text: &str) -> Option<(&str, &str)> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let start = sign(0);
    let whole = digits(start);
    let mut end = start + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let first = end + 1 + sign(end + 1);
        let power = if first <= bytes.len() { digits(first) } else { 0 };
        if power > 0 {
            end = first + power;
        }
    }
    Some(text.split_at(end))
}

/// The three numbers of `(x, y, z) rest`, and the rest.
fn split_triple(text: &str) -> Result<([&str; 3], &str), String> {
    let wrong = || format!("{text:?} is not three numbers in parentheses");
    let (inside, rest) = text.trim().strip_prefix('(').and_then(|t| t.split_once(')')).ok_or_else(wrong)?;
    let mut numbers = [""; 3];
    let mut parts = inside.split(',').map(str::trim);
    for number in &mut numbers {
        *number = parts.next().filter(|part| matches!(split_number(part), Some((_, "")))).ok_or_else(wrong)?;
    }
    if parts.next().is_some() { Err(wrong()) } else { Ok((numbers, rest)) }
}

/// A hint if the text looks like a number with a decimal comma.
fn decimal_comma(text: &str) -> &'static str {
    let comma = text.as_bytes().windows(3).any(|w| w[0].is_ascii_digit() && w[1] == b',' && w[2].is_ascii_digit());
    if comma { " (a decimal point is a point, not a comma)" } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si<T: FromText>(text: &str) -> T {
        T::from_text(text).unwrap_or_else(|what| panic!("{what}"))
    }

    #[test]
    fn a_power_of_ten_is_rounded_once() {
        assert_eq!(si::<Wavelength>("550 nm").0, 550e-9);
        assert_eq!(si::<Length>("2.5mm").0, 2.5e-3);
        assert_eq!(si::<Length>("-1.5e-2 um").0, -1.5e-8);
        assert_eq!(si::<Length>("1e3m").0, 1000.0);
        assert!((si::<Length>(".5 in").0 - 0.0127).abs() <= 0.0127 * f64::EPSILON);
        assert_eq!(si::<WavelengthSquared>("0.006 um²").0, 0.006e-12);
        assert_eq!(si::<Absorption>("0.1 /mm").0, 100.0);
        assert_eq!(si::<Absorption>("0.1 1/cm").0, 10.0);
        assert_eq!(si::<Irradiance>("1361 W/m^2").0, 1361.0);
        assert_eq!(si::<Temperature>("5778 K").0, 5778.0);
        assert_eq!(si::<LengthUnit>("mm").0, 1e-3);
    }

    #[test]
    fn angles_are_radians() {
        assert_eq!(si::<Angle>("180 deg").0, PI);
        assert_eq!(si::<Angle>("90°").0, PI / 2.0);
        assert_eq!(si::<Angle>("50 mrad").0, 0.05);
        assert!((si::<Angle>("3600 arcsec").0 - PI / 180.0).abs() < 1e-17);
    }

    #[test]
    fn vectors_share_one_unit_and_directions_have_none() {
        assert_eq!(si::<Position>("(0, 11.47,-40) mm").0, DVec3::new(0.0, 11.47e-3, -40e-3));
        assert_eq!(si::<Direction>("(0, 0, 1e300)").0, DVec3::Z);
        assert_eq!(si::<Direction>("(0, 0, -1e-300)").0, DVec3::NEG_Z);
        assert!((si::<Direction>("(1, 1, 1)").0.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn what_cannot_be_meant_is_refused() {
        for text in ["12.7", "", "mm", "1,5 mm", "1 kg", "1e999 mm", "1e99999999999 mm", "NaN mm", "inf mm", "1 e"] {
            assert!(Length::from_text(text).is_err(), "{text:?} was accepted");
        }
        for text in ["(0, 0, 0)", "(0, 0)", "(0, 0, 1, 2)", "(0, 0, 1) mm", "0, 0, 1", "(a, b, c)", "(0,0,1"] {
            assert!(Direction::from_text(text).is_err(), "{text:?} was accepted");
        }
    }

    #[test]
    fn a_message_says_what_is_wrong() {
        assert_eq!(Length::from_text("12.7").err().as_deref(), Some("\"12.7\" has no unit"));
        let wrong = Length::from_text("1,5 mm").err().unwrap_or_default();
        assert!(wrong.ends_with("(a decimal point is a point, not a comma)"), "{wrong}");
        let wrong = Flux::from_text("1 mm").err().unwrap_or_default();
        assert_eq!(wrong, "\"1 mm\": no such unit here: \"mm\"; one of W, mW, uW, nW, pW, kW");
    }
}
