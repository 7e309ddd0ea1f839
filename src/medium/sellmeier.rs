//! (to come)
pub struct Sellmeier;
