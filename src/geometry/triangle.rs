//! (to come)
pub struct Triangle;
