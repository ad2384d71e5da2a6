//! Documents and pictures that a graph names, itself and through its group files.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_files::{PathBase, absolute, canonical, without_detours};
use sabi_graph::{Document, Graph, Node, NodeId, Overrides, Value};

use crate::error::{EngineError, ErrorKind};
use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::session::path_rewrite::with_paths;
use crate::source::pictures::{Pictures, named_file};

/// Most group files, as when a graph is opened.
const MOST_DOCUMENTS: usize = 1000;

/// Files that a graph names.
pub(super) struct Needs {
    /// The graph, and its group files.
    pub(super) documents: Vec<NamedDocument>,
    /// Pictures of its nodes.
    pub(super) pictures: BTreeSet<PathBuf>,
    /// Sentences about files that are missing.
    pub(super) missing: Vec<String>,
}

/// A document with its place.
pub(super) struct NamedDocument {
    /// Its file, as [`whole_path`] gives it.
    pub(super) path: PathBuf,
    pub(super) open: OpenGraph,
}

impl NamedDocument {
    /// Base of its paths.
    pub(super) fn base(&self) -> PathBase {
        PathBase::of_file(&self.path)
    }

    /// Nodes of the graph and of the groups in it, each with words for messages.
    pub(super) fn nodes(&self) -> impl Iterator<Item = (String, &Node)> {
        let named = |group: Option<&str>, (id, node): (&NodeId, &Node)| {
            let place = group.map_or_else(String::new, |group| format!(" in group '{group}'"));
            format!("{}: node '{id}' ({}){place}", self.open.path.display(), node.kind)
        };
        graphs(&self.open.document)
            .flat_map(move |(group, graph)| graph.nodes().map(move |node| (named(group, node), node.1)))
    }
}

/// Graphs of a document: its own, and those of its groups by name.
fn graphs(document: &Document) -> impl Iterator<Item = (Option<&str>, &Graph)> {
    let groups = document
        .groups
        .iter()
        .map(|(name, group)| (Some(name.as_str()), &group.graph));
    std::iter::once((None, &document.graph)).chain(groups)
}

/// Absolute path of a file that a document names, without detours.
pub(super) fn whole_path(base: &PathBase, written: &str) -> PathBuf {
    let read = base.resolve(written);
    let direct = without_detours(&absolute(&read));
    match (canonical(&direct), canonical(&read)) {
        // Behind a link to a folder, `..` leads elsewhere than its text says.
        (there, Ok(real)) if there.as_ref().ok() != Some(&real) => real,
        _ => direct,
    }
}

/// Absolute path of a file that the user names: links to its folder are resolved, but not the file, whose name counts.
pub(super) fn named_path(path: &Path) -> PathBuf {
    let folder = path.parent().unwrap_or(Path::new("")); // A bare name lies in the current folder.
    match (canonical(folder), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => absolute(path),
    }
}

impl Needs {
    /// Collects what a graph names, in all its variants.
    ///
    /// # Errors
    /// A group file is damaged, or a picture is none.
    pub(super) fn of(open: OpenGraph, kinds: &Kinds) -> Result<Needs, EngineError> {
        let mut needs = Needs {
            documents: vec![NamedDocument {
                path: named_path(&open.path),
                open,
            }],
            pictures: BTreeSet::new(),
            missing: Vec::new(),
        };
        let mut known = BTreeSet::from([needs.documents[0].path.clone()]);
        let mut pictures = BTreeMap::new();
        let mut at = 0;
        while let Some(document) = needs.documents.get(at) {
            let base = document.base();
            let mut found = Vec::new();
            for written in paths_in(&document.open.document) {
                let path = whole_path(&base, &written);
                let words = words(document, &written);
                if !written.ends_with(".sabi") {
                    pictures.entry(path).or_insert((written, words));
                } else if known.insert(path.clone()) {
                    found.push((path, words));
                }
            }
            for (path, words) in found {
                needs.open_group(path, &words)?;
            }
            at += 1;
        }
        for (path, written) in needs.pictures_from_outside(kinds) {
            let words = words(&needs.documents[0], &written);
            pictures.entry(path).or_insert((written, words));
        }
        needs.check_pictures(pictures)?;
        Ok(needs)
    }

    fn open_group(&mut self, path: PathBuf, words: &str) -> Result<(), EngineError> {
        if self.documents.len() > MOST_DOCUMENTS {
            let why = format!("the graph uses more than {MOST_DOCUMENTS} group files");
            return Err(EngineError::new(ErrorKind::BadInput, why));
        }
        match OpenGraph::open(&path) {
            Ok(open) => self.documents.push(NamedDocument { path, open }),
            Err(error) if error.kind == ErrorKind::MissingInput => {
                self.missing.push(format!(
                    "{words} names the group file {}, which is missing",
                    path.display()
                ));
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// Pictures that instances of group files bring into these: such a path starts from the group file, and is known only once all
    /// groups are inlined.
    fn pictures_from_outside(&self, kinds: &Kinds) -> Vec<(PathBuf, String)> {
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
                    let base = node
                        .file
                        .as_ref()
                        .map_or_else(|| base.clone(), |file| base.base_of(file));
                    found.push((whole_path(&base, written), written.to_owned()));
                }
            }
        }
        found
    }

    fn check_pictures(&mut self, pictures: BTreeMap<PathBuf, (String, String)>) -> Result<(), EngineError> {
        let reader = Pictures::default();
        let mut bad = Vec::new();
        for (path, (written, words)) in pictures {
            match reader.content(&path, &written) {
                Ok(_) => drop(self.pictures.insert(path)),
                Err((_, true)) => self.missing.push(format!(
                    "{words} names the picture {}, which is missing",
                    path.display()
                )),
                // A graph from elsewhere must not make anyone send other files of their computer.
                Err((why, false)) => bad.push(format!("{words}: {why}")),
            }
        }
        match bad.is_empty() {
            true => Ok(()),
            false => Err(EngineError::several(ErrorKind::BadInput, bad)),
        }
    }
}

/// The graph's own values, and each of its variants.
pub(super) fn all_variants(document: &Document) -> Vec<Overrides> {
    let names = document.graph.variants().keys().cloned().map(Some);
    let all = std::iter::once(None).chain(names);
    all.map(|variant| Overrides {
        variant,
        ..Overrides::default()
    })
    .collect()
}

/// A document without the model that it is shown on.
pub(super) fn without_model(document: &Document) -> Document {
    let mut document = document.clone();
    if let Some(preview) = &mut document.preview {
        preview.mesh = None;
    }
    document
}

/// Paths of pictures and group files in a document.
fn paths_in(document: &Document) -> BTreeSet<String> {
    let paths = RefCell::new(BTreeSet::new());
    with_paths(&without_model(document), &|path| {
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
    node.unwrap_or_else(|| format!("{}: a published parameter or a variant", document.open.path.display()))
}
