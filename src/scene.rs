//! What light sees: triangles, parts, surfaces, media, sources, detectors. Ids and SI units; strings only as labels.

use crate::aim::Target;
use crate::detector::Detector;
use crate::filter::{Filter, Names};
use crate::geometry::{Bvh, Hit, Left, Ray};
use crate::medium::Medium;
use crate::packet::{Ancestry, Class, Solids};
use crate::source::Source;
use crate::surface::Surface;
use crate::tally::Layout;
use glam::DVec3;
use num_complex::Complex64;
use std::borrow::Cow;
use std::sync::Arc;

/// A compiled system.
#[derive(Debug)]
pub struct Scene {
    pub name: String,
    pub geometry: Bvh,
    /// Triangle -> part.
    pub part_of: Vec<u32>,
    pub parts: Vec<Part>,
    pub surfaces: Vec<Surface>,
    pub media: Vec<Filling>,
    /// Index into `media` of what is outside every solid.
    pub ambient: u16,
    pub solids: Vec<Solid>,
    pub sources: Vec<Source>,
    pub detectors: Vec<Detector>,
    /// Choices of light that are counted apart.
    pub filters: Vec<Filter>,
    /// What surfaces may aim at.
    pub targets: Vec<Target>,
    /// Scene coordinates are world coordinates minus this, m: the scene is centred so that no digits are lost far from the origin.
    pub shift: DVec3,
    /// True if any surface mirrors or refracts.
    pub has_optics: bool,
}

/// Triangles of one node under one set of surface entries: what a path step names.
#[derive(Clone, Debug)]
pub struct Part {
    /// "Lens_1.front", unique.
    pub label: String,
    /// Surface for light arriving at the front and at the back, per variant lane: `surface[lane][side]`.
    pub surface: Vec<[u32; 2]>,
    pub kind: PartKind,
    /// Detectors that watch this part.
    pub detectors: Vec<u16>,
    /// Targets at which its front and its back aim what they scatter.
    pub aims: [Vec<u16>; 2],
    /// Whether optical contact with glass that touches it is broken by a film of ambient.
    pub air_gap: bool,
}

/// What crossing a part does to the medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// Face of a solid that has a medium.
    Face(u16),
    /// Open sheet or opaque mechanics: the medium is the same on both sides.
    Sheet,
    /// A declared interface between two media: at its back and at its front.
    Between { back: u16, front: u16 },
}

/// A medium by name.
#[derive(Debug)]
pub struct Filling {
    pub label: String,
    pub medium: Arc<dyn Medium>,
}

/// A closed body of one medium.
#[derive(Clone, Debug)]
pub struct Solid {
    pub label: String,
    pub medium: u16,
    /// Declared priority, then the smaller volume (m3), decides which medium fills an overlap.
    pub priority: i32,
    pub volume: f64,
}

/// The media on both sides of a crossing and what leads there.
#[derive(Clone, Debug)]
pub struct Crossed {
    /// Indices into `Scene::media`: on the side of the light, and beyond.
    pub media: [u16; 2],
    /// The solids the packet is in if it goes on.
    pub beyond: Solids,
    /// The hit whose surface acts; `None`: nothing is there.
    pub acting: Option<Hit>,
}

impl Scene {
    /// Slots of a run with `rows` rows in its path table.
    pub fn layout(&self, rows: usize) -> Layout {
        let bins = self.detectors.iter().map(|d| d.grid.shape().iter().product()).collect();
        Layout::new(self.parts.len(), self.media.len(), self.sources.len(), bins, rows).with_filters(self.filters.len())
    }

    /// The class of the light that is meant to arrive: the image, or what comes straight where nothing makes one.
    pub fn image(&self) -> Class {
        if self.has_optics { Class::Signal } else { Class::Direct }
    }

    /// What filters may name.
    pub fn names(&self) -> Names {
        Names {
            sources: self.sources.iter().map(|source| source.label.clone()).collect(),
            parts: self.parts.iter().map(|part| part.label.clone()).collect(),
            media: self.media.iter().map(|filling| filling.label.clone()).collect(),
            detectors: self.detectors.iter().map(|detector| detector.label.clone()).collect(),
            image: self.image(),
        }
    }

