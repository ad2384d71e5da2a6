//! Pictures of choices on the open model, made while the evaluator is idle: of variants, of updates of groups, and of
//! effects of the library.

mod preview_graph;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_editing::{NodeKinds, OpenDocument};
use sabi_engine::Live;
use sabi_engine::evaluating::{load_thumbnail, store_thumbnail};
use sabi_engine::live::{LiveEvent, LiveRequest, THUMBNAIL_VERSION};
use sabi_files::stored_path;
use sabi_gpu::AdapterKind;
use sabi_graph::{LibrarySource, NodeId};
use sabi_view::Pixels;

use crate::evaluation::Evaluation;
use crate::library::GroupLibrary;
use preview_graph::preview_graph;

/// Pixels along a side of a picture.
const SIDE: u32 = 192;
/// Texels of the model for these pictures, and for those of effects on software drivers.
const TEXELS: u32 = 256;
const FEW_TEXELS: u32 = 128;
/// Time without input after which a software driver draws pictures of effects: it takes the cores that the window needs.
const PAUSE: Duration = Duration::from_millis(1500);
/// Most pictures that are kept.
const MOST_PICTURES: usize = 256;

/// Choice that a picture is made of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PreviewChoice {
    /// A variant of the shown graph, or of an instance in it; without a name its own values.
    Variant {
        /// Full id of the shown graph and the instance, which tells those of other graphs apart.
        place: String,
        instance: Option<NodeId>,
        name: Option<String>,
    },
    /// The whole graph before or after these groups are updated from the library.
    Update { groups: Vec<String>, is_after: bool },
    /// A group of the library, by its file.
    Effect(PathBuf),
}

/// State of everything that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct PreviewVersion {
    /// Revision of the model since which its file and the way of reading it are the same.
    model: u64,
    /// The graph, or the digest of the group's file.
    content: String,
}

/// Picture of a choice.
struct PreviewEntry {
    version: PreviewVersion,
    /// `None` if it could not be made.
    picture: Option<PreviewPicture>,
    /// Frame in which it was asked for last.
    asked: u64,
}

/// Picture on the model, with the version that it is of.
struct PreviewPicture {
    texture: TextureHandle,
    #[cfg(test)]
    pixels: Pixels,
    version: PreviewVersion,
}

impl PreviewPicture {
    #[cfg_attr(not(test), expect(unused_variables, reason = "only tests look at the pixels"))]
    fn new(texture: TextureHandle, pixels: &Pixels, version: &PreviewVersion) -> PreviewPicture {
        PreviewPicture {
            texture,
            #[cfg(test)]
            pixels: pixels.clone(),
            version: version.clone(),
        }
    }
}

/// Pictures of choices on the open model, and the evaluator that makes them one at a time.
#[derive(Default)]
pub(crate) struct ChoicePreviews {
    live: Option<Live>,
    /// Number of the last request, and its trial until it is answered.
    requests: u64,
    running: Option<(PreviewChoice, PreviewVersion)>,
    known: BTreeMap<PreviewChoice, PreviewEntry>,
    /// Trials that were asked for in this frame. Filled while views read, hence the cell.
    asked: RefCell<Vec<PreviewChoice>>,
    frame: u64,
    /// Time of the last input.
    last_input: Option<Instant>,
    /// Revision of the model that pictures are compared with in this frame.
    model: u64,
}

/// Inputs of the pictures.
pub(crate) struct PreviewSource<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) library: &'a GroupLibrary,
}

impl ChoicePreviews {
    /// Picture of a choice on the open model, if there is one; asks for it, or for a newer one.
    pub(crate) fn find(&self, choice: PreviewChoice) -> Option<TextureId> {
        let known = self.known.get(&choice);
        let picture = known.and_then(|known| known.picture.as_ref());
        let picture = picture.filter(|picture| picture.version.model == self.model);
        self.asked.borrow_mut().push(choice);
        picture.map(|picture| picture.texture.id())
    }

    /// Number of pictures that were begun.
    #[cfg(test)]
    pub(crate) fn begun(&self) -> u64 {
        self.requests
    }

    /// Pixels of the picture of a choice on the open model.
    #[cfg(test)]
    pub(crate) fn pixels_of(&self, is_meant: impl Fn(&PreviewChoice) -> bool) -> Option<&Pixels> {
        let (_, known) = self.known.iter().find(|(choice, _)| is_meant(choice))?;
        let picture = known
            .picture
            .as_ref()
            .filter(|picture| picture.version.model == self.model);
        picture.map(|picture| &picture.pixels)
    }

