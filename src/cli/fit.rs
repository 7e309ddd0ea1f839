//! `straylight fit`: the planes, spheres, conics and cylinders that a mesh was made from.

use super::table::{Table, digits, direction, millimetres};
use super::{Ending, tell, warn};
use clap::Args;
use glam::DVec3;
use std::path::{Path, PathBuf};
use straylight::error::{Error, Problem, did_you_mean, printable};
use straylight::geometry::exact::Shape;
use straylight::geometry::fit::{Fit, Kind};
use straylight::report::measured;
use straylight::system::compile::{parts_of_file, parts_of_system};
use straylight::system::document::Document;
use straylight::system::fit::{Face, Wish, faces};
use straylight::system::gltf::Node;
use straylight::system::select::named;
use straylight::system::units::{Angle, FromText, Length, LengthUnit};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct FitArgs {
    /// glTF file (.glb, .gltf), or a system file (.ron) for all of its geometry, placed as it says
    pub file: PathBuf,
    /// Only nodes whose name or path matches
    #[arg(long, value_name = "GLOB", default_value = "*")]
    pub node: String,
    /// Unit of length of the glTF file [default: m]
    #[arg(long, value_name = "UNIT", value_parser = LengthUnit::from_text)]
    pub unit: Option<LengthUnit>,
    /// Neighbouring triangles are on one face if their normals differ by no more than this
    #[arg(long, value_name = "ANGLE", default_value = "20 deg", value_parser = Angle::from_text)]
    pub smooth: Angle,
    /// Look for aspheres with these powers of r, too: "asphere:4,6,8"
    #[arg(long, value_name = "FORM", value_parser = powers)]
    pub form: Option<Powers>,
    /// Largest distance of a corner from its form, such as "5 um" [default: what single precision explains]
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    pub tolerance: Option<Length>,
}

const EXAMPLE: &str = "\
Example:
  straylight fit systems/triplet/triplet.glb --node \"Lens_*\"

A row for each smooth face of each node: the simplest form that all of its corners lie on, with radius and conic
constant +- one standard error, vertex, axis, the radius of a circular rim, the residuals of the corners, and by how
much the next simpler form misses them. R > 0: the centre lies towards +axis. Then the entries to paste into `surfaces`;
they turn the facets into that form. Where nothing is found, the last column says how near the nearest form comes: a
--tolerance accepts it, and a smaller --smooth divides a face that is made of several forms.";

/// Rows that are printed; of more, the first. Entries are printed of all.
const MOST: usize = 200;

/// Powers of r.
#[derive(Clone, Debug)]
pub struct Powers(Vec<u32>);

/// Finds forms and prints them.
pub fn fit(args: &FitArgs) -> Result<Ending, Error> {
    let (nodes, warnings) = parts(&args.file, args.unit)?;
    warn(&warnings);
    let wish = Wish {
        smooth: args.smooth.0,
        powers: args.form.as_ref().map_or(Vec::new(), |powers| powers.0.clone()),
        tolerance: args.tolerance.map(|length| length.0),
    };
    let chosen: Vec<&Node> = nodes.iter().filter(|node| named(&args.node, node)).collect();
    if chosen.is_empty() {
        return Err(nothing_matches(&args.node, &nodes));
    }
    let found: Vec<Face> = chosen.into_iter().flat_map(|node| faces(node, &wish)).collect();
    tell(&table(&found));
    tell(&entries(&found));
    Ok(Ending::Done)
}

fn parts(file: &Path, unit: Option<LengthUnit>) -> Result<(Vec<Node>, Vec<Problem>), Error> {
    let is_gltf = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"));
    match (is_gltf, unit) {
        (true, unit) => parts_of_file(file, unit.unwrap_or(LengthUnit(1.0))),
        (false, None) => parts_of_system(&Document::read(file)?),
        (false, Some(_)) => Err(Error::Usage("--unit is for glTF files: a system says the unit of each".into())),
    }
}

fn nothing_matches(glob: &str, nodes: &[Node]) -> Error {
    let names: Vec<&str> = nodes.iter().map(|node| node.name.as_str()).collect();
    let hint = match did_you_mean(glob, names.iter().copied()) {
        Some(name) => format!("did you mean {name:?}?"),
        None => format!("expected one of {}", names.join(", ")),
    };
    Error::Usage(printable(&format!("--node {glob:?}: no node matches; {hint}")))
}

