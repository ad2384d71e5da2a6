//! The window: what happens in a frame, and what is held from frame to frame.

mod ask;
mod bars;
mod documents;
mod exports;
mod eyedropper;
mod keeping;
mod keys;
mod looks;
mod measures;
mod models;
mod perform;
mod rooms;
#[cfg(test)]
mod tests;
mod work;

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::{Context, Rect, Ui};
use sabi_editing::OpenDocument;
use sabi_engine::{Gpu, Session};
use sabi_graph::NodeRef;

pub(crate) use documents::{MODELS, PICTURES, model_of};
pub(crate) use eyedropper::Taken;
use keys::KeyState;
pub(crate) use keys::told_by_system;

use crate::canvas::Canvas;
use crate::command::Command;
use crate::dock::{self, Layout, Panel};
use crate::files::{Files, Question};
use crate::flat_view::FlatView;
use crate::key_map::KeyMap;
use crate::knobs::KnobMemory;
use crate::model_view::ModelView;
use crate::panels;
use crate::panels::page::Draft;
use crate::search::{Candidate, candidates};
use crate::settings::Settings;
use crate::stage::Stage;
use crate::theme::Theme;
use crate::watching::Watching;
use keeping::Keeping;
use work::Work;

/// How long a sentence stays.
const NOTICE_LASTS: Duration = Duration::from_secs(6);

/// Folders of the program on this machine; none where there is no such place.
#[derive(Clone, Debug, Default)]
pub(crate) struct Folders {
    pub(crate) settings: Option<PathBuf>,
    pub(crate) cache: Option<PathBuf>,
    /// What is not saved is kept here.
    pub(crate) recovery: Option<PathBuf>,
    /// Groups that were saved to be used again.
    pub(crate) library: Option<PathBuf>,
    /// Examples that were opened.
    pub(crate) examples: Option<PathBuf>,
}

/// What a window begins with.
pub(crate) struct Beginning {
    pub(crate) session: Session,
    pub(crate) model: PathBuf,
    pub(crate) folders: Folders,
    /// Whether the start page is shown.
    pub(crate) is_start: bool,
}

/// What outlives a window whose device was lost.
pub(crate) struct Kept {
    pub(crate) document: OpenDocument,
    pub(crate) canvas: Canvas,
    pub(crate) model: PathBuf,
    /// Node files that were being written.
    pub(crate) drafts: Vec<Draft>,
    /// Whether textures were being written, which ended with the device.
    pub(crate) was_exporting: bool,
}

/// Where a window leaves what outlives it.
pub(crate) type Handover = Arc<Mutex<Option<Kept>>>;

/// The window.
pub(crate) struct Editor {
    pub(crate) document: OpenDocument,
    pub(crate) canvas: Canvas,
    pub(crate) stage: Stage,
    pub(crate) watching: Watching,
    pub(crate) model_view: ModelView,
    pub(crate) flat_view: FlatView,
    theme: Arc<Theme>,
    keys: KeyMap,
    pub(crate) settings: Settings,
    kept_settings: serde_json::Value,
    folders: Folders,
    layout: Layout,
    use_layout: Option<Layout>,
    /// Where panels were when they were last drawn.
    pub(crate) rects: BTreeMap<Panel, Rect>,
    /// The panel that keys are for.
    pub(crate) active: Panel,
    candidates: (Option<(u64, u64)>, Vec<Candidate>),
    /// The node that is looked at, and the output of it.
    shown: Option<NodeRef>,
    /// The node that the model shows while it follows clicks; none once a click went beside all nodes.
    followed: Option<NodeRef>,
    /// Kept in the 2D view whatever is clicked.
    pinned: Option<NodeRef>,
    /// Kept on the model whatever is clicked.
    locked: Option<NodeRef>,
    /// Outputs of nodes other than the first that thumbnails show, by the full id of the node.
    ports: BTreeMap<String, String>,
    /// Whether a knob is being moved.
    pub(crate) is_moving: bool,
    knob_memory: KnobMemory,
    pub(crate) panels: panels::Panels,
    pub(crate) files: Files,
    notices: VecDeque<(Instant, String)>,
    keeping: Keeping,
    render: Option<RenderState>,
    handover: Handover,
    is_leaving: bool,
    key_state: KeyState,
    /// What the window is called.
    named: String,
    pub(crate) context: Context,
    /// The command that waits for another key.
    pub(crate) waits_for_key: Option<Command>,
    /// Time of the last frames without the drawing of the device.
    pub(crate) frame_times: VecDeque<Duration>,
}

impl Editor {
    /// A window on a device.
    pub(crate) fn new(
        beginning: Beginning,
        context: &Context,
        gpu: Arc<Gpu>,
        render: Option<RenderState>,
        handover: Handover,
    ) -> Editor {
        let (settings, fault) = Settings::load(beginning.folders.settings.as_deref());
        let (keys, mut faults) = KeyMap::new(settings.habit, &settings.keys);
        faults.extend(fault);
        let theme = Arc::new(Theme::of(settings.shade));
        dress(context, &theme, settings.scale);
        let work = Work::taken_up(beginning.session, beginning.model, &handover, || {
            Files::new(beginning.is_start, beginning.folders.recovery.as_deref())
        });
        let (watching, fault) = Watching::new(context);
        faults.extend(fault.map(|error| error.to_string()));
        faults.extend(work.fault);
        let model = (work.model.as_path(), settings.reading(&work.model));
        let stage = Stage::new(gpu, model, beginning.folders.cache.clone(), context);
        let mut editor = Editor {
            model_view: ModelView::new(&settings.environment, &settings.view),
            flat_view: FlatView::default(),
            layout: dock::sound(settings.layout.clone()),
            use_layout: None,
            keys,
            theme,
            kept_settings: settings.to_json(),
            settings,
            files: work.files,
            panels: panels::Panels::new(beginning.folders.cache.clone(), work.drafts),
            folders: beginning.folders,
            rects: BTreeMap::new(),
            active: Panel::Canvas,
            candidates: (None, Vec::new()),
            shown: None,
            followed: None,
            pinned: None,
            locked: None,
            ports: BTreeMap::new(),
            is_moving: false,
            knob_memory: KnobMemory::default(),
            notices: VecDeque::new(),
            keeping: Keeping::default(),
            document: work.document,
            canvas: work.canvas,
            stage,
            watching,
            render,
            handover,
            is_leaving: false,
            key_state: KeyState::default(),
            named: String::new(),
            context: context.clone(),
            waits_for_key: None,
            frame_times: VecDeque::new(),
        };
        editor.begin(faults);
        editor
    }

