//! Writes a GLB file from a loaded model, for formats other than glTF and for vertices that cannot be split: one mesh for
//! each part, with one primitive for each of its materials.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::{Mesh, Model, TextureRef};
use serde_json::{Map, Value as Json, json};

use super::container::Container;
use super::edit::{push, remove};
use super::extensions;
use super::material::{CopiedTextures, write_material};
use super::tiles::{MaterialTiles, in_tile};
use crate::SetKey;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Keys of a material that control how it is drawn, not its appearance.
const DRAWN: [&str; 3] = ["alphaMode", "alphaCutoff", "doubleSided"];
/// Highest number of a UV set up to which gaps are filled. No known file has more.
pub(super) const MOST_SETS: u32 = 16;

/// Triangles by material, and tile where the material has several.
type TrianglesBySet = BTreeMap<(u32, Option<SetKey>), Vec<[u32; 3]>>;

/// A loaded model that is written as glTF.
pub(super) struct MeshCopy<'m> {
    pub(super) model: &'m Model,
    /// Materials that get maps, and so no textures and factors of the model.
    pub(super) baked: &'m BTreeSet<u32>,
    /// `TEXCOORD` number of the mesh's texture coordinates.
    pub(super) uv_set: u32,
    /// The model's file if it is glTF: its settings for drawing materials are kept.
    pub(super) file: Option<&'m Json>,
    pub(super) tiles: &'m MaterialTiles,
}

