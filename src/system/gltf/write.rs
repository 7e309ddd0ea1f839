//! Writing glTF 2.0 binary: one node per part, one primitive and material per tag.
//!
//! Coordinates are single precision relative to the middle of each node, which carries the rest as its translation: a part
//! far from the origin loses nothing. Metres, axes as in the system.

use super::Node;
use glam::DVec3;
use serde_json::{Value, json};

/// "glTF", "JSON" and "BIN\0" as little-endian words.
const MAGIC: [u32; 3] = [0x4654_6c67, 0x4e4f_534a, 0x004e_4942];

/// The bytes of a .glb with these nodes; `shift` (m) is added to their coordinates.
pub fn glb(nodes: &[Node], shift: DVec3) -> Vec<u8> {
    let mut file = File::default();
    nodes.iter().filter(|node| !node.mesh.triangles.is_empty()).for_each(|node| file.add(node, shift));
    file.bytes()
}

#[derive(Default)]
struct File {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<String>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

impl File {
    fn add(&mut self, node: &Node, shift: DVec3) {
        let bounds = node.mesh.bounds().unwrap_or_default();
        let middle = 0.5 * (bounds[0] + bounds[1]);
        let positions: Vec<[f32; 3]> = node.mesh.vertices.iter().map(|v| (*v - middle).as_vec3().to_array()).collect();
        let end = |start: f32, pick: fn(f32, f32) -> f32| -> [f32; 3] {
            positions.iter().fold([start; 3], |most, v| std::array::from_fn(|i| pick(most[i], v[i])))
        };
        let [low, high] = [end(f32::INFINITY, f32::min), end(f32::NEG_INFINITY, f32::max)];
        let vertices = self.view(positions.iter().flatten().flat_map(|x| x.to_le_bytes()), 34962);
        self.accessors.push(json!({
            "bufferView": vertices, "componentType": 5126, "count": positions.len(), "type": "VEC3", "min": low, "max": high,
        }));
        let position = self.accessors.len() - 1;
        let mut tags: Vec<u16> = node.mesh.labels.clone();
        tags.sort_unstable();
        tags.dedup();
        let primitives: Vec<Value> = tags.into_iter().map(|tag| self.primitive(node, tag, position)).collect();
        self.meshes.push(json!({"name": node.name, "primitives": primitives}));
        let mut written = json!({
            "name": node.name, "mesh": self.meshes.len() - 1, "translation": (middle + shift).to_array(),
        });
        if let Some(medium) = &node.medium {
            written["extras"] = json!({"medium": medium});
        }
        self.nodes.push(written);
    }

    /// The triangles of a node that bear a tag.
    fn primitive(&mut self, node: &Node, tag: u16, position: usize) -> Value {
        let triangles = node.mesh.triangles.iter().zip(&node.mesh.labels).filter(|(_, label)| **label == tag);
        let indices: Vec<u32> = triangles.flat_map(|(triangle, _)| *triangle).collect();
        let view = self.view(indices.iter().flat_map(|i| i.to_le_bytes()), 34963);
        self.accessors
            .push(json!({"bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR"}));
        let mut primitive = json!({"attributes": {"POSITION": position}, "indices": self.accessors.len() - 1});
        let name = &node.tags[tag as usize];
        if !name.is_empty() {
            let known = self.materials.iter().position(|material| material == name);
            primitive["material"] = json!(known.unwrap_or_else(|| {
                self.materials.push(name.clone());
                self.materials.len() - 1
            }));
        }
        primitive
    }

    /// Appends a buffer view, padded to words; its number.
    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: u32) -> usize {
        let start = self.bin.len();
        self.bin.extend(bytes);
        let length = self.bin.len() - start;
        self.views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": length, "target": target}));
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn bytes(mut self) -> Vec<u8> {
        let roots: Vec<usize> = (0..self.nodes.len()).collect();
        let materials: Vec<Value> =
            self.materials.iter().map(|name| json!({"name": name, "doubleSided": true})).collect();
        let mut root = json!({"asset": {"version": "2.0", "generator": "straylight"}});
        if !roots.is_empty() {
            root["scene"] = json!(0);
            root["scenes"] = json!([{"nodes": roots}]);
            root["nodes"] = json!(self.nodes);
            root["meshes"] = json!(self.meshes);
            root["accessors"] = json!(self.accessors);
            root["bufferViews"] = json!(self.views);
            root["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        if !materials.is_empty() {
            root["materials"] = json!(materials);
        }
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + text.len() + if self.bin.is_empty() { 0 } else { 8 + self.bin.len() };
        let mut bytes = Vec::with_capacity(length);
        let words = |bytes: &mut Vec<u8>, words: &[u32]| bytes.extend(words.iter().flat_map(|w| w.to_le_bytes()));
        words(&mut bytes, &[MAGIC[0], 2, length as u32, text.len() as u32, MAGIC[1]]);
        bytes.append(&mut text);
        if !self.bin.is_empty() {
            words(&mut bytes, &[self.bin.len() as u32, MAGIC[2]]);
            bytes.append(&mut self.bin);
        }
        bytes
    }
}
