//! The index of every medium at the wavelength of the source ray in hand, asked for once: all its branches have that wavelength.

use crate::scene::Scene;
use num_complex::Complex64;

/// Complex indices n + ik that have been asked for.
#[derive(Debug)]
pub struct Indices {
    /// Vacuum wavelength, m.
    wavelength: f64,
    /// By medium.
    known: Vec<Option<Complex64>>,
}

impl Indices {
    pub fn new(scene: &Scene) -> Indices {
        Indices { wavelength: 0.0, known: vec![None; scene.media.len()] }
    }

    /// [`Scene::index`], bit by bit.
    pub fn at(&mut self, scene: &Scene, medium: u16, wavelength: f64) -> Complex64 {
        if self.wavelength != wavelength {
            self.wavelength = wavelength;
            self.known.fill(None);
        }
        *self.known[medium as usize].get_or_insert_with(|| scene.index(medium, wavelength))
    }
}
