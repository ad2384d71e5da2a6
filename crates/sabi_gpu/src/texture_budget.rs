//! Limit of the textures of a run, and its cause.

/// Maximum number of bytes of the textures of a run, including those of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureBudget {
    /// A budget for textures alone.
    Textures(u64),
    /// Memory of the process that the model leaves, for drivers that keep textures in it.
    Process(u64),
}

impl TextureBudget {
    /// Bytes.
    pub fn bytes(self) -> u64 {
        match self {
            TextureBudget::Textures(bytes) | TextureBudget::Process(bytes) => bytes,
        }
    }
}
