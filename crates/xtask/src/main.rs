//! Set-up and chores: `cargo xtask demo`, `cargo xtask test`, `cargo xtask nightly`, `cargo xtask assets`,
//! `cargo xtask bless`, `cargo xtask reference`, `cargo xtask pictures`, `cargo xtask library`,
//! `cargo xtask gpu`, `cargo xtask interop`, `cargo xtask fuzz`, `cargo xtask soak`.

mod bless;
mod checks;
mod demo;
mod fuzz;
mod gpu;
mod interop;
mod soak;

use std::process::ExitCode;

use xtask::project::{Project, TaskError, finish};

const HELP: &str = "\
cargo xtask demo      set up, build in release, bake an army crate into out/army-paint and draw it
cargo xtask test      set up, then format check, clippy, tests and doc tests
cargo xtask nightly   the build without the editor, the documentation, every fuzz target for a minute, and the soak; with a
                      number, the soak takes so many minutes
cargo xtask assets    write the project's own models into assets/meshes again; with --million [FILE],
                      write only the figure in a million triangles, into target/meshes or FILE
cargo xtask bless K   write the goldens of node kind K again, of all, pictures of the window or the manual,
                      the graphs of the library as the editor saves them, or the schemas of graph files and reports
cargo xtask reference write docs/nodes again; with --text its pages only, with kinds only their pictures
cargo xtask pictures  draw the example graphs on their models into docs/pictures; with names only theirs
cargo xtask library   draw the groups of the effect library into docs/library and write its page; with names only theirs;
                      with --times measure how long each takes to bake instead
cargo xtask gpu       run the tests and benches that use a device on every adapter of this machine, and write
                      target/gpu/report.md; with --pack FOLDER, build them for a machine without Rust, where
                      FOLDER/xtask gpu --packed FOLDER runs them in a copy of the project
cargo xtask interop   install validators of others into target/interop, and hold maps, documents, copies of models,
                      reports and plans against them
cargo xtask fuzz      run every fuzz target for 60 seconds, with limits of time and memory for each input; with a name only
                      that one, with --seconds N for another time; installs cargo-fuzz where it is missing
cargo xtask soak M    press keys and move the pointer at random in the real window for M minutes (120), and fail where
                      the program ends or its memory grows; with a path behind M, in that program
";

fn main() -> ExitCode {
    let task = std::env::args().nth(1);
    let rest: Vec<String> = std::env::args().skip(2).collect();
    let result = match task.as_deref() {
        Some("demo") => Project::find().and_then(|project| demo::run(&project)),
        Some("test") => Project::find().and_then(|project| checks::run(&project)),
        Some("nightly") => Project::find().and_then(|project| checks::run_nightly(&project, &rest)),
        Some("bless") => Project::find().and_then(|project| bless::run(&project, rest.first().map(String::as_str))),
        // A program of its own, so that the other tasks start without building it.
        Some(made @ ("assets" | "reference" | "pictures" | "library")) => {
            Project::find().and_then(|project| make_assets(&project, made, &rest))
        }
        Some("gpu") => gpu::run(&rest),
        Some("fuzz") => Project::find().and_then(|project| fuzz::run(&project, &rest)),
        Some("soak") => Project::find().and_then(|project| soak::run(&project, &rest)),
        Some("interop") => Project::find().and_then(|project| interop::run(&project)),
        None | Some("help" | "-h" | "--help") => {
            eprint!("{HELP}");
            Ok(())
        }
        Some(other) => Err(TaskError::new(
            2,
            format!("There is no task named `{other}`. These exist:\n{HELP}"),
        )),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(stop) => {
            eprintln!("\n{}", stop.sentence);
            ExitCode::from(stop.code)
        }
    }
}

/// Runs `sabi_assets`, which writes files of the repository.
fn make_assets(project: &Project, task: &str, arguments: &[String]) -> Result<(), TaskError> {
    let mut command = project.cargo(&["run", "--quiet", "--package", "sabi_assets", "--", task])?;
    command.args(arguments);
    finish(command, task)
}
