//! Failures to read a graph file, with their positions in its text.

use std::fmt;

use crate::json::{Json, JsonError, JsonErrorKind};
use crate::problem::{Problem, quoted};
use crate::text_position::line_and_column;

/// Failure to read a graph file. Prints as `graph.sabi:12:7: node "edges", input "mask": …`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The file's name for messages (see [`FileError::with_name`]).
    pub name: Option<String>,
    /// Line in the text, from 1.
    pub line: usize,
    /// Column in the line, in characters from 1.
    pub column: usize,
    /// The group with the error; `None` for the main graph.
    pub group: Option<String>,
    /// The node with the error.
    pub node: Option<String>,
    /// The input of that node with the error.
    pub port: Option<String>,
    /// Error at this position.
    pub problem: Box<FileProblem>,
}

/// Error in a graph file, without its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileProblem {
    /// The text is not JSON.
    #[error("{0}")]
    Syntax(String),
    /// The file exceeds the limits of size.
    #[error("the file is larger than 64 MiB or has more than 4 million values; this is no graph that anybody made")]
    TooLarge,
    /// The file is JSON, but not a graph file.
    #[error("this is not a Sabi graph: it must be an object that begins with \"format\": \"sabi\"")]
    NotSabi,
    /// The file has a newer version than this program reads.
    #[error(
        "written by a newer Sabi (version {version}; this one reads up to {newest}); open it with that one, \
         or install it here"
    )]
    Newer {
        /// The version in the file.
        version: String,
        /// The newest version that is read.
        newest: u32,
    },
    /// The value of a key has the wrong type.
    #[error("{key} must be {expected}, not {found}")]
    Expected {
        /// The key, quoted.
        key: String,
        /// Expected value, with an example where it helps.
        expected: String,
        /// Found value.
        found: String,
    },
    /// A required key is missing.
    #[error("{key} is missing; {advice}")]
    Missing {
        /// The key, quoted.
        key: String,
        /// Advice on what to write.
        advice: &'static str,
    },
    /// The graph is invalid.
    #[error(transparent)]
    Graph(#[from] Problem),
}

impl FileError {
    /// Returns this error with the name of the file for messages.
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "{name}:{}:{}: ", self.line, self.column)?,
            None => write!(f, "line {}, column {}: ", self.line, self.column)?,
        }
        let parts = [("group", &self.group), ("node", &self.node), ("input", &self.port)];
        let mut named = parts
            .iter()
            .filter_map(|(what, name)| Some((what, name.as_ref()?)))
            .peekable();
        while let Some((what, name)) = named.next() {
            let end = if named.peek().is_some() { ", " } else { ": " };
            write!(f, "{what} {}{end}", quoted(name))?;
        }
        write!(f, "{}", self.problem)
    }
}

impl std::error::Error for FileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(self.problem.as_ref())
    }
}

/// A [`FileError`] with a byte offset. Line and column are added later, since computing them needs the text.
#[derive(Debug)]
pub(crate) struct ReadError {
    at: usize,
    group: Option<String>,
    node: Option<String>,
    port: Option<String>,
    problem: Box<FileProblem>,
}

impl ReadError {
    pub(crate) fn new(at: usize, problem: impl Into<FileProblem>) -> Self {
        ReadError {
            at,
            group: None,
            node: None,
            port: None,
            problem: Box::new(problem.into()),
        }
    }

    /// Returns the error for a `key` whose value is not the expected one.
    pub(crate) fn expected(found: &Json, key: &str, expected: impl Into<String>) -> Self {
        ReadError::new(
            found.at,
            FileProblem::Expected {
                key: quoted(key),
                expected: expected.into(),
                found: found.description(),
            },
        )
    }

    pub(crate) fn in_group(mut self, name: &str) -> Self {
        self.group.get_or_insert_with(|| name.to_owned());
        self
    }

    pub(crate) fn in_node(mut self, id: &str) -> Self {
        self.node.get_or_insert_with(|| id.to_owned());
        self
    }

    pub(crate) fn in_port(mut self, input: &str) -> Self {
        self.port.get_or_insert_with(|| input.to_owned());
        self
    }

    /// Converts the offset to a line and a column of `text`.
    pub(crate) fn in_text(self, text: &str) -> FileError {
        let (line, column) = line_and_column(text, self.at);
        FileError {
            name: None,
            line,
            column,
            group: self.group,
            node: self.node,
            port: self.port,
            problem: self.problem,
        }
    }
}

impl From<JsonError> for ReadError {
    fn from(error: JsonError) -> Self {
        ReadError::new(
            error.at,
            match error.kind {
                JsonErrorKind::Syntax(sentence) => FileProblem::Syntax(sentence),
                JsonErrorKind::TooLarge => FileProblem::TooLarge,
            },
        )
    }
}