    /// Forgets the pictures of variants and updates, since another graph is opened.
    pub(crate) fn forget_variants(&mut self) {
        self.known
            .retain(|choice, _| matches!(choice, PreviewChoice::Effect(_)));
    }

    /// Takes over the picture that was made, and begins the next one of those that the views have asked for in this frame.
    ///
    /// # Errors
    /// A sentence, where the picture cannot be kept on disk.
    pub(crate) fn advance(&mut self, source: &PreviewSource<'_>, context: &Context) -> Result<(), String> {
        if context.input(|input| !input.events.is_empty() || input.pointer.any_down()) {
            self.last_input = Some(Instant::now());
        }
        let kept = self.take_events(source.evaluation, context);
        self.begin_next(source, context);
        kept
    }

    fn begin_next(&mut self, source: &PreviewSource<'_>, context: &Context) {
        self.frame += 1;
        self.model = source.evaluation.model.file_since();
        let mut asked = std::mem::take(self.asked.get_mut());
        // Variants come first; effects in the order in which they are seen.
        asked.sort_by_key(|choice| matches!(choice, PreviewChoice::Effect(_)));
        for choice in &asked {
            if let Some(known) = self.known.get_mut(choice) {
                known.asked = self.frame;
            }
        }
        self.forget_oldest();
        let is_model_loaded = source.evaluation.model.received.is_some() && source.evaluation.model.failure.is_none();
        // The evaluation of the model computes its shade, and keeps it on disk for the pictures here.
        if !is_model_loaded || source.evaluation.awaits_shade() {
            return;
        }
        // A running picture of another model, or of a graph that was edited since, is dropped.
        let running = self.running.take();
        self.running = running.filter(|(choice, version)| self.version(choice, source).as_ref() == Some(version));
        if self.running.is_some() {
            return;
        }
        let mut missing = asked.into_iter().filter_map(|choice| {
            let version = self.version(&choice, source)?;
            let is_known = self.known.get(&choice).is_some_and(|known| known.version == version);
            (!is_known).then_some((choice, version))
        });
        let next = missing.next();
        drop(missing);
        if matches!(next, Some((PreviewChoice::Effect(_), _))) && is_on_software(source.evaluation) {
            let rested = self.last_input.map_or(PAUSE, |last| last.elapsed());
            if rested < PAUSE || source.evaluation.is_busy() {
                context.request_repaint_after(PAUSE.saturating_sub(rested));
                return;
            }
        }
        if let Some((choice, version)) = next {
            self.begin(choice, version, source, context);
        }
    }

    /// Current version of a choice `None` if its subject does not exist any more.
    fn version(&self, choice: &PreviewChoice, source: &PreviewSource<'_>) -> Option<PreviewVersion> {
        let content = match choice {
            PreviewChoice::Variant { .. } => source.evaluation.graph_number().to_string(),
            PreviewChoice::Update { groups, is_after } => {
                let number = source.evaluation.graph_number();
                let known = |group: &String| source.document.contents().groups.get(group)?.library.clone();
                let sources = groups.iter().map(known).collect::<Option<Vec<_>>>()?;
                let digest = |link: &LibrarySource| match is_after {
                    true => source.library.digest(source.document, link).map(str::to_owned),
                    false => Some(String::new()),
                };
                let digests = sources.iter().map(digest).collect::<Option<Vec<String>>>()?;
                format!("{number} {}", digests.concat())
            }
            PreviewChoice::Effect(file) => source.library.group(file)?.digest.clone()?,
        };
        Some(PreviewVersion {
            model: self.model,
            content,
        })
    }

