//! Simple arithmetic with quantities: `0.5 * hood.length + 2 mm`, `(0, 0, gap)`, `f / (2 * tan(field))`.
//!
//! ```text
//! expression  sum, or three of them in parentheses with commas between
//! sum         product + product - product ..
//! product     factor * factor / factor ..
//! factor      -factor, number, number unit, name, function(sum, ..), (sum)
//! ```
//!
//! Names are those of parameters, and `pi`. Functions: sqrt, abs, min, max; sin, cos, tan of an angle; asin, acos, atan, which
//! give one. What is added or compared must measure the same. SI inside, in double precision.

mod parse;
mod quantity;
#[cfg(test)]
mod tests;

pub use parse::{Fault, evaluate, is_name};
pub use quantity::{Quantity, Value};
