//! Parts that a file has, taken or left out.

/// A part that a file has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePart {
    /// Its name. Several parts may have one.
    pub name: String,
    /// Reason that it is no part of the model; none for one that is.
    pub left_out: Option<LeftOut>,
    /// Name of the node above it by whose meaning it is left out; none where that is no reason.
    pub of_group: Option<String>,
    /// True if it is taken where no parts are chosen: what its name means does not leave it out.
    pub is_usual: bool,
}

/// Reason that a part of a file is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Its name, or that of a node above it, says that it is a collision hull.
    Hull,
    /// Its name, or that of a node above it, says that it is a coarser level of detail of another part.
    CoarserLevel,
    /// The choice of parts does not have it.
    Chosen,
}
