//! The bytes of buffer views, with every range checked against the length of its buffer.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_files::{Uri, find_beside};

use super::Resolve;
use super::document::GltfDocument;
use super::meshopt::{BufferRange, PackedView};
use crate::load::error::{ModelFault, damaged};
use crate::load::warnings::Warnings;

/// All buffers of a file. A missing buffer is a fault only when it is read.
pub(super) struct Buffers<'a> {
    buffers: Vec<Result<Bytes<'a>, ModelFault>>,
    /// Packed buffer views, by number.
    packed: BTreeMap<usize, PackedView>,
    unpacked_bytes: u64,
}

/// Maximum unpacked size of all packed buffer views together: the vertices and indices of the largest model.
const MOST_UNPACKED_BYTES: u64 = 8 << 30;

/// Bytes of the file itself, decoded bytes, or bytes that were read once for all buffers that refer to the same file.
#[derive(Clone)]
enum Bytes<'a> {
    Whole(Cow<'a, [u8]>),
    Shared(Arc<[u8]>),
}

impl Bytes<'_> {
    fn get(&self) -> &[u8] {
        match self {
            Bytes::Whole(bytes) => bytes,
            Bytes::Shared(bytes) => bytes,
        }
    }
}

/// Elements of equal size at a constant stride.
#[derive(Clone, Copy)]
pub(super) struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    /// The bytes of each element, in order.
    pub(super) fn iter(self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.count).map(move |index| &self.bytes[index * self.stride..][..self.size])
    }
}

