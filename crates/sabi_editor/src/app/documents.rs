//! The open graph with everything that belongs to it: nodes and groups that can be added, saved pictures, autosave and
//! watched files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;
use sabi_editing::document_settings::changed_preview;
use sabi_editing::library_folder::LibraryFolder;
use sabi_editing::{OpenDocument, history, relative_paths, trust};
use sabi_engine::opening::linked_model::SavedReading;
use sabi_engine::session::FileState;
use sabi_engine::source::Strokes;
use sabi_engine::{EngineError, ErrorKind, Remedy, Session};
use sabi_files::{Refusal, TrustedPaths};
use sabi_graph::Preview;

use super::autosave::Autosave;
use super::candidates::Candidates;
use super::recoveries::Recoveries;
use crate::action::LibraryKind;
use crate::brush_shelf::BrushShelf;
use crate::builtin_models::{builtin_name, model_of};
use crate::evaluation::Evaluation;
use crate::files::examples;
use crate::kinds_reading::KindsReading;
use crate::library::GroupLibrary;
use crate::model_row::ModelRow;
use crate::paths::{canonical_if_present, in_canonical_folder};
use crate::saved_pictures::SavedPictures;
use crate::search::Candidate;
use crate::settings::{ModelStrip, Settings};
use crate::window_watcher::{WatchedFiles, WindowWatcher};

/// Folders of the program on this machine; `None` where the system has no such folder.
#[derive(Clone, Debug, Default)]
pub(crate) struct ProgramFolders {
    pub(crate) settings: Option<PathBuf>,
    pub(crate) cache: Option<PathBuf>,
    /// Graphs that are not saved yet.
    pub(crate) recovery: Option<PathBuf>,
    /// Groups that every graph can use.
    pub(crate) library: Option<PathBuf>,
    /// Sabi's own effects.
    pub(crate) effects: Option<PathBuf>,
    /// Examples that were opened.
    pub(crate) examples: Option<PathBuf>,
}

impl ProgramFolders {
    /// Writes the built-in model that new graphs are shown on, if it is missing, and returns its file.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn first_model(&self) -> Result<PathBuf, EngineError> {
        let temporary = || std::env::temp_dir().join("sabi");
        let folder = self.examples.clone().unwrap_or_else(temporary);
        let model = examples::first_model(&folder).map_err(|error| {
            let why = format!("{} cannot be written: {error}", folder.display());
            let refused = EngineError::new(ErrorKind::CannotWrite, why).caused_by(error);
            refused.with_remedies([Remedy::NameModel])
        });
        model.map(|model| in_canonical_folder(&model))
    }

    /// Returns whether a model is one of Sabi's own, which are offered without being on the strip.
    pub(super) fn is_own_model(&self, model: &Path) -> bool {
        let folder = self.examples.as_deref();
        folder.is_some_and(|folder| examples::models(folder).any(|own| own == model))
    }

    /// Folders below which every graph may open files.
    pub(super) fn trusted(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.effects, &self.library, &self.examples].into_iter().flatten()
    }
}

/// The open graph with everything that belongs to it.
pub(crate) struct Documents {
    pub(crate) document: OpenDocument,
    pub(crate) folders: ProgramFolders,
    /// Graphs and node files that were not saved when the program ended.
    pub(crate) recoveries: Recoveries,
    /// Models on the strip above the viewport.
    pub(crate) models: ModelStrip,
    pub(crate) library: GroupLibrary,
    pub(crate) pictures: SavedPictures,
    /// Brushes that are kept.
    pub(crate) brushes: BrushShelf,
    pub(crate) watching: WindowWatcher,
    pub(crate) kinds_reading: KindsReading,
    /// True once the user has chosen a model for the open graph, which it names from then on.
    pub(crate) is_model_chosen: bool,
    /// Options for reading the model that the graph had when they were last checked.
    pub(super) seen_reading: SavedReading,
    /// True if another program has changed the graph's file, and the user has not chosen yet which version to keep.
    pub(crate) is_file_foreign: bool,
    /// True while a parameter is dragged: an undo step is open, and fast results are preferred.
    pub(crate) is_dragging: bool,
    pub(crate) autosave: Autosave,
    /// Paths that every graph may open, besides those below its own folder and project.
    trusted: TrustedPaths,
    /// Paths below which node files beside graphs are used.
    trusted_nodes: TrustedPaths,
    /// True if the user wants no question about the node files beside the open graph.
    pub(crate) leaves_nodes: bool,
    candidates: Candidates,
}

