//! Accessors of every valid layout, read into plain arrays.

use gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;
use sabi_cancel::CancelableIterator as _;

use super::source::GltfSource;
use super::storage::{AccessorSemantic, Storage, largest};
use crate::load::error::{ModelFault, damaged};
use crate::load::warnings::Warnings;

/// Number of elements without stored bytes that any file may have. A larger file may have one for each of its bytes.
const UNSTORED: u64 = 1 << 16;

/// An accessor with a checked type.
struct Head<'a> {
    index: usize,
    accessor: &'a json::Accessor,
    component: ComponentType,
    shape: Type,
    /// Name in messages.
    who: String,
    /// Description of the content in messages: `positions of mesh 3`.
    what: String,
}

/// Vertex numbers of corners.
pub(super) struct Indices {
    pub(super) corners: Vec<u32>,
    /// Primitive restart value (glTF 2.0, 3.7.2.1: files must not use it).
    pub(super) restart: u32,
}

impl GltfSource<'_> {
    /// Returns the maximum number of elements that an accessor may have without storing them.
    pub(super) fn most_unstored(&self) -> u64 {
        UNSTORED.max(self.buffers.total_bytes())
    }

    /// Returns the number of elements that an accessor declares.
    pub(super) fn claimed_count(&self, index: usize) -> u64 {
        self.document
            .accessors
            .get(index)
            .map_or(0, |accessor| accessor.count.0)
    }

    /// Returns true if an accessor stores integers, including normalized ones.
    pub(super) fn is_integer(&self, index: usize) -> bool {
        let accessor = self.document.accessors.get(index);
        let component = accessor.map(|accessor| accessor.component_type);
        matches!(component, Some(Checked::Valid(component)) if component.0 != ComponentType::F32)
    }

    /// Reads vectors of `N` numbers, one for each vertex. `what` describes them in messages.
    pub(super) fn floats<const N: usize>(
        &self,
        index: usize,
        meaning: AccessorSemantic,
        what: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<[f32; N]>, ModelFault> {
        let head = self.head(index, what)?;
        let Head {
            component, shape, who, ..
        } = &head;
        if shape.multiplicity() != N || matches!(shape, Type::Mat2) {
            return damaged(format!("{who} has elements of kind {shape:?}, not of {N} numbers"));
        }
        let marked = head.accessor.normalized;
        let normalized = match meaning.storage(*component, marked) {
            Storage::Plain => marked,
            Storage::Quantized => {
                if !self.document.requires("KHR_mesh_quantization") {
                    warnings.add(format!(
                        "The {what} are stored as {}, for which the file should require KHR_mesh_quantization; they are read all the same.",
                        kind(*component)
                    ));
                }
                marked
            }
            Storage::Unmarked => {
                warnings.add(format!(
                    "The {what} are stored as {} without the mark that fractions of 1 are meant; they are read as such.",
                    kind(*component)
                ));
                true
            }
            Storage::Forbidden => {
                return damaged(format!(
                    "{who} is stored as {}, which glTF does not allow for {}",
                    kind(*component),
                    meaning.plural()
                ));
            }
        };
        self.values(
            &head,
            N,
            [0.0; N],
            |bytes| number::<N>(bytes, *component, normalized),
            warnings,
        )
    }

    /// Vertex colors, RGB or RGBA.
    pub(super) fn colors(
        &self,
        index: usize,
        what: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<[f32; 4]>, ModelFault> {
        if self.head(index, what)?.shape == Type::Vec4 {
            return self.floats(index, AccessorSemantic::Color, what, warnings);
        }
        Ok(self
            .floats::<3>(index, AccessorSemantic::Color, what, warnings)?
            .into_iter()
            .map(|[r, g, b]| [r, g, b, 1.0])
            .collect())
    }

    /// Vertex numbers.
    pub(super) fn indices(&self, index: usize, what: &str, warnings: &mut Warnings) -> Result<Indices, ModelFault> {
        let head = self.head(index, what)?;
        let Head {
            component, shape, who, ..
        } = &head;
        if *shape != Type::Scalar {
            return damaged(format!("{who} has elements of kind {shape:?}, not single numbers"));
        }
        let restart = match component {
            ComponentType::U8 => u32::from(u8::MAX),
            ComponentType::U16 => u32::from(u16::MAX),
            ComponentType::U32 => u32::MAX,
            _ => {
                return damaged(format!(
                    "{who} is stored as {}, not as unsigned integers",
                    kind(*component)
                ));
            }
        };
        if let Some(view) = head.accessor.buffer_view {
            self.warn_of_stride(view.value(), what, warnings);
        }
        let corners = self.values(&head, 1, 0, unsigned, warnings)?;
        Ok(Indices { corners, restart })
    }

    /// Warns about a byte stride, which is allowed only for vertex attributes (glTF 2.0, 3.6.2.4).
    fn warn_of_stride(&self, view: usize, what: &str, warnings: &mut Warnings) {
        if self
            .document
            .views
            .get(view)
            .is_some_and(|view| view.byte_stride.is_some())
        {
            warnings.add(format!(
                "The {what} are stored at a distance, which glTF keeps for vertices; they are read that way."
            ));
        }
    }

    fn head(&self, index: usize, what: &str) -> Result<Head<'_>, ModelFault> {
        let who = format!("accessors[{index}] ({what})");
        let Some(accessor) = self.document.accessors.get(index) else {
            return damaged(format!("{who} is not there"));
        };
        let (Checked::Valid(component), Checked::Valid(shape)) = (accessor.component_type, accessor.type_) else {
            return damaged(format!("{who} has an unknown type or componentType"));
        };
        Ok(Head {
            index,
            accessor,
            component: component.0,
            shape,
            who,
            what: what.to_string(),
        })
    }

    /// Reads the base values, or zeros, and replaces the sparse ones.
    fn values<T: Copy>(
        &self,
        head: &Head,
        parts: usize,
        zero: T,
        read: impl Fn(&[u8]) -> T,
        warnings: &mut Warnings,
    ) -> Result<Vec<T>, ModelFault> {
        let Head {
            accessor,
            component,
            who,
            what,
            ..
        } = head;
        let size = component.size() * parts;
        let count = accessor.count.0;
        let unpacked = match self.unpacked {
            Some(mesh) => mesh.elements(head.index, who, *component, parts, accessor.normalized)?,
            None => None,
        };
        let mut values: Vec<T> = match (unpacked, accessor.buffer_view) {
            (Some(bytes), _) => {
                let there = bytes.len() / size;
                if there as u64 != count {
                    warnings.add(format!(
                        "The accessor of the {what} says {count}, and its Draco data has {there}; these are taken."
                    ));
                }
                bytes.chunks_exact(size).looking().map(&read).collect()
            }
            (None, Some(view)) => {
                // 0 is glTF's default.
                let offset = accessor.byte_offset.unwrap_or_default().0;
                let elements = self
                    .buffers
                    .elements(self.document, who, view.value(), offset, size, count)?;
                elements.iter().looking().map(&read).collect()
            }
            (None, None) if count > self.most_unstored() => {
                return damaged(format!("{who} asks for {count} elements and stores none of them"));
            }
            (None, None) => vec![zero; count as usize],
        };
        if accessor.sparse.is_some() {
            self.replace_sparse(head, size, &mut values, read, warnings)?;
        }
        Ok(values)
    }

    /// Replaces elements of `values` by the sparse elements of `size` bytes.
    fn replace_sparse<T>(
        &self,
        head: &Head,
        size: usize,
        values: &mut [T],
        read: impl Fn(&[u8]) -> T,
        warnings: &mut Warnings,
    ) -> Result<(), ModelFault> {
        let Some(sparse) = &head.accessor.sparse else {
            return Ok(());
        };
        let who = format!("the sparse part of {}", head.who);
        let what = format!("sparse {}", head.what);
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return damaged(format!("{who} has an unknown componentType"));
        };
        let (count, more) = (values.len(), sparse.count.0);
        if more > count as u64 {
            return damaged(format!("{who} replaces {more} elements of {count}"));
        }
        let (view, offset) = (sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0);
        self.warn_of_stride(view, &what, warnings);
        let places = self
            .buffers
            .elements(self.document, &who, view, offset, kind.0.size(), more)?;
        let (view, offset) = (sparse.values.buffer_view.value(), sparse.values.byte_offset.0);
        self.warn_of_stride(view, &what, warnings);
        let replaced = self.buffers.elements(self.document, &who, view, offset, size, more)?;
        let mut last = None;
        for (place, value) in places.iter().zip(replaced.iter()).looking() {
            let place = unsigned(place) as usize;
            match values.get_mut(place) {
                Some(slot) => *slot = read(value),
                None => return damaged(format!("{who} replaces element {place} of {count}")),
            }
            if last.replace(place).is_some_and(|last| last >= place) {
                warnings.add(format!(
                    "The {what} are out of order; where two meet, the later one counts."
                ));
            }
        }
        Ok(())
    }
}

