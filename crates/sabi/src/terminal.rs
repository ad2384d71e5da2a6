//! What is said: data on standard output, words for people on standard error.

use std::fmt;
use std::io::{self, ErrorKind, Write};

use serde_json::Value as Json;

use crate::arguments::Global;
use crate::disk::reason;
use crate::exit::{Exit, Failure};

/// Where words go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    quiet: bool,
    bars: bool,
}

impl Terminal {
    pub(crate) fn new(global: &Global) -> Terminal {
        Terminal {
            quiet: global.quiet,
            bars: !global.quiet && !global.no_progress,
        }
    }

    /// Whether bars are wanted, on a terminal.
    pub(crate) fn bars(&self) -> bool {
        self.bars
    }

    /// Something worth knowing.
    pub(crate) fn note(&self, text: impl fmt::Display) {
        if !self.quiet {
            self.line(format_args!("{text}"));
        }
    }

    /// Something that may not be meant.
    pub(crate) fn warning(&self, text: impl fmt::Display) {
        if !self.quiet {
            self.line(format_args!("warning: {text}"));
        }
    }

    /// What went wrong.
    pub(crate) fn error(&self, text: impl fmt::Display) {
        self.line(format_args!("error: {text}"));
    }

    /// A line for people, however quiet it should be.
    pub(crate) fn line(&self, text: fmt::Arguments<'_>) {
        // With nobody to tell it to there is nothing left to do.
        let _ = writeln!(io::stderr().lock(), "{text}");
    }

    /// Text on standard output.
    pub(crate) fn data(&self, text: &str) -> Result<(), Failure> {
        let mut stdout = io::stdout().lock();
        match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
            // Who reads a pipe may stop when it has enough, as `head` does.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(error) => {
                let why = format!("cannot write to standard output: {}", reason(&error));
                Err(Failure::new(Exit::CannotWrite, why))
            }
            Ok(()) => Ok(()),
        }
    }

    /// A JSON document on standard output.
    pub(crate) fn json(&self, json: &Json) -> Result<(), Failure> {
        self.data(&pretty(json))
    }
}

/// A JSON document as text, with a line break at its end.
pub(crate) fn pretty(json: &Json) -> String {
    format!("{json:#}\n")
}

/// A JSON value as people write it: `1` for `1.0`, `a, b` for a list.
pub(crate) fn plain(json: &Json) -> String {
    match json {
        Json::String(text) => text.clone(),
        Json::Number(number) => match number.as_f64() {
            Some(number) => number.to_string(),
            None => number.to_string(),
        },
        Json::Array(values) => {
            let inside = |value: &Json| match value {
                Json::Array(_) => format!("[{}]", plain(value)),
                value => plain(value),
            };
            values.iter().map(inside).collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}
