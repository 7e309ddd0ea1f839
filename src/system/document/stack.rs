//! Layers of a thin-film stack as they are written: `("MgF2", "99.6 nm")`, `("MgF2", "1/4 wave")`, `Repeat(8, [..])`.

use crate::system::units::{FromText, Length, from_string};
use serde::de::{self, DeserializeSeed, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// One entry of `layers`.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A film: its medium, a name in `media`, and its thickness.
    Film(String, Thickness),
    /// Layers that follow each other so many times.
    Repeat(u32, Vec<Layer>),
}

/// How thick a film is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thickness {
    /// m
    Length(f64),
    /// n d in wavelengths of the design, dimensionless.
    Waves(f64),
}

impl Layer {
    /// Films that it stands for, counted with their repetitions; the largest number if they are more.
    pub fn count(&self) -> u64 {
        match self {
            Layer::Film(..) => 1,
            Layer::Repeat(times, layers) => {
                let each = layers.iter().fold(0u64, |sum, layer| sum.saturating_add(layer.count()));
                each.saturating_mul(u64::from(*times))
            }
        }
    }

    /// Adds the names of its media, once for each time they are written.
    pub fn media<'a>(&'a self, into: &mut Vec<&'a str>) {
        match self {
            Layer::Film(medium, _) => into.push(medium),
            Layer::Repeat(_, layers) => layers.iter().for_each(|layer| layer.media(into)),
        }
    }

    /// Calls `film` with every film in order, repetitions written out.
    pub fn films<'a>(&'a self, film: &mut impl FnMut(&'a str, Thickness)) {
        match self {
            Layer::Film(medium, thickness) => film(medium, *thickness),
            Layer::Repeat(times, layers) => {
                for _ in 0..*times {
                    layers.iter().for_each(|layer| layer.films(film));
                }
            }
        }
    }
}

impl FromText for Thickness {
    const EXPECTED: &'static str = "a thickness such as \"99.6 nm\", or an optical one such as \"1/4 wave\"";

    fn from_text(text: &str) -> Result<Self, String> {
        let trimmed = text.trim();
        let waves = trimmed.strip_suffix("waves").or_else(|| trimmed.strip_suffix("wave"));
        let Some(number) = waves else { return Length::from_text(text).map(|length| Thickness::Length(length.0)) };
        let quotient = number.split_once('/').unwrap_or((number, "1"));
        let [over, under] = [quotient.0, quotient.1].map(|part| part.trim().parse::<f64>().ok());
        match over.zip(under).map(|(over, under)| over / under) {
            Some(waves) if waves.is_finite() => Ok(Thickness::Waves(waves)),
            _ => Err(format!("{text:?} is no number of waves")),
        }
    }
}

impl<'de> Deserialize<'de> for Thickness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        from_string(deserializer)
    }
}

/// What an entry begins with.
enum Head {
    Medium(String),
    Times(u32),
}

const LAYER: &str = "a layer such as (\"MgF2\", \"99.6 nm\"), or Repeat(8, [..])";

struct HeadVisitor;

impl Visitor<'_> for HeadVisitor {
    type Value = Head;
    fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str("the name of a medium, or how often layers repeat")
    }
    fn visit_str<E: de::Error>(self, text: &str) -> Result<Head, E> {
        Ok(Head::Medium(text.to_owned()))
    }
    fn visit_u64<E: de::Error>(self, times: u64) -> Result<Head, E> {
        u32::try_from(times).map(Head::Times).map_err(|_| E::custom(format!("{times} repetitions are too many")))
    }
}

impl<'de> DeserializeSeed<'de> for HeadVisitor {
    type Value = Head;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Head, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Deserialize<'de> for Layer {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LayerVisitor;
        impl<'de> Visitor<'de> for LayerVisitor {
            type Value = Layer;
            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str(LAYER)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Layer, A::Error> {
                let short = |found| de::Error::invalid_length(found, &LAYER);
                let layer = match items.next_element_seed(HeadVisitor)?.ok_or_else(|| short(0))? {
                    Head::Medium(medium) => Layer::Film(medium, items.next_element()?.ok_or_else(|| short(1))?),
                    Head::Times(times) => Layer::Repeat(times, items.next_element()?.ok_or_else(|| short(1))?),
                };
                Ok(layer)
            }
        }
        deserializer.deserialize_any(LayerVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thicknesses_are_lengths_or_waves() {
        assert_eq!(Thickness::from_text("99.6 nm"), Ok(Thickness::Length(99.6e-9)));
        assert_eq!(Thickness::from_text("1/4 wave"), Ok(Thickness::Waves(0.25)));
        assert_eq!(Thickness::from_text("0.25 waves"), Ok(Thickness::Waves(0.25)));
        assert!(Thickness::from_text("1/0 wave").is_err());
        assert!(Thickness::from_text("wave").is_err());
        assert!(Thickness::from_text("99.6").is_err());
    }

    #[test]
    fn repetitions_are_written_out_in_order() {
        let layers: Vec<Layer> =
            ron::from_str("[Repeat(2, [(\"H\", \"1/4 wave\"), (3, [(\"L\", \"9 nm\")])]), (\"H\", \"1/4 wave\")]")
                .expect("layers");
        let mut names = String::new();
        layers.iter().for_each(|layer| layer.films(&mut |medium, _| names.push_str(medium)));
        assert_eq!(names, "HLLLHLLLH");
        assert_eq!(layers.iter().map(Layer::count).sum::<u64>(), 9);
        assert!(ron::from_str::<Layer>("(\"H\")").is_err());
        assert!(ron::from_str::<Layer>("(-1, [])").is_err());
    }
}
