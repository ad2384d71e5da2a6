//! A GLB file from a loaded model, for formats that are no glTF: one mesh for each part, one primitive for each of its
//! materials.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::{Mesh, Model, ModelMaterial, TextureRef, Wrap};
use serde_json::{Map, Value as Json, json};

use super::container::Container;
use super::edit::push;
use super::extensions;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The document and its container. Materials that are `baked` get no looks of their own.
pub(super) fn glb(model: &Model, baked: &BTreeSet<u32>) -> (Container, Json) {
    let mut arrays = Arrays::default();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("Sabi ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [] }],
        "buffers": [{ "byteLength": 0 }],
    });
    for (part, materials) in primitives(&model.mesh) {
        let name = model.parts.get(part as usize).map_or("", String::as_str);
        let primitives = materials.into_iter().map(|(material, triangles)| {
            let mut primitive = arrays.primitive(&model.mesh, &triangles);
            primitive["material"] = json!(material);
            primitive
        });
        let primitives: Vec<Json> = primitives.collect();
        let mesh = push(
            &mut document,
            "meshes",
            json!({ "name": name, "primitives": primitives }),
        );
        let node = push(&mut document, "nodes", json!({ "name": name, "mesh": mesh }));
        push(&mut document["scenes"][0], "nodes", json!(node));
    }
    let mut container = Container::glb(Vec::new());
    arrays.finish(&mut document, &mut container);
    let mut pictures = BTreeMap::new();
    for (index, material) in model.materials.iter().enumerate() {
        let mut entry = Map::new();
        if !material.name.is_empty() {
            entry.insert("name".into(), json!(material.name));
        }
        let mut entry = Json::Object(entry);
        if !baked.contains(&(index as u32)) {
            let mut texture = |document: &mut Json, used: &Option<TextureRef>| {
                picture(model, used.as_ref()?, document, &mut container, &mut pictures)
            };
            look(material, &mut entry, &mut document, &mut texture);
        }
        push(&mut document, "materials", entry);
    }
    extensions::keep_lists_true(&mut document, &BTreeSet::new());
    (container, document)
}

/// Triangles by part and material.
fn primitives(mesh: &Mesh) -> BTreeMap<u32, BTreeMap<u32, Vec<[u32; 3]>>> {
    let mut parts: BTreeMap<u32, BTreeMap<u32, Vec<[u32; 3]>>> = BTreeMap::new();
    let of = mesh.triangle_part.iter().zip(&mesh.triangle_material);
    for (corners, (part, material)) in mesh.triangles.iter().zip(of) {
        let materials = parts.entry(*part).or_default();
        materials.entry(*material).or_default().push(*corners);
    }
    parts
}

/// Vertex data on its way into buffer views: indices first, then one view for each attribute.
#[derive(Default)]
struct Arrays {
    /// Bytes and bytes of an element.
    views: BTreeMap<(usize, &'static str), (Vec<u8>, usize)>,
    accessors: Vec<Json>,
}

/// Attributes in the order of their views.
const ATTRIBUTES: [&str; 5] = ["POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0"];

impl Arrays {
    /// Adds the vertices that the triangles use, in the order of their first use.
    fn primitive(&mut self, mesh: &Mesh, triangles: &[[u32; 3]]) -> Json {
        let mut new_from_old = BTreeMap::new();
        let mut used = Vec::new();
        let indices = triangles.iter().flatten().map(|vertex| {
            *new_from_old.entry(*vertex).or_insert_with(|| {
                used.push(*vertex as usize);
                used.len() as u32 - 1
            })
        });
        let indices: Vec<[u32; 1]> = indices.map(|index| [index]).collect();
        let count = indices.len();
        let words = indices.into_iter().map(|[index]| index.to_le_bytes());
        let indices = self.add((0, "indices"), words.flatten().collect(), 4, count, UNSIGNED_INT);
        let mut attributes = Map::new();
        self.attribute(&mut attributes, 0, &mesh.positions, &used);
        self.attribute(&mut attributes, 1, &mesh.normals, &used);
        self.attribute(&mut attributes, 2, &mesh.tangents, &used);
        self.attribute(&mut attributes, 3, &mesh.uvs, &used);
        self.attribute(&mut attributes, 4, &mesh.colors, &used);
        json!({ "attributes": attributes, "indices": indices })
    }

