//! (to come)
pub struct Ideal;
