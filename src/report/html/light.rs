//! Blocks of data behind maps and paths: what the scripts of a report read out, draw and sort.

use super::view::singles;
use crate::tally::results::{MapKind, MapResult, PathResult, Results};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// Bins of a map that a page holds with ease.
const MOST_BINS: usize = 1 << 17;

/// Paths of each detector whose light can be shown by itself.
const PATHS: usize = 30;

/// Whether the bins of a map can be read out: pixels on a plane, and not too many of them.
pub fn is_read_out(map: &MapResult) -> bool {
    map.kind == MapKind::Plane && map.axes.is_some() && map.mean.len() <= MOST_BINS
}

/// The blocks.
pub fn blocks(results: &Results) -> Markup {
    let maps: Vec<Value> = results.maps.iter().filter(|map| is_read_out(map)).map(map).collect();
    let paths: Vec<Value> = results.detectors.keys().flat_map(|name| paths(results, name)).map(path).collect();
    html! {
        script type="application/json" id="maps" { (PreEscaped(super::view::embedded(&json!(maps)))) }
        script type="application/json" id="paths" { (PreEscaped(super::view::embedded(&json!(paths)))) }
    }
}

fn map(map: &MapResult) -> Value {
    let numbers = |values: &[f64]| singles(values.iter().map(|value| *value as f32));
    let axes: Vec<Value> = map
        .axes
        .iter()
        .flatten()
        .map(|axis| json!({ "name": axis.name, "start": axis.start, "step": axis.step }))
        .collect();
    json!({
        "detector": map.detector,
        "shape": map.shape,
        "axes": axes,
        "unit": map.unit.replace('2', "²"),
        "mean": numbers(&map.mean),
        "error": numbers(&map.error),
        "stray": map.stray.as_ref().map(|[mean, _]| numbers(mean)),
    })
}

fn paths<'a>(results: &'a Results, name: &'a str) -> impl Iterator<Item = &'a PathResult> {
    results.paths.iter().filter(move |path| path.detector == name && !path.cells.is_empty()).take(PATHS)
}

fn path(path: &PathResult) -> Value {
    json!({
        "path": [path.detector, path.sequence],
        "cells": singles(path.cells.iter().map(|cell| *cell as f32)),
    })
}
