//! The brush: strokes that are drawn on the model, in the viewport or in the 2D view.

mod decal;
mod handles;
mod mover;
mod open_stroke;
mod path;
mod path_tool;
mod shown_path;
mod shown_pixel;
mod stencil;
mod subject;
pub(crate) mod text;
mod under;

use std::sync::Arc;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Response, TouchPhase, Ui};
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Action as BrushAction, Eye, StrokePoint};
use sabi_surface::patch::Site;

use crate::action::{Action, PaintAction};
use crate::pen::{PenPlace, PenState};
use crate::settings::brush::BrushChoices;
pub(crate) use handles::Handles;
use handles::HeldDecal;
use mover::HeldStrokes;
pub(crate) use mover::Mover;
use open_stroke::OpenStroke;
use path::HeldKnot;
use path_tool::PathToExtend;
pub(crate) use shown_path::ShownPath;
pub(crate) use shown_pixel::shown_pixel;
use stencil::HeldStencil;
pub(crate) use stencil::{PlacedStencil, ShownStencil};
pub(crate) use subject::PaintSubject;
use under::point_at;

/// Factor of the size of the brush, and change of its hardness, for one point of a drag.
const SIZE_OF_DRAG: f32 = 1.008;
const HARDNESS_OF_DRAG: f32 = 0.004;

/// Subject of a drag of the brush.
enum BrushDrag {
    Stroke(Box<OpenStroke>),
    Decal(HeldDecal),
    Knot(Box<HeldKnot>),
    Strokes(Box<HeldStrokes>),
    Stencil(Box<HeldStencil>),
}

/// The brush in a view: draws strokes, and moves decals, knots, marked strokes and the stencil.
#[derive(Default)]
pub(crate) struct BrushTool {
    held: Option<BrushDrag>,
    /// End of the last stroke, from which Shift draws a straight line, with the name of its model.
    last: Option<(String, StrokePoint)>,
    /// Place that the next stroke copies from, with the name of its model.
    source: Option<(String, StrokePoint)>,
    /// Force of a finger on the screen, or of a pen that is reported as a finger; `None` for a mouse.
    force: Option<f32>,
    /// Pen at the last place of the pointer; `None` for a mouse.
    pen: Option<PenState>,
    /// Place where a drag began that changes the size.
    resized_at: Option<Pos2>,
    /// Path that clicks add knots to.
    extended: PathToExtend,
    /// Time and place of the last press, for double clicks.
    pressed: Option<(f64, Pos2)>,
}

/// View that the brush paints in.
pub(crate) trait PaintView {
    /// Surface point under a place of the screen.
    fn site(&self, model: &LiveModel, at: Pos2) -> Option<Site>;

    /// Place on the screen of a surface point; `None` if the point is hidden.
    fn place(&self, model: &LiveModel, site: Site) -> Option<Pos2>;

    /// Returns whether a straight line on the screen between two near places follows the surface: not over a seam of
    /// the texture.
    fn joins(&self, _: &LiveModel, _: [Site; 2]) -> bool {
        true
    }

    /// Eye that looks at the model; `None` in a view of its texture.
    fn eye(&self, model: &LiveModel) -> Option<Eye>;

    /// Rectangle of the view on the screen that a stencil is placed over; `None` for a view of the texture.
    fn stencil_view(&self) -> Option<Rect>;

    /// Rows of the map from places of a model to places of a stencil ([`Stencil::picture_from_model`]); `None` in a view of its texture.
    fn stencil_map(&self, model: &LiveModel, stencil: &ShownStencil) -> Option<[[f64; 4]; 3]>;
}

impl BrushDrag {
    /// The paint node that is changed; `None` while the stencil is moved.
    fn node(&self) -> Option<&NodeId> {
        match self {
            BrushDrag::Stroke(stroke) => Some(&stroke.node),
            BrushDrag::Decal(decal) => Some(&decal.node),
            BrushDrag::Knot(knot) => Some(&knot.node),
            BrushDrag::Strokes(strokes) => Some(&strokes.node),
            BrushDrag::Stencil(_) => None,
        }
    }
}

