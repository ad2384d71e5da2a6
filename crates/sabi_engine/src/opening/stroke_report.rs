//! Report on a stroke file for `sabi paint info`.

use std::path::Path;

use sabi_files::read_plain;
use sabi_paint::StrokeBook;
use sabi_paint::file::{FILE_LIMIT_BYTES, read};
use schemars::JsonSchema;
use serde::Serialize;

use super::unread::why_unread;
use crate::error::{EngineError, ErrorKind};

/// A stroke file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct StrokeReport {
    /// Name of the model that was painted on.
    pub model: String,
    /// Size of the file.
    pub bytes: usize,
    /// Number of steps, which add strokes or change them.
    pub steps: usize,
    /// Number of bytes that belong to no complete step.
    pub damaged_bytes: usize,
    /// The versions after which nothing was painted. A graph names one of them, or an earlier one.
    pub versions: Vec<VersionReport>,
}

/// The strokes of a version.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct VersionReport {
    /// Its name in graphs.
    pub version: String,
    /// Its strokes, without those whose steps are lost.
    pub strokes: usize,
    /// Their places.
    pub points: usize,
}

/// Describes a stroke file.
///
/// # Errors
/// It cannot be read, or is no stroke file.
pub fn describe_strokes(path: &Path) -> Result<StrokeReport, EngineError> {
    let shown = path.display();
    let bytes = read_plain(path, FILE_LIMIT_BYTES).map_err(|unread| {
        let why = why_unread(&unread, ".strokes", "files of strokes", FILE_LIMIT_BYTES);
        EngineError::new(ErrorKind::MissingInput, format!("{shown}: {why}"))
    })?;
    let mut book = StrokeBook::default();
    let strokes = read(&bytes, &mut book)
        .map_err(|error| EngineError::new(ErrorKind::BadInput, format!("{shown}: {error}")).caused_by(error))?;
    let versions = book.ends().into_iter().filter_map(|version| {
        let list = book.list(version)?;
        Some(VersionReport {
            version: version.to_string(),
            points: list.strokes.iter().map(|stroke| stroke.points.len()).sum(),
            strokes: list.strokes.len(),
        })
    });
    Ok(StrokeReport {
        versions: versions.collect(),
        model: strokes.model,
        bytes: bytes.len(),
        steps: strokes.versions.len(),
        damaged_bytes: strokes.damaged_bytes,
    })
}
