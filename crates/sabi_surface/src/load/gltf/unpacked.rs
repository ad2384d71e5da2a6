//! Packed vertices of a file as its accessors would store them.

use std::collections::BTreeMap;

use gltf::json;
use json::validation::Checked;

use super::Resolve;
use super::buffers::Buffers;
use super::document::Document;
use super::draco::{Claim, UnpackedMesh};
use super::source::Source;
use crate::load::LoadOptions;
use crate::load::error::Fault;
use crate::load::warnings::Warnings;

/// Vertices of a glTF file that are packed there, as plain bytes.
#[derive(Debug, Default)]
pub struct UnpackedVertices {
    /// Bytes of packed buffer views.
    pub views: BTreeMap<usize, Vec<u8>>,
    /// Elements of accessors without gaps, by mesh, primitive and accessor.
    pub elements: BTreeMap<[usize; 3], Vec<u8>>,
}

/// Unpacks all buffer views and primitives that are packed.
pub(in crate::load) fn unpack(bytes: &[u8], resolve: &mut Resolve) -> Result<UnpackedVertices, Fault> {
    // They were told when the model was read.
    let warnings = &mut Warnings::default();
    let (document, binary) = Document::parse(bytes, warnings)?;
    let buffers = Buffers::gather(&document, binary, resolve, warnings)?;
    let LoadOptions {
        uv_set,
        scene,
        smooth_degrees,
        ..
    } = LoadOptions::default();
    let source = Source {
        document: &document,
        buffers: &buffers,
        unpacked: None,
        uv_set,
        scene,
        smooth_degrees,
    };
    let mut unpacked = UnpackedVertices::default();
    for view in buffers.packed_views() {
        unpacked.views.insert(view, buffers.view(&document, view)?.to_vec());
    }
    for (mesh, primitives) in document.meshes.iter().map(|mesh| &mesh.primitives).enumerate() {
        let label = document.mesh_label(mesh);
        for (number, primitive) in primitives.iter().enumerate() {
            let claim = Claim {
                triangles: source.claim(primitive),
                vertices: source.claimed_vertices(primitive),
            };
            let Some(vertices) = source.unpacked_mesh(primitive, claim, &label)? else {
                continue;
            };
            for accessor in primitive.attributes.values().map(json::Index::value) {
                if let Some(elements) = source.stored_elements(&vertices, accessor)? {
                    unpacked.elements.insert([mesh, number, accessor], elements);
                }
            }
        }
    }
    Ok(unpacked)
}

impl Source<'_> {
    /// The elements of an accessor; `None` where they are not packed.
    fn stored_elements(&self, vertices: &UnpackedMesh, index: usize) -> Result<Option<Vec<u8>>, Fault> {
        let accessor = self.document.accessors.get(index);
        let Some((accessor, Checked::Valid(component), Checked::Valid(shape))) =
            accessor.map(|accessor| (accessor, accessor.component_type, accessor.type_))
        else {
            return Ok(None);
        };
        let who = format!("accessors[{index}]");
        vertices.elements(index, &who, component.0, shape.multiplicity(), accessor.normalized)
    }
}
