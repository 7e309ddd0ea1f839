//! How a medium scatters.

use super::Medium;
use crate::system::units::{Absorption, Angle, Length, Wavelength};
use serde::{Deserialize, Deserializer, de};
use std::fmt;

/// Scatter inside a medium.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Bulk {
    /// A lobe with one parameter; g = 0 scatters alike into all directions.
    HenyeyGreenstein {
        /// Scattering coefficient, 1/m, >= 0.
        coefficient: OverWavelength,
        /// Mean cosine of the scattering angle, -1 < g < 1.
        g: f64,
    },
    /// Particles much smaller than the wavelength: the coefficient falls with its fourth power.
    Rayleigh {
        /// Scattering coefficient, 1/m, >= 0.
        coefficient: Absorption,
        /// Vacuum wavelength of the coefficient, m.
        at: Wavelength,
    },
    /// A phase function over the scattering angle.
    PhaseTable {
        /// Scattering coefficient, 1/m, >= 0.
        coefficient: OverWavelength,
        /// Scattering angle, rad, 0 to pi increasing (0 is straight on), and relative intensity per solid angle, >= 0.
        values: Vec<(Angle, f64)>,
    },
    /// Equal spheres far apart (Mie).
    Spheres {
        /// What they are made of.
        medium: Box<Medium>,
        /// Their diameter, m.
        diameter: Length,
        /// Their share of the volume, 0..0.1.
        fraction: f64,
    },
}

/// A coefficient: `"0.2 /mm"`, or over the wavelength `[("450 nm", "0.3 /mm"), ("650 nm", "0.1 /mm")]`.
#[derive(Debug, Clone, PartialEq)]
pub struct OverWavelength(
    /// Vacuum wavelengths, m (increasing), and coefficients, 1/m; one row alone holds everywhere.
    pub Vec<(f64, f64)>,
);

impl<'de> Deserialize<'de> for OverWavelength {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Rows;
        impl<'de> de::Visitor<'de> for Rows {
            type Value = OverWavelength;
            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("a coefficient such as \"0.1 /mm\", or a list of wavelengths and coefficients")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<OverWavelength, E> {
                let value = Absorption::deserialize(de::value::StrDeserializer::new(text))?;
                Ok(OverWavelength(vec![(0.0, value.0)]))
            }
            fn visit_f64<E: de::Error>(self, number: f64) -> Result<OverWavelength, E> {
                // A bare number: the unit's own words.
                Absorption::deserialize(de::value::F64Deserializer::new(number)).map(|_| OverWavelength(Vec::new()))
            }
            fn visit_u64<E: de::Error>(self, number: u64) -> Result<OverWavelength, E> {
                self.visit_f64(number as f64)
            }
            fn visit_i64<E: de::Error>(self, number: i64) -> Result<OverWavelength, E> {
                self.visit_f64(number as f64)
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, mut rows: A) -> Result<OverWavelength, A::Error> {
                let mut list = Vec::new();
                while let Some((wavelength, value)) = rows.next_element::<(Wavelength, Absorption)>()? {
                    list.push((wavelength.0, value.0));
                }
                Ok(OverWavelength(list))
            }
        }
        deserializer.deserialize_any(Rows)
    }
}