    /// Remembers what there is from the beginning, and says what could not be read.
    fn begin(&mut self, faults: Vec<String>) {
        self.remember_model();
        self.recall_export();
        for fault in faults {
            self.say(fault);
        }
    }

    /// Shows a sentence for a while.
    pub(crate) fn say(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        self.notices.retain(|(_, known)| *known != sentence);
        self.notices.push_back((Instant::now(), sentence));
        while self.notices.len() > 4 {
            self.notices.pop_front();
        }
    }

    /// Draws everything and does what is asked for.
    pub(crate) fn frame(&mut self, ui: &mut Ui) {
        let began = Instant::now();
        if self.is_leaving {
            return;
        }
        let context = ui.ctx().clone();
        self.stage.take_news(&context);
        self.follow_export();
        if self.stage.lost.is_some() {
            self.hand_over(&context);
            return;
        }
        self.follow_files();
        self.put_down_eyedropper(&context);
        let mut actions = self.keys_pressed(ui);
        self.take_dropped(&context, &mut actions);
        self.refresh_candidates();
        self.top_bar(ui, &mut actions);
        self.show_outside(ui);
        self.status_bar(ui);
        self.panels(ui, &mut actions);
        self.leave_hidden();
        self.show_files(ui, &mut actions);
        self.show_notices(ui);
        for action in actions {
            self.perform(action, ui);
        }
        for sentence in self.document.take_notices() {
            self.say(sentence);
        }
        self.name_window(&context);
        self.wish(&context);
        self.keep(&context);
        self.key_state.was_typing = context.text_edit_focused();
        self.frame_times.push_back(began.elapsed());
        while self.frame_times.len() > 120 {
            self.frame_times.pop_front();
        }
    }

    /// What may be added, brought up to date.
    fn refresh_candidates(&mut self) {
        let now = (self.document.session.revision(), self.document.kinds().1);
        let shelves = self.shelves();
        if self.candidates.0 == Some(now) && !self.panels.library.has_changed(&shelves) {
            return;
        }
        let groups: Vec<String> = self.document.contents().groups.keys().cloned().collect();
        let shelved = self.panels.library.shelved(shelves, self.document.catalog());
        let found = candidates(self.document.catalog(), self.document.faces(), &groups, shelved);
        self.candidates = (Some(now), found);
    }

    /// Leaves the work to a window on another device, since this one's is gone.
    fn hand_over(&mut self, context: &Context) {
        let mut document = self.take_document();
        // Should the other window never come, what is here is kept.
        keeping::keep_at_last(&mut document, &self.panels.page.unsaved());
        self.canvas.drop_all();
        if let Ok(mut handover) = self.handover.lock() {
            *handover = Some(Kept {
                document,
                canvas: std::mem::take(&mut self.canvas),
                model: self.stage.model_file().to_owned(),
                drafts: self.panels.page.take_drafts(),
                was_exporting: self.panels.export.running.is_some(),
            });
        }
        self.stage.lost = None;
        self.is_leaving = true;
        context.send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

/// Gives the window its look and its letters.
fn dress(context: &Context, theme: &Theme, scale: f32) {
    let mut fonts = egui::FontDefinitions::default();
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    context.set_fonts(fonts);
    theme.apply(context);
    // Ctrl and + is a key of ours, which is kept between runs and can be bound anew.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.set_zoom_factor(scale);
}

impl eframe::App for Editor {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        self.frame(ui);
    }

    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        self.theme.ground.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.keep_settings();
        if !self.is_leaving {
            self.end_work();
        }
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}

/// The question that is open, if there is one.
impl Editor {
    /// The picture of a node's result, if there is one.
    pub(crate) fn thumbnail_of(&self, id: &sabi_graph::NodeId) -> Option<egui::TextureId> {
        self.picture_of(&self.chosen(id))
    }

    /// The picture of a result, if there is one.
    pub(crate) fn picture_of(&self, result: &NodeRef) -> Option<egui::TextureId> {
        self.stage.thumbnail(result).map(egui::TextureHandle::id)
    }

    #[cfg(test)]
    fn folders(&self) -> &Folders {
        &self.folders
    }

    pub(crate) fn theme(&self) -> &Arc<Theme> {
        &self.theme
    }

    pub(crate) fn keys(&self) -> &KeyMap {
        &self.keys
    }

    pub(crate) fn candidates(&self) -> &[Candidate] {
        &self.candidates.1
    }

    pub(crate) fn knob_memory(&mut self) -> &mut KnobMemory {
        &mut self.knob_memory
    }

    pub(crate) fn question(&self) -> Option<&Question> {
        self.files.question.as_ref()
    }
}
