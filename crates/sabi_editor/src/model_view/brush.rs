//! The brush on the model: its strokes, and its outline under the pointer.

use std::sync::Arc;

use egui::{Color32, CursorIcon, Event, Key, Modifiers, PointerButton, Pos2, Rect, Response, Stroke as Line, Ui};
use glam::Vec3;
use sabi_editing::command::PaintCommand;
use sabi_engine::LiveModel;
use sabi_engine::paint::{Action as BrushAction, PaintSurface, Site, Stroke, StrokePoint, SurfaceIndex, Version};
use sabi_engine::view::Picked;
use sabi_graph::NodeId;

use super::navigation::{aspect, picked_by};
use super::{ModelView, Subject};
use crate::action::{Action, PaintAction};
use crate::evaluation::Picture;
use crate::settings::brush::BrushChoices;

/// Distance between two places of a stroke on the screen, points: the model is looked at so often, whatever the mouse reports.
const STEP: f32 = 3.0;
/// Corners of the outline.
const CORNERS: usize = 48;

/// The stroke that is drawn.
#[derive(Default)]
pub(super) struct BrushTool {
    stroke: Option<OpenStroke>,
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
    /// True if the next place begins anew, since the pointer was beside the model.
    starts: bool,
}

impl ModelView {
    /// Paints by drags with the first button. Returns whether the drag belongs to the brush.
    pub(super) fn paint_on_model(
        &mut self,
        ui: &Ui,
        response: &Response,
        rect: Rect,
        picture: &Picture,
        subject: &Subject<'_>,
        actions: &mut Vec<Action>,
    ) -> bool {
        let (is_down, modifiers) =
            ui.input(|input| (input.pointer.button_down(PointerButton::Primary), input.modifiers));
        if let Some(stroke) = &self.brush.stroke {
            let is_gone = subject.painted.is_none_or(|painted| painted.node != stroke.node);
            if is_gone || ui.input(|input| input.key_pressed(Key::Escape)) {
                self.brush.stroke = None;
                actions.push(Action::Paint(PaintAction::Cancel));
                return true;
            }
            let places = places_since(ui, is_down);
            self.add_places(places, rect, actions);
            if !is_down {
                self.brush.stroke = None;
                actions.push(Action::Paint(PaintAction::End));
            }
            return true;
        }
        let Some(painted) = subject.painted else {
            return false;
        };
        let pressed = ui.input(|input| input.pointer.button_pressed(PointerButton::Primary));
        let at = response.interact_pointer_pos().filter(|at| rect.contains(*at));
        let is_begun = pressed && response.is_pointer_button_down_on() && !modifiers.alt;
        if let Some(at) = at.filter(|_| is_begun) {
            self.brush.stroke = Some(OpenStroke {
                node: painted.node.clone(),
                before: painted.strokes.clone(),
                model: picture.model.clone(),
                brush: painted.brush.clone(),
                action: action_of(&painted.brush, modifiers),
                points: Vec::new(),
                last: at,
                starts: true,
            });
            actions.push(Action::Paint(PaintAction::Begin));
            self.add_places(vec![at], rect, actions);
            return true;
        }
        // A drag that began beside the model's view, or with Alt, is the camera's.
        false
    }

    /// Adds places of the pointer to the stroke, and lays it.
    fn add_places(&mut self, places: Vec<Pos2>, rect: Rect, actions: &mut Vec<Action>) {
        let camera = self.navigation.camera;
        let Some(stroke) = &mut self.brush.stroke else {
            return;
        };
        let known = stroke.points.len();
        for place in places {
            stroke.add(place, |model, at| picked_by(&camera, model, rect, at));
        }
        if stroke.points.len() > known {
            actions.push(Action::Paint(PaintAction::Lay(stroke.command())));
        }
    }

