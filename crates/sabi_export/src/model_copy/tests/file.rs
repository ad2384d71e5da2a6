//! Files whose vertex data a test lays out itself.

use super::super::container::tests::glb;
use super::*;

pub(super) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const F32: u32 = 5126;

/// A file that grows.
pub(super) struct GltfFile {
    pub(super) json: Json,
    bytes: Vec<u8>,
}

impl GltfFile {
    pub(super) fn new() -> GltfFile {
        let json = json!({
            "asset": { "version": "2.0" }, "buffers": [{}], "bufferViews": [], "accessors": [], "meshes": [],
            "materials": [{ "name": "wood" }], "nodes": [], "scene": 0, "scenes": [{ "nodes": [] }],
        });
        let bytes = Vec::new();
        GltfFile { json, bytes }
    }

    pub(super) fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend_from_slice(bytes);
        edit::push(&mut self.json, "bufferViews", view)
    }

    pub(super) fn accessor(&mut self, view: usize, offset: usize, component: u32, kind: &str, count: usize) -> usize {
        let accessor = json!({
            "bufferView": view, "byteOffset": offset, "componentType": component, "type": kind, "count": count
        });
        edit::push(&mut self.json, "accessors", accessor)
    }

    pub(super) fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(&floats(values.as_flattened()), None);
        let accessor = self.accessor(view, 0, F32, &format!("VEC{N}"), values.len());
        if N == 3 {
            let axis = |at: usize| values.iter().map(move |value| value[at]);
            let least: Vec<f32> = (0..3).map(|at| axis(at).fold(f32::INFINITY, f32::min)).collect();
            let most: Vec<f32> = (0..3).map(|at| axis(at).fold(f32::NEG_INFINITY, f32::max)).collect();
            self.json["accessors"][accessor]["min"] = json!(least);
            self.json["accessors"][accessor]["max"] = json!(most);
        }
        accessor
    }

    pub(super) fn indices(&mut self, corners: &[u16]) -> usize {
        let view = self.view(
            corners
                .iter()
                .flat_map(|at| at.to_le_bytes())
                .collect::<Vec<u8>>()
                .as_slice(),
            None,
        );
        self.accessor(view, 0, U16, "SCALAR", corners.len())
    }

    /// Adds a mesh and a node that shows it.
    pub(super) fn mesh(&mut self, primitives: &[Json]) {
        let mesh = edit::push(&mut self.json, "meshes", json!({ "primitives": primitives }));
        self.node(json!({ "mesh": mesh }));
    }

    pub(super) fn node(&mut self, node: Json) {
        let node = edit::push(&mut self.json, "nodes", node);
        edit::push(&mut self.json["scenes"][0], "nodes", json!(node));
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(self.bytes.len());
        glb(&json, &self.bytes)
    }
}

pub(super) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
