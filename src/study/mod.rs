//! Many answers about one system: what is asked of several runs, or of several lanes of one.

pub mod assumption;
pub mod compare;
pub mod drawing;
pub mod ghost;
pub mod glare;
pub mod objects;
pub mod pst;
pub mod record;
pub mod requirement;
pub mod sensitivity;
pub mod verdict;
