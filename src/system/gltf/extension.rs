//! Extensions: which change the shape of things, and which only their look.

use super::document::Root;
use crate::error::Problem;

/// What an extension means for geometry.
enum Effect {
    /// Look, light, sound, labels: nothing is lost by ignoring it.
    None,
    /// Understood.
    Read,
    /// Vertices are packed in a way that is not read; a file may carry them unpacked as well.
    Packed,
    /// Shapes would be missing or misplaced.
    Shape,
    /// Shapes may be hidden or exchanged: worth a word.
    Choice,
    Unknown,
}

fn effect(name: &str) -> Effect {
    match name {
        "KHR_mesh_quantization" => Effect::Read,
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => Effect::Packed,
        "EXT_mesh_gpu_instancing" => Effect::Shape,
        "KHR_node_visibility" | "MSFT_lod" | "KHR_materials_displacement" => Effect::Choice,
        "KHR_lights_punctual"
        | "KHR_animation_pointer"
        | "KHR_xmp"
        | "KHR_xmp_json_ld"
        | "EXT_lights_image_based"
        | "EXT_lights_ies"
        | "KHR_audio_emitter"
        | "EXT_mesh_features"
        | "EXT_structural_metadata"
        | "CESIUM_RTC"
        | "MSFT_packing_occlusionRoughnessMetallic"
        | "MSFT_packing_normalRoughnessMetallic"
        | "KHR_node_selectability"
        | "KHR_node_hoverability"
        | "ADOBE_materials_clearcoat_specular"
        | "ADOBE_materials_clearcoat_tint"
        | "ADOBE_materials_thin_transparency"
        | "EXT_mesh_manifold" => Effect::None,
        _ if ["KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_"]
            .iter()
            .any(|family| name.starts_with(family)) =>
        {
            Effect::None
        }
        _ => Effect::Unknown,
    }
}

/// Errors for what would change the geometry, warnings for what might.
pub fn check(root: &Root) -> Vec<Problem> {
    let mut problems = Vec::new();
    for name in &root.extensions_required {
        let problem = match effect(name) {
            Effect::None | Effect::Read => continue,
            Effect::Choice => Problem::warning(format!("extension `{name}` is ignored: all nodes are read")),
            Effect::Packed => packed(name),
            Effect::Shape | Effect::Unknown => {
                Problem::error(format!("requires the extension `{}`, which is not supported", super::shorten(name)))
            }
        };
        problems.push(problem.on("extensionsRequired"));
    }
    for name in root.extensions_used.iter().filter(|name| !root.extensions_required.contains(name)) {
        let problem = match effect(name) {
            Effect::None | Effect::Read | Effect::Packed | Effect::Shape => continue,
            Effect::Choice => format!("extension `{name}` is ignored: all nodes are read"),
            Effect::Unknown => format!("unknown extension `{}` is ignored", super::shorten(name)),
        };
        problems.push(Problem::warning(problem).on("extensionsUsed"));
    }
    problems.extend(on_nodes(root));
    problems
}

fn packed(name: &str) -> Problem {
    Problem::error(format!("geometry is compressed with `{name}`, which is not supported"))
        .hinting("save the file without compression (gltf-transform, Blender: no compression)".to_owned())
}

/// Instances in an attribute buffer: without them most of the geometry would be missing.
fn on_nodes(root: &Root) -> impl Iterator<Item = Problem> {
    root.nodes.iter().enumerate().flat_map(|(i, node)| {
        let shape = node.extensions.0.iter().filter(|(name, _)| matches!(effect(name), Effect::Shape));
        shape.map(move |(name, _)| {
            Problem::error(format!("extension `{name}` is not supported"))
                .on(format!("nodes[{i}]"))
                .hinting("save the instances as nodes".to_owned())
        })
    })
}

/// Why an accessor may have no data, when an extension is the reason.
pub fn no_data(root: &Root) -> Option<Problem> {
    root.extensions_used.iter().find(|name| matches!(effect(name), Effect::Packed)).map(|name| packed(name))
}
