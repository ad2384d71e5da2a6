//! `cargo xtask test`: everything that must hold before a change is shared, cheapest first. `cargo xtask nightly`:
//! checks that changes seldom break, or that take too long to wait for.

use std::env;
use std::process::Stdio;

use crate::{fuzz, soak};
use xtask::display;
use xtask::project::{Project, TaskError, finish};
use xtask::vulkan::{self, Driver};

/// Name of a check, and cargo's arguments for it.
type Check = (&'static str, &'static [&'static str]);

const FORMAT: Check = ("Format", &["fmt", "--all", "--check"]);
const CLIPPY: Check = (
    "Clippy",
    &[
        "clippy",
        "--workspace",
        "--all-targets",
        "--locked",
        "--",
        "-D",
        "warnings",
    ],
);
// `cargo xtask demo` builds this, and no other check does: release builds include the files that debug builds read as
// they run. Only assertions of this package differ, so that the dependencies are those of the other checks.
const WITHOUT_EDITOR: Check = (
    "As in a release, without the editor",
    &[
        "check",
        "--package",
        "sabi",
        "--no-default-features",
        "--locked",
        "--config",
        "profile.dev.debug-assertions=false",
        "--config",
        "profile.dev.package.\"*\".debug-assertions=true",
    ],
);
// One run shows all failures. Tests of a crate run in one process, where they share the device, the node library and
// the fonts: a process for each test takes half as long again.
const TESTS: Check = (
    "Tests",
    &[
        "test",
        "--workspace",
        "--locked",
        "--no-fail-fast",
        "--lib",
        "--bins",
        "--tests",
    ],
);
const DOC_TESTS: Check = ("Doc tests", &["test", "--doc", "--workspace", "--locked"]);
const DOCUMENTATION: Check = ("Documentation", &["doc", "--workspace", "--no-deps", "--locked"]);

/// Tests that read real and hostile files, which are no part of the project.
const FILES_FROM_ELSEWHERE: Check = (
    "Tests with files from elsewhere",
    &[
        "test",
        "--workspace",
        "--locked",
        "--no-fail-fast",
        "--lib",
        "--bins",
        "--tests",
        "--",
        "--ignored",
        // Writes pictures of the manual.
        "--skip",
        "app::tests::manual",
    ],
);
/// Environment variable with the folder of these files.
const FILES_VARIABLE: &str = "SABI_TEST_DATA";

/// Environment variable of Mesa's software driver with options of its compiler. Tests run most kernels once and on few
/// texels, so that compiling takes longer than running: `nopt` leaves out the passes that only make code faster.
const DRIVER_OPTIONS: &str = "GALLIVM_PERF";

/// Checks that a change has to pass.
const CHECKS: [Check; 4] = [FORMAT, CLIPPY, TESTS, DOC_TESTS];
/// Checks that run once a night.
const NIGHTLY_CHECKS: [Check; 2] = [WITHOUT_EDITOR, DOCUMENTATION];

/// Sets up and runs every check of a change; the first that fails ends it, with its own exit code.
pub(crate) fn run(project: &Project) -> Result<(), TaskError> {
    for (tool, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if !answers(project, tool)? {
            return Err(TaskError::failed(format!(
                "The checks need {component}: run `rustup component add {component}`, then this again."
            )));
        }
    }
    vulkan::ensure(project, Driver::Software)?;
    display::ensure(project)?;
    run_all(project, &CHECKS)?;
    eprintln!("\nAll {} checks passed.", CHECKS.len());
    Ok(())
}

/// Runs the nightly checks, tests with files from elsewhere where a variable names their folder, every fuzz target for a minute, and the soak for as many minutes as the arguments say.
pub(crate) fn run_nightly(project: &Project, arguments: &[String]) -> Result<(), TaskError> {
    run_all(project, &NIGHTLY_CHECKS)?;
    match env::var_os(FILES_VARIABLE) {
        Some(_) => run_all(project, &[FILES_FROM_ELSEWHERE])?,
        None => eprintln!("\nThe tests with files from elsewhere are left out: {FILES_VARIABLE} names no folder."),
    }
    fuzz::run(project, &[])?;
    soak::run(project, arguments)
}

/// Runs checks in their order; the first that fails ends it.
fn run_all(project: &Project, checks: &[Check]) -> Result<(), TaskError> {
    for (number, (name, arguments)) in checks.iter().enumerate() {
        let count = checks.len();
        eprintln!("\n[{}/{count}] {name}: cargo {}", number + 1, arguments.join(" "));
        let mut command = project.cargo(arguments)?;
        match arguments[0] {
            "doc" => _ = command.env("RUSTDOCFLAGS", "-D warnings"),
            "test" if env::var_os(DRIVER_OPTIONS).is_none() => _ = command.env(DRIVER_OPTIONS, "nopt"),
            _ => {}
        }
        finish(command, name)?;
    }
    Ok(())
}

/// Returns whether a cargo subcommand is installed.
fn answers(project: &Project, subcommand: &str) -> Result<bool, TaskError> {
    let mut command = project.cargo(&[subcommand, "--version"])?;
    Ok(command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_check_resolves_other_dependencies_than_those_of_the_lock_file() {
        for (name, arguments) in CHECKS.into_iter().chain(NIGHTLY_CHECKS) {
            assert_eq!(arguments.contains(&"--locked"), name != FORMAT.0, "{name}");
        }
    }
}
