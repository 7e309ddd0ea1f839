//! A sequence of surfaces cut into things: cemented glasses, mirrors, stops, screens.

use crate::prescription::{Material, Motion, Outline, Prescription, Role};
use glam::{DMat3, DVec3};

/// One thing.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// Surfaces `from..=to` with glass between them; `mirrored`: the last one reflects.
    Lens {
        from: usize,
        to: usize,
        mirrored: bool,
    },
    Mirror {
        at: usize,
        radius: f64,
        hole: Option<f64>,
    },
    Stop {
        at: usize,
    },
    /// A screen of a radius, m.
    Disc {
        at: usize,
        radius: f64,
    },
}

/// What was cut, and what was left out.
#[derive(Clone, Debug, Default)]
pub struct Cut {
    pub blocks: Vec<Block>,
    pub notes: Vec<String>,
}

/// Cuts a lens; `radii`: radius of the used part of every surface, m.
pub fn cut(lens: &Prescription, radii: &[f64]) -> Cut {
    let (mut cut, frames) = (Cut::default(), lens.frames());
    let last = lens.surfaces.len() - 1;
    let glass = |i: usize| *lens.medium(i) != Material::Air;
    let mut i = 1;
    while i < last {
        let surface = &lens.surfaces[i];
        let circle = |role: Role| {
            let of_role = surface.openings.iter().find(|opening| opening.role == role);
            of_role.and_then(|opening| match opening.outline {
                Outline::Circle(r) if opening.centre == [0.0; 2] => Some(r),
                _ => None,
            })
        };
        if surface.material == Material::Mirror && !glass(i) {
            let radius = masked(lens, &frames, i).unwrap_or(radii[i]);
            cut.blocks.push(Block::Mirror { at: i, radius: radius.max(radii[i]), hole: circle(Role::Hole) });
        } else if glass(i) {
            let (to, mirrored) = end(lens, i);
            let seen = cut.blocks.iter().any(|block| match block {
                Block::Lens { from, .. } => (frames[*from].shift - frames[to].shift).length() < 1e-9,
                _ => false,
            });
            if seen {
                cut.notes
                    .push(format!("surfaces {i} to {to}: the light passes the same glass again; it is written once"));
            } else {
                cut.blocks.push(Block::Lens { from: i, to, mirrored });
            }
            if mirrored {
                // The way back through the same glass.
                i = back(lens, to);
                cut.notes.push(format!("surfaces {} to {i}: the way back through the glass before the mirror", to + 1));
            } else {
                i = to;
            }
        } else if lens.stop == Some(i) {
            cut.blocks.push(Block::Stop { at: i });
        } else if let Some(radius) = circle(Role::Obscured) {
            cut.blocks.push(Block::Disc { at: i, radius });
        } else if surface.material != Material::Previous {
            cut.notes.push(format!("surface {i}: a dummy surface in air, left out"));
        }
        if surface
            .openings
            .iter()
            .any(|opening| !matches!(opening.outline, Outline::Circle(_)) || opening.centre != [0.0; 2])
        {
            cut.notes.push(format!("surface {i}: an opening that is not a centred circle is left out"));
        }
        i += 1;
    }
    cut
}

/// The last surface of the glass that begins at surface `from`, and whether it reflects.
fn end(lens: &Prescription, from: usize) -> (usize, bool) {
    let mut to = from + 1;
    loop {
        let surface = &lens.surfaces[to];
        if surface.material == Material::Mirror {
            return (to, true);
        }
        if *lens.medium(to) == Material::Air || to + 2 >= lens.surfaces.len() {
            return (to, false);
        }
        to += 1;
    }
}

/// The surface at which light that was reflected at `mirror`, inside glass, is in air again.
fn back(lens: &Prescription, mirror: usize) -> usize {
    let air = |i: &usize| *lens.medium(*i) == Material::Air;
    (mirror + 1..lens.surfaces.len() - 1).find(air).unwrap_or(lens.surfaces.len() - 2)
}

/// Radius of the mask on an earlier surface that lies where a mirror is: the back of an aluminised spot.
fn masked(lens: &Prescription, frames: &[Motion], mirror: usize) -> Option<f64> {
    let here = |i: &usize| (frames[*i].shift - frames[mirror].shift).length() < 1e-9;
    let masks = (1..mirror).filter(here).flat_map(|i| &lens.surfaces[i].openings);
    masks.filter(|opening| opening.role == Role::Obscured).find_map(|opening| match opening.outline {
        Outline::Circle(radius) => Some(radius),
        _ => None,
    })
}

/// Angles (rad) about the fixed axes x, then y, then z that make a rotation.
pub fn angles(turn: &DMat3) -> DVec3 {
    let [x, y, z] = [turn.x_axis, turn.y_axis, turn.z_axis];
    DVec3::new(y.z.atan2(z.z), (-x.z).atan2(x.x.hypot(x.y)), x.y.atan2(x.x))
}
