//! Handles that move and turn the marked strokes on the surface.

use std::sync::Arc;

use egui::{Color32, Painter, Pos2, Vec2, vec2};
use glam::DVec3;
use sabi_editing::command::PaintCommand;
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Brush, Step, Stroke, StrokePoint, carried};

use super::decal::wrapped;
use super::under::{on_surface, point_at};
use super::{PaintSubject, PaintView};
use crate::action::{Action, PaintAction};

/// Distance from the middle of a handle within which it is taken, points.
const NEAR: f32 = 10.0;
/// Vectors from the place at which the strokes are held to their two handles, in points: the first handle moves the
/// strokes, the second one turns them.
const MOVE: Vec2 = vec2(0.0, -34.0);
const TURN: Vec2 = vec2(40.0, -34.0);
/// Distance between that place and the visible surface there from which on the place is hidden, as a share of the
/// model's largest side.
const HIDDEN: f64 = 0.01;

/// Handles of the marked strokes on the screen.
pub(crate) struct Mover {
    /// Place by which the strokes are held: the point of them that is nearest to their middle.
    held: StrokePoint,
    /// Place of `held` on the screen.
    middle: Pos2,
}

/// Handle that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Handle {
    Move,
    Turn,
}

/// Strokes that are moved or turned.
pub(super) struct HeldStrokes {
    pub(super) node: NodeId,
    /// Versions of the node's strokes before the drag.
    before: String,
    model: Arc<LiveModel>,
    strokes: Vec<Arc<Stroke>>,
    mover: Mover,
    handle: Handle,
    pressed: Pos2,
}

impl Mover {
    /// The handles of some strokes; `None` where the view does not show them. A single decal has its own.
    pub(crate) fn of(model: &LiveModel, canvas: &impl PaintView, strokes: &[Arc<Stroke>]) -> Option<Mover> {
        if let [only] = strokes
            && only.area.is_single()
        {
            return None;
        }
        let points = || strokes.iter().flat_map(|stroke| &stroke.points);
        let count = points().count().max(1) as f64;
        let middle = points().map(|point| point.site.position).sum::<DVec3>() / count;
        let distance = |point: &&StrokePoint| point.site.position.distance(middle);
        let held = points().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let place = canvas.place(model, held.site)?;
        let seen = canvas.site(model, place)?;
        let is_seen = seen.position.distance(held.site.position) <= HIDDEN * model.linked.largest_side;
        is_seen.then_some(Mover {
            held: *held,
            middle: place,
        })
    }

    fn handle_at(&self, at: Pos2) -> Option<Handle> {
        let handles = [(Handle::Move, MOVE), (Handle::Turn, TURN)];
        let near = handles
            .into_iter()
            .find(|(_, way)| (self.middle + *way).distance(at) <= NEAR);
        near.map(|(handle, _)| handle)
    }

    /// Returns true if a handle is under a place of the screen.
    pub(crate) fn is_at(&self, at: Pos2) -> bool {
        self.handle_at(at).is_some()
    }

    /// Draws the handles.
    pub(crate) fn show(&self, painter: &Painter, accent: Color32) {
        let ring = egui::Stroke::new(1.5, Color32::WHITE);
        let line = egui::Stroke::new(1.0, Color32::from_white_alpha(160));
        painter.line_segment([self.middle, self.middle + MOVE], line);
        painter.line_segment([self.middle + MOVE, self.middle + TURN], line);
        painter.circle(self.middle + MOVE, 6.0, accent, ring);
        for way in [vec2(9.0, 0.0), vec2(0.0, 9.0)] {
            let middle = self.middle + MOVE;
            painter.line_segment([middle - way, middle + way], ring);
        }
        painter.circle(
            self.middle + TURN,
            5.0,
            Color32::TRANSPARENT,
            egui::Stroke::new(3.5, Color32::WHITE),
        );
        painter.circle(
            self.middle + TURN,
            5.0,
            Color32::TRANSPARENT,
            egui::Stroke::new(2.0, accent),
        );
    }
}

impl HeldStrokes {
    /// The marked strokes, if one of their handles is under the pointer.
    pub(super) fn at(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
    ) -> Option<HeldStrokes> {
        let mover = Mover::of(model, canvas, &painted.marked)?;
        Some(HeldStrokes {
            node: painted.node.clone(),
            before: painted.strokes.clone(),
            model: model.clone(),
            strokes: painted.marked.clone(),
            handle: mover.handle_at(at)?,
            mover,
            pressed: at,
        })
    }

    /// Follows the pointer; returns the action that moves or turns the strokes.
    pub(super) fn drag(&self, pointer: Pos2, canvas: &impl PaintView) -> Option<Action> {
        let Mover { held, middle } = &self.mover;
        let (to, turn_degrees) = match self.handle {
            Handle::Move => {
                let to = point_at(&self.model, canvas, *middle + (pointer - self.pressed), 1.0, false)?;
                (to, 0.0)
            }
            Handle::Turn => {
                let angle = |at: Pos2| (at - *middle).angle();
                // Angles on the screen go clockwise.
                (*held, (angle(self.pressed) - angle(pointer)).to_degrees())
            }
        };
        let steps: Vec<Step> = self
            .strokes
            .iter()
            .flat_map(|stroke| self.laid(stroke, &to, turn_degrees))
            .collect();
        let title = match self.handle {
            Handle::Move => "Move strokes",
            Handle::Turn => "Turn strokes",
        };
        Some(Action::Paint(PaintAction::Lay(PaintCommand::Steps {
            node: self.node.clone(),
            model: self.model.linked.model.stem.clone(),
            before: self.before.clone(),
            title: title.to_owned(),
            steps,
        })))
    }

    /// Steps that move a stroke; none if the stroke would leave the surface.
    fn laid(&self, stroke: &Stroke, to: &StrokePoint, turn_degrees: f32) -> Vec<Step> {
        let turn = f64::from(turn_degrees);
        let (laid, _) = on_surface(&self.model, |surface| {
            carried(surface, stroke, [&self.mover.held, to], turn)
        });
        if laid.points.is_empty() {
            return Vec::new();
        }
        let mut steps = vec![Step::Place {
            stroke: stroke.id,
            points: laid.points,
            path: laid.path,
            eye: laid.eye,
            stencil: laid.stencil,
        }];
        if stroke.area.is_single() && turn_degrees != 0.0 {
            let brush = Brush {
                angle_degrees: wrapped(stroke.brush.angle_degrees + turn_degrees),
                ..stroke.brush.clone()
            };
            steps.push(Step::Change {
                stroke: stroke.id,
                name: stroke.name.clone(),
                brush: Box::new(brush),
                is_hidden: stroke.is_hidden,
            });
        }
        steps
    }
}
