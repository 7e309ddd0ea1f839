//! The built-in library of finishes: scatter of common surfaces, by name.
//!
//! | finishes | from |
//! |---|---|
//! | `black anodize EC1`, ... | tables measured at 650 nm (`ua-loft/README.md`), scaled to the TIS that they state; beyond 80 deg the last value is held |
//! | `black anodize EC1 fit`, ... | ABg + Lambertian through the same tables: smooth, and off by what the entry says |
//! | `diffuse Kameralack`, ... | the total reflectance over the wavelength as measured, Lambertian by assumption |
//! | `polished glass 1 nm`, `polished mirror 1 nm`, ... | K-correlation of a generic polish, by rms height over 1 to 1000 /mm |
//! | `generic black paint`, ... | plausible numbers: nothing was measured |
//!
//! Every entry says where it comes from and for which wavelengths. A table measured at one wavelength is used unchanged at all others:
//! it holds where the total reflectance of a finish of that sort is known to differ by less than a fifth, and no farther. It is not scaled
//! beyond, since the spectrum was measured on another sample, and dyes differ; who needs the infrared takes the diffuse entry, whose total is
//! right, or measures.

// A problem of an input is built once per run.
#![allow(clippy::result_large_err)]

mod library;
mod spectrum;

use super::spectral::Spectral;
use super::{Abg, Bsdf, KCorrelation, Lambertian, Polish, Side, Tabulated, reading};
use crate::error::{Problem, did_you_mean};

pub use library::LIBRARY;
pub use spectrum::{Black, total};

/// How far an entry can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// BRDF of a sample.
    Measured,
    /// A formula through the BRDF of a sample.
    Fitted,
    /// The total reflectance of a sample; its shape is assumed.
    TotalMeasured,
    /// Plausible, not measured.
    Generic,
}

impl Kind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Kind::Measured => "measured",
            Kind::Fitted => "fitted to a measurement",
            Kind::TotalMeasured => "total measured, shape assumed",
            Kind::Generic => "generic, not measured",
        }
    }
}

/// What an entry is made of.
#[derive(Clone, Copy, Debug)]
enum Model {
    /// The text of a measured table.
    Table(&'static str),
    /// ABg (a in 1/sr) and a Lambertian floor (reflectance).
    Abg { a: f64, b: f64, g: f64, reflectance: f64 },
    /// Lambertian of this total reflectance.
    Diffuse(Black),
    /// K-correlation of this rms height (m), on these sides.
    Polish { rms: f64, sides: &'static [Side] },
}

/// An entry of the library.
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    pub name: &'static str,
    pub kind: Kind,
    /// Who measured what, or why these numbers.
    pub source: &'static str,
    /// Vacuum wavelengths for which it holds, m.
    pub range: [f64; 2],
    /// Vacuum wavelength of the measurement, m, if it was a single one.
    pub measured_at: Option<f64>,
    /// A finish of its sort whose total reflectance is known.
    like: Option<Black>,
    model: Model,
}

/// The entry of a name.
pub fn find(name: &str) -> Result<&'static Finish, Problem> {
    LIBRARY.iter().find(|finish| finish.name == name).ok_or_else(|| {
        let names: Vec<&str> = LIBRARY.iter().map(|finish| finish.name).collect();
        let problem = Problem::error(format!("the library has no finish {name:?}"));
        match did_you_mean(name, names.iter().copied()) {
            Some(close) => problem.hinting(format!("did you mean {close:?}? `straylight finishes` lists them")),
            None => problem
                .expecting(format!("one of {}", names.join(", ")))
                .hinting("`straylight finishes` lists them".to_owned()),
        }
    })
}

/// Polish: shoulder at 1/(55 um), that is Harvey's l = 0.01 at 550 nm, and a slope in the middle of what is quoted (1.5 to 2.5).
const SHOULDER: f64 = 55e-6;
const SLOPE: f64 = 2.0;
/// Spatial frequencies over which the rms height of a polish counts, 1/m.
const BAND: [f64; 2] = [1e3, 1e6];

impl Finish {
    /// What it scatters. Cost: up to 0.1 s for each lobe.
    pub fn lobes(&self) -> Result<Vec<Box<dyn Bsdf>>, Problem> {
        let lambertian = |reflectance: f64| Lambertian { reflectance, transmittance: 0.0 };
        Ok(match self.model {
            Model::Table(text) => vec![Box::new(table(text, self.name)?)],
            Model::Abg { a, b, g, reflectance } => {
                let mut lobes: Vec<Box<dyn Bsdf>> = vec![Box::new(lambertian(reflectance))];
                if a > 0.0 {
                    lobes.push(Box::new(Abg::new(a, b, g, Side::Reflect)));
                }
                lobes
            }
            Model::Diffuse(black) => {
                let (wavelength, reflectance) = spectrum::spectrum(black);
                vec![Box::new(Spectral::new(lambertian(1.0), wavelength, reflectance))]
            }
            Model::Polish { rms, sides } => {
                let lobe = |side: &Side| -> Box<dyn Bsdf> { Box::new(Polish::new(polish(rms), *side)) };
                sides.iter().map(lobe).collect()
            }
        })
    }

    /// The spectrum of heights of a polished surface, which scatters by its shape alone.
    pub fn polish(&self) -> Option<KCorrelation> {
        match self.model {
            Model::Polish { rms, .. } => Some(polish(rms)),
            _ => None,
        }
    }

