//! What must come out exactly: deterministic cases of `tests/data/verification/public.json` through the whole chain (text
//! and geometry, compile, trace, bill), the statistics of the error bars, and the list of who tests what.

#[allow(unused_imports, reason = "one harness, several test targets")]
#[path = "../support/mod.rs"]
mod support;

mod bodies;
mod cases;
mod coincidence;
mod dust;
mod edges;
mod films;
mod ghosts;
mod interfaces;
#[allow(dead_code, reason = "one bench, several test targets")]
mod lab;
mod lay;
mod ledger;
mod media;
mod mixed;
mod optiland;
mod orders;
mod samplers;
mod statistics;
