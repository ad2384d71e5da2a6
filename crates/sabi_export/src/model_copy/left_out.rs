//! Content of a glTF file that a copy made from the loaded mesh lacks.

use serde_json::Value as Json;

use super::extensions;

/// Extensions whose meaning is in the loaded mesh, or that new maps take the place of.
const READ: [&str; 8] = [
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_texture_transform",
];

/// A sentence for the artist; `why` is the reason for the copy, as a clause.
pub(super) fn left_out(document: &Json, why: &str) -> String {
    let has = |list: &&str| document[*list].as_array().is_some_and(|entries| !entries.is_empty());
    let lists = ["animations", "skins", "cameras"].into_iter().filter(has);
    let mut found: Vec<String> = lists.map(str::to_owned).collect();
    if any(document, &|key, value| {
        key == "targets" && value.as_array().is_some_and(|targets| !targets.is_empty())
    }) {
        found.push("morph targets".to_owned());
    }
    if any(document, &|key, _| key == "extras") {
        found.push("extras".to_owned());
    }
    let extensions = extensions::present(document).into_iter();
    found.extend(extensions.filter(|name| !READ.contains(&name.as_str())));
    let without = match &found[..] {
        [] => String::new(),
        found => format!(", without the file's {}", found.join(", ")),
    };
    format!(
        "the copy of the model was made from the loaded mesh, with each node's place applied{without}: {why}; export the \
         model without that to keep its structure"
    )
}

/// Returns true if `is_so` holds for any entry of any object, at any depth.
fn any(value: &Json, is_so: &dyn Fn(&str, &Json) -> bool) -> bool {
    match value {
        Json::Object(entries) => entries
            .iter()
            .any(|(key, value)| is_so(key, value) || any(value, is_so)),
        Json::Array(values) => values.iter().any(|value| any(value, is_so)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_a_new_copy_does_not_have_is_named() {
        let plain = json!({ "asset": { "version": "2.0" }, "skins": [], "meshes": [{ "primitives": [{ "targets": [] }] }],
            "materials": [{ "extensions": { "KHR_materials_emissive_strength": {} } }] });
        let rich = json!({ "animations": [{}], "skins": [{}], "cameras": [{}], "nodes": [{ "extras": { "id": 1 } }],
            "meshes": [{ "primitives": [{ "targets": [{}] }] }],
            "bufferViews": [{ "extensions": { "EXT_meshopt_compression": {} } }],
            "materials": [{ "extensions": { "KHR_materials_sheen": {}, "KHR_materials_emissive_strength": {} } }] });
        let why = "its vertices are compressed";
        assert_eq!(
            left_out(&plain, why),
            "the copy of the model was made from the loaded mesh, with each node's place applied: its vertices are compressed; \
             export the model without that to keep its structure"
        );
        assert_eq!(
            left_out(&rich, why),
            "the copy of the model was made from the loaded mesh, with each node's place applied, without the file's \
             animations, skins, cameras, morph targets, extras, KHR_materials_sheen: its vertices are compressed; export the \
             model without that to keep its structure"
        );
    }
}
