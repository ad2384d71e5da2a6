//! What the repository holds that is made by programs: models and environments, and the pages and pictures of the documentation.
//!
//! `cargo xtask assets`, `reference`, `pictures` and `library` start it.

mod effects;
mod environments;
mod example_pictures;
mod models;
mod reference;
mod small_png;

use std::path::Path;
use std::process::ExitCode;

use xtask::project::{Project, TaskError};

/// Writes models and environments, or with `--million` only the large model.
fn assets(project: &Project, arguments: &[String]) -> Result<(), TaskError> {
    match arguments {
        [] => {
            models::write_all(project)?;
            environments::write_all(project)
        }
        [flag] if flag == "--million" => models::write_million(&project.target.join("meshes/figure-million.glb")),
        [flag, file] if flag == "--million" => models::write_million(Path::new(file)),
        _ => {
            let advice = "`cargo xtask assets` takes nothing, or `--million` and a file to write.";
            Err(TaskError::new(2, advice.to_owned()))
        }
    }
}

fn run(task: &str, arguments: &[String]) -> Result<(), TaskError> {
    let project = Project::find()?;
    match task {
        "assets" => assets(&project, arguments),
        "reference" => reference::run(&project, arguments),
        "pictures" => example_pictures::run(&project, arguments),
        "library" => effects::run(&project, arguments),
        other => Err(TaskError::new(
            2,
            format!("There is no task named `{other}`: `assets`, `reference`, `pictures` and `library` exist."),
        )),
    }
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let task = arguments.next().unwrap_or_else(|| "nothing".to_owned());
    let rest: Vec<String> = arguments.collect();
    match run(&task, &rest) {
        Ok(()) => ExitCode::SUCCESS,
        Err(stop) => {
            eprintln!("\n{}", stop.sentence);
            ExitCode::from(stop.code)
        }
    }
}
