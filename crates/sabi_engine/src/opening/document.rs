//! A graph file in memory, with access to the files that it names.

use std::collections::BTreeSet;
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_files::{PathBase, Refusal, TrustedPaths, Unread, io_reason, is_git_lfs_pointer, read_plain};
use sabi_graph::{
    Document, FlatGraph, FlattenError, Locator, NodeRef, Overrides, ResultOrigin, flatten_and_find, unknown_keys,
};
use sabi_plan::{FileContents, PlanError};

use crate::error::{EngineError, ErrorKind};
use crate::opening::kinds::Kinds;
use crate::opening::unread::{kind_of_unread, why_unread};
use crate::phases::{Progress, unless_canceled};
use crate::remedy::Remedy;
use crate::source::session_pictures::SessionPictures;
use crate::source::strokes::Strokes;

/// Maximum size. Larger graph files are refused before they are read.
pub(crate) const SIZE_LIMIT_BYTES: u64 = 64 << 20;

/// First bytes of an archive, for example of a packed graph.
const ARCHIVE: &[u8] = b"PK\x03\x04";

/// An open graph file.
#[derive(Clone, Debug)]
pub struct OpenGraph {
    /// Path of the file.
    pub path: PathBuf,
    /// Parsed content of the file.
    pub document: Document,
    /// Text of the file, for finding the positions of faults.
    pub text: Arc<str>,
    /// Pictures that its nodes name, as far as they have been opened.
    pub pictures: SessionPictures,
    /// Strokes of its paint nodes, as far as they have been read or painted.
    pub strokes: Strokes,
    /// Paths outside of the graph's folder from which the graph may open files.
    pub trusted: TrustedPaths,
}

impl OpenGraph {
    /// Creates an empty graph, as if it were in a file of this name.
    pub fn empty(path: impl Into<PathBuf>) -> OpenGraph {
        OpenGraph::of_document(path, Document::new(""))
    }

    /// Creates a graph in memory, as if it were in a file of this name that the user names.
    pub fn of_document(path: impl Into<PathBuf>, document: Document) -> OpenGraph {
        let path = path.into();
        let trusted = TrustedPaths::of_file(&path);
        OpenGraph {
            text: document.to_json().into(),
            pictures: SessionPictures::default(),
            strokes: Strokes::trusting(&trusted),
            trusted,
            document,
            path,
        }
    }

    /// Reads a graph file that the user names.
    pub fn open(path: &Path) -> Result<OpenGraph, EngineError> {
        OpenGraph::open_trusting(path, &TrustedPaths::default())
    }

    /// Reads a graph file that the user names. The graph may open the files that it names below these paths, below its
    /// folder, and in the project to which it belongs.
    pub fn open_trusting(path: &Path, trusted: &TrustedPaths) -> Result<OpenGraph, EngineError> {
        let _span = tracing::debug_span!("open graph", path = %path.display()).entered();
        OpenGraph::of_text(path, read_text(path), trusted.clone().with_file(path))
    }

    /// Reads a graph file that the user names, and the kinds of its nodes. Can be canceled at any moment.
    pub(crate) fn open_with_kinds(
        path: PathBuf,
        trusted: TrustedPaths,
        progress: &dyn Progress,
    ) -> Result<(OpenGraph, Kinds), EngineError> {
        unless_canceled(progress, move || {
            let open = OpenGraph::open_trusting(&path, &trusted)?;
            let kinds = Kinds::beside(Some(&path), &open.trusted);
            Ok((open, kinds))
        })?
    }

    /// Reads a group file that this graph names as `written`, if it may open it. The group may open the same files as this graph.
    pub fn open_group(&self, written: &str) -> Result<OpenGraph, EngineError> {
        let base = self.base();
        if let Err(Unread::Refused(refusal)) = self.trusted.check(&base, written) {
            return Err(EngineError::refused(&refusal));
        }
        OpenGraph::open_at(&base.resolve(written), self.trusted.clone())
    }

    /// Reads a graph file that may be opened.
    pub(crate) fn open_at(path: &Path, trusted: TrustedPaths) -> Result<OpenGraph, EngineError> {
        OpenGraph::of_text(path, read_text(path), trusted)
    }