    /// Source, kind and range on one line: what a result rests on.
    pub fn assumption(&self) -> String {
        let at =
            self.measured_at.map_or(String::new(), |at| format!(" at {} nm, taken alike at all wavelengths", nm(at)));
        let [from, to] = self.range.map(nm);
        format!("{}: {}{at}; holds from {from} to {to} nm; {}", self.name, self.kind.words(), self.source)
    }

    /// What to say of light of these vacuum wavelengths (m, lowest and highest), if the entry does not hold for all of them.
    pub fn doubt(&self, light: [f64; 2]) -> Option<Problem> {
        // The rounding of wavelengths that are typed in other units.
        let (low, high) = (self.range[0] * (1.0 - 1e-6), self.range[1] * (1.0 + 1e-6));
        let outside = if light[1] > high { light[1] } else { light[0] };
        let inside = low <= light[0] && light[1] <= high;
        let [from, to] = self.range.map(nm);
        let what = format!("the finish {:?} ({}) is used at {} nm", self.name, self.kind.words(), nm(outside));
        let problem = Problem::warning(what).expecting(format!("light from {from} to {to} nm"));
        (!inside).then(|| match self.known(outside) {
            Some(known) => problem.hinting(known),
            None => problem,
        })
    }

    /// What is known of a finish of its sort at a vacuum wavelength (m).
    fn known(&self, wavelength: f64) -> Option<String> {
        let (like, at) = (self.like?, self.measured_at?);
        let [there, here] = [total(like, wavelength)?, total(like, at)?];
        let diffuse = LIBRARY.iter().find(|finish| matches!(finish.model, Model::Diffuse(black) if black == like))?;
        Some(format!(
            "another sample reflects {there:.3} in all there and {here:.3} at {} nm, {:.1} times as much: \
             `Finish({:?})` has that spectrum",
            nm(at),
            there / here,
            diffuse.name
        ))
    }
}

fn polish(rms: f64) -> KCorrelation {
    KCorrelation::new(rms, BAND, SHOULDER, SLOPE)
}

fn table(text: &str, name: &str) -> Result<Tabulated, Problem> {
    let broken = |what: String| Problem::error(format!("the library's table of {name:?} is broken: {what}"));
    let tables = reading::parse(text, reading::Unmeasured::Hold)
        .map_err(|all| broken(all.first().map_or(String::new(), ToString::to_string)))?;
    let table = tables.into_iter().next().ok_or_else(|| broken("it is empty".into()))?;
    Tabulated::new(table, 1.0).map_err(|bright| broken(bright.to_string()))
}

/// A wavelength (m) in nm, to a tenth.
fn nm(wavelength: f64) -> f64 {
    (wavelength * 1e10).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::Incidence;

    #[test]
    fn every_entry_scatters_less_than_arrives() {
        for finish in LIBRARY {
            let lobes = finish.lobes().expect("a good entry");
            for theta in [0.0, 0.5, 1.0, 1.3, 1.5] {
                for wavelength in finish.range {
                    let at = Incidence::in_air(theta, wavelength);
                    let tis: f64 = lobes.iter().map(|lobe| lobe.albedo(&at)).sum();
                    assert!(tis > 0.0 && tis < 1.0, "{} at {theta}: {tis}", finish.name);
                }
            }
        }
    }

    #[test]
    fn names_are_unique_and_slips_are_answered() {
        let names: std::collections::BTreeSet<&str> = LIBRARY.iter().map(|finish| finish.name).collect();
        assert_eq!(names.len(), LIBRARY.len());
        let problem = find("black anodise EC1").expect_err("no such finish").to_string();
        assert!(problem.contains("did you mean \"black anodize EC1\"?"), "{problem}");
        let problem = find("gold").expect_err("no such finish").to_string();
        assert!(problem.contains("black anodize EC1") && problem.contains("straylight finishes"), "{problem}");
    }

    /// The rule that the module states: from 650 nm to both sides, as far as the spectrum stays within a fifth.
    #[test]
    fn a_table_holds_where_the_spectrum_stays_within_a_fifth() {
        let (wavelength, reflectance) = spectrum::spectrum(Black::Anodize);
        let anchor = total(Black::Anodize, 650e-9).expect("known");
        let alike = |at: &usize| (reflectance[*at] / anchor - 1.0).abs() < 0.2;
        let from = wavelength.partition_point(|w| *w < 650e-9);
        let low = (0..from).rev().take_while(alike).last().expect("some");
        let high = (from..wavelength.len()).take_while(alike).last().expect("some");
        let range = find("black anodize EC1").expect("an entry").range;
        assert!(
            (range[0] / wavelength[low] - 1.0).abs() < 1e-9 && (range[1] / wavelength[high] - 1.0).abs() < 1e-9,
            "{range:?}"
        );
    }

    #[test]
    fn the_infrared_is_doubted_and_the_visible_is_not() {
        let finish = find("black anodize EC1").expect("an entry");
        assert!(finish.doubt([450e-9, 650e-9]).is_none());
        let said = finish.doubt([550e-9, 1064e-9]).expect("a doubt").to_string();
        for word in ["1064 nm", "350 to 685 nm", "0.686", "diffuse black anodize"] {
            assert!(said.contains(word), "{word}: {said}");
        }
    }
}
