//! `cargo xtask test`: everything that must hold before a change is shared, cheapest first.

use std::process::Stdio;

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
// `cargo xtask demo` builds this, and none of the other checks does: release builds include what debug builds read as they run.
// Only assertions tell them apart, so the dependencies are those of the other checks.
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
// One run shows everything that there is to mend. Tests of a crate run in one process, where they share the device, the node
// library and the fonts: a process for each test takes half as long again.
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

const CHECKS: [Check; 6] = [FORMAT, CLIPPY, WITHOUT_EDITOR, TESTS, DOC_TESTS, DOCUMENTATION];

/// Sets up and runs every check; the first that fails ends it, with its own exit code.
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
    for (number, (name, arguments)) in CHECKS.iter().enumerate() {
        eprintln!(
            "\n[{}/{}] {name}: cargo {}",
            number + 1,
            CHECKS.len(),
            arguments.join(" ")
        );
        let mut command = project.cargo(arguments)?;
        if arguments[0] == "doc" {
            command.env("RUSTDOCFLAGS", "-D warnings");
        }
        finish(command, name)?;
    }
    eprintln!("\nAll {} checks passed.", CHECKS.len());
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
        for (name, arguments) in CHECKS {
            assert_eq!(arguments.contains(&"--locked"), name != FORMAT.0, "{name}");
        }
    }
}
