//! Removal of entries that have become unused from the lists of a glTF file; all references are renumbered. This is done
//! only if all references of the file are known: an unknown extension may contain indices into the lists.

use std::collections::BTreeSet;

use serde_json::{Map, Value as Json};
use strum::VariantArray;

use super::container::PACKED;
use super::edit::remove;
use super::extensions;

/// A list whose entries are referred to by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
enum GltfList {
    Textures,
    Images,
    Samplers,
    Accessors,
    Views,
    Buffers,
}

impl GltfList {
    /// All lists. An entry refers only to entries of later lists.
    const ALL: &'static [GltfList] = GltfList::VARIANTS;

    fn name(self) -> &'static str {
        match self {
            GltfList::Textures => "textures",
            GltfList::Images => "images",
            GltfList::Samplers => "samplers",
            GltfList::Accessors => "accessors",
            GltfList::Views => "bufferViews",
            GltfList::Buffers => "buffers",
        }
    }
}

/// Extensions whose references are visited, or that have none.
const KNOWN: [&str; 17] = [
    "EXT_mesh_features",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_structural_metadata",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Entries of each list that were in use.
#[derive(Debug)]
pub(super) struct UsedEntries {
    used: Vec<BTreeSet<usize>>,
}

impl UsedEntries {
    /// Finds the entries in use; `None` for a file whose references are not all known.
    pub(super) fn of(document: &mut Json) -> Option<UsedEntries> {
        let listed = document.get("extensionsUsed").and_then(Json::as_array);
        let listed = listed.into_iter().flatten().filter_map(Json::as_str).map(str::to_owned);
        let is_known = |name: &String| name.starts_with("KHR_materials_") || KNOWN.contains(&name.as_str());
        let all_known = extensions::present(document)
            .into_iter()
            .chain(listed)
            .all(|name| is_known(&name));
        if !all_known || extras_refer(document) {
            return None;
        }
        Some(UsedEntries {
            used: GltfList::ALL.iter().map(|&list| used(document, list)).collect(),
        })
    }

    /// Removes the entries that were in use and no longer are. The first buffer stays if it is the binary chunk.
    pub(super) fn compact(&self, document: &mut Json, has_chunk: bool) -> RemovedEntries {
        let mut removed = RemovedEntries::default();
        for (&list, before) in GltfList::ALL.iter().zip(&self.used) {
            let now = used(document, list);
            let mut dead: Vec<usize> = before.difference(&now).copied().collect();
            dead.retain(|place| !(has_chunk && list == GltfList::Buffers && *place == 0));
            let Some(entries) = document.get_mut(list.name()).and_then(Json::as_array_mut) else {
                continue;
            };
            let all = std::mem::take(entries).into_iter().enumerate();
            let (gone, kept): (Vec<_>, Vec<_>) = all.partition(|(at, _)| dead.binary_search(at).is_ok());
            entries.extend(kept.into_iter().map(|(_, entry)| entry));
            if entries.is_empty() {
                // glTF forbids empty lists.
                remove(document, list.name());
            }
            visit(document, &mut |of, number| {
                if of == list
                    && let Some(place) = place(number)
                {
                    *number = moved(place, &dead).into();
                }
            });
            match list {
                GltfList::Views => removed.views = gone.into_iter().map(|(_, view)| view).collect(),
                GltfList::Images => removed.images = dead,
                _ => {}
            }
        }
        removed
    }
}

/// Entries that were removed.
#[derive(Debug, Default)]
pub(super) struct RemovedEntries {
    pub(super) views: Vec<Json>,
    /// Indices of the removed images, ascending.
    images: Vec<usize>,
}

impl RemovedEntries {
    /// Returns the new index of an image, given the old one.
    pub(super) fn image(&self, before: usize) -> usize {
        moved(before, &self.images)
    }
}

fn moved(place: usize, dead: &[usize]) -> usize {
    place - dead.partition_point(|at| *at < place)
}

fn place(number: &Json) -> Option<usize> {
    usize::try_from(number.as_u64()?).ok()
}

fn used(document: &mut Json, list: GltfList) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    visit(document, &mut |of, number| {
        if of == list {
            found.extend(place(number));
        }
    });
    found
}

/// Returns true if extras contain anything that looks like a reference.
fn extras_refer(value: &Json) -> bool {
    fn refers(value: &Json) -> bool {
        const WORDS: [&str; 6] = ["index", "texture", "image", "sampler", "accessor", "bufferview"];
        match value {
            Json::Object(members) => members.iter().any(|(key, value)| {
                let key = key.to_ascii_lowercase();
                WORDS.iter().any(|word| key.contains(word)) && !value.is_string() || refers(value)
            }),
            Json::Array(values) => values.iter().any(refers),
            _ => false,
        }
    }
    match value {
        Json::Object(members) => members.iter().any(|(key, value)| {
            if key == "extras" {
                refers(value)
            } else {
                extras_refer(value)
            }
        }),
        Json::Array(values) => values.iter().any(extras_refer),
        _ => false,
    }
}

type Visitor<'v> = dyn FnMut(GltfList, &mut Json) + 'v;

