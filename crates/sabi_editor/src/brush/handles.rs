//! Handles of a decal that lies on the model already: one moves it, one turns and sizes it.

use std::sync::Arc;

use egui::{Pos2, Vec2};
use sabi_editing::command::PaintCommand;
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Brush, Step, Stroke, carried};

use super::decal::{axes_on_screen, turn_of, wrapped};
use super::under::{on_surface, point_at};
use super::{PaintSubject, PaintView};
use crate::action::{Action, PaintAction};

/// Distance from the middle of a handle within which it is taken, points.
const NEAR: f32 = 10.0;
/// Distance between the middle of a decal and the visible surface there from which on the decal is hidden, as a share
/// of the model's largest side.
const HIDDEN: f64 = 0.01;
/// Least size of a decal, as a share of the model's largest side.
const LEAST: f64 = 0.002;

/// Handles of a decal on the screen.
pub(crate) struct Handles {
    /// Middle of the decal, which moves it.
    pub(crate) middle: Pos2,
    /// The middle of the decal's right side, which turns and sizes it.
    pub(crate) side: Pos2,
    /// Corners of the decal.
    pub(crate) corners: [Pos2; 4],
}

/// Part of a decal that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DecalPart {
    Middle,
    Side,
}

/// A decal that is moved, or turned and sized.
pub(super) struct HeldDecal {
    pub(super) node: NodeId,
    /// Versions of the node's strokes before the drag.
    before: String,
    model: Arc<LiveModel>,
    stroke: Arc<Stroke>,
    part: DecalPart,
    /// Half of its width, in radii.
    half_width: f32,
    /// Vector from the pointer to the handle, so that the handle does not jump.
    grip: Vec2,
}

impl Handles {
    /// The handles of a decal; `None` where the view does not show it. `half_sides` are those of its picture, in radii.
    pub(crate) fn of(
        model: &LiveModel,
        canvas: &impl PaintView,
        stroke: &Stroke,
        half_sides: [f32; 2],
    ) -> Option<Handles> {
        let placed = stroke.points.first()?;
        let middle = canvas.place(model, placed.site)?;
        // Only a view with an eye draws handles, and not through a surface in front of the decal.
        canvas.eye(model)?;
        let seen = canvas.site(model, middle)?;
        let distance = seen.position.distance(placed.site.position);
        if distance > HIDDEN * model.linked.largest_side {
            return None;
        }
        let [right, up] = axes_on_screen(model, canvas, placed, stroke.eye)?;
        let (sine, cosine) = stroke.brush.angle_degrees.to_radians().sin_cos();
        let radius = stroke.brush.radius;
        let at = |x: f32, y: f32| {
            let (x, y) = (radius * half_sides[0] * x, radius * half_sides[1] * y);
            middle + (cosine * x - sine * y) * right + (sine * x + cosine * y) * up
        };
        Some(Handles {
            middle,
            side: at(1.0, 0.0),
            corners: [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
        })
    }

    /// The part under a place of the screen; the side lies over the middle where both are near.
    fn part_at(&self, at: Pos2) -> Option<(DecalPart, Vec2)> {
        let parts = [(DecalPart::Side, self.side), (DecalPart::Middle, self.middle)];
        let near = parts.into_iter().find(|(_, handle)| handle.distance(at) <= NEAR);
        near.map(|(part, handle)| (part, handle - at))
    }

    /// Returns true if a handle is under a place of the screen.
    pub(crate) fn is_at(&self, at: Pos2) -> bool {
        self.part_at(at).is_some()
    }
}

impl HeldDecal {
    /// The decal of a paint node whose handle is under the pointer.
    pub(super) fn at(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
    ) -> Option<HeldDecal> {
        let marked = painted.decal.as_ref()?;
        let handles = Handles::of(model, canvas, &marked.stroke, marked.half_sides)?;
        let (part, grip) = handles.part_at(at)?;
        Some(HeldDecal {
            node: painted.node.clone(),
            before: painted.strokes.clone(),
            model: model.clone(),
            stroke: marked.stroke.clone(),
            part,
            half_width: marked.half_sides[0],
            grip,
        })
    }

    /// Follows the pointer; returns the action that changes the decal.
    pub(super) fn drag(&self, pointer: Pos2, canvas: &impl PaintView) -> Option<Action> {
        let step = match self.part {
            DecalPart::Middle => self.moved(pointer + self.grip, canvas),
            DecalPart::Side => self.turned(pointer + self.grip, canvas),
        }?;
        Some(Action::Paint(PaintAction::Lay(PaintCommand::Steps {
            node: self.node.clone(),
            model: self.model.linked.model.stem.clone(),
            before: self.before.clone(),
            title: "Decal".to_owned(),
            steps: vec![step],
        })))
    }

    fn moved(&self, to: Pos2, canvas: &impl PaintView) -> Option<Step> {
        let touch = self.stroke.points.first()?.touch();
        let point = point_at(&self.model, canvas, to, touch, true)?;
        let from = self.stroke.points.first()?;
        let (carried, _) = on_surface(&self.model, |surface| {
            carried(surface, &self.stroke, [from, &point], 0.0)
        });
        Some(Step::Place {
            stencil: carried.stencil,
            stroke: self.stroke.id,
            points: vec![point],
            path: None,
            // The 2D view has no eye; the decal is read from where it was.
            eye: canvas.eye(&self.model).or(self.stroke.eye),
        })
    }

    fn turned(&self, to: Pos2, canvas: &impl PaintView) -> Option<Step> {
        let placed = self.stroke.points.first()?;
        let middle = canvas.place(&self.model, placed.site)?;
        let axes = axes_on_screen(&self.model, canvas, placed, self.stroke.eye)?;
        let [radius, turn] = turn_of(axes, to - middle)?;
        let least = (LEAST * self.model.linked.largest_side) as f32;
        let brush = Brush {
            radius: (radius / self.half_width).max(least),
            angle_degrees: wrapped(turn),
            ..self.stroke.brush.clone()
        };
        Some(Step::Change {
            stroke: self.stroke.id,
            name: self.stroke.name.clone(),
            brush: Box::new(brush),
            is_hidden: self.stroke.is_hidden,
        })
    }
}
