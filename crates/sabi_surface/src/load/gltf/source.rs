//! A glTF file and its buffers, as input of the readers of its parts.

use super::buffers::Buffers;
use super::document::GltfDocument;
use super::draco::UnpackedMesh;

/// A file with the bytes to which it refers.
#[derive(Clone, Copy)]
pub(super) struct GltfSource<'a> {
    pub(super) document: &'a GltfDocument,
    pub(super) buffers: &'a Buffers<'a>,
    /// The unpacked data of the primitive that is being read, if it was packed.
    pub(super) unpacked: Option<&'a UnpackedMesh>,
    pub(super) uv_set: u32,
    /// See [`crate::load::LoadOptions::scene`].
    pub(super) scene: Option<u32>,
    /// See [`crate::load::LoadOptions::smooth_degrees`].
    pub(super) smooth_degrees: Option<f32>,
}
