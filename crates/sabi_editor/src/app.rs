//! The window, which connects the owners of its state in each frame.

mod autosave;
mod candidates;
mod changed_files;
mod closing;
mod documents;
mod drop_targets;
mod graph_edits;
mod held_brush;
mod library_files;
mod model_pictures;
mod model_reading;
mod opening;
mod packing;
mod painting;
mod perform;
mod recoveries;
mod recovery_offers;
mod saving;
mod shell;
mod shown_models;
mod switching;
#[cfg(test)]
mod tests;
mod trust;

use std::sync::Arc;
use std::time::Instant;

use eframe::egui_wgpu::RenderState;
use egui::{Context, RawInput, Ui};
use sabi_editing::{OpenDocument, node_paths, nodes};
use sabi_gpu::Gpu;

use crate::action::Action;
use crate::bars;
use crate::button_frames::ButtonFrames;
use crate::choice_previews::{ChoicePreviews, PreviewSource};
use crate::command::{Command, FileCommand};
use crate::context::{View, ViewContext};
use crate::dock::{Dock, Panel};
use crate::evaluation::{Evaluation, WantedResults};
use crate::exports::Exports;
use crate::model_row::ModelRow;
use crate::node_brush_tip::NodeBrushTip;
use crate::notices::Work;
use crate::pack_task::PackTask;
use crate::panels::input_histogram;
use crate::pen::Pens;
use crate::shown_results::ShownResults;
use crate::views::Views;
use changed_files::follow_files;
use documents::Documents;
pub(crate) use documents::ProgramFolders;
use drop_targets::{DropTargets, mark_hovered_file};
use graph_edits::GraphEdits;
use model_pictures::{AwaitedPicture, ModelPictures};
use opening::OpenedWindow;
pub(crate) use opening::{Handover, InitialState};
use painting::Painting;
use recovery_offers::follow_recoveries;
use saving::{Saving, claim_file};
use shell::Shell;
use shown_models::ShownModels;
use switching::{recall_choices, remember_choices};

/// The window. Each field owns a part of its state. This type connects them in each frame, opens another graph in place
/// of the open one, closes, and hands each action (`app/perform.rs`) to what it is about: an owner, or a borrower of a few
/// owners, such as [`GraphEdits`], [`Painting`], [`ShownModels`] or [`Saving`].
pub(crate) struct Editor {
    pub(crate) documents: Documents,
    pub(crate) evaluation: Evaluation,
    pub(crate) row: ModelRow,
    pub(crate) choice_previews: ChoicePreviews,
    pub(crate) looks: ShownResults,
    pub(crate) exports: Exports,
    pub(crate) shell: Shell,
    pub(crate) views: Views,
    pub(crate) node_brush_tip: NodeBrushTip,
    packing: PackTask,
    pub(crate) pens: Pens,
    button_frames: ButtonFrames,
    awaited_picture: AwaitedPicture,
    handover: Handover,
    /// Called once the window is closed for good and all work is kept.
    at_end: fn(),
    /// True if the window closes because its device was lost and another window takes over.
    is_leaving: bool,
    /// True if the window may close without a question.
    may_close: bool,
}

impl Editor {
    /// Creates a window on a device.
    pub(crate) fn new(
        initial: InitialState,
        context: &Context,
        gpu: Arc<Gpu>,
        render: Option<RenderState>,
        handover: Handover,
    ) -> Editor {
        let (folders, at_end) = (initial.folders.clone(), initial.at_end);
        let mut shell = Shell::new(folders.settings.clone(), context, render);
        let OpenedWindow {
            documents,
            views,
            model,
            beside,
            fault,
        } = OpenedWindow::new(initial, &shell.settings, context, &handover);
        for fault in fault {
            shell.fail(fault);
        }
        let reading = documents.reading(&shell.settings, &model);
        let mut editor = Editor {
            evaluation: Evaluation::new(gpu, &model, reading, folders.cache, context),
            row: ModelRow::default(),
            choice_previews: ChoicePreviews::default(),
            documents,
            looks: ShownResults::default(),
            exports: Exports::default(),
            shell,
            views,
            node_brush_tip: NodeBrushTip::default(),
            packing: PackTask::default(),
            pens: Pens::default(),
            button_frames: ButtonFrames::default(),
            awaited_picture: AwaitedPicture::default(),
            handover,
            at_end,
            is_leaving: false,
            may_close: false,
        };
        recall_choices(&mut editor.documents, &mut editor.exports, &editor.shell.settings);
        claim_file(&mut editor.documents, &mut editor.views.questions);
        beside.iter().for_each(|model| editor.models().show_beside(model));
        editor
    }

