//! `cargo xtask test`: everything that must hold before a change is shared, cheapest first.

use std::process::Stdio;

use crate::display;
use crate::place::{Place, Stop, finish};
use crate::vulkan::{self, Driver};

/// What a check is called, and cargo's arguments for it.
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
pub(crate) fn run(place: &Place) -> Result<(), Stop> {
    for (tool, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if !answers(place, tool)? {
            return Err(Stop::new(
                1,
                format!("The checks need {component}: run `rustup component add {component}`, then this again."),
            ));
        }
    }
    vulkan::ensure(place, Driver::Software)?;
    display::ensure(place)?;
    let checks = checks(answers(place, "nextest")?);
    for (number, (name, arguments)) in checks.iter().enumerate() {
        eprintln!(
            "\n[{}/{}] {name}: cargo {}",
            number + 1,
            checks.len(),
            arguments.join(" ")
        );
        let mut command = place.cargo(arguments)?;
        if arguments[0] == "doc" {
            command.env("RUSTDOCFLAGS", "-D warnings");
        }
        finish(command, name)?;
    }
    eprintln!("\nAll {} checks passed.", checks.len());
    Ok(())
}

/// Whether a cargo subcommand is installed.
fn answers(place: &Place, subcommand: &str) -> Result<bool, Stop> {
    let mut command = place.cargo(&[subcommand, "--version"])?;
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
