//! The system document exactly as written: types, reading, and what can be checked without opening another file.
//!
//! [`Document::read`] reads a RON file into a [`System`] whose quantities are SI, and refuses it with *all* of its
//! problems at once, each with line and column. [`Document::span`] finds the place of a path such as
//! `surfaces[3].scatter` or `sources["sun"].extent`, so that later stages can point into the same text.

mod bulk;
mod check;
mod coating;
mod configure;
mod detector;
mod element;
mod entry;
mod exact;
mod files;
mod geometry;
mod glare;
mod include;
mod manuscript;
mod medium;
mod names;
mod parameter;
mod read;
mod run;
mod scatter;
mod source;
mod stack;
mod surface;
mod sweep;
mod target;
mod tree;
mod variant;

pub use bulk::{Bulk, OverWavelength};
pub use coating::{Coating, Row, Specular};
pub use configure::{About, Change, Replacement};
pub use detector::{Bins, Detector, Quantity, Receiver};
pub use element::{Body, Element, Optical};
pub use exact::{Exact, Form, Relative};
pub use geometry::{Geometry, Up};
pub use glare::Glare;
pub use medium::Medium;
pub use names::Names;
pub use parameter::Choice;
pub use read::SECTIONS;
pub use run::{Importance, Roulette, Run, Until, Way};
pub use scatter::{FacetEnergy, FacetLaw, Facets, Roughness, Scatter, ScatterAxis, ScatterSide, Unmeasured};
pub use source::{Angular, Extent, Handedness, Polarization, Source, Spectrum};
pub use stack::{Layer, Thickness};
pub use surface::{ExtrasValue, Finish, Gap, Order, Predicate, Scattering, Selector, Side, Surface, default_smooth};
pub use sweep::{Angles, Mask, Sweep, degrees};
pub use target::Target;
pub use variant::{Bracket, Level};

use crate::error::{Error, Problem, Span};
use manuscript::Manuscript;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use tree::Node;
use variant::{Cast, Role};

/// Larger files are refused, bytes: a system is written by hand.
const LARGEST: u64 = 64 << 20;

/// An optical system as written, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// What reports call it.
    pub name: Option<String>,
    /// Files whose sections are laid under these.
    pub include: Vec<PathBuf>,
    /// Files with the shapes.
    pub geometry: Vec<Geometry>,
    /// Shapes written here, by name.
    pub elements: Names<Element>,
    /// Names of nodes and materials in the files, and what the system calls them.
    pub aliases: Names<String>,
    /// What is done to nodes once they are placed, in order.
    pub configure: Vec<Change>,
    /// The medium around everything: a name in `media`, or "vacuum".
    pub ambient: String,
    /// Media by name. "vacuum" is always there.
    pub media: Names<Medium>,
    /// Coatings by name.
    pub coatings: Names<Coating>,
    /// Scatter models by name.
    pub scatter: Names<Scatter>,
    /// What the triangles are; later entries override earlier ones, field by field.
    pub surfaces: Vec<Surface>,
    /// What triangles are that no entry selects.
    pub default: Option<Finish>,
    /// Light sources by name.
    pub sources: Names<Source>,
    /// Sources at many angles by name.
    pub sweeps: Names<Sweep>,
    /// Fields with a black patch by name.
    pub glare: Names<Glare>,
    /// Detectors by name.
    pub detectors: Names<Detector>,
    /// Expressions that choose light by its path, by name: see [`filter`](crate::filter).
    pub filters: Names<String>,
    /// What surfaces may aim at, by name.
    pub targets: Names<Target>,
    /// How it is traced.
    pub run: Run,
    /// Factor on scatter of an end of a bracket; 1 otherwise.
    pub level: Level,
}

impl System {
    /// The spectra of all light.
    pub fn spectra(&self) -> impl Iterator<Item = &Spectrum> {
        let sources = self.sources.iter().map(|(_, source)| &source.spectrum);
        let sweeps = self.sweeps.iter().map(|(_, sweep)| &sweep.spectrum);
        sources.chain(sweeps).chain(self.glare.iter().map(|(_, glare)| &glare.spectrum))
    }
}

/// A system and the text it was read from.
#[derive(Debug, Clone)]
pub struct Document {
    /// The file.
    pub path: PathBuf,
    /// SHA-256 of its bytes, in lower-case hexadecimal.
    pub sha256: String,
    /// The system.
    pub system: System,
    /// Values of the parameters, in the order of the text: `120 mm`.
    pub parameters: Names<String>,
    /// Names of the variants that the file has, in the order of the text.
    pub variants: Vec<String>,
    /// What the author should look at, though it can be used.
    pub warnings: Vec<Problem>,
    script: Manuscript,
    tree: Node,
    indices: Indices,
}

