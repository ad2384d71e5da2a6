//! Process of one item: its command line, its messages and its result.

use std::process::Command;
use std::{env, io};

use sabi_batch::running::ProcessEnd;
use sabi_engine::phases::Phase;
use sabi_files::TrustedPaths;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};

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

/// Returns the command that bakes an item. Its process stops once its standard input is closed.
pub(super) fn command(arguments: &RunArguments, trusted: &TrustedPaths, item: usize) -> io::Result<Command> {
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
    Ok(command)
}

/// Returns true for a line that is an event of a process.
pub(super) fn is_event(line: &str) -> bool {
    line.starts_with("{\"event\":")
}

/// Returns the step that an event describes.
pub(super) fn step_of(line: &str) -> Option<(Phase, usize, usize)> {
    let event: Json = is_event(line).then(|| serde_json::from_str(line).ok()).flatten()?;
    let phase = event.get("phase")?.as_str()?;
    let phase = *Phase::ALL.iter().find(|known| known.name() == phase)?;
    let number = |key: &str| usize::try_from(event.get(key)?.as_u64()?).ok();
    Some((phase, number("done")?, number("of")?))
}

/// Returns the result that a process reported.
pub(super) fn end_of(process: &ProcessEnd) -> Ended {
    if [Exit::Interrupted, Exit::Terminated]
        .iter()
        .any(|exit| process.status.code() == Some(*exit as i32))
    {
        return Ended::Stopped;
    }
    if process.status.success()
        && let Ok(baked) = serde_json::from_str(&process.output)
    {
        return Ended::Baked(baked);
    }
    let report = serde_json::from_str(&process.output).ok();
    let failure = report.and_then(|json: Json| failure(&json));
    Ended::Failed(failure.unwrap_or_else(|| Failure::new(Exit::Defect, process.without_report())))
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
    fn a_process_without_a_report_has_stopped_or_failed() {
        let end = |raw: i32| {
            end_of(&ProcessEnd {
                output: String::new(),
                status: std::os::unix::process::ExitStatusExt::from_raw(raw),
            })
        };
        assert!(matches!(end(130 << 8), Ended::Stopped));
        assert!(matches!(end(70 << 8), Ended::Failed(failure) if failure.exit == Exit::Defect));
    }
}
