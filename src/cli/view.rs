//! `straylight view`: a system in 3-D before anything is traced.

use super::{Chosen, Ending, load, tell};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use straylight::error::Error;
use straylight::report;
use straylight::study::drawing::{draw, sketch};
use straylight::tally::drawing::Drawing;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct ViewArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// Page to write (.html)
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight view systems/triplet/system.ron -o view.html

One page for a browser, without network: the parts coloured by finish, coating, medium or side, a section
plane, normals, and fifty rays of every source. A click on a part says what it is.";

/// Rays of every source.
const RAYS: u64 = 50;

/// Writes it.
pub fn view(args: &ViewArgs) -> Result<Ending, Error> {
    let compiled = load(&args.system, &args.chosen)?;
    let scene = &compiled.scene;
    let drawing = Drawing { ways: sketch(scene, &compiled.settings, RAYS), ..draw(scene) };
    let page = report::view(&scene.name, &drawing);
    let failed = |source| Error::Io { path: args.output.clone(), source };
    report::create(&args.output, |out| out.write_all(page.as_bytes())).map_err(failed)?;
    let (parts, triangles, rays) = (drawing.parts.len(), drawing.all_triangles, drawing.ways.len());
    tell(&format!("{}: {parts} parts, {triangles} triangles, {rays} lines of light\n", args.output.display()));
    Ok(Ending::Done)
}
