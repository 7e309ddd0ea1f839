//! Generated geometry as glTF text with its buffer inside.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// Triangles, corners counter-clockwise seen from the front.
pub type Mesh = Vec<[DVec3; 3]>;

/// Nodes with a mesh each. A node's name is also its tag.
#[derive(Default)]
pub struct Model {
    nodes: Vec<(String, Mesh, DQuat, DVec3)>,
}

impl Model {
    pub fn new() -> Model {
        Model::default()
    }

    /// A node where its mesh is.
    pub fn add(self, name: &str, mesh: Mesh) -> Model {
        self.add_at(name, mesh, DQuat::IDENTITY, DVec3::ZERO)
    }

    /// A node turned and then moved.
    pub fn add_at(mut self, name: &str, mesh: Mesh, rotation: DQuat, translation: DVec3) -> Model {
        self.nodes.push((name.into(), mesh, rotation, translation));
        self
    }

    /// The .gltf file.
    pub fn gltf(&self) -> String {
        let mut bytes: Vec<u8> = Vec::new();
        let (mut nodes, mut meshes, mut materials) = (Vec::new(), Vec::new(), Vec::new());
        let (mut accessors, mut views) = (Vec::new(), Vec::new());
        for (index, (name, mesh, rotation, translation)) in self.nodes.iter().enumerate() {
            let corners: Vec<[f32; 3]> = mesh.iter().flatten().map(|v| v.as_vec3().to_array()).collect();
            let end = |start: f32, pick: fn(f32, f32) -> f32| -> [f32; 3] {
                corners.iter().fold([start; 3], |m, v| std::array::from_fn(|i| pick(m[i], v[i])))
            };
            views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 12 * corners.len()}));
            accessors.push(json!({
                "bufferView": index, "componentType": 5126, "count": corners.len(), "type": "VEC3",
                "min": end(f32::INFINITY, f32::min), "max": end(f32::NEG_INFINITY, f32::max),
            }));
            bytes.extend(corners.iter().flatten().flat_map(|c| c.to_le_bytes()));
            materials.push(json!({"name": name}));
            meshes.push(json!({"primitives": [{"attributes": {"POSITION": index}, "material": index}]}));
            nodes.push(json!({
                "name": name, "mesh": index,
                "rotation": rotation.to_array(), "translation": translation.to_array(),
            }));
        }
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes));
        let roots: Vec<usize> = (0..nodes.len()).collect();
        let text: Value = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": roots}],
            "nodes": nodes, "meshes": meshes, "materials": materials,
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": bytes.len(), "uri": uri}],
        });
        text.to_string()
    }
}
