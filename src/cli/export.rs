//! `straylight export`: the geometry of a system as one glTF file.

use super::{Chosen, Ending, tell, warn};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use straylight::error::Error;
use straylight::report;
use straylight::system::compile::geometry;

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct ExportArgs {
    /// System file (RON)
    pub system: PathBuf,
    /// What to write (.glb)
    pub file: PathBuf,
    #[command(flatten)]
    pub chosen: Chosen,
}

const EXAMPLE: &str = "\
Example:
  straylight export systems/double_gauss/system.ron lens.glb

Every part becomes a node of its name, every face of an element a material of its name; metres, axes as in the
system. Exact surfaces are written as the facets that stand for them: for CAD and viewers, not for tracing.";

/// Writes it.
pub fn export(args: &ExportArgs) -> Result<Ending, Error> {
    if args.file.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("glb")) {
        return Err(Error::Usage(format!("{} does not end in .glb", args.file.display())));
    }
    let placed = geometry(&args.chosen.read(&args.system)?)?;
    warn(&placed.warnings);
    let bytes = placed.glb();
    let failed = |source| Error::Io { path: args.file.clone(), source };
    report::create(&args.file, |out| out.write_all(&bytes)).map_err(failed)?;
    let triangles: usize = placed.nodes.iter().map(|node| node.mesh.triangles.len()).sum();
    tell(&format!("{}: {} nodes, {triangles} triangles\n", args.file.display(), placed.nodes.len()));
    Ok(Ending::Done)
}
