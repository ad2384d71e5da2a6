//! State of a window in its first frame.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::Session;
use sabi_files::TrustedPaths;

use super::documents::{Documents, ProgramFolders};
use crate::builtin_models::model_of;
use crate::canvas::Canvas;
use crate::files::key_list::KeyList;
use crate::files::start::StartPage;
use crate::files::{Questions, examples};
use crate::flat_view::FlatView;
use crate::gradient_picker::GradientPicker;
use crate::model_view::ModelView;
use crate::panels::export::ExportPanel;
use crate::panels::history::HistoryPanel;
use crate::panels::library::LibraryPanel;
use crate::panels::node_page::{DraftEditor, NodePage};
use crate::panels::parameters::Parameters;
use crate::panels::problems::Problems;
use crate::panels::stack::StackPanel;
use crate::panels::timing::Timing;
use crate::paths::in_canonical_folder;
use crate::settings::Settings;
use crate::views::Views;
use crate::window_watcher::WindowWatcher;

const NOT_WRITTEN: &str = "The textures were not written, since the graphics device was lost; export them again.";

/// State with which a window is opened.
pub(crate) struct InitialState {
    pub(crate) session: Session,
    pub(crate) model: PathBuf,
    /// True if the user named the model, so that the one that the graph names is not shown.
    pub(crate) is_model_given: bool,
    /// Paths that the command line trusts.
    pub(crate) trusted: TrustedPaths,
    pub(crate) folders: ProgramFolders,
    /// True if the start page is shown.
    pub(crate) is_start: bool,
    /// Called once the window is closed for good and all work is kept, before the device is waited for.
    pub(crate) at_end: fn(),
}

/// State that outlives a window whose device was lost.
pub(crate) struct LostWindow {
    pub(crate) document: OpenDocument,
    pub(crate) canvas: Canvas,
    pub(crate) model: PathBuf,
    /// Models beside the main one.
    pub(crate) beside: Vec<PathBuf>,
    /// Node files that were being written.
    pub(crate) drafts: Vec<DraftEditor>,
    /// True if an export was running, which ended with the device.
    pub(crate) was_exporting: bool,
}

/// Slot in which a window leaves the state that outlives it.
pub(crate) type Handover = Arc<Mutex<Option<LostWindow>>>;

/// Parts of a window that depend on how it was opened.
pub(super) struct OpenedWindow {
    pub(super) documents: Documents,
    pub(super) views: Views,
    pub(super) model: PathBuf,
    /// Models beside the main one.
    pub(super) beside: Vec<PathBuf>,
    /// Sentences about files that could not be opened, and state that could not be taken over.
    pub(super) fault: Vec<String>,
}

impl OpenedWindow {
    /// Takes over the state that a window on a lost device left. If there is none, opens the initial state, with the
    /// start page where there is something to recover.
    pub(super) fn new(
        initial: InitialState,
        settings: &Settings,
        context: &Context,
        handover: &Handover,
    ) -> OpenedWindow {
        let (watching, fault) = WindowWatcher::new(context);
        let mut fault: Vec<String> = fault.map(|error| error.to_string()).into_iter().collect();
        let lost = handover.lock().ok().and_then(|mut lost| lost.take());
        let is_new = lost.is_none();
        let lost = lost.unwrap_or_else(|| LostWindow {
            document: OpenDocument::before_kinds(initial.session),
            canvas: Canvas::default(),
            model: initial.model,
            beside: Vec::new(),
            drafts: Vec::new(),
            was_exporting: false,
        });
        fault.extend(lost.was_exporting.then(|| NOT_WRITTEN.to_owned()));
        let mut documents = Documents::new(lost.document, initial.folders, watching, is_new);
        documents.trust_at_start(&initial.trusted, settings);
        if is_new {
            documents.kinds_reading.read_opened(context, &mut documents.document);
        }
        let examples = documents.folders.examples.as_deref();
        let named = model_of(&documents.document.session, examples).and_then(Result::ok);
        let named = named.filter(|_| is_new && !initial.is_model_given);
        let model = named.map_or(lost.model, |model| {
            in_canonical_folder(&examples::at_home(examples, model))
        });
        let is_start = is_new && initial.is_start || !documents.recoveries.found.is_empty();
        OpenedWindow {
            views: Views {
                canvas: lost.canvas,
                model: ModelView::new(&settings.environment, &settings.view),
                flat: FlatView::default(),
                parameters: Parameters::default(),
                layers: StackPanel::default(),
                library: LibraryPanel::default(),
                export: ExportPanel::default(),
                history: HistoryPanel,
                problems: Problems::default(),
                timing: Timing,
                page: NodePage::with_drafts(lost.drafts),
                questions: Questions::default(),
                gradient_picker: GradientPicker::default(),
                start: StartPage::new(is_start),
                key_list: KeyList::default(),
            },
            documents,
            model,
            beside: lost.beside,
            fault,
        }
    }
}
