//! Sources: rows of numbers, which the corners of polygons index.

use sabi_cancel::CancelableIterator as _;
use std::collections::HashMap;
use std::rc::Rc;

use roxmltree::{Node, NodeId};

use super::document::{child, children, numbers};
use super::polygons::{DaeInput, Polygons};
use crate::load::faces::{Attribute, NONE};
use crate::load::warnings::Warnings;

/// Rows of numbers.
#[derive(Default)]
struct DaeSource {
    numbers: Vec<f64>,
    offset: usize,
    stride: usize,
}

impl DaeSource {
    fn read<'d>(node: Node<'d, 'd>, warnings: &mut Warnings) -> DaeSource {
        let accessor = child(node, "technique_common").and_then(|technique| child(technique, "accessor"));
        let number = |name: &str| accessor.and_then(|accessor| accessor.attribute(name)?.parse().ok());
        let parameters = accessor.map_or(1, |accessor| children(accessor, "param").count());
        DaeSource {
            numbers: child(node, "float_array")
                .map(|array| numbers(array, warnings))
                // A source of names contains no numbers.
                .unwrap_or_default(),
            offset: number("offset").unwrap_or(0),
            // Without one it is that of the parameters, whatever the format says.
            stride: number("stride").unwrap_or(parameters).max(1),
        }
    }

    fn row(&self, index: u32) -> Option<&[f64]> {
        let start = (index as usize).checked_mul(self.stride)?.checked_add(self.offset)?;
        self.numbers.get(start..start.checked_add(self.stride)?)
    }
}

/// Sources that were read, each once.
#[derive(Default)]
pub(super) struct DaeSources(HashMap<NodeId, Rc<DaeSource>>);

/// An attribute of the corners of polygons.
pub(super) struct CornerAttribute<const N: usize, T> {
    pub(super) attribute: Attribute<N, T>,
    /// An index that the source does not have, or whose row is too short. Its corners have no value.
    pub(super) beyond: Option<u32>,
}

impl DaeSources {
    /// Returns the values of an input that corners use, in the order of their first use. `value` converts a row to a value.
    pub(super) fn gathered<'d, const N: usize, T: Default>(
        &mut self,
        polygons: &Polygons<'d>,
        input: DaeInput<'d>,
        value: impl Fn(&[f64]) -> Option<[T; N]>,
        warnings: &mut Warnings,
    ) -> CornerAttribute<N, T> {
        let source = self.0.entry(input.source.id());
        let source = Rc::clone(source.or_insert_with(|| Rc::new(DaeSource::read(input.source, warnings))));
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        let mut gathered = CornerAttribute {
            attribute: Attribute::default(),
            beyond: None,
        };
        let Attribute { values, corners } = &mut gathered.attribute;
        for index in polygons.corners(input).looking() {
            corners.push(
                *numbers
                    .entry(index)
                    .or_insert_with(|| match source.row(index).and_then(&value) {
                        Some(value) => {
                            values.push(value);
                            values.len() as u32 - 1
                        }
                        None => {
                            gathered.beyond = Some(index);
                            NONE
                        }
                    }),
            );
        }
        gathered
    }
}
