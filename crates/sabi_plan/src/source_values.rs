//! Parameter values of sources, in the units that WGSL receives.

use std::collections::BTreeMap;
use std::fmt;

use sabi_nodes::kind::{Param, ParamValue, Role};

use crate::packing::ParamPacking;

/// Error of a source that reads a parameter that its kind does not declare with that type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoSuchValue {
    name: String,
    ty: &'static str,
}

impl NoSuchValue {
    fn new(name: &str, ty: &'static str) -> NoSuchValue {
        NoSuchValue {
            name: name.to_owned(),
            ty,
        }
    }
}

impl fmt::Display for NoSuchValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let NoSuchValue { name, ty } = self;
        write!(f, "its kind declares no {ty} '{name}'; this is a defect of Sabi")
    }
}

impl std::error::Error for NoSuchValue {}

/// Parameter values of a source by name: angles in radians, lengths in working units, seeds hashed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceValues(BTreeMap<String, ParamValue>);

impl SourceValues {
    /// `values` has one entry for each of `params`, in artist's units.
    pub(crate) fn new(params: &[Param], values: &[ParamValue], packing: &ParamPacking<'_>) -> SourceValues {
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

    /// Value of a number, length or angle.
    pub fn number(&self, name: &str) -> Result<f32, NoSuchValue> {
        self.numbers::<1>(name).map(|[number]| number)
    }

    /// Components of a vector.
    pub fn numbers<const N: usize>(&self, name: &str) -> Result<[f32; N], NoSuchValue> {
        let missing = || NoSuchValue::new(name, if N == 1 { "number" } else { "vector of that length" });
        match self.0.get(name) {
            Some(ParamValue::Floats(numbers)) => numbers.as_slice().try_into().map_err(|_| missing()),
            _ => Err(missing()),
        }
    }

    /// Index of the chosen word, or a whole number.
    pub fn index(&self, name: &str) -> Result<usize, NoSuchValue> {
        match self.0.get(name) {
            Some(ParamValue::Unsigned(index)) => Ok(*index as usize),
            _ => Err(NoSuchValue::new(name, "choice or whole number")),
        }
    }

    /// A text or a path as it was written.
    pub fn text(&self, name: &str) -> Result<&str, NoSuchValue> {
        match self.0.get(name) {
            Some(ParamValue::Text(text)) => Ok(text),
            _ => Err(NoSuchValue::new(name, "text")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_read_by_its_name_and_type_and_nothing_else_has_one() {
        let values = SourceValues(BTreeMap::from([
            ("size".to_owned(), ParamValue::Floats(vec![2.0])),
            ("file".to_owned(), ParamValue::Text("rust.png".to_owned())),
        ]));
        assert_eq!(values.number("size"), Ok(2.0));
        assert_eq!(values.text("file"), Ok("rust.png"));
        assert_eq!(
            values.number("sise").map_err(|error| error.to_string()),
            Err("its kind declares no number 'sise'; this is a defect of Sabi".to_owned())
        );
        assert!(values.numbers::<2>("size").is_err() && values.index("size").is_err() && values.text("size").is_err());
    }
}
