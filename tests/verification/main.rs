//! The verification set: whole runs of systems written in RON against closed forms and independent quadratures.

#[macro_use]
#[path = "../support/mod.rs"]
mod support;

mod adjoint;
mod cavities;
mod pulls;
mod radiometry;
mod slabs;
mod stray;
mod volumes;
