//! The part of a glTF document that matters here, as written.
//!
//! Transforms are read as f64 and extension names are kept, neither of which the `gltf` crate's own root does; accessors,
//! views, buffers and scenes are the crate's types. Cameras, images, animations and the look of materials are skipped.
//!
//! Source: Khronos, glTF 2.0 specification (2021), chapter 5.

use gltf::json;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Root {
    pub asset: Asset,
    pub scene: Option<u32>,
    #[serde(default)]
    pub scenes: Vec<json::Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub accessors: Vec<json::Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<json::buffer::View>,
    #[serde(default)]
    pub buffers: Vec<json::Buffer>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub animations: Vec<IgnoredAny>,
    #[serde(default)]
    pub extensions_used: Vec<String>,
    #[serde(default)]
    pub extensions_required: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Asset {
    pub version: String,
    pub min_version: Option<String>,
}

#[derive(Debug, Deserialize)]
pub struct Node {
    pub name: Option<String>,
    #[serde(default)]
    pub children: Vec<u32>,
    pub mesh: Option<u32>,
    pub skin: Option<u32>,
    /// Column after column.
    pub matrix: Option<[f64; 16]>,
    /// m
    pub translation: Option<[f64; 3]>,
    /// Unit quaternion x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub weights: Option<Vec<f64>>,
    pub extras: Option<serde_json::Value>,
    #[serde(default)]
    pub extensions: Entries<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
pub struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    pub weights: Option<Vec<f64>>,
    pub extras: Option<serde_json::Value>,
}

#[derive(Debug, Deserialize)]
pub struct Primitive {
    pub attributes: Entries<u32>,
    pub indices: Option<u32>,
    pub material: Option<u32>,
    #[serde(default = "triangles")]
    pub mode: u32,
    #[serde(default)]
    pub targets: Vec<Entries<u32>>,
}

fn triangles() -> u32 {
    json::mesh::TRIANGLES
}

#[derive(Debug, Deserialize)]
pub struct Material {
    pub name: Option<String>,
}

/// A JSON object in its own order, whose keys must differ (serde's maps keep the last of equal keys in silence).
#[derive(Debug)]
pub struct Entries<T>(pub Vec<(String, T)>);

impl<T> Entries<T> {
    pub fn get(&self, key: &str) -> Option<&T> {
        self.0.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }
}

impl<T> Default for Entries<T> {
    fn default() -> Entries<T> {
        Entries(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entries<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Entries<T>, D::Error> {
        struct Object<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Object<T> {
            type Value = Entries<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<T>, A::Error> {
                let mut entries = Entries::default();
                while let Some(key) = map.next_key::<String>()? {
                    if entries.get(&key).is_some() {
                        return Err(serde::de::Error::custom(format_args!("duplicate field `{key}`")));
                    }
                    entries.0.push((key, map.next_value()?));
                }
                Ok(entries)
            }
        }
        from.deserialize_map(Object(PhantomData))
    }
}
