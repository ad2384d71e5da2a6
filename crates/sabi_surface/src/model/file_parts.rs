//! Parts that a file has, taken or left out.

/// A part that a file has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePart {
    /// Its name. Several parts may have one.
    pub name: String,
    /// Reason that it is no part of the model; none for one that is.
    pub left_out: Option<LeftOut>,
    /// True if it is taken where no parts are chosen: what its name means does not leave it out.
    pub is_usual: bool,
}

/// Reason that a part of a file is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Its name says that it is a collision hull.
    Hull,
    /// Its name says that it is a coarser level of detail of another part.
    CoarserLevel,
    /// The choice of parts does not have it.
    Chosen,
}
