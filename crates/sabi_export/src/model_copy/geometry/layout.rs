//! Layout of the elements of an accessor.

use serde_json::Value as Json;

/// Types of components.
const I8: u64 = 5120;
const U8: u64 = 5121;
const I16: u64 = 5122;
const U16: u64 = 5123;
const U32: u64 = 5125;
const F32: u64 = 5126;

/// Layout of the elements of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementLayout {
    component: u64,
    /// Bytes of an element; columns of matrices begin at multiples of four bytes.
    pub(super) size: usize,
    /// Bytes from one element to the next in a buffer view of vertices: a multiple of four.
    pub(super) stride: usize,
    /// Number of elements.
    pub(super) count: usize,
    /// Components of a column, and the number of columns.
    shape: [usize; 2],
}

impl ElementLayout {
    /// The layout of an accessor; `None` if it has none of glTF.
    pub(super) fn of(accessor: &Json) -> Option<ElementLayout> {
        let width = ElementLayout::component_size(&accessor["componentType"])?;
        let [rows, columns] = match accessor["type"].as_str()? {
            "SCALAR" => [1, 1],
            "VEC2" => [2, 1],
            "VEC3" => [3, 1],
            "VEC4" => [4, 1],
            "MAT2" => [2, 2],
            "MAT3" => [3, 3],
            "MAT4" => [4, 4],
            _ => return None,
        };
        let column = rows * width;
        let size = match columns {
            1 => column,
            columns => column.next_multiple_of(4) * columns,
        };
        Some(ElementLayout {
            component: accessor["componentType"].as_u64()?,
            size,
            stride: size.next_multiple_of(4),
            count: usize::try_from(accessor["count"].as_u64()?).ok()?,
            shape: [rows, columns],
        })
    }

    /// Bytes of a component.
    pub(super) fn component_size(component: &Json) -> Option<usize> {
        match component.as_u64()? {
            I8 | U8 => Some(1),
            I16 | U16 => Some(2),
            U32 | F32 => Some(4),
            _ => None,
        }
    }

    /// Least and largest value of each component over elements at their stride; `None` without any.
    pub(super) fn bounds(&self, bytes: &[u8]) -> Option<[Vec<f64>; 2]> {
        let [rows, columns] = self.shape;
        let width = self.size.div_ceil(columns);
        let mut bounds: Option<[Vec<f64>; 2]> = None;
        for element in bytes.chunks_exact(self.stride) {
            let values: Vec<f64> = (0..columns)
                .flat_map(|column| (0..rows).map(move |row| (column, row)))
                .map(|(column, row)| self.value(&element[column * width..], row))
                .collect();
            let [low, high] = bounds.get_or_insert_with(|| [values.clone(), values.clone()]);
            for (at, value) in values.into_iter().enumerate() {
                low[at] = low[at].min(value);
                high[at] = high[at].max(value);
            }
        }
        bounds
    }

    /// A component of a column, as the file stores it.
    fn value(&self, column: &[u8], row: usize) -> f64 {
        let word = |size: usize| {
            let bytes = column.iter().skip(row * size).take(size).rev();
            bytes.fold(0_u32, |number, byte| number << 8 | u32::from(*byte))
        };
        match self.component {
            I8 => f64::from(word(1) as u8 as i8),
            U8 => f64::from(word(1)),
            I16 => f64::from(word(2) as u16 as i16),
            U16 => f64::from(word(2)),
            U32 => f64::from(word(4)),
            _ => f64::from(f32::from_bits(word(4))),
        }
    }
}
