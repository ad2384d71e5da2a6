//! Output: data on standard output, words for people on standard error.

use std::fmt;
use std::io::{self, ErrorKind, IsTerminal as _, Write};
use std::path::Path;

use sabi_engine::Warning;
use sabi_files::io_reason;
use serde::Serialize;

use crate::advice::with_flags;
use crate::arguments::{CliCommand, Global, ProgressChoice};
use crate::event::Event;
use crate::exit::{Exit, Failure};
use crate::failure_report::FailureReport;
use crate::printable::{Page, printable, printable_json, printable_path};

/// Most warnings of a list that are printed; JSON has all of them.
const MOST_WARNINGS: usize = 200;

/// Output of a command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    quiet: bool,
    progress: ProgressChoice,
    /// True if standard output is JSON, even for failures.
    json: bool,
    /// Name of the command that runs, whose flags remedies name.
    command: &'static str,
}

impl Terminal {
    /// Creates the output of a command.
    pub(crate) fn new(global: &Global, command: &CliCommand, progress: ProgressChoice) -> Terminal {
        Terminal {
            command: command.name(),
            json: command.prints_json(),
            quiet: global.quiet,
            progress,
        }
    }

    /// Returns the form in which progress is shown.
    pub(crate) fn progress(&self) -> ProgressChoice {
        self.progress
    }

    /// Prints a progress event.
    pub(crate) fn event(&self, event: &Event) {
        // An event has only plain data, so writing it as JSON cannot fail.
        if let Ok(text) = serde_json::to_string(event) {
            self.line(format_args!("{text}"));
        }
    }

    /// Prints the event that the command has ended, if progress is shown as events.
    pub(crate) fn done(&self, exit: Exit) {
        if self.progress == ProgressChoice::Json {
            self.event(&Event::done(exit));
        }
    }

    /// Prints a remark, unless the user wants errors only.
    pub(crate) fn note(&self, text: impl fmt::Display) {
        if !self.quiet {
            self.line(format_args!("{text}"));
        }
    }

    /// Prints a warning with its remedies, unless the user wants errors only.
    pub(crate) fn warning(&self, warning: impl Into<Warning>) {
        if !self.quiet {
            let Warning { sentence, remedies, .. } = warning.into();
            self.line(format_args!(
                "warning: {}",
                with_flags(&sentence, &remedies, self.command)
            ));
        }
    }

    /// Prints warnings, the first ones of very many: a file may cause any number of them.
    pub(crate) fn warnings(&self, warnings: impl IntoIterator<Item = impl Into<Warning>>) {
        let mut warnings = warnings.into_iter().fuse();
        warnings
            .by_ref()
            .take(MOST_WARNINGS)
            .for_each(|warning| self.warning(warning));
        let more = warnings.count();
        if more > 0 {
            self.warning(format!("{more} more warnings are left out"));
        }
    }

    /// Prints the sentences of a failure, and its remedies after the last one; as JSON, too, if the command prints JSON.
    pub(crate) fn failure(&self, failure: &Failure) {
        if self.json {
            json_failure(failure, self.command);
        }
        self.failure_in_words(failure);
    }

    /// Prints the sentences of a failure for people only.
    pub(crate) fn failure_in_words(&self, failure: &Failure) {
        let Some((last, others)) = failure.messages.split_last() else {
            return;
        };
        for message in others {
            self.line(format_args!("error: {message}"));
        }
        let last = with_flags(last, &failure.remedies, self.command);
        self.line(format_args!("error: {last}"));
    }

    /// Prints the sentence of an error of a command whose JSON output contains the error too.
    pub(crate) fn error(&self, sentence: &str) {
        self.line(format_args!("error: {sentence}"));
    }

    /// Returns the name of the command that runs.
    pub(crate) fn command(&self) -> &'static str {
        self.command
    }

    /// Prints a line for people, even if the user wants errors only.
    pub(crate) fn line(&self, text: fmt::Arguments<'_>) {
        // Standard error may be closed; then the line is lost.
        let _ = writeln!(io::stderr().lock(), "{}", printable(&text.to_string()));
    }

    /// Prints lines for people or scripts on standard output.
    pub(crate) fn page(&self, page: &Page) -> Result<(), Failure> {
        self.data(page.text())
    }

    /// Prints a line on standard output.
    pub(crate) fn data_line(&self, line: impl fmt::Display) -> Result<(), Failure> {
        self.page(&[line].into_iter().collect())
    }

    /// Prints paths of files on standard output, one a line. A pipe gets the bytes of each path, a terminal only text.
    pub(crate) fn paths<P: AsRef<Path>>(&self, paths: impl IntoIterator<Item = P>) -> Result<(), Failure> {
        if io::stdout().is_terminal() {
            return self.page(
                &paths
                    .into_iter()
                    .map(|path| path.as_ref().display().to_string())
                    .collect(),
            );
        }
        let mut lines = Vec::new();
        for path in paths {
            lines.extend(printable_path(path.as_ref()));
            lines.push(b'\n');
        }
        self.bytes(&lines)
    }

    /// Prints text on standard output unchanged: a document, or input for another program.
    pub(crate) fn data(&self, text: &str) -> Result<(), Failure> {
        self.bytes(text.as_bytes())
    }

    fn bytes(&self, bytes: &[u8]) -> Result<(), Failure> {
        let mut stdout = io::stdout().lock();
        match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
            // The reader of a pipe may stop early, as `head` does.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(error) => {
                let why = format!("cannot write to standard output: {}", io_reason(&error));
                Err(Failure::new(Exit::CannotWrite, why))
            }
            Ok(()) => Ok(()),
        }
    }

    /// Prints a JSON document on standard output.
    pub(crate) fn json(&self, document: &impl Serialize) -> Result<(), Failure> {
        self.data(&pretty(document)?)
    }
}

/// Prints a failure of a command as JSON on standard output.
pub(crate) fn json_failure(failure: &Failure, command: &str) {
    if let Ok(text) = pretty(&FailureReport::new(failure, command)) {
        let mut stdout = io::stdout().lock();
        // If standard output is closed, people still see the sentence on standard error.
        let _ = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
    }
}

/// Returns a JSON document as text, with a line break at its end.
pub(crate) fn pretty(document: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(document);
    let text = text.map_err(|error| Failure::new(Exit::Defect, format!("cannot write the report as JSON: {error}")))?;
    Ok(format!("{}\n", printable_json(&text)))
}
