//! (to come)
pub struct Mirror;
