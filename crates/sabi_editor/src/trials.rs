//! Pictures of what could be chosen, tried on the open model while nothing else is to do: variants, and effects of the library.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_editing::{OpenDocument, variants};
use sabi_engine::view::Pixels;
use sabi_engine::{Live, LiveEvent, LiveRequest, NodeRef, OpenGraph, load_thumbnail, store_thumbnail, stored_path};
use sabi_graph::{NodeId, PortType};

use crate::evaluation::Evaluation;
use crate::library::Library;

/// Pixels along a side of a picture.
const SIDE: u32 = 192;
/// Texels of the model for them.
const TEXELS: u32 = 256;
/// Most pictures that are kept.
const MOST_PICTURES: usize = 256;

/// What is tried.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Trial {
    /// A variant of the shown graph, or of an instance in it; without a name its own values.
    Variant {
        /// Full id of the shown graph and the instance, which tells those of other graphs apart.
        place: String,
        instance: Option<NodeId>,
        name: Option<String>,
    },
    /// A group of the library, by its file.
    Effect(PathBuf),
}

/// State of what a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct Version {
    /// First revision of the model's file and how it is read.
    model: u64,
    /// The graph, or the digest of the group's file.
    content: String,
}

/// Picture of a trial.
struct Known {
    version: Version,
    /// None where it could not be made.
    picture: Option<Picture>,
    /// Frame in which it was asked for last.
    asked: u64,
}

/// Picture on the model, with the version that it is of.
struct Picture {
    texture: TextureHandle,
    #[cfg(test)]
    pixels: Pixels,
    version: Version,
}

impl Picture {
    #[cfg_attr(not(test), expect(unused_variables, reason = "only tests look at the pixels"))]
    fn new(texture: TextureHandle, pixels: &Pixels, version: &Version) -> Picture {
        Picture {
            texture,
            #[cfg(test)]
            pixels: pixels.clone(),
            version: version.clone(),
        }
    }
}

/// Pictures of trials, and the evaluator that makes them one at a time.
#[derive(Default)]
pub(crate) struct Trials {
    live: Option<Live>,
    /// Number of the last request, and what it is for until it is answered.
    requests: u64,
    running: Option<(Trial, Version)>,
    known: BTreeMap<Trial, Known>,
    /// What was asked for in this frame. Filled while views read, hence the cell.
    asked: RefCell<Vec<Trial>>,
    frame: u64,
    /// Revisions that pictures are compared with in this frame.
    model: u64,
}

/// What the pictures are made of.
pub(crate) struct TrialSource<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) library: &'a Library,
}

impl Trials {
    /// Picture of a trial on the open model, if there is one; asks for it, or for a newer one.
    pub(crate) fn find(&self, trial: Trial) -> Option<TextureId> {
        let known = self.known.get(&trial);
        let picture = known.and_then(|known| known.picture.as_ref());
        let picture = picture.filter(|picture| picture.version.model == self.model);
        self.asked.borrow_mut().push(trial);
        picture.map(|picture| picture.texture.id())
    }

    /// Number of pictures that were begun.
    #[cfg(test)]
    pub(crate) fn begun(&self) -> u64 {
        self.requests
    }

    /// Pixels of the picture of a trial on the open model.
    #[cfg(test)]
    pub(crate) fn pixels_of(&self, is_meant: impl Fn(&Trial) -> bool) -> Option<&Pixels> {
        let (_, known) = self.known.iter().find(|(trial, _)| is_meant(trial))?;
        let picture = known
            .picture
            .as_ref()
            .filter(|picture| picture.version.model == self.model);
        picture.map(|picture| &picture.pixels)
    }

    /// Forgets the pictures of variants, since another graph is opened.
    pub(crate) fn forget_variants(&mut self) {
        self.known.retain(|trial, _| matches!(trial, Trial::Effect(_)));
    }

    /// Takes over the picture that was made, and begins the next one of those that the views have asked for in this frame.
    ///
    /// # Errors
    /// A sentence, where the picture cannot be kept on disk.
    pub(crate) fn advance(&mut self, source: &TrialSource<'_>, context: &Context) -> Result<(), String> {
        let kept = self.take_events(source.evaluation, context);
        self.begin_next(source, context);
        kept
    }

