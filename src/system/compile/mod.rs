//! The compiler: from the document and its geometry to a scene. All problems at once, not the first.

pub mod against;
mod alias;
mod assembly;
mod assign;
mod coated;
mod coatings;
mod configure;
mod exact;
mod filters;
mod glare;
mod lights;
mod mask;
mod media;
mod models;
mod parts;
mod receivers;
mod scatter;
mod scatterer;
mod sweep;
mod targets;
pub mod understanding;
pub mod variants;

use super::document::{Document, Importance, Way};
use super::gltf::Node;
use crate::bsdf::contamination::Deposit;
use crate::error::{Error, Problem, Severity, did_you_mean};
use crate::geometry::Bvh;
use crate::scene::{Part, PartKind, Scene};
use crate::settings::{Guidance, Roulette, Settings, Trace, Until};
use crate::source::Source;
use assembly::Assembly;
pub use coated::{Coated, coated};
use glam::DVec3;
pub use glare::Glare;
pub use mask::Mask;
pub use parts::{parts_of_file, parts_of_system};
pub use scatterer::{Scatterer, scatterer};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::sync::Arc;
pub use sweep::Sweep;
pub use understanding::Understanding;

/// A system ready to be traced.
#[derive(Debug)]
pub struct Compiled {
    pub scene: Scene,
    pub settings: Settings,
    pub warnings: Vec<Problem>,
    /// SHA-256 of every file that was read, by name as written.
    pub inputs: BTreeMap<String, String>,
    /// Values of the system's parameters by name: `120 mm`.
    pub parameters: BTreeMap<String, String>,
    /// What is assumed of the finishes of the built-in library, a line each.
    pub finishes: Vec<String>,
    /// Which sources are sweeps, and what is asked of them.
    pub sweeps: Vec<Sweep>,
    /// Fields with a black patch.
    pub glare: Vec<Glare>,
}

/// The workshop: the document, and what is found wrong on the way.
pub struct Shop<'a> {
    pub document: &'a Document,
    pub problems: Vec<Problem>,
    pub inputs: BTreeMap<String, String>,
    /// Particles on surfaces, by the scatter model that holds them.
    pub deposits: BTreeMap<String, Arc<Deposit>>,
}

