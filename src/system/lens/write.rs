//! A system file from a lens file.

use super::blocks::{Block, angles, cut};
use super::glass::{find, index, model, vacuum};
use super::text::{form, mm, number, tabulated, vector};
use crate::error::Problem;
use crate::medium::catalog::Shelf;
use crate::prescription::paraxial::{FirstOrder, first_order};
use crate::prescription::{FieldPoint, Material, Prescription, Profile, real};
use glam::{DMat3, DVec3};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

/// A system file, and what of the lens file is not in it.
#[derive(Clone, Debug)]
pub struct Written {
    /// RON.
    pub text: String,
    pub notes: Vec<String>,
    pub optics: FirstOrder,
}

/// How much wider than the beam it asked for a source is, and surfaces are than what they use if their file does not say.
const MARGIN: f64 = 1.05;

/// The system of a lens: elements, stop, glasses, fields as sources, the image plane as detector. Light comes from -z; the origin
/// is the vertex of the first surface.
pub fn system(lens: &Prescription) -> Result<Written, Problem> {
    if let Some(thin) = lens.surfaces.iter().position(|surface| matches!(surface.profile, Profile::Thin { .. })) {
        let problem =
            Problem::error(format!("surface {thin} is an ideal thin lens: it has no surface, and breaks etendue"));
        return Err(problem.expecting("real surfaces"));
    }
    let optics = first_order(lens, &index)?;
    let used = real::semi_diameters(lens, &index)?;
    let radius = |i: usize| lens.surfaces[i].semi_diameter.filter(|r| *r > 0.0).unwrap_or(MARGIN * used[i]);
    let mut radii: Vec<f64> = (0..lens.surfaces.len()).map(radius).collect();
    let mut cut = cut(lens, &radii);
    let mut notes: Vec<String> = lens.notes.iter().map(note).collect();
    notes.append(&mut cut.notes);
    for block in &mut cut.blocks {
        match block {
            Block::Lens { from, to, .. } => notes.extend((*from..*to).filter_map(|i| meet_edge(lens, &mut radii, i))),
            Block::Mirror { at, radius, hole } => notes.extend(pierce(lens, &optics, *at, *radius, hole)),
            Block::Stop { .. } | Block::Disc { .. } => {}
        }
    }
    let mut draft = Draft {
        lens,
        optics: &optics,
        radii: &radii,
        elements: String::new(),
        surfaces: String::new(),
        media: Vec::new(),
    };
    for block in &cut.blocks {
        draft.block(block, &mut notes)?;
    }
    if lens.stop.is_none_or(|stop| !cut.blocks.contains(&Block::Stop { at: stop })) {
        notes.push("the stop lies on an optical surface: its rim limits the beam".to_owned());
    }
    draft.image(&used);
    let text = draft.text(&notes)?;
    Ok(Written { text, notes, optics })
}

/// Makes the surfaces i and i + 1 of a glass smaller if they would cross before their rims.
fn meet_edge(lens: &Prescription, radii: &mut [f64], i: usize) -> Option<String> {
    let [front, back] = [&lens.surfaces[i], &lens.surfaces[i + 1]];
    let way = front.thickness;
    let gap = |scale: f64| {
        let sag = |profile: &Profile, r: f64| profile.at(glam::DVec2::new(0.0, scale * r)).map(|(z, _)| z);
        let edge = way + sag(&back.profile, radii[i + 1])? - sag(&front.profile, radii[i])?;
        Some(edge * way.signum())
    };
    let fits = |scale: f64| gap(scale).is_some_and(|gap| gap >= 0.0);
    if fits(1.0) {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    // A sharp edge with a little room.
    radii[i] *= 0.99 * low;
    radii[i + 1] *= 0.99 * low;
    Some(format!("surfaces {i} and {}: they would cross; made smaller, to {:.6} mm", i + 1, 1e3 * radii[i]))
}

/// A hole where light that was reflected on goes through the mirror again, if the file has none.
fn pierce(lens: &Prescription, optics: &FirstOrder, at: usize, radius: f64, hole: &mut Option<f64>) -> Option<String> {
    let frames = lens.frames();
    let centred =
        |frame: &crate::prescription::Motion| frame.shift.truncate().length() < 1e-12 && frame.turn == DMat3::IDENTITY;
    if !frames.iter().all(centred) {
        return None;
    }
    let z = |i: usize| frames[i].shift.z;
    let through = |i: usize| {
        let part = (z(at) - z(i)) / (z(i + 1) - z(i));
        let between = |rays: &[crate::prescription::paraxial::Ray]| {
            (rays[i].height + part * (rays[i + 1].height - rays[i].height)).abs()
        };
        (part > 1e-9 && part < 1.0 - 1e-9).then(|| between(&optics.marginal) + between(&optics.chief))
    };
    let needed = (at + 1..lens.surfaces.len() - 1).filter_map(through).fold(0.0, f64::max);
    if hole.is_some() || needed == 0.0 || needed >= radius || !needed.is_finite() {
        return None;
    }
    *hole = Some(MARGIN * needed);
    Some(format!(
        "surface {at}: light goes through this mirror; a hole of radius {:.6} mm was cut for it",
        1e3 * MARGIN * needed
    ))
}

fn note(note: &crate::prescription::Note) -> String {
    note.line.map_or_else(|| note.text.clone(), |line| format!("line {line}: {}", note.text))
}

struct Draft<'a> {
    lens: &'a Prescription,
    optics: &'a FirstOrder,
    radii: &'a [f64],
    elements: String,
    surfaces: String,
    /// Name and definition.
    media: Vec<(String, String)>,
}

