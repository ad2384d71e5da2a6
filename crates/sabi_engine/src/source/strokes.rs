//! Strokes of paint nodes. They are read from the folder beside a graph, kept for all evaluations, and stored as they are painted.

mod brush_pictures;
mod files;
mod lost_points;
mod paint_changes;
mod retired_versions;
mod rewriting;
mod stroke_files;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use sabi_files::{Disk, PathBase, TrustedPaths, Unread};
use sabi_gpu::PlaneData;
use sabi_paint::{
    CanvasLayers, Canvases, InputColors, PaintSurface, PaintedStrokes, PictureName, Step, Stroke, StrokeBook,
    StrokeList, Supplies, SurfaceIndex, Version,
};

use brush_pictures::KeptPicture;
pub(crate) use brush_pictures::picture_folder;
pub(crate) use lost_points::title;
use paint_changes::LatestCanvas;
pub(crate) use paint_changes::PaintedNodePlace;
use retired_versions::RetiredVersions;
pub use rewriting::FlattenedFile;
pub(crate) use rewriting::FlattenedStrokes;
pub(crate) use stroke_files::files_beside;

use super::texels::SourceSurface;

/// Size limit of the canvases that are kept.
const CANVAS_LIMIT_BYTES: usize = 1 << 30;

/// Strokes of a session; clones share them.
#[derive(Clone, Default)]
pub struct Strokes {
    state: Arc<Mutex<StrokesState>>,
    /// Locked separately, since painting takes long and a window needs the rest in the meantime.
    canvases: Arc<Mutex<Canvases>>,
    /// Canvases that nodes used last, the latest at the end.
    latest: Arc<Mutex<VecDeque<LatestCanvas>>>,
}

#[derive(Default)]
struct StrokesState {
    disk: Disk,
    /// Paths outside of the graph's folder from which links in the folder of strokes may be read.
    trusted: TrustedPaths,
    book: StrokeBook,
    /// Model on which each version was painted: the name of its file without the extension.
    models: BTreeMap<Version, String>,
    /// Stroke files that were searched, whether they exist or not.
    files: BTreeMap<PathBuf, StrokeFile>,
    /// Versions of the unfinished stroke, and the version before them. They are replaced while the stroke grows.
    drawn: Option<(Version, Vec<Version>)>,
    /// Versions of unfinished strokes to which nothing refers any more.
    retired: RetiredVersions,
    /// Pictures of brushes that are in memory.
    pictures: BTreeMap<PictureName, KeptPicture>,
    /// Files of pictures that could not be used, as they were then.
    bad_pictures: BTreeMap<PathBuf, StrokeFileStamp>,
}

/// Length and modification time of a file.
type StrokeFileStamp = (u64, SystemTime);

/// A stroke file as it was last read or written.
#[derive(Clone, Debug, Default)]
struct StrokeFile {
    /// Model in its header; `None` if the header was not read.
    model: Option<String>,
    /// Versions whose last step is in the file.
    stored: BTreeSet<Version>,
    /// For a damaged file, the version of its last complete record.
    whole: Option<Version>,
    /// Length and time of the file at that time; `None` if there was none.
    stamp: Option<StrokeFileStamp>,
    /// Reason, as a sentence, why it is not used or only partly used. In this case it is not written to.
    fault: Option<String>,
}

impl fmt::Debug for Strokes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.lock().files.keys()).finish()
    }
}

/// Strokes of a paint node on a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StrokeSearch {
    /// Nothing was painted.
    Nothing,
    /// The strokes of this version.
    Strokes(Version),
    /// There are strokes only on other models; their names.
    OtherModels(Vec<String>),
    /// Strokes that are not in the folder.
    Missing,
}

impl StrokeSearch {
    /// Returns the version of the strokes; `None` if nothing is painted on the model.
    pub(crate) fn version(&self) -> Option<Version> {
        match self {
            StrokeSearch::Strokes(version) => Some(*version),
            StrokeSearch::Nothing | StrokeSearch::OtherModels(_) | StrokeSearch::Missing => None,
        }
    }
}

/// Folder of the strokes of a graph: beside its file.
pub fn paint_folder(graph: &Path) -> PathBuf {
    graph.with_extension("paint")
}

/// File of the strokes on a model.
fn stroke_file(folder: &Path, model: &str) -> PathBuf {
    let is_plain = |c: char| !c.is_control() && !"/\\:*?\"<>|".contains(c);
    let name: String = model.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    folder.join(format!("{}.strokes", if name.is_empty() { "model" } else { &name }))
}

/// Length and modification time of a file, if it is there.
fn stamp(path: &Path) -> Option<StrokeFileStamp> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

/// Returns the versions that a paint node names, one for each model.
fn versions_of(written: &str) -> impl Iterator<Item = Version> {
    written.split_whitespace().filter_map(|word| word.parse().ok())
}

/// Returns the base of the files that a graph with this folder of strokes finds.
fn base_of(folder: &Path) -> PathBase {
    PathBase::of_file(folder)
}