/// Returns the name of a component type in messages.
fn kind(component: ComponentType) -> &'static str {
    match component {
        ComponentType::I8 => "signed bytes",
        ComponentType::U8 => "bytes",
        ComponentType::I16 => "signed 16-bit integers",
        ComponentType::U16 => "16-bit integers",
        ComponentType::U32 => "32-bit integers",
        ComponentType::F32 => "floats",
    }
}

/// A little-endian integer of 1, 2 or 4 bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |number, byte| number << 8 | u32::from(*byte))
}

/// Reads numbers. Normalized integers stand for 0..1 or -1..1, others for their own value (glTF 2.0, 3.6.2.2 and 3.11).
fn number<const N: usize>(bytes: &[u8], component: ComponentType, normalized: bool) -> [f32; N] {
    let mut parts = bytes.chunks_exact(component.size());
    // `normalized` has no effect on floats.
    std::array::from_fn(|_| {
        // An element always has bytes for all of its N components.
        let part = parts.next().unwrap_or_default();
        let raw = unsigned(part);
        let value = match component {
            ComponentType::F32 => return f32::from_bits(raw),
            ComponentType::I8 => f32::from(raw as u8 as i8),
            ComponentType::I16 => f32::from(raw as u16 as i16),
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => raw as f32,
        };
        if normalized {
            (value / largest(component)).max(-1.0)
        } else {
            value
        }
    })
}
