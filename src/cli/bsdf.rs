//! `straylight bsdf`: what a scatter model does, as numbers and curves.

use super::table::{Table, digits};
use super::{Chosen, Ending, tell, warn};
use clap::Args;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::Write;
use std::path::{Path, PathBuf};
use straylight::error::Error;
use straylight::optics::refraction::reflect;
use straylight::report::{self, Curve, Division, Ruler, chart, polar};
use straylight::system::compile::{Scatterer, scatterer};
use straylight::system::units::{Angle, FromText, Wavelength};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct BsdfArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Name of a model in its `scatter` section
    pub name: String,
    #[command(flatten)]
    pub chosen: Chosen,
    /// Vacuum wavelength
    #[arg(long, value_name = "WAVELENGTH", default_value = "550 nm", value_parser = Wavelength::from_text)]
    pub wavelength: Wavelength,
    /// Angle of incidence; may be repeated [default: 0, 30, 60 and 85 deg]
    #[arg(long, value_name = "ANGLE", value_parser = incidence)]
    pub incidence: Vec<Angle>,
    /// Medium that light comes from [default: the system's ambient]
    #[arg(long, value_name = "MEDIUM")]
    pub here: Option<String>,
    /// Medium beyond the surface [default: the system's ambient]
    #[arg(long, value_name = "MEDIUM")]
    pub beyond: Option<String>,
    /// Folder for the curves and their numbers [default: none are written]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

const EXAMPLE: &str = "\
Example:
  straylight bsdf systems/triplet/system.ron wall -o wall
  straylight bsdf system.ron ground --beyond N-BK7 --incidence \"45 deg\"

The model by itself, without the coating of a surface: BSDF in the plane of incidence against |beta - beta0|, against
angle and around the point, TIS against angle of incidence. On the terminal the TIS, and of polished surfaces the rms
height that scatters at this wavelength; in the folder bsdf_beta.png, bsdf_angle.png, bsdf_polar.png and tis.png with
bsdf.csv and tis.csv. Angles are in the medium they are in; those of scatter are positive beyond the normal, where the
specular ray goes.";

/// Angles of incidence of the table on the terminal, deg.
const ROWS: [f64; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0, 89.0];

/// Points of a curve.
const POINTS: u32 = 600;

/// Nearest |beta - beta0| that is shown.
const NEAREST: f64 = 1e-6;

/// The two sides of a surface.
const SIDES: [(&str, f64); 2] = [("reflected", 1.0), ("transmitted", -1.0)];

/// Prints and draws a scatter model.
pub fn bsdf(args: &BsdfArgs) -> Result<Ending, Error> {
    let document = args.chosen.read(&args.system)?;
    let media = [args.here.as_deref(), args.beyond.as_deref()];
    let (model, warnings) = scatterer(&document, &args.name, media, args.wavelength.0)?;
    warn(&warnings);
    tell(&summary(&args.name, &model));
    if let Some(folder) = &args.output {
        write(folder, args, &model)?;
    }
    Ok(Ending::Done)
}

fn incidence(text: &str) -> Result<Angle, String> {
    let angle = Angle::from_text(text)?;
    if (0.0..FRAC_PI_2).contains(&angle.0) { Ok(angle) } else { Err(format!("{text:?} is not from 0 to below 90 deg")) }
}

fn summary(name: &str, model: &Scatterer) -> String {
    let mut table =
        Table::new(["incidence deg", "TIS reflected", "TIS transmitted", "at the reflected ray, 1/sr"], &[0, 1, 2, 3]);
    for degrees in ROWS {
        let at = model.arrival(degrees.to_radians());
        let [back, through] = model.tis(&at);
        let peak = digits(model.value(&at, reflect(at.wi)), 6);
        table.row([digits(degrees, 4), digits(back, 6), digits(through, 6), peak]);
    }
    let indices = model.index.map(|n| digits(n.re, 7)).join(" > ");
    let rms = model
        .rms
        .map_or(String::new(), |rms| format!("  rms height   {} nm over 0 .. 1/wavelength\n", digits(1e9 * rms, 5)));
    let particles = model.particles.as_ref().map_or(String::new(), |deposit| {
        format!(
            "  particles    cover {} %, take {} % of the light that crosses them; here they lie on a perfect mirror\n",
            digits(100.0 * deposit.coverage, 4),
            digits(100.0 * deposit.extinction(model.wavelength), 4)
        )
    });
    format!(
        "{name}\n  wavelength   {} nm\n  index        {indices}\n{rms}{particles}{}",
        digits(1e9 * model.wavelength, 7),
        table.text()
    )
}

/// One direction of the plane of incidence and the BSDF there.
struct Point {
    /// rad
    incidence: f64,
    /// Index of [`SIDES`].
    side: usize,
    /// rad, > 0 beyond the normal.
    scatter: f64,
    /// |beta - beta0|, negative away from the source.
    distance: f64,
    /// 1/sr
    value: f64,
}

impl Point {
    /// Angle from the normal on the side of the light, rad, > 0 where the specular ray goes.
    fn polar_angle(&self) -> f64 {
        if self.side == 0 { self.scatter } else { PI - self.scatter }
    }
}

