//! Small models made in code, written as GLB.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

/// Four corners, counter-clockwise seen from outside, with texture coordinates (v grows downward).
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// Positions.
    pub corners: [[f32; 3]; 4],
    /// Texture coordinates.
    pub uvs: [[f32; 2]; 4],
}

/// A model under construction; every quad is flat and has vertices of its own.
#[derive(Clone, Debug, Default)]
pub struct MeshFile {
    /// Its faces.
    pub quads: Vec<Quad>,
    /// An encoded picture of base colors.
    pub base_color: Option<Vec<u8>>,
    /// An encoded normal map.
    pub normal: Option<Vec<u8>>,
    /// Shading normals of all corners, four for each face; `None` for those of the faces themselves.
    pub normals: Option<Vec<[f32; 3]>>,
    /// A second set of texture coordinates, four a face, that the pictures are laid out by.
    pub picture_uvs: Option<Vec<[[f32; 2]; 4]>>,
    /// Further encoded pictures, each with its position in the material's JSON: `/pbrMetallicRoughness/baseColorTexture`.
    pub textures: Vec<MadeTexture>,
    /// Further members of the material's JSON, such as factors.
    pub factors: Value,
    /// Colors of the corners, four for each face; none for a model without.
    pub colors: Vec<[f32; 4]>,
    /// Further members of the node's JSON: its placement.
    pub node: Value,
}

/// A picture of a model's material.
#[derive(Clone, Debug)]
pub struct MadeTexture {
    /// The JSON pointer of its place in the material.
    pub slot: &'static str,
    /// The encoded picture.
    pub png: Vec<u8>,
    /// Further members of the JSON at [`MadeTexture::slot`]: a strength, a transform.
    pub info: Value,
    /// JSON of the sampler: the wrap modes.
    pub sampler: Value,
}

/// A model on disk, for as long as this lives.
pub struct MadeMesh {
    // Removed when this is dropped.
    _folder: TempDir,
    path: PathBuf,
}

impl MadeMesh {
    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// The two chunks of a GLB while they grow.
struct Chunks {
    json: Value,
    bytes: Vec<u8>,
}

impl Chunks {
    fn push(&mut self, list: &str, member: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(member);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("bufferViews", view)
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let accessor =
            json!({ "bufferView": view, "componentType": 5126, "count": values.len(), "type": format!("VEC{N}") });
        self.push("accessors", accessor)
    }

    fn made_texture(&mut self, made: &MadeTexture) -> Value {
        let mut place = self.texture(&made.png, 0);
        let sampler = self.push("samplers", made.sampler.clone());
        let last = self.json["textures"]
            .as_array_mut()
            .and_then(|textures| textures.last_mut());
        last.expect("a texture")["sampler"] = json!(sampler);
        merge(&mut place, &made.info);
        place
    }

    fn texture(&mut self, png: &[u8], set: u32) -> Value {
        let view = self.view(png);
        let image = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        json!({ "index": self.push("textures", json!({ "source": image })), "texCoord": set })
    }

    fn glb(mut self) -> Vec<u8> {
        self.json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = b"glTF".to_vec();
        for word in [2, 28 + text.len() + self.bytes.len(), text.len()] {
            file.extend((word as u32).to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(&text);
        file.extend((self.bytes.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(&self.bytes);
        file
    }
}

/// Merges `from` into `into`. Values in `from` have priority.
fn merge(into: &mut Value, from: &Value) {
    match from {
        Value::Object(members) => {
            for (name, member) in members {
                merge(&mut into[name], member);
            }
        }
        Value::Null => {}
        other => *into = other.clone(),
    }
}

fn normal([a, b, c, _]: [[f32; 3]; 4]) -> [f32; 3] {
    let [a, b, c] = [a, b, c].map(glam::Vec3::from);
    (b - a).cross(c - a).normalize().to_array()
}

impl MeshFile {
    /// A model of these faces.
    pub fn new(quads: Vec<Quad>) -> MeshFile {
        MeshFile {
            quads,
            ..MeshFile::default()
        }
    }

    /// The file's bytes.
    pub fn glb(&self) -> Vec<u8> {
        let mut file = Chunks {
            json: json!({
                "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
                "bufferViews": [], "accessors": [], "images": [], "textures": [], "samplers": [],
                "extensionsUsed": ["KHR_texture_transform", "KHR_materials_emissive_strength"],
            }),
            bytes: Vec::new(),
        };
        merge(&mut file.json["nodes"][0], &self.node);
        let positions: Vec<[f32; 3]> = self.quads.iter().flat_map(|quad| quad.corners).collect();
        let flat = || self.quads.iter().flat_map(|quad| [normal(quad.corners); 4]).collect();
        let normals: Vec<[f32; 3]> = self.normals.clone().unwrap_or_else(flat);
        let uvs: Vec<[f32; 2]> = self.quads.iter().flat_map(|quad| quad.uvs).collect();
        let indices: Vec<u16> = (0..self.quads.len() as u16)
            .flat_map(|quad| [0, 1, 2, 0, 2, 3].map(|corner| 4 * quad + corner))
            .collect();
        let mut attributes = json!({
            "POSITION": file.floats(&positions), "NORMAL": file.floats(&normals), "TEXCOORD_0": file.floats(&uvs),
        });
        if let Some(uvs) = &self.picture_uvs {
            attributes["TEXCOORD_1"] = json!(file.floats(uvs.as_flattened()));
        }
        if !self.colors.is_empty() {
            attributes["COLOR_0"] = json!(file.floats(&self.colors));
        }
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = file.view(&bytes);
        let accessor = json!({ "bufferView": view, "componentType": 5123, "count": indices.len(), "type": "SCALAR" });
        let indices = file.push("accessors", accessor);
        let mut material = json!({ "name": "made", "pbrMetallicRoughness": {} });
        let set = u32::from(self.picture_uvs.is_some());
        if let Some(png) = &self.base_color {
            material["pbrMetallicRoughness"]["baseColorTexture"] = file.texture(png, set);
        }
        if let Some(png) = &self.normal {
            material["normalTexture"] = file.texture(png, set);
        }
        merge(&mut material, &self.factors);
        for made in &self.textures {
            let texture = file.made_texture(made);
            let (parent, name) = made.slot.rsplit_once('/').expect("a JSON pointer");
            let place = material.pointer_mut(parent).expect("a place in the material");
            merge(&mut place[name], &texture);
        }
        file.json["materials"] = json!([material]);
        file.json["meshes"] =
            json!([{ "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }] }]);
        for list in ["images", "textures", "samplers"] {
            if file.json[list].as_array().is_some_and(Vec::is_empty) {
                file.json.as_object_mut().expect("an object").remove(list);
            }
        }
        file.glb()
    }

    /// Writes the file to a folder of its own.
    pub fn write(&self) -> MadeMesh {
        let folder = tempfile::tempdir().expect("a folder for a model");
        let path = folder.path().join("made.glb");
        fs::write(&path, self.glb()).expect("the model's file");
        MadeMesh { _folder: folder, path }
    }
}