    /// Returns the context that views read, the views, and the layout that they are drawn in.
    fn parts(&mut self) -> (ViewContext<'_>, &mut Views, &mut Dock) {
        let Editor {
            documents,
            evaluation,
            row,
            choice_previews,
            looks,
            exports,
            shell,
            views,
            pens,
            ..
        } = self;
        let is_dirty = documents.document.session.is_dirty();
        let context = ViewContext {
            document: &documents.document,
            evaluation,
            row,
            models: &documents.models.files,
            examples: documents.folders.examples.as_deref(),
            looks,
            exports,
            library: &documents.library,
            pictures: &documents.pictures,
            brushes: &documents.brushes,
            choice_previews,
            candidates: documents.candidates(),
            recoveries: &documents.recoveries.found,
            settings: &shell.settings,
            theme: &shell.theme,
            keys: &shell.keys,
            render: shell.render.as_ref(),
            frame_times: &shell.frame_times,
            pens,
            pictures_drawn: views.model.pictures.drawn,
            is_dirty,
            is_file_foreign: documents.is_file_foreign,
            leaves_nodes: documents.leaves_nodes,
            is_use_view: shell.dock.is_use_view(),
            is_dragging: documents.is_dragging,
        };
        (context, views, &mut shell.dock)
    }

    /// Edits of the open graph.
    fn edits(&mut self) -> GraphEdits<'_> {
        GraphEdits {
            documents: &mut self.documents,
            looks: &mut self.looks,
            views: &mut self.views,
            shell: &mut self.shell,
        }
    }

    /// Painting on the selected node.
    fn painting(&mut self) -> Painting<'_> {
        Painting {
            edits: GraphEdits {
                documents: &mut self.documents,
                looks: &mut self.looks,
                views: &mut self.views,
                shell: &mut self.shell,
            },
            evaluation: &self.evaluation,
            node_brush_tip: &mut self.node_brush_tip,
        }
    }

    /// Targets of a node that is dragged from the library.
    fn drop_targets(&self) -> DropTargets<'_> {
        DropTargets {
            documents: &self.documents,
            evaluation: &self.evaluation,
            looks: &self.looks,
            shell: &self.shell,
            views: &self.views,
        }
    }

    /// The shown model and the models beside it.
    pub(crate) fn models(&mut self) -> ShownModels<'_> {
        ShownModels {
            documents: &mut self.documents,
            evaluation: &mut self.evaluation,
            row: &mut self.row,
            shell: &mut self.shell,
            questions: &mut self.views.questions,
        }
    }

    /// Saving of the open graph.
    pub(crate) fn saving(&mut self) -> Saving<'_> {
        Saving {
            documents: &mut self.documents,
            evaluation: &self.evaluation,
            looks: &self.looks,
            shell: &mut self.shell,
            views: &mut self.views,
            exports: &mut self.exports,
        }
    }

    /// Draws the window and performs the requested actions.
    pub(crate) fn frame(&mut self, ui: &mut Ui) {
        let began = Instant::now();
        if self.is_leaving {
            return;
        }
        let context = ui.ctx().clone();
        self.evaluation.take_events(&context);
        mute_slow_nodes(
            &mut self.documents.document,
            &self.evaluation.faults.all.too_long,
            &mut self.shell,
        );
        self.models().follow();
        self.models().follow_reading();
        self.models().follow_row(&context);
        self.exports.follow(&context, &mut self.shell.notices);
        self.painting().take_node_tip();
        match self.packing.take() {
            Some(Ok(told)) => self.shell.notify(told),
            Some(Err(refused)) => self.shell.fail(refused),
            None => {}
        }
        if self.evaluation.lost.is_some() {
            self.hand_over(&context);
            return;
        }
        follow_files(
            &mut self.documents,
            &mut self.evaluation,
            &mut self.row,
            &mut self.views.model,
            &mut self.shell,
        );
        follow_recoveries(&mut self.documents, &mut self.views, &mut self.shell, &context);
        self.looks.cancel_color_target(&context);
        let is_dragging = self.documents.is_dragging;
        let mut actions = self.shell.keys_pressed(ui, &self.views, is_dragging);
        actions.extend(dropped_files(&context));
        self.documents.refresh_candidates();
        self.keep_open(ui);
        actions.extend(self.show(ui));
        mark_hovered_file(ui, &self.shell.theme);
        self.shell.leave_hidden_panel(&mut self.views);
        let document = &self.documents.document;
        let said = |sentence: &str| node_paths::with_titles(document, sentence);
        if self.shell.notices.show(ui, &self.shell.theme, &said) {
            actions.push(Action::Do(Command::File(FileCommand::SaveAs)));
        }
        self.perform_all(actions, ui);
        trust::remember_chosen(&mut self.documents, &mut self.shell.settings);
        let is_dirty = self.documents.document.session.is_dirty();
        let name = bars::marked_name(&self.documents.document, is_dirty);
        self.shell.set_title(format!("{name} – Sabi"));
        // Before the device gets work that may block the window.
        self.autosave(&context);
        self.request_results(&context);
        let kept = self.choice_previews.advance(
            &PreviewSource {
                document: &self.documents.document,
                evaluation: &self.evaluation,
                library: &self.documents.library,
            },
            &context,
        );
        self.shell.report(kept);
        let Editor {
            documents,
            evaluation,
            looks,
            shell,
            views,
            awaited_picture,
            ..
        } = self;
        let mut pictures = ModelPictures {
            documents,
            evaluation,
            looks,
            shell,
            model: &views.model,
        };
        awaited_picture.keep(&mut pictures, &context);
        self.shell.keyboard.end_frame(&context);
        self.shell.add_frame_time(began.elapsed());
    }

    /// Draws the bars and the views, and returns the requested actions.
    fn show(&mut self, ui: &mut Ui) -> Vec<Action> {
        let (context, views, dock) = self.parts();
        let mut actions = bars::top(ui, &context);
        actions.extend(bars::foreign_file(ui, &context));
        actions.extend(bars::trust(ui, &context));
        actions.extend(bars::status(ui, &context));
        dock.show(ui, context.theme, context.problem_count(), &mut |ui, panel| {
            actions.extend(views.in_panel(panel).show(ui, &context));
        });
        if views.start.is_open && views.questions.open.is_none() {
            actions.extend(views.start.show(ui, &context));
        }
        actions.extend(views.key_list.show(ui, &context));
        actions.extend(views.gradient_picker.show(ui, &context));
        actions.extend(views.questions.show(ui, &context));
        actions
    }

    /// Requests the results that are shown now.
    fn request_results(&mut self, context: &Context) {
        let document = &self.documents.document;
        self.looks.forget_deleted(document);
        let is_shown = |panel: Panel| self.shell.dock.is_shown(panel);
        let nodes = self.views.canvas.camera.visible_nodes(document).into_iter();
        let nodes = nodes.map(|id| self.looks.chosen(document, &id));
        let layers = self.views.layers.wanted.iter().cloned();
        let on_model = self.looks.on_model(document, &self.shell.settings);
        let wanted = WantedResults {
            subjects: [on_model].into_iter().chain(self.looks.beside_model()).collect(),
            inspected: self.looks.inspected().cloned(),
            measured: input_histogram::measured(document).filter(|_| is_shown(Panel::Parameters)),
            set: self.views.flat.set,
            thumbnails: nodes
                .filter(|_| is_shown(Panel::Canvas))
                .chain(layers.filter(|_| is_shown(Panel::Stack)))
                .collect(),
            is_flat: self.shell.settings.is_flat,
            is_moving: self.documents.is_dragging,
        };
        self.row.request(document, &wanted.subjects[0]);
        self.evaluation.request(document, wanted);
        // A drag may end outside of the window.
        if self.documents.is_dragging && !context.input(|input| input.pointer.any_down()) {
            self.documents.end_drag();
            context.request_repaint();
        }
    }

    /// Saves recovery copies of unsaved work, and settings that changed.
    fn autosave(&mut self, context: &Context) {
        let drafts_revision = self.views.page.revision();
        if self.documents.autosave.is_due(&self.documents.document) {
            self.documents.name_model_of_unsaved(&self.evaluation);
            let drafts = self.views.page.unsaved();
            let Documents { autosave, document, .. } = &mut self.documents;
            let saved = autosave.save(document, &drafts, drafts_revision);
            self.shell.report_on(Work::Autosave, saved);
            self.save_settings();
        }
        let Documents { autosave, document, .. } = &self.documents;
        autosave.schedule(context, document, drafts_revision);
    }

    /// Saves the settings, with the choices of views and exports.
    fn save_settings(&mut self) {
        remember_choices(&self.documents, &self.exports, &mut self.shell.settings);
        self.shell.settings.view = self.views.model.choices();
        self.shell.save_settings();
    }
}

