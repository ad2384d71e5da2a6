//! The brush: strokes that are drawn on the model, in the viewport or in the 2D view.

mod subject;

use std::sync::Arc;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Response, TouchPhase, Ui};
use sabi_editing::command::PaintCommand;
use sabi_engine::LiveModel;
use sabi_engine::paint::{Action as BrushAction, PaintSurface, Site, Stroke, StrokePoint, SurfaceIndex};
use sabi_graph::NodeId;

use crate::action::{Action, PaintAction};
use crate::settings::brush::BrushChoices;
pub(crate) use subject::PaintSubject;

/// Distance between two places of a stroke on the screen, points: the model is looked at so often, whatever the mouse reports.
const STEP: f32 = 3.0;

/// The stroke that is drawn in a view.
#[derive(Default)]
pub(crate) struct BrushTool {
    stroke: Option<OpenStroke>,
    /// End of the last stroke, from which Shift draws a straight line.
    last: Option<StrokePoint>,
    /// Force of the pen or finger that touches the screen; none for a mouse.
    force: Option<f32>,
}

/// A view that is painted in.
pub(crate) trait Canvas {
    /// The place of a model under a place of the screen.
    fn site(&self, model: &LiveModel, at: Pos2) -> Option<Site>;

    /// The place of the screen that shows a place of the model; none if it is not seen.
    fn place(&self, model: &LiveModel, site: Site) -> Option<Pos2>;
}

/// A stroke from its first touch on.
struct OpenStroke {
    node: NodeId,
    /// Versions of the node's strokes before it.
    before: String,
    model: Arc<LiveModel>,
    brush: BrushChoices,
    action: BrushAction,
    points: Vec<StrokePoint>,
    /// Place of the pointer that was looked at last.
    last: Pos2,
    /// Pressure there.
    pressure: f32,
    /// True if the next place begins anew, since the pointer was beside the model.
    starts: bool,
}

impl BrushTool {
    /// Paints by drags with the first button. Returns whether the drag belongs to the brush.
    pub(crate) fn paint(
        &mut self,
        ui: &Ui,
        response: &Response,
        (painted, model): (Option<&PaintSubject>, &Arc<LiveModel>),
        canvas: &impl Canvas,
        actions: &mut Vec<Action>,
    ) -> bool {
        let places = self.places_since(ui);
        if let Some(stroke) = &self.stroke {
            let is_gone = painted.is_none_or(|painted| painted.node != stroke.node);
            self.go_on(ui, is_gone, &places, canvas, actions);
            return true;
        }
        let Some(painted) = painted else {
            return false;
        };
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
        let mut stroke = OpenStroke {
            node: painted.node.clone(),
            before: painted.strokes.clone(),
            model: model.clone(),
            brush: painted.brush.clone(),
            action: action_of(&painted.brush, modifiers),
            points: Vec::new(),
            last: at,
            pressure: self.force.unwrap_or(1.0), // A mouse presses with all its force.
            starts: true,
        };
        if modifiers.shift {
            stroke.begin_at(self.last, canvas);
        }
        actions.push(Action::Paint(PaintAction::Begin));
        actions.extend(stroke.add(&[(at, stroke.pressure)], canvas));
        self.stroke = Some(stroke);
        self.end_if_lifted(ui, actions);
        true
    }

    /// Places of the pointer since the last frame, from all its events, each with its pressure.
    fn places_since(&mut self, ui: &Ui) -> Vec<(Pos2, f32)> {
        let mut places = Vec::new();
        ui.input(|input| {
            for event in &input.events {
                match event {
                    Event::Touch {
                        phase: TouchPhase::End | TouchPhase::Cancel,
                        ..
                    } => self.force = None,
                    Event::Touch { force: Some(force), .. } => self.force = Some(force.clamp(0.0, 1.0)),
                    Event::PointerMoved(at) => places.push((*at, self.force.unwrap_or(1.0))), // As a mouse does.
                    _ => {}
                }
            }
        });
        places
    }

    /// Follows the pointer.
    fn go_on(
        &mut self,
        ui: &Ui,
        is_gone: bool,
        places: &[(Pos2, f32)],
        canvas: &impl Canvas,
        actions: &mut Vec<Action>,
    ) {
        if is_gone || ui.input(|input| input.key_pressed(Key::Escape)) {
            self.stroke = None;
            actions.push(Action::Paint(PaintAction::Cancel));
            return;
        }
        if let Some(stroke) = &mut self.stroke {
            actions.extend(stroke.add(places, canvas));
        }
        self.end_if_lifted(ui, actions);
    }

    /// Ends the stroke once the button is up.
    fn end_if_lifted(&mut self, ui: &Ui, actions: &mut Vec<Action>) {
        if !ui.input(|input| input.pointer.button_down(PointerButton::Primary)) {
            let ended = self.stroke.take();
            self.last = ended.and_then(|stroke| stroke.points.last().copied());
            actions.push(Action::Paint(PaintAction::End));
        }
    }
}

/// Ctrl has the brush take paint away, or lay it where it takes it away already.
pub(crate) fn action_of(brush: &BrushChoices, modifiers: Modifiers) -> BrushAction {
    if brush.erases == (modifiers.ctrl || modifiers.command) {
        BrushAction::Paint
    } else {
        BrushAction::Erase
    }
}

impl OpenStroke {
    /// Has the stroke begin at a place of the model, if that is seen: it goes straight on the screen from there.
    fn begin_at(&mut self, from: Option<StrokePoint>, canvas: &impl Canvas) {
        let Some((from, place)) = from.and_then(|from| Some((from, canvas.place(&self.model, from.site)?))) else {
            return;
        };
        self.last = place;
        self.points = vec![StrokePoint { starts: true, ..from }];
        self.starts = false;
    }

    /// Adds places of the pointer; returns the action that lays the stroke if it became longer.
    fn add(&mut self, places: &[(Pos2, f32)], canvas: &impl Canvas) -> Option<Action> {
        let known = self.points.len();
        for (place, pressure) in places {
            let way = *place - self.last;
            let steps = (way.length() / STEP).floor() as usize;
            let (start, first) = (self.last, self.pressure);
            if self.points.is_empty() {
                self.look(start, canvas);
            }
            for step in 1..=steps {
                let share = step as f32 * STEP / way.length();
                self.pressure = first + share * (pressure - first);
                self.last = start + way * share;
                self.look(self.last, canvas);
            }
        }
        (self.points.len() > known).then(|| Action::Paint(PaintAction::Lay(self.command())))
    }

    /// Looks at the model under a place of the screen.
    fn look(&mut self, at: Pos2, canvas: &impl Canvas) {
        let linked = self.model.linked.clone();
        let mesh = &linked.model.mesh;
        let index = linked.paint_index.get_or_init(|| SurfaceIndex::new(mesh));
        let surface = PaintSurface::new(mesh, index);
        let site = canvas.site(&self.model, at);
        let point = site.and_then(|site| surface.point(site, self.pressure, self.starts));
        self.starts = point.is_none();
        self.points.extend(point);
    }

    /// The command that lays the stroke so far.
    fn command(&self) -> PaintCommand {
        let linked = &self.model.linked;
        let stroke = Stroke {
            action: self.action,
            area: self.brush.area,
            ..Stroke::new(self.brush.brush(linked.largest_side), self.points.clone())
        };
        PaintCommand::Stroke {
            node: self.node.clone(),
            model: linked.model.stem.clone(),
            before: self.before.clone(),
            stroke: Arc::new(stroke),
        }
    }
}