    fn attribute<const N: usize>(
        &mut self,
        attributes: &mut Map<String, Json>,
        which: usize,
        values: &[[f32; N]],
        used: &[usize],
    ) {
        if values.is_empty() {
            return;
        }
        let name = ATTRIBUTES[which];
        let mut low = [f32::INFINITY; N];
        let mut high = [f32::NEG_INFINITY; N];
        let mut bytes = Vec::with_capacity(used.len() * 4 * N);
        for value in used.iter().map(|vertex| values[*vertex]) {
            for axis in 0..N {
                low[axis] = low[axis].min(value[axis]);
                high[axis] = high[axis].max(value[axis]);
                bytes.extend_from_slice(&value[axis].to_le_bytes());
            }
        }
        let accessor = self.add((which + 1, name), bytes, 4 * N, used.len(), FLOAT);
        if which == 0 {
            // The one attribute that must say it. Exactly as stored: as f64, no digit is lost.
            self.accessors[accessor]["min"] = json!(low.map(f64::from).to_vec());
            self.accessors[accessor]["max"] = json!(high.map(f64::from).to_vec());
        }
        attributes.insert(name.into(), json!(accessor));
    }

    fn add(
        &mut self,
        view: (usize, &'static str),
        bytes: Vec<u8>,
        stride: usize,
        count: usize,
        component: u32,
    ) -> usize {
        let (held, _) = self.views.entry(view).or_insert_with(|| (Vec::new(), stride));
        // The view's number is known once all views are.
        self.accessors.push(json!({
            "bufferView": view.0, "byteOffset": held.len(), "componentType": component, "count": count,
            "type": match stride / 4 { 1 => "SCALAR", 2 => "VEC2", 3 => "VEC3", _ => "VEC4" },
        }));
        held.extend_from_slice(&bytes);
        self.accessors.len() - 1
    }

    fn finish(mut self, document: &mut Json, container: &mut Container) {
        let mut places = BTreeMap::new();
        for ((order, _), (bytes, stride)) in &self.views {
            let Some(mut view) = container.put(bytes) else { continue };
            if *order == 0 {
                view["target"] = json!(ELEMENT_ARRAY_BUFFER);
            } else {
                view["byteStride"] = json!(stride);
                view["target"] = json!(ARRAY_BUFFER);
            }
            places.insert(*order as u64, push(document, "bufferViews", view));
        }
        for accessor in &mut self.accessors {
            let order = accessor["bufferView"].as_u64().unwrap_or_default();
            accessor["bufferView"] = json!(places.get(&order));
        }
        document["accessors"] = json!(self.accessors);
    }
}

/// A material as its file has it.
fn look(
    material: &ModelMaterial,
    entry: &mut Json,
    document: &mut Json,
    texture: &mut dyn FnMut(&mut Json, &Option<TextureRef>) -> Option<usize>,
) {
    let exact = |values: &[f32]| -> Json { values.iter().map(|value| crate::record::short(*value)).collect() };
    let pbr = json!({
        "baseColorFactor": exact(&material.base_color_factor),
        "metallicFactor": exact(&[material.metallic_factor])[0],
        "roughnessFactor": exact(&[material.roughness_factor])[0],
    });
    entry["pbrMetallicRoughness"] = pbr;
    let highest = material.emission_factor.into_iter().fold(1.0, f32::max);
    if material.emission_factor != [0.0; 3] {
        entry["emissiveFactor"] = exact(&material.emission_factor.map(|factor| factor / highest));
    }
    if highest > 1.0 {
        entry["extensions"]["KHR_materials_emissive_strength"] = json!({ "emissiveStrength": exact(&[highest])[0] });
    }
    if material.base_color_factor[3] < 1.0 {
        entry["alphaMode"] = json!("BLEND");
    }
    if let Some(index) = texture(document, &material.base_color) {
        entry["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
    }
    if let Some(index) = texture(document, &material.emission) {
        entry["emissiveTexture"] = json!({ "index": index });
    }
}

/// The texture of a picture that glTF can hold; none for others.
fn picture(
    model: &Model,
    used: &TextureRef,
    document: &mut Json,
    container: &mut Container,
    pictures: &mut BTreeMap<usize, usize>,
) -> Option<usize> {
    let image = match pictures.get(&used.image) {
        Some(image) => *image,
        None => {
            let picture = model.images.get(used.image)?;
            let bytes = picture.bytes.as_ref().ok()?;
            let kind = match &bytes[..] {
                [0x89, b'P', b'N', b'G', ..] => "image/png",
                [0xff, 0xd8, 0xff, ..] => "image/jpeg",
                _ => return None,
            };
            let view = container.put(bytes)?;
            let view = push(document, "bufferViews", view);
            let entry = json!({ "name": picture.name, "mimeType": kind, "bufferView": view });
            *pictures.entry(used.image).or_insert(push(document, "images", entry))
        }
    };
    let wrap = used.wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Clamp => 33071,
        Wrap::Mirror => 33648,
    });
    let sampler = json!({ "wrapS": wrap[0], "wrapT": wrap[1] });
    let sampler = push(document, "samplers", sampler);
    Some(push(
        document,
        "textures",
        json!({ "sampler": sampler, "source": image }),
    ))
}