impl Documents {
    /// Creates the state of an open graph. With `has_recoveries`, unsaved work that can be recovered is looked up.
    pub(crate) fn new(
        document: OpenDocument,
        folders: ProgramFolders,
        watching: WindowWatcher,
        has_recoveries: bool,
    ) -> Documents {
        let recovery = folders.recovery.as_deref().filter(|_| has_recoveries);
        Documents {
            document,
            recoveries: Recoveries::in_folder(recovery),
            models: ModelStrip::default(),
            library: GroupLibrary::default(),
            pictures: SavedPictures::new(folders.cache.clone()),
            brushes: BrushShelf::open(folders.settings.as_deref()),
            watching,
            kinds_reading: KindsReading::default(),
            is_model_chosen: false,
            seen_reading: SavedReading::default(),
            is_file_foreign: false,
            is_dragging: false,
            autosave: Autosave::default(),
            trusted: TrustedPaths::default(),
            trusted_nodes: TrustedPaths::default(),
            leaves_nodes: false,
            candidates: Candidates::default(),
            folders,
        }
    }

    /// Index of the unsaved work on the file of the open graph, if there is any.
    pub(super) fn recovery_of_open_graph(&self) -> Option<usize> {
        self.recoveries.of_file(self.document.session.file()?)
    }

    /// Folder of copies of graphs that are not saved yet.
    pub(crate) fn recovery_folder(&self) -> Option<&Path> {
        self.folders.recovery.as_deref()
    }

    /// Trusts the paths that the command line and the settings name, and the folders of the program.
    pub(crate) fn trust_at_start(&mut self, named: &TrustedPaths, settings: &Settings) {
        let all = self.folders.trusted().chain(&settings.trusted);
        let trusted = all.fold(named.clone(), |trusted, path| trusted.with_path(path));
        let nodes = settings.trusted_nodes.iter();
        self.trusted_nodes = nodes.fold(TrustedPaths::default(), |trusted, path| trusted.with_path(path));
        trust::trust_nodes(&mut self.document, self.trusted_nodes.clone());
        self.trust(&trusted);
    }

    /// Lets this graph and all later ones open the files that they name below these paths.
    pub(crate) fn trust(&mut self, trusted: &TrustedPaths) {
        self.trusted = std::mem::take(&mut self.trusted).with(trusted);
        trust::trust_files(&mut self.document, &self.trusted);
    }

    /// Trusts the node files of a folder: graphs beside it use them when node files are read next.
    pub(crate) fn trust_nodes(&mut self, folder: &Path) {
        self.trusted_nodes = std::mem::take(&mut self.trusted_nodes).with_path(folder);
        trust::trust_nodes(&mut self.document, self.trusted_nodes.clone());
    }

    /// Closes the open graph and opens another one. Returns the file of the model that it names and may open.
    pub(crate) fn replace(&mut self, context: &Context, session: Session) -> Option<PathBuf> {
        let mut document = OpenDocument::before_kinds(session);
        trust::trust_nodes(&mut document, self.trusted_nodes.clone());
        trust::trust_files(&mut document, &self.trusted);
        let before = std::mem::replace(&mut self.document, document);
        before.session.close();
        self.kinds_reading.read_opened(context, &mut self.document);
        self.autosave.invalidate();
        self.leaves_nodes = false;
        self.is_model_chosen = false;
        self.named_model()
    }

