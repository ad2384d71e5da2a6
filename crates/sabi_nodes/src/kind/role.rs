//! Roles of parameters.

/// Meaning of a parameter to an artist. It decides how values are written.
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
    /// `@length`: in working units. With `@absolute`, the length is never a share of a piece.
    Length,
    /// `@angle`: degrees in files, radians in WGSL.
    Angle,
    /// `@seed`: a whole number. WGSL receives it hashed with the seeds of the document and of the enclosing groups.
    Seed,
    /// Gradient stops: `[[position, "#rrggbb"], …]` in files. WGSL receives linear RGB with the position in `w`; unused
    /// stops have position 2.
    Stops,
    /// `@curve`: `[[x, y], …]` in files. WGSL receives x, y, slope, and 1 if the point is used. See [`crate::curve_points`].
    Curve,
    /// A text; only for sources.
    Text,
    /// The path of a file, relative to the file that contains the node; only for sources.
    File,
    /// `@extent low along` or `@extent high along`: not set by artists, but filled with the lowest or highest `dot(vertex,
    /// normalize(along))` over the model's vertices, where `along` is another parameter.
    Extent {
        /// Name of the parameter that holds the direction.
        along: String,
        /// True for `high`, false for `low`.
        high: bool,
    },
}

impl Role {
    /// Returns a word for the values, as shown by `sabi nodes`.
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

    /// Returns the words of a choice.
    pub fn choices(&self) -> Option<&[String]> {
        match self {
            Role::Choice(words) => Some(words),
            _ => None,
        }
    }
}
