//! Memory layout of parameters, and their values as components.

/// Memory shape of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// `f32`
    F32,
    /// `u32`
    U32,
    /// `i32`
    I32,
    /// `vec2f`
    Vec2,
    /// `vec3f`
    Vec3,
    /// `vec4f`
    Vec4,
    /// `array<vec4f, N>`: gradient stops, or with `@curve` the points of a curve.
    Points(u32),
    /// No memory: a text, which only sources can read.
    Text,
}

impl Memory {
    /// Number of 32-bit components.
    pub fn components(self) -> usize {
        match self {
            Memory::F32 | Memory::U32 | Memory::I32 => 1,
            Memory::Vec2 => 2,
            Memory::Vec3 => 3,
            Memory::Vec4 => 4,
            Memory::Points(count) => 4 * count as usize,
            Memory::Text => 0,
        }
    }

    /// Returns the number of entries of a value in a file: components of a vector, or the maximum number of stops or points.
    pub(super) fn entries(self) -> usize {
        match self {
            Memory::Points(most) => most as usize,
            memory => memory.components(),
        }
    }

    /// Returns true if only whole numbers are accepted.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Memory::U32 | Memory::I32)
    }
}

/// A parameter's value as components: numbers in the units of artists, colors linear.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// Either 1 to 4 numbers, or `4 × N` for gradient stops (`r g b position`, with position 2 for unused stops) and curves
    /// (`x y slope used`).
    Floats(Vec<f32>),
    /// A whole number: `u32`, toggle or choice index.
    Unsigned(u32),
    /// A signed whole number.
    Signed(i32),
    /// A text or a path.
    Text(String),
}
