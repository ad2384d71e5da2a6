//! New vertex data on its way into a file.

use std::collections::HashMap;

use sabi_files::data_uri;
use serde_json::{Value as Json, json};

use super::bytes::{FileBytes, OfPrimitive};
use crate::model_copy::CopiedFile;
use crate::model_copy::companions::BUFFER_TYPE;
use crate::model_copy::container::Container;
use crate::model_copy::edit::{push, remove};
use crate::model_copy::picture_slots::uri_of;

const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Arrays of a file that are new, in one run of bytes.
#[derive(Default)]
pub(super) struct NewArrays {
    bytes: Vec<u8>,
    /// Their buffer views, whose offsets are those in `bytes` so far.
    views: Vec<usize>,
    /// Numbers of lists of vertices.
    lists: HashMap<Vec<u32>, usize>,
    /// Gathered accessors, by accessor, packed primitive and list.
    gathered: HashMap<(usize, Option<[usize; 2]>, usize), usize>,
}

impl NewArrays {
    fn view(&mut self, document: &mut Json, bytes: &[u8], stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let target = if stride.is_some() {
            ARRAY_BUFFER
        } else {
            ELEMENT_ARRAY_BUFFER
        };
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        view["target"] = json!(target);
        self.bytes.extend_from_slice(bytes);
        let view = push(document, "bufferViews", view);
        self.views.push(view);
        view
    }

    /// Adds a vertex attribute.
    pub(super) fn floats<const N: usize>(&mut self, document: &mut Json, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values
            .as_flattened()
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(document, &bytes, Some(4 * N));
        let accessor = json!({
            "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": format!("VEC{N}")
        });
        push(document, "accessors", accessor)
    }

    /// Adds the corners of triangles.
    pub(super) fn indices(&mut self, document: &mut Json, corners: &[[u32; 3]]) -> usize {
        let corners = corners.as_flattened();
        // The largest number of a type begins a new strip.
        let is_short = corners.iter().all(|corner| *corner < u32::from(u16::MAX));
        let (component, bytes): (u32, Vec<u8>) = match is_short {
            true => {
                let shorts = corners.iter().flat_map(|corner| (*corner as u16).to_le_bytes());
                (UNSIGNED_SHORT, shorts.collect())
            }
            false => {
                let words = corners.iter().flat_map(|corner| corner.to_le_bytes());
                (UNSIGNED_INT, words.collect())
            }
        };
        let view = self.view(document, &bytes, None);
        let accessor = json!({
            "bufferView": view, "componentType": component, "count": corners.len(), "type": "SCALAR"
        });
        push(document, "accessors", accessor)
    }

    /// Number of a list of vertices, for [`NewArrays::gather`].
    pub(super) fn list(&mut self, vertices: Vec<u32>) -> usize {
        let next = self.lists.len();
        *self.lists.entry(vertices).or_insert(next)
    }

    /// Adds an accessor with the elements of another one, byte for byte. The error is a clause.
    pub(super) fn gather(
        &mut self,
        document: &mut Json,
        file: &FileBytes,
        container: &Container,
        of: OfPrimitive,
        vertices: &[u32],
        list: usize,
    ) -> Result<usize, String> {
        let packed = file.is_unpacked(of.primitive).then_some(of.primitive);
        let key = (of.accessor, packed, list);
        if let Some(known) = self.gathered.get(&key) {
            return Ok(*known);
        }
        let (bytes, layout) = file.gather(document, container, of, vertices)?;
        let mut json = document["accessors"][of.accessor].clone();
        for key in ["byteOffset", "sparse"] {
            remove(&mut json, key);
        }
        if (json.get("min").is_some() || json.get("max").is_some())
            && let Some([low, high]) = layout.bounds(&bytes)
        {
            (json["min"], json["max"]) = (json!(low), json!(high));
        }
        json["count"] = json!(vertices.len());
        json["bufferView"] = json!(self.view(document, &bytes, Some(layout.stride)));
        let new = push(document, "accessors", json);
        self.gathered.insert(key, new);
        Ok(new)
    }

    /// Puts the bytes into the binary chunk, or into a buffer of its own: the file of that, by the name that `name` chooses, or a
    /// data URI where there is no choice.
    pub(super) fn finish(
        self,
        document: &mut Json,
        container: &mut Container,
        name: Option<&dyn Fn() -> String>,
    ) -> Option<CopiedFile> {
        if self.bytes.is_empty() {
            return None;
        }
        let (buffer, start, file) = match container.put(&self.bytes) {
            Some(view) => (0, view["byteOffset"].as_u64().unwrap_or(0), None),
            None => {
                let bytes = self.bytes;
                let mut buffer = json!({ "byteLength": bytes.len() });
                let name = name.map(|name| name());
                buffer["uri"] = match &name {
                    Some(name) => json!(uri_of(name)),
                    None => json!(data_uri(BUFFER_TYPE, &bytes)),
                };
                let file = name.map(|name| CopiedFile { name, bytes });
                (push(document, "buffers", buffer), 0, file)
            }
        };
        for view in self.views {
            let view = &mut document["bufferViews"][view];
            let offset = view["byteOffset"].as_u64().unwrap_or(0);
            (view["buffer"], view["byteOffset"]) = (json!(buffer), json!(start + offset));
        }
        file
    }
}
