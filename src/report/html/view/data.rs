//! A drawing as a block of data in a page: names as JSON, numbers as base64 of little-endian arrays.

use crate::tally::drawing::{Drawing, DrawnPart, Way};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// The whole block; the scripts name the same fields.
pub fn data(drawing: &Drawing) -> Value {
    json!({
        "centre": drawing.centre.to_array(),
        "radius": drawing.radius,
        "corners": singles(drawing.corners.iter().flatten().copied()),
        "triangles": words(drawing.triangles.iter().flatten().copied()),
        "parts": drawing.parts.iter().map(part).collect::<Vec<_>>(),
        "ways": drawing.ways.iter().map(way).collect::<Vec<_>>(),
        "points": singles(drawing.ways.iter().flat_map(|way| &way.points).flat_map(|point| point.as_vec3().to_array())),
    })
}

fn part(part: &DrawnPart) -> Value {
    json!({
        "label": part.label,
        "triangles": part.triangles,
        "area": part.area,
        "solid": part.solid,
        "speculars": part.speculars,
        "scatters": part.scatters,
        "media": part.media,
        "detectors": part.detectors,
    })
}

fn way(way: &Way) -> Value {
    json!({ "source": way.source, "class": way.class, "path": way.path, "points": way.points.len(), "flux": way.flux })
}

/// Base64 of single-precision numbers.
pub fn singles(numbers: impl Iterator<Item = f32>) -> String {
    STANDARD.encode(numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
}

fn words(numbers: impl Iterator<Item = u32>) -> String {
    STANDARD.encode(numbers.flat_map(u32::to_le_bytes).collect::<Vec<u8>>())
}

/// JSON that can stand in a page: nothing in it ends a script.
pub fn embedded(value: &Value) -> String {
    value.to_string().replace("</", "<\\/").replace("<!--", "<\\u0021--")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_can_end_the_block() {
        let text = embedded(&json!({ "label": "</script><!-- \"a\"" }));
        assert!(!text.contains("</") && !text.contains("<!--"), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON")["label"], "</script><!-- \"a\"");
    }

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(singles([1.0f32, -2.0].into_iter()), "AACAPwAAAMA=");
        assert_eq!(words([1u32, 258].into_iter()), "AQAAAAIBAAA=");
    }
}