/// Which items of the lists could be read; all of them in a document that is accepted.
#[derive(Debug, Clone, Default)]
struct Indices {
    geometry: Vec<usize>,
    configure: Vec<usize>,
    surfaces: Vec<usize>,
    /// Which of the surfaces are other variants': they say nothing here.
    outlines: Vec<usize>,
}

/// Reads a file that the user names.
type Opener = dyn Fn(&Path) -> Result<Vec<u8>, Error>;

impl Document {
    /// Reads a system file and what it includes. Fails with all problems at once, or if a file that it names is not there.
    pub fn read(path: &Path) -> Result<Document, Error> {
        Document::choose(path, &Choice::default())
    }

    /// The same with parameters chosen from outside; fails also if the choice names what the system has not.
    pub fn choose(path: &Path, choice: &Choice) -> Result<Document, Error> {
        let bytes = load(path)?;
        if let Some(variant) = &choice.variant {
            return Document::play(path, &bytes, choice, Role::Variant(variant));
        }
        let document = Document::play(path, &bytes, choice, Role::Alone)?;
        document.played(&bytes, choice)?;
        Ok(document)
    }

    /// The system as it stands and then its variants, all with the same parts.
    pub fn lineup(path: &Path, choice: &Choice) -> Result<Vec<Document>, Error> {
        let bytes = load(path)?;
        let baseline = Document::play(path, &bytes, choice, Role::Baseline)?;
        let variants = baseline.played(&bytes, choice)?;
        Ok(std::iter::once(baseline).chain(variants).collect())
    }

    /// All variants of the file, or everything that is wrong with any of them.
    fn played(&self, bytes: &[u8], choice: &Choice) -> Result<Vec<Document>, Error> {
        let (mut variants, mut wrong) = (Vec::new(), Vec::<Problem>::new());
        for name in &self.variants {
            match Document::play(&self.path, bytes, choice, Role::Variant(name)) {
                Ok(variant) => variants.push(variant),
                Err(Error::Input(problems)) => {
                    let new = problems.into_iter().filter(|problem| !wrong.contains(problem));
                    wrong.extend(new.collect::<Vec<_>>());
                }
                Err(other) => return Err(other),
            }
        }
        if wrong.is_empty() { Ok(variants) } else { Err(Error::Input(wrong)) }
    }

    /// The document in a role, if nothing is wrong with it.
    fn play(path: &Path, bytes: &[u8], choice: &Choice, role: Role) -> Result<Document, Error> {
        let (document, mut problems) = Document::examine(path, bytes, choice, role, Some(&load))?;
        let missing = document.missing_files();
        let sound = !problems.iter().any(Problem::is_error);
        if sound && !missing.is_empty() {
            return Err(Error::Missing(missing));
        }
        let known: BTreeSet<String> = problems.iter().map(|problem| problem.path.clone()).collect();
        problems.extend(missing.into_iter().filter(|problem| !known.contains(&problem.path)));
        document.accepted(problems)
    }

    /// Reads a system from the bytes of a file. Opens no file: what it includes is left out.
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Document, Error> {
        let (document, problems) = Document::examine(path, bytes, &Choice::default(), Role::Alone, None)?;
        document.accepted(problems)
    }

    /// The document if nothing is wrong with it.
    fn accepted(mut self, problems: Vec<Problem>) -> Result<Document, Error> {
        if problems.iter().any(Problem::is_error) {
            return Err(Error::Input(problems));
        }
        self.warnings = problems;
        Ok(self)
    }

    /// The document as far as it can be read, and its problems.
    fn examine(
        path: &Path,
        bytes: &[u8],
        choice: &Choice,
        role: Role,
        open: Option<&Opener>,
    ) -> Result<(Document, Vec<Problem>), Error> {
        let mut gatherer = include::Gatherer::new(open);
        let name = path.file_name().map_or("system".into(), PathBuf::from);
        let tree = gatherer.file(path, &name, bytes)?;
        let include::Gatherer { mut script, problems: mut found, .. } = gatherer;
        let variants = variant::names(&tree);
        let Cast { tree, foreign, own } = variant::cast(tree, role)?;
        let parameter::Outcome { values: parameters, problems, unused } =
            parameter::substitute(&mut script, &tree, choice, role)?;
        found.extend(problems);
        let mut reader = read::Reader::new(&script);
        let (mut system, mut indices) = reader.system(&tree);
        system.level = reader.level(&tree, role);
        let read::Reader { problems, mended, .. } = reader;
        found.extend(problems);
        for (at, surface) in indices.surfaces.iter().zip(&mut system.surfaces) {
            if foreign.contains(at) && !own.contains(at) {
                *surface = Surface { name: surface.name.take(), ..Surface::new(surface.on.clone()) };
                indices.outlines.push(*at);
            }
        }
        let (path, sha256) = (path.to_path_buf(), digest(bytes));
        let warnings = Vec::new();
        let document = Document { path, sha256, system, parameters, variants, warnings, script, tree, indices };
        let checked = document.checked(found.is_empty() && role == Role::Alone);
        found.extend(checked.into_iter().filter(|problem| !read::is_mended(&mended, problem)));
        if !found.iter().any(Problem::is_error) {
            found.extend(unused);
        }
        let problems = document.located(found);
        Ok((document, problems))
    }