/// Visits every reference to an entry of the lists.
fn visit(document: &mut Json, visitor: &mut Visitor<'_>) {
    for material in entries(document, "materials") {
        visit_textures(material, visitor);
    }
    for texture in entries(document, "textures") {
        visit_member(texture, "sampler", GltfList::Samplers, visitor);
        visit_member(texture, "source", GltfList::Images, visitor);
        let extensions = texture.get_mut("extensions").and_then(Json::as_object_mut);
        for (_, extension) in extensions.into_iter().flatten() {
            visit_member(extension, "source", GltfList::Images, visitor);
        }
    }
    for view in entries(document, "bufferViews") {
        visit_member(view, "buffer", GltfList::Buffers, visitor);
        for name in PACKED {
            if let Some(packed) = view.get_mut("extensions").and_then(|all| all.get_mut(name)) {
                visit_member(packed, "buffer", GltfList::Buffers, visitor);
            }
        }
    }
    for image in entries(document, "images") {
        visit_member(image, "bufferView", GltfList::Views, visitor);
    }
    for accessor in entries(document, "accessors") {
        visit_member(accessor, "bufferView", GltfList::Views, visitor);
        for part in ["/sparse/indices", "/sparse/values"] {
            if let Some(part) = accessor.pointer_mut(part) {
                visit_member(part, "bufferView", GltfList::Views, visitor);
            }
        }
    }
    for mesh in entries(document, "meshes") {
        for primitive in entries(mesh, "primitives") {
            visit_primitive(primitive, visitor);
        }
    }
    if let Some(metadata) = document.pointer_mut("/extensions/EXT_structural_metadata") {
        visit_metadata(metadata, visitor);
    }
    for skin in entries(document, "skins") {
        visit_member(skin, "inverseBindMatrices", GltfList::Accessors, visitor);
    }
    for animation in entries(document, "animations") {
        for sampler in entries(animation, "samplers") {
            visit_member(sampler, "input", GltfList::Accessors, visitor);
            visit_member(sampler, "output", GltfList::Accessors, visitor);
        }
    }
    for node in entries(document, "nodes") {
        if let Some(instances) = node.pointer_mut("/extensions/EXT_mesh_gpu_instancing/attributes") {
            visit_accessors(instances, visitor);
        }
    }
}

fn visit_primitive(primitive: &mut Json, visitor: &mut Visitor<'_>) {
    visit_member(primitive, "indices", GltfList::Accessors, visitor);
    if let Some(attributes) = primitive.get_mut("attributes") {
        visit_accessors(attributes, visitor);
    }
    for target in entries(primitive, "targets") {
        visit_accessors(target, visitor);
    }
    if let Some(features) = primitive.pointer_mut("/extensions/EXT_mesh_features") {
        for ids in entries(features, "featureIds") {
            if let Some(texture) = ids.get_mut("texture") {
                visit_member(texture, "index", GltfList::Textures, visitor);
            }
        }
    }
    if let Some(compressed) = primitive.pointer_mut("/extensions/KHR_draco_mesh_compression") {
        visit_member(compressed, "bufferView", GltfList::Views, visitor);
    }
}

/// Visits the values of features, which lie in buffer views and textures.
fn visit_metadata(metadata: &mut Json, visitor: &mut Visitor<'_>) {
    for table in entries(metadata, "propertyTables") {
        for property in members(table, "properties") {
            for values in ["values", "arrayOffsets", "stringOffsets"] {
                visit_member(property, values, GltfList::Views, visitor);
            }
        }
    }
    for texture in entries(metadata, "propertyTextures") {
        for property in members(texture, "properties") {
            visit_member(property, "index", GltfList::Textures, visitor);
        }
    }
}

/// Visits the uses of textures below a material: objects under a key that ends with `Texture`.
fn visit_textures(value: &mut Json, visitor: &mut Visitor<'_>) {
    for (key, value) in value.as_object_mut().into_iter().flatten() {
        if key == "extras" {
            continue;
        }
        if key.ends_with("Texture") {
            visit_member(value, "index", GltfList::Textures, visitor);
        }
        visit_textures(value, visitor);
    }
}

fn visit_accessors(attributes: &mut Json, visitor: &mut Visitor<'_>) {
    let all = attributes.as_object_mut().into_iter().flat_map(Map::values_mut);
    all.for_each(|accessor| visitor(GltfList::Accessors, accessor));
}

fn visit_member(object: &mut Json, key: &str, list: GltfList, visitor: &mut Visitor<'_>) {
    if let Some(number) = object.get_mut(key) {
        visitor(list, number);
    }
}

fn members<'j>(object: &'j mut Json, key: &str) -> impl Iterator<Item = &'j mut Json> {
    let members = object.get_mut(key).and_then(Json::as_object_mut);
    members.into_iter().flat_map(Map::values_mut)
}

fn entries<'j>(object: &'j mut Json, list: &str) -> impl Iterator<Item = &'j mut Json> {
    object.get_mut(list).and_then(Json::as_array_mut).into_iter().flatten()
}
