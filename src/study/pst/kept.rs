//! Rounds kept in a file, so that a later command goes on where this one ended.

use super::Round;
use crate::settings::Settings;
use crate::system::compile::Compiled;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// All that was traced of a system, by name of the sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// What the rounds depend on: see [`fingerprint`].
    pub of: String,
    pub sweeps: BTreeMap<String, Vec<Round>>,
}

/// Everything that rounds depend on besides their own number: version, files, parameters, seed and how rays are spent.
/// Requirements are not among it.
pub fn fingerprint(compiled: &Compiled, settings: &Settings) -> String {
    let masks: Vec<&str> = compiled.sweeps.iter().flat_map(|sweep| &sweep.mask).map(|mask| &*mask.file).collect();
    let inputs: Vec<_> = compiled.inputs.iter().filter(|(name, _)| !masks.contains(&name.as_str())).collect();
    let settings = Settings { rays: 0, until: None, batch: None, paths: 0, ..settings.clone() };
    format!("{} {settings:?} {inputs:?} {:?}", env!("CARGO_PKG_VERSION"), compiled.parameters)
}

impl Kept {
    /// What a file holds, if it is about the same; else nothing.
    pub fn read(text: &str, of: String) -> Kept {
        let found: Option<Kept> = serde_json::from_str(text).ok();
        found.filter(|kept| kept.of == of).unwrap_or(Kept { of, sweeps: BTreeMap::new() })
    }

    /// Writes all of it; numbers read back to the same bits.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut *out, self)?;
        out.write_all(b"\n")
    }

    /// Adds the rounds of a sweep. Of each number the last traced is kept.
    pub fn keep(&mut self, sweep: &str, rounds: &[Round]) {
        let known = self.sweeps.entry(sweep.to_owned()).or_default();
        let more = known.split_off(rounds.len().min(known.len()));
        *known = rounds.to_vec();
        known.extend(more);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Seen;
    use super::*;
    use crate::tally::results::Estimate;

    #[test]
    fn what_is_kept_reads_back_to_the_same_bits_and_only_for_the_same_system() {
        let mut kept = Kept { of: "a".into(), ..Kept::default() };
        let flux_w = Estimate { mean: 1.234_567_890_123_456_7e-19, error: f64::MIN_POSITIVE * 1.1 };
        let seen =
            |mean: f64| Seen { flux_w: Estimate { mean, ..flux_w }, classes: vec![(4, flux_w)], ..Seen::default() };
        let numbers = (1..400).map(|k| seen((1.0 / f64::from(k)).powi(7)));
        let rounds = vec![Round { seen: numbers.collect(), warnings: vec!["w".into()] }; 2];
        kept.keep("sky", &rounds);
        kept.keep("sky", &rounds[..1]);
        let mut bytes = Vec::new();
        kept.write(&mut bytes).expect("written");
        let text = String::from_utf8(bytes).expect("text");
        let again = Kept::read(&text, "a".into());
        assert_eq!(again, kept);
        assert_eq!(again.sweeps["sky"].len(), 2);
        assert_eq!(Kept::read(&text, "b".into()), Kept { of: "b".into(), ..Kept::default() });
        assert!(Kept::read("{", "b".into()).sweeps.is_empty());
    }
}
