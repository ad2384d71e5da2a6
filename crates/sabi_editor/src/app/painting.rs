//! Painting on the selected node: its strokes, and the brush that lays them.

mod stroke_clipboard;

use egui::Ui;
use sabi_editing::command::{Outcome, PaintCommand, perform};
use sabi_editing::painting;
use sabi_engine::live::ViewSubject;
use sabi_export::SetKey;
use sabi_graph::NodeId;
use sabi_paint::{Action as BrushAction, CopyOf};

use super::graph_edits::GraphEdits;
use super::held_brush::HeldBrush;
use crate::action::PaintAction;
use crate::command::BrushCommand;
use crate::dock::Panel;
use crate::evaluation::Evaluation;
use crate::files::system_dialog::PathFor;
use crate::node_brush_tip::NodeBrushTip;
use crate::shown_results::ColorTarget;

/// Painting on the selected node, whose strokes are edits of the graph on the shown model.
pub(super) struct Painting<'a> {
    pub(super) edits: GraphEdits<'a>,
    pub(super) evaluation: &'a Evaluation,
    pub(super) node_brush_tip: &'a mut NodeBrushTip,
}

impl Painting<'_> {
    /// Performs an action of the brush.
    pub(super) fn perform(&mut self, action: PaintAction, ui: &Ui) {
        match action {
            PaintAction::PaintSelected { value } => {
                let brush = &mut self.edits.shell.settings.brush;
                brush.value = value.unwrap_or(brush.value);
                self.brush().find_picture();
                if self.begin_painting(ui) {
                    // The added layer is painted next, so the page of the brush is opened.
                    self.edits.shell.dock.bring_up(Panel::Parameters);
                }
            }
            PaintAction::Begin => {
                self.brush().find_picture();
                self.edits.documents.begin_drag();
            }
            PaintAction::Lay(command) => self.edits.edit(command, ui),
            PaintAction::Change(command) => {
                self.brush().find_picture();
                self.edits.edit(command, ui);
                self.keep_strokes();
            }
            PaintAction::End => {
                self.edits.documents.end_drag();
                self.keep_strokes();
                self.edits.shell.settings.remember_brush_color();
                self.edits.views.flat.set = self.set_of_last_stroke().or(self.edits.views.flat.set);
            }
            PaintAction::Cancel => self.edits.documents.cancel_drag(),
            PaintAction::MarkNew => self.mark_new_decal(),
            PaintAction::Mark(strokes) => self.edits.looks.marked_strokes = strokes,
            PaintAction::CopyStrokes(strokes) => self.copy_strokes(&strokes, ui),
            PaintAction::PasteStrokes(text) => self.paste_strokes(&text, ui),
            PaintAction::Choose(brush) => self.brush().choose(*brush),
            PaintAction::TakeColor => self.edits.toggle_color_target(ColorTarget::Brush),
            PaintAction::AskForPicture => self.ask_for_brush(PathFor::BrushPicture),
            PaintAction::AskForBrush => self.ask_for_brush(PathFor::Brush),
            PaintAction::TakePicture(file) => self.brush().take_picture(&file),
            PaintAction::ChooseStencil(stencil) => self.brush().choose_stencil(*stencil),
            PaintAction::AskForStencil => self.ask_for_brush(PathFor::Stencil),
            PaintAction::TakeStencil(file) => self.brush().take_stencil(&file),
            PaintAction::TakeText(text) => self.brush().take_text(&text),
            PaintAction::ChooseFont(font) => self.brush().choose_font(font),
            PaintAction::AskForFont => self.ask_for_brush(PathFor::Font),
            PaintAction::TakeNode(result) => {
                let (gpu, document) = (self.evaluation.gpu(), &self.edits.documents.document);
                self.node_brush_tip.start(ui.ctx(), gpu, document, &result);
                self.edits
                    .shell
                    .notify("The brush gets its tip once the node is evaluated on a square.");
            }
            PaintAction::UseKept(kept) => self.brush().use_kept(*kept),
            PaintAction::Keep(name) => self.brush().keep(&name),
            PaintAction::RemoveKept(file) => {
                let removed = self.edits.documents.brushes.remove(&file);
                self.edits.shell.report(removed);
            }
            PaintAction::TakeBrush(file) => self.brush().take_kept(&file),
        }
    }

    /// Performs a command of the brush.
    pub(super) fn command(&mut self, command: BrushCommand, ui: &Ui) {
        let paints = self.paints();
        let brush = &mut self.edits.shell.settings.brush;
        match command {
            BrushCommand::Paint if paints => self.end_painting(),
            BrushCommand::Paint => {
                self.brush().find_picture();
                self.begin_painting(ui);
            }
            BrushCommand::Larger => *brush = brush.resized(true),
            BrushCommand::Smaller => *brush = brush.resized(false),
            BrushCommand::Erase if brush.action == BrushAction::Erase => brush.action = BrushAction::Paint,
            BrushCommand::Erase => brush.action = BrushAction::Erase,
        }
    }

    /// Returns whether drags on the model paint: painting is on, and the selected node has strokes.
    fn paints(&self) -> bool {
        let document = &self.edits.documents.document;
        let selected = document.selected_one();
        self.edits.looks.is_painting && selected.is_some_and(|node| painting::strokes_of(document, node).is_some())
    }

    /// Ends painting, and keeps what the model shows: the result of the painted node would be its mask alone.
    fn end_painting(&mut self) {
        let shown = self
            .edits
            .looks
            .on_model(&self.edits.documents.document, &self.edits.shell.settings);
        self.edits.looks.is_painting = false;
        if shown == ViewSubject::Outputs {
            self.edits.looks.followed = None;
        }
    }

    /// Switches the brush to painting if its action would change nothing, such as erasing on a new layer.
    fn leave_idle_action(&mut self, node: &NodeId) {
        let strokes = painting::strokes_of(&self.edits.documents.document, node);
        let brush = &mut self.edits.shell.settings.brush;
        let needs_strokes = match brush.action {
            BrushAction::Paint => false,
            BrushAction::Erase | BrushAction::Smear | BrushAction::Blur | BrushAction::Sharpen => true,
            BrushAction::Clone => brush.copy_of == CopyOf::Paint,
        };
        if needs_strokes && strokes.is_some_and(|strokes| strokes.is_empty()) {
            brush.action = BrushAction::Paint;
        }
    }

    /// Begins to paint on the selected paint node, or on a new one over the selected mask. Returns whether drags paint now.
    fn begin_painting(&mut self, ui: &Ui) -> bool {
        let document = &mut self.edits.documents.document;
        let Some(node) = document.selected_one().cloned() else {
            self.edits
                .shell
                .notify("Select the mask to paint over, or a Paint node from the library.");
            return false;
        };
        let Outcome::Added(node) = perform(document, PaintCommand::Over(node).into()) else {
            return false;
        };
        self.edits.looks.show(document, &node, None);
        if !self.edits.looks.is_compared {
            self.edits.looks.pinned_3d = None;
        }
        self.edits.looks.is_painting = true;
        self.edits.shell.dock.bring_up(Panel::Viewport);
        ui.ctx().request_repaint();
        self.leave_idle_action(&node);
        true
    }

    /// Marks the decal or the path that was just laid, so that it has handles. After any other stroke, nothing is
    /// marked.
    fn mark_new_decal(&mut self) {
        let document = &self.edits.documents.document;
        let model = self.evaluation.model.received.as_ref();
        let list = document
            .selected_one()
            .zip(model)
            .and_then(|(node, model)| painting::strokes_on(document, node, &model.linked.model.stem));
        let top = list.and_then(|list| list.strokes.last().cloned());
        let held = top.filter(|top| top.area.is_single() || top.path.is_some());
        self.edits.looks.marked_strokes = held.map(|held| held.id).into_iter().collect();
    }

    /// Texture set that the last stroke of the selected node begins on.
    fn set_of_last_stroke(&self) -> Option<SetKey> {
        let document = &self.edits.documents.document;
        let model = self.evaluation.model.received.as_ref()?;
        let list = painting::strokes_on(document, document.selected_one()?, &model.linked.model.stem)?;
        let begin = list.strokes.last()?.points.first()?;
        let atlas = &model.linked.atlas;
        let chart = atlas.triangle_chart.get(begin.site.triangle as usize)?;
        let chart = atlas.charts.get(*chart as usize)?;
        let set = model.sets.iter().find(|set| set.key.is_home_of(chart))?;
        Some(set.key)
    }

    fn ask_for_brush(&mut self, what: PathFor) {
        let document = &self.edits.documents.document;
        self.edits.views.questions.ask_for_brush(document, what);
    }

    fn keep_strokes(&mut self) {
        let kept = self.edits.documents.keep_strokes();
        self.edits.shell.report(kept);
    }

    /// Uses the rendered result of a node as the tip of the brush, if one has arrived.
    pub(super) fn take_node_tip(&mut self) {
        if let Some(made) = self.node_brush_tip.take() {
            self.brush().take_node_tip(made);
        }
    }

    /// The brush that is held.
    fn brush(&mut self) -> HeldBrush<'_> {
        HeldBrush {
            strokes: self.edits.documents.strokes(),
            brushes: &mut self.edits.documents.brushes,
            looks: self.edits.looks,
            shell: self.edits.shell,
        }
    }
}
