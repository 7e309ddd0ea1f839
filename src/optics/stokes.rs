//! (to come)
pub struct Stokes;
