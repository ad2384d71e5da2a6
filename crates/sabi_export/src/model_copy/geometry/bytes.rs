//! Elements of accessors as the bytes that the file stores.

use std::collections::BTreeMap;
use std::sync::Arc;

use sabi_files::{Uri, canonical};
use sabi_surface::load::{UnpackedVertices, named_file, unpacked_vertices};
use serde_json::Value as Json;

use super::layout::ElementLayout;
use crate::model_copy::CopySource;
use crate::model_copy::container::{Container, PACKED};
use crate::model_copy::extensions;

/// Extension of primitives that are packed.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// Bytes of a file besides the binary chunk.
pub(in crate::model_copy) struct FileBytes {
    buffers: BTreeMap<usize, Arc<Vec<u8>>>,
    unpacked: UnpackedVertices,
}

/// An accessor of a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfPrimitive {
    pub(super) accessor: usize,
    /// Its mesh, and its number there.
    pub(super) primitive: [usize; 2],
}

impl FileBytes {
    /// Reads the buffers to which the `file` of a model refers, and unpacks packed data. Unreadable data is left out. A
    /// file with several spellings of its path is kept once.
    pub(in crate::model_copy) fn read(source: CopySource<'_>, file: &[u8], document: &Json) -> FileBytes {
        let CopySource { path, model, .. } = source;
        let list = document["buffers"].as_array();
        let mut held = BTreeMap::new();
        let buffers = list.into_iter().flatten().enumerate().filter_map(|(index, buffer)| {
            let uri = buffer["uri"].as_str()?;
            let bytes = match Uri::parse(uri) {
                Uri::Data(bytes) => Arc::new(bytes),
                _ => {
                    let (bytes, place) = named_file(path, model, uri)?.ok()?;
                    let file = canonical(&place).ok()?;
                    held.entry(file).or_insert_with(|| Arc::new(bytes)).clone()
                }
            };
            Some((index, bytes))
        });
        let is_packed = extensions::present(document)
            .iter()
            .any(|name| name == DRACO || PACKED.contains(&name.as_str()));
        let unpacked = is_packed.then(|| unpacked_vertices(path, model, file).ok()).flatten();
        FileBytes {
            buffers: buffers.collect(),
            // A file that is not packed has nothing to unpack.
            unpacked: unpacked.unwrap_or_default(),
        }
    }

    /// Returns true if the vertices of a primitive were packed by Draco and could be unpacked.
    pub(super) fn is_unpacked(&self, [mesh, primitive]: [usize; 2]) -> bool {
        let all = [mesh, primitive, 0]..=[mesh, primitive, usize::MAX];
        self.unpacked.elements.range(all).next().is_some()
    }

    /// Returns the bytes of the elements of an accessor, each `layout.stride` long. The error is a clause.
    pub(super) fn gather(
        &self,
        document: &Json,
        container: &Container,
        of: OfPrimitive,
        elements: &[u32],
    ) -> Result<(Vec<u8>, ElementLayout), String> {
        let stored = self.stored(document, container, of)?;
        let layout = stored.layout;
        let sparse = stored.sparse.iter().map(|(place, value)| (*place, *value));
        let sparse: BTreeMap<u32, &[u8]> = sparse.collect();
        let mut bytes = vec![0; elements.len() * layout.stride];
        for (element, target) in elements.iter().zip(bytes.chunks_exact_mut(layout.stride)) {
            let plain = || stored.base?.element(*element as usize, layout.size);
            if *element as usize >= layout.count {
                return Err(format!("accessors[{}] has no element {element}", of.accessor));
            }
            // An accessor without a view is zero where it is not sparse (glTF 2.0, 3.6.2.3).
            if let Some(source) = sparse.get(element).copied().or_else(plain) {
                target[..layout.size].copy_from_slice(source);
            }
        }
        Ok((bytes, layout))
    }

    /// Checks that an accessor has plain bytes for elements up to `last`. The error is a clause.
    pub(super) fn check(
        &self,
        document: &Json,
        container: &Container,
        of: OfPrimitive,
        last: u32,
    ) -> Result<(), String> {
        let stored = self.stored(document, container, of)?;
        match (last as usize) < stored.layout.count {
            true => Ok(()),
            false => Err(format!("accessors[{}] has no element {last}", of.accessor)),
        }
    }

