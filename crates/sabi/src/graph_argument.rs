//! Graph that a command line names: a file, or standard input.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use sabi_engine::{Kinds, OpenGraph};
use sabi_files::TrustedPaths;

use crate::exit::{Exit, Failure};

/// Graph that a command line names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct GraphArgument {
    path: PathBuf,
    is_piped: bool,
}

/// Name of the graph from standard input, in messages and reports.
const NAME: &str = "standard input";

/// True once standard input was read.
static WAS_READ: AtomicBool = AtomicBool::new(false);

impl From<OsString> for GraphArgument {
    fn from(text: OsString) -> GraphArgument {
        let is_piped = text == "-";
        let path = if is_piped { NAME.into() } else { text.into() };
        GraphArgument { path, is_piped }
    }
}

impl GraphArgument {
    /// Returns the path of the file as given, or words for standard input.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Opens the graph, which may open files that it names below `trusted`. Standard input is read completely, and only once; relative
    /// paths in it start from the current folder.
    pub(crate) fn open(&self, trusted: &TrustedPaths) -> Result<OpenGraph, Failure> {
        if !self.is_piped {
            return Ok(OpenGraph::open_trusting(&self.path, trusted)?);
        }
        if WAS_READ.swap(true, Ordering::Relaxed) {
            let why = "standard input holds one graph, but - stands more than once".to_owned();
            return Err(Failure::new(Exit::Usage, why));
        }
        let mut open = OpenGraph::read(NAME, io::stdin().lock())?;
        open.trusted = open.trusted.with(trusted);
        Ok(open)
    }

    /// Reads the graph with its kinds if it comes from standard input; `None` for a file.
    pub(crate) fn piped(&self, trusted: &TrustedPaths) -> Result<Option<(OpenGraph, Kinds)>, Failure> {
        if !self.is_piped {
            return Ok(None);
        }
        let open = self.open(trusted)?;
        let kinds = Kinds::beside(Some(&open.path), &open.trusted);
        Ok(Some((open, kinds)))
    }

    /// Returns the path of the graph's file. Refuses standard input for a command that needs a file; `need` is a clause that says why.
    pub(crate) fn file(&self, need: &str) -> Result<&Path, Failure> {
        if self.is_piped {
            let why = format!("{need}; name a file in place of -");
            return Err(Failure::new(Exit::Usage, why));
        }
        Ok(&self.path)
    }
}
