//! `cargo xtask gpu`: all tests and benches that use a device, on every adapter of this machine, in one report.
//!
//! Everything runs from a folder of programs, so that the same folder can be carried to a machine that has a graphics card
//! and no Rust: `cargo xtask gpu --pack FOLDER` here, `FOLDER/xtask gpu --packed FOLDER` in a copy of the project there.

mod adapters;
mod benches;
mod pack;
mod report;
mod tests_run;

use std::fs;
use std::path::{Path, PathBuf};

use crate::place::{Place, Stop};
use adapters::Adapter;
use pack::Pack;

/// Where the report and what belongs to it are written, from the root.
const FOLDER: &str = "target/gpu";

/// What is asked for on the command line.
#[derive(Debug, PartialEq, Eq)]
enum Asked {
    /// Build, then run everything here.
    Everything,
    /// Build into a folder.
    Pack(PathBuf),
    /// Run what such a folder holds.
    Packed(PathBuf),
}

impl Asked {
    fn read(arguments: &[String]) -> Result<Asked, Stop> {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        match arguments[..] {
            [] => Ok(Asked::Everything),
            ["--pack", folder] => Ok(Asked::Pack(folder.into())),
            ["--packed", folder] => Ok(Asked::Packed(folder.into())),
            _ => Err(Stop::new(
                2,
                "`cargo xtask gpu` takes nothing, `--pack FOLDER` or `--packed FOLDER`.",
            )),
        }
    }
}

/// Builds, runs or both.
pub(crate) fn run(arguments: &[String]) -> Result<(), Stop> {
    match Asked::read(arguments)? {
        Asked::Everything => {
            let place = Place::find()?;
            let pack = Pack::build(&place, &place.root.join(FOLDER).join("programs"))?;
            run_pack(&place, &pack)
        }
        Asked::Pack(folder) => {
            let pack = Pack::build(&Place::find()?, &folder)?;
            eprintln!(
                "\n{} programs are in {}. Copy the folder into a copy of the project on another machine, and run there \
                 `FOLDER/xtask gpu --packed FOLDER` in the project's root.",
                pack.programs.len(),
                folder.display()
            );
            Ok(())
        }
        Asked::Packed(folder) => {
            let place = Place::here()?;
            let pack = Pack::open(&folder)?;
            run_pack(&place, &pack)
        }
    }
}

/// Runs everything on every adapter and writes the report; a failed test is a failure of the task.
fn run_pack(place: &Place, pack: &Pack) -> Result<(), Stop> {
    let adapters = Adapter::find_all(place, pack)?;
    let folder = place.root.join(FOLDER);
    make_folder(&folder)?;
    let mut results = Vec::new();
    for adapter in adapters {
        eprintln!("\n{adapter}");
        let pictures = format!("{FOLDER}/{}", adapter.folder_name());
        let tests = tests_run::run_all(place, pack, &adapter, &pictures)?;
        let benches = benches::run_all(place, pack, &adapter)?;
        results.push(report::Results {
            adapter,
            tests,
            benches,
            pictures,
        });
    }
    let text = report::written(&results);
    let file = folder.join("report.md");
    fs::write(&file, &text).map_err(|error| Stop::new(1, format!("{} cannot be written: {error}.", file.display())))?;
    print_report(&text, &file);
    let failed: usize = results.iter().map(report::Results::failures).sum();
    if failed == 0 {
        return Ok(());
    }
    Err(Stop::new(
        1,
        format!("{failed} tests or benches failed; the report names them."),
    ))
}

fn print_report(text: &str, file: &Path) {
    eprintln!("\n{text}\nThe same in {}", file.display());
}

fn make_folder(folder: &Path) -> Result<(), Stop> {
    fs::create_dir_all(folder)
        .map_err(|error| Stop::new(1, format!("The folder {} cannot be made: {error}.", folder.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_task_takes_a_folder_to_pack_or_a_packed_one() {
        let read = |words: &[&str]| Asked::read(&words.iter().map(ToString::to_string).collect::<Vec<_>>());
        assert_eq!(read(&[]), Ok(Asked::Everything));
        assert_eq!(read(&["--pack", "a"]), Ok(Asked::Pack("a".into())));
        assert_eq!(read(&["--packed", "a"]), Ok(Asked::Packed("a".into())));
        assert_eq!(read(&["--pack"]).unwrap_err().code, 2);
    }
}
