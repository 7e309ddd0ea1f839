//! The variants of a system side by side: one scene whose lanes are their surfaces, wherever shapes and indices are the same.

use super::assembly::Assembly;
use super::models::Finish;
use super::understanding::contacts;
use super::{Compiled, build};
use crate::error::{Error, Problem};
use crate::geometry::Hit;
use crate::optics::Incidence;
use crate::scene::{Part, PartKind, Scene};
use crate::system::document::Document;
use glam::DVec2;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_4;

/// Most variants of one trace.
pub const LANES: usize = 16;

/// Variants that are traced together.
#[derive(Debug)]
pub struct Trace {
    /// The surfaces of the parts of its scene have as many lanes as there are `variants`.
    pub compiled: Compiled,
    /// Which variant each lane is; 0 is the baseline. The first lane is that which scatters most: what a run learns of importance, it
    /// learns of the first lane, and light that counts in one lane must not be dropped because it does not in another.
    pub variants: Vec<usize>,
    /// Values of the parameters in each lane: what only finishes depend on may differ.
    pub parameters: Vec<BTreeMap<String, String>>,
}

impl Trace {
    fn new(mut compiled: Compiled, mut variants: Vec<usize>, mut parameters: Vec<BTreeMap<String, String>>) -> Trace {
        let scene = &mut compiled.scene;
        let brightness: Vec<f64> = (0..variants.len()).map(|lane| scattered(scene, lane)).collect();
        // Of lanes that are alike the first, which is the baseline where it is there.
        let brightest = (0..variants.len()).rev().max_by(|&a, &b| brightness[a].total_cmp(&brightness[b])).unwrap_or(0);
        scene
            .parts
            .iter_mut()
            .filter(|part| brightest < part.surface.len())
            .for_each(|part| part.surface.swap(0, brightest));
        variants.swap(0, brightest);
        parameters.swap(0, brightest);
        Trace { compiled, variants, parameters }
    }

    /// The lane that the others are compared with: the baseline, or the first of variants that are traced without it.
    pub fn reference(&self) -> usize {
        self.variants.iter().position(|variant| *variant == 0).unwrap_or(0)
    }
}

/// TIS of the sides of all parts together in a lane, at 45 deg and a wavelength of the light.
fn scattered(scene: &Scene, lane: usize) -> f64 {
    let wavelength = scene.sources.first().map_or(550e-9, |source| source.spectrum.range()[0]);
    let at = Incidence { lay: DVec2::X, ..Incidence::in_air(FRAC_PI_4, wavelength) };
    let sides = scene.parts.iter().flat_map(|part| part.surface[lane.min(part.surface.len() - 1)]);
    sides.map(|side| scene.surfaces[side as usize].albedo(&at).iter().sum::<f64>()).sum()
}

/// Everything that is compared.
#[derive(Debug)]
pub struct Lineup {
    /// The first trace has the baseline among its lanes. So has every other that shares its shapes and indices.
    pub traces: Vec<Trace>,
    /// What the author should look at, each once.
    pub warnings: Vec<Problem>,
}

/// One document, compiled.
struct Entrant<'a> {
    number: usize,
    document: &'a Document,
    compiled: Compiled,
    assembly: Assembly,
}

/// Compiles the documents of a comparison, the baseline first.
///
/// # Errors
/// Everything that is wrong with any of them.
pub fn lineup(documents: &[Document]) -> Result<Lineup, Error> {
    let mut groups: Vec<Vec<Entrant>> = Vec::new();
    let (mut wrong, mut warnings) = (Vec::new(), Vec::new());
    for (number, document) in documents.iter().enumerate() {
        let (mut compiled, assembly) = match build(document) {
            Ok(built) => built,
            Err(Error::Input(problems)) => {
                note(&mut wrong, problems);
                continue;
            }
            Err(other) => return Err(other),
        };
        note(&mut warnings, std::mem::take(&mut compiled.warnings));
        let entrant = Entrant { number, document, compiled, assembly };
        match groups.iter_mut().find(|group| alike(&group[0], &entrant) && !clash(group, &entrant)) {
            Some(group) => group.push(entrant),
            None => groups.push(vec![entrant]),
        }
    }
    if wrong.iter().any(Problem::is_error) {
        return Err(Error::Input(wrong));
    }
    let mut traces = Vec::new();
    for group in groups {
        traces.extend(together(group)?);
    }
    Ok(Lineup { traces, warnings })
}

