//! Writing of graph files, with a backup of what was there.

use std::fs;
use std::path::Path;

use sabi_files::{StagedSet, behind_links};

use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

/// Suffix of the backup of a file that a save replaces, appended to the file's whole name.
const BACKUP: &str = ".bak";

/// Writes a graph file durably and keeps the replaced one as a backup. The file behind a symbolic link is written.
pub(super) fn write_with_backup(path: &Path, text: &str) -> Result<(), EngineError> {
    let path = &behind_links(path);
    if fs::metadata(path).is_ok_and(|known| known.permissions().readonly()) {
        let why = format!("{} is write-protected", path.display());
        let refused = EngineError::new(ErrorKind::CannotWrite, why);
        return Err(refused.with_remedies([Remedy::AllowWriting, Remedy::SaveUnderOtherName]));
    }
    let Some(name) = path.file_name() else {
        let why = format!("{} names no file; add a name that ends in .sabi", path.display());
        return Err(EngineError::new(ErrorKind::CannotWrite, why));
    };
    let mut staged = StagedSet::create(path.parent().unwrap_or(Path::new(".")))?;
    if let Ok(before) = fs::read(path)
        && before != text.as_bytes()
    {
        let mut backup = name.to_owned();
        backup.push(BACKUP);
        staged.stage(backup, &before)?;
    }
    staged.stage(name, text.as_bytes())?;
    staged.commit()?;
    Ok(())
}
