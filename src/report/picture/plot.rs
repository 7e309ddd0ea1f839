//! The picture of a map: alone for the page, or with axes, title and colour bar as a file.

use super::canvas::{Anchor, Canvas, LETTER, Weight, length};
use super::scale::{DARK, Palette};
use super::{Cell, Field, Scale, ticks};
use crate::tally::results::MapResult;
use std::io;

/// Longest side of the plot, pixels.
const LONGEST: f64 = 640.0;

/// Space left, above, right (colour bar) and below the plot, pixels.
const MARGIN: [i32; 4] = [104, 84, 190, 132];

/// Colours on the scale of an indexed picture; the two after them are "no ray" and "outside".
const SHADES: usize = 254;

/// The field alone, one pixel per cell, row 0 at the bottom, outside transparent: an indexed PNG.
pub fn bare(field: &Field, scale: &Scale, palette: Palette) -> io::Result<Vec<u8>> {
    let [rows, columns] = field.shape;
    let index = |cell: &Cell| match *cell {
        Cell::Lit(value) => (scale.place(value) * (SHADES - 1) as f64).round() as u8,
        Cell::Dark => SHADES as u8,
        Cell::Outside => SHADES as u8 + 1,
    };
    let pixels: Vec<u8> = field.cells.chunks_exact(columns).rev().flatten().map(index).collect();
    let shades = (0..SHADES).flat_map(|shade| palette.colour(shade as f64 / (SHADES - 1) as f64));
    let palette: Vec<u8> = shades.chain(DARK).chain([255; 3]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_trns([[255; SHADES + 1].as_slice(), &[0]].concat());
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(bytes)
}

/// The whole picture as a PNG: plot, axes with units, title, colour bar, and the scale in words.
pub fn png(map: &MapResult, system: &str) -> io::Result<Vec<u8>> {
    let field = Field::of(map);
    let scale = Scale::of(field.lit());
    encode(&Plot::new(&field, scale, map).draw(map, system))
}

/// A canvas as a PNG.
pub fn encode(canvas: &Canvas) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, canvas.width.unsigned_abs(), canvas.height.unsigned_abs());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&canvas.pixels)?;
    Ok(bytes)
}

struct Plot<'a> {
    field: &'a Field,
    scale: Scale,
    unit: String,
    /// Upper left corner and size of the plot.
    at: [i32; 2],
    size: [i32; 2],
    canvas: Canvas,
}

impl<'a> Plot<'a> {
    fn new(field: &'a Field, scale: Scale, map: &MapResult) -> Plot<'a> {
        let size = size(field);
        let width = (MARGIN[0] + size[0] + MARGIN[2]).max(760);
        let at = [MARGIN[0] + (width - MARGIN[0] - MARGIN[2] - size[0]) / 2, MARGIN[1]];
        let canvas = Canvas::new(width, MARGIN[1] + size[1].max(160) + MARGIN[3]);
        Plot { field, scale, unit: map.unit.replace('2', "²"), at, size, canvas }
    }

    fn draw(mut self, map: &MapResult, system: &str) -> Canvas {
        let quantity = map.quantity().to_lowercase();
        let side = if map.side == "both" { "both sides".into() } else { format!("{} side", map.side) };
        let light = map.filter.as_ref().map(|filter| format!(", {filter}")).unwrap_or_default();
        let fit = |text: String| text.chars().take(((self.canvas.width - 32) / LETTER[0]) as usize).collect::<String>();
        let [title, subtitle] = [fit(format!("{}: {quantity}, {side}{light}", map.detector)), fit(system.to_owned())];
        self.canvas.text([16, 26], Anchor::Start, Weight::Bold, &title);
        self.canvas.text([16, 50], Anchor::Start, Weight::Regular, &subtitle);
        self.cells();
        self.canvas.frame(self.at, self.size);
        self.axes();
        if self.scale != Scale::Empty {
            self.bar();
        }
        self.words();
        self.canvas
    }

    fn cells(&mut self) {
        let [rows, columns] = self.field.shape;
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let row = rows - 1 - y as usize * rows / self.size[1] as usize;
                let cell = self.field.cells[row * columns + x as usize * columns / self.size[0] as usize];
                let colour = match cell {
                    Cell::Lit(value) => Palette::Light.colour(self.scale.place(value)),
                    Cell::Dark => DARK,
                    Cell::Outside => [255; 3],
                };
                self.canvas.dot(self.at[0] + x, self.at[1] + y, colour);
            }
        }
    }

    fn axes(&mut self) {
        let ([left, top], [width, height]) = (self.at, self.size);
        let (middle, bottom) = (left + width / 2, top + height);
        let Some([x, y]) = &self.field.spans else {
            let label = format!("triangle 0 .. {}", self.field.shape[1] * self.field.averaged - 1);
            return self.canvas.text([middle, bottom + 24], Anchor::Middle, Weight::Regular, &label);
        };
        for (place, text) in ticks(x.from, x.to, (width / 100).max(2) as usize) {
            let at = left + (place * f64::from(width - 1)).round() as i32;
            self.canvas.tick([at, bottom + 1], [1, 6]);
            self.canvas.text([at, bottom + 20], Anchor::Middle, Weight::Regular, &text);
        }
        self.canvas.text([middle, bottom + 48], Anchor::Middle, Weight::Regular, &latin(&x.label()));
        let mut widest = 0;
        for (place, text) in ticks(y.from, y.to, (height / 80).max(1) as usize) {
            let at = bottom - 1 - (place * f64::from(height - 1)).round() as i32;
            self.canvas.tick([left - 7, at], [6, 1]);
            self.canvas.text([left - 12, at], Anchor::End, Weight::Regular, &text);
            widest = widest.max(length(&text));
        }
        self.canvas.upward([left - 12 - widest - 18, top + height / 2], Anchor::Middle, &latin(&y.label()));
    }

    fn bar(&mut self) {
        let (left, top) = (self.at[0] + self.size[0] + 32, self.at[1]);
        let height = self.size[1].max(160);
        for y in 0..height {
            let place = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
            self.canvas.fill([left, top + y], [24, 1], Palette::Light.colour(place));
        }
        self.canvas.frame([left, top], [24, height]);
        let mut free = top + height + LETTER[1]; // lowest line of text not yet taken
        for mark in self.scale.marks() {
            let y = top + height - 1 - (mark.place * f64::from(height - 1)).round() as i32;
            self.canvas.tick([left + 25, y], [6, 1]);
            if y + LETTER[1] <= free {
                self.canvas.text([left + 36, y], Anchor::Start, Weight::Regular, &mark.text);
                free = y;
            }
        }
        let factor = match self.scale.exponent() {
            0 => String::new(),
            power => format!("1e{power} "),
        };
        self.canvas.text([left, top - 16], Anchor::Start, Weight::Regular, &format!("{factor}{}", self.unit));
    }

    /// Two lines at the foot: the scale, and what else must be known to read the picture.
    fn words(&mut self) {
        let statement = self.scale.statement(&self.unit);
        let averaged = self.field.averaged;
        let remarks: Vec<String> = [
            self.field.has_dark().then(|| "grey: no ray arrived".to_owned()),
            (averaged > 1).then(|| format!("pixels average up to {averaged} x {averaged} bins")),
            (!self.field.true_to_scale()).then(|| "axes not to one scale".to_owned()),
        ]
        .into_iter()
        .flatten()
        .collect();
        let foot = self.canvas.height - 44;
        let scale = statement.split("; ").next().unwrap_or_default();
        self.canvas.text([16, foot], Anchor::Start, Weight::Regular, scale);
        self.canvas.text([16, foot + 24], Anchor::Start, Weight::Regular, &remarks.join("; "));
    }
}