    /// File of the model that the open graph names and may open.
    pub(crate) fn named_model(&self) -> Option<PathBuf> {
        let named = self.written_model()?.ok()?;
        Some(examples::at_home(self.folders.examples.as_deref(), named))
    }

    /// File of the model that the open graph names, or the reason that it may not open it.
    pub(crate) fn written_model(&self) -> Option<Result<PathBuf, Refusal>> {
        model_of(&self.document.session, self.folders.examples.as_deref())
    }

    /// Returns the open graph and leaves an empty one in its place. Called when the window ends.
    pub(crate) fn take(&mut self) -> OpenDocument {
        std::mem::replace(&mut self.document, OpenDocument::before_kinds(Session::new(None)))
    }

    /// Begins the drag of a parameter: all of it is one step to undo, and results are quick meanwhile.
    pub(crate) fn begin_drag(&mut self) {
        self.document.session.begin("");
        self.is_dragging = true;
    }

    /// Ends the drag of a parameter, unless it has ended already because its row disappeared.
    pub(crate) fn end_drag(&mut self) {
        if self.is_dragging {
            self.document.session.end();
            self.is_dragging = false;
        }
    }

    /// Cancels the drag of a parameter.
    pub(crate) fn cancel_drag(&mut self) {
        history::cancel_step(&mut self.document);
        self.is_dragging = false;
    }

    /// Strokes of the open document.
    pub(super) fn strokes(&self) -> Strokes {
        self.document.session.graph().strokes.clone()
    }

    /// Stores the strokes, and makes the next autosave store the graph that names them.
    ///
    /// # Errors
    /// They cannot be written.
    pub(super) fn keep_strokes(&mut self) -> Result<(), EngineError> {
        let kept = self.document.session.keep_strokes();
        self.autosave.invalidate();
        kept
    }

    /// Nodes and groups that can be added.
    pub(crate) fn candidates(&self) -> &[Candidate] {
        &self.candidates.all
    }

    /// Updates the list of nodes and groups that can be added.
    pub(crate) fn refresh_candidates(&mut self) {
        let folders = self.library_folders();
        let has_changed = self.library.has_changed(&folders);
        self.document.library_folders = named_folders(&folders);
        let library_groups = self.library.groups(folders, self.document.catalog());
        self.candidates
            .refresh(&self.document, library_groups, has_changed, self.is_dragging);
    }

    /// Folder of a library. The project has one only once the graph has a file.
    pub(crate) fn library_folder(&self, library: LibraryKind) -> Option<PathBuf> {
        match library {
            LibraryKind::Project => Some(self.document.session.file()?.with_file_name("library")),
            LibraryKind::User => self.folders.library.clone(),
            LibraryKind::Sabi => self.folders.effects.clone(),
        }
    }

    /// Folders of the libraries, each of them once.
    fn library_folders(&self) -> Vec<(LibraryKind, PathBuf)> {
        let all = [LibraryKind::Sabi, LibraryKind::Project, LibraryKind::User];
        let found = all.map(|library| Some((library, self.library_folder(library)?)));
        let mut folders: Vec<(LibraryKind, PathBuf)> = found.into_iter().flatten().collect();
        folders.dedup_by(|one, other| one.1 == other.1);
        folders
    }

    /// Reads node kinds again from these folders.
    pub(crate) fn reread_kinds(&mut self, context: &Context, folders: &[PathBuf]) {
        self.kinds_reading.read_again(context, &mut self.document, folders);
    }

