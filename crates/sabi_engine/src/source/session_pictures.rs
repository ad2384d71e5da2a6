//! Pictures that nodes and models name. They are identified by the content of their files, decoded on first use, and shared by all users.

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
use super::mip_chain::{MipChain, PixelReading};

/// Maximum size of picture files. Larger ones are not read.
pub(crate) const SIZE_LIMIT_BYTES: u64 = 1 << 30;
/// Size limit of the decoded pictures that are kept. A single larger picture is kept alone.
const CACHE_LIMIT_BYTES: u64 = 2 << 30;
/// Bytes of a pixel of the smaller copies of a picture. Together, the copies have a third of its pixels.
const COPY_PIXEL_BYTES: u64 = 16;
/// Bytes of a pixel during the upload: half floats including the smaller copies, in a buffer, and again in the texture if
/// the driver keeps textures in the memory of the process.
const UPLOAD_PIXEL_BYTES: u64 = 16;

/// Reason why a picture is unavailable, as a sentence, and its kind.
pub(crate) type PictureFault = (String, FileFaultKind);

/// The pictures of a session; clones share one cache.
#[derive(Clone, Default)]
pub struct SessionPictures {
    cache: Arc<Mutex<PictureCache>>,
}

struct PictureCache {
    /// Bytes of decoded pictures that are kept; a single larger one is kept alone.
    limit_bytes: u64,
    /// Files by path, as they were when last read.
    known: BTreeMap<PathBuf, KnownFile>,
    /// Pictures by key. The one used last is at the end.
    decoded: Vec<([u8; 32], Arc<OpenPicture>)>,
    /// Pictures that are not kept here but may still be in use.
    others: BTreeMap<[u8; 32], Weak<OpenPicture>>,
}

/// A file whose header is that of a picture.
#[derive(Clone)]
struct KnownFile {
    stamp: Option<PictureStamp>,
    /// Hash of the file's bytes.
    content: [u8; 32],
    /// Layers of an OpenEXR file, the one that is shown by default first.
    layers: Vec<String>,
    /// Memory that showing it takes, bytes.
    memory_bytes: u64,
}

/// Length and modification time of a file.
type PictureStamp = (u64, SystemTime);

fn stamp(path: &Path) -> Option<PictureStamp> {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

/// Picture that is shown from a file.
#[derive(Clone, Copy)]
struct PictureLayer<'a> {
    /// Hash of the file's bytes.
    content: [u8; 32],
    /// Name of a layer; empty for the default one.
    layer: &'a str,
}

impl PictureLayer<'_> {
    /// Returns the key of the picture. For the default layer it is the content alone.
    fn key(self) -> [u8; 32] {
        if self.layer.is_empty() {
            return self.content;
        }
        let mut hash = blake3::Hasher::new();
        hash.update(&self.content).update(self.layer.as_bytes());
        *hash.finalize().as_bytes()
    }
}

impl Default for PictureCache {
    fn default() -> PictureCache {
        PictureCache {
            limit_bytes: CACHE_LIMIT_BYTES,
            known: BTreeMap::new(),
            decoded: Vec::new(),
            others: BTreeMap::new(),
        }
    }
}

impl PictureCache {
    /// Finds a decoded picture by the key of what it shows and marks it as the most recently used.
    fn find(&mut self, key: &[u8; 32]) -> Option<Arc<OpenPicture>> {
        let Some(at) = self.decoded.iter().position(|(own, _)| own == key) else {
            let picture = self.others.remove(key)?.upgrade()?;
            self.decoded.push((*key, picture.clone()));
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

impl fmt::Debug for SessionPictures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.lock().known.keys()).finish()
    }
}

/// A decoded picture.
pub(crate) struct OpenPicture {
    /// Values as the file stores them.
    pub(crate) picture: Arc<Picture>,
    /// Layers of its file, the default one first; empty for files other than OpenEXR.
    pub(crate) layers: Vec<String>,
    /// True if a pixel is not opaque.
    is_transparent: bool,
    /// Mip chains, as far down as they were needed, by the number of the reading options.
    levels: [Mutex<MipChain>; 6],
}

