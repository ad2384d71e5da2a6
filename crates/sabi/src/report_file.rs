//! Report of a bake, including a failed one, as a file that is complete or does not exist.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::{fs, io};

use sabi_files::{FileError, PathBase, Unread, WholeFile, absolute, io_reason, read_plain, sweep};
use serde::Serialize;
use serde_json::Value as Json;

use crate::exit::{Exit, Failure};
use crate::terminal::{Terminal, pretty};

/// Greatest size of a report; larger files are not reports.
const LARGEST_REPORT_BYTES: u64 = 64 << 20;

/// Destination of a report. Dropping it leaves an earlier report unchanged.
pub(crate) enum ReportFile {
    /// Standard output.
    Stdout,
    /// File whose folder exists.
    File(WholeFile),
    /// File in the output folder, which the bake creates.
    InNewFolder(PathBuf),
}

impl ReportFile {
    /// Checks at the start that the report can be written and does not replace one of `inputs`. `output` is the folder of the maps,
    /// which the bake may create.
    pub(crate) fn create(path: &Path, output: &Path, inputs: &[PathBuf]) -> Result<ReportFile, Failure> {
        if path == Path::new("-") {
            return Ok(ReportFile::Stdout);
        }
        if path.is_dir() {
            return Err(write_failure(path, &ErrorKind::IsADirectory.into()));
        }
        let refused = |why: &str| {
            let why = format!("cannot write the report {}: {why}", path.display());
            Err(Failure::new(Exit::CannotWrite, why))
        };
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            return refused("it is no ordinary file; use - for standard output");
        }
        let real = path.canonicalize().ok();
        if real.is_some() && inputs.iter().any(|input| input.canonicalize().ok() == real) {
            return refused("this very bake reads it; name another file");
        }
        let folder = folder_of(path);
        if !folder.exists() && folder.components().eq(output.components()) {
            return Ok(ReportFile::InNewFolder(path.to_owned()));
        }
        create_file(path).map(ReportFile::File)
    }

    /// Returns the folder from which relative paths in the report start; for standard output, the current folder.
    pub(crate) fn base(&self) -> PathBase {
        match self {
            ReportFile::Stdout => PathBase::of_folder(absolute(Path::new("."))),
            ReportFile::File(file) => PathBase::of_file(&absolute(file.target())),
            ReportFile::InNewFolder(path) => PathBase::of_file(&absolute(path)),
        }
    }

    /// Returns whether the report is written to standard output.
    pub(crate) fn is_stdout(&self) -> bool {
        matches!(self, ReportFile::Stdout)
    }

    /// Writes the report of a bake that failed. A file of another kind is not replaced: the bake may have failed before it knew that it
    /// reads this file.
    pub(crate) fn write_failure(self, report: &impl Serialize, terminal: &Terminal) -> Result<(), Failure> {
        if let ReportFile::File(file) = &self
            && !is_report(file.target())
        {
            let why = format!(
                "the report {} is not written: there is a file that is no report; name another one",
                file.target().display()
            );
            return Err(Failure::new(Exit::CannotWrite, why));
        }
        self.write(report, terminal)
    }

    /// Writes the report. Creates its folder if the bake has not.
    pub(crate) fn write(self, report: &impl Serialize, terminal: &Terminal) -> Result<(), Failure> {
        let mut file = match self {
            ReportFile::Stdout => return terminal.json(report),
            ReportFile::File(file) => file,
            ReportFile::InNewFolder(path) => {
                fs::create_dir_all(folder_of(&path)).map_err(|error| write_failure(&path, &error))?;
                create_file(&path)?
            }
        };
        let path = file.target().to_owned();
        let text = pretty(report)?;
        let written = file.write(text.as_bytes()).and_then(|()| file.commit());
        written.map_err(|error| write_failure(&path, &error.source))
    }
}

/// Returns whether a file is missing, empty or a report.
fn is_report(path: &Path) -> bool {
    match read_plain(path, LARGEST_REPORT_BYTES) {
        Err(unread) => unread == Unread::Missing,
        Ok(bytes) if bytes.is_empty() => true,
        Ok(bytes) => serde_json::from_slice::<Json>(&bytes).is_ok_and(|json| json.get("sabi").is_some()),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn create_file(path: &Path) -> Result<WholeFile, Failure> {
    // Remove unfinished reports of bakes that were killed.
    sweep(folder_of(path));
    WholeFile::create(path).map_err(|FileError { source, .. }| write_failure(path, &source))
}

fn write_failure(path: &Path, error: &io::Error) -> Failure {
    let why = match error.kind() {
        ErrorKind::NotFound => format!(
            "there is no folder {}; make it, or name another file",
            folder_of(path).display()
        ),
        _ => format!("{}; name another file", io_reason(error)),
    };
    let why = format!("cannot write the report {}: {why}", path.display());
    Failure::new(Exit::CannotWrite, why)
}
