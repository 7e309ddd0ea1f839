//! Sums per batch, and what they mean: estimates, ledger, paths, maps.

pub mod results;
