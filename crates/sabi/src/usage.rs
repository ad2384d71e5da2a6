//! Command lines that cannot be understood.

use std::env;
use std::io::{self, Write as _};
use std::path::Path;

use clap::error::ErrorKind;
use sabi_graph::nearest;

use crate::arguments::command_names;
use crate::exit::{Exit, Failure};
use crate::printable::printable;

/// Returns whether a command line contains the flag for JSON, even if the rest of it cannot be understood.
pub(crate) fn asks_for_json() -> bool {
    let options = env::args_os().skip(1).take_while(|argument| argument != "--");
    options.into_iter().any(|argument| argument == "--json")
}

/// Returns a sentence about a first word that is neither a file nor a command, but similar to a command.
pub(crate) fn mistyped_command(typed: &Path) -> Option<String> {
    let word = typed.to_str().filter(|_| !typed.exists())?;
    let names = command_names();
    let meant = nearest(word, names.iter().map(String::as_str)).filter(|meant| *meant != word)?;
    Some(format!(
        "there is no file '{word}' to edit, and no such command; did you mean 'sabi {meant}'?"
    ))
}

/// Returns the sentence about a mistyped command if that may be why a command line cannot be understood: the words after it are then not
/// arguments of the editor.
pub(crate) fn mistyped_command_line(kind: ErrorKind) -> Option<String> {
    if !matches!(
        kind,
        ErrorKind::UnknownArgument | ErrorKind::InvalidSubcommand | ErrorKind::ArgumentConflict
    ) {
        return None;
    }
    let first = env::args_os()
        .skip(1)
        .find(|word| !word.as_encoded_bytes().starts_with(b"-"))?;
    mistyped_command(Path::new(&first))
}

/// Prints the error of a command line. Its arguments may be names of files, so they neither control a terminal nor are
/// taken for commands.
pub(crate) fn print(error: &clap::Error) -> io::Result<()> {
    let is_odd = |argument: std::ffi::OsString| {
        let argument = argument.to_string_lossy();
        printable(&argument) != argument
    };
    if !env::args_os().any(is_odd) {
        return error.print();
    }
    let text = error.to_string();
    let lines = text.lines().map(|line| format!("{}\n", printable(line)));
    io::stderr().lock().write_all(lines.collect::<String>().as_bytes())
}

/// Returns the failure of a command line from the text that is printed for people: a sentence, tips, and where to read on.
pub(crate) fn usage_failure(text: &str) -> Failure {
    let text = text.strip_prefix("error: ").unwrap_or(text); // It says nothing that the kind does not.
    let paragraphs = text.split("\n\n").map(|paragraph| {
        let words: Vec<&str> = paragraph.split_whitespace().collect();
        words.join(" ")
    });
    let mut said =
        paragraphs.take_while(|said| !said.starts_with("Usage:") && !said.starts_with("For more information"));
    let mut failure = Failure::new(Exit::Usage, said.next().unwrap_or_default()); // There always is a sentence.
    let without_word = |tip: String| tip.strip_prefix("tip: ").map(str::to_owned).unwrap_or(tip);
    failure.tips = said.map(without_word).collect();
    failure
}

#[cfg(test)]
mod tests {
    use super::usage_failure;

    #[test]
    fn a_usage_error_is_its_sentence_and_its_tips() {
        let text = "error: unexpected argument '--colour' found\n\n  tip: a similar argument exists: '--color'\n\n\
            Usage: sabi bake [OPTIONS]\n\nFor more information, try '--help'.\n";
        let failure = usage_failure(text);
        assert_eq!(failure.messages, ["unexpected argument '--colour' found"]);
        assert_eq!(failure.tips, ["a similar argument exists: '--color'"]);
        let text = "error: the following required arguments were not provided:\n  --mesh <FILE>\n  --output <DIR>\n\nUsage: x\n";
        assert_eq!(
            usage_failure(text).messages,
            ["the following required arguments were not provided: --mesh <FILE> --output <DIR>"]
        );
    }
}
