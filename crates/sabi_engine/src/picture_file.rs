//! Finished pictures become files, all of them or none.

use std::path::{Path, PathBuf};

use sabi_export::Staging;

use crate::error::EngineError;

/// Writes pictures of one folder under temporary names and renames them; `inputs` are files that they must not replace.
pub(crate) fn write_pictures(paths: &[PathBuf], pictures: &[Vec<u8>], inputs: Vec<PathBuf>) -> Result<(), EngineError> {
    let folder = paths.first().and_then(|path| path.parent());
    let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
    let mut staging = Staging::create(folder.unwrap_or(Path::new(".")))?;
    staging.protect(inputs);
    for (path, bytes) in paths.iter().zip(pictures) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        staging.stage(&name, bytes)?;
    }
    staging.commit()?;
    Ok(())
}
