//! `straylight check`: what was understood of a system.

use super::against::against;
use super::table::{Table, digits, direction, millimetres};
use super::{Chosen, Ending, optics, tell, warn};
use clap::Args;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;
use straylight::detector::{Detector, Place};
use straylight::error::Error;
use straylight::medium::absorption;
use straylight::scene::Scene;
use straylight::source::angular::Pattern;
use straylight::source::extent::{Extent, Outline};
use straylight::source::{Source, Spectrum};
use straylight::system::compile::understanding::{ANGLES, Beam, Budget, NodeFacts, Share};
use straylight::system::compile::{Understanding, understand};
use straylight::tally::results::MapKind;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct CheckArgs {
    /// System file (RON); `straylight schema` prints its grammar
    pub system: PathBuf,
    #[command(flatten)]
    pub chosen: Chosen,
    /// Older system or glTF file: tell first what changed since
    #[arg(long, value_name = "OLD")]
    pub against: Option<PathBuf>,
}

const EXAMPLE: &str = "\
Example:
  straylight check systems/triplet/system.ron

  straylight check system.ron --against old.glb

Reads everything, traces nothing: solids, which part got which surface and medium, what each surface
does with the light, whether the beams cover the scene, where the pixels are, memory. All problems of
a system are told at once, with file, line and column.";

/// Rows of a table that are printed; of more, the first.
const MOST: usize = 200;

/// Reads a system and prints what was understood.
pub fn check(args: &CheckArgs) -> Result<Ending, Error> {
    let document = args.chosen.read(&args.system)?;
    if let Some(older) = &args.against {
        tell(&against(&document, older)?);
    }
    let (compiled, facts) = understand(&document)?;
    warn(&compiled.warnings);
    let scene = &compiled.scene;
    let sections = [
        head(scene, &facts),
        parameters(&compiled.parameters),
        finishes(&compiled.finishes),
        nodes(&facts.nodes),
        media(scene),
        parts(&facts),
        budgets(&facts.budgets),
        sources(scene, &facts.beams),
        optics::section(&facts),
        detectors(scene),
        memory(&facts),
    ];
    tell(&sections.into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("\n"));
    let count = compiled.warnings.len();
    let verdict = if count == 0 { "no warnings".into() } else { format!("{count} on standard error") };
    tell(&format!("\nWarnings\n  {verdict}\n"));
    Ok(Ending::Done)
}

fn head(scene: &Scene, facts: &Understanding) -> String {
    let [low, high] = facts.bounds;
    let [x, y, z] = (1e3 * (high - low)).to_array().map(|size| digits(size, 5));
    format!(
        "{}\n  bounding box  {} .. {} mm, that is {x} x {y} x {z} mm\n  triangles     {} in {} nodes\n  ambient       {}\n",
        scene.name,
        millimetres(low),
        millimetres(high),
        scene.part_of.len(),
        facts.nodes.len(),
        scene.media[scene.ambient as usize].label,
    )
}

fn parameters(values: &BTreeMap<String, String>) -> String {
    let mut table = Table::new(["parameter", "value"], &[]);
    values.iter().take(MOST).for_each(|(name, value)| table.row([name.clone(), value.clone()]));
    if values.is_empty() { String::new() } else { section("Parameters", &table, values.len()) }
}

/// What is assumed of the finishes of the built-in library.
fn finishes(assumed: &[String]) -> String {
    let lines: String = assumed.iter().map(|line| format!("  {line}\n")).collect();
    if lines.is_empty() { lines } else { format!("Finishes of the built-in library\n{lines}") }
}

/// A title, a table and how many rows are not in it.
fn section(title: &str, table: &Table, count: usize) -> String {
    let more = count.saturating_sub(MOST);
    let more = if more > 0 { format!("  and {more} more\n") } else { String::new() };
    format!("{title}\n{}{more}", table.text())
}

