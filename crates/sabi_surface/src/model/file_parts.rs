//! Parts of a file, loaded or left out.

/// A part of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePart {
    /// Name, which several parts may share.
    pub name: String,
    /// Reason why it is not a part of the model; `None` if it is.
    pub left_out: Option<ExclusionReason>,
    /// Name of the node above it by whose meaning it is left out; none where that is no reason.
    pub of_group: Option<String>,
    /// True if it is taken where no parts are chosen: what its name means does not leave it out.
    pub is_usual: bool,
}

/// Reason that a part of a file is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExclusionReason {
    /// Its name marks it as a collision hull.
    Hull,
    /// Its name marks it as a coarser level of detail of another part.
    CoarserLevel,
    /// The user's choice of parts excludes it.
    Chosen,
}
