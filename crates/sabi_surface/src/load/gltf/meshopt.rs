//! Buffer views packed by meshoptimizer: EXT_meshopt_compression, and KHR_meshopt_compression, which has one more filter.

use std::sync::OnceLock;

use gltf::json;
use meshoptimizer_rs::codec::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use meshoptimizer_rs::{Error, Limits, Workspace};
use serde_json::Value;

use super::document::MESHOPT;
use crate::load::error::{ModelFault, damaged};

/// Maximum number of unpacked bytes for each packed byte. A block of 256 vertices takes at least one byte for every four
/// bytes of a vertex; a triangle and an index take at least one byte each (EXT_meshopt_compression, "Bitstream").
const ATTRIBUTES_BEST_RATIO: u64 = 1024;
const TRIANGLES_BEST_RATIO: u64 = 12;
const INDICES_BEST_RATIO: u64 = 4;

/// A packed buffer view, which is unpacked when it is first read.
pub(super) struct PackedView {
    /// The extension that describes it.
    pub(super) extension: &'static str,
    packed: Result<CompressedView, ModelFault>,
    unpacked: OnceLock<Result<Vec<u8>, ModelFault>>,
}

/// Bytes of a buffer, and the form into which they are unpacked.
struct CompressedView {
    index: usize,
    place: BufferRange,
    stride: u64,
    count: u64,
    mode: MeshoptMode,
    filter: MeshoptFilter,
}

/// A range of a buffer.
#[derive(Clone, Copy)]
pub(super) struct BufferRange {
    pub(super) buffer: usize,
    pub(super) offset: u64,
    pub(super) length: u64,
}

#[derive(Clone, Copy)]
enum MeshoptMode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy)]
enum MeshoptFilter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl PackedView {
    /// Returns the packed form of a buffer view, if it has one. Its faults are reported when it is read.
    pub(super) fn of(view: &json::buffer::View, index: usize) -> Option<PackedView> {
        let others = &view.extensions.as_ref()?.others;
        let extension = MESHOPT.into_iter().find(|name| others.contains_key(*name))?;
        Some(PackedView {
            extension,
            packed: CompressedView::read(&others[extension], extension, index),
            unpacked: OnceLock::new(),
        })
    }

    /// Returns the unpacked size that the view declares.
    pub(super) fn claimed_bytes(&self) -> u64 {
        self.packed.as_ref().map_or(0, CompressedView::claimed_bytes)
    }

    /// Returns the buffer that contains the packed bytes; if it is unknown, the number of a buffer that does not exist.
    pub(super) fn buffer(&self) -> usize {
        self.packed.as_ref().map_or(usize::MAX, |packed| packed.place.buffer)
    }

    /// The unpacked bytes; `packed_bytes` returns a range of a buffer.
    pub(super) fn bytes<'p>(
        &self,
        packed_bytes: impl FnOnce(BufferRange) -> Result<&'p [u8], ModelFault>,
    ) -> Result<&[u8], ModelFault> {
        let unpacked = self.unpacked.get_or_init(|| {
            let packed = self.packed.as_ref().map_err(Clone::clone)?;
            packed.unpack(packed_bytes(packed.place)?)
        });
        unpacked.as_deref().map_err(Clone::clone)
    }
}

impl CompressedView {
    fn read(value: &Value, extension: &str, index: usize) -> Result<CompressedView, ModelFault> {
        let number = |key: &str, default: Option<u64>| match (value.get(key), default) {
            (None, Some(default)) => Ok(default),
            (given, _) => given
                .and_then(Value::as_u64)
                .ok_or_else(|| ModelFault::Damaged(format!("bufferViews[{index}] has no `{key}` in its {extension}"))),
        };
        let word = |key: &str| value.get(key).and_then(Value::as_str);
        let unknown = |key: &str| {
            damaged(format!(
                "bufferViews[{index}] has a `{key}` in its {extension} that is not known"
            ))
        };
        Ok(CompressedView {
            index,
            place: BufferRange {
                // A number that no buffer has stands for an invalid one.
                buffer: usize::try_from(number("buffer", None)?).unwrap_or(usize::MAX),
                // 0 is the extension's default.
                offset: number("byteOffset", Some(0))?,
                length: number("byteLength", None)?,
            },
            stride: number("byteStride", None)?,
            count: number("count", None)?,
            mode: match word("mode") {
                Some("ATTRIBUTES") => MeshoptMode::Attributes,
                Some("TRIANGLES") => MeshoptMode::Triangles,
                Some("INDICES") => MeshoptMode::Indices,
                _ => return unknown("mode"),
            },
            filter: match (word("filter"), extension) {
                (None, _) if value.get("filter").is_none() => MeshoptFilter::None,
                (Some("NONE"), _) => MeshoptFilter::None,
                (Some("OCTAHEDRAL"), _) => MeshoptFilter::Octahedral,
                (Some("QUATERNION"), _) => MeshoptFilter::Quaternion,
                (Some("EXPONENTIAL"), _) => MeshoptFilter::Exponential,
                (Some("COLOR"), _) if extension == MESHOPT[0] => MeshoptFilter::Color,
                _ => return unknown("filter"),
            },
        })
    }

    fn claimed_bytes(&self) -> u64 {
        self.count.saturating_mul(self.stride)
    }

    fn unpack(&self, bytes: &[u8]) -> Result<Vec<u8>, ModelFault> {
        let ratio = match self.mode {
            MeshoptMode::Attributes => ATTRIBUTES_BEST_RATIO,
            MeshoptMode::Triangles => TRIANGLES_BEST_RATIO,
            MeshoptMode::Indices => INDICES_BEST_RATIO,
        };
        let claimed = self.claimed_bytes();
        if claimed / ratio > bytes.len() as u64 {
            return damaged(format!(
                "bufferViews[{}] claims {claimed} bytes, more than its {} packed bytes can hold",
                self.index,
                bytes.len()
            ));
        }
        self.decode(bytes)
            .map_err(|error| ModelFault::Damaged(format!("bufferViews[{}] cannot be unpacked ({error})", self.index)))
    }

    fn decode(&self, bytes: &[u8]) -> Result<Vec<u8>, Error> {
        let whole = |number| usize::try_from(number).map_err(|_| Error::SizeOverflow);
        let (count, stride) = (whole(self.count)?, whole(self.stride)?);
        let workspace = &mut Workspace::new(Limits {
            // The declared size was checked, but allocators may round it up.
            max_bytes: whole(self.claimed_bytes())?.saturating_mul(2),
            max_work: u64::MAX,
        });
        let mut unpacked = match self.mode {
            MeshoptMode::Attributes => decode_vertex_buffer(count, stride, bytes, workspace)?,
            MeshoptMode::Triangles => decode_index_buffer(count, stride, bytes, workspace)?,
            MeshoptMode::Indices => decode_index_sequence(count, stride, bytes, workspace)?,
        };
        match self.filter {
            MeshoptFilter::None => {}
            MeshoptFilter::Octahedral => decode_filter_oct(&mut unpacked, count, stride, workspace)?,
            MeshoptFilter::Quaternion => decode_filter_quat(&mut unpacked, count, stride, workspace)?,
            MeshoptFilter::Exponential => decode_filter_exp(&mut unpacked, count, stride, workspace)?,
            MeshoptFilter::Color => decode_filter_color(&mut unpacked, count, stride, workspace)?,
        }
        Ok(unpacked)
    }
}