fn table(faces: &[Face]) -> String {
    let heading = [
        "node",
        "face",
        "triangles",
        "form",
        "radius mm",
        "conic",
        "vertex mm",
        "axis",
        "semi-diameter mm",
        "rms um",
        "max um",
        "next simpler",
    ];
    let mut table = Table::new(heading, &[1, 2, 9, 10]);
    for face in faces.iter().take(MOST) {
        table.row(row(face));
    }
    let more = faces.len().saturating_sub(MOST);
    table.text() + &if more > 0 { format!("  and {more} more; --node chooses\n") } else { String::new() }
}

fn row(face: &Face) -> [String; 12] {
    let outcome = &face.outcome;
    let fit = &outcome.fit;
    let known = |text: String| if outcome.found { text } else { "-".into() };
    // What a hundredth of the tolerance hides is nothing.
    let shown = |x: f64| if x.abs() < 0.01 * face.tolerance { 0.0 } else { x };
    let microns = |length: f64| digits(1e6 * length, 3);
    let other = if outcome.found { outcome.simpler.as_ref() } else { Some(fit) };
    [
        face.node.clone(),
        face.number.to_string(),
        face.triangles.len().to_string(),
        if outcome.found { form(fit) } else { "nothing".into() },
        known(radius(fit)),
        known(conic(fit)),
        known(millimetres(DVec3::from_array(fit.at.to_array().map(shown)))),
        known(direction(fit.axis)),
        known(face.semi_diameter().map_or("-".into(), |r| digits(1e3 * r, 7))),
        microns(fit.rms),
        microns(fit.max),
        other.map_or("-".into(), |other| format!("{}: max {} um", form(other), microns(other.max))),
    ]
}

fn form(fit: &Fit) -> String {
    let name = match fit.kind {
        Kind::Plane => "plane",
        Kind::Sphere => "sphere",
        Kind::Cylinder => "cylinder",
        Kind::Cone => "cone",
        Kind::Conic => "conic",
        Kind::Asphere => "asphere",
    };
    match &fit.shape {
        Shape::Cone { taper, .. } if fit.kind == Kind::Cone => {
            format!("{name}, {} deg", digits(taper.atan().abs().to_degrees(), 6))
        }
        _ => name.into(),
    }
}

fn radius(fit: &Fit) -> String {
    if fit.kind == Kind::Plane { "-".into() } else { measured(1e3 * fit.radius(), 1e3 * fit.errors[0]) }
}

fn conic(fit: &Fit) -> String {
    match &fit.shape {
        Shape::Conic(conic) if fit.kind == Kind::Conic => measured(conic.conic, fit.errors[1]),
        Shape::Sag { sag, .. } => measured(sag.base().conic, fit.errors[1]),
        _ => "-".into(),
    }
}

fn entries(faces: &[Face]) -> String {
    let entry = |face: &Face| {
        let entry = face.entry()?;
        Some(format!(
            "        // {}, face {}: {}\n        {}\n",
            face.node,
            face.number,
            form(&face.outcome.fit),
            entry.replace('\n', "\n        ")
        ))
    };
    let all: Vec<String> = faces.iter().filter_map(entry).collect();
    match all.is_empty() {
        true => "\nNothing to declare: flat faces are what they are, and no other form was found.\n".into(),
        false => format!("\nTo paste at the end of `surfaces`:\n\n{}", all.concat()),
    }
}

fn positive(text: &str) -> Result<Length, String> {
    let length = Length::from_text(text)?;
    if length.0 > 0.0 { Ok(length) } else { Err(format!("{text:?} is not above 0")) }
}

/// "asphere:4,6,8"
fn powers(text: &str) -> Result<Powers, String> {
    let wrong = || format!("{text:?} is no form; expected powers of r from 1 to 40, such as \"asphere:4,6,8\"");
    let list = text.strip_prefix("asphere:").ok_or_else(wrong)?;
    let mut powers: Vec<u32> =
        list.split(',').map(|power| power.trim().parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    powers.sort_unstable();
    let distinct = powers.windows(2).all(|pair| pair[0] != pair[1]);
    if distinct && powers.iter().all(|power| (1..=40).contains(power)) { Ok(Powers(powers)) } else { Err(wrong()) }
}
