//! Methods to remove noise from means over rays.

/// Selects the neighbors of a place that are averaged to denoise a mean over rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Denoise {
    /// Neighbors on triangles with similar directions: for values that change at every edge of the model.
    Triangles,
    /// Neighbors with similar shading normals: for values in which smoothly shaded edges are not visible.
    Shading,
}

impl Denoise {
    /// Returns the WGSL expression of the normal that is compared.
    pub(crate) fn normal(self) -> &'static str {
        match self {
            Denoise::Triangles => "at.face_normal",
            Denoise::Shading => "at.normal",
        }
    }
}
