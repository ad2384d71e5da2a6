//! Converts values of parameters to the bytes that a node's WGSL reads.

use sabi_nodes::kind::{Kind, ParamValue, Role};

/// Everything that the bytes of a node depend on besides its values.
pub struct ParamPacking<'a> {
    /// Seeds of the document and of the enclosing groups, outermost first.
    pub(crate) seeds: &'a [u32],
    /// Factor from lengths as written in the graph to working units.
    pub(crate) working_from_length: f64,
    /// The same factor for lengths that are never shares of a piece.
    pub(crate) working_from_absolute: f64,
    /// Lowest and highest `dot(vertex, direction)`.
    pub(crate) extent: &'a dyn Fn([f32; 3]) -> [f32; 2],
}

impl ParamPacking<'_> {
    /// Factor from artist's units to those of kernels.
    pub(crate) fn factor(&self, role: &Role) -> f64 {
        match role {
            Role::Angle => std::f64::consts::PI / 180.0,
            Role::Length => self.working_from_length,
            _ => 1.0,
        }
    }
}

/// The bytes of `struct Params`: angles in radians, lengths in working units, seeds hashed.
///
/// `values` has one entry for each of the kind's parameters, in artist's units.
pub fn pack_params(kind: &Kind, values: &[ParamValue], packing: &ParamPacking<'_>) -> Vec<u8> {
    let mut bytes = vec![0_u8; kind.params_size as usize];
    for (param, value) in kind.params.iter().zip(values) {
        let words: Vec<[u8; 4]> = match (&param.ty.role, value) {
            (Role::Extent { along, high }, _) => {
                let extent = (packing.extent)(direction(kind, values, along));
                vec![extent[usize::from(*high)].to_le_bytes()]
            }
            (Role::Seed, ParamValue::Unsigned(seed)) => {
                vec![crate::seeds::effective(packing.seeds, *seed).to_le_bytes()]
            }
            (role, ParamValue::Floats(numbers)) => {
                let factor = match param.is_absolute {
                    true => packing.working_from_absolute,
                    false => packing.factor(role),
                };
                numbers
                    .iter()
                    .map(|number| ((f64::from(*number) * factor) as f32).to_le_bytes())
                    .collect()
            }
            (_, ParamValue::Unsigned(number)) => vec![number.to_le_bytes()],
            (_, ParamValue::Signed(number)) => vec![number.to_le_bytes()],
            (_, ParamValue::Text(_)) => Vec::new(),
        };
        for (index, word) in words.iter().enumerate() {
            let at = param.offset as usize + 4 * index;
            if let Some(place) = bytes.get_mut(at..at + 4) {
                place.copy_from_slice(word);
            }
        }
    }
    bytes
}

/// Value of a direction parameter with unit length; straight up for a zero vector.
fn direction(kind: &Kind, values: &[ParamValue], name: &str) -> [f32; 3] {
    let value = kind.params.iter().zip(values).find(|(param, _)| param.name == name);
    if let Some((_, ParamValue::Floats(numbers))) = value
        && let [x, y, z] = numbers[..]
    {
        let length = (x * x + y * y + z * z).sqrt();
        if length > 1e-12 {
            return [x / length, y / length, z / length];
        }
    }
    [0.0, 1.0, 0.0]
}
