//! The double Gauss of `systems/double_gauss`, lit along its axis, and its vertices as a list.

use crate::unfold::Vertex;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use straylight::study::ghost::{Ghosts, ghosts};
use straylight::system::compile::{Compiled, compile};
use straylight::system::document::{Body, Document, Form};
use straylight::tally::results::Results;
use straylight::transport::{self, summary};

/// A compiled double Gauss.
pub struct Gauss {
    pub compiled: Compiled,
    /// Lens surfaces in the order of the light, then the image.
    pub train: Vec<Vertex>,
    /// Where a ray must stay below a radius (m) between two places (m): stop, spacers, barrel.
    pub bores: Vec<([f64; 2], f64)>,
}

/// Lit by a parallel beam of 1 W and this radius (mm), with replacements in the text of the system.
pub fn gauss(beam: f64, rays: u64, edits: &[(&str, &str)]) -> Gauss {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems/double_gauss/system.ron");
    let mut text = std::fs::read_to_string(shipped).expect("the shipped system");
    let end = |text: &str, from: usize| from + text[from..].find("\n    },\n").expect("the end of the section") + 8;
    let from = text.find("    sources: {").expect("sources");
    let source = format!(
        "    sources: {{ \"star\": (flux: \"1 W\", extent: Disk(radius: \"{beam} mm\"), at: \"(0, 0, -5) mm\", axis: \"(0, 0, 1)\", \
         angular: Collimated(direction: \"(0, 0, 1)\"), spectrum: Line(\"587.7246 nm\")) }},\n"
    );
    text.replace_range(from..end(&text, from), &source);
    for (old, new) in edits.iter().chain(&[("rays: 300_000", &*format!("rays: {rays}"))]) {
        assert!(text.contains(old), "{old} is not in the system");
        text = text.replace(old, new);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("system.ron");
    std::fs::write(&path, text).expect("written");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{e}\n{:#?}", e.problems()));
    let compiled = compile(&document).unwrap_or_else(|e| panic!("{e}\n{:#?}", e.problems()));
    let (train, bores) = train(&document, &compiled);
    Gauss { compiled, train, bores }
}

fn train(document: &Document, compiled: &Compiled) -> (Vec<Vertex>, Vec<([f64; 2], f64)>) {
    let scene = &compiled.scene;
    let wavelength = 587.7246e-9;
    let complex = |name: &str| {
        let medium = scene.media.iter().position(|filling| filling.label == name).expect("a medium");
        scene.index(medium as u16, wavelength)
    };
    let absorption = |name: &str| 4.0 * PI * complex(name).im / wavelength;
    let (mut train, mut bores) = (Vec::new(), Vec::new());
    for (_, element) in document.system.elements.iter() {
        let z = element.at.0.z;
        match &element.body {
            Body::Lens { surfaces, thickness, media, .. } => {
                let mut place = z;
                for (at, surface) in surfaces.iter().enumerate() {
                    let around = |i: Option<usize>| i.and_then(|i| media.get(i)).map_or("air", String::as_str);
                    let curvature = if let Form::Sphere { radius } = &surface.form { 1.0 / radius.0 } else { 0.0 };
                    let semi = surface.semi_diameter.as_ref().expect("a semi-diameter").0;
                    let sides = [around(at.checked_sub(1)), around(Some(at))];
                    let (indices, absorption) = (sides.map(|name| complex(name).re), sides.map(absorption));
                    train.push(Vertex { place, curvature, semi, indices, absorption, reflectance: None });
                    place += thickness.get(at).map_or(0.0, |thickness| thickness.0);
                }
            }
            Body::Aperture { diameter, .. } if diameter.0 > 0.0 => bores.push(([z, z], 0.5 * diameter.0)),
            Body::Aperture { outer, .. } => {
                let (indices, absorption) = ([complex("air").re; 2], [0.0; 2]);
                let semi = 0.5 * outer.0;
                train.push(Vertex { place: z, curvature: 0.0, semi, indices, absorption, reflectance: Some(0.0) });
            }
            Body::Tube { inner, length, .. } => bores.push(([z, z + length.0], 0.5 * inner.0)),
            other => panic!("{other:?} in a double Gauss"),
        }
    }
    train.sort_by(|a, b| a.place.total_cmp(&b.place));
    (train, bores)
}

impl Gauss {
    /// All ghosts of two reflections.
    pub fn ghosts(&self) -> Ghosts {
        let never = AtomicBool::new(false);
        let found = ghosts(&self.compiled.scene, &self.compiled.settings, 2, &never, &|_| ()).expect("not stopped");
        assert!(found.trusted, "{:?}", found.warnings);
        found
    }

    /// A plain run.
    pub fn run(&self) -> Results {
        let Compiled { scene, settings, .. } = &self.compiled;
        let counts = transport::run::<1>(scene, settings, &AtomicBool::new(false), &|_| ());
        summary::results(scene, settings, &counts, 0, Default::default(), Vec::new())
    }
}
