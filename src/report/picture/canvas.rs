//! A sheet of pixels with lines and letters.
//!
//! The letters are Noto Sans Mono (SIL Open Font License 1.1), drawn beforehand by `noto-sans-mono-bitmap` (MIT).

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster};

/// Advance of one letter and height of a line, pixels.
pub const LETTER: [i32; 2] = [10, 20];

const INK: [u8; 3] = [0x16, 0x1b, 0x22];

/// Which point of a text stands at the given place.
#[derive(Clone, Copy)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Weight {
    Regular,
    Bold,
}

/// RGB, white at first. Drawing outside is ignored.
pub struct Canvas {
    pub width: i32,
    pub height: i32,
    pub pixels: Vec<u8>,
}

impl Canvas {
    pub fn new(width: i32, height: i32) -> Canvas {
        Canvas { width, height, pixels: vec![255; (3 * width * height) as usize] }
    }

    pub fn dot(&mut self, x: i32, y: i32, colour: [u8; 3]) {
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            let start = 3 * (y * self.width + x) as usize;
            self.pixels[start..start + 3].copy_from_slice(&colour);
        }
    }

    /// Lays ink over what is there; coverage 0..255.
    fn ink(&mut self, x: i32, y: i32, coverage: u8) {
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            let start = 3 * (y * self.width + x) as usize;
            for (channel, ink) in self.pixels[start..start + 3].iter_mut().zip(INK) {
                let mixed = u32::from(*channel) * u32::from(255 - coverage) + u32::from(ink) * u32::from(coverage);
                *channel = (mixed / 255) as u8;
            }
        }
    }

    pub fn fill(&mut self, [x, y]: [i32; 2], [width, height]: [i32; 2], colour: [u8; 3]) {
        for y in y..y + height {
            for x in x..x + width {
                self.dot(x, y, colour);
            }
        }
    }

    /// Straight lines two pixels thick between neighbours that both have a place.
    pub fn curve(&mut self, places: &[Option<[f64; 2]>], colour: [u8; 3]) {
        for pair in places.windows(2) {
            if let [Some(from), Some(to)] = [pair[0], pair[1]] {
                self.line([from, to], 2, colour, |_| true);
            }
        }
    }

    /// A straight line, so many pixels `thick`, where `inked` says so of the length drawn so far.
    pub fn line(&mut self, [from, to]: [[f64; 2]; 2], thick: i32, colour: [u8; 3], inked: impl Fn(f64) -> bool) {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let way = dx.hypot(dy);
        let steps = (2.0 * way).ceil().max(1.0);
        for step in 0..=steps as i32 {
            let part = f64::from(step) / steps;
            if inked(part * way) {
                let [x, y] = [(from[0] + part * dx).round() as i32, (from[1] + part * dy).round() as i32];
                self.fill([x - thick / 2, y - thick / 2], [thick, thick], colour);
            }
        }
    }

    /// A frame of one pixel around a rectangle.
    pub fn frame(&mut self, [x, y]: [i32; 2], [width, height]: [i32; 2]) {
        self.fill([x - 1, y - 1], [width + 2, 1], INK);
        self.fill([x - 1, y + height], [width + 2, 1], INK);
        self.fill([x - 1, y - 1], [1, height + 2], INK);
        self.fill([x + width, y - 1], [1, height + 2], INK);
    }

    pub fn tick(&mut self, at: [i32; 2], size: [i32; 2]) {
        self.fill(at, size, INK);
    }

    /// Horizontal text, centred on `y`.
    pub fn text(&mut self, [x, y]: [i32; 2], anchor: Anchor, weight: Weight, text: &str) {
        let x = x - before(anchor, text);
        for (index, glyph) in text.chars().map(|letter| raster(letter, weight)).enumerate() {
            each(glyph, |column, row, coverage| {
                self.ink(x + index as i32 * LETTER[0] + column, y - LETTER[1] / 2 + row, coverage);
            });
        }
    }

    /// Text that reads upward, centred on `x`.
    pub fn upward(&mut self, [x, y]: [i32; 2], anchor: Anchor, text: &str) {
        let y = y + before(anchor, text);
        for (index, glyph) in text.chars().map(|letter| raster(letter, Weight::Regular)).enumerate() {
            each(glyph, |column, row, coverage| {
                self.ink(x - LETTER[1] / 2 + row, y - index as i32 * LETTER[0] - column, coverage);
            });
        }
    }
}

/// Width of a text, pixels.
pub fn length(text: &str) -> i32 {
    text.chars().count() as i32 * LETTER[0]
}

fn before(anchor: Anchor, text: &str) -> i32 {
    match anchor {
        Anchor::Start => 0,
        Anchor::Middle => length(text) / 2,
        Anchor::End => length(text),
    }
}

fn each(glyph: Option<RasterizedChar>, mut draw: impl FnMut(i32, i32, u8)) {
    for (row, line) in glyph.iter().flat_map(|glyph| glyph.rows().enumerate()) {
        for (column, &coverage) in line.iter().enumerate() {
            draw(column as i32, row as i32, coverage);
        }
    }
}

/// The letter, or what the font has in its place.
fn raster(letter: char, weight: Weight) -> Option<RasterizedChar> {
    let weight = match weight {
        Weight::Regular => FontWeight::Regular,
        Weight::Bold => FontWeight::Bold,
    };
    get_raster(letter, weight, RasterHeight::Size20).or_else(|| get_raster('?', weight, RasterHeight::Size20))
}
