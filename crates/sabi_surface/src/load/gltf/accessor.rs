//! Accessors: every legal layout into plain arrays.

use gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;

use super::primitive::Source;
use crate::load::error::{Fault, damaged};

/// Elements that a file may ask for without storing a byte of them.
const MOST_UNSTORED: u64 = 1 << 24;

/// The checked head of an accessor.
struct Head<'a> {
    accessor: &'a json::Accessor,
    component: ComponentType,
    shape: Type,
    /// How messages name it.
    who: String,
}

impl Source<'_> {
    /// The number of elements that an accessor claims to have.
    pub(super) fn claimed_count(&self, index: usize) -> u64 {
        self.document
            .accessors
            .get(index)
            .map_or(0, |accessor| accessor.count.0)
    }

    /// Numbers a file gives for each vertex; `N` of them, `what` in messages.
    pub(super) fn floats<const N: usize>(&self, index: usize, what: &str) -> Result<Vec<[f32; N]>, Fault> {
        let head = self.head(index, what)?;
        let Head {
            component, shape, who, ..
        } = &head;
        if shape.multiplicity() != N || matches!(shape, Type::Mat2) {
            return damaged(format!("{who} has elements of kind {shape:?}, not of {N} numbers"));
        }
        if *component == ComponentType::U32 {
            return damaged(format!(
                "{who} is stored as 32-bit integers, which glTF allows for indices alone"
            ));
        }
        let normalized = head.accessor.normalized;
        self.values(&head, N, [0.0; N], |bytes| number::<N>(bytes, *component, normalized))
    }

    /// Vertex colors, RGB or RGBA.
    pub(super) fn colors(&self, index: usize, what: &str) -> Result<Vec<[f32; 4]>, Fault> {
        if self.head(index, what)?.shape == Type::Vec4 {
            return self.floats(index, what);
        }
        Ok(self
            .floats::<3>(index, what)?
            .into_iter()
            .map(|[r, g, b]| [r, g, b, 1.0])
            .collect())
    }

    /// Vertex numbers.
    pub(super) fn indices(&self, index: usize, what: &str) -> Result<Vec<u32>, Fault> {
        let head = self.head(index, what)?;
        let Head {
            component, shape, who, ..
        } = &head;
        if *shape != Type::Scalar {
            return damaged(format!("{who} has elements of kind {shape:?}, not single numbers"));
        }
        if !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return damaged(format!("{who} is stored as {component:?}, not as unsigned integers"));
        }
        self.values(&head, 1, 0, unsigned)
    }

    fn head(&self, index: usize, what: &str) -> Result<Head<'_>, Fault> {
        let who = format!("accessors[{index}] ({what})");
        let Some(accessor) = self.document.accessors.get(index) else {
            return damaged(format!("{who} is not there"));
        };
        let (Checked::Valid(component), Checked::Valid(shape)) = (accessor.component_type, accessor.type_) else {
            return damaged(format!("{who} has an unknown type or componentType"));
        };
        Ok(Head {
            accessor,
            component: component.0,
            shape,
            who,
        })
    }

    /// Base values or zeros, with the sparse ones on top.
    fn values<T: Copy>(&self, head: &Head, parts: usize, zero: T, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>, Fault> {
        let Head {
            accessor,
            component,
            who,
            ..
        } = head;
        let size = component.size() * parts;
        let count = accessor.count.0;
        let mut values: Vec<T> = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                let elements = self
                    .buffers
                    .elements(self.document, who, view.value(), offset, size, count)?;
                elements.iter().map(&read).collect()
            }
            // Compressed vertices have their bytes elsewhere, and nothing here.
            None if accessor.sparse.is_none()
                && let Some(refused) = self.document.compression() =>
            {
                return Err(refused);
            }
            None if count > MOST_UNSTORED => {
                return damaged(format!("{who} asks for {count} elements and stores none of them"));
            }
            None => vec![zero; count as usize],
        };
        let Some(sparse) = &accessor.sparse else {
            return Ok(values);
        };
        let who = format!("the sparse part of {who}");
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return damaged(format!("{who} has an unknown componentType"));
        };
        let (view, offset) = (sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0);
        let places = self
            .buffers
            .elements(self.document, &who, view, offset, kind.0.size(), sparse.count.0)?;
        let (view, offset) = (sparse.values.buffer_view.value(), sparse.values.byte_offset.0);
        let replaced = self
            .buffers
            .elements(self.document, &who, view, offset, size, sparse.count.0)?;
        for (place, value) in places.iter().zip(replaced.iter()) {
            let place = unsigned(place) as usize;
            match values.get_mut(place) {
                Some(slot) => *slot = read(value),
                None => return damaged(format!("{who} replaces element {place} of {count}")),
            }
        }
        Ok(values)
    }
}

/// A little-endian integer of 1, 2 or 4 bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |number, byte| number << 8 | u32::from(*byte))
}

/// glTF 2.0, 3.6.2.2 and 3.11: normalized integers stand for 0..1 or -1..1, plain ones for themselves.
fn number<const N: usize>(bytes: &[u8], component: ComponentType, normalized: bool) -> [f32; N] {
    let mut parts = bytes.chunks_exact(component.size());
    std::array::from_fn(|_| {
        let part = parts.next().unwrap_or_default();
        let raw = unsigned(part);
        let (value, largest) = match component {
            ComponentType::F32 => return f32::from_bits(raw),
            ComponentType::I8 => (f32::from(raw as u8 as i8), 127.0),
            ComponentType::U8 => (raw as f32, 255.0),
            ComponentType::I16 => (f32::from(raw as u16 as i16), 32767.0),
            ComponentType::U16 => (raw as f32, 65535.0),
            ComponentType::U32 => (raw as f32, u32::MAX as f32),
        };
        if normalized { (value / largest).max(-1.0) } else { value }
    })
}
