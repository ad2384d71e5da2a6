//! A stroke file in numbers, for `sabi paint info`.

use std::path::Path;

use sabi_files::{Unread, read_plain};
use sabi_paint::StrokeBook;
use sabi_paint::file::{FILE_LIMIT_BYTES, read};
use serde::Serialize;

use crate::error::{EngineError, ErrorKind};

/// A stroke file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StrokeReport {
    /// Name of the model that was painted on.
    pub model: String,
    /// Size of the file.
    pub bytes: usize,
    /// Steps: strokes that were added, and changes of them.
    pub steps: usize,
    /// Bytes that belong to no whole step.
    pub damaged_bytes: usize,
    /// The versions that nothing was painted after; a graph names one of them, or one before.
    pub versions: Vec<VersionReport>,
}

/// The strokes of a version.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct VersionReport {
    /// Its name in graphs.
    pub version: String,
    /// Its strokes; none where steps to it are lost.
    pub strokes: Option<usize>,
    /// Their places.
    pub points: usize,
}

/// Describes a stroke file.
///
/// # Errors
/// It cannot be read, or is no stroke file.
pub fn describe_strokes(path: &Path) -> Result<StrokeReport, EngineError> {
    let shown = path.display();
    let missing = |why: String| EngineError::new(ErrorKind::MissingInput, format!("{shown}: {why}"));
    let bytes = read_plain(path, FILE_LIMIT_BYTES).map_err(|unread| match unread {
        Unread::Missing => missing("there is no such file; check the path".to_owned()),
        Unread::Folder => missing("this is a folder; name a .strokes file in it".to_owned()),
        Unread::NotPlain => missing("this is a pipe or a device; name a .strokes file".to_owned()),
        Unread::TooLarge(bytes) => missing(format!("the file has {} MiB; at most 1024 are read", bytes >> 20)),
        Unread::Other(reason) => missing(format!("the file cannot be read: {reason}")),
    })?;
    let mut book = StrokeBook::default();
    let strokes = read(&bytes, &mut book)
        .map_err(|error| EngineError::new(ErrorKind::BadInput, format!("{shown}: {error}")).caused_by(error))?;
    let versions = book.ends().into_iter().map(|version| {
        let list = book.list(version);
        VersionReport {
            version: version.to_string(),
            points: list
                .iter()
                .flat_map(|list| &list.strokes)
                .map(|stroke| stroke.points.len())
                .sum(),
            strokes: list.map(|list| list.strokes.len()),
        }
    });
    Ok(StrokeReport {
        versions: versions.collect(),
        model: strokes.model,
        bytes: bytes.len(),
        steps: strokes.versions.len(),
        damaged_bytes: strokes.damaged_bytes,
    })
}
