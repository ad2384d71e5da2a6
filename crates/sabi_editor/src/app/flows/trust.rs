//! Trust in files that lie outside of the folder of the graph or model that names them.

use std::path::Path;

use sabi_editing::knob_target::KnobTarget;
use sabi_editing::{knob_target, relative_paths};
use sabi_engine::{TrustedPaths, Value};

use super::super::Editor;
use crate::action::TrustAction;
use crate::paths::{canonical_if_present, model_of};

impl Editor {
    /// Takes over trust that the user gives, for this graph and all later ones.
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
        let named = model_of(&self.documents.document.session).and_then(Result::ok);
        if let Some(model) = named.filter(|model| canonical_if_present(model) != shown) {
            self.take_model(&model);
        }
    }

    /// Remembers the files that the user chose for the graph, so that it opens them the next time.
    pub(in crate::app) fn remember_chosen(&mut self) {
        for file in self.documents.document.take_chosen() {
            self.remember_file(&file);
        }
    }

    /// Shows a model that the user chose.
    pub(in crate::app) fn take_chosen_model(&mut self, file: &Path) {
        self.trust_model(file);
        self.take_model(file);
    }

    /// Shows a model that the user chose beside the main one.
    pub(in crate::app) fn show_chosen_beside(&mut self, file: &Path) {
        self.trust_model(file);
        self.show_beside(file);
    }

    /// Lets every graph open a model that the user chose: a graph that is saved names it.
    fn trust_model(&mut self, file: &Path) {
        let graph = self.documents.document.session.graph();
        if !graph.base().is_above(file) && !graph.trusted.contains(file) {
            self.remember_file(file);
        }
    }

    fn remember_file(&mut self, file: &Path) {
        self.shell.settings.trust(file);
        self.documents.trust(&TrustedPaths::default().with_path(file));
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
