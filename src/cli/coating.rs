//! `straylight coating`: what a coating reflects, transmits and absorbs, over wavelength and angle, from both sides.

use super::table::{Table, digits};
use super::{Chosen, Ending, tell, warn};
use clap::Args;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use straylight::coating::Side;
use straylight::coating::response::{Response, mean};
use straylight::error::Error;
use straylight::report::{self, Ink, Line, Panel, Span, Stroke};
use straylight::system::compile::{Coated, coated};
use straylight::system::units::{Angle, FromText, Wavelength};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct CoatingArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// A name in its `coatings`
    pub name: String,
    /// Media in front and behind [default: those of the first face that has the coating]
    #[arg(long, num_args = 2, value_names = ["FRONT", "BACK"])]
    pub between: Option<Vec<String>>,
    /// Vacuum wavelength of what is shown over the angle [default: the middle of the sources' light]
    #[arg(long, value_parser = Wavelength::from_text)]
    pub wavelength: Option<Wavelength>,
    /// Angle of incidence of what is shown over the wavelength, on the side of the light
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", value_parser = Angle::from_text)]
    pub angle: Angle,
    /// Write curves (.png) or numbers (.csv) to a file; may be repeated
    #[arg(short, long, value_name = "FILE")]
    pub out: Vec<PathBuf>,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight coating system.ron ar -o ar.png -o ar.csv

R, T and A (absorbed) of s and p light and of their mean, met from the front of the face (the outside of a solid)
and from its back. Angles are those in the medium on the side of the light.";

/// Points of a curve.
const POINTS: u32 = 400;
/// Grazing incidence is shown up to here, deg.
const GRAZING: f64 = 89.9;
/// Without a band of its own, light is shown from and to these multiples of its wavelength.
const AROUND: [f64; 2] = [0.7, 1.4];

/// What is shown.
struct Survey<'a> {
    name: &'a str,
    coated: Coated,
    /// m
    wavelength: f64,
    /// m
    band: [f64; 2],
    /// rad
    angle: f64,
}

/// Shows it.
pub fn coating(args: &CoatingArgs) -> Result<Ending, Error> {
    if !(0.0..90.0).contains(&args.angle.0.to_degrees()) {
        return Err(Error::Usage("--angle is from 0 deg to below 90 deg".into()));
    }
    let between = args.between.as_ref().map(|names| [names[0].clone(), names[1].clone()]);
    let coated = coated(&args.chosen.read(&args.system)?, &args.name, between.as_ref())?;
    warn(&coated.warnings);
    let wavelength = args.wavelength.map_or(0.5 * (coated.light[0] + coated.light[1]), |wavelength| wavelength.0);
    if coated.range.is_some_and(|[low, high]| wavelength < low * (1.0 - 1e-6) || wavelength > high * (1.0 + 1e-6)) {
        return Err(Error::Usage(format!(
            "the data of {:?} do not cover {} nm",
            args.name,
            digits(1e9 * wavelength, 6)
        )));
    }
    let band = band(&coated, wavelength);
    let survey = Survey { name: &args.name, coated, wavelength, band, angle: args.angle.0 };
    tell(&survey.table());
    args.out.iter().try_for_each(|file| survey.write(file))?;
    Ok(Ending::Done)
}

/// Wavelengths (m) that are shown: those of the sources, or around a line, as far as the data reach.
fn band(coated: &Coated, wavelength: f64) -> [f64; 2] {
    let wide = coated.light[0] < coated.light[1];
    let [from, to] = if wide { coated.light } else { AROUND.map(|factor| factor * wavelength) };
    let [low, high] = coated.range.unwrap_or([0.0, f64::INFINITY]);
    [from.max(low), to.min(high)]
}

