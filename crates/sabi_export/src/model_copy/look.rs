//! The appearance of a baked material: which properties of the model are kept, and a record of the changes.

mod rules;
#[cfg(test)]
mod tests;
mod vertex_colors;

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use self::rules::{PropertyOwner, RULES};
use super::edit::{primitives, remove};
use super::maps::MaterialMaps;

pub use self::rules::Treatment;

/// Change of a property of a material that got maps.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
pub struct LookChange {
    /// Name of the material, as files are named after it.
    pub material: String,
    /// Name of the property in glTF.
    pub property: String,
    /// What happened to it.
    pub change: Treatment,
}

const METALLIC_ROUGHNESS: &str = "pbrMetallicRoughness";

/// Removes everything from a material that its new appearance replaces.
pub(super) fn strip(material: &mut Json, keeps_look: bool) {
    let is_replaced = |treatment: Treatment| treatment != Treatment::Kept;
    for rule in RULES.iter().filter(|rule| is_replaced(rule.treatment(keeps_look))) {
        match rule.owner {
            // The mode is chosen once the new opacity is known.
            PropertyOwner::Material if rule.property != "alphaMode" => remove(material, rule.property),
            PropertyOwner::MetallicRoughness => {
                if let Some(metallic_roughness) = material.get_mut(METALLIC_ROUGHNESS) {
                    remove(metallic_roughness, rule.property);
                }
            }
            _ => {}
        }
    }
    if let Some(Json::Object(extensions)) = material.get_mut("extensions") {
        extensions.retain(|name, _| {
            let Some(rule) = rules::of_extension(name) else {
                return true;
            };
            match rule.treatment(keeps_look) {
                Treatment::Kept => true,
                Treatment::Removed => false,
                // Finishes that the graph does not have belong to the look that is kept.
                Treatment::Set => keeps_look && super::finish_extensions::EXTENSIONS.contains(&name.as_str()),
            }
        });
        if extensions.is_empty() {
            remove(material, "extensions");
        }
    }
}

/// Sets the alpha mode for the new opacity.
pub(super) fn set_alpha_mode(material: &mut Json, maps: &MaterialMaps, keeps_look: bool) {
    const OPAQUE: &str = "OPAQUE";
    let mode = material.get("alphaMode").and_then(Json::as_str).unwrap_or(OPAQUE);
    let varies = maps.base_color_factor[3] == 1.0;
    let new = match mode {
        "MASK" | "BLEND" if keeps_look => mode,
        _ if !maps.has_opacity => OPAQUE,
        // With a threshold, a constant opacity would show either everything or nothing.
        "MASK" if varies => mode,
        _ => "BLEND",
    };
    let (is_changed, new) = (new != mode, new.to_owned());
    if is_changed {
        remove(material, "alphaCutoff");
        remove(material, "alphaMode");
        if new != OPAQUE {
            material["alphaMode"] = json!(new);
        }
    }
}

/// Lists the changes between the material `before` and `after`.
pub(super) fn changes(name: &str, before: &Json, after: &Json, keeps_look: bool) -> Vec<LookChange> {
    let mut found = Vec::new();
    let mut compare = |property: &str, before: Option<&Json>, after: Option<&Json>, is_replaced: bool| {
        let change = match (before, after) {
            (None, None) => return,
            (Some(_), None) => Treatment::Removed,
            // A new texture may have the same number as the earlier one.
            (Some(before), Some(after)) if before == after && !is_replaced => Treatment::Kept,
            (_, Some(_)) => Treatment::Set,
        };
        found.push(LookChange {
            material: name.to_owned(),
            property: property.to_owned(),
            change,
        });
    };
    for rule in &RULES {
        let owner = |material: &'_ Json| -> Option<Json> {
            let owner = match rule.owner {
                PropertyOwner::Material => material,
                PropertyOwner::MetallicRoughness => material.get(METALLIC_ROUGHNESS)?,
                PropertyOwner::Extensions | PropertyOwner::OtherExtensions | PropertyOwner::Primitive => return None,
            };
            owner.get(rule.property).cloned()
        };
        let is_replaced = rule.treatment == Treatment::Set && rule.property != "alphaMode";
        compare(
            rule.property,
            owner(before).as_ref(),
            owner(after).as_ref(),
            is_replaced,
        );
    }
    let none = Map::new();
    let [before, after] = [before, after].map(|material| {
        let extensions = material.get("extensions").and_then(Json::as_object);
        extensions.unwrap_or(&none)
    });
    let new = after.keys().filter(|name| !before.contains_key(*name));
    for name in before.keys().chain(new) {
        let is_set = rules::of_extension(name).is_some_and(|rule| rule.treatment == Treatment::Set);
        compare(name, before.get(name), after.get(name), is_set && !keeps_look);
    }
    found
}

/// Changes the primitives of the material at a place; lists what became of their properties.
pub(super) fn change_primitives(name: &str, document: &mut Json, index: usize, keeps_look: bool) -> Vec<LookChange> {
    let mut found = BTreeSet::new();
    for primitive in primitives(document) {
        if primitive["material"].as_u64() != Some(index as u64) {
            continue;
        }
        let colors = vertex_colors::names(primitive);
        if !keeps_look && !colors.is_empty() {
            vertex_colors::hide(primitive);
        }
        let change = if keeps_look {
            Treatment::Kept
        } else {
            Treatment::Removed
        };
        found.extend(colors.into_iter().map(|color| (color, change)));
        if primitive.pointer("/extensions/KHR_materials_variants").is_some() {
            found.insert(("KHR_materials_variants".to_owned(), Treatment::Kept));
        }
    }
    let changes = found.into_iter().map(|(property, change)| LookChange {
        material: name.to_owned(),
        property,
        change,
    });
    changes.collect()
}
