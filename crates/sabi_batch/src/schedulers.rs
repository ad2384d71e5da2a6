//! Text with which other programs run the items of a plan: commands, an array of Slurm jobs, a job of Open Job Description.

mod command_lines;
mod open_job_description;
mod slurm;

pub use command_lines::command_lines;
pub use open_job_description::job_template;
pub use slurm::slurm_script;

use std::path::Path;

use sabi_engine::{EngineError, ErrorKind};

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
    let name = file.file_name().and_then(|name| name.to_str());
    let stem = file.file_stem().and_then(|stem| stem.to_str());
    name.zip(stem)
        .map(|(name, stem)| [name, stem])
        .ok_or_else(|| not_text(file))
}

fn not_text(file: &Path) -> EngineError {
    let why = format!(
        "{} cannot be named in the text, because its name is not Unicode text; name another file",
        file.display()
    );
    EngineError::new(ErrorKind::CannotWrite, why)
}
