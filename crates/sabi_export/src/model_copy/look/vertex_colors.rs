//! Vertex colors of baked primitives. Viewers multiply the base color by them, so they are kept in the file under other names.

use serde_json::{Map, Value as Json};

/// Name of a vertex color that viewers ignore: glTF leaves names that begin with `_` to programs.
fn hidden_name(name: &str) -> String {
    format!("_{name}")
}

fn is_color(name: &str) -> bool {
    name.starts_with("COLOR_")
}

/// Names of the vertex colors of a primitive.
pub(super) fn names(primitive: &Json) -> Vec<String> {
    let attributes = primitive.get("attributes").and_then(Json::as_object);
    let names = attributes.into_iter().flat_map(Map::keys);
    names.filter(|name| is_color(name)).cloned().collect()
}

/// Renames the vertex colors of a primitive.
pub(super) fn hide(primitive: &mut Json) {
    if let Some(attributes) = primitive.get_mut("attributes") {
        rename(attributes);
    }
    // Morph targets and compressed data refer to attributes by name.
    let targets = primitive.get_mut("targets").and_then(Json::as_array_mut);
    targets.into_iter().flatten().for_each(rename);
    if let Some(compressed) = primitive.pointer_mut("/extensions/KHR_draco_mesh_compression/attributes") {
        rename(compressed);
    }
}

fn rename(attributes: &mut Json) {
    let Some(attributes) = attributes.as_object_mut() else {
        return;
    };
    let renamed = std::mem::take(attributes).into_iter();
    *attributes = renamed
        .map(|(name, accessor)| match is_color(&name) {
            true => (hidden_name(&name), accessor),
            false => (name, accessor),
        })
        .collect();
}
