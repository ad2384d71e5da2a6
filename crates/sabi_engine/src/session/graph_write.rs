//! Writing of graph files, with backups of their earlier contents.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::ErrorKind as ErrorKindOfSystem;
use std::path::{Path, PathBuf};

use sabi_files::{Disk, StagedError, StagedSet, Unread, behind_links, read_plain};

use super::known_contents::KnownContents;
use crate::error::{EngineError, ErrorKind};
use crate::remedy::Remedy;

/// Maximum size of a file that is kept as a backup when a graph replaces it.
const LARGEST_BACKUP_BYTES: u64 = 1 << 30;

/// Content of a file that a save replaces, with its permissions and modification time.
struct Earlier {
    bytes: Vec<u8>,
    metadata: Option<fs::Metadata>,
}

/// Options for writing a graph file.
#[derive(Clone, Copy, Debug)]
pub(super) struct GraphWrite<'a> {
    pub(super) disk: &'a Disk,
    /// Number of backups that are kept.
    pub(super) backups: usize,
    /// Contents that may be replaced; `None` for any.
    pub(super) replaceable: Option<&'a KnownContents>,
}

impl GraphWrite<'_> {
    /// Writes a graph file durably. If the path is a symbolic link, its target is written. The earlier content becomes the first backup,
    /// the first backup becomes the second, and so on. A backup that has the right content already is not written.
    pub(super) fn write(self, path: &Path, text: &str) -> Result<(), EngineError> {
        let path = &behind_links(path);
        refuse_write_protected(path)?;
        let Some(name) = path.file_name() else {
            let why = format!("{} names no file; add a name that ends in .sabi", path.display());
            return Err(EngineError::new(ErrorKind::CannotWrite, why));
        };
        let before = self.replaced(path)?;
        let written = || {
            let mut staged = StagedSet::create_on(self.disk, path.parent().unwrap_or(Path::new(".")))?;
            if let Some(before) = before.filter(|before| before.bytes != text.as_bytes()) {
                self.stage_backups(&mut staged, path, before)?;
            }
            staged.stage(name, text.as_bytes())?;
            staged.commit()
        };
        written().map(drop).map_err(|error| not_saved(path, error))
    }

    /// Returns the content of the file that is replaced; `None` if there is no file.
    fn replaced(self, path: &Path) -> Result<Option<Earlier>, EngineError> {
        match earlier(path) {
            Ok(before) => match self.replaceable {
                Some(known) if !known.contains(&before.bytes) => Err(written_by_another(path)),
                _ => Ok(Some(before)),
            },
            // A folder with this name is refused when the file is put in its place.
            Err(Unread::Missing | Unread::Folder) => Ok(None),
            Err(unread) => Err(not_kept(path, &unread)),
        }
    }

    /// Writes the backups under temporary names, the oldest first, so that each content exists at least once even if the
    /// process ends in between.
    fn stage_backups(self, staged: &mut StagedSet, path: &Path, before: Earlier) -> Result<(), StagedError> {
        let mut moved = Some(before);
        let mut backups: Vec<(OsString, Earlier)> = Vec::new();
        for number in 1..=self.backups {
            let Some(content) = moved.take() else { break };
            let backup = backup_of(path, number);
            // A backup that cannot be read is treated like a missing one.
            let there = earlier(&backup).ok();
            if there.as_ref().is_some_and(|there| there.bytes == content.bytes) {
                break;
            }
            moved = there;
            backups.push((backup.file_name().unwrap_or(OsStr::new("")).to_owned(), content));
        }
        for (name, content) in backups.into_iter().rev() {
            staged.stage_like(name, &content.bytes, content.metadata.as_ref())?;
        }
        Ok(())
    }
}

/// Returns the path of a backup of a graph file: its whole name with `.bak` for the latest, `.bak2` for the one before, and so on.
pub(super) fn backup_of(path: &Path, number: usize) -> PathBuf {
    // The path of a graph names a file.
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".bak");
    if number > 1 {
        name.push(number.to_string());
    }
    path.with_file_name(name)
}

fn earlier(path: &Path) -> Result<Earlier, Unread> {
    let bytes = read_plain(path, LARGEST_BACKUP_BYTES)?;
    let metadata = fs::metadata(path).ok();
    Ok(Earlier { bytes, metadata })
}

fn refuse_write_protected(path: &Path) -> Result<(), EngineError> {
    if fs::metadata(path).is_ok_and(|known| known.permissions().readonly()) {
        let why = format!("{} is write-protected", path.display());
        let refused = EngineError::new(ErrorKind::CannotWrite, why);
        return Err(refused.with_remedies([Remedy::AllowWriting, Remedy::SaveUnderOtherName]));
    }
    Ok(())
}

/// Returns the error for a disk that refuses a graph. It names the graph instead of the temporary file that could not be written.
pub(super) fn not_saved(path: &Path, error: StagedError) -> EngineError {
    // The disk or the folder refuses: a file that is write-protected was refused before.
    let (reason, is_full, elsewhere) = match &error {
        StagedError::File(error) | StagedError::Commit { error, .. } => (
            error.reason(),
            matches!(
                error.kind(),
                ErrorKindOfSystem::StorageFull | ErrorKindOfSystem::QuotaExceeded
            ),
            Remedy::SaveInOtherFolder,
        ),
        StagedError::Protected { .. } | StagedError::NotAFile { .. } | StagedError::SameName { .. } => {
            (error.to_string(), false, Remedy::SaveUnderOtherName)
        }
    };
    let why = format!("{} cannot be saved: {reason}", path.display());
    let refused = EngineError::new(ErrorKind::CannotWrite, why).caused_by(error);
    let free = is_full.then_some(Remedy::FreeSpace);
    refused.with_remedies(free.into_iter().chain([elsewhere]))
}

fn written_by_another(path: &Path) -> EngineError {
    let why = format!(
        "{} was written by another program since it was opened or saved here",
        path.display()
    );
    let refused = EngineError::new(ErrorKind::CannotWrite, why);
    refused.with_remedies([Remedy::ReplaceFile, Remedy::SaveUnderOtherName])
}

fn not_kept(path: &Path, unread: &Unread) -> EngineError {
    let why = match unread {
        Unread::TooLarge(bytes) => format!("it has {} MiB", bytes >> 20),
        Unread::Other(reason) => reason.clone(),
        Unread::Refused(refusal) => refusal.to_string(),
        Unread::Missing | Unread::Folder | Unread::NotPlain => "it is no ordinary file".to_owned(),
    };
    let why = format!(
        "{} is not replaced, since what it holds cannot be kept as a backup: {why}",
        path.display()
    );
    EngineError::new(ErrorKind::CannotWrite, why).with_remedies([Remedy::SaveUnderOtherName])
}
