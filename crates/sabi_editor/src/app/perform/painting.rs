//! Performs the actions of the brush.

use std::path::Path;

use egui::Ui;
use sabi_editing::command::{Outcome, PaintCommand, perform};
use sabi_editing::painting;
use sabi_engine::live::ViewSubject;
use sabi_engine::source::Strokes;
use sabi_export::SetKey;
use sabi_graph::NodeId;
use sabi_paint::{Action as BrushAction, CopyOf, PictureName, PicturePart, PictureTip};

use crate::action::PaintAction;
use crate::app::Editor;
use crate::brush::text::{font_bytes, picture_of};
use crate::brush_shelf::{self, KeptBrush};
use crate::command::BrushCommand;
use crate::dock::Panel;
use crate::files::system_dialog::PathFor;
use crate::settings::brush::BrushChoices;
use crate::settings::stencil::StencilChoices;
use crate::settings::text_font::TextFont;
use crate::shown_results::ColorTarget;

impl Editor {
    pub(super) fn perform_painting(&mut self, action: PaintAction, ui: &Ui) {
        match action {
            PaintAction::PaintSelected { value } => {
                let brush = &mut self.shell.settings.brush;
                brush.value = value.unwrap_or(brush.value);
                self.find_brush_picture();
                if self.begin_painting(ui) {
                    // The added layer is painted next, so the page of the brush is opened.
                    self.shell.dock.bring_up(Panel::Parameters);
                }
            }
            PaintAction::Begin => {
                self.find_brush_picture();
                self.documents.begin_drag();
            }
            PaintAction::Lay(command) => self.edits().edit(command, ui),
            PaintAction::Change(command) => {
                self.find_brush_picture();
                self.edits().edit(command, ui);
                self.keep_strokes();
            }
            PaintAction::End => {
                self.documents.end_drag();
                self.keep_strokes();
                self.shell.settings.remember_brush_color();
                self.views.flat.set = self.set_of_last_stroke().or(self.views.flat.set);
            }
            PaintAction::Cancel => self.documents.cancel_drag(),
            PaintAction::MarkNew => self.mark_new_decal(),
            PaintAction::Mark(strokes) => self.looks.marked_strokes = strokes,
            PaintAction::CopyStrokes(strokes) => self.copy_strokes(&strokes, ui),
            PaintAction::PasteStrokes(text) => self.paste_strokes(&text, ui),
            PaintAction::Choose(brush) => self.choose_brush(*brush),
            PaintAction::TakeColor => self.edits().toggle_color_target(ColorTarget::Brush),
            PaintAction::AskForPicture => self.ask_for_brush(PathFor::BrushPicture),
            PaintAction::AskForBrush => self.ask_for_brush(PathFor::Brush),
            PaintAction::TakePicture(file) => self.take_brush_picture(&file),
            PaintAction::ChooseStencil(stencil) => self.choose_stencil(*stencil),
            PaintAction::AskForStencil => self.ask_for_brush(PathFor::Stencil),
            PaintAction::TakeStencil(file) => self.take_stencil(&file),
            PaintAction::TakeText(text) => self.take_text(&text),
            PaintAction::ChooseFont(font) => self.choose_font(font),
            PaintAction::AskForFont => self.ask_for_brush(PathFor::Font),
            PaintAction::TakeNode(result) => {
                let (gpu, document) = (self.evaluation.gpu(), &self.documents.document);
                self.node_brush_tip.start(ui.ctx(), gpu, document, &result);
                self.shell
                    .notify("The brush gets its tip once the node is evaluated on a square.");
            }
            PaintAction::UseKept(kept) => self.use_kept_brush(*kept),
            PaintAction::Keep(name) => {
                self.find_brush_picture();
                let strokes = self.strokes();
                let kept = self.documents.brushes.keep(&name, &self.shell.settings.brush, &strokes);
                self.shell.report(kept);
            }
            PaintAction::RemoveKept(file) => {
                let removed = self.documents.brushes.remove(&file);
                self.shell.report(removed);
            }
            PaintAction::TakeBrush(file) => {
                let strokes = self.strokes();
                let taken = self.documents.brushes.take(&file, &strokes);
                if let Some(brush) = self.shell.report(taken) {
                    self.choose_brush(brush);
                }
            }
        }
    }