fn nodes(nodes: &[NodeFacts]) -> String {
    let mut table = Table::new(["node", "triangles", "area mm2", "shape", "medium", "tags", "neighbours"], &[1, 2]);
    for node in nodes.iter().take(MOST) {
        table.row([
            node.name.clone(),
            node.triangles.to_string(),
            digits(1e6 * node.topology.area, 5),
            shape(node),
            node.medium.clone().unwrap_or_else(|| "-".into()),
            few(&node.tags),
            neighbours(node),
        ]);
    }
    section("Nodes", &table, nodes.len())
}

fn shape(node: &NodeFacts) -> String {
    let topology = &node.topology;
    let pieces = if topology.pieces > 1 { format!(", {} pieces", topology.pieces) } else { String::new() };
    let shape = match (topology.closed(), topology.inverted()) {
        (true, true) => "closed, inside out".into(),
        (true, false) => "closed".into(),
        (false, _) if topology.twisted_edges > 0 => {
            format!("{} open edges, {} twisted", topology.open_edges, topology.twisted_edges)
        }
        (false, _) => format!("{} open edges", topology.open_edges),
    };
    shape + &pieces
}

fn neighbours(node: &NodeFacts) -> String {
    let tell = |what: &str, names: &[String]| (!names.is_empty()).then(|| format!("{what} {}", few(names)));
    let all = [tell("in", &node.inside), tell("partly in", &node.partly), tell("touches", &node.touches)];
    let all: Vec<String> = all.into_iter().flatten().collect();
    if all.is_empty() { "-".into() } else { all.join("; ") }
}

/// The first three names and how many follow.
fn few(names: &[String]) -> String {
    let more = if names.len() > 3 { format!(" and {} more", names.len() - 3) } else { String::new() };
    if names.is_empty() { "-".into() } else { names[..names.len().min(3)].join(", ") + &more }
}

/// Index and absorption of every medium at the wavelengths of the sources.
fn media(scene: &Scene) -> String {
    let of = |source: &Source| match &source.spectrum {
        Spectrum::Lines(lines) => lines.iter().map(|line| line.0).collect(),
        other => other.range().to_vec(),
    };
    let mut wavelengths: Vec<f64> = scene.sources.iter().flat_map(of).collect();
    wavelengths.sort_by(f64::total_cmp);
    wavelengths.dedup();
    let heading = ["medium", "vacuum nm", "n", "k", "absorption /mm", "data nm", "from"];
    let mut table = Table::new(heading, &[1, 2, 3, 4]);
    let rows = scene.media.iter().flat_map(|filling| wavelengths.iter().map(move |wavelength| (filling, *wavelength)));
    for (filling, wavelength) in rows.clone().take(MOST) {
        let index = filling.medium.index(wavelength);
        let range =
            filling.medium.range().map(|range| range.map(|wavelength| digits(1e9 * wavelength, 6)).join(" .. "));
        table.row([
            filling.label.clone(),
            digits(1e9 * wavelength, 7),
            digits(index.re, 8),
            digits(index.im, 5),
            digits(1e-3 * absorption(index, wavelength), 5),
            range.unwrap_or_else(|| "-".into()),
            filling.medium.origin().unwrap_or("-").into(),
        ]);
    }
    section("Media", &table, rows.count())
}

fn parts(facts: &Understanding) -> String {
    let heading = ["part", "triangles", "area mm2", "front", "back", "medium in front | behind"];
    let mut table = Table::new(heading, &[1, 2]);
    for part in facts.parts.iter().take(MOST) {
        let [front, back] = part.surfaces.clone();
        let back = if back == front { "same".into() } else { back };
        let by = if part.by_default { " (default)" } else { "" };
        table.row([
            part.label.clone(),
            part.triangles.to_string(),
            digits(1e6 * part.area, 5),
            front + by,
            back,
            part.media.join(" | "),
        ]);
    }
    let default = facts.parts.iter().filter(|part| part.by_default).count();
    let rest = match default {
        0 => "  every triangle is selected by an entry of `surfaces`\n".into(),
        n => format!("  {n} parts are selected by no entry of `surfaces` and get the default\n"),
    };
    section("Parts and their surfaces", &table, facts.parts.len()) + &rest
}