/// Adds problems that are not among the known.
fn note(known: &mut Vec<Problem>, more: Vec<Problem>) {
    for problem in more {
        let told = |other: &Problem| other.message == problem.message && other.span == problem.span;
        if !known.iter().any(told) {
            known.push(problem);
        }
    }
}

/// The traces of entrants that share shapes and indices; the first is in each of them.
fn together(group: Vec<Entrant>) -> Result<Vec<Trace>, Error> {
    let mut entrants = group.into_iter();
    let Some(mut first) = entrants.next() else { return Ok(Vec::new()) };
    let mut traces = Vec::new();
    let own = first.compiled.parameters.clone();
    let (mut variants, mut parameters) = (vec![first.number], vec![own.clone()]);
    for entrant in entrants {
        if variants.len() == LANES {
            let (compiled, assembly) = build(first.document)?;
            let full = std::mem::replace(&mut first.compiled, compiled);
            first.assembly = assembly;
            let numbers = std::mem::replace(&mut variants, vec![first.number]);
            traces.push(Trace::new(full, numbers, std::mem::replace(&mut parameters, vec![own.clone()])));
        }
        variants.push(entrant.number);
        parameters.push(entrant.compiled.parameters.clone());
        add(&mut first, entrant);
    }
    traces.push(Trace::new(first.compiled, variants, parameters));
    Ok(traces)
}

/// Adds the surfaces of another as a lane.
fn add(first: &mut Entrant, other: Entrant) {
    let Compiled { scene, inputs, finishes, .. } = other.compiled;
    let own = &mut first.compiled.scene;
    let offset = own.surfaces.len() as u32;
    for (part, theirs) in own.parts.iter_mut().zip(&scene.parts) {
        let surface = |side: usize| {
            let (old, new) = (part.surface[0][side], theirs.surface[0][side]);
            let finishes = [&first.assembly.finishes[old as usize], &other.assembly.finishes[new as usize]];
            if same(finishes, [first.document, other.document]) { old } else { offset + new }
        };
        let lane = [surface(0), surface(1)];
        part.surface.push(lane);
    }
    own.surfaces.extend(scene.surfaces);
    own.has_optics |= scene.has_optics;
    first.compiled.inputs.extend(inputs);
    let known: BTreeSet<String> = first.compiled.finishes.drain(..).chain(finishes).collect();
    first.compiled.finishes.extend(known);
}

/// True if two finishes are one: the same names that mean the same.
fn same([a, b]: [&Finish; 2], [left, right]: [&Document; 2]) -> bool {
    let coating = |name: &str| left.system.coatings.get(name) == right.system.coatings.get(name);
    let scatter = |name: &str| {
        let level = left.system.level.of(name) == right.system.level.of(name);
        level && left.system.scatter.get(name) == right.system.scatter.get(name)
    };
    // Names of media stand in the stacks of coatings.
    let media = || left.system.media.iter().all(|(name, medium)| right.system.media.get(name) == Some(medium));
    a == b
        && a.coating.as_deref().is_none_or(|name| coating(name) && media())
        && a.scatter.as_deref().is_none_or(scatter)
}

