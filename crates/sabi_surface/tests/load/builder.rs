//! Small glTF files, made in code.

use sabi_surface::load::{LoadError, LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::{Value, json};

pub(crate) const I8: u32 = 5120;
pub(crate) const U8: u32 = 5121;
pub(crate) const I16: u32 = 5122;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// Change to a file under construction.
pub(crate) type GltfEdit = fn(&mut Gltf);

/// A file under construction; `json` may be edited at will.
#[derive(Clone, Debug)]
pub(crate) struct Gltf {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

/// Little-endian bytes.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Little-endian bytes.
pub(crate) fn shorts(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

impl Gltf {
    /// A file without anything in it.
    pub(crate) fn new() -> Gltf {
        let json = json!({
            "asset": { "version": "2.0" }, "buffers": [{ "byteLength": 0 }], "bufferViews": [], "accessors": [],
            "meshes": [], "nodes": [], "materials": [], "textures": [], "images": [], "samplers": []
        });
        Gltf {
            json,
            bytes: Vec::new(),
        }
    }

    /// The content of a GLB file.
    pub(crate) fn of_glb(file: &[u8]) -> Gltf {
        let size = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        let text = 20 + size(12);
        Gltf {
            json: serde_json::from_slice(&file[20..text]).unwrap(),
            bytes: file[text + 8..][..size(text)].to_vec(),
        }
    }

    /// One triangle in the plane z = 0, with UVs; node and mesh are called `leaf`.
    pub(crate) fn triangle() -> Gltf {
        let mut file = Gltf::new();
        let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let uvs = file.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
        file.place(
            "leaf",
            json!({ "attributes": { "POSITION": positions, "TEXCOORD_0": uvs } }),
        );
        file
    }

    /// Adds a member to one of the lists and gives its index.
    pub(crate) fn push(&mut self, list: &str, member: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(member);
        list.len() - 1
    }

    /// Adds bytes and a view of them.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.json["buffers"][0]["byteLength"] = json!(self.bytes.len());
        self.push(
            "bufferViews",
            json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }),
        )
    }

    /// Adds an accessor over a view of its own.
    pub(crate) fn accessor(&mut self, component: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({ "bufferView": view, "componentType": component, "type": shape, "count": count });
        self.push("accessors", accessor)
    }

    /// Adds an accessor of floats.
    pub(crate) fn floats(&mut self, shape: &str, values: &[f32]) -> usize {
        let parts = shape.strip_prefix("VEC").map_or(1, |parts| parts.parse().unwrap());
        self.accessor(F32, shape, values.len() / parts, &floats(values))
    }

    /// Adds a mesh of one primitive and a root node that shows it.
    pub(crate) fn place(&mut self, name: &str, primitive: Value) -> usize {
        let mesh = self.push("meshes", json!({ "name": name, "primitives": [primitive] }));
        self.push("nodes", json!({ "name": name, "mesh": mesh }))
    }

    /// The first primitive.
    pub(crate) fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// The file as GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = b"glTF".to_vec();
        for word in [2, 12 + 8 + text.len() + 8 + self.bytes.len(), text.len()] {
            file.extend((word as u32).to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(&text);
        file.extend((self.bytes.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(&self.bytes);
        file
    }

    /// Loads it with nothing beside it.
    pub(crate) fn load(&self) -> Result<Model, LoadError> {
        self.load_with(&LoadOptions::default())
    }

    /// Loads it with nothing beside it.
    pub(crate) fn load_with(&self, options: &LoadOptions) -> Result<Model, LoadError> {
        load_bytes("test.glb", &self.glb(), &mut nothing, options)
    }

    /// Loads what must be good, and checks what every model promises.
    pub(crate) fn model(&self) -> Model {
        let model = self.load().unwrap();
        crate::promises::check(&model);
        model
    }
}

/// No file stands beside the model.
pub(crate) fn nothing(_: &str) -> Result<Vec<u8>, String> {
    Err("there is no such file".into())
}