    /// Names the shown model in the graph before it is saved, so that the graph opens on that model again. This is no
    /// undo step, since the choice of a model is none either.
    pub(crate) fn name_model(&mut self, evaluation: &Evaluation) {
        let model = evaluation.model.file();
        let named = match self.written_model() {
            // The shown model is a substitute for one that the graph may not open.
            Some(Err(_)) if !self.is_model_chosen => return,
            named => named.and_then(Result::ok),
        };
        let is_named = named
            .as_ref()
            .is_some_and(|named| canonical_if_present(named) == canonical_if_present(model));
        // The graph's own model may be missing only for now, and the shown one be its substitute.
        let refused = evaluation.model.refused().map(canonical_if_present);
        let is_substitute = refused.is_some() && refused == named.as_deref().map(canonical_if_present);
        if is_substitute || is_named || evaluation.model.failure.is_some() {
            return;
        }
        let reading = evaluation.model.import_options().saved();
        let examples = self.folders.examples.as_deref();
        let builtin = examples.and_then(|folder| builtin_name(folder, model));
        let mesh = match builtin {
            Some(name) => Ok(format!("{}{name}", Preview::BUILTIN)),
            None => relative_paths::relative(&self.document, model),
        };
        let texts = mesh.and_then(|mesh| Ok((mesh, self.textures_text(&reading)?)));
        let (mesh, textures) = match texts {
            Ok(texts) => texts,
            Err(refused) => return self.document.notify(refused.to_string()),
        };
        let edit = changed_preview(&self.document, |preview| {
            preview.mesh = Some(mesh);
            reading.put_into(preview, textures);
        });
        self.document.edit_aside(edit);
    }

    /// Names the shown model in a graph that was never saved, so that a recovered one comes back on it. A saved graph names its model.
    pub(crate) fn name_model_of_unsaved(&mut self, evaluation: &Evaluation) {
        let session = &mut self.document.session;
        if session.file().is_none() && session.is_dirty() && !self.is_dragging {
            self.name_model(evaluation);
        }
    }

    /// Watches the files that the window depends on now.
    pub(crate) fn watch(&mut self, evaluation: &Evaluation, row: &ModelRow, environment: Option<&Path>) {
        let now = WatchedFiles {
            graph: self.document.session.file().map(Path::to_owned),
            nodes: trust::node_folders(&self.document),
            model: evaluation.model.file().to_owned(),
            loaded: evaluation.model.loaded(),
            beside: row.files(),
            named: Arc::clone(&evaluation.files),
            library: self.library.files().clone(),
            environment: environment.map(Path::to_owned),
        };
        let before = self.watching.watched();
        if before.is_some_and(|before| before.graph != now.graph) {
            self.is_file_foreign = false;
        }
        self.watching.watch(now, || model_files(evaluation));
    }

    /// Checks whether another program wrote the graph's file. Returns a sentence if the file was deleted.
    pub(crate) fn check_file(&mut self) -> Option<String> {
        let state = self.document.session.graph_file.check();
        self.is_file_foreign = state == FileState::Another;
        self.autosave.invalidate();
        let file = self.document.session.file().filter(|_| state == FileState::Gone)?;
        Some(format!(
            "{} is not there any more; saving writes it again",
            file.display()
        ))
    }
}

/// Files that the model is read from. While it cannot be read, also its folder, where a missing file may appear.
fn model_files(evaluation: &Evaluation) -> Vec<PathBuf> {
    let file = evaluation.model.file();
    let mut files = vec![file.to_owned()];
    match &evaluation.model.received {
        Some(model) if evaluation.model.loaded().1 => {
            let model = &model.linked.model;
            files.extend(model.files.iter().chain(&model.absent).cloned());
        }
        _ => files.extend(file.parent().map(Path::to_owned)),
    }
    files
}

/// Folders of libraries by the names that links begin with. Links to the project's library are paths.
fn named_folders(folders: &[(LibraryKind, PathBuf)]) -> Vec<LibraryFolder> {
    let named = folders.iter().filter_map(|(library, folder)| {
        let name = match library {
            LibraryKind::Sabi => "sabi",
            LibraryKind::User => "user",
            LibraryKind::Project => return None,
        };
        Some(LibraryFolder {
            name: name.to_owned(),
            folder: folder.clone(),
        })
    });
    named.collect()
}