impl Draft<'_> {
    fn block(&mut self, block: &Block, notes: &mut Vec<String>) -> Result<(), Problem> {
        match *block {
            Block::Lens { from, to, mirrored } => self.glass(from, to, mirrored, notes),
            Block::Mirror { at, radius, hole } => {
                let hole = hole.map_or(String::new(), |hole| format!(", hole: {}", mm(2.0 * hole)));
                let body = format!(
                    "Mirror(form: {}, diameter: {}{hole})",
                    form(&self.lens.surfaces[at].profile)?,
                    mm(2.0 * radius)
                );
                let name = self.place(&format!("M{at}"), &body, at);
                let _ = writeln!(self.surfaces, "        (on: Node({name:?}), specular: Mirror(reflectance: 1)),");
                Ok(())
            }
            Block::Stop { at } => {
                let (open, largest) = (self.radii[at], self.radii.iter().copied().fold(0.0, f64::max));
                let body = format!("Aperture(diameter: {}, outer: {})", mm(2.0 * open), mm(2.4 * largest.max(open)));
                self.place("stop", &body, at);
                Ok(())
            }
            Block::Disc { at, radius } => {
                let body = format!("Aperture(diameter: \"0 mm\", outer: {})", mm(2.0 * radius));
                self.place(&format!("disc{at}"), &body, at);
                Ok(())
            }
        }
    }

    fn glass(&mut self, from: usize, to: usize, mirrored: bool, notes: &mut Vec<String>) -> Result<(), Problem> {
        let mut order: Vec<usize> = (from..=to).collect();
        let way: f64 = (from..to).map(|i| self.lens.surfaces[i].thickness).sum();
        let mut gaps: Vec<f64> = (from..to).map(|i| self.lens.surfaces[i].thickness.abs()).collect();
        let mut media = Vec::new();
        for i in from..to {
            media.push(self.medium(self.lens.medium(i))?);
        }
        if (from + 1..=to).any(|i| self.lens.surfaces[i].before != crate::prescription::Motion::NONE) {
            notes.push(format!("surfaces {from} to {to}: tilts inside a lens are left out"));
        }
        if way < 0.0 {
            // Met from behind: written along +z.
            order.reverse();
            gaps.reverse();
            media.reverse();
        }
        let mut surfaces = Vec::new();
        for &i in &order {
            surfaces.push(format!(
                "(form: {}, semi_diameter: {})",
                form(&self.lens.surfaces[i].profile)?,
                mm(self.radii[i])
            ));
        }
        let list = |items: Vec<String>| format!("[{}]", items.join(", "));
        let body = format!(
            "Lens(\n                surfaces: {},\n                thickness: {},\n                media: {},\n            )",
            list(surfaces),
            list(gaps.into_iter().map(mm).collect()),
            list(media.into_iter().map(|name| format!("{name:?}")).collect()),
        );
        let name = self.place(&format!("L{from}"), &body, order[0]);
        if mirrored {
            let face = if way < 0.0 { "front" } else { "back" };
            let _ = writeln!(self.surfaces, "        (on: Tag(\"{name}*.{face}\"), specular: Mirror(reflectance: 1)),");
        }
        Ok(())
    }

    /// Adds an element at the vertex of surface `at`; its name.
    fn place(&mut self, name: &str, body: &str, at: usize) -> String {
        let frame = self.lens.frames()[at];
        // The curve of a toroid runs along x here, along y in lens files.
        let quarter = body.contains("Toroid(");
        let turn = angles(&if quarter { frame.turn * DMat3::from_rotation_z(FRAC_PI_2) } else { frame.turn });
        let triple = |v: DVec3, scale: f64| {
            let [x, y, z] = (scale * v).to_array().map(|x| number(if x == 0.0 { 0.0 } else { x }));
            format!("({x}, {y}, {z})")
        };
        let rotate = if turn.abs().max_element() < 1e-15 {
            String::new()
        } else {
            format!(", rotate: \"{} deg\"", triple(turn, 180.0 / std::f64::consts::PI))
        };
        let _ = writeln!(
            self.elements,
            "        {name:?}: (body: {body}, at: \"{} mm\"{rotate}),",
            triple(frame.shift, 1e3)
        );
        name.to_owned()
    }

    /// The name under which a glass stands in `media`.
    fn medium(&mut self, material: &Material) -> Result<String, Problem> {
        let (name, definition) = match material {
            Material::Glass { name, maker } => {
                let entry = find(name, maker.as_deref())?;
                let shelf = if entry.shelf == Shelf::Glass { "Glass" } else { "Material" };
                (entry.short().to_owned(), format!("{shelf}({:?})", entry.name))
            }
            Material::Private { name, indices } => (name.clone(), tabulated(indices)),
            Material::Model { nd, vd } => {
                let indices: Vec<(f64, f64)> = self.knots().into_iter().map(|w| (w, model(*nd, *vd, w))).collect();
                (format!("glass {nd}/{vd}"), tabulated(&indices))
            }
            Material::Air | Material::Mirror | Material::Previous => ("air".to_owned(), "Air()".to_owned()),
        };
        if !self.media.iter().any(|(known, _)| *known == name) {
            self.media.push((name.clone(), definition));
        }
        Ok(name)
    }

    /// Wavelengths at which a table of a smooth index is written, m: those of the file, so that they are met exactly, with more
    /// between and some room on both sides.
    fn knots(&self) -> Vec<f64> {
        let own: Vec<f64> = self.lens.wavelengths.iter().map(|(w, _)| *w).collect();
        let (low, high) = own.iter().fold((f64::INFINITY, 0.0), |(low, high), w| (w.min(low), w.max(high)));
        let (low, high) = (0.8 * low, 1.25 * high);
        let mut knots: Vec<f64> = (0..=8).map(|i| low + (high - low) * f64::from(i) / 8.0).chain(own).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup_by(|a, b| (*a / *b - 1.0).abs() < 1e-6);
        knots
    }

    /// The screen in the image plane.
    fn image(&mut self, used: &[f64]) {
        let last = self.lens.surfaces.len() - 1;
        let half = used[last].max(self.optics.image_height.abs()).max(1e-3 * self.optics.entrance_pupil.diameter.abs());
        let body = format!("Aperture(diameter: \"0 mm\", outer: {})", mm(2.4 * half));
        self.place("image", &body, last);
    }

    fn text(&mut self, notes: &[String]) -> Result<String, Problem> {
        let lens = self.lens;
        let sources = self.sources();
        let mut out = String::new();
        let first = self.optics;
        let _ = writeln!(out, "// Imported: focal length {:.7} mm, f/{:.4}.", 1e3 * first.focal_length, first.f_number);
        let _ = writeln!(out, "// Wavelengths here are those in vacuum; the file's, in air, are 0.03 % shorter.");
        for note in notes {
            let _ = writeln!(out, "// Not in this file: {note}");
        }
        let title = if lens.name.trim().is_empty() { "Imported lens" } else { lens.name.trim() };
        let _ = writeln!(out, "System(\n    name: {title:?},\n    elements: {{\n{}    }},", self.elements);
        let _ = writeln!(out, "    ambient: \"air\",\n    media: {{\n        \"air\": Air(),");
        for (name, definition) in self.media.iter().filter(|(name, _)| name != "air") {
            let _ = writeln!(out, "        {name:?}: {definition},");
        }
        let _ = writeln!(out, "    }},\n    surfaces: [\n{}", self.surfaces.trim_end());
        if self.elements.contains("Lens(") {
            let _ = writeln!(out, "        (on: Tag(\"*.edge\"), specular: Absorb),");
            if self.has_shoulders() {
                let _ = writeln!(out, "        (on: Tag(\"*.shoulder\"), specular: Absorb),");
            }
        }
        let _ = writeln!(out, "    ],\n    default: (specular: Absorb),\n    sources: {{\n{sources}    }},");
        let _ = writeln!(
            out,
            "    detectors: {{\n        \"image\": (on: Node(\"image\"), quantity: Irradiance, pixels: (128, 128)),\n    }},\n    \
             run: (rays: 300_000, seed: 1),\n)"
        );
        Ok(out.replace("surfaces: [\n\n", "surfaces: [\n"))
    }

    /// Whether a lens has surfaces of different size.
    fn has_shoulders(&self) -> bool {
        let glass =
            |i: usize| *self.lens.medium(i) != Material::Air && self.lens.surfaces[i].material != Material::Mirror;
        (1..self.lens.surfaces.len() - 1)
            .any(|i| glass(i) && number(1e3 * self.radii[i]) != number(1e3 * self.radii[i + 1]))
    }

    /// One source for every field.
    fn sources(&self) -> String {
        let (lens, pupil) = (self.lens, &self.optics.entrance_pupil);
        let radius = 0.5 * MARGIN * pupil.diameter.abs();
        let nearest = lens.frames()[1..].iter().map(|frame| frame.shift.z).fold(0.0, f64::min);
        let waves: Vec<String> = lens
            .wavelengths
            .iter()
            .map(|(w, weight)| format!("(\"{} nm\", {})", number(1e9 * vacuum(*w).0), number(*weight)))
            .collect();
        let spectrum = match lens.wavelengths[..] {
            [(only, _)] => format!("Line(\"{} nm\")", number(1e9 * vacuum(only).0)),
            _ => format!("Lines([{}])", waves.join(", ")),
        };
        let axis = [FieldPoint::ObjectAngle([0.0; 2])];
        let written: Vec<FieldPoint> = lens.fields.iter().map(|field| field.point).collect();
        let points = if written.is_empty() { &axis[..] } else { &written[..] };
        let mut out = String::new();
        for (i, point) in points.iter().enumerate() {
            let towards = DVec3::new(0.0, 0.0, pupil.position);
            let (from, angular, extent) = match self.object(point) {
                Origin::Far(direction) => {
                    let back = (towards.z - nearest) / direction.z + 2.0 * radius;
                    (
                        towards - back * direction,
                        format!("Collimated(direction: \"{}\")", vector(direction, 1.0)),
                        format!("Disk(radius: {})", mm(radius)),
                    )
                }
                Origin::Near(place) => {
                    let half = (radius / (towards - place).length()).atan().to_degrees();
                    (place, format!("Cone(half_angle: \"{} deg\")", number(half)), "Point".to_owned())
                }
            };
            let facing = format!(", axis: \"{}\"", vector((towards - from).normalize(), 1.0));
            let _ = writeln!(
                out,
                "        \"field {}\": (flux: \"1 W\", extent: {extent}, at: \"{} mm\"{facing}, angular: {angular}, spectrum: {spectrum}),",
                i + 1,
                vector(from, 1e3)
            );
        }
        out
    }

    fn object(&self, point: &FieldPoint) -> Origin {
        let distance = self.lens.surfaces[0].thickness;
        let pupil = self.optics.entrance_pupil.position;
        let far = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize();
        match (*point, distance.is_infinite()) {
            (FieldPoint::ObjectAngle([x, y]), true) => Origin::Far(far(x.tan(), y.tan())),
            (FieldPoint::ObjectAngle([x, y]), false) => {
                let away = distance + pupil;
                Origin::Near(DVec3::new(-away * x.tan(), -away * y.tan(), -distance))
            }
            (FieldPoint::ObjectHeight([x, y]), _) => Origin::Near(DVec3::new(x, y, -distance)),
            (FieldPoint::ImageHeight([x, y]), true) => {
                let f = self.optics.focal_length;
                Origin::Far(far(-x / f, -y / f))
            }
            (FieldPoint::ImageHeight([x, y]), false) => {
                let m = self.optics.magnification;
                Origin::Near(DVec3::new(x / m, y / m, -distance))
            }
        }
    }
}

/// Where the light of a field comes from.
enum Origin {
    /// From infinity in a direction.
    Far(DVec3),
    /// From a point, m.
    Near(DVec3),
}
