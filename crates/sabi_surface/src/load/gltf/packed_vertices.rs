//! Vertices and triangles of primitives that are packed.

use std::collections::BTreeMap;

use gltf::json;
use json::validation::Checked;
use serde_json::Value;

use super::document::DRACO;
use super::draco::{PrimitiveSize, UnpackedMesh};
use super::source::GltfSource;
use crate::load::error::{ModelFault, damaged};

/// The extension of a primitive, where it is packed.
pub(super) fn extension(primitive: &json::mesh::Primitive) -> Option<&Value> {
    primitive.extensions.as_ref()?.others.get(DRACO)
}

impl GltfSource<'_> {
    /// Unpacks the primitive `label`; `None` if it is not packed, or if the file has the same data unpacked.
    pub(super) fn unpacked_mesh(
        &self,
        primitive: &json::mesh::Primitive,
        claim: PrimitiveSize,
        label: &str,
    ) -> Result<Option<UnpackedMesh>, ModelFault> {
        let Some(extension) = extension(primitive).filter(|_| self.needs_unpacking(primitive)) else {
            return Ok(None);
        };
        let view = extension.get("bufferView").and_then(Value::as_u64);
        let view = view.and_then(|view| usize::try_from(view).ok());
        let (Some(view), Some(ids)) = (view, extension.get("attributes")) else {
            return damaged(format!("{label} has no `bufferView` or no `attributes` in its {DRACO}"));
        };
        let mut attribute_of = BTreeMap::new();
        for (semantic, accessor) in &primitive.attributes {
            let Checked::Valid(semantic) = semantic else { continue };
            let id = ids.get(semantic.to_string()).and_then(Value::as_u64);
            if let Some(id) = id.and_then(|id| u32::try_from(id).ok()) {
                attribute_of.insert(accessor.value(), id);
            }
        }
        let bytes = self.buffers.view(self.document, view)?;
        UnpackedMesh::unpack(bytes, attribute_of, claim, label).map(Some)
    }

    /// Returns true if the packed data is needed. Files that do not require the extension also have all data unpacked.
    fn needs_unpacking(&self, primitive: &json::mesh::Primitive) -> bool {
        let mut accessors = primitive.attributes.values().chain(&primitive.indices);
        let is_plain = |index: &json::Index<json::Accessor>| {
            let accessor = self.document.accessors.get(index.value());
            accessor.is_some_and(|accessor| accessor.buffer_view.is_some())
        };
        self.document.requires(DRACO) || !accessors.all(is_plain)
    }
}
