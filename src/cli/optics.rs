//! First-order data as `straylight check` prints them.

use super::table::{Table, digits};
use straylight::system::compile::Understanding;
use straylight::system::compile::understanding::Optics;

/// The section, empty without lenses and mirrors among the elements.
pub fn section(facts: &Understanding) -> String {
    match &facts.optics {
        None => String::new(),
        Some(Err(why)) => format!("First-order data\n  none: {why}\n"),
        Some(Ok(optics)) => format!("First-order data\n{}{}", numbers(optics), rays(optics)),
    }
}

fn mm(metres: f64) -> String {
    digits(1e3 * metres, 8)
}

fn numbers(optics: &Optics) -> String {
    let first = &optics.first_order;
    let frames = optics.lens.frames();
    let last = optics.start + frames[frames.len() - 2].shift.z;
    let towards = if mirrors(optics) % 2 == 1 { -1.0 } else { 1.0 };
    let mut table = Table::new(["", "", ""], &[1]);
    let mut row = |name: &str, value: String, more: String| table.row([name.to_owned(), value, more]);
    row("focal length", mm(first.focal_length), "mm; above 0 converges".into());
    let focus = last + first.back_focal_length;
    row("back focus", mm(first.back_focal_length), format!("mm from the last vertex, z = {} mm", mm(focus)));
    let along = if towards < 0.0 { "; light ends along -z" } else { "" };
    row(
        "image",
        mm(first.image_distance),
        format!("mm from the last vertex, height {} mm{along}", mm(first.image_height)),
    );
    row("f-number", digits(first.f_number, 6), format!("working {}", digits(first.working_f_number, 6)));
    let (enter, exit) = (&first.entrance_pupil, &first.exit_pupil);
    let at = |base: f64, position: f64| format!("mm across, z = {} mm", mm(base + position));
    row("entrance pupil", mm(enter.diameter.abs()), at(optics.start, enter.position));
    row("exit pupil", mm(exit.diameter.abs()), at(last, exit.position));
    let text = table.text();
    text.split_once('\n').map_or(String::new(), |(_, rows)| rows.to_owned())
}

fn mirrors(optics: &Optics) -> usize {
    optics.lens.surfaces.iter().filter(|s| s.material == straylight::prescription::Material::Mirror).count()
}

/// Paraxial heights at every surface.
fn rays(optics: &Optics) -> String {
    let mut table = Table::new(
        ["surface", "vertex z mm", "radius mm", "semi-diameter mm", "marginal mm", "chief mm"],
        &[1, 2, 3, 4, 5],
    );
    let frames = optics.lens.frames();
    let first = &optics.first_order;
    for (i, surface) in optics.lens.surfaces.iter().enumerate().take(optics.lens.surfaces.len() - 1).skip(1) {
        let curvature = match &surface.profile {
            straylight::prescription::Profile::Revolved(curve) => curve.vertex_curvature(),
            _ => 0.0,
        };
        let radius = if curvature == 0.0 { "plane".into() } else { digits(1e3 / curvature, 7) };
        let stop = if optics.lens.stop == Some(i) { " (stop)" } else { "" };
        let reflects = if surface.material == straylight::prescription::Material::Mirror { " mirror" } else { "" };
        table.row([
            format!("{}{reflects}{stop}", surface.label),
            digits(1e3 * (optics.start + frames[i].shift.z), 7),
            radius,
            surface.semi_diameter.map_or("-".into(), |r| digits(1e3 * r, 6)),
            digits(1e3 * first.marginal[i].height, 6),
            digits(1e3 * first.chief[i].height, 6),
        ]);
    }
    table.text()
}