    /// Uses a brush from now on; its picture is kept for other graphs.
    fn choose_brush(&mut self, brush: BrushChoices) {
        let before = &self.shell.settings.brush;
        if before.area.is_single() && !brush.area.is_single() {
            // Handles would be in the way of strokes.
            self.looks.marked_strokes.clear();
        }
        let picture = brush.picture.clone().filter(|_| before.picture != brush.picture);
        if let Some(tip) = picture {
            let kept = self.documents.brushes.keep_picture(&tip.picture, &self.strokes());
            self.shell.report(kept);
        }
        self.shell.settings.brush = brush;
    }

    /// Marks the decal or the path that was just laid, so that it has handles. After any other stroke, nothing is
    /// marked.
    fn mark_new_decal(&mut self) {
        let document = &self.documents.document;
        let model = self.evaluation.model.received.as_ref();
        let list = document
            .selected_one()
            .zip(model)
            .and_then(|(node, model)| painting::strokes_on(document, node, &model.linked.model.stem));
        let top = list.and_then(|list| list.strokes.last().cloned());
        let held = top.filter(|top| top.area.is_single() || top.path.is_some());
        self.looks.marked_strokes = held.map(|held| held.id).into_iter().collect();
    }

    /// Texture set that the last stroke of the selected node begins on.
    fn set_of_last_stroke(&self) -> Option<SetKey> {
        let document = &self.documents.document;
        let model = self.evaluation.model.received.as_ref()?;
        let list = painting::strokes_on(document, document.selected_one()?, &model.linked.model.stem)?;
        let begin = list.strokes.last()?.points.first()?;
        let atlas = &model.linked.atlas;
        let chart = atlas.triangle_chart.get(begin.site.triangle as usize)?;
        let chart = atlas.charts.get(*chart as usize)?;
        let set = model.sets.iter().find(|set| set.key.is_home_of(chart))?;
        Some(set.key)
    }

    /// Strokes of the open document.
    pub(super) fn strokes(&self) -> Strokes {
        self.documents.document.session.graph().strokes.clone()
    }

    fn ask_for_brush(&mut self, what: PathFor) {
        self.views.questions.ask_for_brush(&self.documents.document, what);
    }

    /// Uses a picture as the tip of the brush.
    fn take_brush_picture(&mut self, file: &Path) {
        let taken = self.strokes().take_picture(file);
        if let Some(picture) = self.shell.report(taken) {
            self.stamp_picture(picture);
        }
    }

    /// Uses a font for texts from now on, if it can be read.
    fn choose_font(&mut self, font: TextFont) {
        let read = font.file.as_deref().map(font_bytes).transpose();
        if self.shell.report(read).is_some() {
            self.shell.settings.text_font = font;
        }
    }

    /// Uses a text as the tip of the brush.
    fn take_text(&mut self, text: &str) {
        let drawn = picture_of(text, &self.shell.settings.text_font);
        let Some(drawn) = self.shell.report(drawn) else {
            return;
        };
        let Some(shapes) = drawn else {
            self.shell.notify("Type the text that the brush is to stamp.");
            return;
        };
        let taken = self.strokes().keep_shapes(shapes.size, &shapes.alpha);
        if let Some(picture) = self.shell.report(taken) {
            self.stamp_picture(picture);
        }
    }

    /// Uses the rendered result of a node as the tip of the brush, if one has arrived.
    pub(in crate::app) fn take_node_brush_tip(&mut self) {
        let Some(made) = self.node_brush_tip.take() else { return };
        let taken = made.and_then(|made| {
            let part = if made.is_mask {
                PicturePart::Light
            } else {
                PicturePart::Colors
            };
            let picture = self.strokes().keep_picture(made.png, "png")?;
            Ok(PictureTip { picture, part })
        });
        if let Some(tip) = self.shell.report(taken) {
            self.choose_brush(self.shell.settings.brush.with_picture(tip));
        }
    }

    /// Makes a picture of the document's strokes the tip of the brush, and keeps it for other graphs.
    fn stamp_picture(&mut self, picture: PictureName) {
        let tip = likely_tip(&self.strokes(), picture);
        self.choose_brush(self.shell.settings.brush.with_picture(tip));
    }

    /// Uses a kept brush. Settings that it does not list, such as the color of one that comes with the program, have
    /// their defaults.
    fn use_kept_brush(&mut self, kept: KeptBrush) {
        let brush = match &kept.file {
            Some(file) => self.shell.report(brush_shelf::opened(file, &self.strokes())),
            None => Some(kept.brush),
        };
        if let Some(brush) = brush {
            self.choose_brush(brush);
        }
    }

