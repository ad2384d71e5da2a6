//! Finished pictures become files, all of them or none.

use std::path::{Path, PathBuf};

use sabi_export::Staging;

use crate::error::EngineError;

/// Pictures of one folder on their way to disk: under temporary names until all are there.
pub(crate) struct PictureFiles {
    staging: Staging,
    /// Those that are still to come, the next one last.
    names: Vec<String>,
}

impl PictureFiles {
    /// Files to be written, all in the folder of the first; `inputs` are files that they must not replace. A folder that
    /// cannot be written to is told before anything is drawn.
    pub(crate) fn begin(paths: &[PathBuf], inputs: Vec<PathBuf>) -> Result<PictureFiles, EngineError> {
        let folder = paths.first().and_then(|path| path.parent());
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
        let mut staging = Staging::create(folder.unwrap_or(Path::new(".")))?;
        staging.protect(inputs);
        let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let names: Vec<String> = paths.iter().rev().map(name).collect();
        for name in &names {
            staging.check(name)?;
        }
        Ok(PictureFiles { staging, names })
    }

    /// Writes the next picture, under a temporary name.
    pub(crate) fn add(&mut self, bytes: Vec<u8>) -> Result<(), EngineError> {
        if let Some(name) = self.names.pop() {
            self.staging.stage(&name, &bytes)?;
        }
        Ok(())
    }

    /// Puts all pictures in their places.
    pub(crate) fn commit(self) -> Result<(), EngineError> {
        self.staging.commit()?;
        Ok(())
    }
}