impl OpenPicture {
    fn new(picture: Picture, layers: Vec<String>) -> OpenPicture {
        let picture = Arc::new(picture);
        OpenPicture {
            layers,
            is_transparent: is_transparent(&picture),
            levels: PixelReading::ALL.map(|reading| Mutex::new(MipChain::new(picture.clone(), reading))),
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

    /// Returns the options with which the picture is read. If it is opaque everywhere, colors are not weighted by alpha.
    pub(crate) fn reading(&self, wish: PixelReading) -> PixelReading {
        PixelReading {
            by_alpha: wish.by_alpha && self.is_transparent,
            ..wish.named(&self.picture)
        }
    }

    /// Returns the mip chain of the picture, down to the first level with at most `least` pixels along both sides. Levels
    /// are built once, by many threads. Must not be called from a parallel task, which might wait for itself.
    pub(crate) fn levels(&self, wish: PixelReading, least: u32) -> MipChain {
        locked(&self.levels[self.reading(wish).number()]).down_to(least)
    }
}

/// Returns whether a pixel is not opaque.
fn is_transparent(picture: &Picture) -> bool {
    let channels = usize::from(picture.channels);
    if channels != 2 && channels != 4 {
        return false;
    }
    fn any<T: Copy>(samples: &[T], channels: usize, is_clear: impl Fn(T) -> bool) -> bool {
        samples
            .chunks_exact(channels)
            .any(|pixel| is_clear(pixel[channels - 1]))
    }
    match &picture.pixels {
        Pixels::U8(samples) => any(samples, channels, |alpha| alpha < u8::MAX),
        Pixels::U16(samples) => any(samples, channels, |alpha| alpha < u16::MAX),
        Pixels::F32(samples) => any(samples, channels, |alpha| alpha < 1.0),
    }
}

impl SessionPictures {
    /// Limits the decoded pictures that are kept to so many bytes, and never to more than a session's limit.
    pub(crate) fn keep_at_most(&self, bytes: u64) {
        let mut cache = self.lock();
        let limit_bytes = bytes.min(CACHE_LIMIT_BYTES);
        cache.limit_bytes = limit_bytes;
        cache.evict(limit_bytes);
    }

    /// Returns the hash of the file that each of these nodes names, or the fault, such as that showing it takes more than
    /// `memory_bytes`; muted nodes name none.
    pub(crate) fn contents(
        &self,
        base: &PathBase,
        trusted: &TrustedPaths,
        graph: &FlatGraph,
        sources: &SourceKinds,
        nodes: impl IntoIterator<Item = usize>,
        memory_bytes: u64,
    ) -> FileContents {
        let named = nodes.into_iter().filter_map(|index| {
            let node = graph.nodes.get(index).filter(|node| !node.muted)?;
            let (param, path) = named_file(node, sources)?;
            let fault = |param: &str, (why, kind): PictureFault| FileFault {
                param: param.to_owned(),
                why,
                kind,
            };
            let read = allowed_path(base, trusted, node, path)
                .and_then(|file| Ok((self.content(&file, path)?, file)))
                .map_err(|why| fault(param, why));
            let content = read.and_then(|(content, file)| {
                self.check_layer(&file, path, named_layer(node))
                    .map_err(|why| fault(LAYER, why))?;
                self.check_memory(&file, path, memory_bytes)
                    .map_err(|why| fault(param, why))?;
                Ok(content)
            });
            Some((index, content))
        });
        named.collect()
    }

    /// Returns the hash of the file at a path, which is read again if its length or time has changed. `written` is the
    /// path as the graph stores it, for messages.
    pub(crate) fn content(&self, path: &Path, written: &str) -> Result<[u8; 32], PictureFault> {
        // The stamp is read before the content, so that a file that is saved in the meantime counts as changed the next time.
        let stamp = stamp(path);
        if let Some(known) = self.lock().known.get(path)
            && known.stamp == stamp
            && stamp.is_some()
        {
            return Ok(known.content);
        }
        let bytes = read(path, written)?;
        sabi_image::check_header(written, &bytes).map_err(unusable)?;
        let known = KnownFile {
            stamp,
            content: *blake3::hash(&bytes).as_bytes(),
            layers: sabi_image::layer_names(written, &bytes).map_err(unusable)?,
            memory_bytes: memory_of_shown(written, &bytes).map_err(unusable)?,
        };
        let content = known.content;
        self.lock().known.insert(path.to_owned(), known);
        Ok(content)
    }

    /// Checks that showing a file whose content is known takes no more than `memory_bytes`.
    fn check_memory(&self, path: &Path, written: &str, memory_bytes: u64) -> Result<(), PictureFault> {
        let cache = self.lock();
        match cache.known.get(path).map(|known| known.memory_bytes) {
            Some(needed) if needed > memory_bytes => {
                let why = format!(
                    "{written} takes {} MiB of memory once it is open, and {} MiB are for pictures",
                    needed.div_ceil(1 << 20),
                    memory_bytes >> 20
                );
                Err((why, FileFaultKind::TooLarge))
            }
            _ => Ok(()),
        }
    }

    /// Checks that a file whose content is known has a layer; an empty name asks for none.
    fn check_layer(&self, path: &Path, written: &str, layer: &str) -> Result<(), PictureFault> {
        let cache = self.lock();
        let Some(known) = cache.known.get(path).filter(|_| !layer.is_empty()) else {
            return Ok(());
        };
        match known.layers.iter().any(|own| own.eq_ignore_ascii_case(layer)) {
            true => Ok(()),
            false => Err(unusable(ImageError::Layer {
                name: written.to_owned(),
                asked: layer.to_owned(),
                layers: known.layers.clone(),
            })),
        }
    }

    /// Opens the picture at a path with the content that [`SessionPictures::contents`] last returned, since results are cached by that
    /// content; of a file with several layers the one of a name, or the first where the name is empty.
    pub(crate) fn open(&self, path: &Path, written: &str, layer: &str) -> Result<Arc<OpenPicture>, PictureFault> {
        let known = self.lock().known.get(path).map(|known| known.content);
        let content = known.map_or_else(|| self.content(path, written), Ok)?;
        let shown = PictureLayer { content, layer };
        if let Some(picture) = self.lock().find(&shown.key()) {
            return Ok(picture);
        }
        let bytes = read(path, written)?;
        if *blake3::hash(&bytes).as_bytes() != content {
            let why = format!("{written} was saved again while it was in use; try again to use the new version");
            return Err((why, FileFaultKind::Unusable));
        }
        self.decode(written, &bytes, shown).map_err(unusable)
    }

    /// Opens a picture in memory, such as one within the file of a model; `name` is for messages, and `content` the hash of the
    /// bytes.
    pub(crate) fn open_bytes(
        &self,
        name: &str,
        bytes: &[u8],
        content: [u8; 32],
    ) -> Result<Arc<OpenPicture>, ImageError> {
        let shown = PictureLayer { content, layer: "" };
        if let Some(picture) = self.lock().find(&shown.key()) {
            return Ok(picture);
        }
        self.decode(name, bytes, shown)
    }

    fn decode(&self, name: &str, bytes: &[u8], shown: PictureLayer<'_>) -> Result<Arc<OpenPicture>, ImageError> {
        let picture = match shown.layer {
            "" => sabi_image::decode(name, bytes)?,
            layer => sabi_image::decode_layer(name, bytes, layer)?,
        };
        let layers = sabi_image::layer_names(name, bytes)?;
        let picture = Arc::new(OpenPicture::new(picture, layers));
        let mut cache = self.lock();
        cache.decoded.push((shown.key(), picture.clone()));
        let limit_bytes = cache.limit_bytes;
        cache.evict(limit_bytes);
        Ok(picture)
    }

    /// Number of decoded pictures that are kept.
    #[cfg(test)]
    pub(crate) fn kept(&self) -> usize {
        self.lock().decoded.len()
    }

    /// Drops all pictures. They are read again on their next use.
    pub(crate) fn clear(&self) {
        let mut cache = self.lock();
        let limit_bytes = cache.limit_bytes;
        *cache = PictureCache {
            limit_bytes,
            ..PictureCache::default()
        };
    }

    /// Makes these files be read again on their next use, for changes that do not change the length or the time.
    pub(crate) fn look_again(&self, files: &BTreeSet<PathBuf>) {
        self.lock().known.retain(|file, _| !files.contains(file));
    }

    fn lock(&self) -> MutexGuard<'_, PictureCache> {
        locked(&self.cache)
    }
}

/// Returns the memory that a picture takes until a node shows it: that of [`memory_of`], and of its way to the device.
fn memory_of_shown(name: &str, bytes: &[u8]) -> Result<u64, ImageError> {
    let uploaded = sabi_image::decoded_size(name, bytes)?
        .pixels
        .saturating_mul(UPLOAD_PIXEL_BYTES);
    Ok(memory_of(name, bytes, 1)?.saturating_add(uploaded))
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

fn unusable(error: ImageError) -> PictureFault {
    (error.to_string(), FileFaultKind::Unusable)
}

/// Lists the files that the nodes of a graph name and may open.
pub(crate) fn files(base: &PathBase, trusted: &TrustedPaths, graph: &FlatGraph, sources: &SourceKinds) -> Vec<PathBuf> {
    let named = graph.nodes.iter().filter_map(|node| {
        let (_, path) = named_file(node, sources)?;
        (!path.is_empty()).then(|| allowed_path(base, trusted, node, path).ok())?
    });
    named.collect()
}

/// Lists the refusals of files that the nodes of a graph name and may not open.
pub(crate) fn refused(
    base: &PathBase,
    trusted: &TrustedPaths,
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

/// Returns the base of the paths in a node, which start from the file that defines the node. `base` is the graph's.
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
) -> Result<PathBuf, PictureFault> {
    let base = base_of(base, node);
    match trusted.check(&base, path) {
        Err(Unread::Refused(refusal)) => Err(refusal_fault(&refusal)),
        // Other problems are reported when the file is read.
        _ => Ok(base.resolve(path)),
    }
}

/// Returns the parameter with which a node names a file, and the path; the path is empty if no file was chosen.
pub(crate) fn named_file<'n>(node: &'n FlatNode, sources: &'n SourceKinds) -> Option<(&'n str, &'n str)> {
    let params = &sources.get(&node.kind)?.params;
    let param = params.iter().find(|param| param.ty.role == Role::File)?;
    match node.params.get(&param.name) {
        Some(Value::Text(path)) => Some((param.name.as_str(), path.as_str())),
        None => Some((param.name.as_str(), "")),
        // The planner reports values of a wrong type.
        Some(_) => None,
    }
}

/// Parameter of `source/image` that names a layer.
const LAYER: &str = "layer";

/// Returns the name of the layer that a node shows; empty for the default one.
fn named_layer(node: &FlatNode) -> &str {
    match node.params.get(LAYER) {
        Some(Value::Text(layer)) => layer,
        // The planner reports a value of a wrong type.
        _ => "",
    }
}

fn read(path: &Path, written: &str) -> Result<Vec<u8>, PictureFault> {
    if written.is_empty() {
        let why = "no picture is chosen; give the path of one, relative to the file that the node is in";
        return Err((why.to_owned(), FileFaultKind::Missing));
    }
    read_plain(path, SIZE_LIMIT_BYTES).map_err(|unread| why_unread(path, unread))
}

fn refusal_fault(refusal: &Refusal) -> PictureFault {
    let kind = match refusal.folder() {
        Some(_) => FileFaultKind::Refused,
        None => FileFaultKind::NeverOpened,
    };
    (refusal.to_string(), kind)
}

fn why_unread(path: &Path, unread: Unread) -> PictureFault {
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
        Unread::Refused(refusal) => return refusal_fault(&refusal),
        Unread::Other(reason) => format!("{shown} cannot be read: {reason}"),
    };
    (why, FileFaultKind::Missing)
}

#[cfg(test)]
pub(super) mod tests;
