//! `straylight fit-bsdf`: laws through a measured table of scatter.

use super::table::{Table, digits};
use super::{Ending, say, tell};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use straylight::bsdf::Side;
use straylight::bsdf::fit::{Fit, Law, Point, fit, points};
use straylight::bsdf::reading::{self, Unmeasured};
use straylight::bsdf::tabulated;
use straylight::error::{Error, Problem, Span};
use straylight::report::{self, Curve, Division, Ruler, chart, measured};
use straylight::system::units::{FromText, Wavelength};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct FitBsdfArgs {
    /// Table of scatter: Speos .anisotropicbsdf, Zemax .bsdf, FRED or CSV, as text
    pub table: PathBuf,
    /// Vacuum wavelength of the measurement: fits a K-correlation, too
    #[arg(long, value_name = "WAVELENGTH", value_parser = Wavelength::from_text)]
    pub wavelength: Option<Wavelength>,
    /// Picture (.png) or numbers (.csv) of table and fits; may be repeated
    #[arg(short, long, value_name = "FILE", value_parser = output)]
    pub output: Vec<PathBuf>,
}

const EXAMPLE: &str = "\
Example:
  straylight fit-bsdf anodize.bsdf
  straylight fit-bsdf mirror.csv --wavelength \"633 nm\" -o mirror.png -o mirror.csv

ABg, Harvey-Shack and, with a wavelength, K-correlation, each with a Lambertian floor, through all incidences and directions
at once: coefficients +- one standard error, residuals in dB (10 log10), the TIS of each law against that of the table, and the
entries to paste into `scatter`. A law holds where there is data; one with residuals of more than 1 dB is a summary of the
table, not a substitute: use the table.";

/// One dB in natural logarithms.
const DECIBEL: f64 = 0.230_258_509_299_404_57;

fn output(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match extension(&path).as_str() {
        "png" | "csv" => Ok(path),
        _ => Err("expected a name that ends in .png or .csv".into()),
    }
}

fn extension(path: &Path) -> String {
    path.extension().map_or(String::new(), |end| end.to_string_lossy().to_lowercase())
}

/// Fits and prints.
pub fn fit_bsdf(args: &FitBsdfArgs) -> Result<Ending, Error> {
    let bytes = std::fs::read(&args.table)
        .map_err(|e| Error::Missing(vec![Problem::error(format!("cannot be read: {e}")).in_file(&args.table)]))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let [zero, held] = [Unmeasured::Zero, Unmeasured::Hold].map(|rule| read(&text, rule, &args.table));
    let (table, held) = (zero?, held?);
    let points = points(&table, factor(&table));
    if table.is_transmitted() && args.wavelength.is_some() {
        return Err(Error::Usage("--wavelength: a K-correlation is fitted to reflected light only".into()));
    }
    let fits: Vec<Fit> = laws(&points, args.wavelength).into_iter().filter_map(|law| fit(&points, law)).collect();
    let Some(best) = fits.iter().min_by(|a, b| a.rms.total_cmp(&b.rms)) else {
        let what = format!("there are {} values above zero", points.len());
        return Err(Error::Input(vec![Problem::error(what).expecting("five or more").in_file(&args.table)]));
    };
    tell(&head(&args.table, &table, &points));
    fits.iter().for_each(|fit| tell(&coefficients(fit, &points, table.is_transmitted())));
    tell(&totals(&table, &held, &fits));
    tell(&verdict(best, &points));
    args.output.iter().try_for_each(|path| write(path, &args.table, &points, (&fits, best)))?;
    Ok(Ending::Done)
}

fn read(text: &str, rule: Unmeasured, file: &Path) -> Result<tabulated::Table, Error> {
    let problem = |fault: reading::Problem| {
        let span = Span { line: fault.line.try_into().unwrap_or(u32::MAX), column: 1, len: 1 };
        Problem::error(fault.message).expecting(fault.expected).at(span).in_file(file)
    };
    let tables = reading::parse(text, rule);
    let mut tables = tables.map_err(|faults| Error::Input(faults.into_iter().map(problem).collect()))?;
    match tables.pop() {
        Some(only) if tables.is_empty() => Ok(only),
        _ => {
            let several = Problem::error("there are several tables: by the azimuth of the sample, or of two sides");
            let expected = "one, of one side, that is the same about the normal: the laws are";
            Err(Error::Input(vec![several.expecting(expected).in_file(file)]))
        }
    }
}