impl BrushTool {
    /// Place that the next stroke on a model copies from.
    pub(crate) fn source_on(&self, model: &LiveModel) -> Option<StrokePoint> {
        on_model(&self.source, model)
    }

    /// The brush with the size that it has under a place of the screen.
    pub(crate) fn brush_at(brush: &BrushChoices, model: &LiveModel, canvas: &impl PaintView, at: Pos2) -> BrushChoices {
        match point_at(model, canvas, at, 1.0, true) {
            Some(point) => decal::sized(brush, model, canvas, &point),
            None => brush.clone(),
        }
    }

    /// Returns true if the marked strokes have handles: not while a path is drawn.
    pub(crate) fn moves_marked(&self) -> bool {
        self.extended == PathToExtend::None
    }

    /// Place where the outline of the brush stays while a drag changes its size.
    pub(crate) fn resized_at(&self) -> Option<Pos2> {
        self.resized_at
    }

    /// Place of the brush on the screen while a stroke is drawn. The pointer pulls the brush by a string, so it may be
    /// behind the pointer.
    pub(crate) fn pulled(&self) -> Option<Pos2> {
        match &self.held {
            Some(BrushDrag::Stroke(stroke)) => Some(stroke.brush_place()),
            Some(BrushDrag::Decal(_) | BrushDrag::Knot(_) | BrushDrag::Strokes(_) | BrushDrag::Stencil(_)) | None => {
                None
            }
        }
    }

    /// Paints by drags with the first button. Returns whether the drag belongs to the brush.
    pub(crate) fn paint(
        &mut self,
        ui: &Ui,
        response: &Response,
        painted: Option<&PaintSubject>,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        actions: &mut Vec<Action>,
    ) -> bool {
        let places = self.places_since(ui, painted.map_or(&[], |painted| &painted.pen));
        if let Some(held) = &self.held {
            let is_gone = painted.is_none_or(|painted| held.node().is_some_and(|node| painted.node != *node));
            self.go_on(ui, is_gone, &places, canvas, actions);
            return true;
        }
        let Some(painted) = painted else {
            self.resized_at = None;
            self.extended = PathToExtend::None;
            return false;
        };
        self.follow_marked(ui, painted);
        if self.resize(ui, response, &painted.brush, actions) {
            return true;
        }
        let (is_pressed, modifiers) = ui.input(|input| {
            let is_pressed = input.pointer.button_pressed(PointerButton::Primary);
            (is_pressed, input.modifiers)
        });
        // A quick click is over in the frame that it began in.
        let is_here = response.is_pointer_button_down_on() || response.clicked();
        let is_begun = is_pressed && is_here && !modifiers.alt;
        let Some(at) = response.interact_pointer_pos().filter(|_| is_begun) else {
            // A drag that began elsewhere, or with Alt, is the view's.
            return false;
        };
        let stencil = painted.stencil.as_ref().zip(canvas.stencil_view());
        if let Some(held) = stencil.and_then(|(stencil, view)| HeldStencil::at(stencil, view, at)) {
            self.held = Some(BrushDrag::Stencil(Box::new(held)));
            return true;
        }
        if let Some(decal) = HeldDecal::at(painted, model, canvas, at) {
            actions.push(Action::Paint(PaintAction::Begin));
            self.held = Some(BrushDrag::Decal(decal));
            self.end_if_lifted(ui, actions);
            return true;
        }
        if let Some(strokes) = HeldStrokes::at(painted, model, canvas, at).filter(|_| self.moves_marked()) {
            actions.push(Action::Paint(PaintAction::Begin));
            self.held = Some(BrushDrag::Strokes(Box::new(strokes)));
            self.end_if_lifted(ui, actions);
            return true;
        }
        let pen = self.pen.unwrap_or(self.touch());
        let is_second = self.is_second_press(ui, at);
        if self.press_path(ui, painted, model, canvas, at, pen, is_second, actions) {
            return true;
        }
        self.begin_stroke(painted, model, canvas, at, pen, modifiers, actions);
        self.end_if_lifted(ui, actions);
        true
    }

