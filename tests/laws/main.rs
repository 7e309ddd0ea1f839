//! Laws that whole families obey: every interface, every medium, every scatter model; and the reference numbers of
//! `tests/data/verification/public.json` for single interfaces, dispersion and scatter.

mod azimuth;
mod cells;
mod contamination;
mod equations;
mod family;
mod films;
mod interfaces;
mod measured;
mod media;
mod phases;
mod polar;
mod reference;
mod rough;
mod samplers;
mod scatter;
mod tables;
