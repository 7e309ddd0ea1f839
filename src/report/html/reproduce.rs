//! What is needed to get the same bits again.

use crate::report::measured::grouped;
use crate::tally::results::{Results, RunInfo};
use maud::{Markup, html};
use std::collections::BTreeMap;

pub fn reproduce(results: &Results, run: &RunInfo) -> Markup {
    let gap = "\u{202f}";
    html! {
        section.reproduce {
            h2 { "Repeat this run" }
            p { "The same version, inputs and seed give the same bits on any number of threads." }
            pre { (run.command) }
            dl {
                dt { "Version" } dd { "straylight " (run.version) }
                dt { "Seed" } dd { (results.seed) }
                dt { "Source rays" } dd { (grouped(results.rays, gap)) " in " (grouped(results.batches, gap)) " batches of " (grouped(results.batch_rays, gap)) }
                dt { "Run" } dd { (run.threads) " threads on " (run.host) ", " (format!("{:.1}", run.seconds)) " s, "
                    (grouped(run.rays_per_s.max(0.0) as u64, gap)) " source rays/s, " (grouped(run.segments_per_s.max(0.0) as u64, gap)) " segments/s" }
            }
            @if !results.parameters.is_empty() {
                table.inputs {
                    thead { tr { th { "Parameter" } th { "Value" } } }
                    tbody { @for (name, value) in &results.parameters { tr { td { (name) } td { (value) } } } }
                }
            }
            @if !results.finishes.is_empty() {
                table.inputs {
                    thead { tr { th { "Finishes of the built-in library" } } }
                    tbody { @for finish in &results.finishes { tr { td { (finish) } } } }
                }
            }
            (inputs(&results.inputs))
            (footer(run))
        }
    }
}

/// The same for what is more than one run.
pub fn repeat(run: &RunInfo, read: &BTreeMap<String, String>) -> Markup {
    html! {
        section.reproduce {
            h2 { "Repeat this" }
            p { "The same version, inputs and seed give the same bits on any number of threads." }
            pre { (run.command) }
            p.note { "straylight " (run.version) ", " (run.threads) " threads on " (run.host) ", " (format!("{:.1}", run.seconds)) " s" }
            (inputs(read))
            (footer(run))
        }
    }
}

fn inputs(inputs: &BTreeMap<String, String>) -> Markup {
    html! {
        @if !inputs.is_empty() {
            table.inputs {
                thead { tr { th { "Input" } th { "SHA-256" } } }
                tbody { @for (name, hash) in inputs { tr { td { (name) } td.hash { (hash) } } } }
            }
        }
    }
}

fn footer(run: &RunInfo) -> Markup {
    html! { footer { "Geometric optics: diffraction is outside of this model. Made by straylight " (run.version) "." } }
}