    /// A path as a detector sees it that it has come to: see [`Ancestry::ending`].
    pub fn ending<'a>(&self, detector: usize, path: &'a Ancestry) -> Cow<'a, Ancestry> {
        path.ending(|part| self.parts[part as usize].detectors.contains(&(detector as u16)))
    }

    /// Medium of the innermost of `solids`.
    pub fn medium_in(&self, solids: &Solids) -> u16 {
        if solids.is_empty() {
            return self.ambient;
        }
        let key = |s: u16| (self.solids[s as usize].priority, -self.solids[s as usize].volume);
        let innermost = solids.iter().max_by(|&a, &b| {
            let ((pa, va), (pb, vb)) = (key(a), key(b));
            pa.cmp(&pb).then(va.total_cmp(&vb)).then(b.cmp(&a))
        });
        innermost.map_or(self.ambient, |s| self.solids[s as usize].medium)
    }

    /// Complex index of medium `medium` at vacuum wavelength `wavelength` (m).
    pub fn index(&self, medium: u16, wavelength: f64) -> Complex64 {
        self.media[medium as usize].medium.index(wavelength)
    }

    /// The part of a hit.
    pub fn part(&self, hit: Hit) -> &Part {
        &self.parts[self.part_of[hit.triangle as usize] as usize]
    }

    /// The surface that light arriving at `hit` meets, in variant `lane`.
    pub fn surface(&self, hit: Hit, lane: usize) -> &Surface {
        let part = self.part(hit);
        let side = part.surface[lane.min(part.surface.len() - 1)];
        &self.surfaces[side[!hit.front as usize] as usize]
    }

    /// Whether a side of a part scatters in any variant.
    pub fn scatters(&self, part: u32, front: bool) -> bool {
        let mut lanes = self.parts[part as usize].surface.iter();
        lanes.any(|sides| !self.surfaces[sides[!front as usize] as usize].lobes.is_empty())
    }

    /// True for a bare interface in every variant.
    fn is_plain(&self, hit: Hit) -> bool {
        let mut lanes = self.part(hit).surface.iter();
        lanes.all(|sides| self.surfaces[sides[!hit.front as usize] as usize].is_plain())
    }

    /// One event out of all faces that lie on each other at a crossing: media before and after, and the face whose
    /// surface acts. An opaque face acts first, then the one with a finish of its own, then the nearest; the two faces of
    /// a solid that is entered and left again within the rounding of its corners are not there.
    /// `None`: the faces contradict the solids the packet is in.
    pub fn cross(&self, hits: &[Hit], solids: &Solids) -> Option<Crossed> {
        if let [hit] = hits
            && self.part(*hit).kind == PartKind::Sheet
        {
            let acting = (!self.is_plain(*hit)).then_some(*hit);
            return Some(Crossed { media: [self.medium_in(solids); 2], beyond: *solids, acting });
        }
        let mut beyond = *solids;
        let mut between = None;
        for (i, hit) in hits.iter().enumerate() {
            match self.part(*hit).kind {
                PartKind::Face(solid) if !hits[..i].iter().any(|other| self.is_face_of(*other, solid)) => {
                    match self.net_entries(hits, solid) {
                        0 => {}
                        1 => beyond.enter(solid).then_some(())?,
                        -1 => beyond.leave(solid).then_some(())?,
                        _ => return None,
                    }
                }
                PartKind::Between { back, front } => {
                    between = Some(if hit.front { [front, back] } else { [back, front] })
                }
                PartKind::Face(_) | PartKind::Sheet => {}
            }
        }
        let media = between.unwrap_or_else(|| [self.medium_in(solids), self.medium_in(&beyond)]);
        Some(Crossed { media, beyond, acting: self.acting(hits, media[0] == media[1]) })
    }

    fn is_face_of(&self, hit: Hit, solid: u16) -> bool {
        self.part(hit).kind == PartKind::Face(solid)
    }

    /// How many more times the hits enter a solid than leave it.
    fn net_entries(&self, hits: &[Hit], solid: u16) -> i32 {
        let faces = hits.iter().filter(|hit| self.is_face_of(**hit, solid));
        faces.map(|hit| if hit.front { 1 } else { -1 }).sum()
    }

    /// The hit whose surface acts; `None` if there is nothing but bare faces between equal media, or faces that cancel.
    fn acting(&self, hits: &[Hit], same_medium: bool) -> Option<Hit> {
        let there = |hit: &&Hit| match self.part(**hit).kind {
            PartKind::Face(solid) => hits.len() == 1 || self.net_entries(hits, solid) != 0,
            PartKind::Sheet | PartKind::Between { .. } => true,
        };
        let rank = |hit: &&Hit| (!self.surface(**hit, 0).opaque(), self.is_plain(**hit));
        let hit = match hits {
            [only] => *only,
            _ => *hits.iter().filter(there).min_by_key(rank)?,
        };
        (!same_medium || !self.is_plain(hit)).then_some(hit)
    }

    /// The solids that contain `point` (scene coordinates), by the winding number along a fixed skew direction.
    pub fn solids_at(&self, point: DVec3) -> Solids {
        let mut solids = Solids::default();
        let direction = DVec3::new(0.532_177_1, -0.371_993_5, 0.760_548_7).normalize();
        let mut winding = vec![0i32; self.solids.len()];
        let (mut ray, mut left) = (Ray { origin: point, direction }, Left::nothing());
        while let Some(crossing) = self.geometry.nearest(&ray, &left) {
            for hit in &crossing.hits {
                if let PartKind::Face(solid) = self.part(*hit).kind {
                    winding[solid as usize] += if hit.front { -1 } else { 1 };
                }
            }
            (ray.origin, left) = (crossing.point, Left::after(&crossing, true, &left));
        }
        for (solid, _) in winding.iter().enumerate().filter(|(_, count)| **count > 0) {
            solids.enter(solid as u16);
        }
        solids
    }
}