impl Survey<'_> {
    fn response(&self, side: Side, wavelength: f64, theta: f64) -> Response {
        let [front, back] = self.coated.index(wavelength);
        let [ahead, behind] = &self.coated.faces;
        match side {
            Side::Front => Response::of(ahead.as_ref(), [front, back], wavelength, theta),
            Side::Back => Response::of(behind.as_ref(), [back, front], wavelength, theta),
        }
    }

    fn heading(&self) -> String {
        let [front, back] = &self.coated.names;
        format!("{}: {front} in front, {back} behind", self.name)
    }

    fn table(&self) -> String {
        let mut text = format!("{}, {} nm\n", self.heading(), digits(1e9 * self.wavelength, 6));
        let mut table = Table::new(
            ["from the", "deg", "R s", "R p", "R", "T s", "T p", "T", "A s", "A p", "A"],
            &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10],
        );
        for (side, name) in [(Side::Front, "front"), (Side::Back, "back")] {
            for degrees in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0f64] {
                let found = self.response(side, self.wavelength, degrees.to_radians());
                let [r, t, a] =
                    [found.reflected, found.transmitted, found.absorbed()].map(|[s, p]| [s, p, mean([s, p])]);
                // What is absorbed is a difference from 1: its rounding is not shown.
                let shown = |x: f64| if x.abs() < 1e-9 { "0".to_owned() } else { digits(x, 5) };
                let [[r0, r1, r2], [t0, t1, t2], [a0, a1, a2]] = [r, t, a].map(|shares| shares.map(shown));
                table.row([name.into(), digits(degrees, 3), r0, r1, r2, t0, t1, t2, a0, a1, a2]);
            }
        }
        let _ = write!(text, "{}", table.text());
        text
    }

    fn write(&self, file: &Path) -> Result<(), Error> {
        let failed = |source| Error::Io { path: file.into(), source };
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let bytes = match ending.as_deref() {
            Some("png") => self.png().map_err(failed)?,
            Some("csv") => self.csv().into_bytes(),
            _ => return Err(Error::Usage(format!("{} ends neither in .png nor in .csv", file.display()))),
        };
        report::create(file, |out| out.write_all(&bytes)).map_err(failed)
    }

    /// Every point of the curves.
    fn csv(&self) -> String {
        let mut text = String::from("side,wavelength_nm,angle_deg,rs,rp,ts,tp,as,ap\n");
        for (side, name) in [(Side::Front, "front"), (Side::Back, "back")] {
            let over_wavelength = self.wavelengths().map(|wavelength| (wavelength, self.angle));
            let over_angle = self.angles().map(|degrees| (self.wavelength, degrees.to_radians()));
            for (wavelength, theta) in over_wavelength.chain(over_angle) {
                let found = self.response(side, wavelength, theta);
                let ([rs, rp], [ts, tp], [a, b]) = (found.reflected, found.transmitted, found.absorbed());
                let (nm, degrees) = (wavelength * 1e9, theta.to_degrees());
                let _ = writeln!(text, "{name},{nm},{degrees},{rs},{rp},{ts},{tp},{a},{b}");
            }
        }
        text
    }

    fn wavelengths(&self) -> impl Iterator<Item = f64> + '_ {
        let [from, to] = self.band;
        (0..=POINTS).map(move |i| from + (to - from) * f64::from(i) / f64::from(POINTS))
    }

    fn angles(&self) -> impl Iterator<Item = f64> {
        (0..=POINTS).map(|i| GRAZING * f64::from(i) / f64::from(POINTS))
    }

    fn png(&self) -> std::io::Result<Vec<u8>> {
        let legend = [
            (Ink::Red, Stroke::Bold, "R mean"),
            (Ink::Blue, Stroke::Bold, "T mean"),
            (Ink::Grey, Stroke::Bold, "A mean"),
            (Ink::Red, Stroke::Thin, "s"),
            (Ink::Red, Stroke::Dashed, "p"),
        ];
        let sides = [(Side::Front, "front"), (Side::Back, "back")];
        let panels = sides.map(|(side, name)| [self.over_wavelength(side, name), self.over_angle(side, name)]);
        report::curves(&self.heading(), &legend, &panels.concat())
    }

    fn over_wavelength(&self, side: Side, name: &str) -> Panel {
        let points = self.wavelengths().map(|w| (1e9 * w, self.response(side, w, self.angle))).collect();
        let title = format!("from the {name}, {} deg", digits(self.angle.to_degrees(), 4));
        panel(
            title,
            Span { name: "vacuum wavelength".into(), unit: "nm", from: 1e9 * self.band[0], to: 1e9 * self.band[1] },
            points,
        )
    }

    fn over_angle(&self, side: Side, name: &str) -> Panel {
        let points = self.angles().map(|d| (d, self.response(side, self.wavelength, d.to_radians()))).collect();
        let title = format!("from the {name}, {} nm", digits(1e9 * self.wavelength, 6));
        panel(title, Span { name: "angle of incidence".into(), unit: "deg", from: 0.0, to: 90.0 }, points)
    }
}

/// R, T or A of s and p.
type Share = fn(&Response) -> [f64; 2];

fn panel(title: String, x: Span, points: Vec<(f64, Response)>) -> Panel {
    let shares: [(Ink, Share); 3] =
        [(Ink::Grey, Response::absorbed), (Ink::Blue, |r| r.transmitted), (Ink::Red, |r| r.reflected)];
    let curves = shares.into_iter().flat_map(|(ink, share)| {
        let of = |pick: fn([f64; 2]) -> f64| points.iter().map(|(x, r)| [*x, pick(share(r))]).collect();
        [
            Line { points: of(|[s, _]| s), ink, stroke: Stroke::Thin },
            Line { points: of(|[_, p]| p), ink, stroke: Stroke::Dashed },
            Line { points: of(mean), ink, stroke: Stroke::Bold },
        ]
    });
    Panel { title, x, curves: curves.collect() }
}
