//! straylight: from a written optical system to numbers with error bars.

pub mod bsdf;
pub mod cli;
pub mod coating;
pub mod detector;
pub mod error;
pub mod geometry;
pub mod math;
pub mod medium;
pub mod optics;
pub mod packet;
pub mod registry;
pub mod report;
pub mod scene;
pub mod source;
pub mod surface;
pub mod system;
pub mod tally;
pub mod transport;
