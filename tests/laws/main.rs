//! Laws that whole families obey: every interface, every medium, every scatter model; and the reference numbers of
//! `tests/data/verification/public.json` for single interfaces, dispersion and scatter.

mod azimuth;
mod contamination;
mod equations;
mod films;
mod interfaces;
mod media;
mod phases;
mod reference;
mod rough;
mod samplers;
mod scatter;
mod tables;
