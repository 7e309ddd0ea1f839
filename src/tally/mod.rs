//! Sums per batch, and what they mean.
//!
//! Every number that a run can give lives in one *slot*: a ledger line, a class, a pixel, a path. A batch adds flux to
//! slots; batches are folded in a fixed binary tree on the batch index; a slot then has a mean, a standard error from
//! the scatter of its batches, and the number of source rays that fed it.

pub mod drawing;
pub mod layout;
pub mod required;
pub mod results;
pub mod series;
pub mod slots;

pub use layout::Layout;
pub use slots::{Fold, Live, Sums};
