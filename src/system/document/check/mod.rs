//! What serde cannot see: ranges, names, contradictions. Everything is checked and everything wrong is reported.

mod bulk;
mod coating;
mod detector;
mod glare;
mod light;
mod optics;
mod requirement;
mod scatter;
mod sweep;
mod thermal;

use super::tree::Shape;
use super::{About, Body, Document, Run, read, variant};
use crate::error::{Problem, did_you_mean};
use crate::system::units::Wavelength;
use std::collections::BTreeSet;
use std::path::Path;

/// Shares given as decimals add up to 1 within the rounding of their sum: half an ulp for each of at most 64 terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Problems taken down; finding the place of each takes time.
const MOST: usize = 500;

/// Most rays of a run: the counter of the random numbers has 48 bits for the source ray.
const MOST_RAYS: u64 = 1 << 48;

/// A section whose entries are used by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Section {
    Media,
    Coatings,
    Scatter,
    Detectors,
    Targets,
}

impl Section {
    fn name(self) -> &'static str {
        match self {
            Section::Media => "media",
            Section::Coatings => "coatings",
            Section::Scatter => "scatter",
            Section::Detectors => "detectors",
            Section::Targets => "targets",
        }
    }

    fn noun(self) -> &'static str {
        match self {
            Section::Media => "medium",
            Section::Coatings => "coating",
            Section::Scatter => "scatter model",
            Section::Detectors => "detector",
            Section::Targets => "target",
        }
    }
}

/// Collects what is wrong.
struct Checker<'a> {
    document: &'a Document,
    problems: Vec<Problem>,
    used: BTreeSet<(Section, &'a str)>,
}

impl Document {
    /// All problems, without file. What is never used is only said of a system without faults.
    pub(super) fn checked(&self, sound: bool) -> Vec<Problem> {
        let mut checker = Checker { document: self, problems: Vec::new(), used: BTreeSet::new() };
        checker.geometry();
        checker.elements();
        checker.configure();
        checker.media();
        checker.coatings();
        checker.scatter();
        checker.surfaces();
        checker.sources();
        checker.sweeps();
        checker.glare();
        checker.thermal();
        checker.detectors();
        checker.requirements();
        checker.targets();
        checker.run(&self.system.run);
        if sound && !checker.problems.iter().any(Problem::is_error) {
            checker.unused();
        }
        checker.problems
    }
}

impl<'a> Checker<'a> {
    /// Takes a problem down at a path of the document.
    fn push(&mut self, path: &str, problem: Problem) {
        if self.problems.len() >= MOST {
            return;
        }
        self.problems.push(self.document.problem(path, problem));
    }

    /// Takes a problem down if something that must hold does not.
    fn require(&mut self, holds: bool, path: &str, problem: impl FnOnce() -> Problem) {
        if !holds {
            self.push(path, problem());
        }
    }

    /// Refuses a value out of its range, quoting it as written.
    fn range(&mut self, holds: bool, path: &str, expected: &str) {
        if !holds {
            let written = read::steps(path)
                .and_then(|steps| self.document.tree.find(&steps))
                .map_or(String::new(), |node| self.document.script.read(node.start..node.end));
            self.push(path, Problem::error(format!("{written} is out of range")).expecting(expected));
        }
    }

    fn fraction(&mut self, value: f64, path: &str) {
        self.range((0.0..=1.0).contains(&value), path, "a number between 0 and 1");
    }

    fn positive(&mut self, value: f64, path: &str) {
        self.range(value > 0.0 && value.is_finite(), path, "a value above 0");
    }

    fn not_negative(&mut self, value: f64, path: &str) {
        self.range(value >= 0.0 && value.is_finite(), path, "0 or more");
    }

    fn finite(&mut self, value: f64, path: &str) {
        self.range(value.is_finite(), path, "a finite number");
    }

    /// An angle in degrees, `least < angle <= most`.
    fn angle(&mut self, radians: f64, (least, most): (f64, f64), path: &str) {
        let degrees = radians.to_degrees();
        // One part in 1e12 for the conversion there and back.
        let holds = degrees > least && degrees <= most * (1.0 + 1e-12);
        self.range(holds, path, &format!("an angle above {least} deg, up to {most} deg"));
    }