    /// Begins to make a picture, unless it is kept on disk.
    fn begin(&mut self, choice: PreviewChoice, version: PreviewVersion, source: &PreviewSource<'_>, context: &Context) {
        let kept = kept_under(&choice, &version, source.evaluation);
        let kept = kept.and_then(|(folder, key)| load_thumbnail(folder, &key.each_ref().map(String::as_str)));
        if let Some(picture) = kept {
            return self.finish(choice, version, Some((texture_of(&picture, context), picture)));
        }
        let Some((graph, node)) = preview_graph(&choice, source) else {
            self.finish(choice, version, None);
            return;
        };
        let evaluation = source.evaluation;
        let live = self
            .live
            .get_or_insert_with(|| evaluation.start_previews(SIDE, context));
        let texels = texels_of(&choice, evaluation);
        let NodeKinds { kinds, revision, .. } = source.document.node_kinds();
        self.requests += 1;
        // The engine sends a picture only once, but two choices may have the same one.
        live.mark_dropped(Vec::new(), node.iter().cloned().collect());
        live.submit(LiveRequest {
            revision: self.requests,
            graph: Arc::new(graph).into(),
            kinds: kinds.clone(),
            kinds_revision: *revision,
            model: Arc::new(evaluation.model.options_of_size(texels)),
            model_revision: 2 * self.model + u64::from(texels == FEW_TEXELS),
            coarse_size: texels,
            subjects: Vec::new(),
            inspected: Vec::new(),
            set: None,
            outputs_thumbnail: node.is_none(),
            thumbnails: node.into_iter().collect(),
            is_flat: false,
            is_moving: false,
        });
        self.running = Some((choice, version));
    }

    fn take_events(&mut self, evaluation: &Evaluation, context: &Context) -> Result<(), String> {
        let events = self.live.as_ref().map_or_else(Vec::new, Live::take_events);
        let mut kept = Ok(());
        for event in events {
            match event {
                LiveEvent::OutputsThumbnail { revision, picture } | LiveEvent::Thumbnail { revision, picture, .. }
                    if revision == self.requests =>
                {
                    if let Some((choice, version)) = self.running.take() {
                        if let Some((folder, key)) = kept_under(&choice, &version, evaluation) {
                            let key = key.each_ref().map(String::as_str);
                            kept = store_thumbnail(folder, &key, &picture).map_err(|error| error.to_string());
                        }
                        self.finish(choice, version, Some((texture_of(&picture, context), picture)));
                    }
                }
                LiveEvent::Done { revision } if revision == self.requests => {
                    if let Some((choice, version)) = self.running.take() {
                        self.finish(choice, version, None);
                    }
                }
                // The loss of the device is reported by the evaluation of the model.
                LiveEvent::Lost(_) => self.running = None,
                _ => {}
            }
        }
        kept
    }

    /// Keeps a picture; if none could be made, the previous one stays.
    fn finish(&mut self, choice: PreviewChoice, version: PreviewVersion, drawn: Option<(TextureHandle, Pixels)>) {
        let picture = drawn.map(|(texture, pixels)| PreviewPicture::new(texture, &pixels, &version));
        let asked = self.frame;
        let known = self.known.entry(choice).or_insert_with(|| PreviewEntry {
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

fn is_on_software(evaluation: &Evaluation) -> bool {
    evaluation.gpu().summary().kind == AdapterKind::Cpu
}

/// Texels of the model for the picture of a choice.
fn texels_of(choice: &PreviewChoice, evaluation: &Evaluation) -> u32 {
    match choice {
        PreviewChoice::Effect(_) if is_on_software(evaluation) => FEW_TEXELS,
        _ => TEXELS,
    }
}

fn texture_of(picture: &Pixels, context: &Context) -> TextureHandle {
    let image = ColorImage::from_rgba_unmultiplied(picture.size.map(|side| side as usize), &picture.rgba);
    context.load_texture("what is tried", image, TextureOptions::LINEAR)
}

/// Folder and key under which the picture of an effect is kept on disk: its content, the state of the model's file, the
/// import options, the size, and the version of the renderer. Pictures of variants change with every edit, and are not
/// kept.
fn kept_under<'e>(
    choice: &PreviewChoice,
    version: &PreviewVersion,
    evaluation: &'e Evaluation,
) -> Option<(&'e Path, [String; 4])> {
    let PreviewChoice::Effect(_) = choice else { return None };
    let file = evaluation.model.file();
    let state = std::fs::metadata(file).ok()?;
    let changed = state.modified().ok()?.duration_since(std::time::UNIX_EPOCH).ok()?;
    let options = evaluation.model.import_options();
    let model = format!("{} {} {changed:?} {options:?}", stored_path(file), state.len());
    let size = format!("{SIDE} {} {THUMBNAIL_VERSION}", texels_of(choice, evaluation));
    Some((
        evaluation.cache_dir()?,
        ["effect".to_owned(), version.content.clone(), model, size],
    ))
}