impl<'a> Shop<'a> {
    pub fn new(document: &'a Document, problems: Vec<Problem>) -> Shop<'a> {
        Shop { document, problems, inputs: BTreeMap::new(), deposits: BTreeMap::new() }
    }

    /// Notes a problem at a path of the document.
    pub fn fault(&mut self, path: &str, problem: Problem) {
        self.problems.push(self.document.problem(path, problem));
    }

    /// Notes a file that was read.
    pub fn input(&mut self, name: &str, bytes: &[u8]) {
        let hash = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        self.inputs.insert(name.into(), hash);
    }

    /// A glob that selects nothing.
    pub fn nothing_matches(&mut self, path: &str, glob: &str, names: &[String]) {
        self.fault(path, no_node(glob, names));
    }
}

/// A glob that none of these nodes matches.
fn no_node(glob: &str, names: &[String]) -> Problem {
    let problem = Problem::error(format!("no node matches `{glob}`"));
    match did_you_mean(glob, names.iter().map(String::as_str)) {
        Some(name) => problem.hinting(format!("did you mean `{name}`?")),
        None => problem.expecting(format!("one of {}", listed(names))),
    }
}

/// At most eight names of a list.
pub fn listed(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(8).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > 8 { format!(" and {} more", names.len() - 8) } else { String::new() };
    shown.join(", ") + &more
}

/// Compiles a document; reads the geometry and tables that it names.
pub fn compile(document: &Document) -> Result<Compiled, Error> {
    Ok(build(document)?.0)
}

/// Compiles a document and says what was understood of it.
pub fn understand(document: &Document) -> Result<(Compiled, Understanding), Error> {
    let (compiled, assembly) = build(document)?;
    let understanding = understanding::understand(&compiled.scene, &assembly, &compiled.settings, document);
    Ok((compiled, understanding))
}

/// The parts of a system where they stand.
#[derive(Debug)]
pub struct Placed {
    /// In scene coordinates, m.
    pub nodes: Vec<Node>,
    /// World coordinates minus those of the scene, m.
    pub shift: DVec3,
    pub warnings: Vec<Problem>,
}

impl Placed {
    /// The parts as a binary glTF file.
    pub fn glb(&self) -> Vec<u8> {
        super::gltf::glb(&self.nodes, self.shift)
    }
}

/// Reads and places the geometry of a document; everything else must be right as well.
pub fn geometry(document: &Document) -> Result<Placed, Error> {
    let (compiled, assembly) = build(document)?;
    Ok(Placed { nodes: assembly.nodes, shift: assembly.shift, warnings: compiled.warnings })
}

fn build(document: &Document) -> Result<(Compiled, Assembly), Error> {
    let mut shop = Shop::new(document, document.warnings.clone());
    let system_file = document.path.file_name().map_or("system".into(), |name| name.to_string_lossy().into_owned());
    shop.inputs.insert(system_file, document.sha256.clone());
    shop.inputs.extend(document.included().map(|(name, sha256)| (name, sha256.to_owned())));
    let mut assembly = assembly::read(&mut shop);
    let media = media::media(&mut shop);
    exact::declare(&mut shop, &mut assembly);
    let coatings = coatings::coatings(&mut shop, &media);
    let assigned = assign::assign(&mut shop, &mut assembly, &media, &coatings);
    exact::mason::faces(&mut shop, &mut assembly);
    let watched = receivers::detectors(&mut shop, &assembly);
    let targets = targets::targets(&mut shop, &assembly);
    let mut sources = lights::sources(&mut shop, &assembly);
    let sweeps = sweep::sweeps(&mut shop, &assembly, &watched, &mut sources);
    let glare = glare::glare(&mut shop, &assembly, &watched);
    let lit: Vec<Source> = sources.iter().chain(glare.iter().flat_map(|glare| &glare.sources)).cloned().collect();
    coatings::ranges(&mut shop, &coatings, &lit);
    if !lit.is_empty() {
        scatter::ranges(&mut shop, &lit);
    }
    if sources.is_empty() && shop.problems.iter().all(|p| p.severity == Severity::Warning) {
        shop.fault("sources", Problem::error("nothing shines").expecting("at least one source"));
    }
    let mut parts: Vec<Part> = assigned.parts;
    let mut detectors = Vec::new();
    for (index, (detector, on)) in watched.into_iter().enumerate() {
        on.into_iter().for_each(|part| parts[part].detectors.push(index as u16));
        detectors.push(detector);
    }
    let has_optics = parts.iter().any(|part| {
        let acts = |surface: u32| assigned.surfaces[surface as usize].optical();
        part.surface.iter().flatten().any(|&surface| acts(surface))
    });
    let scene = Scene {
        name: document.system.name.clone().unwrap_or_else(|| stem(document)),
        geometry: Bvh::build(&assembly.bodies()),
        part_of: assembly.all_parts(),
        parts,
        surfaces: assigned.surfaces,
        ambient: media::ambient(document),
        media,
        solids: assigned.solids,
        sources,
        detectors,
        filters: Vec::new(),
        targets,
        shift: assembly.shift,
        has_optics,
    };
    let filters = filters::filters(&mut shop, &scene);
    let scene = Scene { filters, ..scene };
    let settings = settings(document);
    shop.problems.extend(understanding::doubts(&scene, &assembly, document));
    let Shop { problems, inputs, .. } = shop;
    if problems.iter().any(|problem| problem.severity == Severity::Error) {
        return Err(Error::Input(problems));
    }
    let parameters = document.parameters.iter().map(|(name, value)| (name.to_owned(), value.clone())).collect();
    let finishes = scatter::assumptions(document);
    Ok((Compiled { scene, settings, warnings: problems, inputs, parameters, finishes, sweeps, glare }, assembly))
}

fn stem(document: &Document) -> String {
    let folder = document.path.parent().and_then(|folder| folder.file_name());
    folder.or(document.path.file_stem()).map_or("system".into(), |name| name.to_string_lossy().into_owned())
}

fn settings(document: &Document) -> Settings {
    let run = &document.system.run;
    let default = Settings::default();
    Settings {
        rays: run.rays,
        seed: run.seed,
        batch: run.batch,
        splits: run.splits as u16,
        scatter_splits: run.scatter_splits as u16,
        roulette: Roulette { below: run.roulette.below, survive: run.roulette.survive },
        max_scatters: run.max_scatters.map(|n| n.min(u16::MAX as u32) as u16),
        max_reflections: run.max_reflections,
        max_ghosts: default.max_ghosts,
        max_events: run.max_events.unwrap_or(default.max_events),
        until: run.until.as_ref().and_then(|until| {
            let detector = document.system.detectors.position(&until.detector)?;
            Some(Until { detector, relative: until.relative })
        }),
        paths: run.paths as usize,
        importance: match run.importance {
            Importance::Auto => Guidance::Auto,
            Importance::On => Guidance::On,
            Importance::Off => Guidance::Off,
        },
        trace: match run.trace {
            Way::Forward => Trace::Forward,
            Way::Backward => Trace::Backward,
        },
        booking: default.booking,
    }
}

/// True if a part is a face of a solid.
pub fn is_face(part: &Part) -> bool {
    matches!(part.kind, PartKind::Face(_))
}
