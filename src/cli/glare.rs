//! `straylight glare`: the veiling glare index of a system.

use super::stop::Stop;
use super::table::digits;
use super::tracing::Tracing;
use super::{Ending, load, say, tell};
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;
use straylight::error::{Error, Problem};
use straylight::report::measured;
use straylight::settings::Settings;
use straylight::study::glare::{Index, index};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct GlareArgs {
    /// System file (RON) with `glare`; `straylight schema` prints its grammar
    pub system: PathBuf,
    #[command(flatten)]
    pub tracing: Tracing,
}

const EXAMPLE: &str = "\
Example:
  straylight glare system.ron

VGI = irradiance in the image of a black patch in a uniform field / irradiance there without the patch (ISO 9358).
The detector must lie within the image of the patch. Field and patch have so many rays each.";

/// Part of the index above which the image of the field is worth a warning.
const IMAGE: f64 = 1e-3;

/// Traces the fields and says what they come to.
pub fn glare(args: &GlareArgs) -> Result<Ending, Error> {
    let mut compiled = load(&args.system, &args.tracing.chosen)?;
    if compiled.glare.is_empty() {
        let problem = Problem::error("the system has no field with a black patch").in_file(&args.system);
        return Err(Error::Input(vec![problem.expecting("`glare: {..}`")]));
    }
    let settings = args.tracing.settings(&compiled.settings);
    let stop = Stop::listen();
    let pool = args.tracing.pool()?;
    let mut trusted = true;
    for glare in &compiled.glare {
        let scene = &mut compiled.scene;
        let Some(found) = pool.install(|| index(scene, glare, &settings, &stop.asked)) else {
            say("interrupted: nothing is told of what was not finished\n");
            return Ok(Ending::Interrupted(stop.code()));
        };
        tell(&text(&found, &settings));
        trusted &= found.trusted;
    }
    Ok(if trusted { Ending::Done } else { Ending::Doubtful })
}

fn text(found: &Index, settings: &Settings) -> String {
    let percent = |share: straylight::tally::results::Estimate| measured(100.0 * share.mean, 100.0 * share.error);
    let [field, patch] = [found.field_w_m2, found.patch_w_m2].map(|e| measured(e.mean, e.error));
    let mut out = format!("{}: veiling glare index {} % on {}\n", found.name, percent(found.index), found.detector);
    // Writing into a String cannot fail.
    let _ =
        writeln!(out, "  of a radiance of 1 W/m2/sr: {field} W/m2 by the field, {patch} W/m2 more without the patch");
    for (class, share) in &found.classes {
        let _ = writeln!(out, "  {class:<14} {:>26} %", percent(*share));
    }
    let _ =
        writeln!(out, "  {} source rays of each, seed {}; errors are one standard error", settings.rays, settings.seed);
    if found.image > IMAGE {
        let share = digits(100.0 * found.image, 2);
        let _ = writeln!(
            out,
            "warning: {share} % of the index is the image of the field: is {:?} within the image of the patch?",
            found.detector
        );
    }
    for warning in &found.warnings {
        let _ = writeln!(out, "warning: {warning}");
    }
    out
}