fn budgets(budgets: &[Budget]) -> String {
    let mut table = Table::new(
        ["surface", "from > to", "nm", "of the light", "0 deg", "45 deg", "75 deg", "85 deg"],
        &[4, 5, 6, 7],
    );
    type Column = (&'static str, fn(&Share) -> f64);
    let rows: [Column; 5] = [
        ("specular R", |s| s.mirrored),
        ("diffuse R", |s| s.diffuse),
        ("specular T", |s| s.passed),
        ("diffuse T", |s| s.spread),
        ("absorbed", Share::absorbed),
    ];
    for budget in budgets.iter().take(MOST) {
        let mut names =
            [budget.surface.clone(), budget.media.join(" > "), digits(1e9 * budget.wavelength, 6)].into_iter();
        for (what, of) in rows {
            let values: [f64; ANGLES.len()] = budget.shares.each_ref().map(of);
            if values.iter().all(|value| value.abs() < 5e-13) {
                continue;
            }
            let [a, b, c, d] = values.map(|value| digits(if value.abs() < 5e-13 { 0.0 } else { value }, 4));
            let mut name = || names.next().unwrap_or_default();
            table.row([name(), name(), name(), what.into(), a, b, c, d]);
        }
    }
    section("Where light goes, by angle of incidence", &table, budgets.len())
}

fn sources(scene: &Scene, beams: &[Beam]) -> String {
    let mut text = String::from("Sources\n");
    for (source, beam) in scene.sources.iter().zip(beams).take(MOST) {
        let covers = beam.covers.map_or(String::new(), |part| match part {
            part if part > 0.9995 => "covers the whole scene as seen along the beam; ".into(),
            part => format!("covers {} % of the scene as seen along the beam; ", digits(100.0 * part, 3)),
        });
        text.push_str(&format!("  {}\n    flux      {} W\n", source.label, digits(source.flux, 6)));
        text.push_str(&format!("    from      {}\n", extent(scene, source)));
        text.push_str(&format!("    towards   {}\n    light     {}\n", towards(source), spectrum(&source.spectrum)));
        text.push_str(&format!(
            "    reach     {covers}{} % of its rays meet something\n",
            digits(100.0 * beam.meets, 3)
        ));
    }
    text
}

fn extent(scene: &Scene, source: &Source) -> String {
    let mm = |length: f64| digits(1e3 * length, 6);
    match &source.extent {
        Extent::Mesh(mesh) => {
            format!("{} sides of triangles, {} mm2", mesh.triangles.len(), digits(1e6 * source.extent.area(), 5))
        }
        Extent::Flat { at, outline, frame } => {
            let shape = match *outline {
                Outline::Point => "a point".into(),
                Outline::Disk { radius } => format!("a disc of radius {} mm", mm(radius)),
                Outline::Annulus { inner, outer } => format!("a ring of radii {} and {} mm", mm(inner), mm(outer)),
                Outline::Polygon { radius, sides } => format!("a polygon of {sides} sides, radius {} mm", mm(radius)),
                Outline::Rectangle { width, height } => format!("a rectangle of {} x {} mm", mm(width), mm(height)),
                Outline::Gaussian { waist } => format!("a Gaussian of 1/e2 radius {} mm", mm(waist)),
            };
            format!("{shape} at {} mm, normal {}", millimetres(*at + scene.shift), direction(frame.z))
        }
    }
}

fn towards(source: &Source) -> String {
    let degrees = |angle: f64| digits(angle.to_degrees(), 5);
    let axis = match source.angular.frame() {
        Some(frame) => direction(frame.z),
        None => "the normal of each triangle".into(),
    };
    match source.angular.pattern {
        Pattern::Collimated => axis,
        Pattern::Cone { half_angle } => {
            format!("a cone of {} deg about {axis}, constant intensity", degrees(half_angle))
        }
        Pattern::Radiance { half_angle } if half_angle >= FRAC_PI_2 => format!("Lambertian about {axis}"),
        Pattern::Radiance { half_angle } => format!("constant radiance within {} deg of {axis}", degrees(half_angle)),
        Pattern::Ring { inner, outer } => {
            format!("constant radiance between {} and {} deg of {axis}", degrees(inner), degrees(outer))
        }
        Pattern::Gaussian { half_angle } => {
            format!("a Gaussian of 1/e2 half-angle {} deg about {axis}", degrees(half_angle))
        }
    }
}

fn spectrum(spectrum: &Spectrum) -> String {
    let [from, to] = spectrum.range().map(|wavelength| digits(1e9 * wavelength, 7));
    match spectrum {
        Spectrum::Line(_) => format!("{from} nm"),
        Spectrum::Lines(lines) => format!("{} lines from {from} to {to} nm", lines.len()),
        Spectrum::Table(_) => format!("{from} to {to} nm"),
    }
}

fn detectors(scene: &Scene) -> String {
    let mut text = String::from("Detectors\n");
    for detector in scene.detectors.iter().take(MOST) {
        let place = match &detector.place {
            Place::Parts => {
                let watching = scene.parts.iter().filter(|part| {
                    part.detectors.iter().any(|&index| std::ptr::eq(&scene.detectors[index as usize], detector))
                });
                format!("on {}", few(&watching.map(|part| part.label.clone()).collect::<Vec<_>>()))
            }
            Place::Window(window) => {
                let centre = millimetres(window.centre + scene.shift);
                format!("a window at {centre} mm, normal {}", direction(window.frame.z))
            }
            Place::FarField => "at infinity".into(),
        };
        let side = detector.side.label();
        text.push_str(&format!("  {}\n    place     {place}; side: {side}\n{}", detector.label, grid(scene, detector)));
    }
    text
}

fn grid(scene: &Scene, detector: &Detector) -> String {
    let grid = &detector.grid;
    let ([rows, columns], frame) = (grid.shape(), grid.frame());
    let total: f64 = (0..rows * columns).map(|bin| grid.extent(bin)).sum();
    let steps = grid.axes().map(|axes| axes.map(|axis| axis.step));
    match (grid.kind(), steps) {
        (MapKind::Plane, Some([x, y])) => format!(
            "    pixels    {columns} columns x {rows} rows of {} x {} um, area {} mm2\n    axes      pixel (row 0, column 0) at {} mm; columns along {}, rows along {}\n",
            digits(1e6 * x, 5),
            digits(1e6 * y, 5),
            digits(1e6 * total, 6),
            millimetres(grid.origin() + scene.shift),
            direction(frame.x),
            direction(frame.y),
        ),
        (MapKind::Triangles, _) | (_, None) => {
            format!("    bins      {} triangles, area {} mm2\n", rows * columns, digits(1e6 * total, 6))
        }
        (_, Some(_)) => format!(
            "    bins      {columns} sectors x {rows} rings, {} sr\n    axes      theta from the direction of flight {}; phi from {} towards {}\n",
            digits(total, 6),
            direction(frame.z),
            direction(frame.x),
            direction(frame.y),
        ),
    }
}

fn memory(facts: &Understanding) -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let memory = &facts.memory;
    let all = memory.geometry + threads * memory.thread + memory.batches;
    let mib = |bytes: usize| format!("{} MiB", digits(bytes as f64 / (1 << 20) as f64, 3));
    format!(
        "Memory\n  geometry {}, tallies {} x {threads} threads, finished batches {}: about {}\n",
        mib(memory.geometry),
        mib(memory.thread),
        mib(memory.batches),
        mib(all)
    )
}
