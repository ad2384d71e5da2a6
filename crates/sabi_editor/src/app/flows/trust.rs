//! Trust in files that lie outside of the folder of the graph or model that names them.

use std::path::{Path, PathBuf};

use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{knob_target, missing_files, relative_paths, trust};
use sabi_files::{PathBase, TrustedPaths};
use sabi_graph::Value;

use super::super::Editor;
use crate::action::TrustAction;
use crate::import_options::ImportOptions;
use crate::paths::canonical_if_present;

impl Editor {
    /// Performs an action about trust. Trusted paths hold for this graph and all later ones.
    pub(in crate::app) fn trust(&mut self, action: TrustAction) {
        match action {
            TrustAction::Folder(folder) => {
                self.shell.settings.trust(&folder);
                self.documents.trust(&TrustedPaths::default().with_path(&folder));
                self.take_named_model();
            }
            TrustAction::Nodes(folder) => {
                self.shell.settings.trust_nodes(&folder);
                self.documents.trust_nodes(&folder);
                self.documents
                    .reread_kinds(&self.shell.context, std::slice::from_ref(&folder));
            }
            TrustAction::LeaveNodes => self.documents.leaves_nodes = true,
        }
    }

    /// Shows the model that the graph names, if it may be opened and is not shown.
    fn take_named_model(&mut self) {
        let shown = canonical_if_present(self.evaluation.model.file());
        let named = self.documents.named_model();
        if let Some(model) = named.filter(|model| canonical_if_present(model) != shown) {
            self.take_model(&model);
        }
    }

    /// Remembers the files that the user chose for the graph, so that it opens them the next time.
    pub(in crate::app) fn remember_chosen(&mut self) {
        for file in trust::take_chosen(&mut self.documents.document) {
            self.remember_file(&file);
        }
    }

    /// Shows a model that the user chose.
    pub(in crate::app) fn take_chosen_model(&mut self, file: &Path) {
        self.trust_model(file);
        self.documents.is_model_chosen = true;
        self.take_model(file);
    }

    /// Shows a model that the user chose beside the main one.
    pub(in crate::app) fn show_chosen_beside(&mut self, file: &Path) {
        self.trust_model(file);
        self.show_beside(file);
    }

    /// Lets every graph open a model that the user chose, since the open graph names it once it is saved.
    fn trust_model(&mut self, file: &Path) {
        if !self.opens_again(file) {
            self.remember_file(file);
        }
    }

    /// Remembers the files that the saved graph names, and those that its model was read from, so that it may open them
    /// the next time. It may be in another folder now, or have been opened with files that only the command line
    /// trusted.
    pub(in crate::app) fn remember_named(&mut self) {
        let named = missing_files::named(&self.documents.document);
        let model = self.evaluation.model.received.as_ref();
        let of_model = model.into_iter().flat_map(|model| {
            let files = &model.linked.model.files;
            let beside = files.first().map(|file| PathBase::of_file(file));
            let is_beside = move |file: &&PathBuf| beside.as_ref().is_some_and(|beside| beside.is_above(file));
            files.iter().filter(move |file| !is_beside(file)).cloned()
        });
        // The loaded model may be a substitute for one that was not found.
        let has_own_model = self.evaluation.model.loaded().1 && self.evaluation.model.refused().is_none();
        let of_model: Vec<PathBuf> = of_model.filter(|_| has_own_model).collect();
        for file in named.into_iter().chain(of_model) {
            if !self.opens_again(&file) {
                self.remember_file(&file);
            }
        }
    }

    /// Returns whether the folder of the graph and the settings alone allow the graph to open a file.
    fn opens_again(&self, file: &Path) -> bool {
        let place = self.documents.document.session.file();
        let by_place = place.is_some_and(|place| TrustedPaths::of_file(place).contains(file));
        let own = self.documents.folders.trusted();
        let kept = own.chain(&self.shell.settings.trusted);
        let kept = kept.fold(TrustedPaths::default(), |trusted, path| trusted.with_path(path));
        by_place || kept.contains(file)
    }

    fn remember_file(&mut self, file: &Path) {
        self.shell.settings.trust(file);
        self.documents.trust(&TrustedPaths::default().with_path(file));
    }

    /// Names a file in place of a missing one, and files beside it in place of other missing ones.
    pub(in crate::app) fn find_missing(&mut self, lost: &str, file: &Path) {
        let model = self.evaluation.model.received.as_ref();
        let is_texture = model.is_some_and(|model| model.linked.model.missing_pictures().contains(lost));
        if is_texture
            && !missing_files::missing(&self.documents.document)
                .iter()
                .any(|named| named == lost)
        {
            return self.look_for_textures_beside(file);
        }
        let before = self.documents.written_model();
        let found = missing_files::relocate(&mut self.documents.document, lost, file);
        if self.documents.written_model() != before {
            self.take_named_model();
        }
        let sentence = match found {
            0 => return,
            1 => format!("{} is used from now on.", file.display()),
            2 => format!(
                "{} is used from now on, and one more that lies beside it.",
                file.display()
            ),
            _ => format!(
                "{} is used from now on, and {} more that lie beside it.",
                file.display(),
                found - 1
            ),
        };
        self.shell.notify(sentence);
    }

    /// Reads the shown model again, and looks for its missing pictures in and below the folder of a file.
    fn look_for_textures_beside(&mut self, file: &Path) {
        let Some(folder) = file.parent().map(canonical_if_present) else {
            return;
        };
        self.trust_model(&folder);
        let reading = ImportOptions {
            textures: Some(folder.clone()),
            ..self.evaluation.model.import_options().clone()
        };
        self.read_model(reading);
        self.shell.notify(format!(
            "Missing pictures of the model are looked for in {}.",
            folder.display()
        ));
    }

    pub(in crate::app) fn set_image(&mut self, parameter: &KnobTarget, file: &Path) {
        let document = &mut self.documents.document;
        match relative_paths::chosen(document, file) {
            Ok(text) => {
                knob_target::set(document, parameter, Value::Text(text));
            }
            Err(refused) => document.notify(refused.to_string()),
        }
    }
}
