//! `straylight ray`: one packet of 1 W and everything that happens to it, by the tracer that runs use.

use super::table::{Table, digits, direction, millimetres};
use super::{Chosen, Ending, load, tell};
use clap::Args;
use glam::DVec3;
use std::path::PathBuf;
use straylight::error::Error;
use straylight::geometry::{Frame, Left, Ray};
use straylight::math::Rng;
use straylight::optics::Stokes;
use straylight::packet::{Ancestry, Packet};
use straylight::scene::Scene;
use straylight::settings::Settings;
use straylight::system::units::{Angle, Direction, FromText, Position, Wavelength};
use straylight::tally::layout::Cut;
use straylight::tally::{Layout, Live, Sums};
use straylight::transport::book::Book;
use straylight::transport::importance::Importance;
use straylight::transport::paths::Rows;
use straylight::transport::walk::Walk;
use straylight::transport::watch::{Sight, Watch};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct RayArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Where it starts, in the world: "(0, 0, -20) mm"
    #[arg(long, value_name = "POINT", value_parser = text::<Position>)]
    pub from: Position,
    /// Where it flies to: "(0, 0, 1)"
    #[arg(long, value_name = "DIRECTION", value_parser = text::<Direction>)]
    pub direction: Direction,
    /// Vacuum wavelength, such as "550 nm"; else that of the first source
    #[arg(long, value_parser = text::<Wavelength>)]
    pub wavelength: Option<Wavelength>,
    /// Linear polarisation at this angle from x about the ray, such as "45 deg"
    #[arg(long, value_name = "ANGLE", value_parser = text::<Angle>)]
    pub polarization: Option<Angle>,
    /// Reflections up to which both branches are followed; then one is drawn
    #[arg(long, value_name = "N")]
    pub splits: Option<u16>,
    /// Seed of what is drawn
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight ray systems/slab/system.ron --from \"(0, 0, -20) mm\" --direction \"(0, 0, 1)\"

Each row is an event: what the light has done so far (R reflected, T transmitted, S scattered), where it
is and on which side of which part, and which fractions of the arriving flux are reflected, transmitted,
scattered and absorbed there. Branches are followed one after the other, the last one first.";

/// Rows that are printed; of more, the first.
const MOST: usize = 1000;
/// Flights to the next event after which a packet is cut: a table is for people.
const MOST_EVENTS: u32 = 10_000;

fn text<T: FromText>(written: &str) -> Result<T, String> {
    T::from_text(written)
}

/// Traces it.
pub fn ray(args: &RayArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.chosen)?;
    let scene = &compiled.scene;
    let settings = Settings {
        splits: args.splits.unwrap_or(compiled.settings.splits),
        seed: args.seed.unwrap_or(compiled.settings.seed),
        max_events: compiled.settings.max_events.min(MOST_EVENTS),
        ..compiled.settings.clone()
    };
    let layout = scene.layout(0);
    let rows = Rows::default();
    let book = Book::<1>::new(&layout, Live::new(layout.len()), Some(&rows));
    let log = Log { rows: Vec::new(), more: 0, way: String::new() };
    let mut packet = packet(args, scene, &settings);
    tell(&start(&packet, scene));
    let importance = Importance::declared(scene);
    let mut walk = Walk::new(scene, &settings, &importance, book, log);
    walk.history(&mut packet);
    let sums = walk.book.finish();
    tell(&table(&walk.watch, scene));
    tell(&balance(scene, &layout, &sums));
    Ok(Ending::Done)
}

fn packet(args: &RayArgs, scene: &Scene, settings: &Settings) -> Packet<1> {
    let range = scene.sources.first().map_or([550e-9; 2], |source| source.spectrum.range());
    let direction = args.direction.0;
    let origin = args.from.0 - scene.shift;
    Packet {
        ray: Ray { origin, direction },
        light: [args.polarization.map_or(Stokes::unpolarised(1.0), |angle| Stokes::linear(1.0, angle.0))],
        transverse: Frame::from_z_x(direction, DVec3::X).x,
        wavelength: args.wavelength.map_or(0.5 * (range[0] + range[1]), |wavelength| wavelength.0),
        solids: scene.solids_at(origin),
        left: Left::nothing(),
        film: None,
        rng: Rng::new(settings.seed, 0, 0),
        level: 0.0,
        ancestry: Ancestry::born(0, 0),
    }
}

fn start(packet: &Packet<1>, scene: &Scene) -> String {
    let medium = &scene.media[scene.medium_in(&packet.solids) as usize].label;
    format!(
        "1 W of {} nm from {} mm towards {}, in {medium}\n\n",
        digits(1e9 * packet.wavelength, 6),
        millimetres(packet.ray.origin + scene.shift),
        direction(packet.ray.direction),
    )
}