    /// Draws the outline of the brush on the surface under the pointer.
    pub(super) fn show_brush(&self, ui: &Ui, response: &Response, rect: Rect, subject: &Subject<'_>) {
        let (Some(painted), Some(picture)) = (subject.painted, &self.last) else {
            return;
        };
        let Some(at) = response.hover_pos().filter(|at| rect.contains(*at)) else {
            return;
        };
        let Some(picked) = picked_by(&self.navigation.camera, &picture.model, rect, at) else {
            return;
        };
        response.clone().on_hover_cursor(CursorIcon::Crosshair);
        let linked = &picture.model.linked;
        let radius = f64::from(painted.brush.size) * linked.largest_side * picture.model.placement.scale;
        let erases = action_of(&painted.brush, ui.input(|input| input.modifiers)) == BrushAction::Erase;
        let color = if erases { subject.theme.warning } else { Color32::WHITE };
        let hard = f64::from(painted.brush.hardness);
        for (share, strength) in [(1.0, 1.0), (hard, 0.45)] {
            let corners = self.outline(rect, &picked, (share * radius) as f32);
            for (width, color) in [
                (3.0, Color32::from_black_alpha(90)),
                (1.2, color.gamma_multiply(strength)),
            ] {
                for pair in corners.windows(2) {
                    ui.painter().line_segment([pair[0], pair[1]], Line::new(width, color));
                }
            }
        }
    }

    /// A circle on the tangent plane, on the screen.
    fn outline(&self, rect: Rect, picked: &Picked, radius: f32) -> Vec<Pos2> {
        let camera = &self.navigation.camera;
        let (x, y) = picked.normal.any_orthonormal_pair();
        let corner = |index: usize| -> Option<Pos2> {
            let (sine, cosine) = (index as f32 / CORNERS as f32 * std::f32::consts::TAU).sin_cos();
            let place: Vec3 = picked.position_view + radius * (cosine * x + sine * y);
            let share = camera.project(place, aspect(rect))?;
            Some(rect.min + egui::vec2(share.x * rect.width(), share.y * rect.height()))
        };
        (0..=CORNERS).filter_map(corner).collect()
    }
}

/// Places of the pointer since the last frame, from all its events.
fn places_since(ui: &Ui, is_down: bool) -> Vec<Pos2> {
    ui.input(|input| {
        let moved = input.events.iter().filter_map(|event| match event {
            Event::PointerMoved(at) => Some(*at),
            // Behind the release, moves are none of the stroke.
            _ => None,
        });
        let mut places: Vec<Pos2> = moved.collect();
        if is_down && places.is_empty() {
            places.extend(input.pointer.latest_pos());
        }
        places
    })
}

/// Ctrl has the brush take paint away, or lay it where it takes it away already.
fn action_of(brush: &BrushChoices, modifiers: Modifiers) -> BrushAction {
    if brush.erases == (modifiers.ctrl || modifiers.command) {
        BrushAction::Paint
    } else {
        BrushAction::Erase
    }
}

impl OpenStroke {
    /// Looks at the model along the way of the pointer to a place, in small steps.
    fn add(&mut self, place: Pos2, picked: impl Fn(&LiveModel, Pos2) -> Option<Picked>) {
        let way = place - self.last;
        let steps = (way.length() / STEP).floor() as usize;
        let start = self.last;
        if self.points.is_empty() {
            self.look(start, &picked);
        }
        for step in 1..=steps {
            let at = start + way * (step as f32 * STEP / way.length());
            self.look(at, &picked);
            self.last = at;
        }
    }

    fn look(&mut self, at: Pos2, picked: impl Fn(&LiveModel, Pos2) -> Option<Picked>) {
        let linked = self.model.linked.clone();
        let mesh = &linked.model.mesh;
        let index = linked.paint_index.get_or_init(|| SurfaceIndex::new(mesh));
        let surface = PaintSurface::new(mesh, index);
        let point = picked(&self.model, at).and_then(|picked| {
            let site = Site {
                triangle: picked.triangle,
                position: picked.position.as_dvec3(),
            };
            surface.point(site, 1.0, self.starts)
        });
        self.starts = point.is_none();
        self.points.extend(point);
    }

    /// The command that lays the stroke so far.
    fn command(&self) -> PaintCommand {
        let linked = &self.model.linked;
        let stroke = Stroke {
            id: Version::EMPTY,
            name: String::new(),
            brush: self.brush.brush(linked.largest_side),
            action: self.action,
            is_hidden: false,
            points: self.points.clone(),
        };
        PaintCommand::Stroke {
            node: self.node.clone(),
            model: linked.model.stem.clone(),
            before: self.before.clone(),
            stroke: Arc::new(stroke),
        }
    }
}
