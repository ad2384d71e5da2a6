//! Pictures that nodes and models name: identified by the content of their files, decoded on first use, and shared by all that
//! show them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::SystemTime;
use std::{fmt, fs};

use sabi_files::{PathBase, Refusal, TrustedPaths, Unread, read_plain};
use sabi_graph::{FlatGraph, FlatNode, Value};
use sabi_image::{ImageError, Picture, Pixels};
use sabi_nodes::kind::Role;
use sabi_plan::{FileContents, FileFault, FileFaultKind};

use super::SourceKinds;
use super::mip_chain::MipChain;

/// Files of pictures larger than this are not read.
pub(crate) const SIZE_LIMIT_BYTES: u64 = 1 << 30;
/// Size limit of the decoded pictures that are kept; a single larger one is kept alone.
const CACHE_LIMIT_BYTES: u64 = 2 << 30;
/// Bytes of a pixel of the smaller copies of a picture, which are a third of its pixels together.
const COPY_PIXEL_BYTES: u64 = 16;

/// Reason why a picture is unavailable, as a sentence, and its kind.
pub(crate) type Fault = (String, FileFaultKind);

/// The pictures of a session; clones share one cache.
#[derive(Clone, Default)]
pub struct Pictures {
    cache: Arc<Mutex<PictureCache>>,
}

#[derive(Default)]
struct PictureCache {
    /// Files by path, as they were when last read.
    known: BTreeMap<PathBuf, KnownFile>,
    /// Pictures by the hash of their file's bytes, the most recently used last.
    decoded: Vec<([u8; 32], Arc<OpenPicture>)>,
    /// Pictures that are not kept here and that something may still show.
    others: BTreeMap<[u8; 32], Weak<OpenPicture>>,
}

/// A file whose header is that of a picture.
#[derive(Clone, Copy)]
struct KnownFile {
    stamp: Option<Stamp>,
    /// Hash of the file's bytes.
    content: [u8; 32],
}

/// Length and modification time of a file.
type Stamp = (u64, SystemTime);

fn stamp(path: &Path) -> Option<Stamp> {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

impl PictureCache {
    /// Finds a decoded picture and marks it as the most recently used.
    fn find(&mut self, content: &[u8; 32]) -> Option<Arc<OpenPicture>> {
        let Some(at) = self.decoded.iter().position(|(own, _)| own == content) else {
            let picture = self.others.remove(content)?.upgrade()?;
            self.decoded.push((*content, picture.clone()));
            return Some(picture);
        };
        let entry = self.decoded.remove(at);
        let picture = entry.1.clone();
        self.decoded.push(entry);
        Some(picture)
    }

    /// Drops the least recently used pictures until at most `limit` bytes or one picture are kept.
    fn evict(&mut self, limit: u64) {
        let mut bytes: u64 = self.decoded.iter().map(|(_, picture)| picture.bytes()).sum();
        while bytes > limit && self.decoded.len() > 1 {
            let (content, picture) = self.decoded.remove(0);
            bytes -= picture.bytes();
            self.others.insert(content, Arc::downgrade(&picture));
        }
        self.others.retain(|_, picture| picture.strong_count() > 0);
    }
}

impl fmt::Debug for Pictures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.lock().known.keys()).finish()
    }
}

/// A decoded picture.
pub(crate) struct OpenPicture {
    /// Values as the file stores them.
    pub(crate) picture: Arc<Picture>,
    /// True if it holds infinite or undefined numbers.
    pub(crate) has_non_numbers: bool,
    /// Mip chains of its values as they are, and of sRGB decoded, as far down as they were needed.
    levels: [Mutex<MipChain>; 2],
}

impl OpenPicture {
    fn new(picture: Picture) -> OpenPicture {
        let is_odd = |values: &[f32]| values.iter().any(|value| !value.is_finite());
        let has_non_numbers = matches!(&picture.pixels, Pixels::F32(values) if is_odd(values));
        let picture = Arc::new(picture);
        OpenPicture {
            has_non_numbers,
            levels: [false, true].map(|is_srgb| Mutex::new(MipChain::new(picture.clone(), is_srgb))),
            picture,
        }
    }

    /// Returns the memory of the picture and of the mip chains that were built, bytes.
    fn bytes(&self) -> u64 {
        let own = match &self.picture.pixels {
            Pixels::U8(values) => size_of_val(values.as_slice()),
            Pixels::U16(values) => size_of_val(values.as_slice()),
            Pixels::F32(values) => size_of_val(values.as_slice()),
        };
        let levels = self.levels.iter().map(|levels| locked(levels).bytes());
        own as u64 + levels.sum::<u64>()
    }

