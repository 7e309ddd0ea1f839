//! Why there is stray light: its paths by what happened last, and the strongest of them.

use super::share::shares;
use crate::tally::results::{DetectorResult, Estimate, PathResult, Results};

/// Whether a class of light is meant to arrive: the image, or direct light where nothing makes one.
pub fn is_meant(class: &str) -> bool {
    matches!(class, "signal" | "direct")
}

/// What a part of the stray light has in common.
#[derive(Debug)]
pub struct Cause {
    /// "one scatter off Barrel", "ghost between Lens_2.back and Lens_1.front", ...
    pub text: String,
    /// Of all stray light, 0..1; the error is an upper bound, for paths may share their rays.
    pub share: Estimate,
}

/// The causes of the stray light on a detector, largest first.
pub fn causes(results: &Results, name: &str) -> Vec<Cause> {
    let Some(detector) = results.detectors.get(name) else { return Vec::new() };
    let whole = detector.stray.flux_w.mean;
    let mut groups: Vec<(String, Estimate)> = Vec::new();
    for path in stray_paths(results, name) {
        let text = cause(path);
        match groups.iter_mut().find(|group| group.0 == text) {
            Some((_, flux)) => *flux = sum(*flux, path.flux_w),
            None => groups.push((text, path.flux_w)),
        }
    }
    let all = groups.iter().map(|group| group.1).fold(Estimate::default(), sum);
    groups.sort_by(|a, b| b.1.mean.total_cmp(&a.1.mean).then(a.0.cmp(&b.0)));
    // s = g / (g + r): ds = ((1 - s) dg - s dr) / (g + r).
    let share = |flux: Estimate| {
        let share = flux.mean / whole;
        let error = ((1.0 - share) * flux.error + share * (all.error - flux.error)) / whole;
        Estimate { mean: share, error: error.max(0.0) }
    };
    let known = groups.into_iter().filter(|group| whole > 0.0 && group.0 != OTHER);
    known.map(|(text, flux)| Cause { text, share: share(flux) }).collect()
}

/// The row of what has no row of its own.
const OTHER: &str = "other";

fn stray_paths<'a>(results: &'a Results, name: &'a str) -> impl Iterator<Item = &'a PathResult> {
    results.paths.iter().filter(move |path| path.detector == name && !is_meant(&path.class))
}

fn sum(a: Estimate, b: Estimate) -> Estimate {
    Estimate { mean: a.mean + b.mean, error: a.error + b.error }
}

/// What a path has in common with others.
fn cause(path: &PathResult) -> String {
    if path.sequence == OTHER {
        return OTHER.into();
    }
    let steps = || path.sequence.split(" > ").filter_map(|step| step.rsplit_once(':'));
    let last = steps().filter(|step| matches!(step.1, "S" | "V")).last();
    match (path.scatter_order, last) {
        (1, Some((name, "V"))) => format!("one scatter in {name}"),
        (1, Some((name, _))) => format!("one scatter off {name}"),
        (n, Some((name, event))) => {
            let count = if n == 2 { "two".into() } else { n.to_string() };
            format!("{count} scatters, the last {} {name}", if event == "V" { "in" } else { "off" })
        }
        (_, None) if path.ghost_order > 0 => {
            let by = path.reflectors.join(", ");
            match path.ghost_order {
                1 => format!("a ghost of one reflection: {by}"),
                n => format!("a ghost of {n} reflections: {by}"),
            }
        }
        (_, None) => "light straight from the source".into(),
    }
}

/// The strongest paths of stray light and the rest of it; shares of the stray light that add up to 100 %.
pub struct Top<'a> {
    pub rows: Vec<(&'a PathResult, String)>,
    /// W, and share; `None` where nothing is left.
    pub other: Option<(f64, String)>,
}

/// At most `count` paths.
pub fn top<'a>(results: &'a Results, name: &'a str, detector: &DetectorResult, count: usize) -> Top<'a> {
    let mut rows: Vec<&PathResult> = stray_paths(results, name).filter(|path| path.sequence != OTHER).collect();
    rows.sort_by(|a, b| b.flux_w.mean.total_cmp(&a.flux_w.mean));
    rows.truncate(count);
    let whole = detector.stray.flux_w.mean;
    let listed: f64 = rows.iter().map(|path| path.flux_w.mean).sum();
    // 1e-12: the rounding of sums in another order.
    let left = if whole - listed > 1e-12 * whole { whole - listed } else { 0.0 };
    let fluxes: Vec<f64> = rows.iter().map(|path| path.flux_w.mean).chain([left]).collect();
    let mut shares = shares(&fluxes, fluxes.iter().sum());
    let share = shares.pop().unwrap_or_default();
    let other = (left > 0.0).then_some((left, share));
    Top { rows: rows.into_iter().zip(shares).collect(), other }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(sequence: &str, class: &str, scatters: u32, ghosts: u32) -> PathResult {
        PathResult {
            detector: "fpa".into(),
            source: "sun".into(),
            sequence: sequence.into(),
            class: class.into(),
            rays: 100,
            flux_w: Estimate { mean: 1.0, error: 0.1 },
            percent: 0.0,
            ghost_order: ghosts,
            scatter_order: scatters,
            reflectors: vec!["L2".into(), "L1".into()],
            last_scatter: String::new(),
            optical_path_m: 0.0,
            peak_w_m2: 0.0,
            cells: Vec::new(),
        }
    }

    #[test]
    fn a_path_is_called_by_what_happened_last() {
        let said = |sequence: &str, scatters, ghosts| cause(&path(sequence, "", scatters, ghosts));
        assert_eq!(said("sun > L1:T > Barrel:S > L2:T", 1, 0), "one scatter off Barrel");
        assert_eq!(said("sun > Hood:S > Barrel:S", 2, 0), "two scatters, the last off Barrel");
        assert_eq!(said("sun > opal:V", 1, 0), "one scatter in opal");
        assert_eq!(said("sun > L1:T > L2:R > L1:R > L2:T", 0, 2), "a ghost of 2 reflections: L2, L1");
        assert_eq!(said("sun", 0, 0), "light straight from the source");
    }

    #[test]
    fn what_is_meant_is_no_stray_light() {
        assert!(is_meant("signal") && is_meant("direct"));
        assert!(!is_meant("direct leak") && !is_meant("ghost 2") && !is_meant("mixed"));
    }
}
