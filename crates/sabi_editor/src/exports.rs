//! Exports: textures of the open graph, written on a thread of their own.

mod export_task;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::baking::presets::default_preset_folder;
use sabi_engine::baking::{BakeReport, BakeRequest, Seams, bake_graph, needs_force};
use sabi_engine::evaluating::EvaluatorOptions;
use sabi_engine::{EngineError, ErrorKind, Warning};
use sabi_export::ConstantRecord;
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::Overrides;

use crate::evaluation::Evaluation;
use crate::notices::{Notices, Work};
use crate::paths::{canonical_if_present, file_name};
use crate::settings::export::{ExportChoices, ExportPlace};
use crate::task::TaskFailure;
use export_task::{Bake, ExportTask};

/// Name of the folder for the graph's own values, where every variant is exported.
const BASE: &str = "base";

/// Exports of the window: the running one, those that wait for it, and the result of the last one.
#[derive(Default)]
pub(crate) struct Exports {
    /// Target of the open graph's textures.
    pub(crate) place: ExportPlace,
    pub(crate) running: Option<ExportTask>,
    /// Exports that start after the running one, each of a graph as it was saved meanwhile.
    pub(crate) queued: VecDeque<Bake>,
    /// True if the folder has files that do not belong to the graph, and the panel asks whether to write there anyway.
    pub(crate) asks_force: bool,
    /// Result of the last export.
    pub(crate) result: Option<Result<ExportOutput, EngineError>>,
}

/// Files and warnings of an export.
pub(crate) struct ExportOutput {
    pub(crate) folder: PathBuf,
    pub(crate) files: Vec<ExportedFile>,
    /// Channels without a file because they are the same everywhere, with their values.
    pub(crate) constants: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
    /// Memory of its maps in an engine, by folder.
    pub(crate) memory: Vec<String>,
}

/// A file of an export.
pub(crate) struct ExportedFile {
    /// Path in the folder.
    pub(crate) path: String,
    /// Bits and color space of a map.
    pub(crate) format: Option<String>,
}

/// Inputs of an export.
#[derive(Clone, Copy)]
pub(crate) struct ExportSource<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) choices: &'a ExportChoices,
}

impl Exports {
    /// Switches to the export target of another graph.
    pub(crate) fn turn_to(&mut self, place: ExportPlace) {
        self.place = place;
        self.asks_force = false;
        self.result = None;
    }

    /// Takes the results of exports, and reports a failure even if the export panel is hidden.
    pub(crate) fn follow(&mut self, context: &Context, notices: &mut Notices) {
        let Some(folder) = self.poll(context) else {
            return;
        };
        match &self.result {
            Some(Err(error)) if error.kind != ErrorKind::Interrupted => {
                let folder = folder.display();
                notices.fail(
                    Work::Export,
                    format!("The textures were not exported to {folder}: {error}"),
                );
            }
            Some(Ok(_)) => notices.succeed(Work::Export),
            _ => {}
        }
    }

    /// Takes over the result of an export that has ended, and starts the next one. Returns the folder of the one that has ended.
    pub(crate) fn poll(&mut self, context: &Context) -> Option<PathBuf> {
        let done = self.running.as_ref().and_then(ExportTask::poll)?;
        let running = self.running.take()?;
        let failed = "The export stopped unexpectedly, which is a bug in the program; nothing was changed.";
        let done = done.unwrap_or_else(|TaskFailure| Err(EngineError::new(ErrorKind::Defect, failed)));
        let before = self.result.take().filter(|_| running.continues);
        self.result = Some(match (before, done) {
            (Some(Ok(before)), Ok(report)) => Ok(before.and(&running.folder, report)),
            (_, Ok(report)) => Ok(ExportOutput::new(running.folder.clone(), report)),
            (_, Err(error)) => {
                // Later exports may be of a newer save.
                while self.queued.front().is_some_and(|bake| bake.continues) {
                    self.queued.pop_front();
                }
                Err(error)
            }
        });
        if let Some(bake) = self.queued.pop_front() {
            self.running = Some(ExportTask::start(context, bake));
        }
        Some(running.folder.clone())
    }