/// Size on paper: true proportions up to 8 : 1, whole pixels per cell where they fit.
fn size(field: &Field) -> [i32; 2] {
    let [rows, columns] = field.shape.map(|side| side as f64);
    let aspect = field.aspect();
    let (width, height) = if aspect >= 1.0 { (LONGEST, LONGEST / aspect) } else { (LONGEST * aspect, LONGEST) };
    let whole = |length: f64, cells: f64| (length / cells).round().max(1.0) * cells;
    let fitted = [whole(width, columns), whole(height, rows)];
    let kept = (fitted[0] / fitted[1] / aspect - 1.0).abs() < 0.02 && fitted[0].max(fitted[1]) < 1.7 * LONGEST;
    let [width, height] = if kept { fitted } else { [width, height] };
    [width.round() as i32, height.round() as i32]
}

/// The picture's font has no Greek.
fn latin(text: &str) -> String {
    text.replace('θ', "theta").replace('φ', "phi")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tally::results::MapKind;

    fn decoded(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        (frame.width, frame.height, pixels)
    }

    /// Two rows of three bins; only the first bin of row 0 is dark.
    fn map() -> MapResult {
        MapResult {
            detector: "d".into(),
            filter: None,
            kind: MapKind::Plane,
            shape: [2, 3],
            axes: None,
            unit: "W/m2",
            mean: vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
            error: vec![0.1; 6],
            rays: vec![0, 9, 9, 9, 9, 9],
            upper: vec![0.0; 6],
            extent: vec![1.0; 6],
            origin: [0.0; 3],
            column_direction: [1.0, 0.0, 0.0],
            row_direction: [0.0, 1.0, 0.0],
            stray: None,
            side: "front",
        }
    }

    #[test]
    fn the_first_row_is_at_the_bottom_and_the_first_column_at_the_left() {
        let field = Field::of(&map());
        let scale = Scale::of(field.lit());
        let (width, height, pixels) = decoded(&bare(&field, &scale, Palette::Light).unwrap());
        assert_eq!((width, height), (3, 2));
        let dark = SHADES as u8;
        assert_eq!(pixels.iter().position(|&pixel| pixel == dark), Some(3));
        assert_eq!(pixels[2], dark - 1); // the brightest bin, upper right
    }

    #[test]
    fn a_picture_shows_dark_bins_in_a_colour_that_is_not_on_the_scale() {
        let (_, _, pixels) = decoded(&png(&map(), "system").unwrap());
        assert!(pixels.chunks_exact(3).any(|pixel| pixel == DARK));
        assert!((0..=1000).all(|step| Palette::Light.colour(f64::from(step) / 1000.0) != DARK));
    }
}
