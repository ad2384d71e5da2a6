//! Parameters of a kind: their names and places in memory.

use super::ParamType;

/// One member of `struct Params`.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Name in WGSL and in graph files.
    pub name: String,
    /// Name shown to artists: `@label`, or the name with spaces and a capital.
    pub label: String,
    /// The doc comment without its annotations.
    pub doc: String,
    /// Values it takes, and how they are written.
    pub ty: ParamType,
    /// Byte offset in `struct Params`, from naga.
    pub offset: u32,
    /// [`ParamType::default`] as components.
    pub default: ParamValue,
    /// True if a loop's bound depends on it, so that the linked kernel clamps it to its range.
    pub bounds_a_loop: bool,
    /// Earlier names (`@was`).
    pub formerly: Vec<String>,
}

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
    /// No memory: a text, which only kinds implemented in Rust can read.
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
}

/// Meaning of a parameter to an artist, which decides how its values are written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// A number or a vector of numbers.
    Plain,
    /// `@toggle`: on or off; `u32` 1 or 0, `true` or `false` in files.
    Toggle,
    /// `@choice a b c`: the index of the word; the word in files.
    Choice(Vec<String>),
    /// `@color`: `vec3f` linear; `"#rrggbb"` (sRGB) in files.
    Color,
    /// `@length`: model units after fitting.
    Length,
    /// `@angle`: degrees in files, radians in WGSL.
    Angle,
    /// `@seed`: a whole number; WGSL receives it hashed with the seeds of the document and the groups around.
    Seed,
    /// Gradient stops: `[[position, "#rrggbb"], …]` in files; linear RGB with the position in `w` in WGSL, where unused
    /// stops have position 2.
    Stops,
    /// `@curve`: `[[x, y], …]` in files; in WGSL x, y, slope and 1 if the point is used. See [`crate::curve_points`].
    Curve,
    /// A text, only in kinds implemented in Rust.
    Text,
    /// The path of a file, relative to the file in which the node was written; only in kinds implemented in Rust.
    File,
    /// `@extent low along` or `@extent high along`: not an artist's parameter; filled with the lowest or highest
    /// `dot(vertex, normalize(along))` over the model's vertices, `along` being another parameter.
    Extent {
        /// Name of the parameter that holds the direction.
        along: String,
        /// `high` rather than `low`.
        high: bool,
    },
}

impl Role {
    /// Word for the values it takes, as `sabi nodes` shows it.
    pub fn name(&self) -> &'static str {
        match self {
            Role::Plain | Role::Extent { .. } => "number",
            Role::Toggle => "toggle",
            Role::Choice(_) => "choice",
            Role::Color => "color",
            Role::Length => "length",
            Role::Angle => "angle",
            Role::Seed => "seed",
            Role::Stops => "stops",
            Role::Curve => "curve",
            Role::Text => "text",
            Role::File => "file",
        }
    }

    /// Words of a choice.
    pub fn choices(&self) -> Option<&[String]> {
        match self {
            Role::Choice(words) => Some(words),
            _ => None,
        }
    }
}

/// A parameter's value as components: numbers in artist's units, colors linear.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// One to four floats, or `4 × N` for stops (`r g b position`, unused positions 2) and curves (`x y slope used`).
    Floats(Vec<f32>),
    /// A whole number: `u32`, toggle or choice index.
    Unsigned(u32),
    /// A signed whole number.
    Signed(i32),
    /// A text or a path.
    Text(String),
}
