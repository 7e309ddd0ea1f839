//! (to come)
pub struct Abg;
