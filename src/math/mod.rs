//! Mathematics with no optics in it: random numbers, low-discrepancy points, sampling, tables, statistics, least squares.

pub mod alias;
pub mod eigen;
pub mod elliptic;
pub mod least_squares;
pub mod lowdiscrepancy;
pub mod quadrature;
pub mod rng;
pub mod sampling;
pub mod statistics;
pub mod table;

pub use rng::Rng;
