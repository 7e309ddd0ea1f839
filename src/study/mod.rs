//! Many answers about one system: what is asked of several runs, or of several lanes of one.

pub mod compare;
pub mod ghost;
pub mod glare;
pub mod pst;
pub mod record;
pub mod sensitivity;
pub mod verdict;