/// Mutes nodes that keep the device busy for too long. For a node in a group, the group is muted.
fn mute_slow_nodes(document: &mut OpenDocument, too_long: &[String], shell: &mut Shell) {
    for full_id in too_long {
        let title = node_paths::title(document, full_id);
        let of_main_graph = full_id.split('/').next().and_then(|id| id.parse().ok());
        if of_main_graph.is_some_and(|id| nodes::mute_in_main_graph(document, &id)) {
            shell.notify(format!(
                "'{title}' keeps the device busy for too long and is muted. Change it before you unmute it."
            ));
        }
    }
}

/// Files that were dropped on the window.
fn dropped_files(context: &Context) -> Vec<Action> {
    let dropped = context.input(|input| input.raw.dropped_files.clone());
    let paths = dropped.into_iter().filter_map(|file| file.path);
    paths.map(Action::Dropped).collect()
}

impl eframe::App for Editor {
    fn raw_input_hook(&mut self, context: &Context, raw: &mut RawInput) {
        self.button_frames.enter_frame(raw);
        self.pens.enter_frame(raw, context.zoom_factor());
    }

    /// Called even while the window is hidden.
    fn logic(&mut self, context: &Context, _: &mut eframe::Frame) {
        if self.is_leaving {
            return;
        }
        self.evaluation.take_events(context);
        if self.evaluation.lost.is_some() {
            self.hand_over(context);
        }
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if self.looks.is_painting {
            self.pens.connect(frame);
        }
        self.frame(ui);
        self.pens.end_frame(ui.ctx());
        self.button_frames.end_frame(ui.ctx());
    }

    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        self.shell.theme.background.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.pens.disconnect();
        self.save_settings();
        if !self.is_leaving {
            self.end();
            // Cancels an archive that is being written, and waits until its temporary file is deleted.
            self.packing = PackTask::default();
            (self.at_end)();
        }
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}