    /// Cancels the running export and those that wait for it.
    pub(crate) fn cancel(&mut self) {
        self.queued.clear();
        if let Some(running) = &self.running {
            running.cancel();
        }
    }

    /// Starts an export. With `force`, it writes to the folder even if that has files that do not belong to the graph.
    ///
    /// # Errors
    /// It cannot start; the error is a sentence.
    pub(crate) fn start(&mut self, context: &Context, source: ExportSource<'_>, force: bool) -> Result<(), String> {
        if self.running.is_some() {
            return Err("An export is being made already.".to_owned());
        }
        let mut bakes = self.bakes(source, |_| force)?.into_iter();
        self.running = bakes.next().map(|bake| ExportTask::start(context, bake));
        self.queued.extend(bakes);
        Ok(())
    }

    /// Exports again, if the user wants that at every save.
    ///
    /// # Errors
    /// It cannot start; the error is a sentence.
    pub(crate) fn after_save(&mut self, context: &Context, source: ExportSource<'_>) -> Result<(), String> {
        if !self.place.again {
            return Ok(());
        }
        let now = source.evaluation.model.file();
        let is_other = |before: &&PathBuf| canonical_if_present(before) != canonical_if_present(now);
        if let Some(before) = self.place.model.as_ref().filter(is_other) {
            return Err(format!(
                "The textures were not exported again: the folder holds those of {}. Press Export once to replace them by \
                 those of {}.",
                file_name(before),
                file_name(now)
            ));
        }
        let Some(running) = &self.running else {
            return self.start(context, source, false);
        };
        // The folder of a running export may have textures of it.
        let at_work = running.folder.clone();
        for bake in self.bakes(source, |folder| *folder == at_work)? {
            // A newer export to the same folder replaces an older one.
            self.queued.retain(|known| known.folder != bake.folder);
            self.queued.push_back(bake);
        }
        Ok(())
    }

    /// Folder for the textures; `None` where it is not named, or is relative to the file of a graph that has none.
    fn folder(&self, document: &OpenDocument) -> Option<PathBuf> {
        folder_of(&self.place.folder, document.session.file())
    }

    /// Exports of the graph as it is now: of the shown values, or of the base and every variant. `force` tells whether
    /// a folder is written to even if it has files that do not belong to the graph.
    fn bakes(&mut self, source: ExportSource<'_>, force: impl Fn(&PathBuf) -> bool) -> Result<Vec<Bake>, String> {
        let Some(folder) = self.folder(source.document) else {
            let is_empty = self.place.folder.trim().is_empty();
            return Err(match is_empty {
                true => "Choose a folder for the textures first.".to_owned(),
                false => "Save the graph first, or type the whole path of a folder.".to_owned(),
            });
        };
        let variants = source.document.contents().graph.variants();
        let targets: Vec<(PathBuf, Overrides)> = if self.place.variants && !variants.is_empty() {
            let mut targets = vec![(folder.join(BASE), Overrides::default())];
            for variant in variants.keys() {
                let mut target = folder.join(folder_name(variant));
                // Names of variants that differ only in special characters give the same folder, and on many systems
                // also names that differ only in case.
                let lower = |path: &Path| path.to_string_lossy().to_lowercase();
                while targets.iter().any(|(known, _)| lower(known) == lower(&target)) {
                    target.as_mut_os_string().push("_");
                }
                let overrides = Overrides {
                    variant: Some(variant.clone()),
                    ..Overrides::default()
                };
                targets.push((target, overrides));
            }
            targets
        } else {
            vec![(folder, Overrides::of_preview(source.document.contents()))]
        };
        let mut bakes = Vec::new();
        for (folder, overrides) in targets {
            let mut request = source.request(folder.clone(), force(&folder));
            request.evaluator.overrides = overrides;
            let open = source.document.session.graph().clone();
            let kinds = source.document.node_kinds().kinds.clone();
            self.asks_force = needs_force(&open, &request);
            if self.asks_force {
                let why = "Nothing was exported: the folder has other files. Decide in the Export panel.";
                return Err(why.to_owned());
            }
            bakes.push(Bake {
                folder,
                continues: !bakes.is_empty(),
                work: Box::new(move |progress| bake_graph(&open, &kinds, &request, progress)),
            });
        }
        self.place.model = Some(source.evaluation.model.file().to_owned());
        Ok(bakes)
    }
}

