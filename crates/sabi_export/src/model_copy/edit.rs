//! Baked materials in the JSON of a glTF file.

use sabi_surface::model::UvDecoding;
use serde_json::{Value as Json, json};

use super::map_file::MapFile;
use super::maps::MaterialMaps;
use super::numbers::{numbers, short};

/// A texture of the file on a UV set.
pub(super) struct TextureUse {
    pub(super) index: usize,
    pub(super) uv_set: u32,
    /// Transform of the coordinates that the set stores.
    pub(super) decoding: Option<UvDecoding>,
}

impl TextureUse {
    /// Returns the JSON of the use; the first UV set is glTF's default and not written.
    pub(super) fn to_json(&self) -> Json {
        let mut written = match self.uv_set {
            0 => json!({ "index": self.index }),
            uv_set => json!({ "index": self.index, "texCoord": uv_set }),
        };
        if let Some(UvDecoding { scale, offset }) = self.decoding {
            written["extensions"]["KHR_texture_transform"] =
                json!({ "offset": numbers(&offset), "scale": numbers(&scale) });
        }
        written
    }
}

const STRENGTH: &str = "KHR_materials_emissive_strength";

/// Appends to a list of the document, which is created where it does not exist; returns the entry's index.
pub(super) fn push(document: &mut Json, list: &str, value: Json) -> usize {
    match &mut document[list] {
        Json::Array(entries) => {
            entries.push(value);
            entries.len() - 1
        }
        none => {
            *none = json!([value]);
            0
        }
    }
}

/// All primitives of all meshes.
pub(super) fn primitives(document: &mut Json) -> impl Iterator<Item = &mut Json> {
    let meshes = document.get_mut("meshes").and_then(Json::as_array_mut);
    let lists = meshes
        .into_iter()
        .flatten()
        .filter_map(|mesh| mesh.get_mut("primitives"));
    lists.filter_map(Json::as_array_mut).flatten()
}

/// Removes a key, and keeps the order of the others.
pub(super) fn remove(object: &mut Json, key: &str) {
    if let Some(object) = object.as_object_mut() {
        object.shift_remove(key);
    }
}

/// Adds the new maps and factors to a stripped material; glTF's defaults are not written.
pub(super) fn add_maps(
    document: &mut Json,
    index: usize,
    maps: &mut MaterialMaps,
    place: &mut dyn FnMut(&mut Json, MapFile) -> TextureUse,
) {
    let mut put = |document: &mut Json, map: Option<MapFile>| map.map(|map| place(document, map).to_json());
    let base_color = put(document, maps.base_color.take());
    let packed = put(document, maps.packed.take());
    let normal = put(document, maps.normal.take());
    let emission = put(document, maps.emission.take());
    let mut put_map = |map: MapFile| place(document, map).to_json();
    let finish = std::mem::take(&mut maps.finish).extensions(&mut put_map, normal.as_ref());
    let metallic_roughness = packed.clone().filter(|_| maps.packed_surface);
    let material = &mut document["materials"][index];
    let pbr = metallic_roughness_model(maps, base_color, metallic_roughness);
    if !pbr.is_empty() {
        // Extensions of other programs stay.
        let held = &mut material["pbrMetallicRoughness"];
        if !held.is_object() {
            *held = json!({});
        }
        for (key, value) in pbr {
            held[key] = value;
        }
    }
    for (key, texture) in [
        ("normalTexture", normal),
        ("occlusionTexture", packed.filter(|_| maps.packed_occlusion)),
        ("emissiveTexture", emission),
    ] {
        if let Some(texture) = texture {
            material[key] = texture;
        }
    }
    if maps.emission_factor != [0.0; 3] {
        material["emissiveFactor"] = numbers(&maps.emission_factor);
    }
    if maps.emission_strength != 1.0 {
        material["extensions"][STRENGTH] = json!({ "emissiveStrength": short(maps.emission_strength) });
    }
    for (name, extension) in finish {
        material["extensions"][name] = extension;
    }
}

/// glTF's `pbrMetallicRoughness`.
fn metallic_roughness_model(
    maps: &MaterialMaps,
    base_color: Option<Json>,
    metallic_roughness: Option<Json>,
) -> Vec<(&'static str, Json)> {
    let factor = |value: f32| (value != 1.0).then(|| short(value));
    let color = maps.base_color_factor;
    let entries = [
        ("baseColorFactor", (color != [1.0; 4]).then(|| numbers(&color))),
        ("baseColorTexture", base_color),
        ("metallicFactor", factor(maps.metallic_factor)),
        ("roughnessFactor", factor(maps.roughness_factor)),
        ("metallicRoughnessTexture", metallic_roughness),
    ];
    let present = entries.into_iter().filter_map(|(key, value)| Some((key, value?)));
    present.collect()
}
