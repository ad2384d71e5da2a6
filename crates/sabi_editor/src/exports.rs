//! Exports: textures of the open graph, written on a thread of their own.

mod running;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::{
    AdapterChoice, BakeReport, BakeRequest, CasterChoice, DEFAULT_BUDGET_BYTES, EngineError, ErrorKind,
    EvaluatorOptions, Overrides, Seams, Warning, bake_graph, default_padding, needs_force,
};

use crate::evaluation::Evaluation;
use crate::paths::{canonical_if_present, file_name};
use crate::settings::export::{ExportChoices, ExportPlace};
use crate::task::Failed;
use running::{Bake, Running};

/// Exports of the window: the running one, those that wait for it, and the result of the last one.
#[derive(Default)]
pub(crate) struct Exports {
    /// Target of the open graph's textures.
    pub(crate) place: ExportPlace,
    pub(crate) running: Option<Running>,
    /// Exports that start after the running one, each of a graph as it was saved meanwhile.
    pub(crate) queued: VecDeque<Bake>,
    /// True if the folder has files that do not belong to the graph, and the panel asks whether to write there anyway.
    pub(crate) asks_force: bool,
    /// Result of the last export.
    pub(crate) result: Option<Result<Written, EngineError>>,
}

/// Files and warnings of an export.
pub(crate) struct Written {
    pub(crate) files: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
}

/// Inputs of an export.
#[derive(Clone, Copy)]
pub(crate) struct ExportSource<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) choices: &'a ExportChoices,
}

impl Exports {
    /// Turns to the target of another graph.
    pub(crate) fn turn_to(&mut self, place: ExportPlace) {
        self.place = place;
        self.asks_force = false;
        self.result = None;
    }

    /// Takes over the result of an export that has ended, and starts the next one.
    pub(crate) fn poll(&mut self, context: &Context) {
        let Some(done) = self.running.as_ref().and_then(Running::poll) else {
            return;
        };
        self.running = None;
        let failed = "The export stopped unexpectedly, which is a bug in the program; nothing was changed.";
        let done = done.unwrap_or_else(|Failed| Err(EngineError::new(ErrorKind::Defect, failed)));
        self.result = Some(done.map(|report: BakeReport| Written {
            files: report.files,
            warnings: report.warnings,
        }));
        if let Some(bake) = self.queued.pop_front() {
            self.running = Some(Running::start(context, bake));
        }
    }

    /// Cancels the running export and those that wait for it.
    pub(crate) fn cancel(&mut self) {
        self.queued.clear();
        if let Some(running) = &self.running {
            running.cancel();
        }
    }

    /// Starts an export. With `force` it writes to a folder whatever files are in it.
    ///
    /// # Errors
    /// A sentence, where it cannot start.
    pub(crate) fn start(&mut self, context: &Context, source: ExportSource<'_>, force: bool) -> Result<(), String> {
        if self.running.is_some() {
            return Err("An export is being made already.".to_owned());
        }
        let bake = self.bake(source, force)?;
        self.running = Some(Running::start(context, bake));
        Ok(())
    }

    /// Exports again where that is wanted at every save.
    ///
    /// # Errors
    /// A sentence, where it cannot start.
    pub(crate) fn after_save(&mut self, context: &Context, source: ExportSource<'_>) -> Result<(), String> {
        if !self.place.again {
            return Ok(());
        }
        let now = source.evaluation.model.file();
        let is_other = |before: &&PathBuf| canonical_if_present(before) != canonical_if_present(now);
        if let Some(before) = self.place.model.as_ref().filter(is_other) {
            return Err(format!(
                "The textures were not written again: those that are there are of {}. Export them once to put those of {} \
                 in their place.",
                file_name(before),
                file_name(now)
            ));
        }
        let Some(running) = &self.running else {
            return self.start(context, source, false);
        };
        // The folder of a running export may have textures of it.
        let force = Some(&running.folder) == self.folder(source.document).as_ref();
        let bake = self.bake(source, force)?;
        // A newer export to the same folder replaces an older one.
        self.queued.retain(|known| known.folder != bake.folder);
        self.queued.push_back(bake);
        Ok(())
    }

    /// Folder for the textures; none where it is not named, or is relative to the file of a graph that has none.
    fn folder(&self, document: &OpenDocument) -> Option<PathBuf> {
        folder_of(&self.place.folder, document.session.file())
    }

    /// An export of the graph as it is now.
    fn bake(&mut self, source: ExportSource<'_>, force: bool) -> Result<Bake, String> {
        let Some(folder) = self.folder(source.document) else {
            let is_empty = self.place.folder.trim().is_empty();
            return Err(match is_empty {
                true => "Name the folder for the textures first.".to_owned(),
                false => {
                    "Save the graph first, so that there is a folder beside it, or write the whole path of another."
                        .to_owned()
                }
            });
        };
        let request = source.request(folder.clone(), force);
        let open = source.document.session.graph().clone();
        let kinds = source.document.kinds().0.clone();
        self.asks_force = needs_force(&open, &request);
        if self.asks_force {
            let why = "No textures were written: their folder has other files. The export panel asks what to do.";
            return Err(why.to_owned());
        }
        self.place.model = Some(source.evaluation.model.file().to_owned());
        Ok(Bake {
            folder,
            work: Box::new(move |progress| bake_graph(&open, &kinds, &request, progress)),
        })
    }
}

impl ExportSource<'_> {
    /// Request with the panel's choices, for the window's model and device.
    pub(crate) fn request(&self, output: PathBuf, force: bool) -> BakeRequest {
        let ExportSource {
            document,
            evaluation,
            choices,
        } = *self;
        BakeRequest {
            graph: document.session.graph().path.clone(),
            evaluator: EvaluatorOptions {
                model: evaluation.model.options_of_size(choices.size),
                overrides: Overrides::of_preview(document.contents()),
                fit: None,
                adapter: AdapterChoice::Named(evaluation.gpu().summary().name.clone()),
                caster: CasterChoice::Auto,
                budget_bytes: DEFAULT_BUDGET_BYTES,
            },
            output,
            presets: vec![choices.preset.clone()],
            names: Some(choices.names.clone()).filter(|names| !names.is_empty()),
            channels: choices.channels.clone(),
            material: None,
            all_maps: choices.all_maps,
            padding: Some(default_padding(choices.size)),
            seams: Seams::default(),
            fuse: true,
            force,
            model: choices.has_model,
            report: None,
        }
    }
}

/// Folder that was typed. A relative one is beside the graph's file, and none while the graph has no file.
fn folder_of(text: &str, graph: Option<&Path>) -> Option<PathBuf> {
    let typed = PathBuf::from(text.trim());
    if typed.as_os_str().is_empty() {
        return None;
    }
    match graph.and_then(Path::parent) {
        Some(folder) => Some(folder.join(typed)),
        None => Some(typed).filter(|typed| typed.is_absolute()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_beside_the_graph_and_never_where_the_program_was_started() {
        let graph = Path::new("project").join("worn.sabi");
        let whole = std::env::temp_dir();
        let told = whole.display().to_string();
        assert_eq!(folder_of(" maps ", Some(&graph)), Some(PathBuf::from("project/maps")));
        assert_eq!(folder_of(&told, Some(&graph)), Some(whole.clone()));
        assert_eq!(folder_of("maps", None), None);
        assert_eq!(folder_of(&told, None), Some(whole));
        assert_eq!(folder_of("  ", Some(&graph)), None);
    }
}
