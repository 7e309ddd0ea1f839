//! Filters in a run: every arrival is judged, also those without a row in the path table.

use crate::gauss::gauss;
use straylight::error::Error;
use straylight::system::compile::compile;
use straylight::system::document::Document;
use straylight::tally::results::{FilterResult, Results};

const FILTERS: &str = "    filters: {
        \"all\": \"star\",
        \"signal\": \"signal\",
        \"stray\": \"stray\",
        \"worst\": \"ghost(L4.back, L4.front)\",
        \"its way\": \"ghosts == 2 and scatters == 0 and star > ... > L4.front:T > L4.back:R > L4.front:R > L4.back:T > image\",
        \"barrel\": \"scatters == 1 and barrel*\",
        \"no barrel\": \"not (scatters == 1 and barrel*)\",
        \"nothing\": \"lens_that_is_not or direct\",
    },
    scatter: {";

fn found<'a>(results: &'a Results, name: &str) -> &'a FilterResult {
    results.filters.iter().find(|filter| filter.filter == name).expect("a filter of the file")
}

#[test]
fn filters_part_the_light_exactly() {
    let filters = FILTERS.replace("lens_that_is_not or direct", "direct");
    // One row in the path table: filters do not depend on it.
    let few = ("seed: 1", "seed: 1, paths: 1");
    let results = gauss(20.0, 2048, &[("    scatter: {", &filters), few]).run();
    let detector = &results.detectors["image"];
    let flux = |name: &str| found(&results, name).flux_w.mean;
    let same = |a: f64, b: f64, what: &str| assert!((a - b).abs() <= 1e-12 * b, "{what}: {a:e} {b:e}");
    same(flux("all"), detector.flux_w.mean, "all light");
    same(flux("signal"), detector.classes["signal"].mean, "signal");
    same(flux("signal") + flux("stray"), detector.flux_w.mean, "signal and stray light");
    let parted = ["barrel", "no barrel"].map(|name| found(&results, name));
    let sum: f64 = parted.iter().map(|filter| filter.flux_w.mean).sum();
    same(sum + parted[0].open_w.mean, detector.flux_w.mean, "a filter, its opposite and what is open");
    assert_eq!(parted[0].open_w, parted[1].open_w);
    assert!(flux("barrel") > 0.0 && flux("worst") > 0.0);
    same(flux("worst"), flux("its way"), "a ghost by its surfaces and by its way");
    let map = &found(&results, "worst").map;
    same(map.mean.iter().zip(&map.extent).map(|(mean, extent)| mean * extent).sum(), flux("worst"), "the map");
    assert!(found(&results, "nothing").upper_limit_w.is_some_and(|limit| limit > 0.0));
}

#[test]
fn a_filter_that_cannot_be_read_is_told_with_its_place() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/systems/double_gauss/system.ron"));
    let text = text.expect("the shipped system").replace("    scatter: {", FILTERS).replace("\"star", "\"sun");
    let document = Document::parse(std::path::Path::new("a.ron"), text.as_bytes()).expect("a system");
    let Err(Error::Input(problems)) = compile(&document) else { panic!("accepted") };
    let told: Vec<String> = problems.iter().map(ToString::to_string).collect();
    // The source has another name here: both are told at once.
    assert_eq!(told.len(), 2, "{told:#?}");
    assert!(told[0].contains("no source is called \"star\""), "{told:#?}");
    let place = "filters[\"nothing\"]: column 1 of the filter: no part or medium or source or detector is called \"lens_that_is_not\"";
    assert!(told[1].starts_with("a.ron:") && told[1].contains(place), "{told:#?}");
}
