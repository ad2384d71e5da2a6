//! Presses of the brush that draw paths: knot by knot, or along the edges of the model.

use std::sync::Arc;

use egui::{Key, Modifiers, Pos2, Ui};
use sabi_editing::command::PaintCommand;
use sabi_engine::live::LiveModel;
use sabi_paint::{Action as BrushAction, Area, Path, Step, Stroke, Version};

use super::decal::sized;
use super::path::{HeldKnot, Press, PressKind, press};
use super::under::{on_surface, point_at};
use super::{BrushDrag, BrushTool, PaintSubject, PaintView, action_of, has_ctrl};
use crate::action::{Action, PaintAction};
use crate::pen::PenState;
use crate::settings::brush::Hand;

/// Time in seconds and distance in points between the two presses of a double click, at most.
const DOUBLE_CLICK: f64 = 0.35;
const DOUBLE_CLICK_REACH: f32 = 6.0;
/// Distance from the pointer within which edges are followed, as a share of the model's largest side.
const EDGE_REACH: f64 = 0.04;

/// Path that clicks add knots to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum PathToExtend {
    /// No path: a click begins a new one.
    #[default]
    None,
    /// The one that was just begun and is marked in the next frame.
    New,
    Path(Version),
}

impl BrushTool {
    /// Keeps adding knots to the marked path until another one is marked, or until Enter or Escape ends it.
    pub(super) fn follow_marked(&mut self, ui: &Ui, painted: &PaintSubject) {
        let marked = painted.path.as_ref().map(|path| path.id);
        let is_ended = ui.input(|input| input.key_pressed(Key::Enter) || input.key_pressed(Key::Escape));
        self.extended = match (self.extended, marked) {
            (PathToExtend::New, Some(id)) if !is_ended => PathToExtend::Path(id),
            (PathToExtend::Path(known), Some(id)) if known == id && !is_ended => PathToExtend::Path(id),
            _ => PathToExtend::None,
        };
    }

    /// Returns true for the second press of a double click.
    pub(super) fn is_second_press(&mut self, ui: &Ui, at: Pos2) -> bool {
        let now = ui.input(|input| input.time);
        let before = self.pressed.replace((now, at));
        before.is_some_and(|(time, place)| now - time < DOUBLE_CLICK && place.distance(at) < DOUBLE_CLICK_REACH)
    }

    /// Performs a press on the marked path, or begins a new path. Returns whether the press has an effect.
    pub(super) fn press_path(
        &mut self,
        ui: &Ui,
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        pen: PenState,
        is_second: bool,
        actions: &mut Vec<Action>,
    ) -> bool {
        let modifiers = ui.input(|input| input.modifiers);
        let hand = painted.brush.used_hand();
        if hand != Hand::Free && self.takes_source(&painted.brush, model, modifiers) {
            self.take_source(&painted.brush, model, canvas, at, has_ctrl(modifiers), actions);
            return true;
        }
        let extends = matches!(self.extended, PathToExtend::Path(_));
        let kind = PressKind {
            modifiers,
            is_second,
            extends,
            splits: hand == Hand::Path,
        };
        let held = match press(painted, model, canvas, at, kind) {
            Some(Press::Hold(held)) => Some(held),
            Some(Press::Changed(action)) => {
                self.extended = PathToExtend::None;
                let [begin, end] = [PaintAction::Begin, PaintAction::End].map(Action::Paint);
                actions.extend([begin, action, end]);
                return true;
            }
            Some(Press::End) => {
                self.extended = PathToExtend::None;
                return true;
            }
            None if hand == Hand::Path && extends => HeldKnot::extended(painted, model, canvas, at, pen),
            None if hand == Hand::Path => {
                let stroke = self.template(painted, model, canvas, at, modifiers);
                HeldKnot::begun(painted, model, canvas, at, pen, stroke)
            }
            None => return self.lay_along_edges(painted, model, canvas, at, modifiers, actions),
        };
        let Some(held) = held else { return hand == Hand::Path };
        actions.push(Action::Paint(PaintAction::Begin));
        actions.extend(held.drag(at, canvas));
        self.held = Some(BrushDrag::Knot(Box::new(held)));
        self.end_if_lifted(ui, actions);
        true
    }

    /// Lays a path along the edges under the pointer, if the brush follows edges. Returns whether it does.
    fn lay_along_edges(
        &mut self,
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        modifiers: Modifiers,
        actions: &mut Vec<Action>,
    ) -> bool {
        let Some(kind) = painted.brush.used_hand().edges() else {
            return false;
        };
        let reach = EDGE_REACH * model.linked.largest_side;
        let path = canvas
            .site(model, at)
            .and_then(|site| on_surface(model, |surface| Path::along_edges(surface, kind, site.position, reach)));
        let Some(path) = path else {
            let none = "There is no such edge near the pointer: bends of more than 30°, seams of the texture or borders between materials.";
            actions.push(Action::Notice(none.to_owned()));
            return true;
        };
        let (points, form) = path.places();
        let stroke = Stroke {
            path: Some(form),
            points,
            eye: canvas.eye(model),
            ..self.template(painted, model, canvas, at, modifiers)
        };
        let command = PaintCommand::Steps {
            node: painted.node.clone(),
            model: model.linked.model.stem.clone(),
            before: painted.strokes.clone(),
            title: "Path".to_owned(),
            steps: vec![Step::Add(Arc::new(stroke))],
        };
        let laid = [
            PaintAction::Begin,
            PaintAction::Lay(command),
            PaintAction::End,
            PaintAction::MarkNew,
        ];
        actions.extend(laid.map(Action::Paint));
        true
    }

    /// A stroke of the brush, in the size that it has under the pointer, without places.
    fn template(
        &self,
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        modifiers: Modifiers,
    ) -> Stroke {
        let under = point_at(model, canvas, at, 1.0, true);
        let brush = &match under {
            Some(point) => sized(&painted.brush, model, canvas, &point),
            None => painted.brush.clone(),
        };
        let action = action_of(brush, modifiers);
        Stroke {
            area: if action.adjusts() { Area::Way } else { brush.area },
            source: self.source_on(model).filter(|_| action == BrushAction::Clone),
            copy_of: brush.copy_of_stroke(action),
            action,
            stencil: painted.stencil_before(model, canvas),
            ..Stroke::new(brush.brush(model.linked.largest_side), Vec::new())
        }
    }
}
