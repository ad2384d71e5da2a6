//! `unpack_graph`: a packed graph becomes a folder.

use std::path::{Path, PathBuf};

use sabi_files::archive::{ArchiveError, UnpackedArchive};
use sabi_files::{Unread, read_plain};
use schemars::JsonSchema;
use serde::Serialize;

use super::entries::{check_file, check_name};
use super::manifest::{self, ArchiveManifest};
use crate::error::{EngineError, ErrorKind};
use crate::phases::{Progress, stop_if_canceled};

/// A graph that was unpacked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct UnpackReport {
    /// Path of the folder as it was given.
    pub folder: String,
    /// Path of the graph.
    pub graph: String,
    /// The same path; the other may have replacements for what is no text.
    #[serde(skip)]
    pub graph_file: PathBuf,
    /// Path of the model, if one was packed.
    pub model: Option<String>,
    /// All files, as paths from the folder.
    pub files: Vec<String>,
}

/// Unpacks a graph into a folder that does not exist or is empty. Only what [`super::pack_graph`] writes is unpacked: an archive from
/// elsewhere brings no settings that other programs act on, and no mark of a project.
///
/// # Errors
/// The archive is damaged, unsafe or no packed graph, or the folder has files; nothing is left behind.
pub fn unpack_graph(archive: &Path, folder: &Path, progress: &dyn Progress) -> Result<UnpackReport, EngineError> {
    let unpacked = UnpackedArchive::read(archive, folder, &check_name, &|| progress.is_canceled())?;
    let refused = |why: String| {
        let why = format!("{} is no packed graph: {why}", archive.display());
        EngineError::new(ErrorKind::BadInput, why)
    };
    let bytes = read_plain(&unpacked.folder().join(manifest::NAME), manifest::LIMIT_BYTES);
    let bytes = bytes.map_err(|unread| {
        refused(match unread {
            Unread::TooLarge(_) => format!(
                "its {} has more than {} KiB",
                manifest::NAME,
                manifest::LIMIT_BYTES >> 10
            ),
            _ => format!("it has no {}", manifest::NAME),
        })
    })?;
    let manifest = ArchiveManifest::read(&bytes).map_err(refused)?;
    for name in std::iter::once(&manifest.graph).chain(&manifest.model) {
        // Names of entries are safe, but other texts need not be.
        if !unpacked.names().contains(name) {
            return Err(refused(format!("it names '{name}', which is not in it")));
        }
    }
    for name in unpacked.names() {
        stop_if_canceled(progress)?;
        check_file(name, &unpacked.folder().join(name)).map_err(|why| ArchiveError::Unwanted {
            name: name.clone(),
            why,
        })?;
    }
    let files = unpacked.names().to_vec();
    unpacked.commit()?;
    let path = |name: &String| folder.join(name).display().to_string();
    Ok(UnpackReport {
        folder: folder.display().to_string(),
        graph: path(&manifest.graph),
        graph_file: folder.join(&manifest.graph),
        model: manifest.model.as_ref().map(path),
        files,
    })
}
