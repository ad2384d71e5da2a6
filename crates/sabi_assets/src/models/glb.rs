//! Parts into the bytes of a GLB file: one buffer, a root node with the parts below it.

use std::collections::BTreeMap;

use glam::DVec3;
use serde_json::{Value, json};

use super::charted_mesh::{ModelPart, corner_normals};
use super::pack::pack;

const FLOAT: u32 = 5126;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// A model to write.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// File stem and root node.
    pub(crate) name: &'static str,
    /// Colors of its vertices by their place in the model: linear, multiplied with the material's color.
    pub(crate) paint: Option<fn(DVec3) -> [f64; 3]>,
    /// Materials of its parts; all share one sheet of texture coordinates.
    pub(crate) materials: Vec<Material>,
    /// Its pieces.
    pub(crate) parts: Vec<ModelPart>,
}

/// Material of a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    /// Its name in the file.
    pub(crate) name: &'static str,
    /// Linear base color.
    pub(crate) base_color_linear: [f64; 3],
    /// 1 for bare metal.
    pub(crate) metallic: f64,
    /// 0 is a mirror, 1 is chalk.
    pub(crate) roughness: f64,
}

impl Material {
    /// Anything but metal, rather rough.
    pub(crate) fn plain(name: &'static str, base_color_linear: [f64; 3]) -> Material {
        Material {
            name,
            base_color_linear,
            metallic: 0.0,
            roughness: 0.8,
        }
    }

    /// Bare wrought iron.
    pub(crate) fn iron() -> Material {
        Material {
            name: "iron",
            base_color_linear: [0.28, 0.27, 0.26],
            metallic: 1.0,
            roughness: 0.5,
        }
    }
}

/// A part as the file holds it.
#[derive(Clone, Debug, Default)]
pub(crate) struct IndexedMesh {
    /// In meters.
    pub(crate) positions: Vec<[f32; 3]>,
    /// Unit length.
    pub(crate) normals: Vec<[f32; 3]>,
    /// v downward.
    pub(crate) uvs: Vec<[f32; 2]>,
    /// Three for a triangle.
    pub(crate) indices: Vec<u32>,
}

/// Every part with its charts placed and equal corners joined.
pub(crate) fn index(model: &Model) -> Vec<IndexedMesh> {
    let places = pack(&model.parts);
    let parts = model.parts.iter().zip(&places);
    parts
        .map(|(part, places)| {
            let mut indexed = IndexedMesh::default();
            let mut numbers: BTreeMap<[u32; 8], u32> = BTreeMap::new();
            for (triangle, normals) in part.shape.triangles.iter().zip(corner_normals(part)) {
                for (corner, normal) in triangle.corners.iter().zip(normals) {
                    let position = rounded(corner.position);
                    let normal = rounded(normal);
                    let uv = places[triangle.chart].uv_from_sheet(corner.sheet);
                    let [x, y, z] = position.map(f32::to_bits);
                    let [nx, ny, nz] = normal.map(f32::to_bits);
                    let key = [x, y, z, nx, ny, nz, uv[0].to_bits(), uv[1].to_bits()];
                    let number = *numbers.entry(key).or_insert_with(|| {
                        indexed.positions.push(position);
                        indexed.normals.push(normal);
                        indexed.uvs.push(uv);
                        indexed.positions.len() as u32 - 1
                    });
                    indexed.indices.push(number);
                }
            }
            indexed
        })
        .collect()
}

/// To f32 by way of a tenth of a micrometer, so that the last bit of a platform's sine never shows; and no −0.
fn rounded(vector: DVec3) -> [f32; 3] {
    vector
        .to_array()
        .map(|value| ((value * 1e7).round() / 1e7) as f32 + 0.0)
}