impl<'a> Buffers<'a> {
    /// Reads the buffers that the views of the file use. Unpacked data takes at most `memory_bytes`.
    pub(super) fn gather(
        document: &GltfDocument,
        binary: Option<&'a [u8]>,
        resolve: &mut Resolve,
        memory_bytes: u64,
        warnings: &mut Warnings,
    ) -> Result<Buffers<'a>, ModelFault> {
        let views = document.views.iter().enumerate();
        let packed: BTreeMap<usize, PackedView> = views
            .filter_map(|(index, view)| Some((index, PackedView::of(view, index)?)))
            .collect();
        let plain = document.views.iter().map(|view| view.buffer.value());
        let used: BTreeSet<usize> = plain.chain(packed.values().map(PackedView::buffer)).collect();
        let mut fetched = BTreeMap::new();
        let buffers: Vec<Result<Bytes, ModelFault>> = document
            .buffers
            .iter()
            .enumerate()
            .map(|(index, buffer)| match (&buffer.uri, binary) {
                // This buffer is not read.
                _ if !used.contains(&index) => Ok(Bytes::Whole(Cow::Borrowed(&[]))),
                (Some(uri), _) => fetch(uri, index, &mut fetched, resolve),
                (None, Some(binary)) if index == 0 => Ok(Bytes::Whole(Cow::Borrowed(binary))),
                (None, _) => damaged(format!("buffers[{index}] names no file and is not the binary chunk")),
            })
            .collect();
        for (index, (claimed, bytes)) in document.buffers.iter().zip(&buffers).enumerate() {
            let (claimed, there) = (
                claimed.byte_length.0,
                bytes.as_ref().map_or(0, |bytes| bytes.get().len()),
            );
            if used.contains(&index) && bytes.is_ok() && claimed > there as u64 {
                warnings.add(format!(
                    "buffers[{index}] should have {claimed} bytes and has {there}: it was cut off, or it belongs to another model."
                ));
            }
        }
        let claims = packed.values().map(PackedView::claimed_bytes);
        let unpacked_bytes = claims.fold(0, u64::saturating_add);
        if unpacked_bytes > MOST_UNPACKED_BYTES {
            return damaged(format!(
                "its packed buffer views claim {unpacked_bytes} bytes together, more than the largest model has"
            ));
        }
        if unpacked_bytes > memory_bytes {
            return Err(ModelFault::memory(unpacked_bytes, memory_bytes));
        }
        Ok(Buffers {
            buffers,
            packed,
            unpacked_bytes,
        })
    }

    /// The numbers of the packed buffer views.
    pub(super) fn packed_views(&self) -> impl Iterator<Item = usize> {
        self.packed.keys().copied()
    }

    /// Returns the unpacked size that all packed buffer views declare.
    pub(super) fn unpacked_bytes(&self) -> u64 {
        self.unpacked_bytes
    }

    /// Returns the size of all buffers together, without unpacking.
    pub(super) fn total_bytes(&self) -> u64 {
        let lengths = self.buffers.iter().flatten().map(|bytes| bytes.get().len() as u64);
        lengths.sum()
    }

    /// Returns the bytes of a buffer view, unpacked. A file that does not require the extension also has the plain bytes.
    pub(super) fn view(&self, document: &GltfDocument, index: usize) -> Result<&[u8], ModelFault> {
        let Some(view) = document.views.get(index) else {
            return damaged(format!("there is no bufferViews[{index}]"));
        };
        let plain = BufferRange {
            buffer: view.buffer.value(),
            // 0 is glTF's default.
            offset: view.byte_offset.unwrap_or_default().0,
            length: view.byte_length.0,
        };
        let plain = || self.range(plain, index);
        match self.packed.get(&index) {
            None => plain(),
            Some(packed) if document.requires(packed.extension) => packed.bytes(|place| self.range(place, index)),
            Some(packed) => plain().or_else(|_| packed.bytes(|place| self.range(place, index))),
        }
    }

    /// Returns a range of a buffer; `index` is the buffer view for messages.
    fn range(&self, place: BufferRange, index: usize) -> Result<&[u8], ModelFault> {
        let BufferRange { buffer, offset, length } = place;
        let Some(bytes) = self.buffers.get(buffer) else {
            return damaged(format!(
                "bufferViews[{index}] is in buffers[{buffer}], which is not there"
            ));
        };
        let bytes = bytes.as_ref().map_err(Clone::clone)?.get();
        let range = usize::try_from(offset)
            .ok()
            .zip(usize::try_from(offset.saturating_add(length)).ok());
        match range.and_then(|(start, end)| bytes.get(start..end)) {
            Some(bytes) => Ok(bytes),
            None => damaged(format!(
                "bufferViews[{index}] takes {length} bytes from {offset} on, and buffers[{buffer}] has {} bytes",
                bytes.len()
            )),
        }
    }

    /// Returns `count` elements of `size` bytes in a buffer view. `who` describes the accessor in messages.
    pub(super) fn elements(
        &self,
        document: &GltfDocument,
        who: &str,
        view: usize,
        offset: u64,
        size: usize,
        count: u64,
    ) -> Result<Elements<'_>, ModelFault> {
        let bytes = self.view(document, view)?;
        let stride = document.views[view].byte_stride.map_or(size, |stride| stride.0);
        if stride < size {
            return damaged(format!("{who} has elements of {size} bytes, {stride} bytes apart"));
        }
        let needed = match count {
            0 => 0,
            _ => u128::from(offset) + (u128::from(count) - 1) * stride as u128 + size as u128,
        };
        if needed > bytes.len() as u128 {
            return damaged(format!(
                "{who} needs {needed} bytes, and bufferViews[{view}] has {}",
                bytes.len()
            ));
        }
        // Both fit into usize, since they are within the bytes.
        let bytes = if count == 0 { &[] } else { &bytes[offset as usize..] };
        Ok(Elements {
            bytes,
            stride,
            size,
            count: count as usize,
        })
    }
}

fn fetch<'a>(
    uri: &str,
    index: usize,
    fetched: &mut BTreeMap<String, Result<Arc<[u8]>, ModelFault>>,
    resolve: &mut Resolve,
) -> Result<Bytes<'a>, ModelFault> {
    let fault = |reason| ModelFault::NoBuffer {
        uri: uri.chars().take(80).collect(),
        reason,
    };
    match Uri::parse(uri) {
        Uri::Data(bytes) => Ok(Bytes::Whole(Cow::Owned(bytes))),
        Uri::Damaged(reason) => damaged(format!("buffers[{index}]: {reason}")),
        Uri::Unusable(reason) => Err(fault(reason)),
        Uri::Beside(path) => fetched
            .entry(path.to_string())
            .or_insert_with(|| find_beside(uri, &path, resolve).map_err(fault))
            .clone()
            .map(Bytes::Shared),
    }
}
