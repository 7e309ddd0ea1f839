//! Lenses between prescription and system: an imported file becomes elements, elements become a sequence of surfaces again.

mod blocks;
mod glass;
mod sequence;
mod text;
mod write;

pub use glass::{index, vacuum};
pub use sequence::{Sequence, sequence};
pub use write::{Written, system};