    fn begin_next(&mut self, source: &TrialSource<'_>, context: &Context) {
        self.frame += 1;
        self.model = source.evaluation.model.file_since();
        let mut asked = std::mem::take(self.asked.get_mut());
        // Variants come first; effects in the order in which they are seen.
        asked.sort_by_key(|trial| matches!(trial, Trial::Effect(_)));
        for trial in &asked {
            if let Some(known) = self.known.get_mut(trial) {
                known.asked = self.frame;
            }
        }
        self.forget_oldest();
        let is_model_loaded = source.evaluation.model.received.is_some() && source.evaluation.model.failure.is_none();
        if !is_model_loaded {
            return;
        }
        // One of another model, or of a graph that was edited since, makes way.
        let running = self.running.take();
        self.running = running.filter(|(trial, version)| self.version(trial, source).as_ref() == Some(version));
        if self.running.is_some() {
            return;
        }
        let next = asked.into_iter().find_map(|trial| {
            let version = self.version(&trial, source)?;
            let is_known = self.known.get(&trial).is_some_and(|known| known.version == version);
            (!is_known).then_some((trial, version))
        });
        if let Some((trial, version)) = next {
            self.begin(trial, version, source, context);
        }
    }

    /// Version of a trial as it would be made now; none where it is gone.
    fn version(&self, trial: &Trial, source: &TrialSource<'_>) -> Option<Version> {
        let content = match trial {
            Trial::Variant { .. } => source.evaluation.graph_number().to_string(),
            Trial::Effect(file) => source.library.group(file)?.digest.clone()?,
        };
        Some(Version {
            model: self.model,
            content,
        })
    }

    /// Begins to make a picture, unless it is kept on disk.
    fn begin(&mut self, trial: Trial, version: Version, source: &TrialSource<'_>, context: &Context) {
        let kept = kept_under(&trial, &version, source.evaluation);
        let kept = kept.and_then(|(folder, key)| load_thumbnail(folder, &key.each_ref().map(String::as_str)));
        if let Some(picture) = kept {
            return self.finish(trial, version, Some((texture_of(&picture, context), picture)));
        }
        let Some((graph, node)) = tried_graph(&trial, source) else {
            self.finish(trial, version, None);
            return;
        };
        let evaluation = source.evaluation;
        let live = self.live.get_or_insert_with(|| evaluation.start_trials(SIDE, context));
        let (kinds, kinds_revision) = source.document.kinds();
        self.requests += 1;
        // Pictures that were sent are sent again: two trials may look the same.
        live.mark_dropped(Vec::new(), node.iter().cloned().collect());
        live.submit(LiveRequest {
            revision: self.requests,
            graph: Arc::new(graph).into(),
            kinds: kinds.clone(),
            kinds_revision,
            model: Arc::new(evaluation.model.options_of_size(TEXELS)),
            model_revision: self.model,
            coarse_size: TEXELS,
            subjects: Vec::new(),
            inspected: None,
            set: None,
            outputs_thumbnail: node.is_none(),
            thumbnails: node.into_iter().collect(),
            is_flat: false,
            is_moving: false,
        });
        self.running = Some((trial, version));
    }

    fn take_events(&mut self, evaluation: &Evaluation, context: &Context) -> Result<(), String> {
        let events = self.live.as_ref().map_or_else(Vec::new, Live::take_events);
        let mut kept = Ok(());
        for event in events {
            match event {
                LiveEvent::OutputsThumbnail { revision, picture } | LiveEvent::Thumbnail { revision, picture, .. }
                    if revision == self.requests =>
                {
                    if let Some((trial, version)) = self.running.take() {
                        if let Some((folder, key)) = kept_under(&trial, &version, evaluation) {
                            let key = key.each_ref().map(String::as_str);
                            kept = store_thumbnail(folder, &key, &picture).map_err(|error| error.to_string());
                        }
                        self.finish(trial, version, Some((texture_of(&picture, context), picture)));
                    }
                }
                LiveEvent::Done { revision } if revision == self.requests => {
                    if let Some((trial, version)) = self.running.take() {
                        self.finish(trial, version, None);
                    }
                }
                // The loss of the device is reported by the evaluation of the model.
                LiveEvent::Lost(_) => self.running = None,
                _ => {}
            }
        }
        kept
    }

