//! Checks of scatter inside media.

use super::Checker;
use crate::error::Problem;
use crate::system::document::{Bulk, Medium, OverWavelength};
use std::f64::consts::PI;

impl Checker<'_> {
    pub(super) fn bulk(&mut self, scatter: &Bulk, path: &str) {
        match scatter {
            Bulk::HenyeyGreenstein { coefficient, g } => {
                self.over_wavelength(coefficient, &format!("{path}.coefficient"));
                self.range(g.abs() < 1.0, &format!("{path}.g"), "a mean cosine between -1 and 1");
            }
            Bulk::Rayleigh { coefficient, at } => {
                self.not_negative(coefficient.0, &format!("{path}.coefficient"));
                self.positive(at.0, &format!("{path}.at"));
            }
            Bulk::PhaseTable { coefficient, values } => {
                self.over_wavelength(coefficient, &format!("{path}.coefficient"));
                self.phase_table(values.iter().map(|(angle, value)| (angle.0, *value)), &format!("{path}.values"));
            }
            Bulk::Spheres { medium, diameter, fraction } => {
                self.medium(medium, &format!("{path}.medium"));
                self.positive(diameter.0, &format!("{path}.diameter"));
                let share = (0.0..=0.1).contains(fraction);
                self.range(share, &format!("{path}.fraction"), "0 to 0.1: spheres that are closer scatter together");
            }
        }
        self.require(!self.clouds_the_ambient(path), path, || {
            Problem::error("the ambient scatters: light would never leave it")
                .hinting("put the scattering medium into a closed solid".to_owned())
        });
    }

    fn clouds_the_ambient(&self, path: &str) -> bool {
        let system = &self.document.system;
        path.starts_with(&format!("media[{:?}].scatter", system.ambient))
            && matches!(system.media.get(&system.ambient), Some(Medium::Turbid { .. }))
    }

    fn over_wavelength(&mut self, coefficient: &OverWavelength, path: &str) {
        let rows = &coefficient.0;
        let rises = !rows.is_empty() && rows.windows(2).all(|w| w[0].0 < w[1].0);
        self.require(rises, path, || {
            Problem::error("the wavelengths do not rise").expecting("at least one row, in order")
        });
        rows.iter().for_each(|(_, value)| self.not_negative(*value, path));
    }

    fn phase_table(&mut self, rows: impl Iterator<Item = (f64, f64)> + Clone, path: &str) {
        let angles: Vec<f64> = rows.clone().map(|(angle, _)| angle).collect();
        let rises = angles.windows(2).all(|w| w[0] < w[1]);
        let inside = angles.iter().all(|angle| (0.0..=PI * (1.0 + 1e-12)).contains(angle));
        self.require(rises && inside && angles.len() > 1, path, || {
            Problem::error("the angles are not in order").expecting("two or more angles that rise from 0 to 180 deg")
        });
        let dark = rows.clone().all(|(_, value)| value == 0.0);
        self.require(!dark, path, || Problem::error("every value is zero").expecting("a value above zero"));
        rows.enumerate().for_each(|(at, (_, value))| self.not_negative(value, &format!("{path}[{at}][1]")));
    }
}
