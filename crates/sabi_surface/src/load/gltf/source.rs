//! A glTF file and its buffers, as the readers of its parts take them.

use super::buffers::Buffers;
use super::document::Document;
use super::draco::UnpackedMesh;

/// A file with the bytes it names.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) document: &'a Document,
    pub(super) buffers: &'a Buffers<'a>,
    /// The primitive that is read, where it was packed.
    pub(super) unpacked: Option<&'a UnpackedMesh>,
    pub(super) uv_set: u32,
    /// See [`crate::load::LoadOptions::scene`].
    pub(super) scene: Option<u32>,
    /// See [`crate::load::LoadOptions::smooth_degrees`].
    pub(super) smooth_degrees: Option<f32>,
}
