//! Curves for the terminal: plain lines, no colour, no width assumed.

use super::Went;
use crate::report::measured::{below, grouped, measured};
use crate::study::pst::{Curve, GROUPS, Point, Sweeps};
use std::fmt::{self, Write};

/// Every direction with its PST, what it is made of, and what is required of it. Ends with a newline.
#[must_use]
pub fn text(sweeps: &Sweeps, went: &Went) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = whole(&mut out, sweeps, went);
    out
}

fn whole(out: &mut String, sweeps: &Sweeps, went: &Went) -> fmt::Result {
    writeln!(out, "{}", sweeps.system)?;
    for curve in &sweeps.curves {
        heading(out, curve, went)?;
        table(out, curve)?;
        sky(out, curve)?;
        verdict(out, curve)?;
        for warning in &curve.warnings {
            writeln!(out, "warning: {warning}")?;
        }
    }
    Ok(())
}

fn heading(out: &mut String, curve: &Curve, went: &Went) -> fmt::Result {
    let area = format!("{} mm²", measured(rounded(1e6 * curve.area_m2), 0.0));
    let rays = grouped(curve.rays, " ");
    let (directions, rounds) = (curve.points.len(), curve.rounds);
    writeln!(out, "\n{}: mean irradiance on {} ({area}) / irradiance across the beam", curve.sweep, curve.detector)?;
    let seed = curve.seed;
    writeln!(
        out,
        "{directions} directions, {rays} source rays in {rounds} rounds, seed {seed}; {:.1} s on {} threads",
        went.seconds, went.threads
    )?;
    if went.interrupted {
        writeln!(out, "interrupted: the rounds that were finished are below")?;
    }
    writeln!(out, "errors are one standard error of the mean; \"<\": nothing arrived; classes in % of the PST")
}

fn table(out: &mut String, curve: &Curve) -> fmt::Result {
    let azimuths = curve.cuts().len() > 1;
    let shown: Vec<usize> =
        (0..GROUPS.len()).filter(|&group| curve.points.iter().any(|point| point.groups[group].mean > 0.0)).collect();
    let ratio = curve.points.iter().any(|point| point.psrr.is_some());
    let required = curve.mask.is_some();
    write!(out, "{:>9}", "deg")?;
    if azimuths {
        write!(out, "{:>9}", "azimuth")?;
    }
    write!(out, "{:>25}{:>8}", "PST", "error")?;
    if ratio {
        write!(out, "{:>11}", "PSRR")?;
    }
    for &group in &shown {
        write!(out, "{:>15}", GROUPS[group])?;
    }
    if required {
        write!(out, "{:>11}{:>10}  stray light", "limit", "margin")?;
    }
    writeln!(out)?;
    for point in &curve.points {
        write!(out, "{:>9}", point.angle_deg)?;
        if azimuths {
            write!(out, "{:>9}", point.azimuth_deg)?;
        }
        write!(out, "{:>25}{:>8}", value(point), relative(point))?;
        if ratio {
            write!(out, "{:>11}", point.psrr.map_or(String::new(), |ratio| format!("{:.2e}", ratio.mean)))?;
        }
        for &group in &shown {
            write!(out, "{:>15}", share(point, group))?;
        }
        if let Some(required) = &point.required {
            let margin = measured(rounded(required.margin), 0.0);
            write!(out, "{:>11}{margin:>10}  {}", format!("{:.1e}", required.limit), required.verdict)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn verdict(out: &mut String, curve: &Curve) -> fmt::Result {
    let Some(mask) = &curve.mask else { return Ok(()) };
    match curve.verdict {
        Some(verdict) => writeln!(out, "{}: {verdict} ({mask}, 95 % confidence at each angle)", curve.sweep),
        None => writeln!(out, "{}: {mask} requires nothing at these angles", curve.sweep),
    }
}

fn sky(out: &mut String, curve: &Curve) -> fmt::Result {
    let Some(sky) = &curve.sky else { return Ok(()) };
    let solid = measured(sky.stray_sr.mean, sky.stray_sr.error);
    let other = measured(rounded(sky.logarithmic_sr), 0.0);
    let around =
        if sky.around_deg < 359.9 { format!(" over {:.0} deg of azimuth", sky.around_deg) } else { String::new() };
    writeln!(
        out,
        "uniform sky from {} to {} deg{around}: stray irradiance {solid} sr x its radiance ({other} with log(PST) linear between angles)",
        sky.from_deg, sky.to_deg
    )
}

fn value(point: &Point) -> String {
    point.upper_limit.map_or_else(|| measured(point.pst.mean, point.pst.error), below)
}

/// The relative error.
fn relative(point: &Point) -> String {
    let percent = 100.0 * point.pst.error / point.pst.mean;
    if percent.is_finite() { format!("{percent:.1} %") } else { String::new() }
}

/// Percent of the PST.
fn share(point: &Point, group: usize) -> String {
    let percent = 100.0 * point.groups[group].mean / point.pst.mean;
    match percent {
        p if !p.is_finite() || p == 0.0 => String::new(),
        p if p < 0.01 => format!("{p:.0e}"),
        p => format!("{p:.2}"),
    }
}

/// Three digits of a number.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
