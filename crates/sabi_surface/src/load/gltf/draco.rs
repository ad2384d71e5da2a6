//! Primitives packed by Draco: KHR_draco_mesh_compression.

use std::collections::BTreeMap;

use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute};
use gltf::json::accessor::ComponentType;

use super::storage::largest;
use crate::load::error::{ModelFault, damaged};

/// Number of vertices that a packed primitive may have in addition to those of its triangles.
const UNUSED_VERTICES: u64 = 1 << 16;
/// Number of attributes that Draco data may have in addition to those that accessors use.
const UNLISTED_ATTRIBUTES: u64 = 1;
/// Maximum size of an attribute of a vertex in bytes: four numbers of double precision.
const BYTES_OF_A_VALUE: u64 = 32;

/// The triangles and vertices of one primitive.
pub(super) struct UnpackedMesh {
    mesh: Mesh,
    /// Draco's id of the attribute that contains the data of an accessor.
    attribute_of: BTreeMap<usize, u32>,
}

/// Maximum number of triangles and vertices of a primitive.
#[derive(Clone, Copy)]
pub(super) struct PrimitiveSize {
    pub(super) triangles: u64,
    pub(super) vertices: u64,
}

impl UnpackedMesh {
    /// Unpacks the primitive `label`. `attribute_of` maps each accessor to Draco's id of its attribute.
    pub(super) fn unpack(
        bytes: &[u8],
        attribute_of: BTreeMap<usize, u32>,
        claim: PrimitiveSize,
        label: &str,
    ) -> Result<UnpackedMesh, ModelFault> {
        let PrimitiveSize { triangles, vertices } = claim;
        let of_triangles = triangles.saturating_mul(3).saturating_add(UNUSED_VERTICES);
        let attributes = attribute_of.len() as u64 + UNLISTED_ATTRIBUTES;
        let values = vertices.min(of_triangles).saturating_mul(attributes);
        let limits = DecodeLimits::default()
            .with_max_faces(triangles)
            .with_max_decoded_bytes(values.saturating_mul(BYTES_OF_A_VALUE));
        let mut mesh = Mesh::new();
        let unpacked = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
        unpacked.map_err(|error| {
            ModelFault::Damaged(match error.kind() {
                ErrorKind::LimitExceeded => format!(
                    "the Draco data of {label} has more triangles or vertices than its accessors ({triangles} and {vertices})"
                ),
                _ => format!("the Draco data of {label} cannot be unpacked ({})", error.message()),
            })
        })?;
        Ok(UnpackedMesh { mesh, attribute_of })
    }

    /// Returns the corners of the triangles of a primitive with `vertices` vertices. Draco has no strips: they were
    /// converted to triangles when the file was written.
    pub(super) fn triangles(&self, label: &str, vertices: usize) -> Result<Vec<[u32; 3]>, ModelFault> {
        let triangles: Vec<[u32; 3]> = self.mesh.faces().iter().map(|face| face.map(|point| point.0)).collect();
        match triangles
            .as_flattened()
            .iter()
            .find(|vertex| **vertex as usize >= vertices)
        {
            Some(vertex) => damaged(format!("{label} names vertex {vertex} of {vertices}")),
            None => Ok(triangles),
        }
    }

    /// Returns the elements of an accessor in the form that its type stores; `None` if they are not packed. `who` describes
    /// it in messages.
    pub(super) fn elements(
        &self,
        accessor: usize,
        who: &str,
        component: ComponentType,
        parts: usize,
        normalized: bool,
    ) -> Result<Option<Vec<u8>>, ModelFault> {
        let Some(id) = self.attribute_of.get(&accessor) else {
            return Ok(None);
        };
        let Some(attribute) = self.mesh.attribute_by_unique_id(*id) else {
            return damaged(format!("{who} is attribute {id} of its Draco data, which is not there"));
        };
        let there = usize::from(attribute.num_components());
        if there != parts {
            return damaged(format!(
                "{who} has elements of {parts} numbers, and its Draco data has elements of {there}"
            ));
        }
        let scale = scale(attribute, component, normalized);
        let numbers = attribute.read_f32s(self.mesh.num_points(), parts).into_iter();
        let words = numbers.map(|number| word(number * scale, component));
        Ok(Some(
            words.flat_map(|word| word.into_iter().take(component.size())).collect(),
        ))
    }
}

/// Returns the factor from the numbers of a Draco attribute to those of an accessor. Integers stay unchanged. Between
/// integers and floats, normalized numbers are fractions of the largest integer (glTF 2.0, 3.6.2.2).
fn scale(attribute: &PointAttribute, component: ComponentType, normalized: bool) -> f32 {
    let is_float = component == ComponentType::F32;
    match attribute.data_type() {
        DataType::Float32 | DataType::Float64 if !is_float && normalized => largest(component),
        DataType::Int8 if is_float && attribute.normalized() => 1.0 / largest(ComponentType::I8),
        DataType::Uint8 if is_float && attribute.normalized() => 1.0 / largest(ComponentType::U8),
        DataType::Int16 if is_float && attribute.normalized() => 1.0 / largest(ComponentType::I16),
        DataType::Uint16 if is_float && attribute.normalized() => 1.0 / largest(ComponentType::U16),
        _ => 1.0,
    }
}

/// Returns a number as an accessor stores it, little-endian, in the first bytes of the result.
fn word(number: f32, component: ComponentType) -> [u8; 4] {
    let whole = number.round();
    match component {
        ComponentType::F32 => number.to_bits(),
        ComponentType::I8 => u32::from(whole as i8 as u8),
        ComponentType::U8 => u32::from(whole as u8),
        ComponentType::I16 => u32::from(whole as i16 as u16),
        ComponentType::U16 => u32::from(whole as u16),
        ComponentType::U32 => whole as u32,
    }
    .to_le_bytes()
}
