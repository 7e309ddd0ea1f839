//! Where light enters a film between faces (see `film`), and how it goes on from any face.

use crate::film::{Film, Onward};
use crate::geometry::{Crossing, Left};
use crate::packet::{Packet, Solids};
use crate::scene::{PartKind, Scene};

/// The faces that `packet` meets of those at `crossing`: all of them, or the near ones of a film, which it then carries.
pub fn open<const V: usize>(scene: &Scene, packet: &mut Packet<V>, crossing: Crossing) -> Crossing {
    let airy = |crossing: &Crossing| crossing.hits.iter().any(|hit| scene.part(*hit).air_gap);
    if crossing.hits.len() < 2 || !airy(&crossing) {
        return crossing;
    }
    let Some((near, far)) = split(scene, &crossing, &packet.solids) else { return crossing };
    packet.film = Some(Box::new(Film::new(crossing, near.clone(), far, packet.left.clone())));
    near
}

/// Faces of the solids that are left here, and all others; `None` unless there are both.
fn split(scene: &Scene, crossing: &Crossing, solids: &Solids) -> Option<(Crossing, Crossing)> {
    let (mut near, mut far) = (crossing.clone(), crossing.clone());
    let left = |kind| matches!(kind, PartKind::Face(solid) if solids.iter().any(|inside| inside == solid));
    near.hits.retain(|hit| !hit.front && left(scene.part(*hit).kind));
    far.hits.retain(|hit| !near.hits.contains(hit));
    (!near.hits.is_empty() && !far.hits.is_empty()).then_some((near, far))
}

/// The packet goes on from `crossing`, to the other side or back: into the film it carries, or away.
pub fn depart<const V: usize>(packet: &mut Packet<V>, crossing: &Crossing, passes: bool) {
    match packet.film.take().map(|film| film.onward(passes)) {
        Some(Onward::Film(film)) => packet.film = Some(film),
        Some(Onward::Away(left)) => packet.left = left,
        None => packet.left = Left::after(crossing, passes, &packet.left),
    }
}
