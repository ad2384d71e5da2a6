//! The tests on one adapter: how many passed, and which failed with which message.

use std::process::Stdio;

use super::adapters::Adapter;
use super::pack::{Pack, ProgramRole};
use xtask::project::{Project, TaskError, output_of};

/// Results of one program of tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TestResults {
    /// The program's name.
    pub(super) program: String,
    /// Number of tests that passed.
    pub(super) passed: usize,
    /// Names of tests that failed, each with its message.
    pub(super) failed: Vec<(String, String)>,
    /// Cause of an end before the summary, if it ended early.
    pub(super) ended_early: Option<String>,
}

/// Runs all programs of tests, one after the other. Pictures of failed goldens are written below `pictures`.
pub(super) fn run_all(
    project: &Project,
    pack: &Pack,
    adapter: &Adapter,
    pictures: &str,
) -> Result<Vec<TestResults>, TaskError> {
    let mut results = Vec::new();
    for (name, program) in pack.of(ProgramRole::Test) {
        eprintln!("  tests: {name}");
        let mut command = project.command(program)?;
        command
            .env("SABI_PROJECT", &project.root)
            .env("SABI_ADAPTER", &adapter.name)
            .env("SABI_PICTURES", pictures);
        let output = output_of(command.stderr(Stdio::piped()))?;
        let end = (!output.status.success()).then(|| output.status.to_string());
        let mut result = read(name, &String::from_utf8_lossy(&output.stdout), end);
        if let Some(why) = &mut result.ended_early {
            let words = String::from_utf8_lossy(&output.stderr);
            *why = format!("{why}: {}", last_lines(&words));
        }
        results.push(result);
    }
    Ok(results)
}

fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().rev().take(4).collect();
    lines.into_iter().rev().collect::<Vec<_>>().join(" / ")
}

/// Reads the output of a program of tests. `end` says how the program ended, if it failed.
fn read(program: &str, printed: &str, end: Option<String>) -> TestResults {
    let outcome = |line: &str, word: &str| {
        let name = line.strip_prefix("test ")?.strip_suffix(&format!(" ... {word}"))?;
        Some(name.split(" - ").next().unwrap_or(name).to_owned())
    };
    let passed = printed.lines().filter(|line| outcome(line, "ok").is_some()).count();
    let failed = printed.lines().filter_map(|line| outcome(line, "FAILED"));
    let failed: Vec<_> = failed
        .map(|name| (message_of(printed, &name), name))
        .map(|(message, name)| (name, message))
        .collect();
    let is_summed_up = printed.lines().any(|line| line.starts_with("test result: "));
    TestResults {
        program: program.to_owned(),
        passed,
        failed,
        ended_early: end.filter(|_| !is_summed_up),
    }
}

/// Returns the output of a failed test: its first lines, without notes.
fn message_of(printed: &str, name: &str) -> String {
    let head = format!("---- {name} stdout ----");
    let lines = printed.lines().skip_while(|line| *line != head).skip(1);
    let lines = lines.take_while(|line| !line.starts_with("---- ") && *line != "failures:");
    let is_said = |line: &&str| !line.is_empty() && !line.starts_with("note: ");
    lines.filter(is_said).take(12).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRINTED: &str = "\
running 3 tests
test golden::every_result ... FAILED
test seams::no_seam ... ok
test units::in_meters ... ok

failures:

---- golden::every_result stdout ----

thread 'golden::every_result' panicked at tests/pixels/specimens.rs:1:1:
noise/simplex: 40 samples differ
note: run with `RUST_BACKTRACE=1`

failures:
    golden::every_result

test result: FAILED. 2 passed; 1 failed; 0 ignored
";

    #[test]
    fn a_failed_test_is_named_with_its_message() {
        let results = read("pixels", PRINTED, Some("exit status: 101".into()));
        assert_eq!(results.passed, 2);
        let (name, message) = &results.failed[0];
        assert_eq!(name, "golden::every_result");
        assert!(message.ends_with("noise/simplex: 40 samples differ"), "{message}");
        assert_eq!(results.ended_early, None);
    }

    #[test]
    fn a_program_that_a_driver_crashes_has_not_passed() {
        let results = read(
            "views",
            "running 2 tests\ntest sun::up ... ok\n",
            Some("signal: 11".into()),
        );
        assert_eq!(results.ended_early.as_deref(), Some("signal: 11"));
    }
}
