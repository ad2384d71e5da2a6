//! Ways to take the grain out of means over rays.

/// Neighbors of a place whose means over rays are alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Denoise {
    /// Those whose triangles face alike: for what changes at every edge of the model.
    Triangles,
    /// Those whose shading faces alike: for what an edge with smooth shading does not show in.
    Shading,
}

impl Denoise {
    /// Expression of the normal that tells it, at a place.
    pub(crate) fn normal(self) -> &'static str {
        match self {
            Denoise::Triangles => "at.face_normal",
            Denoise::Shading => "at.normal",
        }
    }
}
