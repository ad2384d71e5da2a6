//! Permitted storage of vertex attributes: the tables of glTF 2.0 (3.7.2.1) and KHR_mesh_quantization.

use gltf::json::accessor::ComponentType;

/// Meaning of an accessor's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AccessorSemantic {
    Position,
    /// A normal or a tangent.
    Direction,
    TextureCoordinate,
    Color,
    /// A 4 × 4 matrix, column by column.
    Matrix,
}

/// Validity of the storage of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    /// Permitted by glTF.
    Plain,
    /// Permitted by KHR_mesh_quantization.
    Quantized,
    /// Permitted by glTF only with `normalized`, which is missing.
    Unmarked,
    /// Not interpretable.
    Forbidden,
}

impl AccessorSemantic {
    /// Returns the validity of a component type with its `normalized` mark.
    pub(super) fn storage(self, component: ComponentType, normalized: bool) -> Storage {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        match (self, component) {
            (_, F32) => Storage::Plain,
            (_, U32) | (AccessorSemantic::Matrix, _) => Storage::Forbidden,
            (AccessorSemantic::Color, U8 | U16) if normalized => Storage::Plain,
            (AccessorSemantic::Color, U8 | U16) => Storage::Unmarked,
            (AccessorSemantic::TextureCoordinate, U8 | U16) if normalized => Storage::Plain,
            (AccessorSemantic::Position | AccessorSemantic::TextureCoordinate, _) => Storage::Quantized,
            (AccessorSemantic::Direction, I8 | I16) if normalized => Storage::Quantized,
            (AccessorSemantic::Direction, I8 | I16) => Storage::Unmarked,
            (AccessorSemantic::Direction | AccessorSemantic::Color, _) => Storage::Forbidden,
        }
    }

    /// Plural in messages.
    pub(super) fn plural(self) -> &'static str {
        match self {
            AccessorSemantic::Position => "positions",
            AccessorSemantic::Direction => "normals and tangents",
            AccessorSemantic::TextureCoordinate => "texture coordinates",
            AccessorSemantic::Color => "colors",
            AccessorSemantic::Matrix => "matrices",
        }
    }
}

/// Returns the stored number that means 1 where numbers are normalized.
pub(super) fn largest(component: ComponentType) -> f32 {
    match component {
        ComponentType::I8 => 127.0,
        ComponentType::U8 => 255.0,
        ComponentType::I16 => 32767.0,
        ComponentType::U16 => 65535.0,
        ComponentType::U32 => u32::MAX as f32,
        ComponentType::F32 => 1.0,
    }
}
