//! Checks of output folders against their recorded bakes.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use sabi_files::is_temporary_name;
use schemars::JsonSchema;
use serde::Serialize;

use super::manifest::{self, Manifest};
use super::recorded_bake::RecordedBake;
use crate::error::{EngineError, ErrorKind};

/// Result of checking an output folder; docs/report.md lists the keys of its file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Verification {
    /// The folder as it was given.
    pub folder: String,
    /// Bakes whose files are in the folder.
    pub bakes: usize,
    /// Files that these bakes wrote.
    pub files: usize,
    /// Differences from the recorded bakes.
    pub findings: Vec<Finding>,
    /// Reason why the folder could not be checked, as a sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl Verification {
    /// Returns the result for a folder that could not be checked.
    pub fn failed(folder: &Path, error: &EngineError) -> Verification {
        Verification {
            folder: folder.display().to_string(),
            bakes: 0,
            files: 0,
            findings: Vec::new(),
            error: Some(error.messages.join("; ")),
        }
    }
}

/// A difference between an output folder and its recorded bakes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Finding {
    /// Kind of finding.
    pub kind: FindingKind,
    /// The file: in the folder, or one that a bake read.
    pub path: String,
    /// A sentence.
    pub message: String,
}

/// Kind of finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// A file is missing or has other bytes.
    Damaged,
    /// A file that a bake read has changed, so that the maps are not up to date.
    Stale,
    /// A file that no recorded bake wrote.
    Stranger,
    /// A temporary file of a bake that was killed; the next bake removes it.
    LeftOver,
}

/// Checks the files of a folder against its recorded bakes: finds files that are damaged, outdated or unknown.
///
/// # Errors
/// There is no folder, or it has no manifest.
pub fn verify_folder(folder: &Path) -> Result<Verification, EngineError> {
    let fault = |kind, why: &str| EngineError::new(kind, format!("{} {why}", folder.display()));
    if !folder.is_dir() {
        return Err(fault(
            ErrorKind::MissingInput,
            "is no folder; give the folder of the maps",
        ));
    }
    if !manifest::path(folder).exists() {
        let why = "has no manifest of bakes (.sabi/bakes.json): it was baked by an earlier Sabi, or copied without its hidden files";
        return Err(fault(ErrorKind::MissingInput, why));
    }
    let recorded = Manifest::read(folder).and_then(|manifest| manifest.recorded(folder));
    let bakes = recorded.map_err(|why| {
        let why = format!(
            "has a damaged manifest, {}: {why}; bake again",
            manifest::path(folder).display()
        );
        fault(ErrorKind::BadInput, &why)
    })?;
    let known: BTreeSet<String> = bakes
        .iter()
        .flat_map(|bake| bake.files().map(|file| file.path.clone()))
        .collect();
    let mut findings: Vec<Finding> = bakes.iter().flat_map(|bake| faults_of(bake, folder)).collect();
    findings.extend(others(folder, &known)?);
    findings.sort_by(|one, other| (one.kind, &one.path).cmp(&(other.kind, &other.path)));
    findings.dedup();
    Ok(Verification {
        folder: folder.display().to_string(),
        bakes: bakes.len(),
        files: known.len(),
        findings,
        error: None,
    })
}

/// Damage and staleness of a bake.
fn faults_of(bake: &RecordedBake, folder: &Path) -> Vec<Finding> {
    let damaged = bake.damaged_files(folder).into_iter().map(|(path, message)| Finding {
        kind: FindingKind::Damaged,
        path,
        message,
    });
    let stale = bake.changed_inputs().into_iter().map(|(path, message)| Finding {
        kind: FindingKind::Stale,
        path,
        message,
    });
    damaged.chain(stale).collect()
}

/// Returns the files of a folder that no bake wrote. Hidden files, except those of killed bakes, and reports are ignored.
fn others(folder: &Path, known: &BTreeSet<String>) -> Result<Vec<Finding>, EngineError> {
    let unread = |error: std::io::Error| {
        let why = format!("{} cannot be read: {}", folder.display(), sabi_files::io_reason(&error));
        EngineError::new(ErrorKind::MissingInput, why)
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(unread)? {
        let entry = entry.map_err(unread)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let kind = match name.as_str() {
            name if is_temporary_name(name) => FindingKind::LeftOver,
            name if name.starts_with('.') || known.contains(name) || is_report(&entry.path()) => continue,
            _ => FindingKind::Stranger,
        };
        let message = match kind {
            FindingKind::LeftOver => format!("{name} is left of a bake that was killed; the next bake removes it"),
            _ => format!("{name} was not written by a bake that the folder knows"),
        };
        found.push(Finding {
            kind,
            path: name,
            message,
        });
    }
    Ok(found)
}

/// Returns whether a file is the report of a bake.
fn is_report(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "json") && RecordedBake::open(path).is_ok()
}