impl Strokes {
    /// Creates the strokes of a graph that may open files below these paths.
    pub(crate) fn trusting(trusted: &TrustedPaths) -> Strokes {
        let strokes = Strokes::default();
        strokes.trust(trusted);
        strokes
    }

    /// Allows links in the folder of strokes to lead below these paths, too.
    pub(crate) fn trust(&self, trusted: &TrustedPaths) {
        let mut state = self.lock();
        state.trusted = std::mem::take(&mut state.trusted).with(trusted);
        // Refused files are checked again.
        state.files.retain(|_, file| file.fault.is_none());
        state.bad_pictures.clear();
    }

    /// Returns the version that is used of those that a node names; `None` if it names none.
    pub(crate) fn first_version(written: &str) -> Option<Version> {
        versions_of(written).next()
    }

    /// Returns the strokes on a model of a node with these versions. Files of the folder are read on first use.
    pub(crate) fn find(&self, graph: &Path, model: &str, written: &str) -> StrokeSearch {
        if written.trim().is_empty() {
            return StrokeSearch::Nothing;
        }
        let mut state = self.lock();
        let is_known = |state: &StrokesState, version: &Version| state.model_of(*version).is_some();
        if versions_of(written).any(|version| !is_known(&state, &version)) {
            state.read_folder(&paint_folder(graph));
        }
        let known: Vec<(Version, String)> = versions_of(written)
            .filter(|version| is_known(&state, version))
            .filter_map(|version| Some((version, state.model_of(version)?.to_owned())))
            .collect();
        let file = state.files.get(&state.file_of(&paint_folder(graph), model));
        let whole = file.and_then(|file| file.whole);
        match known.iter().find(|(_, own)| own == model) {
            Some((version, _)) => StrokeSearch::Strokes(*version),
            None if known.is_empty() => whole.map_or(StrokeSearch::Missing, StrokeSearch::Strokes),
            None => StrokeSearch::OtherModels(known.into_iter().map(|(_, model)| model).collect()),
        }
    }

    /// Keeps the strokes of a version for an evaluation that begins, even if the stroke is continued in the meantime.
    pub(crate) fn keep_for_evaluation(&self, version: Version, model: &str) {
        let mut state = self.lock();
        if let Some(list) = state.list(version) {
            state.retired.keep(version, list, model.to_owned());
        }
    }

    /// Sentences about faulty stroke files beside a graph.
    pub(crate) fn faults(&self, graph: &Path) -> Vec<String> {
        let folder = paint_folder(graph);
        let state = self.lock();
        let of_folder = state.files.iter().filter(|(file, _)| file.parent() == Some(&folder));
        of_folder.filter_map(|(_, file)| file.fault.clone()).collect()
    }

    /// Returns the strokes on a model of a node with these versions; `None` if nothing is painted there.
    pub fn on_model(&self, graph: &Path, model: &str, written: &str) -> Option<Arc<StrokeList>> {
        let version = self.find(graph, model, written).version()?;
        self.lock().book.list(version)
    }

    /// Returns the versions of a paint node after a step on a model. The version of this model is replaced, and those of
    /// other models are kept.
    pub fn after(&self, graph: &Path, model: &str, written: &str, step: &Step) -> String {
        self.after_steps(graph, model, written, std::slice::from_ref(step))
    }

    /// Returns the versions of a paint node after several steps on a model, like [`Strokes::after`].
    pub fn after_steps(&self, graph: &Path, model: &str, written: &str, steps: &[Step]) -> String {
        let before = self.find(graph, model, written).version().unwrap_or(Version::EMPTY);
        let mut state = self.lock();
        // Earlier versions of the unfinished stroke with the same start are replaced. A finished stroke is not.
        if let Some((from, parts)) = state.drawn.take()
            && from == before
        {
            for part in state.retired.retire(parts) {
                state.book.forget(part);
                state.models.remove(&part);
            }
        }
        let mut parts = Vec::new();
        for step in steps {
            let last = parts.last().copied().unwrap_or(before);
            let version = state.book.push(last, step);
            state.retired.recall(version);
            if version != last {
                state.models.insert(version, model.to_owned());
                parts.push(version);
            }
        }
        let version = parts.last().copied().unwrap_or(before);
        state.drawn = Some((before, parts));
        // The first version of a model is used, so that one whose file comes back later does not hide it.
        let of_others = versions_of(written).filter(|other| {
            let is_own = state.models.get(other).is_some_and(|other| other == model);
            *other != before && !is_own
        });
        let own = (version != Version::EMPTY).then_some(version);
        let all = own.into_iter().chain(of_others).map(|version| version.to_string());
        all.collect::<Vec<String>>().join(" ")
    }

    /// Finishes the stroke that is drawn. The next one is a new stroke.
    pub fn settle(&self) {
        self.lock().drawn = None;
        // The canvases are locked while they are painted. In this case the state of this stroke is replaced by the next stroke.
        if let Ok(mut canvases) = self.canvases.try_lock() {
            canvases.end_strokes();
        }
    }

