//! Text with which other programs run the items of a plan: commands, an array of Slurm jobs, a job of Open Job Description.

mod command_lines;
mod open_job_description;
mod slurm;

pub use command_lines::command_lines;
pub use open_job_description::job_template;
pub use slurm::slurm_script;

use std::ffi::OsStr;
use std::path::Path;

use sabi_engine::{EngineError, ErrorKind};
use sabi_files::is_invisible;

/// Flags of the command `run`, as the front end names them.
#[derive(Clone, Copy, Debug)]
pub struct RunFlags {
    /// Flag before a list of items.
    pub items: &'static str,
    /// Flag before the name of an adapter.
    pub adapter: &'static str,
    /// Words that ask for progress in the lines of Open Job Description.
    pub openjd_progress: [&'static str; 2],
}

/// Returns the name of a plan's file without the folder, and the stem of the name, which is only for the names of jobs.
fn names(file: &Path) -> Result<[&str; 2], EngineError> {
    let name = file.file_name().unwrap_or(file.as_os_str()); // A path without a name, such as `..`, is no file.
    let stem = file.file_stem().unwrap_or(name); // A name has a stem.
    Ok([line_of_text(file, name)?, line_of_text(file, stem)?])
}

/// Returns the path of a plan's file, or a part of it, as text for a line.
///
/// # Errors
/// It is no text, or has characters that are not shown: a program that runs lines would run the part after a line break
/// as a second command, even inside quotes, and a text that turns the direction of writing reads as something else.
fn line_of_text<'a>(file: &Path, part: &'a OsStr) -> Result<&'a str, EngineError> {
    let refused = |reason: &str| {
        let why = format!(
            "{} cannot be named in the text, because {reason}; name another file",
            file.display()
        );
        EngineError::new(ErrorKind::CannotWrite, why)
    };
    match part.to_str() {
        None => Err(refused("its name is not Unicode text")),
        Some(text) if text.chars().any(is_invisible) => Err(refused(
            "its name has a line break or another character that is not shown",
        )),
        Some(text) => Ok(text),
    }
}