impl ExportOutput {
    fn new(folder: PathBuf, report: BakeReport) -> ExportOutput {
        ExportOutput {
            folder,
            files: files_of(&report),
            constants: report.constants.iter().map(constant_text).collect(),
            memory: report.engine.sentence().into_iter().collect(),
            warnings: report.warnings,
        }
    }

    /// Adds the files of a folder beside this one.
    fn and(mut self, folder: &Path, report: BakeReport) -> ExportOutput {
        let named = |folder: &Path, path: &str| format!("{}/{path}", file_name(folder));
        if let Some(above) = folder.parent().filter(|above| self.folder != **above) {
            for file in &mut self.files {
                file.path = named(&self.folder, &file.path);
            }
            for constant in &mut self.constants {
                *constant = named(&self.folder, constant);
            }
            for memory in &mut self.memory {
                *memory = format!("{}: {memory}", file_name(&self.folder));
            }
            above.clone_into(&mut self.folder);
        }
        self.files
            .extend(files_of(&report).into_iter().map(|file| ExportedFile {
                path: named(folder, &file.path),
                ..file
            }));
        let constants = report.constants.iter().map(constant_text);
        self.constants
            .extend(constants.map(|constant| named(folder, &constant)));
        let memory = report.engine.sentence();
        self.memory
            .extend(memory.map(|memory| format!("{}: {memory}", file_name(folder))));
        for warning in report.warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        self
    }
}

/// Files of a bake, with the format of those that are maps.
fn files_of(report: &BakeReport) -> Vec<ExportedFile> {
    let format = |path: &String| {
        let map = report.outputs.iter().find(|map| map.path == *path)?;
        let space = if map.color_space == "srgb" { "sRGB" } else { "linear" };
        Some(format!("{} bits, {space}", map.bits))
    };
    let file = |path: &String| ExportedFile {
        path: path.clone(),
        format: format(path),
    };
    report.files.iter().map(file).collect()
}

/// A constant channel with its value, and its material where that has a name.
fn constant_text(constant: &ConstantRecord) -> String {
    let value = constant.srgb.clone().unwrap_or_else(|| constant.value.to_string());
    format!("{} {}: {value} everywhere", constant.material, constant.channel.name())
}

/// Name of a folder for a variant: its letters, digits, dots and dashes.
fn folder_name(variant: &str) -> String {
    let is_kept = |letter: char| letter.is_alphanumeric() || "-_.".contains(letter);
    let name: String = variant
        .chars()
        .map(|letter| if is_kept(letter) { letter } else { '_' })
        .collect();
    match name.trim_matches('.') {
        "" => "_".to_owned(),
        name => name.to_owned(),
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
            preset_folder: default_preset_folder(),
            names: Some(choices.names.clone()).filter(|names| !names.is_empty()),
            channels: choices.channels.clone(),
            mesh_maps: Vec::new(),
            material: None,
            all_maps: choices.all_maps,
            padding: choices.padding.texels(choices.size),
            seams: Seams::default(),
            fuse: true,
            force,
            model: choices.copy_options(),
            report: None,
            disk: document.session.disk().clone(),
        }
    }
}

/// Folder that was typed. A relative one is beside the graph's file, and `None` while the graph has no file.
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
    fn relative_folders_are_beside_the_graph_and_never_in_the_working_directory() {
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
