//! What happens to light at a point: incidence, polarisation, reflection, refraction, Fresnel's amplitudes, thin films.

pub mod amplitudes;
pub mod fresnel;
pub mod incidence;
pub mod mie;
pub mod refraction;
pub mod stack;
pub mod stokes;

pub use amplitudes::{Amplitudes, Split};
pub use incidence::Incidence;
pub use stokes::{Hand, Stokes};
