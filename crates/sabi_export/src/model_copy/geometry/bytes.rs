//! Elements of accessors as the bytes that the file stores.

use std::collections::BTreeMap;
use std::path::Path;

use sabi_files::Uri;
use sabi_surface::load::named_file;
use serde_json::Value as Json;

use super::layout::ElementLayout;
use crate::model_copy::container::Container;

/// Buffers of a file besides the binary chunk.
pub(in crate::model_copy) struct FileBytes {
    buffers: BTreeMap<usize, Vec<u8>>,
}

/// Extensions under which a buffer view has no plain bytes.
const COMPRESSIONS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl FileBytes {
    /// Reads the buffers that the file at `path` names; those that cannot be read are left out.
    pub(in crate::model_copy) fn read(path: &Path, document: &Json) -> FileBytes {
        let list = document["buffers"].as_array();
        let buffers = list.into_iter().flatten().enumerate().filter_map(|(index, buffer)| {
            let uri = buffer["uri"].as_str()?;
            let bytes = match Uri::parse(uri) {
                Uri::Data(bytes) => bytes,
                _ => named_file(path, uri)?.ok()?.0,
            };
            Some((index, bytes))
        });
        FileBytes {
            buffers: buffers.collect(),
        }
    }

    /// Returns the bytes of the elements of an accessor, each `layout.stride` long. The error is a clause.
    pub(super) fn gather(
        &self,
        document: &Json,
        container: &Container,
        accessor: usize,
        elements: &[u32],
    ) -> Result<(Vec<u8>, ElementLayout), String> {
        let stored = self.stored(document, container, accessor)?;
        let layout = stored.layout;
        let sparse = stored.sparse.iter().map(|(place, value)| (*place, *value));
        let sparse: BTreeMap<u32, &[u8]> = sparse.collect();
        let mut bytes = vec![0; elements.len() * layout.stride];
        for (element, target) in elements.iter().zip(bytes.chunks_exact_mut(layout.stride)) {
            let plain = || stored.base?.element(*element as usize, layout.size);
            if *element as usize >= layout.count {
                return Err(format!("accessors[{accessor}] has no element {element}"));
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
        accessor: usize,
        last: u32,
    ) -> Result<(), String> {
        let stored = self.stored(document, container, accessor)?;
        match (last as usize) < stored.layout.count {
            true => Ok(()),
            false => Err(format!("accessors[{accessor}] has no element {last}")),
        }
    }

    fn stored<'b>(&'b self, document: &Json, container: &'b Container, accessor: usize) -> Result<Stored<'b>, String> {
        let unreadable = || format!("accessors[{accessor}] cannot be read");
        let json = document["accessors"].get(accessor).ok_or_else(unreadable)?;
        let layout = ElementLayout::of(json).ok_or_else(unreadable)?;
        let run = |part: &Json, size: usize, count: usize| self.run(document, container, part, size, count);
        let base = match json.get("bufferView") {
            Some(_) => Some(run(json, layout.size, layout.count).map_err(|why| why.unwrap_or_else(unreadable))?),
            None => None,
        };
        let mut sparse = Vec::new();
        if let Some(part) = json.get("sparse") {
            let count = part["count"].as_u64().and_then(|count| usize::try_from(count).ok());
            let count = count.filter(|count| *count <= layout.count).ok_or_else(unreadable)?;
            let width = ElementLayout::component_size(&part["indices"]["componentType"]).ok_or_else(unreadable)?;
            let places = run(&part["indices"], width, count).map_err(|why| why.unwrap_or_else(unreadable))?;
            let values = run(&part["values"], layout.size, count).map_err(|why| why.unwrap_or_else(unreadable))?;
            for at in 0..count {
                let place = places.element(at, width).ok_or_else(unreadable)?;
                let place = place
                    .iter()
                    .rev()
                    .fold(0, |number, byte| number << 8 | u32::from(*byte));
                sparse.push((place, values.element(at, layout.size).ok_or_else(unreadable)?));
            }
        }
        Ok(Stored { base, sparse, layout })
    }

    /// The elements that an accessor or a part of it refers to. The error says why there are none, where that has a reason.
    fn run<'b>(
        &'b self,
        document: &Json,
        container: &'b Container,
        part: &Json,
        size: usize,
        count: usize,
    ) -> Result<Run<'b>, Option<String>> {
        let number = |of: &Json, key: &str| of.get(key)?.as_u64().and_then(|at| usize::try_from(at).ok());
        let view = number(part, "bufferView").and_then(|view| document["bufferViews"].get(view));
        let view = view.ok_or(None)?;
        if let Some(name) = COMPRESSIONS
            .iter()
            .find(|name| view["extensions"].get(**name).is_some())
        {
            return Err(Some(format!("its vertices are compressed ({name})")));
        }
        let found = || {
            let buffer = number(view, "buffer")?;
            let bytes = match container.binary_chunk() {
                Some(binary) if buffer == 0 => binary,
                _ => self.buffers.get(&buffer)?,
            };
            // 0 is glTF's default.
            let offset = number(view, "byteOffset").unwrap_or(0);
            let bytes = bytes.get(offset..)?.get(..number(view, "byteLength")?)?;
            let bytes = bytes.get(number(part, "byteOffset").unwrap_or(0)..)?;
            let stride = number(view, "byteStride").unwrap_or(size);
            let needed = count.checked_sub(1)?.checked_mul(stride)?.checked_add(size)?;
            (needed <= bytes.len()).then_some(Run { bytes, stride })
        };
        found().ok_or(None)
    }
}

/// Bytes of an accessor.
struct Stored<'b> {
    base: Option<Run<'b>>,
    /// Elements that replace others.
    sparse: Vec<(u32, &'b [u8])>,
    layout: ElementLayout,
}

/// Elements at a constant stride.
#[derive(Clone, Copy)]
struct Run<'b> {
    bytes: &'b [u8],
    stride: usize,
}

impl<'b> Run<'b> {
    fn element(self, index: usize, size: usize) -> Option<&'b [u8]> {
        self.bytes.get(index.checked_mul(self.stride)?..)?.get(..size)
    }
}
