//! Curves, and maps as pictures: row 0 at the bottom, columns to the right, so that a picture shows the detector from the stated side.

mod axis;
mod canvas;
mod chart;
mod curves;
mod field;
mod plot;
mod polar;
mod scale;

pub use axis::{Span, superscript, ticks};
pub use chart::{Curve, Division, Ruler, chart};
pub use curves::{Ink, Line, Panel, Stroke, curves};
pub use field::{Cell, Field};
pub use plot::{bare, png};
pub use polar::polar;
pub use scale::{Mark, Palette, Scale};
