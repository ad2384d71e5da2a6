//! Status of the items of a run.

use schemars::JsonSchema;
use serde::Serialize;

/// Status of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ItemStatus {
    /// The item was finished by an earlier run.
    Finished,
    /// The item was baked by this run.
    Baked,
    /// The item could not be baked.
    Failed,
    /// The item is not baked, because it was not requested or the run was stopped.
    Waiting,
}

impl ItemStatus {
    /// Returns the word for the status in JSON and tables.
    pub fn name(self) -> &'static str {
        match self {
            ItemStatus::Finished => "finished",
            ItemStatus::Baked => "baked",
            ItemStatus::Failed => "failed",
            ItemStatus::Waiting => "waiting",
        }
    }
}
