//! A graph file and the files it stands among.

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_files::{PathBase, Unread, read_plain};
use sabi_graph::{Document, FlatGraph, FlattenError, Found, NodeRef, Overrides, flatten_and_find, locate};
use sabi_plan::{FileContents, PlanError};

use crate::error::{EngineError, ErrorKind};
use crate::opening::kinds::Kinds;
use crate::source::pictures::Pictures;

/// Graph files larger than this are refused before they are read.
const SIZE_LIMIT_BYTES: u64 = 64 << 20;

/// An open graph file.
#[derive(Clone, Debug)]
pub struct OpenGraph {
    /// Where it is.
    pub path: PathBuf,
    /// What it says.
    pub document: Document,
    /// The file's text, to point into.
    pub text: Arc<str>,
    /// The pictures that its nodes name, as far as they were opened.
    pub pictures: Pictures,
}

impl OpenGraph {
    /// Reads a graph file.
    pub fn open(path: &Path) -> Result<OpenGraph, EngineError> {
        let _span = tracing::debug_span!("open graph", path = %path.display()).entered();
        let text = read_text(path).map_err(|error| error.said(|why| format!("{}: {why}", path.display())))?;
        let document = Document::from_json(&text)
            .map_err(|error| EngineError::of(ErrorKind::BadInput, error.with_name(path.display().to_string())))?;
        Ok(OpenGraph {
            path: path.to_owned(),
            document,
            text: text.into(),
            pictures: Pictures::default(),
        })
    }

    /// Returns the folder that paths in the file start from.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new("")) // A bare file name lies in the current folder.
    }

    /// Returns the base that resolves paths in the file.
    pub fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Looks at these pictures again when they are used next, however little they seem to have changed.
    pub fn look_again(&self, pictures: &BTreeSet<PathBuf>) {
        self.pictures.look_again(pictures);
    }

    /// What is in the files that these nodes of the flat graph name.
    pub(crate) fn file_contents(
        &self,
        graph: &FlatGraph,
        kinds: &Kinds,
        nodes: impl IntoIterator<Item = usize>,
    ) -> FileContents {
        self.pictures.contents(&self.base(), graph, &kinds.sources, nodes)
    }

    /// A sentence about the graph, with the file's path before it.
    pub(crate) fn said(&self, sentence: impl fmt::Display) -> String {
        format!("{}: {sentence}", self.path.display())
    }

    /// What is wrong with a node, with the file's path, line and column before it.
    pub(crate) fn pointed(&self, error: &PlanError, sentence: impl fmt::Display) -> String {
        match locate(&self.text, &error.node, error.problem.member()) {
            Some((line, column)) => format!("{}:{line}:{column}: {sentence}", self.path.display()),
            None => self.said(sentence),
        }
    }

    /// The graph without groups and reroutes, with overrides applied.
    pub fn flatten(&self, overrides: &Overrides) -> Result<FlatGraph, EngineError> {
        self.flatten_and_find(overrides, &[]).map(|(graph, _)| graph)
    }

    /// The same, and where in it the results of some nodes of the document come from.
    pub(crate) fn flatten_and_find(
        &self,
        overrides: &Overrides,
        wanted: &[NodeRef],
    ) -> Result<(FlatGraph, Vec<Found>), EngineError> {
        self.flatten_and_list(overrides, wanted, &mut BTreeSet::new())
    }

    /// The same; `groups` takes in the group files that were looked for, whatever came of it.
    pub(crate) fn flatten_and_list(
        &self,
        overrides: &Overrides,
        wanted: &[NodeRef],
        groups: &mut BTreeSet<PathBuf>,
    ) -> Result<(FlatGraph, Vec<Found>), EngineError> {
        let flat = self.try_flatten(&self.document, overrides, wanted, groups);
        flat.map_err(|(error, of_file)| {
            let kind = if self.is_asked_for(&error, overrides) {
                ErrorKind::Usage
            } else {
                of_file
            };
            EngineError::new(kind, self.said(&error)).caused_by(error)
        })
    }

    /// Flattens; an error comes with its kind if the files are to blame.
    pub(crate) fn try_flatten(
        &self,
        document: &Document,
        overrides: &Overrides,
        wanted: &[NodeRef],
        groups: &mut BTreeSet<PathBuf>,
    ) -> Result<(FlatGraph, Vec<Found>), (FlattenError, ErrorKind)> {
        let base = self.base();
        let mut kind = ErrorKind::BadInput;
        let mut group_file = |name: &str| {
            let path = base.resolve(name);
            groups.insert(path.clone());
            let text = read_text(&path).map_err(|error| {
                kind = error.kind;
                format!("{}: {error}", path.display())
            })?;
            Document::from_json(&text).map_err(|error| error.with_name(path.display().to_string()).to_string())
        };
        flatten_and_find(document, overrides, &mut group_file, wanted).map_err(|error| (error, kind))
    }

    /// Whether an error comes from what was set on top of the files, which are without it otherwise.
    fn is_asked_for(&self, error: &FlattenError, overrides: &Overrides) -> bool {
        let is_gone_without = |less: &Overrides| match self.try_flatten(&self.document, less, &[], &mut BTreeSet::new())
        {
            Ok(_) => true,
            Err((other, _)) => other != *error,
        };
        let without_values = Overrides {
            set: Vec::new(),
            ..overrides.clone()
        };
        // What a variant of the file sets is the file's; that there is such a variant is not.
        is_gone_without(&without_values)
            || matches!(error, FlattenError::NoSuchVariant { .. }) && is_gone_without(&Overrides::default())
    }
}

fn read_text(path: &Path) -> Result<String, EngineError> {
    let bytes = read_plain(path, SIZE_LIMIT_BYTES).map_err(|unread| {
        let missing = |why: &str| EngineError::new(ErrorKind::MissingInput, why);
        match unread {
            Unread::Missing => missing("there is no such file; check the path"),
            Unread::Folder => missing("this is a folder; name a .sabi file"),
            Unread::NotPlain => missing("this is a pipe or a device; name a .sabi file"),
            Unread::Other(reason) => missing(&format!("the file cannot be read: {reason}")),
            Unread::TooLarge(bytes) => {
                let [has, most] = [bytes, SIZE_LIMIT_BYTES].map(|bytes| bytes >> 20);
                let why = format!("the file has {has} MiB; graphs have at most {most}");
                EngineError::new(ErrorKind::BadInput, why)
            }
        }
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let why = format!("the file is not text: byte {at} is not UTF-8; graphs are JSON");
        EngineError::new(ErrorKind::BadInput, why).caused_by(error)
    })
}