/// The tables of a file while it grows.
#[derive(Default)]
struct Tables {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Tables {
    /// Appends a block and returns its accessor's number. Every value is four bytes or padded to it.
    fn push(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        }));
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn push_vectors<const N: usize>(&mut self, vectors: &[[f32; N]], is_position: bool) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let mut accessor = json!({ "componentType": FLOAT, "count": vectors.len(), "type": format!("VEC{N}") });
        if is_position {
            let along = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N)
                    .map(|i| vectors.iter().map(|v| v[i]).reduce(pick).unwrap_or(0.0))
                    .collect()
            };
            accessor["min"] = json!(along(f32::min));
            accessor["max"] = json!(along(f32::max));
        }
        self.push(&bytes, ARRAY_BUFFER, accessor)
    }

    fn push_colors(&mut self, colors: &[[f64; 3]]) -> usize {
        let code = |value: f64| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let bytes: Vec<u8> = colors
            .iter()
            .flat_map(|&[r, g, b]| [code(r), code(g), code(b), 255])
            .collect();
        let count = colors.len();
        let accessor = json!({ "componentType": UNSIGNED_BYTE, "normalized": true, "count": count, "type": "VEC4" });
        self.push(&bytes, ARRAY_BUFFER, accessor)
    }

    fn push_indices(&mut self, indices: &[u32], vertices: usize) -> usize {
        // The largest 16 bit number is the one glTF reserves.
        let is_short = vertices < 65_535;
        let bytes: Vec<u8> = if is_short {
            indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()
        } else {
            indices.iter().flat_map(|index| index.to_le_bytes()).collect()
        };
        let component = if is_short { UNSIGNED_SHORT } else { UNSIGNED_INT };
        let accessor = json!({ "componentType": component, "count": indices.len(), "type": "SCALAR" });
        self.push(&bytes, ELEMENT_ARRAY_BUFFER, accessor)
    }
}

/// The whole file.
pub(crate) fn encode(model: &Model) -> Vec<u8> {
    let mut tables = Tables::default();
    let mut meshes = Vec::new();
    let mut nodes = Vec::new();
    for (part, indexed) in model.parts.iter().zip(index(model)) {
        let mut attributes = json!({
            "POSITION": tables.push_vectors(&indexed.positions, true),
            "NORMAL": tables.push_vectors(&indexed.normals, false),
            "TEXCOORD_0": tables.push_vectors(&indexed.uvs, false),
        });
        if let Some(paint) = model.paint {
            let place = |position: &[f32; 3]| part.translation + part.rotation * DVec3::from(position.map(f64::from));
            let colors = indexed.positions.iter().map(|position| paint(place(position)));
            attributes["COLOR_0"] = json!(tables.push_colors(&colors.collect::<Vec<_>>()));
        }
        let indices = tables.push_indices(&indexed.indices, indexed.positions.len());
        meshes.push(json!({
            "name": part.name,
            "primitives": [{ "attributes": attributes, "indices": indices, "material": part.material }],
        }));
        nodes.push(node(part, meshes.len() - 1));
    }
    let children: Vec<usize> = (0..nodes.len()).collect();
    nodes.push(json!({ "name": model.name, "children": children }));
    let materials = model.materials.iter().map(|material| {
        let [r, g, b] = material.base_color_linear;
        let (metallic, roughness) = (material.metallic, material.roughness);
        json!({
            "name": material.name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness,
            },
        })
    });
    let document = json!({
        "asset": { "version": "2.0", "generator": "cargo xtask assets", "copyright": "The Sabi authors, MIT OR Apache-2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials.collect::<Vec<_>>(),
        "accessors": tables.accessors,
        "bufferViews": tables.views,
        "buffers": [{ "byteLength": tables.bytes.len() }],
    });
    container(&document.to_string(), &tables.bytes)
}

fn node(part: &ModelPart, mesh: usize) -> Value {
    let mut node = json!({ "name": part.name, "mesh": mesh });
    if part.translation != DVec3::ZERO {
        node["translation"] = json!(rounded(part.translation));
    }
    let rotation = part
        .rotation
        .to_array()
        .map(|value| ((value * 1e7).round() / 1e7) as f32 + 0.0);
    if rotation != [0.0, 0.0, 0.0, 1.0] {
        node["rotation"] = json!(rotation);
    }
    node
}

/// The GLB header and its two chunks.
fn container(document: &str, buffer: &[u8]) -> Vec<u8> {
    let mut text = document.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + 8 + buffer.len();
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend((total as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text.as_slice()), (b"BIN\0", buffer)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend_from_slice(chunk);
    }
    file
}
