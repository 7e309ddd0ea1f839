//! Bricks as a glTF file: closed, faces outward, axes along the world's.

use base64::Engine;
use serde_json::json;

/// A brick: name of the node and of its material, least and greatest corner in m.
pub type Brick<'a> = (&'a str, [f32; 3], [f32; 3]);

/// The text of a .gltf with these bricks, buffers inside.
pub fn gltf(bricks: &[Brick]) -> String {
    let (mut bytes, mut accessors, mut meshes, mut nodes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut views, mut materials) = (Vec::new(), Vec::new());
    for (i, (name, low, high)) in bricks.iter().enumerate() {
        let first = bytes.len();
        for corner in 0..8usize {
            for axis in 0..3 {
                let value = if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                bytes.extend(value.to_le_bytes());
            }
        }
        views.push(json!({"buffer": 0, "byteOffset": first, "byteLength": 96}));
        // Corner number: bit 0 for x, bit 1 for y, bit 2 for z.
        let faces: [[u16; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for [a, b, c, d] in faces {
            [a, b, c, a, c, d].iter().for_each(|index| bytes.extend(index.to_le_bytes()));
        }
        views.push(json!({"buffer": 0, "byteOffset": first + 96, "byteLength": 72}));
        accessors.push(
            json!({"bufferView": 2 * i, "componentType": 5126, "count": 8, "type": "VEC3", "min": low, "max": high}),
        );
        accessors.push(json!({"bufferView": 2 * i + 1, "componentType": 5123, "count": 36, "type": "SCALAR"}));
        materials.push(json!({"name": name}));
        meshes.push(json!({"primitives": [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1, "material": i}]}));
        nodes.push(json!({"name": name, "mesh": i}));
    }
    let uri = base64::engine::general_purpose::STANDARD.encode(&bytes);
    json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": (0..bricks.len()).collect::<Vec<_>>()}],
        "nodes": nodes, "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{uri}")}],
    })
    .to_string()
}