    /// Stores the strokes of all these versions beside a graph. Strokes on other models keep their own files.
    ///
    /// # Errors
    /// The disk refuses, or the file is damaged; what it holds stays.
    pub fn store(&self, graph: &Path, written: &str) -> Result<(), String> {
        let folder = paint_folder(graph);
        let mut state = self.lock();
        state.drawn = None;
        // If a version cannot be stored, the others are still stored.
        let faults: Vec<String> = versions_of(written)
            .filter_map(|version| state.store(&folder, version).err())
            .collect();
        if faults.is_empty() {
            Ok(())
        } else {
            Err(faults.join("; "))
        }
    }

    /// Pictures of brushes that the strokes of a version lack beside a graph.
    pub(crate) fn missing_pictures(&self, graph: &Path, version: Version) -> Vec<PictureName> {
        let list = self.lock().book.list(version);
        list.map_or_else(Vec::new, |list| self.pictures_of(graph, &list).missing)
    }

    /// Returns true if strokes that a node with these versions has on a model copy the result that is connected to it.
    pub(crate) fn copy_input(&self, graph: &Path, model: &str, written: &str) -> bool {
        let list = self.on_model(graph, model, written);
        list.is_some_and(|list| list.strokes.iter().any(copies))
    }

    /// Returns the canvas of a version of a node, with at least these layers; `None` if the version is not known, or if the
    /// work was canceled. Strokes have no effect if their picture is not beside the graph, or if they copy the result
    /// connected to the node and nothing is connected.
    pub(crate) fn painted(
        &self,
        surface: &SourceSurface<'_>,
        graph: &Path,
        node: &str,
        version: Version,
        layers: CanvasLayers,
        from: Option<&PlaneData>,
    ) -> Option<PaintedStrokes> {
        let list = self.lock().list(version)?;
        let found = self.pictures_of(graph, &list);
        let from = from.filter(|_| list.strokes.iter().any(copies));
        // A canvas with missing pictures, or with another copied result, has another key.
        let mut hash = blake3::Hasher::new();
        hash.update(&surface.key);
        for name in &found.missing {
            hash.update(name.as_str().as_bytes());
        }
        if let Some(from) = from {
            hash.update(from.bytes());
        }
        let key = *hash.finalize().as_bytes();
        let mesh = &surface.model.mesh;
        let index = surface.paint_index.get_or_init(|| SurfaceIndex::new(mesh));
        let progress = surface.progress;
        let is_canceled = || progress.is_canceled();
        let paint_surface = PaintSurface::new(mesh, index).stopped_by(&is_canceled);
        let mut canvases = self.canvases.lock().unwrap_or_else(PoisonError::into_inner);
        let colors = from.map(|from| |texel: usize| color_of(from, texel));
        let supplies = Supplies {
            pictures: &found.pictures,
            input: colors.as_ref().map(|colors| colors as &InputColors<'_>),
        };
        let painted = canvases.painted(
            &paint_surface,
            surface.atlas,
            key,
            &list,
            supplies,
            layers,
            CANVAS_LIMIT_BYTES,
        );
        drop(canvases);
        if paint_surface.is_stopped() {
            return None;
        }
        let place = PaintedNodePlace {
            surface_key: surface.key,
            node: node.to_owned(),
        };
        self.remember_canvas(place, version, &painted.canvas);
        Some(painted)
    }

    /// Reads all strokes beside a graph. Those of a recovery file are in another place than those of the graph.
    pub(crate) fn read_beside(&self, graph: &Path) {
        self.lock().read_folder(&paint_folder(graph));
        self.read_pictures(graph);
    }

    /// Writes strokes to this disk from now on.
    pub(crate) fn turn_to_disk(&self, disk: &Disk) {
        self.lock().disk = disk.clone();
    }

    fn lock(&self) -> MutexGuard<'_, StrokesState> {
        // Each change is complete before the next, so a panic elsewhere leaves the state consistent.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns true if a stroke copies the result that is connected to its node.
fn copies(stroke: &Arc<Stroke>) -> bool {
    stroke.copies_input() && !stroke.leaves_nothing()
}

/// Linear color of a texel of a result.
fn color_of(result: &PlaneData, texel: usize) -> [f32; 3] {
    let [red, green, blue, _] = result.texel(texel);
    [red, green, blue]
}

impl StrokesState {
    /// Returns the model on which a version was painted; `None` if the version is no longer known.
    fn model_of(&self, version: Version) -> Option<&str> {
        let named = self.models.get(&version).filter(|_| self.book.knows(version));
        named
            .map(String::as_str)
            .or_else(|| self.retired.list(version).map(|(_, model)| model))
    }

    /// Reads a file in a folder of strokes or below it. Links may lead only where the graph may read.
    fn read_below(&self, folder: &Path, file: &Path, limit: u64) -> Result<Vec<u8>, Unread> {
        self.trusted.read_at(&base_of(folder), file, limit)
    }

    /// Returns the strokes of a version. The version may be one to which nothing refers any more, if an evaluation began with it.
    fn list(&mut self, version: Version) -> Option<Arc<StrokeList>> {
        let named = self.book.list(version);
        named.or_else(|| self.retired.list(version).map(|(list, _)| Arc::clone(list)))
    }
}
