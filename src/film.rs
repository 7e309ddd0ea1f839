//! A film between two faces that lie on each other: the optical contact that `gap: Air` breaks.
//!
//! The film has no thickness and is filled with what is around the glass. Light that leaves the glass meets the bare
//! or coated face first, glass to film; what is transmitted meets the face beyond in the same place, and what comes back
//! from there meets the glass again, until all of it is absorbed or has left on one side. Each meeting is an event of its own.
//!
//! Left out: frustrated total reflection and interference, which need a film thinner than some wavelengths.

use crate::geometry::{Crossing, Left};

/// The film that a packet is about to enter or is in.
#[derive(Clone, Debug)]
pub struct Film {
    /// All faces that lie here.
    all: Crossing,
    /// The faces it comes from, as met from inside the glass.
    near: Crossing,
    /// The faces on the other side of the film.
    far: Crossing,
    /// What the packet had left when it arrived.
    before: Left,
    place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// At the near faces, still in the glass.
    Arriving,
    /// In the film, on the way to the far faces.
    Across,
    /// In the film, on the way back to the near faces.
    Back,
}

/// Where a packet goes on.
pub enum Onward {
    /// In the film.
    Film(Box<Film>),
    /// Away from it, having left this.
    Away(Left),
}

impl Film {
    /// At the near faces of a film. `near` and `far` share out the hits of `all`; `before`: what was left on the way there.
    pub fn new(all: Crossing, near: Crossing, far: Crossing, before: Left) -> Film {
        Film { all, near, far, before, place: Place::Arriving }
    }

    /// The faces that light in the film meets next, at no distance.
    pub fn next(&self) -> Crossing {
        let mut crossing = if self.place == Place::Across { self.far.clone() } else { self.near.clone() };
        crossing.distance = 0.0;
        if self.place == Place::Back {
            crossing.hits.iter_mut().for_each(|hit| hit.front = !hit.front);
        }
        crossing
    }

    /// After the faces it has just met: to their other side (`passes`) or back.
    pub fn onward(mut self: Box<Film>, passes: bool) -> Onward {
        self.place = match (self.place, passes) {
            (Place::Arriving, true) | (Place::Back, false) => Place::Across,
            (Place::Across, false) => Place::Back,
            (place, _) => return Onward::Away(Left::after(&self.all, place == Place::Across, &self.before)),
        };
        Onward::Film(self)
    }
}
