//! Report of a bake as a file that is complete or does not exist.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::{fs, io};

use sabi_engine::{BakeReport, FileError, WholeFile, io_reason};

use crate::exit::{Exit, Failure};
use crate::terminal::{Terminal, pretty};

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
    /// Checks early that the report can be written; it never replaces one of `inputs`. `output` is the folder of the maps,
    /// which the bake may create.
    pub(crate) fn create(path: &Path, output: &Path, inputs: &[&Path]) -> Result<ReportFile, Failure> {
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

    /// Returns whether the report is written to standard output.
    pub(crate) fn is_stdout(&self) -> bool {
        matches!(self, ReportFile::Stdout)
    }

    /// Writes the report.
    pub(crate) fn write(self, report: &BakeReport, terminal: &Terminal) -> Result<(), Failure> {
        let mut file = match self {
            ReportFile::Stdout => return terminal.json(report),
            ReportFile::File(file) => file,
            ReportFile::InNewFolder(path) => create_file(&path)?,
        };
        let path = file.target().to_owned();
        let text = pretty(report)?;
        let written = file.write(text.as_bytes()).and_then(|()| file.commit());
        written.map_err(|error| write_failure(&path, &error.source))
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn create_file(path: &Path) -> Result<WholeFile, Failure> {
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
