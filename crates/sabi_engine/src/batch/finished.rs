//! Items that need not be baked, and those that cannot be.

use std::path::{Path, PathBuf};

use sabi_files::{PathBase, read_plain};
use serde::Deserialize;

use super::faults::Faults;
use super::inputs::{InputHashes, hash_file};
use super::item::{BUILD, BakeItem};
use crate::error::{EngineError, ErrorKind};

/// Report in the folder of an item.
const REPORT: &str = "report.json";
/// A larger file is no report.
const LARGEST_REPORT_BYTES: u64 = 64 << 20;

/// What the report of a finished item says of its files.
#[derive(Deserialize)]
struct FinishedReport {
    key: String,
    outputs: Vec<WrittenRecord>,
    model: Option<ModelRecord>,
}

#[derive(Deserialize)]
struct ModelRecord {
    #[serde(flatten)]
    copy: WrittenRecord,
    files: Vec<WrittenRecord>,
}

#[derive(Deserialize)]
struct WrittenRecord {
    path: String,
    blake3: String,
}

impl BakeItem {
    /// Returns the report in the item's folder; `base` is the folder of the plan's file.
    pub fn report(&self, base: &PathBase) -> PathBuf {
        self.folder(base).join(REPORT)
    }

    /// Returns true if the item was baked: its report has its key, and all files are as the report says. `base` is the folder of the
    /// plan's file.
    pub fn is_finished(&self, base: &PathBase) -> bool {
        let report = read_plain(&self.report(base), LARGEST_REPORT_BYTES).ok();
        let report = report.and_then(|bytes| serde_json::from_slice::<FinishedReport>(&bytes).ok());
        let Some(report) = report.filter(|report| report.key == self.key) else {
            return false;
        };
        let folder = self.folder(base);
        let copies = report
            .model
            .iter()
            .flat_map(|model| std::iter::once(&model.copy).chain(&model.files));
        report.outputs.iter().chain(copies).all(|file| file.is_there(&folder))
    }

    /// Refuses an item of another build of Sabi, or with an input that is not as it was when the plan was made. `base` is the folder of
    /// the plan's file.
    ///
    /// # Errors
    /// A sentence for each input.
    pub fn refuse_changed(&self, base: &PathBase, hashes: &mut InputHashes) -> Result<(), EngineError> {
        if self.sabi != BUILD {
            let why = format!(
                "the plan was made by Sabi {}, and this is {BUILD}; plan again",
                self.sabi
            );
            return Err(EngineError::new(ErrorKind::BadInput, why));
        }
        let mut faults = Faults::default();
        for input in &self.inputs {
            let path = base.resolve(&input.path);
            match hashes.of(&path) {
                Err(error) => faults.add(error),
                Ok(hash) if hash != input.blake3 => {
                    let why = format!("{} was changed after the plan was made; plan again", path.display());
                    faults.add(EngineError::new(ErrorKind::BadInput, why));
                }
                Ok(_) => {}
            }
        }
        faults.into_result()
    }
}

impl WrittenRecord {
    fn is_there(&self, folder: &Path) -> bool {
        hash_file(&folder.join(&self.path)).is_ok_and(|hash| hash == self.blake3)
    }
}
