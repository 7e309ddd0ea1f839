//! What a run takes for granted and leaves out, for the reader of a report.

use crate::scene::Scene;
use crate::settings::{Settings, Trace};
use std::collections::BTreeSet;

/// Names that are listed under one heading.
const LISTED: usize = 12;

/// Headings with what is assumed under them; `finishes` is what is known of those of the built-in library.
pub fn assumptions(scene: &Scene, settings: &Settings, finishes: &[String]) -> Vec<[String; 2]> {
    let line = |heading: &str, text: String| [heading.to_owned(), text];
    let mut all = vec![line("Band", band(scene))];
    all.extend(finishes.iter().map(|finish| line("Finish", finish.clone())));
    all.push(line("Other scatter", scatter(scene, finishes)));
    all.push(line("Coatings", listed(&speculars(scene), "none")));
    all.push(line("Cleanliness", cleanliness(scene)));
    all.push(line("Orders", orders(settings)));
    all.push(line(
        "Uncertainty",
        "errors are those of the Monte Carlo alone; that of BSDFs, coatings and shapes comes on top (variants and levels say what it changes)"
            .into(),
    ));
    all.push(line(
        "Left out",
        "diffraction, interference between paths, fluorescence, thermal emission, what the geometry does not hold"
            .into(),
    ));
    all
}

/// Vacuum wavelengths of the sources.
fn band(scene: &Scene) -> String {
    let ranges = || scene.sources.iter().map(|source| source.spectrum.range());
    let low = ranges().map(|range| range[0]).fold(f64::INFINITY, f64::min);
    let high = ranges().map(|range| range[1]).fold(0.0, f64::max);
    let nanometres = |wavelength: f64| (1e12 * wavelength).round() / 1e3;
    match high > low {
        true => format!("{} to {} nm (vacuum)", nanometres(low), nanometres(high)),
        false => format!("{} nm (vacuum)", nanometres(low)),
    }
}

/// The two parts of the label of every surface: "coating ar + scatter black".
fn labels(scene: &Scene) -> impl Iterator<Item = (&str, &str)> {
    let all = scene.surfaces.iter().map(|surface| surface.label.as_str());
    all.map(|label| label.split_once(" + scatter ").unwrap_or((label, "")))
}

fn speculars(scene: &Scene) -> BTreeSet<String> {
    let name = |specular: &str| match specular {
        "Absorb" => None,
        "Fresnel" => Some("bare interfaces (Fresnel)".to_owned()),
        other => Some(other.strip_prefix("coating ").unwrap_or(other).to_owned()),
    };
    labels(scene).filter_map(|(specular, _)| name(specular)).collect()
}

fn scatter(scene: &Scene, finishes: &[String]) -> String {
    let names: BTreeSet<String> =
        labels(scene).filter(|label| !label.1.is_empty()).map(|(_, scatter)| format!("{scatter:?}")).collect();
    let source = if finishes.is_empty() { "" } else { ", where not built on a finish above" };
    match names.is_empty() {
        true => "none: every surface is specular or black".into(),
        false => format!("{}: as the system file and its tables state{source}", listed(&names, "")),
    }
}

fn cleanliness(scene: &Scene) -> String {
    let dusty: BTreeSet<String> =
        scene.surfaces.iter().filter(|surface| surface.is_dusty()).map(|surface| surface.label.clone()).collect();
    match dusty.is_empty() {
        true => "no particles on any surface beyond what its measured scatter holds".into(),
        false => format!("particles on {}; all else clean", listed(&dusty, "")),
    }
}

fn orders(settings: &Settings) -> String {
    let limit = |what: &str, most: Option<u32>| most.map(|most| format!("at most {most} {what}"));
    let limits: Vec<String> =
        [limit("scatters", settings.max_scatters.map(u32::from)), limit("reflections", settings.max_reflections)]
            .into_iter()
            .flatten()
            .collect();
    let limits = if limits.is_empty() { "no limit on scatters or reflections".into() } else { limits.join(", ") };
    let way = if settings.trace == Trace::Backward { "from the detectors where that is possible, " } else { "" };
    format!("traced {way}with {limits}; faint light is drawn for, not dropped")
}

fn listed(names: &BTreeSet<String>, none: &str) -> String {
    let more = names.len().saturating_sub(LISTED);
    let shown: Vec<&str> = names.iter().take(LISTED).map(String::as_str).collect();
    match (names.is_empty(), more) {
        (true, _) => none.into(),
        (_, 0) => shown.join(", "),
        (_, more) => format!("{} and {more} more", shown.join(", ")),
    }
}
