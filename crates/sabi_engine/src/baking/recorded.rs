//! Bakes recorded in reports and output folders.

pub(crate) mod manifest;
pub(crate) mod recorded_bake;
pub(crate) mod verification;

pub use manifest::{FinishedBake, finished_bake, is_finished_on_any_machine};
pub use recorded_bake::RecordedBake;
pub use verification::{Finding, FindingKind, Verification, verify_folder};