    /// Shares of one whole: each 0..1 and together no more than 1.
    fn shares(&mut self, parts: &[(&str, f64)], path: &str) {
        for (name, value) in parts {
            self.fraction(*value, &format!("{path}.{name}"));
        }
        let valid = parts.iter().all(|(_, value)| (0.0..=1.0).contains(value));
        let sum: f64 = parts.iter().map(|(_, value)| value).sum();
        self.require(!valid || sum <= 1.0 + ROUNDING, path, || {
            let names: Vec<&str> = parts.iter().map(|(name, _)| *name).collect();
            Problem::error(format!("{} is {sum}: more light leaves than arrives", names.join(" + ")))
                .expecting("a sum of at most 1")
        });
    }

    fn wavelength(&mut self, wavelength: Wavelength, path: &str) {
        self.positive(wavelength.0, path);
        let plausible = wavelength.0 <= 0.0 || (10e-9..=1e-3).contains(&wavelength.0);
        self.require(plausible, path, || {
            Problem::warning(format!("a wavelength of {:e} m", wavelength.0)).expecting("10 nm to 1 mm")
        });
    }

    /// Wavelengths of a table: positive and strictly increasing.
    fn wavelengths(&mut self, wavelengths: &[Wavelength], path: &str) {
        for (at, wavelength) in wavelengths.iter().enumerate() {
            self.wavelength(*wavelength, &format!("{path}[{at}]"));
        }
        if let Some(at) = wavelengths.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            let problem = Problem::error("the wavelengths do not increase here");
            self.push(&format!("{path}[{}]", at + 1), problem.expecting("increasing wavelengths, each given once"));
        }
    }

    /// Two lists that belong together.
    fn same_length(&mut self, lengths: [usize; 2], names: [&str; 2], path: &str) {
        self.require(lengths[0] == lengths[1], &format!("{path}.{}", names[1]), || {
            Problem::error(format!("`{}` holds {} values and `{}` {}", names[0], lengths[0], names[1], lengths[1]))
                .expecting("lists of one length")
        });
        self.require(lengths[0] > 0, &format!("{path}.{}", names[0]), || Problem::error("the list is empty"));
    }

    fn not_empty(&mut self, text: &str, path: &str, what: &str) {
        self.require(!text.trim().is_empty(), path, || Problem::error(format!("{what} is empty")));
    }

    /// A name that must be defined in a section.
    fn refer(&mut self, section: Section, name: &'a str, path: &str) {
        self.used.insert((section, name));
        let defined = self.defined(section.name());
        if defined.contains(&name) || (section == Section::Media && name == "vacuum") {
            return;
        }
        let problem = Problem::error(format!("no {} {name:?}", section.noun()));
        let problem = match (did_you_mean(name, defined.iter().copied()), self.elsewhere(section, name)) {
            (Some(close), _) => problem.hinting(format!("did you mean {close:?}?")),
            (None, Some(other)) => problem.hinting(format!("{name:?} is defined in `{}`", other.name())),
            (None, None) if defined.is_empty() => problem.hinting(format!("`{}` defines none", section.name())),
            (None, None) => {
                let names: Vec<String> = defined.iter().take(12).map(|name| format!("{name:?}")).collect();
                problem.expecting(format!("one of {}", names.join(", ")))
            }
        };
        self.push(path, problem);
    }

    /// Another section that defines the name.
    fn elsewhere(&self, section: Section, name: &str) -> Option<Section> {
        let all = [Section::Media, Section::Coatings, Section::Scatter];
        all.into_iter().find(|other| *other != section && self.defined(other.name()).contains(&name))
    }

    /// Names that the text defines in a section, whether or not their values could be read.
    fn defined(&self, section: &str) -> Vec<&'a str> {
        let tree: &'a super::Node = &self.document.tree;
        match tree.child(section).map(|node| &node.shape) {
            Some(Shape::Entries(entries)) => entries.iter().filter_map(|(key, _)| key.text()).collect(),
            _ => Vec::new(),
        }
    }

    /// Definitions that nothing refers to.
    fn unused(&mut self) {
        let mentioned = variant::mentioned(&self.document.tree);
        for section in [Section::Media, Section::Coatings, Section::Scatter, Section::Targets] {
            for name in self.defined(section.name()) {
                let used = self.used.contains(&(section, name)) || mentioned.contains(name);
                self.require(used, &format!("{}[{name:?}]", section.name()), || {
                    Problem::warning(format!("{} {name:?} is never used", section.noun()))
                });
            }
        }
    }

    fn geometry(&mut self) {
        let document = self.document;
        for (at, geometry) in document.indices.geometry.iter().zip(&document.system.geometry) {
            self.gltf(&geometry.file, &format!("geometry[{at}].file"));
        }
    }

    fn gltf(&mut self, file: &Path, path: &str) {
        let extension = file.extension().and_then(|e| e.to_str()).unwrap_or("").to_lowercase();
        self.require(matches!(extension.as_str(), "glb" | "gltf"), path, || {
            Problem::error(format!("{:?} is not a glTF file", file.display().to_string()))
                .expecting("a file that ends in .glb or .gltf")
        });
    }

    fn configure(&mut self) {
        let document = self.document;
        for (at, change) in document.indices.configure.iter().zip(&document.system.configure) {
            let path = format!("configure[{at}]");
            self.not_empty(&change.node, &format!("{path}.node"), "the name of the node");
            let moves = change.scale.is_some() || change.rotate.is_some() || change.shift.is_some();
            let acts = moves || change.replace.is_some();
            self.require(change.hide != acts, &path, || {
                let what = if acts { "a hidden node is not changed" } else { "this changes nothing" };
                Problem::error(what).expecting("`hide: true`, or `replace`, `scale`, `rotate`, `move`")
            });
            self.require(moves || change.about == About::Own, &format!("{path}.about"), || {
                Problem::error("nothing is given in this frame").expecting("`scale`, `rotate` or `move`")
            });
            if let Some((x, y, z)) = change.scale {
                for (axis, factor) in [x, y, z].into_iter().enumerate() {
                    let holds = factor != 0.0 && factor.is_finite();
                    self.range(holds, &format!("{path}.scale[{axis}]"), "a factor that is not 0");
                }
            }
            if let Some(replacement) = &change.replace {
                self.gltf(&replacement.file, &format!("{path}.replace.file"));
                self.not_empty(&replacement.node, &format!("{path}.replace.node"), "the name of the node");
            }
        }
    }

    /// Media that elements name; their shapes are judged when they are built.
    fn elements(&mut self) {
        let document = self.document;
        for (name, element) in document.system.elements.iter() {
            let path = format!("elements[{name:?}].body");
            match &element.body {
                Body::Lens { media, .. } => {
                    let named = media.iter().enumerate();
                    named.for_each(|(i, medium)| self.refer(Section::Media, medium, &format!("{path}.media[{i}]")));
                }
                Body::Plate { medium: Some(medium), .. } | Body::Prism { medium: Some(medium), .. } => {
                    self.refer(Section::Media, medium, &format!("{path}.medium"));
                }
                _ => {}
            }
        }
    }

    fn run(&mut self, run: &'a Run) {
        self.range((1..=MOST_RAYS).contains(&run.rays), "run.rays", "1 to 2^48 rays");
        let batch = run.batch.unwrap_or(1);
        self.range(batch.is_power_of_two() && batch <= 1 << 24, "run.batch", "a power of two up to 2^24");
        self.range(run.splits <= 64, "run.splits", "0 to 64");
        self.range((1..=64).contains(&run.scatter_splits), "run.scatter_splits", "1 to 64");
        self.fraction(run.roulette.below, "run.roulette.below");
        let survive = run.roulette.survive;
        self.range(survive > 0.0 && survive <= 1.0, "run.roulette.survive", "a probability above 0, up to 1");
        self.range(run.max_events != Some(0), "run.max_events", "at least 1");
        self.range(run.paths <= 1_000_000, "run.paths", "at most 1_000_000 rows");
        if let Some(until) = &run.until {
            self.refer(Section::Detectors, &until.detector, "run.until");
        }
    }
}