/// True if two can be lanes of one scene: they differ in nothing but their surfaces.
fn alike(a: &Entrant, b: &Entrant) -> bool {
    let (left, right) = (&a.document.system, &b.document.system);
    let written = left.geometry == right.geometry
        && left.elements == right.elements
        && left.aliases == right.aliases
        && left.configure == right.configure
        && left.sources == right.sources
        && left.detectors == right.detectors
        && left.targets == right.targets
        && left.run == right.run
        && left.surfaces.iter().map(|s| &s.exact).eq(right.surfaces.iter().map(|s| &s.exact));
    written && fitting(&a.compiled.scene, &b.compiled.scene) && filled_alike(a, b)
}

/// Where faces lie on each other one of them acts, in all lanes alike: true if another would act where one of these is alone.
fn clash(group: &[Entrant], other: &Entrant) -> bool {
    let entrants = || group.iter().chain([other]);
    // As `Scene::cross` ranks them, seen from both sides.
    let rank = |entrant: &Entrant, hit: Hit| {
        let surface = entrant.compiled.scene.surface(hit, 0);
        (!surface.opaque(), surface.is_plain())
    };
    let clashes = |hits: [Hit; 2]| {
        let ranks: Vec<[(bool, bool); 2]> = entrants().map(|entrant| hits.map(|hit| rank(entrant, hit))).collect();
        let together = [0, 1].map(|face| (ranks[0][face].0, ranks.iter().all(|ranks| ranks[face].1)));
        let acts = |[a, b]: [(bool, bool); 2]| a.cmp(&b);
        ranks.iter().any(|&own| acts(own) != acts(together) && !(own[0].1 && own[1].1))
    };
    let turned = |hit: Hit| Hit { front: !hit.front, ..hit };
    contacts(&group[0].compiled.scene).into_values().any(|hits| clashes(hits) || clashes(hits.map(turned)))
}

/// The same parts and solids, and light passes the same of them.
fn fitting(a: &Scene, b: &Scene) -> bool {
    let opaque = |scene: &Scene, sides: [u32; 2]| sides.map(|side| scene.surfaces[side as usize].opaque());
    let parts = a.parts.iter().zip(&b.parts).all(|(x, y)| {
        (&x.label, x.kind, &x.detectors, &x.aims, x.air_gap) == (&y.label, y.kind, &y.detectors, &y.aims, y.air_gap)
            && opaque(a, x.surface[0]) == opaque(b, y.surface[0])
    });
    let solids = |scene: &Scene| -> Vec<(String, u16, i32)> {
        scene.solids.iter().map(|solid| (solid.label.clone(), solid.medium, solid.priority)).collect()
    };
    parts
        && a.parts.len() == b.parts.len()
        && a.part_of == b.part_of
        && solids(a) == solids(b)
        && a.ambient == b.ambient
}

/// The same media fill the same numbers, wherever light goes.
fn filled_alike(a: &Entrant, b: &Entrant) -> bool {
    let scene = &a.compiled.scene;
    let between = scene.parts.iter().flat_map(|part| match part.kind {
        PartKind::Between { back, front } => vec![back, front],
        PartKind::Face(_) | PartKind::Sheet => Vec::new(),
    });
    let used: BTreeSet<u16> =
        scene.solids.iter().map(|solid| solid.medium).chain([scene.ambient]).chain(between).collect();
    used.into_iter().all(|medium| {
        let [x, y] = [scene, &b.compiled.scene].map(|s| s.media[medium as usize].label.as_str());
        x == y && a.document.system.media.get(x) == b.document.system.media.get(y)
    })
}

/// What a lane does otherwise than the reference, for people: part and the finish there, each part once.
pub fn differences(trace: &Trace, lane: usize) -> Vec<(String, String)> {
    let scene = &trace.compiled.scene;
    let part = |part: &Part| {
        let (old, new) = (*part.surface.get(trace.reference())?, *part.surface.get(lane)?);
        let side = (0..2).find(|&side| old[side] != new[side])?;
        Some((part.label.clone(), scene.surfaces[new[side] as usize].label.clone()))
    };
    scene.parts.iter().filter_map(part).collect()
}
