//! Report of a bake, for people and for programs.

use serde_json::Value as Json;

use crate::phases::PhaseTimes;
use crate::warning::Warning;

/// Result of a bake; [`BakeReport::json`] is the report file.
#[derive(Clone, Debug)]
pub struct BakeReport {
    /// Times of its phases.
    pub times: PhaseTimes,
    /// Names of the written files.
    pub files: Vec<String>,
    /// What is probably not intended.
    pub warnings: Vec<Warning>,
    /// Report file.
    pub json: Json,
}
