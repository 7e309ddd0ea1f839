//! (to come)
pub struct Lambertian;
