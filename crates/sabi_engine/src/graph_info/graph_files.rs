//! Files that a graph uses, as `sabi info` lists them.

use std::path::Path;

use sabi_files::{absolute, is_local, whole_path};
use sabi_graph::Node;
use schemars::JsonSchema;
use serde::Serialize;

use crate::opening::document::OpenGraph;
use crate::opening::kinds::Kinds;
use crate::packing::named_files::{NamedDocument, NamedFiles};
use crate::packing::own_nodes::own_nodes;
use crate::source::paint::NAME as PAINT;
use crate::source::strokes::{files_beside, paint_folder};

/// A file that a graph takes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
pub struct FileDescription {
    /// `group`, `model` (which it is shown on), `node`, `picture` or `strokes`.
    pub role: &'static str,
    /// Absolute path.
    pub path: String,
    /// Path as written in the graph or a group file; `None` for files that are found by their location.
    pub written: Option<String>,
    /// True if there is such a file.
    pub exists: bool,
}

/// All files that a graph takes.
pub(super) struct GraphFiles {
    /// The files, by role and path.
    pub(super) files: Vec<FileDescription>,
    /// Sentences about those that are missing or faulty.
    pub(super) warnings: Vec<String>,
    /// True if a group file cannot be opened.
    pub(super) lacks_groups: bool,
}

impl GraphFiles {
    /// Looks for the files of a graph.
    pub(super) fn of(open: &OpenGraph, kinds: &Kinds) -> GraphFiles {
        let named = NamedFiles::of(open.clone(), kinds);
        let (nodes, without_file) = own_nodes(kinds, &Kinds::folders(Some(&open.path)), &named.documents);
        let mut files = named_files(open, &named);
        files.extend(nodes.values().map(|path| FileDescription::new("node", path, None)));
        files.extend(named.documents.iter().flat_map(strokes));
        files.sort();
        let mut warnings = warnings(&named);
        warnings.extend(files.iter().filter_map(FileDescription::missing));
        warnings.extend(without_file);
        GraphFiles {
            files,
            warnings,
            lacks_groups: !named.unopened.is_empty(),
        }
    }
}

/// Describes the files that are written in a graph or in its group files.
fn named_files(open: &OpenGraph, named: &NamedFiles) -> Vec<FileDescription> {
    let file = |role, path: &Path, written: &String| FileDescription::new(role, path, Some(written.clone()));
    let groups = named.documents.iter();
    let groups = groups.filter_map(|group| Some(file("group", &group.path, group.written.as_ref()?)));
    let unopened = named.unopened.iter();
    let unopened = unopened.map(|group| file("group", &group.path, &group.naming.written));
    let pictures = named.pictures.iter();
    let pictures = pictures.map(|(path, naming)| file("picture", path, &naming.written));
    let preview = open.document.preview.as_ref();
    let preview = preview.filter(|preview| preview.builtin_mesh().is_none());
    let model = preview.and_then(|preview| preview.mesh.as_ref());
    let model = model.map(|written| file("model", &whole_path(&open.base(), written), written));
    groups.chain(unopened).chain(pictures).chain(model).collect()
}

fn warnings(named: &NamedFiles) -> Vec<String> {
    let groups = named.unopened.iter().map(|group| {
        let (words, path, why) = (&group.naming.words, group.path.display(), &group.error);
        match group.naming.refusal.is_some() || group.path.exists() {
            true => format!("{words} names the group file {path}, which cannot be opened: {why}"),
            false => format!("{words} names the group file {path}, which is missing"),
        }
    });
    let pictures = named.pictures.iter().filter_map(|(path, naming)| {
        let (words, shown) = (&naming.words, path.display());
        match &naming.refusal {
            Some(refusal) => Some(format!("{words} names a picture that is not read: {refusal}")),
            None if path.is_file() => None,
            None => Some(format!("{words} names the picture {shown}, which is missing")),
        }
    });
    groups.chain(pictures).collect()
}

/// Describes the files of strokes beside a document with painted nodes, for all models; their folder if it has none.
fn strokes(document: &NamedDocument) -> Vec<FileDescription> {
    let is_painted = |node: &Node| node.kind == PAINT && node.params.contains_key("strokes");
    if !document.nodes().any(|(_, node)| is_painted(node)) {
        return Vec::new();
    }
    let folder = paint_folder(&document.path);
    let files = files_beside(&document.path);
    if files.is_empty() {
        return vec![FileDescription::new("strokes", &folder, None)];
    }
    let paths = files.iter().map(|file| folder.join(file));
    paths.map(|path| FileDescription::new("strokes", &path, None)).collect()
}

impl FileDescription {
    /// Returns a sentence about missing models or strokes. Other missing files are reported by the nodes that name them.
    fn missing(&self) -> Option<String> {
        let path = &self.path;
        let sentence = match (self.role, &self.written) {
            _ if self.exists => return None,
            ("model", Some(written)) if !is_local(written) => {
                format!(
                    "the graph is shown on the model {written}, which is not on this computer's disk and is not read"
                )
            }
            ("model", _) => format!("the graph is shown on the model {path}, which is missing"),
            ("strokes", _) => format!("what was painted by hand is missing: there are no strokes in {path}"),
            _ => return None,
        };
        Some(sentence)
    }

    fn new(role: &'static str, path: &Path, written: Option<String>) -> FileDescription {
        FileDescription {
            role,
            exists: written.as_deref().is_none_or(is_local) && path.is_file(),
            path: absolute(path).display().to_string(),
            written,
        }
    }
}
