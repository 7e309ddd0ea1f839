//! Exact surfaces: lenses and mirrors from prescriptions and from meshes, against closed forms.

#[macro_use]
#[allow(unused_imports, reason = "one harness, several test targets")]
#[path = "../support/mod.rs"]
mod support;

#[allow(dead_code, reason = "one bench, several test targets")]
#[path = "../exactness/lab.rs"]
mod lab;

mod ghosts;
mod leaks;
mod lenses;
mod meshes;
mod radiance;
