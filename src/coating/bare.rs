//! (to come)
pub struct Bare;
