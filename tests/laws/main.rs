//! Laws that whole families obey: every interface, every medium, every scatter model; and the reference numbers of
//! `tests/data/verification/public.json` for single interfaces, dispersion and scatter.

mod equations;
mod films;
mod interfaces;
mod media;
mod reference;
mod samplers;
mod scatter;
