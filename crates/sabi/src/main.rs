//! The command line: reads arguments, calls the engine, and prints results.

mod advice;
mod arguments;
mod commands;
mod defect;
mod driver_environment;
mod event;
mod exit;
mod failed_bake;
mod failure_report;
mod graph_argument;
mod openjd;
mod printable;
mod progress;
mod report_file;
#[cfg(test)]
mod report_keys;
mod requested_bake;
mod stopping;
mod terminal;
mod usage;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Parser, ValueEnum};
use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::FmtSpan;

use crate::arguments::{Arguments, Global, ProgressChoice};
use crate::exit::{Exit, Failure};
use crate::printable::LogWriter;
use crate::terminal::Terminal;

fn main() -> ExitCode {
    driver_environment::start_again_if_needed();
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
            if let Some(why) = usage::mistyped_command_line(error.kind()) {
                // The standard streams may be closed; then the message is lost.
                let _ = writeln!(io::stderr().lock(), "error: {why}");
                if usage::asks_for_json() {
                    terminal::json_failure(&Failure::new(Exit::Usage, why), "");
                }
                return Exit::Usage;
            }
            // The standard streams may be closed; then the message is lost.
            let _ = usage::print(&error);
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
    let progress = progress_choice(&global);
    let terminal = Terminal::new(&global, &command, *progress.as_ref().unwrap_or(&ProgressChoice::Auto));
    let done = progress
        .and_then(|_| start_log(global.log.as_deref()))
        .and_then(|()| commands::run(command, &global.trusted()?, &terminal));
    let exit = done.unwrap_or_else(|mut failure| {
        failure.exit = stopping::exit_of(failure.exit);
        terminal.failure(&failure);
        failure.exit
    });
    let exit = stopping::exit_of(exit);
    terminal.done(exit);
    exit
}

/// Environment variable with the form of progress, used if `--progress` is not given.
const PROGRESS_VARIABLE: &str = "SABI_PROGRESS";

/// Returns the form in which progress is shown: that of the command line, otherwise that of the variable. If neither is given, progress is
/// shown unless the command is quiet.
fn progress_choice(global: &Global) -> Result<ProgressChoice, Failure> {
    if global.no_progress {
        return Ok(ProgressChoice::None);
    }
    let variable = std::env::var(PROGRESS_VARIABLE).ok().filter(|word| !word.is_empty());
    match (global.progress, variable) {
        (Some(choice), _) => Ok(choice),
        (None, Some(word)) => ProgressChoice::from_str(&word, false).map_err(|_| {
            let why = format!("{PROGRESS_VARIABLE} takes auto, plain, json, openjd or none, not '{word}'");
            Failure::new(Exit::Usage, why)
        }),
        (None, None) if global.quiet => Ok(ProgressChoice::None),
        (None, None) => Ok(ProgressChoice::Auto),
    }
}

/// Environment variable with the filter of the log, used if `--log` is not given.
const LOG_VARIABLE: &str = "SABI_LOG";

/// Starts the log on standard error if `--log` or `SABI_LOG` gives a filter for it. Spans are logged with their times when they
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
        .with_writer(|| LogWriter(io::stderr()))
        .with_ansi(false)
        .init();
    Ok(())
}