    /// Begins a stroke at a place of the screen, or takes it as the place to copy from.
    fn begin_stroke(
        &mut self,
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        pen: PenState,
        modifiers: Modifiers,
        actions: &mut Vec<Action>,
    ) {
        let brush = &painted.brush;
        if !pen.is_eraser && self.takes_source(brush, model, modifiers) {
            self.take_source(brush, model, canvas, at, has_ctrl(modifiers), actions);
            return;
        }
        let action = if pen.is_eraser {
            BrushAction::Erase
        } else {
            action_of(brush, modifiers)
        };
        let mut stroke = OpenStroke::new(painted, model, action, at, pen);
        stroke.source = self.source_on(model).filter(|_| action == BrushAction::Clone);
        stroke.eye = canvas.eye(model);
        stroke.stencil = painted.stencil_before(model, canvas);
        if modifiers.shift && !stroke.area().is_single() {
            stroke.begin_at(on_model(&self.last, model), canvas);
        }
        actions.push(Action::Paint(PaintAction::Begin));
        actions.extend(stroke.add(&[(at, pen)], canvas));
        self.held = Some(BrushDrag::Stroke(Box::new(stroke)));
    }

    /// Returns true if a press takes the place to copy from, instead of a stroke.
    fn takes_source(&self, brush: &BrushChoices, model: &LiveModel, modifiers: Modifiers) -> bool {
        let lacks_source = brush.needs_source() && self.source_on(model).is_none();
        brush.action == BrushAction::Clone && (has_ctrl(modifiers) || lacks_source)
    }

    /// Takes the place under the pointer as the one that strokes copy from, or says that one is needed.
    fn take_source(
        &mut self,
        brush: &BrushChoices,
        model: &LiveModel,
        canvas: &impl PaintView,
        at: Pos2,
        is_meant: bool,
        actions: &mut Vec<Action>,
    ) {
        if is_meant {
            let source = point_at(model, canvas, at, 1.0, true);
            self.source = source.map(|source| (model.linked.model.stem.clone(), source));
        }
        if brush.needs_source() && self.source_on(model).is_none() {
            actions.push(Action::Notice(
                "Click with Ctrl where to copy from, then paint where to copy to.".to_owned(),
            ));
        }
    }

    /// Handles drags with Ctrl and the second button: horizontal ones change the size of the brush, vertical ones its
    /// hardness. Returns whether there is such a drag.
    fn resize(&mut self, ui: &Ui, response: &Response, brush: &BrushChoices, actions: &mut Vec<Action>) -> bool {
        let is_held = response.dragged_by(PointerButton::Secondary) && ui.input(|input| input.modifiers.command);
        let goes_on = self.resized_at.is_some() && ui.input(|input| input.pointer.secondary_down());
        if !is_held && !goes_on {
            self.resized_at = None;
            return false;
        }
        self.resized_at = self.resized_at.or(response.interact_pointer_pos());
        let moved = ui.input(|input| input.pointer.delta());
        let changed = BrushChoices {
            size: brush.size * SIZE_OF_DRAG.powf(moved.x),
            points: brush.points * SIZE_OF_DRAG.powf(moved.x),
            hardness: brush.hardness - HARDNESS_OF_DRAG * moved.y,
            ..brush.clone()
        };
        actions.push(Action::Paint(PaintAction::Choose(Box::new(changed.sanitized()))));
        true
    }

    /// State of a finger on the screen. A mouse has full pressure.
    fn touch(&self) -> PenState {
        PenState {
            pressure: self.force.unwrap_or(PenState::MOUSE.pressure),
            ..PenState::MOUSE
        }
    }

