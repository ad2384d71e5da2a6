//! Disk access on a user's behalf.
//!
//! [`write_whole`] replaces one file durably, [`append_durably`] appends to a file, [`StagedSet`] replaces several files together,
//! [`Cache`] stores results that can be computed again, [`FileLock`] marks a file as in use, [`PathBase`] resolves paths written in files,
//! [`TrustedPaths`] decides which of these may be opened, [`archive`] packs files into an archive and unpacks them. All of them write to a
//! [`Disk`]; a test disk fails at a chosen step. Paths are always [`std::path::Path`], so that names that are not UTF-8 work, too.
//!
//! Invariants: at every moment a target file has either its earlier bytes or all new bytes; a temporary file is opened with
//! `create_new` and never shared; no function interprets the bytes.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("notes.txt");
//! sabi_files::write_whole(&file, b"first")?;
//! sabi_files::write_whole(&file, b"second")?;
//! assert_eq!(std::fs::read(&file)?, b"second");
//! # Ok(())
//! # }
//! ```

mod address;
mod append;
pub mod archive;
mod cache;
mod disk;
mod error;
#[cfg(test)]
mod fault_tests;
mod folder_search;
mod git_lfs;
mod invisible;
mod lock;
mod path_base;
pub mod path_encoding;
mod paths;
mod read;
mod refusal;
mod staged_set;
mod temporary;
#[cfg(test)]
mod test_folder;
mod trusted_paths;
mod uri;
mod whole;
mod whole_path;

pub use address::is_local;
pub use append::append_durably;
pub use cache::{Cache, CacheKey, CacheKind};
pub use disk::{Disk, DiskFault};
pub use error::{FileError, Operation, io_reason};
pub use folder_search::FolderSearch;
pub use git_lfs::is_git_lfs_pointer;
pub use invisible::is_invisible;
pub use lock::{FileLock, LockError, is_locked};
pub use path_base::{AbsolutePaths, NotText, PathBase, path_text, without_detours};
pub use path_encoding::{path_from_stored, stored_path};
pub use paths::{absolute, behind_links, canonical, free_file};
pub use read::{Unread, read_plain};
pub use refusal::Refusal;
pub use staged_set::{StagedError, StagedSet};
pub use temporary::{is_temporary_name, sweep};
pub use trusted_paths::TrustedPaths;
pub use uri::{Uri, data_uri, find_beside};
pub use whole::{WholeFile, write_whole};
pub use whole_path::{named_path, whole_path};