    /// Uses these settings of the stencil from now on.
    fn choose_stencil(&mut self, stencil: StencilChoices) {
        self.shell.settings.stencil = stencil;
        self.find_stencil_picture();
    }

    /// Uses a picture as the stencil, and keeps it for other graphs.
    fn take_stencil(&mut self, file: &Path) {
        let strokes = self.strokes();
        let taken = strokes.take_picture(file);
        let Some(picture) = self.shell.report(taken) else {
            return;
        };
        let kept = self.documents.brushes.keep_picture(&picture, &strokes);
        self.shell.report(kept);
        self.shell.settings.stencil = StencilChoices::with_picture(likely_tip(&strokes, picture));
    }

    /// Loads the picture of the stencil into the open document, if that does not have it yet.
    fn find_stencil_picture(&mut self) {
        let strokes = self.strokes();
        let stencil = &self.shell.settings.stencil;
        let Some(tip) = stencil.picture.clone().filter(|_| stencil.is_used) else {
            return;
        };
        if strokes.picture(&tip.picture).is_none() {
            let found = self.documents.brushes.find_picture(&tip.picture, &strokes);
            if self
                .shell
                .report(found.map_err(|_| "The picture of the stencil is gone; choose another one.".to_owned()))
                .is_none()
            {
                self.shell.settings.stencil = StencilChoices::default();
            }
        }
    }

    /// Loads the pictures of the brush and of the stencil into the open document, if that does not have them yet.
    fn find_brush_picture(&mut self) {
        self.find_stencil_picture();
        let strokes = self.strokes();
        let Some(tip) = self.shell.settings.brush.picture.clone() else {
            return;
        };
        if strokes.picture(&tip.picture).is_none() {
            let found = self.documents.brushes.find_picture(&tip.picture, &strokes);
            if self.shell.report(found).is_none() {
                self.shell.settings.brush.picture = None;
            }
        }
    }

    /// Stores the strokes, and makes the next autosave store the graph that names them.
    pub(super) fn keep_strokes(&mut self) {
        if let Err(error) = self.documents.document.session.keep_strokes() {
            self.shell.fail(error.to_string());
        }
        self.documents.autosave.invalidate();
    }

    pub(super) fn brush_command(&mut self, command: BrushCommand, ui: &Ui) {
        let paints = self.paints();
        let brush = &mut self.shell.settings.brush;
        match command {
            BrushCommand::Paint if paints => self.end_painting(),
            BrushCommand::Paint => {
                self.find_brush_picture();
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
        let document = &self.documents.document;
        let selected = document.selected_one();
        self.looks.is_painting && selected.is_some_and(|node| painting::strokes_of(document, node).is_some())
    }

    /// Ends painting, and keeps what the model shows: the result of the painted node would be its mask alone.
    fn end_painting(&mut self) {
        let shown = self.looks.on_model(&self.documents.document, &self.shell.settings);
        self.looks.is_painting = false;
        if shown == ViewSubject::Outputs {
            self.looks.followed = None;
        }
    }

    /// Switches the brush to painting if its action would change nothing, such as erasing on a new layer.
    fn leave_idle_action(&mut self, node: &NodeId) {
        let strokes = painting::strokes_of(&self.documents.document, node);
        let brush = &mut self.shell.settings.brush;
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
        let document = &mut self.documents.document;
        let Some(node) = document.selected_one().cloned() else {
            self.shell
                .notify("Select the mask to paint over, or a Paint node from the library.");
            return false;
        };
        let Outcome::Added(node) = perform(document, PaintCommand::Over(node).into()) else {
            return false;
        };
        self.looks.show(document, &node, None);
        if !self.looks.is_compared {
            self.looks.pinned_3d = None;
        }
        self.looks.is_painting = true;
        self.shell.dock.bring_up(Panel::Viewport);
        ui.ctx().request_repaint();
        self.leave_idle_action(&node);
        true
    }
}

/// Tip of a picture that was just taken, with the part of the picture that the artist most likely means.
fn likely_tip(strokes: &Strokes, picture: PictureName) -> PictureTip {
    let part = strokes.picture(&picture).map(|stamp| stamp.likely_part());
    PictureTip {
        part: part.unwrap_or_default(), // It is in memory.
        picture,
    }
}