    /// Places of the pointer since the last frame, from all its events, each with its pen. `given` are the places that
    /// a pen reported.
    fn places_since(&mut self, ui: &Ui, given: &[PenPlace]) -> Vec<(Pos2, PenState)> {
        let mut places = Vec::new();
        let mut given = given.iter().peekable();
        ui.input(|input| {
            for event in &input.events {
                match event {
                    Event::Touch {
                        phase: TouchPhase::End | TouchPhase::Cancel,
                        ..
                    } => self.force = None,
                    Event::Touch { force: Some(force), .. } => self.force = Some(force.clamp(0.0, 1.0)),
                    Event::PointerMoved(at) => {
                        self.pen = given.next_if(|place| place.at == *at).map(|place| place.state);
                        places.push((*at, self.pen.unwrap_or(self.touch())));
                    }
                    Event::PointerGone => self.pen = None,
                    _ => {}
                }
            }
        });
        places
    }

    /// Continues the drag at new places of the pointer.
    fn go_on(
        &mut self,
        ui: &Ui,
        is_gone: bool,
        places: &[(Pos2, PenState)],
        canvas: &impl PaintView,
        actions: &mut Vec<Action>,
    ) {
        if let Some(BrushDrag::Stencil(held)) = &self.held {
            actions.extend(places.last().map(|(at, _)| held.drag(*at)));
            if is_gone || !ui.input(|input| input.pointer.button_down(PointerButton::Primary)) {
                self.held = None;
            }
            return;
        }
        if is_gone || ui.input(|input| input.key_pressed(Key::Escape)) {
            self.held = None;
            actions.push(Action::Paint(PaintAction::Cancel));
            return;
        }
        match &mut self.held {
            Some(BrushDrag::Stroke(stroke)) => actions.extend(stroke.add(places, canvas)),
            Some(BrushDrag::Decal(decal)) => {
                let last = places.last().and_then(|(at, _)| decal.drag(*at, canvas));
                actions.extend(last);
            }
            Some(BrushDrag::Strokes(strokes)) => {
                let last = places.last().and_then(|(at, _)| strokes.drag(*at, canvas));
                actions.extend(last);
            }
            Some(BrushDrag::Knot(knot)) => {
                let last = places.last().and_then(|(at, _)| knot.drag(*at, canvas));
                actions.extend(last);
            }
            Some(BrushDrag::Stencil(_)) | None => {}
        }
        self.end_if_lifted(ui, actions);
    }

    /// Ends the stroke once the button is up.
    fn end_if_lifted(&mut self, ui: &Ui, actions: &mut Vec<Action>) {
        if !ui.input(|input| input.pointer.button_down(PointerButton::Primary)) {
            actions.push(Action::Paint(PaintAction::End));
            match self.held.take() {
                Some(BrushDrag::Stroke(stroke)) => {
                    self.last = stroke.last_point();
                    actions.push(Action::Paint(PaintAction::MarkNew));
                }
                Some(BrushDrag::Knot(knot)) if knot.is_new => {
                    self.extended = PathToExtend::New;
                    actions.push(Action::Paint(PaintAction::MarkNew));
                }
                Some(BrushDrag::Decal(_) | BrushDrag::Knot(_) | BrushDrag::Strokes(_) | BrushDrag::Stencil(_))
                | None => {}
            }
        }
    }
}

/// The stored place, if it is on this model.
fn on_model(kept: &Option<(String, StrokePoint)>, model: &LiveModel) -> Option<StrokePoint> {
    let own = kept.as_ref().filter(|(name, _)| *name == model.linked.model.stem);
    own.map(|(_, point)| *point)
}

/// Ctrl, or the key for it on other systems, is held.
fn has_ctrl(modifiers: Modifiers) -> bool {
    modifiers.ctrl || modifiers.command
}

/// Action of the brush: with Ctrl it erases, or paints if it is an eraser.
pub(crate) fn action_of(brush: &BrushChoices, modifiers: Modifiers) -> BrushAction {
    match brush.action {
        action if !has_ctrl(modifiers) => action,
        BrushAction::Erase => BrushAction::Paint,
        BrushAction::Paint | BrushAction::Smear | BrushAction::Blur | BrushAction::Sharpen | BrushAction::Clone => {
            BrushAction::Erase
        }
    }
}