/// Factor on the values of a table: at its shortest wavelength.
fn factor(table: &tabulated::Table) -> f64 {
    let spectrum: Vec<(f64, f64)> = table.spectrum().collect();
    if let [(first, _), .., (last, _)] = spectrum[..]
        && spectrum.iter().any(|(_, factor)| *factor != spectrum[0].1)
    {
        let [first, last] = [first, last].map(|wavelength| digits(1e9 * wavelength, 6));
        say(&format!("warning: the table changes from {first} to {last} nm; the fit is for {first} nm\n"));
    }
    spectrum.first().map_or(1.0, |(_, factor)| *factor)
}

fn laws(points: &[Point], wavelength: Option<Wavelength>) -> Vec<Law> {
    let [low, high] = reach(points);
    let polish = wavelength.filter(|_| low < high).map(|wavelength| {
        let band = [low / wavelength.0, high / wavelength.0];
        Law::KCorrelation { wavelength: wavelength.0, band }
    });
    [Law::Abg, Law::Harvey].into_iter().chain(polish).collect()
}

/// Least and greatest |beta - beta0|.
fn reach(points: &[Point]) -> [f64; 2] {
    let x = points.iter().map(|point| point.x);
    [x.clone().fold(f64::INFINITY, f64::min), x.fold(0.0, f64::max)]
}

fn head(file: &Path, table: &tabulated::Table, points: &[Point]) -> String {
    let angles: Vec<String> = table.lobes().iter().map(|lobe| digits(lobe.incidence().to_degrees(), 4)).collect();
    let all: usize = table.lobes().iter().map(|lobe| lobe.entries().len()).sum();
    let zeros = all - points.len();
    let left = if zeros > 0 { format!(", {zeros} zeros left out") } else { String::new() };
    format!("{}\n  {} values at {} deg of incidence{left}\n", file.display(), points.len(), angles.join(", "))
}

