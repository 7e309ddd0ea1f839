//! Ghosts by pairs of surfaces against optics that is unfolded by hand, and filters against the path table.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[path = "../support/mod.rs"]
mod support;

mod filters;
mod gauss;
mod pairs;
mod unfold;
