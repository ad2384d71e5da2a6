//! `cargo xtask gpu`: all tests and benches that use a device, on every adapter of this machine, in one report.
//!
//! Everything runs from a folder of programs, so that the same folder can be carried to a machine that has a graphics card
//! and no Rust: `cargo xtask gpu --pack FOLDER` here, `FOLDER/xtask gpu --packed FOLDER` in a copy of the project there.

mod adapters;
mod benches;
mod pack;
mod report;
mod tests_run;

use std::path::{Path, PathBuf};

use adapters::Adapter;
use pack::Pack;
use xtask::project::{Project, TaskError, create_folder, write_file};

/// Folder of the report and its files, relative to the root.
const FOLDER: &str = "target/gpu";

/// Action requested on the command line.
#[derive(Debug, PartialEq, Eq)]
enum GpuTask {
    /// Build, then run everything here.
    Everything,
    /// Build into a folder.
    Pack(PathBuf),
    /// Run the programs of such a folder.
    Packed(PathBuf),
}

impl GpuTask {
    fn read(arguments: &[String]) -> Result<GpuTask, TaskError> {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        match arguments[..] {
            [] => Ok(GpuTask::Everything),
            ["--pack", folder] => Ok(GpuTask::Pack(folder.into())),
            ["--packed", folder] => Ok(GpuTask::Packed(folder.into())),
            _ => Err(TaskError::new(
                2,
                "`cargo xtask gpu` takes nothing, `--pack FOLDER` or `--packed FOLDER`.",
            )),
        }
    }
}

/// Performs the action that the arguments request.
pub(crate) fn run(arguments: &[String]) -> Result<(), TaskError> {
    match GpuTask::read(arguments)? {
        GpuTask::Everything => {
            let project = Project::find()?;
            let pack = Pack::build(&project, &project.root.join(FOLDER).join("programs"))?;
            run_pack(&project, &pack)
        }
        GpuTask::Pack(folder) => {
            let pack = Pack::build(&Project::find()?, &folder)?;
            eprintln!(
                "\n{} programs are in {}. Copy the folder into a copy of the project on another machine, and run there \
                 `FOLDER/xtask gpu --packed FOLDER` in the project's root.",
                pack.programs.len(),
                folder.display()
            );
            Ok(())
        }
        GpuTask::Packed(folder) => {
            let project = Project::here()?;
            let pack = Pack::open(&folder)?;
            run_pack(&project, &pack)
        }
    }
}

/// Runs everything on every adapter and writes the report; a failed test is a failure of the task.
fn run_pack(project: &Project, pack: &Pack) -> Result<(), TaskError> {
    let adapters = Adapter::find_all(project, pack)?;
    let folder = project.root.join(FOLDER);
    create_folder(&folder)?;
    let mut results = Vec::new();
    for adapter in adapters {
        eprintln!("\n{adapter}");
        let pictures = format!("{FOLDER}/{}", adapter.folder_name());
        let tests = tests_run::run_all(project, pack, &adapter, &pictures)?;
        let benches = benches::run_all(project, pack, &adapter)?;
        results.push(report::Results {
            adapter,
            tests,
            benches,
            pictures,
        });
    }
    let text = report::written(&results);
    let file = folder.join("report.md");
    write_file(&file, &text)?;
    print_report(&text, &file);
    let failed: usize = results.iter().map(report::Results::failures).sum();
    if failed == 0 {
        return Ok(());
    }
    Err(TaskError::failed(format!(
        "{failed} tests or benches failed; the report names them."
    )))
}

fn print_report(text: &str, file: &Path) {
    eprintln!("\n{text}\nThe same in {}", file.display());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_task_takes_a_folder_to_pack_or_a_packed_one() {
        let read = |words: &[&str]| GpuTask::read(&words.iter().map(ToString::to_string).collect::<Vec<_>>());
        assert_eq!(read(&[]), Ok(GpuTask::Everything));
        assert_eq!(read(&["--pack", "a"]), Ok(GpuTask::Pack("a".into())));
        assert_eq!(read(&["--packed", "a"]), Ok(GpuTask::Packed("a".into())));
        assert_eq!(read(&["--pack"]).unwrap_err().code, 2);
    }
}