/// What was seen, in the order in which it happened.
struct Log {
    rows: Vec<(String, Seen)>,
    /// Rows that were not kept.
    more: usize,
    /// What the packet in hand has done so far: "TRT".
    way: String,
}

enum Seen {
    Event(Sight),
    /// Scattered in a medium: on the way it came, flux.
    Bulk(Ray, u16, f64),
    Escape(Ray, f64),
}

impl Log {
    fn push(&mut self, seen: impl FnOnce() -> Seen) {
        if self.rows.len() < MOST {
            self.rows.push((self.way.clone(), seen()));
        } else {
            self.more += 1;
        }
    }
}

impl Watch for Log {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        let letters: String = ancestry.steps.iter().map(|step| step.event().letter()).collect();
        let longer = !ancestry.is_spelled();
        self.way = if longer { format!("{letters}..") } else { letters };
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        self.push(|| Seen::Event(sight()));
    }

    fn scattered(&mut self, ray: &Ray, medium: u16, flux: f64) {
        self.push(|| Seen::Bulk(*ray, medium, flux));
    }

    fn escaped(&mut self, ray: Ray, flux: f64) {
        self.push(|| Seen::Escape(ray, flux));
    }
}

fn table(log: &Log, scene: &Scene) -> String {
    let heading = [
        "depth",
        "so far",
        "point mm",
        "part",
        "side",
        "medium",
        "angle deg",
        "flux W",
        "R",
        "T",
        "scattered",
        "absorbed",
        "R goes to",
        "T or escape goes to",
    ];
    let mut table = Table::new(heading, &[0, 6, 7, 8, 9, 10, 11]);
    for (way, seen) in &log.rows {
        let way = if way.is_empty() { "-".into() } else { way.clone() };
        match seen {
            Seen::Event(sight) => table.row(event(sight, way, scene)),
            Seen::Bulk(ray, medium, flux) => {
                let mut cells = [const { String::new() }; 14];
                cells[1] = way;
                cells[2] = millimetres(ray.origin + scene.shift);
                cells[3] = "is scattered".into();
                cells[5] = scene.media[*medium as usize].label.clone();
                cells[7] = digits(*flux, 5);
                table.row(cells);
            }
            Seen::Escape(ray, flux) => {
                let mut cells = [const { String::new() }; 14];
                cells[1] = way;
                cells[2] = millimetres(ray.origin + scene.shift);
                cells[3] = "escapes".into();
                cells[13] = direction(ray.direction);
                cells[7] = digits(*flux, 5);
                table.row(cells);
            }
        }
    }
    let more = if log.more > 0 { format!("  and {} more rows\n", log.more) } else { String::new() };
    table.text() + &more
}

fn event(sight: &Sight, way: String, scene: &Scene) -> [String; 14] {
    let [before, after] = sight.media.map(|medium| scene.media[medium as usize].label.as_str());
    let [r, t, scattered, absorbed] = sight.fractions.map(|f| digits(if f.abs() < 5e-13 { 0.0 } else { f }, 5));
    // A branch that carries nothing goes nowhere.
    let leaves = |i: usize| match sight.leaves[i] {
        Some(unit) if sight.fractions[i] > 0.0 => direction(unit),
        _ => "-".into(),
    };
    [
        sight.depth.to_string(),
        way,
        millimetres(sight.point + scene.shift),
        scene.parts[sight.part as usize].label.clone(),
        if sight.front { "front".into() } else { "back".into() },
        format!("{before} > {after}"),
        digits(sight.angle.to_degrees(), 6),
        digits(sight.flux, 5),
        r,
        t,
        scattered,
        absorbed,
        leaves(0),
        leaves(1),
    ]
}

/// Where the watt went, and who saw it.
fn balance(scene: &Scene, layout: &Layout, sums: &Sums<1>) -> String {
    let flux = |slot: usize| sums.estimate(slot, 0).mean;
    let lines = [
        ("absorbed", flux(Layout::ABSORBED)),
        ("escaped", flux(Layout::ESCAPED)),
        ("cut by roulette (net)", flux(layout.cut(Cut::Roulette))),
        ("cut by limits", flux(Layout::TERMINATED) - flux(layout.cut(Cut::Roulette))),
        ("lost", flux(Layout::LOST)),
        ("not accounted for: scatter drawn, not integrated", flux(Layout::RESIDUAL)),
    ];
    let mut table = Table::new(["where it went", "W"], &[1]);
    let kept = lines.into_iter().filter(|(_, watts)| watts.abs() > 1e-12);
    kept.for_each(|(what, watts)| table.row([what.into(), digits(watts, 6)]));
    for (index, detector) in scene.detectors.iter().enumerate() {
        table.row([format!("seen by {}", detector.label), digits(flux(layout.detector(index)), 6)]);
    }
    format!("\n{}", table.text())
}
