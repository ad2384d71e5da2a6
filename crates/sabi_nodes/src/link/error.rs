//! Errors of linking a kernel.

use std::fmt;

use crate::fault::Fault;

/// Reason why a kernel could not be linked: the nodes changed between planning and linking, or a mistake in the planner.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// A call names a kind that does not exist.
    #[error("the kernel calls the node kind '{0}', which is not loaded; reload the node folder")]
    UnknownKind(String),
    /// A kind uses a library that does not exist.
    #[error("a node uses the library '{0}', which is not loaded; add `lib/{0}.wgsl` or remove the `@use`")]
    UnknownLibrary(String),
    /// A call names a function that its kind does not have.
    #[error("the node kind '{0}' has no result '{1}'")]
    UnknownFunction(String, String),
    /// A shared file cannot be linked.
    #[error("{0}")]
    Shared(#[from] Fault),
    /// The planner left out something that a call or a store needs.
    #[error("the plan lacks {missing} for {reader}; this is a defect of Sabi")]
    Incomplete {
        /// The function or result that needs the missing part.
        reader: String,
        /// The missing part.
        missing: MissingPart,
    },
}

/// A missing part of a kernel's plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MissingPart {
    /// The source of an input.
    Input(String),
    /// The stored result of a pass.
    Pass(String),
    /// The table of a survey.
    Survey,
    /// The normals of triangles.
    Normals,
    /// A stored result, by its number among the loads.
    Load(usize),
    /// Calls: there are none.
    Call,
}

impl fmt::Display for MissingPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MissingPart::Input(name) => write!(f, "a source for the input '{name}'"),
            MissingPart::Pass(name) => write!(f, "the result of the pass '{name}'"),
            MissingPart::Survey => f.write_str("the survey"),
            MissingPart::Normals => f.write_str("the normals"),
            MissingPart::Load(number) => write!(f, "the stored result {number}"),
            MissingPart::Call => f.write_str("a call"),
        }
    }
}
