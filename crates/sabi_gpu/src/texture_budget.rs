//! Limit of the textures of a run, and what sets it.

/// Most bytes of the textures of a run, those of the surface included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureBudget {
    /// A budget of their own.
    Textures(u64),
    /// What a model leaves of the memory of the process, where the driver keeps textures in it.
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
