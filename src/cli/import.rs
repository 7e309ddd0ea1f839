//! `straylight import`: a lens of a design program becomes a system.

use super::table::digits;
use super::{Ending, tell};
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use straylight::error::Error;
use straylight::system::lens;
use straylight::{import, report};

#[derive(Args)]
#[command(after_help = EXAMPLE)]
pub struct ImportArgs {
    /// Lens file: Zemax .zmx, CODE V .seq, ray-optics .roa
    pub file: PathBuf,
    /// Folder to write system.ron to; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
}

const EXAMPLE: &str = "\
Example:
  straylight import double_gauss.zmx -o double_gauss
  straylight check double_gauss/system.ron

Elements, stop, glasses, fields as sources, the image plane as detector. What cannot be translated is listed, here and at
the head of the file. An existing system.ron is not overwritten.";

/// Translates it.
pub fn import(args: &ImportArgs) -> Result<Ending, Error> {
    let in_file = |problem: straylight::error::Problem| problem.in_file(&args.file);
    if !args.file.is_file() {
        let problem = straylight::error::Problem::error("no such lens file");
        return Err(Error::Missing(vec![in_file(problem)]));
    }
    let prescription = import::read(&args.file).map_err(Error::Input)?;
    let written = lens::system(&prescription).map_err(|problem| Error::Input(vec![in_file(problem)]))?;
    let target = args.out.join("system.ron");
    if target.exists() {
        return Err(Error::Usage(format!("{} is there already", target.display())));
    }
    let failed = |source| Error::Io { path: target.clone(), source };
    std::fs::create_dir_all(&args.out).map_err(failed)?;
    report::create(&target, |out| out.write_all(written.text.as_bytes())).map_err(failed)?;
    let optics = &written.optics;
    let mm = |metres: f64| digits(1e3 * metres, 8);
    tell(&format!(
        "{}\n  focal length  {} mm\n  back focus    {} mm\n  f-number      {}\n  wavelength    {} nm\n",
        target.display(),
        mm(optics.focal_length),
        mm(optics.back_focal_length),
        digits(optics.f_number, 6),
        digits(1e9 * prescription.wavelength(), 6),
    ));
    for note in &written.notes {
        tell(&format!("  not translated: {note}\n"));
    }
    Ok(Ending::Done)
}
