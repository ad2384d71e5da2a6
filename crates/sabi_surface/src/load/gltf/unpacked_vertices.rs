//! Packed vertices of a file in the form in which its accessors would store them.

use std::collections::BTreeMap;

use gltf::json;
use json::validation::Checked;

use super::Resolve;
use super::buffers::Buffers;
use super::document::GltfDocument;
use super::draco::{PrimitiveSize, UnpackedMesh};
use super::source::GltfSource;
use crate::load::LoadOptions;
use crate::load::error::ModelFault;
use crate::load::warnings::Warnings;

/// Packed vertices of a glTF file as plain bytes.
#[derive(Debug, Default)]
pub struct UnpackedVertices {
    /// Bytes of packed buffer views.
    pub views: BTreeMap<usize, Vec<u8>>,
    /// Elements of accessors without gaps, by mesh, primitive and accessor.
    pub elements: BTreeMap<[usize; 3], Vec<u8>>,
}

/// Unpacks all buffer views and primitives that are packed.
pub(in crate::load) fn unpack(bytes: &[u8], resolve: &mut Resolve) -> Result<UnpackedVertices, ModelFault> {
    // The warnings were reported when the model was read.
    let warnings = &mut Warnings::default();
    let (document, binary) = GltfDocument::parse(bytes, u64::MAX, warnings)?;
    let buffers = Buffers::gather(&document, binary, resolve, u64::MAX, warnings)?;
    let LoadOptions {
        uv_set,
        scene,
        smooth_degrees,
        ..
    } = LoadOptions::default();
    let source = GltfSource {
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
            let claim = PrimitiveSize {
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
            let places = source.float_weights(primitive).map(|accessor| [mesh, number, accessor]);
            let weights = places.filter_map(|place| unpacked.elements.remove_entry(&place));
            let (places, mut weights): (Vec<_>, Vec<_>) = weights.unzip();
            normalize_weights(&mut weights);
            unpacked.elements.extend(places.into_iter().zip(weights));
        }
    }
    Ok(unpacked)
}

impl GltfSource<'_> {
    /// Returns the accessors of the weights of a primitive that are floats. Integers are packed without loss.
    fn float_weights(&self, primitive: &json::mesh::Primitive) -> impl Iterator<Item = usize> {
        let is_float =
            move |accessor: &usize| self.document.accessors.get(*accessor).is_some() && !self.is_integer(*accessor);
        let attributes = primitive.attributes.iter();
        let weights = attributes.filter(|(name, _)| matches!(name, Checked::Valid(json::mesh::Semantic::Weights(_))));
        weights.map(|(_, accessor)| accessor.value()).filter(is_float)
    }

    /// The elements of an accessor; `None` where they are not packed.
    fn stored_elements(&self, vertices: &UnpackedMesh, index: usize) -> Result<Option<Vec<u8>>, ModelFault> {
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

/// Bytes of four weights of a vertex.
const WEIGHTS: usize = 16;

/// Scales the weights of each vertex so that their sum is 1, as required by glTF 2.0, 3.7.3.3. Packing rounds them.
fn normalize_weights(sets: &mut [Vec<u8>]) {
    let weights = |vertex: &[u8]| -> Vec<f32> {
        let (words, _) = vertex.as_chunks();
        words.iter().map(|word| f32::from_le_bytes(*word)).collect()
    };
    let mut sums: Vec<f32> = Vec::new();
    for set in sets.iter() {
        sums.resize(sums.len().max(set.len() / WEIGHTS), 0.0);
        for (sum, vertex) in sums.iter_mut().zip(set.chunks_exact(WEIGHTS)) {
            *sum += weights(vertex).iter().sum::<f32>();
        }
    }
    for set in sets {
        for (sum, vertex) in sums.iter().zip(set.chunks_exact_mut(WEIGHTS)) {
            if sum.is_finite() && *sum > 0.0 {
                let scaled = weights(vertex)
                    .into_iter()
                    .flat_map(|weight| (weight / sum).to_le_bytes());
                vertex.iter_mut().zip(scaled).for_each(|(byte, new)| *byte = new);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_all_sets_of_a_vertex_add_up_to_one() {
        let bytes = |weights: &[f32]| -> Vec<u8> { weights.iter().flat_map(|weight| weight.to_le_bytes()).collect() };
        let first = bytes(&[0.5, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let second = bytes(&[0.5, 0.0, 0.0, 0.75, 0.0, 0.0, 0.0, 0.0]);
        let mut sets = [first, second];
        normalize_weights(&mut sets);
        let [first, second] = sets;
        assert_eq!(first, bytes(&[0.25, 0.125, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        assert_eq!(
            second,
            bytes(&[0.25, 0.0, 0.0, 0.375, 0.0, 0.0, 0.0, 0.0]),
            "no weight at all stays"
        );
    }
}