    /// Keeps a picture; where none could be made, the one before it stays.
    fn finish(&mut self, trial: Trial, version: Version, drawn: Option<(TextureHandle, Pixels)>) {
        let picture = drawn.map(|(texture, pixels)| Picture::new(texture, &pixels, &version));
        let asked = self.frame;
        let known = self.known.entry(trial).or_insert_with(|| Known {
            version: version.clone(),
            picture: None,
            asked,
        });
        known.version = version;
        if picture.is_some() {
            known.picture = picture;
        }
    }

    fn forget_oldest(&mut self) {
        if self.known.len() <= MOST_PICTURES {
            return;
        }
        let mut asked: Vec<u64> = self.known.values().map(|known| known.asked).collect();
        asked.sort_unstable();
        let oldest = asked[asked.len() - MOST_PICTURES];
        self.known.retain(|_, known| known.asked >= oldest);
    }
}

fn texture_of(picture: &Pixels, context: &Context) -> TextureHandle {
    let image = ColorImage::from_rgba_unmultiplied(picture.size.map(|side| side as usize), &picture.rgba);
    context.load_texture("what is tried", image, TextureOptions::LINEAR)
}

/// Folder and key under which the picture of an effect is kept on disk: its content, the model as it is and as it is read, and
/// the size. Pictures of variants change with every edit, and are not kept.
fn kept_under<'e>(trial: &Trial, version: &Version, evaluation: &'e Evaluation) -> Option<(&'e Path, [String; 4])> {
    let Trial::Effect(_) = trial else { return None };
    let file = evaluation.model.file();
    let state = std::fs::metadata(file).ok()?;
    let changed = state.modified().ok()?.duration_since(std::time::UNIX_EPOCH).ok()?;
    let options = evaluation.model.import_options();
    let model = format!("{} {} {changed:?} {options:?}", stored_path(file), state.len());
    let size = format!("{SIDE} {TEXELS}");
    Some((
        evaluation.cache_dir()?,
        ["effect".to_owned(), version.content.clone(), model, size],
    ))
}

/// The graph of a trial, and the node whose result is shown; without one, all outputs are.
fn tried_graph(trial: &Trial, source: &TrialSource<'_>) -> Option<(OpenGraph, Option<NodeRef>)> {
    let document = source.document;
    match trial {
        Trial::Variant { instance, name, .. } => {
            let graph = variants::tried(document, instance.as_ref(), name.as_deref())?;
            let is_output = |kind: &str| kind.starts_with("output/");
            let has_outputs = graph.document.graph.nodes().any(|(_, node)| is_output(&node.kind));
            let shown = instance.as_ref().filter(|_| !has_outputs);
            let node = shown.map(|id| NodeRef {
                node: document.full_id(id),
                port: document.face(id).and_then(|face| material_port(&face.outputs)),
            });
            Some((graph, node))
        }
        Trial::Effect(file) => {
            let group = source.library.group(file)?;
            let text = serde_json::json!({
                "format": "sabi",
                "version": 1,
                "nodes": { EFFECT: { "kind": "graph/group", "group": file.file_name()?.to_str()? } },
            });
            let text = text.to_string();
            let graph = OpenGraph {
                document: sabi_graph::Document::from_json(&text).ok()?,
                text: text.into(),
                ..OpenGraph::empty(file.with_file_name(BESIDE))
            };
            let node = NodeRef {
                node: EFFECT.to_owned(),
                port: material_port(&group.face.outputs),
            };
            Some((graph, Some(node)))
        }
    }
}

/// Name of the only node of a graph that tries an effect, and of its file, which is never written.
const EFFECT: &str = "effect";
const BESIDE: &str = "trial.sabi";

/// The first output that gives a material, as results name it: the first output of all has no name.
fn material_port(outputs: &[sabi_engine::catalog::Port]) -> Option<String> {
    let at = outputs.iter().position(|port| port.ty == Some(PortType::Material))?;
    (at > 0).then(|| outputs[at].name.clone())
}
