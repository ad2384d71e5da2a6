//! Files that change while they are open: nodes, the model, the environment, pictures, group files and the library are read
//! again, and the graph's own file is asked about, since what is here would be gone.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::{Context, Frame, Margin, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::{EngineError, FileState, Kinds, Watched, Watcher};

use crate::app::Editor;

/// The files that the window hangs on.
pub(crate) struct Watching {
    /// None where the system has no thread for it, which was said.
    watcher: Option<Watcher>,
    followed: Option<Followed>,
    /// Whether the library has to be read again once its files are watched: they may have changed since they were read.
    rereads_library: bool,
    /// Whether another program wrote the graph's file, and it is to be said what becomes of that.
    pub(crate) is_asked: bool,
}

/// What the watched files follow from.
#[derive(Clone, PartialEq)]
struct Followed {
    graph: Option<PathBuf>,
    model: PathBuf,
    /// The model that is there, and whether it is the one that is wanted.
    loaded: (Option<u64>, bool),
    named: Arc<BTreeSet<PathBuf>>,
    /// Folders and files of the library.
    library: Arc<[PathBuf]>,
    environment: Option<PathBuf>,
}

impl Watching {
    /// Watches nothing yet, and nothing ever where the system does not let it; `context` is woken when something changes.
    pub(crate) fn new(context: &Context) -> (Watching, Option<EngineError>) {
        let woken = context.clone();
        let (watcher, error) = match Watcher::new(move || woken.request_repaint()) {
            Ok(watcher) => (Some(watcher), None),
            Err(error) => (None, Some(error)),
        };
        let watching = Watching {
            watcher,
            followed: None,
            rereads_library: false,
            is_asked: false,
        };
        (watching, error)
    }

    /// Whether changes from here on are seen.
    #[cfg(test)]
    pub(crate) fn is_watching(&self) -> bool {
        self.followed.is_some() && self.watcher.as_ref().is_some_and(Watcher::is_watching)
    }
}

impl Editor {
    /// Reads again what has changed.
    pub(crate) fn follow_files(&mut self) {
        self.follow();
        let Some(watcher) = &self.watching.watcher else { return };
        if self.watching.rereads_library && watcher.is_watching() {
            self.watching.rereads_library = false;
            self.panels.library.forget();
        } else if self.watching.rereads_library {
            self.context.request_repaint_after(Duration::from_millis(100));
        }
        let changes = watcher.changes();
        if changes.nodes {
            let mut kinds = Kinds::clone(self.document.kinds().0);
            kinds.reread(&Kinds::folders(self.document.session.file()));
            self.document.take_kinds(kinds);
        }
        if changes.model {
            self.stage.reread_model();
        }
        let Some(followed) = &self.watching.followed else {
            return;
        };
        if followed.library.iter().any(|file| changes.files.contains(file)) {
            self.panels.library.forget();
        }
        if followed.environment.iter().any(|file| changes.files.contains(file)) {
            self.model_view.reread_environment();
        }
        if !changes.files.is_disjoint(&followed.named) {
            self.document.files_changed(&changes.files);
        }
        if changes.graph {
            self.look_at_file();
        }
    }

    /// Watches what is to be watched by now.
    fn follow(&mut self) {
        let stage = &self.stage;
        let now = Followed {
            graph: self.document.session.file().map(Path::to_owned),
            model: stage.model_file().to_owned(),
            loaded: stage.loaded_model(),
            named: stage.files.clone(),
            library: self.panels.library.files().clone(),
            environment: self.model_view.environment_file().map(Path::to_owned),
        };
        if self.watching.followed.as_ref() == Some(&now) {
            return;
        }
        if self
            .watching
            .followed
            .as_ref()
            .is_some_and(|before| before.graph != now.graph)
        {
            self.watching.is_asked = false;
        }
        let before = self.watching.followed.as_ref();
        self.watching.rereads_library |= before.is_some_and(|before| before.library != now.library);
        if let Some(watcher) = &self.watching.watcher {
            watcher.watch(Watched {
                nodes: Kinds::folders(now.graph.as_deref()),
                graph: now.graph.clone(),
                model: self.model_files(),
                files: now
                    .named
                    .iter()
                    .chain(&*now.library)
                    .chain(&now.environment)
                    .cloned()
                    .collect(),
            });
        }
        self.watching.followed = Some(now);
    }

    /// Files that the model is read from. As long as it cannot be read, what comes into its folder may be what it lacks.
    fn model_files(&self) -> Vec<PathBuf> {
        let file = self.stage.model_file();
        let mut files = vec![file.to_owned()];
        match &self.stage.shown_model {
            Some(model) if self.stage.loaded_model().1 => {
                let model = &model.linked.model;
                files.extend(model.files.iter().chain(&model.absent).cloned());
            }
            _ => files.extend(file.parent().map(Path::to_owned)),
        }
        files
    }

    /// Finds out whether another program wrote the graph's file.
    fn look_at_file(&mut self) {
        let state = self.document.session.look_at_file();
        self.watching.is_asked = state == FileState::Another;
        self.keep_soon();
        if state == FileState::Gone
            && let Some(file) = self.document.session.file()
        {
            self.say(format!(
                "{} is not there any more; saving writes it again",
                file.display()
            ));
        }
    }

    /// Asks what becomes of a file that another program wrote.
    pub(crate) fn show_outside(&mut self, ui: &mut Ui) {
        let Some(file) = self.document.session.file().filter(|_| self.watching.is_asked) else {
            return;
        };
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let theme = self.theme().clone();
        let frame = Frame::new().fill(theme.panel).inner_margin(Margin::symmetric(8, 4));
        let [mut anew, mut keep] = [false; 2];
        egui::Panel::top("outside")
            .frame(frame)
            .show_separator_line(false)
            .show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    let sentence = format!("{} Another program has written {name}.", icon::WARNING);
                    ui.label(RichText::new(sentence).color(theme.warning));
                    let button = ui.button("Open it anew");
                    anew = button.on_hover_text("Undo brings back what is here now").clicked();
                    let button = ui.button("Keep what is here");
                    let aside =
                        format!("Saving puts it in the place of the other, which stays beside it as {name}.bak");
                    keep = button.on_hover_text(aside).clicked();
                });
            });
        if anew {
            self.open_anew();
        }
        if keep {
            self.watching.is_asked = false;
            self.document.session.keep_apart();
            self.keep_soon();
        }
    }

    /// Takes what another program wrote in the place of what is here.
    fn open_anew(&mut self) {
        let before = crate::app::model_of(&self.document.session);
        match self.document.read_again() {
            Ok(()) => {
                self.watching.is_asked = false;
                let model = crate::app::model_of(&self.document.session);
                if let Some(model) = model.filter(|model| before.as_ref() != Some(model)) {
                    self.take_model(&model);
                }
            }
            Err(error) => self.say(error.to_string()),
        }
    }
}