    /// Returns the mip chain of the picture, down to the first level with at most `least` pixels along both sides; with
    /// `is_srgb`, sRGB is decoded in all channels but alpha. Levels are built once, by many threads: not to be called from a
    /// parallel task, which might wait for itself.
    pub(crate) fn levels(&self, is_srgb: bool, least: u32) -> MipChain {
        locked(&self.levels[usize::from(is_srgb)]).down_to(least)
    }
}

impl Pictures {
    /// Returns the hash of the file that each of these nodes names, or the fault; muted nodes name none.
    pub(crate) fn contents(
        &self,
        (base, trusted): (&PathBase, &TrustedPaths),
        graph: &FlatGraph,
        sources: &SourceKinds,
        nodes: impl IntoIterator<Item = usize>,
    ) -> FileContents {
        let named = nodes.into_iter().filter_map(|index| {
            let node = graph.nodes.get(index).filter(|node| !node.muted)?;
            let (param, path) = named_file(node, sources)?;
            let content = allowed_path(base, trusted, node, path).and_then(|file| self.content(&file, path));
            let content = content.map_err(|(why, kind)| FileFault {
                param: param.to_owned(),
                why,
                kind,
            });
            Some((index, content))
        });
        named.collect()
    }

    /// Returns the hash of the file at a path, which is read again if its length or time has changed. `written` is the
    /// path as the graph stores it, for messages.
    pub(crate) fn content(&self, path: &Path, written: &str) -> Result<[u8; 32], Fault> {
        // Read before the content, so that a file that is saved meanwhile counts as changed the next time.
        let stamp = stamp(path);
        if let Some(known) = self.lock().known.get(path)
            && known.stamp == stamp
            && stamp.is_some()
        {
            return Ok(known.content);
        }
        let bytes = read(path, written)?;
        sabi_image::check_header(written, &bytes).map_err(unusable)?;
        let content = *blake3::hash(&bytes).as_bytes();
        self.lock().known.insert(path.to_owned(), KnownFile { stamp, content });
        Ok(content)
    }

    /// Opens the picture at a path with the content that [`Pictures::contents`] last returned, since results are cached by that
    /// content.
    pub(crate) fn open(&self, path: &Path, written: &str) -> Result<Arc<OpenPicture>, Fault> {
        let known = self.lock().known.get(path).map(|known| known.content);
        let content = known.map_or_else(|| self.content(path, written), Ok)?;
        if let Some(picture) = self.lock().find(&content) {
            return Ok(picture);
        }
        let bytes = read(path, written)?;
        if *blake3::hash(&bytes).as_bytes() != content {
            let why = format!("{written} was saved again while it was in use; try again to use the new version");
            return Err((why, FileFaultKind::Unusable));
        }
        self.decode(written, &bytes, content).map_err(unusable)
    }

    /// Opens a picture in memory, such as one within the file of a model; `name` is for messages, and `content` the hash of the
    /// bytes.
    pub(crate) fn open_bytes(
        &self,
        name: &str,
        bytes: &[u8],
        content: [u8; 32],
    ) -> Result<Arc<OpenPicture>, ImageError> {
        if let Some(picture) = self.lock().find(&content) {
            return Ok(picture);
        }
        self.decode(name, bytes, content)
    }

    fn decode(&self, name: &str, bytes: &[u8], content: [u8; 32]) -> Result<Arc<OpenPicture>, ImageError> {
        let picture = Arc::new(OpenPicture::new(sabi_image::decode(name, bytes)?));
        let mut cache = self.lock();
        cache.decoded.push((content, picture.clone()));
        cache.evict(CACHE_LIMIT_BYTES);
        Ok(picture)
    }

    /// Number of decoded pictures that are kept.
    #[cfg(test)]
    pub(crate) fn kept(&self) -> usize {
        self.lock().decoded.len()
    }

    /// Drops all pictures; they are read again on their next use.
    pub(crate) fn clear(&self) {
        *self.lock() = PictureCache::default();
    }

    /// Has these files read again on their next use, for changes that neither length nor time shows.
    pub(crate) fn look_again(&self, files: &BTreeSet<PathBuf>) {
        self.lock().known.retain(|file, _| !files.contains(file));
    }

    fn lock(&self) -> MutexGuard<'_, PictureCache> {
        locked(&self.cache)
    }
}

