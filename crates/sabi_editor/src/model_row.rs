//! Models beside the main one, each with the same graph, so that the effect of a change is seen on all of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::live::ViewSubject;

use crate::evaluation::{Evaluation, ModelOutcome, WantedResults};
use crate::import_options::ImportOptions;
use crate::task::Task;

/// Most models beside the main one: every one takes memory of its own on the device.
pub(crate) const MOST_BESIDE: usize = 7;

/// Models beside the main one, in the order of the view.
#[derive(Default)]
pub(crate) struct ModelRow {
    beside: Vec<Evaluation>,
    /// Evaluations that end on threads of their own, since their last step may take long.
    ending: Vec<Task<()>>,
}

impl ModelRow {
    /// Evaluations on the models beside the main one.
    pub(crate) fn beside(&self) -> &[Evaluation] {
        &self.beside
    }

    /// Files of the models.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let files = self.beside.iter().map(|evaluation| evaluation.model.file());
        files.map(Path::to_owned).collect()
    }

    /// Returns whether a model is beside the main one.
    pub(crate) fn contains(&self, model: &Path) -> bool {
        self.beside.iter().any(|evaluation| evaluation.model.file() == model)
    }

    /// Adds a model beside the main one.
    ///
    /// # Errors
    /// A sentence, where it is shown already or there are as many as there may be.
    pub(crate) fn add(
        &mut self,
        main: &Evaluation,
        model: &Path,
        import: ImportOptions,
        context: &Context,
    ) -> Result<(), String> {
        if main.model.file() == model || self.contains(model) {
            return Err(format!("{} is shown already.", model.display()));
        }
        if self.beside.len() == MOST_BESIDE {
            return Err(format!(
                "There are {} models in the view, which is the most; remove one first.",
                MOST_BESIDE + 1
            ));
        }
        self.beside.push(main.beside(model, import, context));
        Ok(())
    }

    /// Removes a model from beside the main one, if it is there.
    pub(crate) fn remove(&mut self, model: &Path, context: &Context) {
        if let Some(at) = self.position(model) {
            let evaluation = self.beside.remove(at);
            self.ending.push(Task::start(context, move || drop(evaluation)));
        }
    }

    /// Shows another model in the place of one that becomes the main one.
    pub(crate) fn replace(&mut self, model: &Path, by: &Path, import: ImportOptions) {
        if let Some(at) = self.position(model) {
            self.beside[at].model.replace(by, import);
        }
    }

    fn position(&self, model: &Path) -> Option<usize> {
        self.beside.iter().position(|known| known.model.file() == model)
    }

    /// Takes the results that arrived. Returns the outcomes of models that were requested, by their files.
    pub(crate) fn take_events(&mut self, context: &Context) -> Vec<(PathBuf, ModelOutcome)> {
        self.ending.retain(|task| !task.is_over());
        let mut outcomes = Vec::new();
        for evaluation in &mut self.beside {
            evaluation.take_events(context);
            let outcome = evaluation.model.take_outcome();
            outcomes.extend(outcome.map(|outcome| (evaluation.model.file().to_owned(), outcome)));
        }
        outcomes
    }

    /// Requests the result that the main model shows on all of them.
    pub(crate) fn request(&mut self, document: &OpenDocument, subject: &ViewSubject) {
        for evaluation in &mut self.beside {
            let wanted = WantedResults {
                subjects: vec![subject.clone()],
                ..WantedResults::default()
            };
            evaluation.request(document, wanted);
        }
    }

    /// Reads the models again whose files are among those that changed.
    pub(crate) fn reread(&mut self, changed: &BTreeSet<PathBuf>) {
        let models = self.beside.iter_mut().map(|evaluation| &mut evaluation.model);
        for model in models.filter(|model| changed.contains(model.file())) {
            model.reread();
        }
    }

    /// Drops all results of nodes, since another graph is opened.
    pub(crate) fn drop_nodes(&mut self) {
        self.beside.iter_mut().for_each(Evaluation::drop_nodes);
    }
}
