//! Report of a bake, for people and for programs.

use serde_json::Value as Json;

use crate::phases::PhaseTimes;

/// Result of a bake; [`BakeReport::json`] is the report file.
#[derive(Clone, Debug)]
pub struct BakeReport {
    /// Times of its phases.
    pub times: PhaseTimes,
    /// Names of the written files.
    pub files: Vec<String>,
    /// Warnings for the artist.
    pub warnings: Vec<String>,
    /// Report file.
    pub json: Json,
}
