//! Pictures that nodes name: read and decoded once, shared by all nodes that name the same file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::{fmt, fs, io};

use sabi_graph::{FlatGraph, FlatNode, Value};
use sabi_image::{Picture, Pixels};
use sabi_nodes::kind::Role;
use sabi_plan::{FileContents, FileFault};

use crate::kinds::Kinds;
use crate::source::Levels;

/// Files of pictures larger than this are refused before they are read.
const SIZE_LIMIT_BYTES: u64 = 1 << 30;

/// The pictures of a session by path; clones share them.
#[derive(Clone, Default)]
pub struct Pictures {
    open: Arc<Mutex<BTreeMap<PathBuf, Arc<OpenPicture>>>>,
}

impl fmt::Debug for Pictures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.lock().keys()).finish()
    }
}

/// A decoded picture.
pub(crate) struct OpenPicture {
    /// As its file has it.
    pub(crate) picture: Arc<Picture>,
    /// Hash of the file's bytes.
    content: [u8; 32],
    /// Whether it holds infinite or undefined numbers.
    pub(crate) has_non_numbers: bool,
    levels: [OnceLock<Arc<Levels>>; 2],
}

impl OpenPicture {
    /// The picture and its halves; with `is_srgb` the sRGB curve is undone on everything but alpha.
    pub(crate) fn levels(&self, is_srgb: bool) -> Arc<Levels> {
        let make = || Arc::new(Levels::new(self.picture.clone(), is_srgb, 1));
        self.levels[usize::from(is_srgb)].get_or_init(make).clone()
    }
}

impl Pictures {
    /// What is in the files that these nodes name; muted nodes name none.
    pub(crate) fn contents(
        &self,
        folder: &Path,
        graph: &FlatGraph,
        kinds: &Kinds,
        nodes: impl IntoIterator<Item = usize>,
    ) -> FileContents {
        let named = nodes.into_iter().filter_map(|index| {
            let node = graph.nodes.get(index).filter(|node| !node.muted)?;
            let (param, path) = named_file(node, kinds)?;
            let opened = self.open(&path_of(folder, node, path), path);
            let content = opened
                .map(|picture| picture.content)
                .map_err(|(why, is_missing)| FileFault {
                    param: param.to_owned(),
                    why,
                    is_missing,
                });
            Some((index, content))
        });
        named.collect()
    }

    /// The picture at a path; `written` is that path as the graph has it. The error is a sentence, and whether the file is
    /// missing.
    pub(crate) fn open(&self, path: &Path, written: &str) -> Result<Arc<OpenPicture>, (String, bool)> {
        if let Some(open) = self.lock().get(path) {
            return Ok(open.clone());
        }
        let bytes = read(path, written)?;
        let picture = sabi_image::decode(written, &bytes).map_err(|error| (error.to_string(), false))?;
        let open = Arc::new(OpenPicture {
            content: *blake3::hash(&bytes).as_bytes(),
            has_non_numbers: matches!(&picture.pixels, Pixels::F32(values) if values.iter().any(|value| !value.is_finite())),
            picture: Arc::new(picture),
            levels: [const { OnceLock::new() }; 2],
        });
        self.lock().insert(path.to_owned(), open.clone());
        Ok(open)
    }

    /// Lets go of all pictures; they are read again when they are needed again.
    pub(crate) fn forget(&self) {
        self.lock().clear();
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<PathBuf, Arc<OpenPicture>>> {
        // Pictures are inserted whole, so a panic elsewhere leaves none half made.
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The files that the nodes of a graph name.
pub(crate) fn files(folder: &Path, graph: &FlatGraph, kinds: &Kinds) -> Vec<PathBuf> {
    let named = graph.nodes.iter().filter_map(|node| {
        let (_, path) = named_file(node, kinds)?;
        (!path.is_empty()).then(|| path_of(folder, node, path))
    });
    named.collect()
}

/// Where a path in a node leads: it starts at the folder of the file that the node was written in. `folder` is the
/// graph's.
pub(crate) fn path_of(folder: &Path, node: &FlatNode, path: &str) -> PathBuf {
    match &node.file {
        Some(group) => folder.join(group).with_file_name("").join(path),
        None => folder.join(path),
    }
}

/// The parameter with which a node names a file, and the path; empty when none was chosen.
fn named_file<'n>(node: &'n FlatNode, kinds: &'n Kinds) -> Option<(&'n str, &'n str)> {
    let params = &kinds.sources.get(&node.kind)?.params;
    let param = params.iter().find(|param| param.role == Role::File)?;
    match node.params.get(&param.name) {
        Some(Value::Text(path)) => Some((param.name.as_str(), path.as_str())),
        None => Some((param.name.as_str(), "")),
        // Told with the other values that do not fit.
        Some(_) => None,
    }
}

fn read(path: &Path, written: &str) -> Result<Vec<u8>, (String, bool)> {
    if written.is_empty() {
        let why = "no picture is chosen; give the path of one, relative to the file that the node is in";
        return Err((why.to_owned(), true));
    }
    let shown = path.display();
    let unread = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => {
            let why = format!("there is no file {shown}; check the path, relative to the file that the node is in");
            (why, true)
        }
        _ => (format!("{shown} cannot be read: {error}"), true),
    };
    let metadata = fs::metadata(path).map_err(unread)?;
    if metadata.is_dir() {
        return Err((format!("{shown} is a folder; give the path of a picture in it"), true));
    }
    if metadata.len() > SIZE_LIMIT_BYTES {
        let mib = metadata.len() >> 20;
        let why = format!("{shown} has {mib} MiB; pictures of up to 1024 MiB are read, so make it smaller");
        return Err((why, false));
    }
    fs::read(path).map_err(unread)
}
