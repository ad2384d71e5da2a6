//! Roles of parameters.

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
    /// `@length`: working units. With `@absolute` beside it the length is never a share of a piece.
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
    /// A text, only for sources.
    Text,
    /// The path of a file, relative to the file in which the node was written; only for sources.
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
