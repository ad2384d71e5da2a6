//! Parameter values of sources, in the units that WGSL receives.

use std::collections::BTreeMap;

use sabi_nodes::kind::{Param, ParamValue, Role};

use crate::values::Packing;

/// Parameter values of a source by name: angles in radians, lengths in working units, seeds hashed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceValues(BTreeMap<String, ParamValue>);

impl SourceValues {
    /// `values` has one entry for each of `params`, in artist's units.
    pub(crate) fn new(params: &[Param], values: &[ParamValue], packing: &Packing<'_>) -> SourceValues {
        let named = params.iter().zip(values).map(|(param, value)| {
            let value = match (&param.ty.role, value) {
                (Role::Seed, ParamValue::Unsigned(seed)) => {
                    ParamValue::Unsigned(crate::seeds::effective(packing.seeds, *seed))
                }
                (role, ParamValue::Floats(numbers)) => {
                    let factor = packing.factor(role);
                    let scaled = numbers.iter().map(|number| (f64::from(*number) * factor) as f32);
                    ParamValue::Floats(scaled.collect())
                }
                (_, other) => other.clone(),
            };
            (param.name.clone(), value)
        });
        SourceValues(named.collect())
    }

    /// Bytes of all values and their names, for keys.
    pub(crate) fn key_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (name, value) in &self.0 {
            let (sort, content): (u8, Vec<u8>) = match value {
                ParamValue::Floats(numbers) => (0, numbers.iter().flat_map(|number| number.to_le_bytes()).collect()),
                ParamValue::Unsigned(number) => (1, number.to_le_bytes().to_vec()),
                ParamValue::Signed(number) => (2, number.to_le_bytes().to_vec()),
                ParamValue::Text(text) => (3, text.clone().into_bytes()),
            };
            for part in [name.as_bytes(), &[sort], &content] {
                bytes.extend((part.len() as u64).to_le_bytes());
                bytes.extend(part);
            }
        }
        bytes
    }

    /// A number, length or angle; 0 for any other name.
    pub fn number(&self, name: &str) -> f32 {
        self.numbers::<1>(name)[0]
    }

    /// Several numbers; zeros for a name with another number of them.
    pub fn numbers<const N: usize>(&self, name: &str) -> [f32; N] {
        match self.0.get(name) {
            // Sources name their own parameters, so that the default is never taken.
            Some(ParamValue::Floats(numbers)) => numbers.as_slice().try_into().unwrap_or([0.0; N]),
            _ => [0.0; N],
        }
    }

    /// Index of the chosen word, or a whole number; 0 for any other name.
    pub fn index(&self, name: &str) -> usize {
        match self.0.get(name) {
            Some(ParamValue::Unsigned(index)) => *index as usize,
            _ => 0,
        }
    }

    /// Returns true if a toggle is on.
    pub fn is_on(&self, name: &str) -> bool {
        self.index(name) != 0
    }

    /// A text or a path as it was written; empty for any other name.
    pub fn text(&self, name: &str) -> &str {
        match self.0.get(name) {
            Some(ParamValue::Text(text)) => text,
            _ => "",
        }
    }
}