fn write(folder: &Path, args: &BsdfArgs, model: &Scatterer) -> Result<(), Error> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| Error::Io { path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let angles = match args.incidence.as_slice() {
        [] => [0.0f64, 30.0, 60.0, 85.0].map(f64::to_radians).to_vec(),
        some => some.iter().map(|angle| angle.0).collect(),
    };
    let points: Vec<Point> = angles.iter().flat_map(|&angle| plane(model, angle)).collect();
    let save = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        report::create(&path, |out| out.write_all(bytes)).map_err(failed(&path))
    };
    let at = format!("{}, {} nm", args.name, digits(1e9 * model.wavelength, 7));
    let draw = |rulers, curves: &[Curve]| chart(&at, rulers, curves).map_err(failed(folder));
    let decades = |label| Ruler { label, division: Division::Decades };
    let linear = |label| Ruler { label, division: Division::Linear };
    let towards = curves(&points, &angles, |p| (p.distance > 0.0).then_some([p.distance, p.value]));
    save("bsdf_beta.png", &draw([decades("|beta - beta0|, towards the source"), decades("BSDF, 1/sr")], &towards)?)?;
    let angle = curves(&points, &angles, |p| Some([p.scatter.to_degrees(), p.value]));
    save("bsdf_angle.png", &draw([linear("angle of scatter, deg"), decades("BSDF, 1/sr")], &angle)?)?;
    let around = curves(&points, &angles, |p| Some([p.polar_angle(), p.value]));
    save("bsdf_polar.png", &polar(&at, "BSDF, 1/sr", &around).map_err(failed(folder))?)?;
    let tis = tis_curves(model);
    save("tis.png", &draw([linear("angle of incidence, deg"), linear("TIS")], &tis)?)?;
    save("bsdf.csv", rows(&points).as_bytes())?;
    save("tis.csv", tis_rows(model).as_bytes())?;
    tell(&format!("{}: bsdf_beta.png, bsdf_angle.png, bsdf_polar.png, tis.png, bsdf.csv, tis.csv\n", folder.display()));
    Ok(())
}

/// Directions in the plane of incidence on the sides that the model scatters to: even in the logarithm of the distance to beta0, on both sides of it.
fn plane(model: &Scatterer, incidence: f64) -> Vec<Point> {
    let at = model.arrival(incidence);
    let mut points = Vec::new();
    for (side, (_, sign)) in SIDES.iter().enumerate().filter(|(side, _)| model.reaches(*side == 1)) {
        let n = model.index[side].re;
        let specular = incidence.sin() * model.index[0].re / n;
        let add = |points: &mut Vec<Point>, distance: f64| {
            let beta = specular - distance;
            if beta.abs() < 1.0 {
                let wo = DVec3::new(-beta, 0.0, sign * ((1.0 - beta) * (1.0 + beta)).sqrt());
                let value = model.value(&at, wo);
                points.push(Point { incidence, side, scatter: beta.asin(), distance, value });
            }
        };
        let distance = |k: u32| NEAREST * (2.0 / NEAREST).powf(f64::from(k) / f64::from(POINTS));
        (0..=POINTS).rev().for_each(|k| add(&mut points, distance(k)));
        (0..=POINTS).for_each(|k| add(&mut points, -distance(k)));
    }
    points
}

/// A curve for each incidence and side, of the points that `at` shows.
fn curves(points: &[Point], angles: &[f64], at: impl Fn(&Point) -> Option<[f64; 2]>) -> Vec<Curve> {
    let both = SIDES.iter().enumerate().flat_map(|side| angles.iter().map(move |angle| (side, *angle)));
    let curve = |((side, (name, _)), angle): ((usize, &(&str, f64)), f64)| {
        let own = points.iter().filter(|point| point.side == side && point.incidence == angle);
        let points: Vec<[f64; 2]> = own.filter_map(&at).collect();
        let label = format!("{} deg, {name}", digits(angle.to_degrees(), 4));
        (!points.is_empty()).then_some(Curve { label, points })
    };
    both.filter_map(curve).collect()
}

/// Angles of incidence of the curves of TIS, rad, crowding towards grazing.
fn incidences() -> impl Iterator<Item = f64> {
    (0..=200).map(|k| FRAC_PI_2 * (1.0 - 1e-4) * (FRAC_PI_2 * f64::from(k) / 200.0).sin())
}

fn tis_curves(model: &Scatterer) -> Vec<Curve> {
    let curve = |(side, (name, _)): (usize, &(&str, f64))| {
        let points = incidences().map(|theta| [theta.to_degrees(), model.tis(&model.arrival(theta))[side]]).collect();
        model.reaches(side == 1).then(|| Curve { label: (*name).into(), points })
    };
    SIDES.iter().enumerate().filter_map(curve).collect()
}

fn rows(points: &[Point]) -> String {
    let row = |p: &Point| {
        let angles = [p.incidence, p.scatter].map(f64::to_degrees);
        format!("{:e},{},{:e},{:e},{:e}\n", angles[0], SIDES[p.side].0, angles[1], p.distance, p.value)
    };
    let heading = "incidence_deg,side,scatter_deg,beta0_minus_beta,bsdf_per_sr\n";
    heading.to_owned() + &points.iter().map(row).collect::<String>()
}

fn tis_rows(model: &Scatterer) -> String {
    let row = |theta: f64| {
        let [back, through] = model.tis(&model.arrival(theta));
        format!("{:e},{back:e},{through:e}\n", theta.to_degrees())
    };
    "incidence_deg,tis_reflected,tis_transmitted\n".to_owned() + &incidences().map(row).collect::<String>()
}
