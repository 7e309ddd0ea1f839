//! Many answers about one system: what is asked of several runs, or of several lanes of one.

pub mod glare;
pub mod pst;