    /// Reads a graph from a stream, as if it were in a file of this name in the current folder. Relative paths in it start
    /// from that folder.
    pub fn read(name: impl AsRef<Path>, stream: impl Read) -> Result<OpenGraph, EngineError> {
        let mut bytes = Vec::new();
        let read = stream.take(SIZE_LIMIT_BYTES + 1).read_to_end(&mut bytes);
        let bytes = match read {
            Err(error) => Err(unread_graph(&Unread::Other(io_reason(&error)))),
            Ok(_) if bytes.len() as u64 > SIZE_LIMIT_BYTES => {
                let most = SIZE_LIMIT_BYTES >> 20;
                let why = format!("it goes on after {most} MiB; graphs have at most that");
                Err(EngineError::new(ErrorKind::BadInput, why))
            }
            Ok(_) => Ok(bytes),
        };
        let name = name.as_ref();
        OpenGraph::of_text(name, bytes.and_then(text_of), TrustedPaths::of_file(name))
    }

    /// Returns the graph's text if it differs from its file: with unsaved changes, or from another origin.
    pub(crate) fn unsaved_text(&self) -> Option<String> {
        let text = self.document.to_json();
        let is_saved = read_text(&self.path).is_ok_and(|saved| saved == text);
        (!is_saved).then_some(text)
    }

    fn of_text(
        path: &Path,
        text: Result<String, EngineError>,
        trusted: TrustedPaths,
    ) -> Result<OpenGraph, EngineError> {
        let text = text.map_err(|error| error.map_messages(|why| format!("{}: {why}", path.display())))?;
        let document = Document::from_json(&text)
            .map_err(|error| EngineError::of(ErrorKind::BadInput, error.with_name(path.display().to_string())))?;
        Ok(OpenGraph {
            path: path.to_owned(),
            document,
            text: text.into(),
            pictures: SessionPictures::default(),
            strokes: Strokes::trusting(&trusted),
            trusted,
        })
    }

    /// Returns the folder from which paths in the file start.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new("")) // A bare file name refers to the current folder.
    }

    /// Returns the base that resolves paths in the file.
    pub fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Reads these pictures again on their next use: a file may have changed without a change of its length or time.
    pub fn look_again(&self, pictures: &BTreeSet<PathBuf>) {
        self.pictures.look_again(pictures);
    }

    /// Returns the hash of the file that each of these nodes of the flat graph names, or the fault.
    pub(crate) fn file_contents(
        &self,
        graph: &FlatGraph,
        kinds: &Kinds,
        nodes: impl IntoIterator<Item = usize>,
    ) -> FileContents {
        self.pictures
            .contents(&self.base(), &self.trusted, graph, &kinds.sources, nodes, u64::MAX)
    }

    /// Lists the keys of the file that are not used, as sentences that begin with the file's path, line and column.
    pub fn unknown_keys(&self) -> Vec<String> {
        let found = unknown_keys(&self.text);
        let path = self.path.display();
        let more =
            (found.more > 0).then(|| format!("{path}: {} more keys that nothing reads are left out", found.more));
        let first = found.first.into_iter();
        first
            .map(|key| format!("{path}:{}:{}: {key}", key.line, key.column))
            .chain(more)
            .collect()
    }

    /// Returns a sentence about the graph that begins with the file's path.
    pub(crate) fn with_path(&self, sentence: impl fmt::Display) -> String {
        format!("{}: {sentence}", self.path.display())
    }

    /// Returns a search for the positions of nodes in the file.
    pub(crate) fn locator(&self) -> Locator<'_> {
        Locator::new(&self.text)
    }

    /// Returns a sentence about a faulty node that begins with the file's path, line and column. `locator` is that of the file.
    pub(crate) fn with_position(
        &self,
        locator: &Locator<'_>,
        error: &PlanError,
        sentence: impl fmt::Display,
    ) -> String {
        match locator.locate(&error.node, error.problem.member()) {
            Some((line, column)) => format!("{}:{line}:{column}: {sentence}", self.path.display()),
            None => self.with_path(sentence),
        }
    }

    /// Flattens the graph with overrides applied.
    pub fn flatten(&self, overrides: &Overrides) -> Result<FlatGraph, EngineError> {
        self.flatten_and_find(overrides, &[]).map(|(graph, _)| graph)
    }

    /// Flattens the graph, and finds where the results of some nodes of the document come from.
    pub(crate) fn flatten_and_find(
        &self,
        overrides: &Overrides,
        wanted: &[NodeRef],
    ) -> Result<(FlatGraph, Vec<ResultOrigin>), EngineError> {
        self.flatten_and_list(overrides, wanted, &mut BTreeSet::new())
    }

    /// Flattens the graph like [`OpenGraph::flatten_and_find`]. Adds the group files that were searched to `groups`, even
    /// if flattening fails.
    pub(crate) fn flatten_and_list(
        &self,
        overrides: &Overrides,
        wanted: &[NodeRef],
        groups: &mut BTreeSet<PathBuf>,
    ) -> Result<(FlatGraph, Vec<ResultOrigin>), EngineError> {
        let flat = self.try_flatten(&self.document, overrides, wanted, groups);
        flat.map_err(|(error, of_file)| {
            let kind = if self.is_caused_by(&error, overrides) {
                ErrorKind::Usage
            } else {
                of_file.kind
            };
            let told = EngineError::new(kind, self.with_path(&error)).caused_by(error);
            told.with_remedies(of_file.remedy())
        })
    }

    /// Flattens a document as if it were in this file. If files cause an error, its class is returned as well.
    pub(crate) fn try_flatten(
        &self,
        document: &Document,
        overrides: &Overrides,
        wanted: &[NodeRef],
        groups: &mut BTreeSet<PathBuf>,
    ) -> Result<(FlatGraph, Vec<ResultOrigin>), (FlattenError, FileClass)> {
        let base = self.base();
        let mut class = FileClass::default();
        let mut trusted = self.trusted.clone();
        let mut group_file = |name: &str| {
            let path = base.resolve(name);
            if let Err(Unread::Refused(refusal)) = trusted.check(&base, name) {
                let why = refusal.to_string();
                class = FileClass::refused(refusal);
                return Err(why);
            }
            groups.insert(path.clone());
            let text = read_text(&path).map_err(|error| {
                class.kind = error.kind;
                format!("{}: {error}", path.display())
            })?;
            // A group may name files in its own folder.
            let folder = path.parent().unwrap_or(Path::new("")); // A bare name refers to the current folder.
            trusted = std::mem::take(&mut trusted).with_path(folder);
            Document::from_json(&text).map_err(|error| error.with_name(path.display().to_string()).to_string())
        };
        flatten_and_find(document, overrides, &mut group_file, wanted).map_err(|error| (error, class))
    }

    /// Returns true if an error is caused by the overrides, that is, if it does not occur without them.
    fn is_caused_by(&self, error: &FlattenError, overrides: &Overrides) -> bool {
        let is_gone_without = |less: &Overrides| match self.try_flatten(&self.document, less, &[], &mut BTreeSet::new())
        {
            Ok(_) => true,
            Err((other, _)) => other != *error,
        };
        let without_values = Overrides {
            set: Vec::new(),
            ..overrides.clone()
        };
        // The values of a variant belong to the file. If a variant is missing, its name belongs to the overrides.
        is_gone_without(&without_values)
            || matches!(error, FlattenError::NoSuchVariant { .. }) && is_gone_without(&Overrides::default())
    }
}

