//! Errors of loading a model.

use std::collections::BTreeSet;

use sabi_files::Refusal;

use super::name_lists::listed;

/// A model that could not be loaded, and the reason.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{model}: {fault}")]
pub struct LoadError {
    /// The model's file as the artist named it.
    pub model: String,
    /// Fault of the model.
    pub fault: ModelFault,
}

impl LoadError {
    /// Returns true if a file is missing or unreadable, rather than wrong in its content.
    pub fn is_missing(&self) -> bool {
        matches!(
            self.fault,
            ModelFault::NoFile | ModelFault::Unreadable(_) | ModelFault::NoBuffer { .. } | ModelFault::Refused { .. }
        )
    }
}

/// Fault in a model file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelFault {
    /// The model file does not exist.
    #[error("there is no such file; check the path")]
    NoFile,
    /// The model file exists but cannot be read.
    #[error("the file cannot be read: {0}")]
    Unreadable(String),
    /// A file of vertex data beside the model cannot be read.
    #[error(
        "its vertex data is in `{uri}`, which cannot be read: {reason}; put that file back beside the model, or export the model as one .glb file"
    )]
    NoBuffer {
        /// The file as written in the model.
        uri: String,
        /// Error of the operating system.
        reason: String,
    },
    /// A file of vertex data may not be opened.
    #[error("its vertex data is in `{uri}`, which is not read: {refusal}")]
    Refused {
        /// The file as written in the model.
        uri: String,
        /// Reason.
        refusal: Refusal,
    },
    /// A kind of file that is not supported.
    #[error("{0}")]
    Format(String),
    /// The file requires a glTF extension that is not supported.
    #[error("it needs the glTF extension {extension}, which is not read here; export the model without it")]
    Extension {
        /// The extension's name.
        extension: String,
    },
    /// No part of the model has the requested UV set.
    #[error("it has no UV set {asked}; {there}")]
    UvSet {
        /// The requested set.
        asked: u32,
        /// Sets that exist.
        there: String,
    },
    /// The requested scene is not in the file.
    #[error("it has no scene {asked}; {there}")]
    Scene {
        /// The requested scene.
        asked: u32,
        /// Scenes that exist.
        there: String,
    },
    /// No part has one of the requested names.
    #[error("it has no part {}; its parts are {}", listed(unknown.iter().map(String::as_str), MOST_NAMES), listed(there.iter().map(String::as_str), MOST_NAMES))]
    NoSuchPart {
        /// The requested names that do not exist.
        unknown: Vec<String>,
        /// The names of the model's parts, sorted.
        there: Vec<String>,
    },
    /// The choice of parts excludes all parts.
    #[error("the choice of its parts leaves none")]
    NoPart,
    /// The file contradicts itself or its format.
    #[error("the file is damaged: {0}")]
    Damaged(String),
    /// The model has no triangles; with the reasons that were found.
    #[error("it has no triangles{0}")]
    NoTriangles(String),
    /// More triangles than are supported.
    #[error("it has {0} triangles, and at most {max} are handled; reduce it or split it", max = super::MAX_TRIANGLES)]
    TooLarge(u64),
    /// The model needs more memory than is allowed.
    #[error("it takes {needed_mib} MiB of memory, and {limit_mib} MiB are for a model; nothing of it was read")]
    Memory {
        /// Minimum memory that the model needs.
        needed_mib: u64,
        /// Memory that the model may use.
        limit_mib: u64,
    },
    /// A scale that is not a positive number.
    #[error("a scale of {0} makes no model; give a number above 0")]
    Scale(f32),
    /// A smoothing angle that is not possible between faces.
    #[error("faces cannot be smoothed up to an angle of {0}; give degrees from 0 (all flat) to 180 (all smooth)")]
    Smooth(f32),
}

/// Maximum number of names in a sentence.
const MOST_NAMES: usize = 8;

impl ModelFault {
    /// Returns the fault of a model that needs more bytes of memory than the limit.
    pub(super) fn memory(needed: u64, limit: u64) -> ModelFault {
        ModelFault::Memory {
            needed_mib: mib(needed),
            limit_mib: limit >> 20,
        }
    }
}

/// Returns a fault if no triangle has the requested UV set; `sets` are the sets of the meshes. A model without the default
/// set has no UVs, which is not a fault.
pub(super) fn missing_uv_set(asked: u32, sets: &BTreeSet<u32>) -> Result<(), ModelFault> {
    let has_asked = sets.contains(&asked);
    let there = match sets.iter().map(u32::to_string).collect::<Vec<_>>().as_slice() {
        sets if asked == 0 && (sets.is_empty() || has_asked) => return Ok(()),
        _ if has_asked => "all triangles with that set had to be left out".to_owned(),
        [] => "it has no UVs at all".to_owned(),
        [one] => format!("it has set {one}"),
        [first @ .., last] => format!("it has the sets {} and {last}", first.join(", ")),
    };
    Err(ModelFault::UvSet { asked, there })
}

/// Bytes as mebibytes, rounded up.
pub(super) fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

/// Shorthand for a damaged file.
pub(super) fn damaged<T>(what: impl Into<String>) -> Result<T, ModelFault> {
    Err(ModelFault::Damaged(what.into()))
}
