//! How many rays, and how they are spent.

use crate::system::units::{FromText, from_string};
use serde::{Deserialize, Deserializer};

/// How the system is traced.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Source rays, 1..2^48; rounded up to whole batches.
    pub rays: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Source rays per batch, a power of two; chosen by the program if not given.
    pub batch: Option<u64>,
    /// Reflections at transmitting interfaces up to which a ray splits into both branches, 0..64.
    pub splits: u32,
    /// Scatter events of a path up to which specular and scattered light are both followed, 1..64; then one is drawn.
    pub scatter_splits: u32,
    /// When weak rays are drawn for.
    pub roulette: Roulette,
    /// Scatter events of a path after which it is cut, and booked as cut; no limit if not given.
    pub max_scatters: Option<u32>,
    /// Reflections of a path after which it is cut.
    pub max_reflections: Option<u32>,
    /// Events of a path after which it is cut.
    pub max_events: Option<u32>,
    /// The error wanted: the run stops at the first doubling of `rays` where it is reached.
    pub until: Option<Until>,
    /// Rows of the path table; the rest is one exact row.
    pub paths: u32,
    /// Whether the run learns first where scattered light counts.
    pub importance: Importance,
    /// Which way light is followed.
    pub trace: Way,
}

/// Which way light is followed. Every number means the same; the errors differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Way {
    /// From the sources.
    #[default]
    Forward,
    /// From the detectors, all beams at once; what they cannot see from the sources.
    Backward,
}

/// Whether the run learns first where scattered light counts. Every number means the same; the errors differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Importance {
    /// It learns, tries what it learned, and draws more of what counts and less of what does not where that pays.
    #[default]
    Auto,
    /// The same whether it pays or not.
    On,
    /// Light is drawn as it scatters, but for the targets of surfaces.
    Off,
}

impl Default for Run {
    fn default() -> Run {
        Run {
            rays: 1_000_000,
            seed: 1,
            batch: None,
            splits: 2,
            scatter_splits: 1,
            roulette: Roulette::default(),
            max_scatters: None,
            max_reflections: None,
            max_events: None,
            until: None,
            paths: 1000,
            importance: Importance::default(),
            trace: Way::default(),
        }
    }
}

/// Russian roulette: a ray below a share of its starting flux survives with a probability, and carries flux / probability.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Roulette {
    /// Share of the starting flux, >= 0.
    pub below: f64,
    /// Probability to survive, > 0, <= 1.
    pub survive: f64,
}

impl Default for Roulette {
    fn default() -> Roulette {
        Roulette { below: 1e-12, survive: 0.1 }
    }
}

/// The error wanted: `"1 % on fpa"`.
#[derive(Debug, Clone, PartialEq)]
pub struct Until {
    /// Standard error of the detector's flux over the flux, > 0, dimensionless.
    pub relative: f64,
    /// Name of the detector.
    pub detector: String,
}

impl FromText for Until {
    const EXPECTED: &'static str = "an error and a detector, such as \"1 % on fpa\"";

    fn from_text(text: &str) -> Result<Until, String> {
        let wrong = || format!("{text:?} is not an error and a detector");
        let (percent, detector) = text.split_once('%').ok_or_else(wrong)?;
        let percent: f64 = percent.trim().parse().map_err(|_| wrong())?;
        let detector = detector.trim().strip_prefix("on ").ok_or_else(wrong)?.trim();
        if percent.is_finite() && percent > 0.0 {
            Ok(Until { relative: percent / 100.0, detector: detector.to_owned() })
        } else {
            Err(format!("{text:?}: the error must be above 0 %"))
        }
    }
}

impl<'de> Deserialize<'de> for Until {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        from_string(deserializer)
    }
}