    fn stored<'b>(
        &'b self,
        document: &Json,
        container: &'b Container,
        of: OfPrimitive,
    ) -> Result<AccessorBytes<'b>, String> {
        let OfPrimitive { accessor, primitive } = of;
        let unreadable = || format!("accessors[{accessor}] cannot be read");
        let json = document["accessors"].get(accessor).ok_or_else(unreadable)?;
        let mut layout = ElementLayout::of(json).ok_or_else(unreadable)?;
        let run = |part: &Json, size: usize, count: usize| self.run(document, container, part, size, count);
        let [mesh, number] = primitive;
        let unpacked = self.unpacked.elements.get(&[mesh, number, accessor]);
        let base = match (unpacked, json.get("bufferView")) {
            (Some(bytes), _) => {
                layout.count = bytes.len() / layout.size;
                let stride = layout.size;
                Some(StridedElements { bytes, stride })
            }
            (None, Some(_)) => Some(run(json, layout.size, layout.count).ok_or_else(unreadable)?),
            (None, None) => None,
        };
        let mut sparse = Vec::new();
        if let Some(part) = json.get("sparse") {
            let count = part["count"].as_u64().and_then(|count| usize::try_from(count).ok());
            let count = count.filter(|count| *count <= layout.count).ok_or_else(unreadable)?;
            let width = ElementLayout::component_size(&part["indices"]["componentType"]).ok_or_else(unreadable)?;
            let places = run(&part["indices"], width, count).ok_or_else(unreadable)?;
            let values = run(&part["values"], layout.size, count).ok_or_else(unreadable)?;
            for at in 0..count {
                let place = places.element(at, width).ok_or_else(unreadable)?;
                let place = place
                    .iter()
                    .rev()
                    .fold(0, |number, byte| number << 8 | u32::from(*byte));
                sparse.push((place, values.element(at, layout.size).ok_or_else(unreadable)?));
            }
        }
        Ok(AccessorBytes { base, sparse, layout })
    }

    /// The elements that an accessor or a part of it refers to.
    fn run<'b>(
        &'b self,
        document: &Json,
        container: &'b Container,
        part: &Json,
        size: usize,
        count: usize,
    ) -> Option<StridedElements<'b>> {
        let number = |of: &Json, key: &str| of.get(key)?.as_u64().and_then(|at| usize::try_from(at).ok());
        let index = number(part, "bufferView")?;
        let view = document["bufferViews"].get(index)?;
        let bytes = match self.unpacked.views.get(&index) {
            Some(unpacked) => unpacked,
            // If the view is packed, its plain bytes have no meaning.
            None if PACKED.iter().any(|name| view["extensions"].get(name).is_some()) => return None,
            None => {
                let buffer = number(view, "buffer")?;
                let bytes = match container.binary_chunk() {
                    Some(binary) if buffer == 0 => binary,
                    _ => self.buffers.get(&buffer)?.as_slice(),
                };
                // 0 is glTF's default.
                let offset = number(view, "byteOffset").unwrap_or(0);
                bytes.get(offset..)?.get(..number(view, "byteLength")?)?
            }
        };
        let bytes = bytes.get(number(part, "byteOffset").unwrap_or(0)..)?;
        let stride = number(view, "byteStride").unwrap_or(size);
        let needed = count.checked_sub(1)?.checked_mul(stride)?.checked_add(size)?;
        (needed <= bytes.len()).then_some(StridedElements { bytes, stride })
    }
}

/// Bytes of an accessor.
struct AccessorBytes<'b> {
    base: Option<StridedElements<'b>>,
    /// Elements that replace others.
    sparse: Vec<(u32, &'b [u8])>,
    layout: ElementLayout,
}

/// Elements at a constant stride.
#[derive(Clone, Copy)]
struct StridedElements<'b> {
    bytes: &'b [u8],
    stride: usize,
}

impl<'b> StridedElements<'b> {
    fn element(self, index: usize, size: usize) -> Option<&'b [u8]> {
        self.bytes.get(index.checked_mul(self.stride)?..)?.get(..size)
    }
}

#[cfg(test)]
mod tests {
    use sabi_surface::model::Model;
    use serde_json::json;

    use super::*;

    #[test]
    fn a_buffer_under_many_spellings_is_held_once() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("data.bin"), b"numbers").unwrap();
        let spellings: Vec<Json> = (0..20)
            .map(|number| json!({ "uri": format!("{}data.bin", "./".repeat(number)) }))
            .collect();
        let source = CopySource {
            path: &folder.path().join("it.gltf"),
            model: &Model::default(),
            uv_set: 0,
            unwrapped_uv_set: None,
        };
        let read = FileBytes::read(source, b"", &json!({ "buffers": spellings }));
        assert_eq!(read.buffers.len(), 20);
        assert!(read.buffers.values().all(|bytes| Arc::ptr_eq(bytes, &read.buffers[&0])));
        assert_eq!(**read.buffers[&0], *b"numbers");
    }
}
