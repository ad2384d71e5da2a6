//! Faults of a node's file: description, location and remedy.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Maximum length of the part of a source line that a message shows.
const SNIPPET_CHARS: usize = 160;

/// Maximum number of faults of one kind that are reported for a file: finding the line of a fault takes as long as reading the file.
pub(crate) const FAULTS_SHOWN: usize = 64;

/// Start of the message for a text that can be parsed but is not valid.
pub(crate) const INVALID: &str = "This is not valid WGSL: ";

/// Error in a WGSL file, for its author.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The file.
    pub path: PathBuf,
    /// Line, counted from 1; 0 if the fault concerns the whole file.
    pub line: u32,
    /// Column in characters, counted from 1; 0 if the fault concerns the whole file.
    pub column: u32,
    /// Description of the fault, as a sentence.
    pub message: String,
    /// Advice for correcting it; may be empty.
    pub advice: String,
    /// The source line, or a part of it if the line is very long; empty if the fault concerns the whole file.
    pub snippet: String,
    /// Characters of [`Fault::snippet`] before the faulty ones.
    pub indent: u32,
    /// Number of faulty characters, at least 1 when there is a snippet.
    pub width: u32,
}

impl Fault {
    /// Creates a fault that concerns a whole file.
    pub(crate) fn of_file(path: &Path, message: impl Into<String>, advice: impl Into<String>) -> Fault {
        Fault {
            path: path.to_path_buf(),
            line: 0,
            column: 0,
            message: message.into(),
            advice: advice.into(),
            snippet: String::new(),
            indent: 0,
            width: 0,
        }
    }

    /// Creates a fault for the bytes `range` of `text`. Any range is allowed, also one outside of the text.
    pub(crate) fn at(
        path: &Path,
        text: &str,
        range: Range<usize>,
        message: impl Into<String>,
        advice: impl Into<String>,
    ) -> Fault {
        let start = floor_boundary(text, range.start);
        let end = floor_boundary(text, range.end.max(range.start));
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let line = 1 + text[..line_start].matches('\n').count();
        let before = text[line_start..start].chars().count();
        let marked = text[start..end.clamp(start, line_end)].chars().count().max(1);
        let skipped = if before >= SNIPPET_CHARS { before - 20 } else { 0 };
        let snippet: String = text[line_start..line_end]
            .trim_end()
            .chars()
            .skip(skipped)
            .take(SNIPPET_CHARS)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        Fault {
            path: path.to_path_buf(),
            line: line as u32,
            column: before as u32 + 1,
            message: message.into(),
            advice: advice.into(),
            snippet,
            indent: (before - skipped) as u32,
            width: marked.min(SNIPPET_CHARS) as u32,
        }
    }
}

/// Returns the nearest character boundary at or below `at`.
fn floor_boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Use slashes on every system, so that messages are the same everywhere.
        let path = self.path.to_string_lossy().replace('\\', "/");
        if self.line == 0 {
            write!(f, "{path}: {}", self.message)?;
        } else {
            write!(f, "{path}:{}:{}: {}", self.line, self.column, self.message)?;
            let marks = "^".repeat(self.width as usize);
            let indent = " ".repeat(self.indent as usize);
            write!(f, "\n   | {}\n   | {indent}{marks}", self.snippet)?;
        }
        if !self.advice.is_empty() {
            write!(f, "\n   = {}", self.advice)?;
        }
        Ok(())
    }
}

impl std::error::Error for Fault {}

/// A text with its path. Creates faults from byte ranges.
#[derive(Clone, Copy)]
pub(crate) struct Text<'a> {
    pub(crate) path: &'a Path,
    pub(crate) text: &'a str,
}

impl Text<'_> {
    /// Creates a fault for the bytes `range`.
    pub(crate) fn fault(&self, range: Range<usize>, message: impl Into<String>, advice: impl Into<String>) -> Fault {
        Fault::at(self.path, self.text, range, message, advice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, range: Range<usize>) -> String {
        Fault::at(Path::new("a/b.wgsl"), text, range, "It is wrong.", "Change it.").to_string()
    }

    #[test]
    fn a_fault_shows_line_column_and_the_marked_characters() {
        assert_eq!(
            shown("one\n\ttwö three\n", 10..15),
            "a/b.wgsl:2:6: It is wrong.\n   |  twö three\n   |      ^^^^^\n   = Change it."
        );
    }

    #[test]
    fn any_range_gives_a_fault() {
        for range in [0..0, 3..900, 900..901, 2..3, 4..4] {
            shown("ä\nö\u{2028}x", range);
        }
        shown("", 0..1);
        shown(&"x".repeat(10_000), 9_000..9_999);
    }
}