fn coefficients(fit: &Fit, points: &[Point], transmitted: bool) -> String {
    let far = &points[fit.largest.1];
    let mut text = format!(
        "\n{}\n  residuals    rms {} dB, largest {} dB at {} deg of incidence, |beta - beta0| {}\n",
        fit.law.name(),
        digits(fit.rms / DECIBEL, 3),
        digits(fit.largest.0 / DECIBEL, 3),
        digits(far.incidence.to_degrees(), 4),
        digits(far.x, 3),
    );
    for (i, (name, unit)) in fit.law.coefficients().into_iter().enumerate() {
        let value = match i == 3 && fit.is_bare(points) {
            true => "0: no floor is seen".into(),
            false => measured(fit.values[i], fit.errors[i]),
        };
        text.push_str(&format!("  {name:<12} {value} {unit}\n", unit = unit.replace("1/sr", "/sr")));
    }
    text.push_str(&format!("  to paste     {}\n", entry(fit, points, transmitted)));
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

/// TIS by angle of incidence: of the table as it stands, with its gaps filled by what was measured last, and of the fits.
fn totals(table: &tabulated::Table, held: &tabulated::Table, fits: &[Fit]) -> String {
    let factor = table.spectrum().next().map_or(1.0, |(_, factor)| factor);
    let side = if table.is_transmitted() { Side::Transmit } else { Side::Reflect };
    let angles: Vec<f64> = table.totals().map(|(incidence, _)| incidence).collect();
    let laws: Vec<Vec<f64>> = fits.iter().map(|fit| fit.tis(&angles, side)).collect();
    let law = |law: usize, row: usize| laws.get(law).map_or("-".into(), |tis| digits(tis[row], 4));
    let mut rows = Table::new(
        ["incidence deg", "TIS stated", "of its values", "gaps held", "ABg", "Harvey", "K-correlation"],
        &[0, 1, 2, 3, 4, 5, 6],
    );
    for (row, ((angle, [stated, integral]), (_, [_, full]))) in table.totals().zip(held.totals()).enumerate() {
        let [stated, integral, full] = [stated, integral, full].map(|tis| digits(factor * tis, 4));
        rows.row([digits(angle.to_degrees(), 4), stated, integral, full, law(0, row), law(1, row), law(2, row)]);
    }
    format!("\nTotal scatter\n{}", rows.text())
}

fn verdict(best: &Fit, points: &[Point]) -> String {
    let [low, high] = reach(points);
    let order = match best.law {
        Law::KCorrelation { .. } => "\n  surfaces that have it need `order: Scaled`",
        _ => "",
    };
    let doubt = match best.rms > DECIBEL {
        true => "\n  residuals beyond 1 dB: no shift-invariant law, or none of this shape; the table itself is better",
        false => "",
    };
    format!(
        "\nBest: {}, for |beta - beta0| from {} to {}{order}{doubt}\n",
        best.law.name(),
        digits(low, 3),
        digits(high, 4)
    )
}

/// The fit as a system file writes it.
fn entry(fit: &Fit, points: &[Point], transmitted: bool) -> String {
    let side = if transmitted { ", side: Transmit" } else { "" };
    let [p, q, r, reflectance] = fit.values.map(|value| digits(value, 6));
    let lobe = match fit.law {
        Law::Abg => format!("ABg(a: {p}, b: {q}, g: {r}{side})"),
        Law::Harvey => format!("HarveyShack(b0: {p}, l: {q}, s: -{r}{side})"),
        Law::KCorrelation { band, .. } => {
            let [from, to] = band.map(|frequency| digits(1e-3 * frequency, 6));
            let [rms, b] = [digits(1e9 * fit.values[0], 6), digits(1e6 * fit.values[1], 6)];
            format!(
                "KCorrelation(rms: Band(rms: \"{rms} nm\", from: \"{from} /mm\", to: \"{to} /mm\"), b: \"{b} um\", s: {r})"
            )
        }
    };
    let share = if transmitted {
        format!("reflectance: 0, transmittance: {reflectance}")
    } else {
        format!("reflectance: {reflectance}")
    };
    if fit.is_bare(points) { lobe } else { format!("Sum([{lobe}, Lambertian({share})])") }
}

fn write(path: &Path, table: &Path, points: &[Point], (fits, best): (&[Fit], &Fit)) -> Result<(), Error> {
    let failed = |source| Error::Io { path: path.to_owned(), source };
    let bytes = match extension(path).as_str() {
        "png" => picture(&table.display().to_string(), points, best).map_err(failed)?,
        _ => rows(points, fits).into_bytes(),
    };
    report::create(path, |out| out.write_all(&bytes)).map_err(failed)?;
    tell(&format!("\n{}\n", path.display()));
    Ok(())
}

/// The plane of incidence, towards the normal and beyond it: table and best fit.
fn picture(title: &str, points: &[Point], best: &Fit) -> std::io::Result<Vec<u8>> {
    let mut plane: Vec<&Point> = points.iter().filter(|point| point.in_plane.is_some()).collect();
    plane.sort_by(|a, b| {
        a.incidence
            .total_cmp(&b.incidence)
            .then(a.in_plane.partial_cmp(&b.in_plane).unwrap_or(std::cmp::Ordering::Equal))
    });
    let mut curves = Vec::new();
    for own in plane.chunk_by(|a, b| a.incidence == b.incidence) {
        let angle = digits(own[0].incidence.to_degrees(), 4);
        let curve = |what: &str, f: &dyn Fn(&Point) -> f64| Curve {
            label: format!("{angle} deg, {what}"),
            points: own.iter().filter_map(|point| Some([point.in_plane?.asin().to_degrees(), f(point)])).collect(),
        };
        curves.push(curve("table", &|point| point.value));
        curves.push(curve("fit", &|point| best.at(point)));
    }
    let rulers = [
        Ruler { label: "angle of scatter in the plane of incidence, deg", division: Division::Linear },
        Ruler { label: "BSDF, 1/sr", division: Division::Decades },
    ];
    chart(title, rulers, &curves)
}

fn rows(points: &[Point], fits: &[Fit]) -> String {
    let names = ["abg", "harvey", "k_correlation"].into_iter().take(fits.len());
    let heading: String = names.map(|name| format!(",{name}_per_sr")).collect();
    let row = |point: &Point| {
        let laws: String = fits.iter().map(|fit| format!(",{:e}", fit.at(point))).collect();
        format!("{},{:e},{:e}{laws}\n", point.incidence.to_degrees(), point.x, point.value)
    };
    format!("incidence_deg,distance,bsdf_per_sr{heading}\n") + &points.iter().map(row).collect::<String>()
}
