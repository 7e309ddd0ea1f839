//! `straylight finishes`: the built-in library of finishes.

use super::table::{Table, digits};
use super::{Ending, tell};
use straylight::bsdf::finish::{Finish, LIBRARY};
use straylight::error::Error;
use straylight::optics::Incidence;

/// Angles of incidence of the TIS that is listed, deg.
const ANGLES: [f64; 2] = [10.0, 75.0];

/// Prints the library.
pub fn finishes() -> Result<Ending, Error> {
    let heading = ["finish", "kind", "holds, nm", "at nm", "TIS 10 deg", "TIS 75 deg"];
    let mut table = Table::new(heading, &[2, 3, 4, 5]);
    for finish in LIBRARY {
        table.row(row(finish)?);
    }
    let mut sources: Vec<&str> = LIBRARY.iter().map(|finish| finish.source).collect();
    sources.dedup();
    let notes: Vec<String> = sources.into_iter().map(|source| note(source) + "\n").collect();
    tell(&format!("{}\n{}", table.text(), notes.concat()));
    Ok(Ending::Done)
}

fn row(finish: &Finish) -> Result<[String; 6], Error> {
    let lobes = finish.lobes().map_err(|problem| Error::Input(vec![problem]))?;
    let [low, high] = finish.range;
    let wavelength = finish.measured_at.unwrap_or(550e-9).clamp(low, high);
    let tis = |degrees: f64| {
        let at = Incidence::in_air(degrees.to_radians(), wavelength);
        digits(lobes.iter().filter(|lobe| !lobe.transmits()).map(|lobe| lobe.albedo(&at)).sum(), 3)
    };
    let nm = |metres: f64| digits(1e9 * metres, 6);
    let [near, far] = ANGLES.map(tis);
    let range = format!("{} .. {}", nm(low), nm(high));
    Ok([finish.name.into(), finish.kind.words().into(), range, nm(wavelength), near, far])
}

/// Where the finishes of one source come from.
fn note(source: &str) -> String {
    let names: Vec<&str> = LIBRARY.iter().filter(|finish| finish.source == source).map(|finish| finish.name).collect();
    let span = match names[..] {
        [first, .., last] => format!("{first} .. {last}"),
        _ => names.concat(),
    };
    format!("  {span}: {source}")
}
