//! The report file: complete or not there.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::Value as Json;

use crate::disk::reason;
use crate::exit::{Exit, Failure};
use crate::terminal::{Terminal, pretty};

/// Where a report goes; dropping it leaves what was there before.
pub(crate) enum ReportFile {
    /// Standard output.
    Stdout,
    /// A file.
    File {
        /// Its name.
        path: PathBuf,
        /// Its name while it is not complete; none until a folder that the bake makes is there.
        temporary: Option<(File, PathBuf)>,
    },
}

impl ReportFile {
    /// Finds out early whether the report can be written; it never replaces one of `inputs`. `output` is the folder of the maps, which may come into being
    /// with them.
    pub(crate) fn create(path: &Path, output: &Path, inputs: &[&Path]) -> Result<ReportFile, Failure> {
        if path == Path::new("-") {
            return Ok(ReportFile::Stdout);
        }
        if path.is_dir() {
            return Err(cannot(path, &io::ErrorKind::IsADirectory.into()));
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
        let made_by_the_bake = !folder.exists() && folder.components().eq(output.components());
        let temporary = if made_by_the_bake {
            None
        } else {
            Some(open_temporary(path)?)
        };
        Ok(ReportFile::File {
            path: path.to_owned(),
            temporary,
        })
    }

    /// Whether the report goes to standard output.
    pub(crate) fn is_stdout(&self) -> bool {
        matches!(self, ReportFile::Stdout)
    }

    /// Writes the report.
    pub(crate) fn write(mut self, json: &Json, terminal: &Terminal) -> Result<(), Failure> {
        let ReportFile::File { path, temporary } = &mut self else {
            return terminal.json(json);
        };
        if temporary.is_none() {
            *temporary = Some(open_temporary(path)?);
        }
        if let Some((file, name)) = temporary {
            let text = pretty(json);
            let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_data());
            written
                .and_then(|()| fs::rename(name, &*path))
                .map_err(|error| cannot(path, &error))?;
        }
        *temporary = None;
        Ok(())
    }
}

impl Drop for ReportFile {
    fn drop(&mut self) {
        if let ReportFile::File {
            temporary: Some((_, name)),
            ..
        } = self
        {
            // Nothing more can be done about one that stays.
            let _ = fs::remove_file(name);
        }
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn open_temporary(path: &Path) -> Result<(File, PathBuf), Failure> {
    let Some(name) = path.file_name() else {
        return Err(cannot(path, &io::ErrorKind::InvalidFilename.into()));
    };
    let name = name.to_string_lossy();
    for number in 0..10_000 {
        let temporary = folder_of(path).join(format!(".{name}.{number}.tmp"));
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((file, temporary)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(cannot(path, &error)),
        }
    }
    Err(cannot(path, &io::ErrorKind::AlreadyExists.into()))
}

fn cannot(path: &Path, error: &io::Error) -> Failure {
    let why = match error.kind() {
        io::ErrorKind::NotFound => format!(
            "there is no folder {}; make it, or name another file",
            folder_of(path).display()
        ),
        _ => format!("{}; name another file", reason(error)),
    };
    let why = format!("cannot write the report {}: {why}", path.display());
    Failure::new(Exit::CannotWrite, why)
}
