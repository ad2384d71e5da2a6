//! Textures are written beside the window's work.

use std::path::{Path, PathBuf};

use sabi_engine::{
    AdapterChoice, BakeRequest, CasterChoice, DEFAULT_BUDGET_BYTES, EvaluatorOptions, Overrides, Seams, bake_graph,
    default_padding, needs_force,
};

use super::Editor;
use crate::files::whole;
use crate::panels::export::{Bake, Running, folder_of};

impl Editor {
    /// Turns the panel to where textures of the open graph went before.
    pub(super) fn recall_export(&mut self) {
        let file = self.document.session.file();
        let place = file.map(|file| self.settings.export_place(file)).unwrap_or_default();
        self.panels.export.turn_to(place);
    }

    /// Keeps where textures of the open graph go.
    pub(super) fn remember_export(&mut self) {
        if let Some(file) = self.document.session.file() {
            self.settings.remember_export(file, &self.panels.export.place);
        }
    }

    /// Takes what came of an export, and begins the one that waits for its end.
    pub(super) fn follow_export(&mut self) {
        let is_over = self.panels.export.poll();
        if is_over && let Some(bake) = self.panels.export.queued.pop_front() {
            self.begin_export(bake);
        }
    }

    /// Writes the textures again where that is wanted at every save.
    pub(super) fn export_after_save(&mut self) {
        let export = &self.panels.export;
        if !export.place.again {
            return;
        }
        let now = self.stage.model_file();
        if let Some(before) = export.place.model.as_ref().filter(|before| whole(before) != whole(now)) {
            let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let sentence = format!(
                "The textures were not written again: those that are there are of {}. Export them once to put those of {} \
                 in their place.",
                name(before),
                name(now)
            );
            self.say(sentence);
            return;
        }
        match &export.running {
            Some(running) => {
                // A folder that textures are being written to is one that may have them.
                let is_allowed = Some(&running.folder) == self.export_folder().as_ref();
                self.queue_export(is_allowed);
            }
            None => self.export(),
        }
    }

    fn queue_export(&mut self, force: bool) {
        if let Some(bake) = self.bake(force) {
            let queued = &mut self.panels.export.queued;
            // What is newer in the same folder takes its place.
            queued.retain(|known| known.folder != bake.folder);
            queued.push_back(bake);
        }
    }

    /// Where textures go; none where that is not said, or hangs on the file that the graph does not have yet.
    fn export_folder(&self) -> Option<PathBuf> {
        folder_of(&self.panels.export.place.folder, self.document.session.file())
    }

    /// Writes the textures beside the window's work; asks first where the folder has files of somebody else.
    pub(crate) fn export(&mut self) {
        self.export_with(false);
    }

    /// Writes the textures into a folder whatever else it has.
    pub(crate) fn export_into_any_folder(&mut self) {
        self.export_with(true);
    }

    fn export_with(&mut self, force: bool) {
        if self.panels.export.running.is_some() {
            self.say("An export is being made already.");
        } else if let Some(bake) = self.bake(force) {
            self.begin_export(bake);
        }
    }

    fn begin_export(&mut self, bake: Bake) {
        self.panels.export.running = Some(Running::start(&self.context, bake));
    }

    /// What writes the textures of the graph as it is now; says why where they cannot be written.
    fn bake(&mut self, force: bool) -> Option<Bake> {
        let Some(folder) = self.export_folder() else {
            let is_empty = self.panels.export.place.folder.trim().is_empty();
            self.say(match is_empty {
                true => "Name the folder for the textures first.",
                false => {
                    "Save the graph first, so that there is a folder beside it, or write the whole path of another."
                }
            });
            return None;
        };
        let request = self.bake_request(folder.clone(), force);
        let (open, kinds) = (self.document.session.graph().clone(), self.document.kinds().0.clone());
        self.panels.export.asks_force = needs_force(&open, &request);
        if self.panels.export.asks_force {
            self.say("No textures were written: their folder has other files. The export panel asks what to do.");
            return None;
        }
        self.panels.export.place.model = Some(self.stage.model_file().to_owned());
        Some(Bake {
            folder,
            work: Box::new(move |progress| bake_graph(&open, &kinds, &request, progress)),
        })
    }

    /// What the export panel says, for the model and the device of the window.
    pub(super) fn bake_request(&self, output: PathBuf, force: bool) -> BakeRequest {
        let export = &self.settings.export;
        BakeRequest {
            graph: self.document.session.graph().path.clone(),
            evaluator: EvaluatorOptions {
                model: self.stage.model_of_size(export.size),
                overrides: Overrides::default(),
                fit: None,
                adapter: AdapterChoice::Named(self.stage.gpu().summary().name.clone()),
                caster: CasterChoice::Auto,
                budget_bytes: DEFAULT_BUDGET_BYTES,
            },
            output,
            presets: vec![export.preset.clone()],
            names: Some(export.names.clone()).filter(|names| !names.is_empty()),
            channels: export.channels.clone(),
            material: None,
            all_maps: export.all_maps,
            padding: Some(default_padding(export.size)),
            seams: Seams::default(),
            fuse: true,
            force,
            model: export.has_model,
            report: None,
        }
    }
}
