//! The system in 3-D: a canvas, what steers it, and the scripts that draw.
//!
//! | script | does |
//! |---|---|
//! | `data.js` | takes the block of data apart |
//! | `space.js` | vectors and matrices |
//! | `camera.js` | where one looks from: mouse, touch, keys |
//! | `shape.js` | corners with normals, lines of a section, rays as ribbons |
//! | `canvas.js` | WebGL 2: parts, section, rays |
//! | `pick.js` | which triangle is under the pointer |
//! | `colour.js` | one colour for each finish, coating, medium or side |
//! | `stage.js` | buttons, list of parts, what is said of what was picked |

mod data;

use super::{Page, number::plain};
use crate::report::measured::grouped;
use crate::tally::drawing::Drawing;
pub use data::{embedded, singles};
use maud::{Markup, PreEscaped, html};

/// The scripts of the view, in one scope of their own.
pub const SCRIPTS: &[&str] = &[
    include_str!("../script/data.js"),
    include_str!("../script/space.js"),
    include_str!("../script/camera.js"),
    include_str!("../script/shape.js"),
    include_str!("../script/canvas.js"),
    include_str!("../script/pick.js"),
    include_str!("../script/colour.js"),
    include_str!("../script/stage.js"),
];

/// How the view looks.
pub const STYLE: &str = include_str!("style.css");

/// The page of a system before it is traced.
pub fn page(system: &str, drawing: &Drawing) -> String {
    let body = html! {
        header {
            p.overline { "System, before tracing" }
            h1 { (system) }
        }
        (stage(drawing))
        p.note { "Rays show where light goes, not how much of it: at each interface one branch is drawn, by its share of the light. "
            "Sides: the front is where the normal points to. Exact surfaces are drawn by facets that stand for them. Made by straylight "
            (env!("CARGO_PKG_VERSION")) "." }
    };
    super::document(&Page { title: system, kind: "3-D view", class: "wide", style: STYLE, scripts: SCRIPTS }, &body)
}

/// The view itself, to stand in any page that has its scripts.
pub fn stage(drawing: &Drawing) -> Markup {
    html! {
        section.stage id="stage" aria-label="3-D view" {
            div.scene {
                canvas id="canvas" tabindex="0" role="application"
                    aria-label="3-D view of the system. Arrow keys turn it, shift and arrow keys move it, plus and minus zoom, 0 shows all of it." {}
                p.picked id="picked" role="status" {}
                p.hint { "drag to turn · shift or right button to move · wheel to zoom · click a part" }
            }
            form.panel id="panel" {
                (choices())
                (section_plane())
                details.list open {
                    summary { "Parts " small id="count" { (drawing.parts.len()) } }
                    input id="find" type="search" placeholder="find a part" aria-label="Find a part";
                    div.rows { button type="button" id="all" { "show all" } button type="button" id="none" { "hide all" } }
                    ul id="parts" {}
                }
                @if drawing.moved > 0.0 { (merged(drawing)) }
            }
        }
        script type="application/json" id="drawing" { (PreEscaped(embedded(&data::data(drawing)))) }
    }
}

/// What is coloured and shown.
fn choices() -> Markup {
    html! {
        div.rows {
            label { "Colour by " select id="colour" {
                option value="finish" { "finish" } option value="coating" { "coating" }
                option value="medium" { "medium" } option value="side" { "side" }
            } }
            label { "Opacity " input id="opacity" type="range" min="5" max="100" value="100" aria-label="Opacity"; }
        }
        ul.legend id="legend" {}
        div.rows {
            label { input id="rays" type="checkbox" checked; " rays" }
            label { input id="normals" type="checkbox"; " normals" }
            label { input id="edges" type="checkbox" checked; " edges" }
        }
        div.rows {
            label { "Rays of " select id="from" {} }
            label { "by " select id="raycolour" { option value="class" { "class" } option value="source" { "source" } } }
        }
        div.rows.looks {
            span { "Look along" }
            @for axis in ["x", "y", "z"] { button type="button" data-look=(axis) { (axis) } }
            button type="button" data-look="all" { "reset view" }
        }
    }
}

fn section_plane() -> Markup {
    html! {
        div.rows {
            label { "Section " select id="axis" {
                option value="" { "off" } option value="0" { "x" } option value="1" { "y" } option value="2" { "z" }
            } }
            label { input id="flip" type="checkbox"; " other half" }
            output id="place" {}
        }
        input.slide id="slide" type="range" min="-1000" max="1000" value="0" aria-label="Place of the section plane";
    }
}

/// What the picture of a large mesh leaves out.
fn merged(drawing: &Drawing) -> Markup {
    let shown: usize = drawing.parts.iter().map(|part| part.triangles).sum();
    html! {
        p.note { "Simplified for the screen: " (grouped(shown as u64, "\u{202f}")) " of " (grouped(drawing.all_triangles as u64, "\u{202f}"))
            " triangles, corners moved by up to " (plain(1e3 * drawing.moved, "mm")) ". Light is traced against all of them." }
    }
}
