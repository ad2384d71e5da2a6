//! Documents and pictures that a graph names, directly or through its group files.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_files::{PathBase, Refusal, Unread, named_path, whole_path};
use sabi_graph::{Document, Graph, Node, NodeId, Overrides, Value};

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::session::path_rewrite::document_with_paths;
use crate::source::session_pictures::{base_of, named_file};

/// Maximum number of group files, the same as when a graph is opened.
const MOST_DOCUMENTS: usize = 1000;

/// Files that a graph names in all its variants. Pictures may be missing, or be other files.
pub(crate) struct NamedFiles {
    /// The graph, and its group files.
    pub(crate) documents: Vec<NamedDocument>,
    /// Pictures by their paths.
    pub(crate) pictures: BTreeMap<PathBuf, FileReference>,
    /// Group files that cannot be opened.
    pub(crate) unopened: Vec<UnopenedGroup>,
}

/// Place that names a file.
pub(crate) struct FileReference {
    /// The path as written in the document.
    pub(crate) written: String,
    /// Description of the place in the document, for messages.
    pub(crate) words: String,
    /// Reason that the file may not be opened, if it may not.
    pub(crate) refusal: Option<Refusal>,
}

/// A group file that cannot be opened.
pub(crate) struct UnopenedGroup {
    /// Its path.
    pub(crate) path: PathBuf,
    /// Place that names it.
    pub(crate) naming: FileReference,
    /// Reason.
    pub(crate) error: EngineError,
}

/// A document with its place.
pub(crate) struct NamedDocument {
    /// Its file, as [`whole_path`] gives it.
    pub(crate) path: PathBuf,
    /// Its path as written where it is named first; `None` for the graph itself.
    pub(crate) written: Option<String>,
    pub(crate) open: OpenGraph,
}

impl NamedFiles {
    /// Collects what a graph names.
    pub(crate) fn of(open: OpenGraph, kinds: &Kinds) -> NamedFiles {
        let graph = NamedDocument {
            path: named_path(&open.path),
            written: None,
            open,
        };
        let mut known = BTreeSet::from([graph.path.clone()]);
        let mut named = NamedFiles {
            documents: vec![graph],
            pictures: BTreeMap::new(),
            unopened: Vec::new(),
        };
        let mut at = 0;
        while let Some(document) = named.documents.get(at) {
            let base = document.base();
            let mut groups = Vec::new();
            for written in paths_in(&document.open.document) {
                let path = whole_path(&base, &written);
                let naming = FileReference::of(document, &base, written);
                if !naming.written.ends_with(".sabi") {
                    named.pictures.entry(path).or_insert(naming);
                } else if known.insert(path.clone()) {
                    groups.push((path, naming));
                }
            }
            for (path, naming) in groups {
                named.open_group(path, naming);
            }
            at += 1;
        }
        for (path, base, written) in named.pictures_from_outside(kinds) {
            let naming = FileReference::of(&named.documents[0], &base, written);
            named.pictures.entry(path).or_insert(naming);
        }
        named
    }

    fn open_group(&mut self, path: PathBuf, naming: FileReference) {
        let opened = match (&naming.refusal, self.documents.len()) {
            (Some(refusal), _) => Err(EngineError::refused(refusal)),
            (None, ..=MOST_DOCUMENTS) => OpenGraph::open_at(&path, self.documents[0].open.trusted.clone()),
            (None, _) => {
                let why = format!("the graph uses more than {MOST_DOCUMENTS} group files");
                Err(EngineError::new(ErrorKind::BadInput, why))
            }
        };
        match opened {
            Ok(open) => self.documents.push(NamedDocument {
                path,
                written: Some(naming.written),
                open,
            }),
            Err(error) => self.unopened.push(UnopenedGroup { path, naming, error }),
        }
    }

    /// Returns pictures that instances of group files pass into the groups. Such a path starts from the group file, and is
    /// known only after all groups are inlined.
    fn pictures_from_outside(&self, kinds: &Kinds) -> Vec<(PathBuf, PathBase, String)> {
        let graph = &self.documents[0];
        let base = graph.base();
        let mut found = Vec::new();
        for overrides in all_variants(&graph.open.document) {
            // A graph that cannot be flattened is packed as it is.
            let Ok(flat) = graph.open.flatten(&overrides) else {
                continue;
            };
            for node in &flat.nodes {
                if let Some((_, written)) = named_file(node, &kinds.sources).filter(|(_, written)| !written.is_empty())
                {
                    let base = base_of(&base, node);
                    found.push((whole_path(&base, written), base, written.to_owned()));
                }
            }
        }
        found
    }
}

impl FileReference {
    /// `base` is that of the path.
    fn of(document: &NamedDocument, base: &PathBase, written: String) -> FileReference {
        let refusal = match document.open.trusted.check(base, &written) {
            Err(Unread::Refused(refusal)) => Some(refusal),
            _ => None,
        };
        FileReference {
            words: words(document, &written),
            written,
            refusal,
        }
    }
}

impl NamedDocument {
    /// Base of its paths.
    pub(crate) fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Returns the nodes of the graph and of its groups, each with a description for messages.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = (String, &Node)> {
        let named = |group: Option<&str>, (id, node): (&NodeId, &Node)| {
            let place = group.map_or_else(String::new, |group| format!(" in group '{group}'"));
            format!("{}: node '{id}' ({}){place}", self.open.path.display(), node.kind)
        };
        graphs(&self.open.document)
            .flat_map(move |(group, graph)| graph.nodes().map(move |node| (named(group, node), node.1)))
    }
}

/// Returns the graphs of a document: its own, and those of its groups by name.
fn graphs(document: &Document) -> impl Iterator<Item = (Option<&str>, &Graph)> {
    let groups = document
        .groups
        .iter()
        .map(|(name, group)| (Some(name.as_str()), &group.graph));
    std::iter::once((None, &document.graph)).chain(groups)
}

/// Returns the overrides for the graph's own values, and for each of its variants.
pub(crate) fn all_variants(document: &Document) -> Vec<Overrides> {
    let names = document.graph.variants().keys().cloned().map(Some);
    let all = std::iter::once(None).chain(names);
    all.map(|variant| Overrides {
        variant,
        ..Overrides::default()
    })
    .collect()
}

/// Returns a document without its preview model.
pub(crate) fn without_model(document: &Document) -> Document {
    let mut document = document.clone();
    if let Some(preview) = &mut document.preview {
        preview.mesh = None;
        preview.textures = None;
    }
    document
}

/// Returns the paths of pictures and group files in a document.
fn paths_in(document: &Document) -> BTreeSet<String> {
    let paths = RefCell::new(BTreeSet::new());
    document_with_paths(&without_model(document), &|path| {
        if !path.trim().is_empty() {
            paths.borrow_mut().insert(path.to_owned());
        }
        path.to_owned()
    });
    paths.into_inner()
}

/// Words for what names a path.
fn words(document: &NamedDocument, written: &str) -> String {
    let is_it = |value: &Value| matches!(value, Value::Text(text) if text == written);
    let names_it = |node: &Node| node.group.as_deref() == Some(written) || node.params.values().any(is_it);
    let node = document
        .nodes()
        .find(|(_, node)| names_it(node))
        .map(|(words, _)| words);
    node.unwrap_or_else(|| format!("{}: an exposed parameter or a variant", document.open.path.display()))
}
