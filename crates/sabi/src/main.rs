//! The command line: reads arguments, calls the engine, and prints results.

mod advice;
mod arguments;
mod commands;
mod defect;
#[cfg(test)]
mod documented;
mod exit;
mod failed_bake;
mod failure_report;
mod graph_argument;
mod progress;
mod quiet_driver;
mod report_file;
mod terminal;
mod usage;

use std::io;
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::FmtSpan;

use crate::arguments::Arguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

fn main() -> ExitCode {
    quiet_driver::start_again_if_needed();
    let exit = defect::caught(start).unwrap_or_else(|sentence| {
        if usage::asks_for_json() {
            terminal::json_failure(&Failure::new(Exit::Defect, sentence), "");
        }
        Exit::Defect
    });
    ExitCode::from(exit as u8)
}

fn start() -> Exit {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // The standard streams may be closed, and then there is nowhere to say so.
            let _ = error.print();
            if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
                return Exit::Done;
            }
            if usage::asks_for_json() {
                terminal::json_failure(&usage::usage_failure(&error.to_string()), "");
            }
            return Exit::Usage;
        }
    };
    let (command, global) = arguments.into_command();
    let terminal = Terminal::new(&global, &command);
    let done = start_log(global.log.as_deref()).and_then(|()| commands::run(command, &terminal));
    match done {
        Ok(exit) => exit,
        Err(failure) => {
            terminal.failure(&failure);
            failure.exit
        }
    }
}

/// Filter of the log where `--log` is not given.
const LOG_VARIABLE: &str = "SABI_LOG";

/// Starts the log on standard error, if `--log` or `SABI_LOG` gives a filter for it. Spans are logged with their times when they
/// close.
fn start_log(argument: Option<&str>) -> Result<(), Failure> {
    let variable = std::env::var(LOG_VARIABLE).ok().filter(|filter| !filter.is_empty());
    let (filter, name) = match (argument, &variable) {
        (Some(filter), _) => (filter, "--log"),
        (None, Some(filter)) => (filter.as_str(), LOG_VARIABLE),
        (None, None) => return Ok(()),
    };
    let filter = EnvFilter::try_new(filter).map_err(|error| {
        let why = format!("{name} takes a filter such as 'info' or 'sabi_gpu=debug', not '{filter}': {error}");
        Failure::new(Exit::Usage, why)
    })?;
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_span_events(FmtSpan::CLOSE)
        .with_writer(io::stderr)
        .with_ansi(false)
        .init();
    Ok(())
}
