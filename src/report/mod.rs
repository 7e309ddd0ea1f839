//! What a run found, written down: maps, tables, one page to read, one text for the terminal.
//!
//! ```text
//! summary.json      every number with its error, and how the run went
//! NAME.fits         map, error, contributing rays, upper limits, bin sizes (double precision, checksummed)
//! NAME.npy          the map alone, NAME_error.npy its error: row-major, row 0 first
//! NAME.png          the map with axes, units and a colour bar
//! paths.csv         which way the light came
//! report.html       all of it on one self-contained page
//! ```
//!
//! Nothing here computes physics: it only rounds, draws and lays out what `tally` found.

mod atomic;
pub mod compare;
mod digest;
mod fits;
pub mod ghosts;
mod html;
mod measured;
mod name;
mod npy;
mod paths;
mod picture;
pub mod problems;
pub mod pst;
pub mod sensitivity;
mod share;
mod summary;
mod text;
mod write;

pub use atomic::create;
pub use measured::{below, measured};
pub use picture::{Curve, Division, Ink, Line, Panel, Ruler, Span, Stroke, chart, curves, polar};
pub use text::text;
pub use write::{WriteError, write};
