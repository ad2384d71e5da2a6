//! `cargo xtask test`: everything that must hold before a change is shared, cheapest first.

use std::process::Stdio;

use crate::display;
use crate::project::{Project, TaskError, finish};
use crate::vulkan::{self, Driver};

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
// `cargo xtask demo` builds this, and none of the other checks does.
const WITHOUT_EDITOR: Check = (
    "Build without the editor",
    &["check", "--package", "sabi", "--no-default-features", "--locked"],
);
// One run shows everything that there is to mend.
const NEXTEST: Check = (
    "Tests (nextest)",
    &["nextest", "run", "--workspace", "--locked", "--no-fail-fast"],
);
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

fn checks(has_nextest: bool) -> [Check; 6] {
    [
        FORMAT,
        CLIPPY,
        WITHOUT_EDITOR,
        if has_nextest { NEXTEST } else { TESTS },
        DOC_TESTS,
        DOCUMENTATION,
    ]
}

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
    let checks = checks(answers(project, "nextest")?);
    for (number, (name, arguments)) in checks.iter().enumerate() {
        eprintln!(
            "\n[{}/{}] {name}: cargo {}",
            number + 1,
            checks.len(),
            arguments.join(" ")
        );
        let mut command = project.cargo(arguments)?;
        if arguments[0] == "doc" {
            command.env("RUSTDOCFLAGS", "-D warnings");
        }
        finish(command, name)?;
    }
    eprintln!("\nAll {} checks passed.", checks.len());
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
    fn the_cheapest_check_comes_first_and_nextest_is_used_where_it_is_installed() {
        let names = |has_nextest| checks(has_nextest).map(|(name, _)| name);
        assert_eq!(
            names(true),
            [
                "Format",
                "Clippy",
                "Build without the editor",
                "Tests (nextest)",
                "Doc tests",
                "Documentation"
            ]
        );
        assert_eq!(
            names(false),
            [
                "Format",
                "Clippy",
                "Build without the editor",
                "Tests",
                "Doc tests",
                "Documentation"
            ]
        );
    }
}