/// Class of an error that a group file causes.
pub(crate) struct FileClass {
    kind: ErrorKind,
    /// Reason that a file may not be opened.
    pub(crate) refusal: Option<Box<Refusal>>,
}

impl FileClass {
    fn refused(refusal: Refusal) -> FileClass {
        FileClass {
            kind: ErrorKind::MissingInput,
            refusal: Some(Box::new(refusal)),
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        let folder = self.refusal.as_ref().and_then(|refusal| refusal.folder());
        folder.map(|_| Remedy::TrustFile)
    }
}

impl Default for FileClass {
    fn default() -> FileClass {
        FileClass {
            kind: ErrorKind::BadInput,
            refusal: None,
        }
    }
}

fn read_text(path: &Path) -> Result<String, EngineError> {
    read_plain(path, SIZE_LIMIT_BYTES)
        .map_err(|unread| unread_graph(&unread))
        .and_then(text_of)
}

fn unread_graph(unread: &Unread) -> EngineError {
    let why = why_unread(unread, ".sabi", "graphs", SIZE_LIMIT_BYTES);
    EngineError::new(kind_of_unread(unread), why)
}

fn text_of(bytes: Vec<u8>) -> Result<String, EngineError> {
    if bytes.starts_with(ARCHIVE) {
        let why = "this is a zip archive and no graph; if it is a packed graph, unpack it first with 'sabi unpack'";
        return Err(EngineError::new(ErrorKind::BadInput, why));
    }
    if is_git_lfs_pointer(&bytes) {
        let why = "this is a Git LFS pointer instead of the graph itself; run `git lfs pull` where it came from";
        return Err(EngineError::new(ErrorKind::BadInput, why));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let why = format!("the file is not text: byte {at} is not UTF-8; graphs are JSON");
        EngineError::new(ErrorKind::BadInput, why).caused_by(error)
    })
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[test]
    fn a_pointer_of_git_lfs_is_told_instead_of_a_fault_of_json() {
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
        assert_eq!(
            text_of(pointer.to_vec()).unwrap_err().to_string(),
            "this is a Git LFS pointer instead of the graph itself; run `git lfs pull` where it came from"
        );
        assert_eq!(text_of(b"{}".to_vec()).unwrap(), "{}");
    }
}