impl MeshCopy<'_> {
    /// Places of the materials of UDIM tiles in the document.
    pub(super) fn tile_places(&self) -> BTreeMap<SetKey, usize> {
        let further = self.tiles.further().zip(self.model.materials.len()..);
        further.map(|(key, place)| (*key, place)).collect()
    }

    /// The document and its container. `warnings` gets a sentence for each picture of materials without maps that glTF cannot
    /// hold.
    pub(super) fn glb(&self, warnings: &mut Vec<String>) -> (Container, Json) {
        let mut document = json!({
            "asset": { "version": "2.0", "generator": concat!("Sabi ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [] }],
            "buffers": [{ "byteLength": 0 }],
        });
        let mut container = Container::glb(Vec::new());
        self.add_meshes(&mut document, &mut container);
        self.add_materials(&mut document, &mut container, warnings);
        extensions::keep_lists_true(&mut document, &BTreeSet::new());
        (container, document)
    }

    fn add_meshes(&self, document: &mut Json, container: &mut Container) {
        let model = self.model;
        let places = self.tile_places();
        let mut arrays = Arrays::default();
        for (part, sets) in self.primitives() {
            let name = model.parts.get(part as usize).map_or("", String::as_str);
            let primitives = sets.into_iter().map(|((material, tile), triangles)| {
                let moved = tile.map(|key| self.moved_uvs(key));
                let own = moved.as_deref().unwrap_or(&model.mesh.uvs);
                let uvs = uv_sets(&model.mesh, own, self.uv_set);
                let mut primitive = arrays.primitive(&model.mesh, &uvs, &triangles);
                let place = tile.and_then(|key| places.get(&key).copied());
                primitive["material"] = json!(place.unwrap_or(material as usize));
                primitive
            });
            let primitives: Vec<Json> = primitives.collect();
            let mesh = push(document, "meshes", json!({ "name": name, "primitives": primitives }));
            let node = push(document, "nodes", node(name, mesh, model.middle));
            push(&mut document["scenes"][0], "nodes", json!(node));
        }
        arrays.finish(document, container);
    }

    /// Groups the triangles by part and set.
    fn primitives(&self) -> BTreeMap<u32, TrianglesBySet> {
        let mesh = &self.model.mesh;
        let mut parts: BTreeMap<u32, TrianglesBySet> = BTreeMap::new();
        let of = mesh.triangle_part.iter().zip(&mesh.triangle_material);
        for (triangle, (corners, (part, material))) in mesh.triangles.iter().zip(of).enumerate() {
            let set = (*material, self.tiles.of_triangle(mesh, triangle));
            parts.entry(*part).or_default().entry(set).or_default().push(*corners);
        }
        parts
    }

    /// Texture coordinates in the unit square of a tile.
    fn moved_uvs(&self, key: SetKey) -> Vec<[f32; 2]> {
        let uvs = self.model.mesh.uvs.iter();
        uvs.map(|uv| in_tile(*uv, key.uv_tile)).collect()
    }

    fn add_materials(&self, document: &mut Json, container: &mut Container, warnings: &mut Vec<String>) {
        let model = self.model;
        let mut textures = CopiedTextures::new(model);
        for (index, material) in model.materials.iter().enumerate() {
            let mut entry = Json::Object(Map::new());
            if !material.name.is_empty() {
                entry["name"] = json!(material.name);
            }
            if !self.baked.contains(&(index as u32)) {
                let mut place = |used: &Option<TextureRef>| textures.place(used.as_ref()?, document, container);
                write_material(material, &mut entry, &mut place);
                textures.leave_unpacked(material);
            }
            if let (Some(file), Some(place)) = (self.file, material.file_index) {
                for key in DRAWN {
                    match file["materials"][place].get(key) {
                        Some(drawn) => entry[key] = drawn.clone(),
                        None => remove(&mut entry, key),
                    }
                }
            }
            push(document, "materials", entry);
        }
        for key in self.tiles.further() {
            let entry = document["materials"][key.material as usize].clone();
            push(document, "materials", entry);
        }
        warnings.extend(textures.warnings());
    }
}

/// Returns a node at the model's position.
fn node(name: &str, mesh: usize, middle: [f64; 3]) -> Json {
    let mut node = json!({ "name": name, "mesh": mesh });
    if middle != [0.0; 3] {
        node["translation"] = json!(middle);
    }
    node
}

/// Texture coordinates by their number.
type UvSets<'m> = BTreeMap<u32, &'m [[f32; 2]]>;

/// Returns all sets of the mesh, with its `own` as number `uv_set`. glTF requires consecutive numbers from 0: sets of the
/// file that were not loaded are replaced by the mesh's own set.
fn uv_sets<'m>(mesh: &'m Mesh, own: &'m [[f32; 2]], uv_set: u32) -> UvSets<'m> {
    if own.is_empty() {
        return UvSets::new();
    }
    let mut sets: UvSets = (0..uv_set.min(MOST_SETS)).map(|set| (set, own)).collect();
    sets.extend(mesh.texture_uvs.iter().map(|other| (other.set, &other.uvs[..])));
    sets.insert(uv_set, own);
    sets
}

/// Vertex data on its way into buffer views: indices first, then one view for each attribute.
#[derive(Default)]
struct Arrays {
    /// Bytes and element size of each view, in order.
    views: BTreeMap<u64, (Vec<u8>, usize)>,
    accessors: Vec<Json>,
}

/// Orders of the views; those of texture coordinates follow, by their numbers.
const INDICES: u64 = 0;
const POSITION: u64 = 1;
const NORMAL: u64 = 2;
const TANGENT: u64 = 3;
const COLOR: u64 = 4;
const TEXCOORD: u64 = 5;

impl Arrays {
    /// Adds the vertices that the triangles use, in the order of their first use.
    fn primitive(&mut self, mesh: &Mesh, sets: &UvSets<'_>, triangles: &[[u32; 3]]) -> Json {
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
        let indices = self.add(INDICES, words.flatten().collect(), 4, count, UNSIGNED_INT);
        let mut attributes = Map::new();
        self.attribute(&mut attributes, POSITION, "POSITION", &mesh.positions, &used);
        self.attribute(&mut attributes, NORMAL, "NORMAL", &mesh.normals, &used);
        self.attribute(&mut attributes, TANGENT, "TANGENT", &mesh.tangents, &used);
        self.attribute(&mut attributes, COLOR, "COLOR_0", &mesh.colors, &used);
        let mut placed: Vec<(&[[f32; 2]], Json)> = Vec::new();
        for (&set, &uvs) in sets {
            let name = format!("TEXCOORD_{set}");
            if let Some((_, accessor)) = placed.iter().find(|(other, _)| std::ptr::eq(*other, uvs)) {
                attributes.insert(name, accessor.clone());
                continue;
            }
            self.attribute(&mut attributes, TEXCOORD + u64::from(set), &name, uvs, &used);
            placed.extend(attributes.get(&name).map(|accessor| (uvs, accessor.clone())));
        }
        json!({ "attributes": attributes, "indices": indices })
    }

    fn attribute<const N: usize>(
        &mut self,
        attributes: &mut Map<String, Json>,
        order: u64,
        name: &str,
        values: &[[f32; N]],
        used: &[usize],
    ) {
        if values.is_empty() {
            return;
        }
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
        let accessor = self.add(order, bytes, 4 * N, used.len(), FLOAT);
        if order == POSITION {
            // The only attribute for which this is required. The values are written as f64, so that they are exactly those stored.
            self.accessors[accessor]["min"] = json!(low.map(f64::from).to_vec());
            self.accessors[accessor]["max"] = json!(high.map(f64::from).to_vec());
        }
        attributes.insert(name.into(), json!(accessor));
    }

    fn add(&mut self, order: u64, bytes: Vec<u8>, stride: usize, count: usize, component: u32) -> usize {
        let (held, _) = self.views.entry(order).or_insert_with(|| (Vec::new(), stride));
        // The number of the view is known only after all views are created.
        self.accessors.push(json!({
            "bufferView": order, "byteOffset": held.len(), "componentType": component, "count": count,
            "type": match stride / 4 { 1 => "SCALAR", 2 => "VEC2", 3 => "VEC3", _ => "VEC4" },
        }));
        held.extend_from_slice(&bytes);
        self.accessors.len() - 1
    }

    fn finish(mut self, document: &mut Json, container: &mut Container) {
        let mut places = BTreeMap::new();
        for (order, (bytes, stride)) in &self.views {
            let Some(mut view) = container.put(bytes) else { continue };
            if *order == INDICES {
                view["target"] = json!(ELEMENT_ARRAY_BUFFER);
            } else {
                view["byteStride"] = json!(stride);
                view["target"] = json!(ARRAY_BUFFER);
            }
            places.insert(*order, push(document, "bufferViews", view));
        }
        for accessor in &mut self.accessors {
            // An accessor of a view that was not stored refers to none.
            let place = accessor["bufferView"].as_u64().and_then(|order| places.get(&order));
            accessor["bufferView"] = json!(place);
        }
        document["accessors"] = json!(self.accessors);
    }
}
