//! Process of one item: its messages and its result.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::{env, thread};

use sabi_engine::{Phase, TrustedPaths, io_reason};
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};
use crate::printable::printable;

/// Result of an item that was baked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BakedItem {
    /// Maps that were written.
    pub(crate) maps: usize,
    /// Time that the bake took.
    pub(crate) seconds: f64,
    /// Warnings with their remedies.
    pub(crate) warnings: Vec<String>,
}

/// End of an item.
#[derive(Debug)]
pub(crate) enum Ended {
    Baked(BakedItem),
    Failed(Failure),
    /// The bake was stopped.
    Stopped,
}

/// Starts the process of an item. It stops once its standard input is closed; the system closes it if this process ends.
pub(super) fn start(
    arguments: &RunArguments,
    trusted: &TrustedPaths,
    item: usize,
) -> io::Result<(Child, Option<ChildStdin>)> {
    let mut command = Command::new(env::current_exe()?);
    command.arg("run").arg(&arguments.plan);
    command.args([
        "--items",
        &item.to_string(),
        "--alone",
        "--json",
        "--quiet",
        "--progress",
        "json",
    ]);
    let machine = &arguments.machine;
    command.args([
        "--adapter",
        &machine.adapter.to_string(),
        "--caster",
        &machine.caster.to_string(),
    ]);
    command.args(["--budget", &(machine.budget_bytes() >> 20).to_string()]);
    command.args(["--memory", &arguments.memory_mib().to_string()]);
    for path in trusted.paths() {
        command.arg("--trust").arg(path);
    }
    for (is_set, flag) in [(arguments.no_cache, "--no-cache"), (arguments.force, "--force")] {
        command.args(is_set.then_some(flag));
    }
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn()?;
    let input = child.stdin.take();
    Ok((child, input))
}

/// Waits for the end of an item. Calls `step` for its progress, and prints its other lines on standard error.
pub(super) fn ended(mut child: Child, step: impl Fn(Phase, usize, usize)) -> Ended {
    let errors = child.stderr.take();
    let out = child.stdout.take();
    let read = thread::scope(|scope| {
        // Both streams are read at the same time, since a full pipe would block the process.
        let said = scope.spawn(move || {
            let mut said = String::new();
            let read = out.map_or(Ok(0), |mut out| out.read_to_string(&mut said));
            read.map(|_| said)
        });
        for line in errors
            .into_iter()
            .flat_map(|errors| BufReader::new(errors).lines())
            .map_while(Result::ok)
        {
            match step_of(&line) {
                Some((phase, done, of)) => step(phase, done, of),
                None if is_event(&line) => {}
                // Standard error may be closed; then the line is lost.
                None => drop(writeln!(io::stderr().lock(), "{}", printable(&line))),
            }
        }
        said.join()
            .unwrap_or_else(|_| Err(io::Error::other("its output cannot be read")))
    });
    match (read, child.wait()) {
        (Ok(said), Ok(status)) => end_of(&said, status),
        (Err(error), _) | (_, Err(error)) => {
            unknown(&format!("it cannot be told how the item ended: {}", io_reason(&error)))
        }
    }
}

fn is_event(line: &str) -> bool {
    line.starts_with("{\"event\":")
}

/// Returns the step that an event describes.
fn step_of(line: &str) -> Option<(Phase, usize, usize)> {
    let event: Json = is_event(line).then(|| serde_json::from_str(line).ok()).flatten()?;
    let phase = event.get("phase")?.as_str()?;
    let phase = *Phase::ALL.iter().find(|known| known.name() == phase)?;
    let number = |key: &str| usize::try_from(event.get(key)?.as_u64()?).ok();
    Some((phase, number("done")?, number("of")?))
}

fn end_of(said: &str, status: ExitStatus) -> Ended {
    if [Exit::Interrupted, Exit::Terminated]
        .iter()
        .any(|exit| status.code() == Some(*exit as i32))
    {
        return Ended::Stopped;
    }
    if status.success()
        && let Ok(baked) = serde_json::from_str(said)
    {
        return Ended::Baked(baked);
    }
    match serde_json::from_str(said).ok().and_then(|json: Json| failure(&json)) {
        Some(failure) => Ended::Failed(failure),
        None => unknown(&sentence(status)),
    }
}

fn unknown(sentence: &str) -> Ended {
    Ended::Failed(Failure::new(Exit::Defect, sentence.to_owned()))
}

/// Returns the failure in a report that a command prints.
fn failure(json: &Json) -> Option<Failure> {
    let error = json.get("error")?;
    let text = |json: &Json| json.as_str().map(str::to_owned);
    let texts = |json: &Json| {
        json.as_array()
            .map(|texts| texts.iter().filter_map(text).collect::<Vec<_>>())
    };
    let code = error.get("exit")?.as_u64()?;
    let exit = *Exit::ALL.iter().find(|exit| **exit as u64 == code)?;
    let mut failure = Failure::new(exit, text(error.get("message")?)?);
    if let Some(messages) = error.get("messages").and_then(texts) {
        failure.messages = messages;
    }
    failure.tips = error.get("remedies").and_then(texts)?;
    Some(failure)
}

/// Returns a sentence about a process that ended without a result.
fn sentence(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let why = match signal {
            9 => ": it was killed, by somebody or because memory ran out",
            6 | 11 => ": it crashed, perhaps in the driver of the adapter",
            _ => "",
        };
        return format!("signal {signal} ended the process of the item{why}");
    }
    format!("the process of the item ended with {status} and without a report")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::failure_report::FailureReport;

    #[test]
    fn a_failure_comes_back_as_its_process_told_it() {
        let mut told = Failure::new(Exit::CannotWrite, "one".to_owned());
        told.messages.push("two".to_owned());
        told.tips = vec!["try again".to_owned()];
        let json = serde_json::to_value(FailureReport::new(&told, "run")).unwrap();
        assert_eq!(failure(&json), Some(told));
        assert_eq!(failure(&json!({ "maps": 1 })), None);
    }

    #[test]
    fn a_step_is_read_from_its_event() {
        let line = serde_json::to_string(&crate::event::Event::phase(Phase::Run, 3, 12)).unwrap();
        assert_eq!(step_of(&line), Some((Phase::Run, 3, 12)));
        for other in ["{\"event\":\"done\",\"exit\":0}", "error: no", "{}"] {
            assert_eq!(step_of(other), None);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_process_that_says_nothing_is_described_by_its_end() {
        let status = |raw: i32| std::os::unix::process::ExitStatusExt::from_raw(raw);
        let told = |raw: i32| match end_of("", status(raw)) {
            Ended::Failed(failure) => failure.messages.concat(),
            other => panic!("{other:?}"),
        };
        assert_eq!(
            told(9),
            "signal 9 ended the process of the item: it was killed, by somebody or because memory ran out"
        );
        assert_eq!(told(1), "signal 1 ended the process of the item");
        assert_eq!(
            told(70 << 8),
            "the process of the item ended with exit status: 70 and without a report"
        );
        assert!(matches!(end_of("", status(130 << 8)), Ended::Stopped));
    }
}