    /// What is wrong or doubtful about the system, in the order of the text: ranges, names, contradictions.
    pub fn problems(&self) -> Vec<Problem> {
        self.located(self.checked(true))
    }

    /// Problems in the order of the text, file by file.
    fn located(&self, mut problems: Vec<Problem>) -> Vec<Problem> {
        problems.sort_by_key(|problem| (self.script.order(problem.file.as_deref()), problem.span));
        let here = |problem: Problem| if problem.file.is_some() { problem } else { problem.in_file(&self.path) };
        problems.into_iter().map(here).collect()
    }

    /// Files that the system includes, as seen from its folder, each with its SHA-256.
    pub fn included(&self) -> impl Iterator<Item = (String, &str)> {
        self.script.pages.iter().skip(1).map(|page| (page.name.display().to_string(), page.sha256.as_str()))
    }

    /// Where a path such as `surfaces[3].scatter` or `sources["sun"].extent.radius` stands in the text of its file: the name
    /// of a named entry, the value of anything else. If the path leads nowhere, the nearest thing on the way.
    pub fn span(&self, path: &str) -> Option<Span> {
        self.find(path).map(|found| self.script.span(found.start..found.end))
    }

    /// A problem at a path of this document: file, place and path are filled in.
    pub fn problem(&self, path: &str, problem: Problem) -> Problem {
        let problem = problem.on(path);
        match self.find(path) {
            Some(found) => self.script.locate(problem, found.start..found.end),
            None => problem.in_file(&self.path),
        }
    }

    /// The value or name at a path, or the nearest on the way.
    fn find(&self, path: &str) -> Option<&Node> {
        let steps = read::steps(path)?;
        (1..=steps.len()).rev().find_map(|n| {
            let (last, way) = steps[..n].split_last()?;
            let node = self.tree.find(way)?;
            match last {
                tree::Step::Name(name) if node.key(name).is_some() => node.key(name),
                _ => self.tree.find(&steps[..n]),
            }
        })
    }

    /// The path of a file that the document names, which is relative to the document's own directory.
    pub fn resolve(&self, file: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// Content of a file that the document names. A pipe or a device is refused before it is opened.
    #[allow(clippy::result_large_err, reason = "built once per run")]
    pub fn load(&self, file: &Path) -> Result<Vec<u8>, Problem> {
        let resolved = self.resolve(file);
        if !resolved.is_file() {
            return Err(files::no_file(file, &resolved));
        }
        load(&resolved).map_err(|error| Problem::error(error.to_string()))
    }
}

/// The bytes of a file that the user named.
fn load(path: &Path) -> Result<Vec<u8>, Error> {
    let missing = |what: String| Error::Missing(vec![Problem::error(what).in_file(path)]);
    if path.is_dir() {
        return Err(missing("this is a directory; expected a system file".to_owned()));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(|e| missing(format!("cannot be opened: {e}")))?;
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(|e| missing(format!("cannot be read: {e}")))?;
    if bytes.len() as u64 > LARGEST {
        let problem = Problem::error(format!("this file is larger than {} MiB", LARGEST >> 20)).in_file(path);
        return Err(Error::Input(vec![problem]));
    }
    Ok(bytes)
}

/// SHA-256 in lower-case hexadecimal.
fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn not_utf8(bytes: &[u8], valid: usize) -> Problem {
    let before = String::from_utf8_lossy(&bytes[..valid]);
    Problem::error("this is not UTF-8 text")
        .at(tree::place(&before, before.len(), before.len()))
        .expecting("a system written in RON")
}

/// A fault of syntax in the file that was appended last.
fn syntax(script: &Manuscript, fault: &tree::Fault) -> Problem {
    // A fault at the very end of a file is in that file.
    let at = fault.at.max(script.pages.last().map_or(0, |page| page.start));
    let bracket = fault.open.map(|open| {
        let Span { line, column, .. } = script.span(open..open + 1);
        format!("inside the `{}` of line {line}, column {column}", script.written(open..open + 1))
    });
    let problem = script.locate(Problem::error(fault.message.clone()), at..at + 1).hinting(bracket);
    match fault.expected {
        Some(expected) => problem.expecting(expected),
        None => problem,
    }
}
