//! The system as written: RON document, glTF geometry, and the compiler that turns both into a scene.

// A problem is large because it says much; it is made once, and ends the reading.
#![allow(clippy::result_large_err)]

pub mod compile;
pub mod document;
pub mod elements;
pub mod exact;
pub mod expression;
pub mod fit;
pub mod gltf;
pub mod lens;
pub mod schema;
pub mod select;
pub mod units;
