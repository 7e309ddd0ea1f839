//! (to come)
pub struct Constant;