/// Returns the memory of a picture in memory and of its smaller copies, once it is open, by its header alone; `spaces` is the
/// number of color spaces in which its values are read.
pub(crate) fn memory_of(name: &str, bytes: &[u8], spaces: u64) -> Result<u64, ImageError> {
    let size = sabi_image::decoded_size(name, bytes)?;
    let copies = (size.pixels / 3)
        .saturating_mul(COPY_PIXEL_BYTES)
        .saturating_mul(spaces);
    Ok(size.bytes.saturating_add(copies))
}

/// Locks a state. Every change of these is a single assignment or push, so a panic elsewhere leaves them consistent.
fn locked<T>(state: &Mutex<T>) -> MutexGuard<'_, T> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

fn unusable(error: ImageError) -> Fault {
    (error.to_string(), FileFaultKind::Unusable)
}

/// Lists the files that the nodes of a graph name and may open.
pub(crate) fn files(
    (base, trusted): (&PathBase, &TrustedPaths),
    graph: &FlatGraph,
    sources: &SourceKinds,
) -> Vec<PathBuf> {
    let named = graph.nodes.iter().filter_map(|node| {
        let (_, path) = named_file(node, sources)?;
        (!path.is_empty()).then(|| allowed_path(base, trusted, node, path).ok())?
    });
    named.collect()
}

/// Lists the refusals of files that the nodes of a graph name and may not open.
pub(crate) fn refused(
    (base, trusted): (&PathBase, &TrustedPaths),
    graph: &FlatGraph,
    sources: &SourceKinds,
) -> Vec<Refusal> {
    let named = graph.nodes.iter().filter_map(|node| {
        let (_, path) = named_file(node, sources)?;
        match trusted.check(&base_of(base, node), path) {
            Err(Unread::Refused(refusal)) => Some(refusal),
            _ => None,
        }
    });
    named.collect()
}

/// Returns the base of the paths in a node, which start from the file that defines it. `base` is the graph's.
pub(crate) fn base_of(base: &PathBase, node: &FlatNode) -> PathBase {
    node.file
        .as_ref()
        .map_or_else(|| base.clone(), |group| base.base_of(group))
}

/// Returns the file that a path in a node leads to.
///
/// # Errors
/// The node may not open it.
pub(crate) fn allowed_path(
    base: &PathBase,
    trusted: &TrustedPaths,
    node: &FlatNode,
    path: &str,
) -> Result<PathBuf, Fault> {
    let base = base_of(base, node);
    match trusted.check(&base, path) {
        Err(Unread::Refused(refusal)) => Err((refusal.to_string(), FileFaultKind::Refused)),
        // Everything else is told when it is read.
        _ => Ok(base.resolve(path)),
    }
}

/// Returns the parameter with which a node names a file, and the path; empty where no file was chosen.
pub(crate) fn named_file<'n>(node: &'n FlatNode, sources: &'n SourceKinds) -> Option<(&'n str, &'n str)> {
    let params = &sources.get(&node.kind)?.params;
    let param = params.iter().find(|param| param.ty.role == Role::File)?;
    match node.params.get(&param.name) {
        Some(Value::Text(path)) => Some((param.name.as_str(), path.as_str())),
        None => Some((param.name.as_str(), "")),
        // The planner reports it with the other values of a wrong type.
        Some(_) => None,
    }
}

fn read(path: &Path, written: &str) -> Result<Vec<u8>, Fault> {
    if written.is_empty() {
        let why = "no picture is chosen; give the path of one, relative to the file that the node is in";
        return Err((why.to_owned(), FileFaultKind::Missing));
    }
    read_plain(path, SIZE_LIMIT_BYTES).map_err(|unread| why_unread(path, unread))
}

fn why_unread(path: &Path, unread: Unread) -> Fault {
    let shown = path.display();
    let why = match unread {
        Unread::Missing => {
            format!("there is no file {shown}; check the path, relative to the file that the node is in")
        }
        Unread::Folder => format!("{shown} is a folder; give the path of a picture in it"),
        Unread::NotPlain => {
            format!("{shown} is a pipe or a device, which may have no end; give the path of a picture file")
        }
        Unread::TooLarge(bytes) => {
            let mib = bytes >> 20;
            let why = format!("{shown} has {mib} MiB; pictures of up to 1024 MiB are read, so make it smaller");
            return (why, FileFaultKind::Unusable);
        }
        Unread::Refused(refusal) => return (refusal.to_string(), FileFaultKind::Refused),
        Unread::Other(reason) => format!("{shown} cannot be read: {reason}"),
    };
    (why, FileFaultKind::Missing)
}

#[cfg(test)]
pub(super) mod tests;
