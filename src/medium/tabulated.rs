//! (to come)
pub struct Tabulated;
