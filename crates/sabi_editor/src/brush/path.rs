//! A path that is drawn knot by knot, and the knots and handles that are moved.

use std::sync::Arc;

use egui::{Modifiers, Pos2, Vec2};
use glam::DVec3;
use sabi_editing::command::PaintCommand;
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Bend, Knot, PaintSurface, Path, Step, Stroke, StrokePoint, relocate};

use super::shown_path::{PathPart, ShownPath};
use super::under::{on_surface, point_at, touched_at};
use super::{PaintSubject, PaintView};
use crate::action::{Action, PaintAction};
use crate::pen::PenState;

/// Length of a drag from which on it pulls handles out of a knot, in points.
const PULL: f32 = 6.0;
/// Distance of the pointer from its press from which on it is a drag, in points.
const MOVED: f32 = 2.0;
/// A knot or handle that is moved.
pub(super) struct HeldKnot {
    pub(super) node: NodeId,
    /// Versions of the node's strokes before the press.
    before: String,
    model: Arc<LiveModel>,
    stroke: Arc<Stroke>,
    /// True if the stroke is not among those of the node yet.
    pub(super) is_new: bool,
    path: Path,
    part: PathPart,
    pressed: Pos2,
    /// Vector from the pointer to the handle, so that the handle does not jump.
    grip: Vec2,
    /// True if the press itself changes the path, before the pointer moves.
    lays_at_once: bool,
}

/// Meaning of a press on a path.
pub(super) enum Press {
    /// A knot or a handle is held, which may be a new one.
    Hold(HeldKnot),
    /// The path was changed at once.
    Changed(Action),
    /// Clicks do not add knots any more.
    End,
}

/// Circumstances of a press.
#[derive(Clone, Copy)]
pub(super) struct PressKind {
    pub(super) modifiers: Modifiers,
    /// True for the second one of a double click.
    pub(super) is_second: bool,
    /// True while clicks add knots to the path.
    pub(super) extends: bool,
    /// True if a press on the path between two knots inserts a knot.
    pub(super) splits: bool,
}

impl HeldKnot {
    /// A new path whose first knot is under the pointer.
    pub(super) fn begun(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        pen: PenState,
        stroke: Stroke,
    ) -> Option<HeldKnot> {
        let place = touched_at(model, canvas, at, pen, true)?;
        let knot = Knot {
            place,
            bend: Bend::Smooth,
        };
        let path = Path {
            knots: vec![knot],
            is_closed: false,
        };
        Some(HeldKnot::new(
            painted,
            model,
            Arc::new(stroke),
            true,
            path,
            PathPart::Pull(0),
            at,
            Vec2::ZERO,
        ))
    }

    /// The marked path with one more knot at its end, under the pointer.
    pub(super) fn extended(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        canvas: &impl PaintView,
        at: Pos2,
        pen: PenState,
    ) -> Option<HeldKnot> {
        let stroke = painted.path.as_ref()?;
        let mut path = on_surface(model, |surface| relocate(surface, stroke).0.as_path())?;
        path.knots.push(Knot {
            place: touched_at(model, canvas, at, pen, false)?,
            bend: Bend::Smooth,
        });
        let last = PathPart::Pull(path.knots.len() - 1);
        Some(HeldKnot::new(
            painted,
            model,
            stroke.clone(),
            false,
            path,
            last,
            at,
            Vec2::ZERO,
        ))
    }

    fn new(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        stroke: Arc<Stroke>,
        is_new: bool,
        path: Path,
        part: PathPart,
        pressed: Pos2,
        grip: Vec2,
    ) -> HeldKnot {
        HeldKnot {
            node: painted.node.clone(),
            before: painted.strokes.clone(),
            model: model.clone(),
            stroke,
            is_new,
            path,
            lays_at_once: true,
            part,
            pressed,
            grip,
        }
    }

    /// A knot or a handle that was there before: a click on it changes nothing.
    fn known(self) -> HeldKnot {
        HeldKnot {
            lays_at_once: false,
            ..self
        }
    }

    /// Follows the pointer; returns the action that changes the path.
    pub(super) fn drag(&self, pointer: Pos2, canvas: &impl PaintView) -> Option<Action> {
        let mut path = self.path.clone();
        let at = pointer + self.grip;
        let model = &self.model;
        if !self.lays_at_once && pointer.distance(self.pressed) < MOVED {
            return None;
        }
        match self.part {
            PathPart::Pull(_) if pointer.distance(self.pressed) < PULL => {}
            PathPart::Pull(index) => {
                let handle = point_at(model, canvas, at, 1.0, false)?;
                path.knots[index].bend = Bend::Handles([mirrored(model, &path.knots[index], &handle)?, handle]);
            }
            PathPart::Knot(index) => {
                let knot = &mut path.knots[index];
                let place = point_at(model, canvas, at, knot.place.touch(), false)?;
                if let Bend::Handles(handles) = knot.bend {
                    let way = place.site.position - knot.place.site.position;
                    let moved = handles.map(|handle| led(model, &place, handle.site.position + way));
                    let [Some(before), Some(behind)] = moved else {
                        return None;
                    };
                    knot.bend = Bend::Handles([before, behind]);
                }
                knot.place = place;
            }
            PathPart::Handle(index, side) => {
                let handle = point_at(model, canvas, at, 1.0, false)?;
                let other = mirrored(model, &path.knots[index], &handle)?;
                path.knots[index].bend = Bend::Handles(if side == 0 { [handle, other] } else { [other, handle] });
            }
        }
        Some(self.laid(&path, canvas))
    }

    /// The action that gives the stroke a path.
    fn laid(&self, path: &Path, canvas: &impl PaintView) -> Action {
        let (points, form) = path.places();
        let eye = canvas.eye(&self.model);
        let step = if self.is_new {
            Step::Add(Arc::new(Stroke {
                path: Some(form),
                points,
                eye,
                ..(*self.stroke).clone()
            }))
        } else {
            Step::Place {
                stroke: self.stroke.id,
                path: Some(form),
                points,
                eye,
                stencil: self.stroke.stencil.clone(),
            }
        };
        Action::Paint(PaintAction::Lay(PaintCommand::Steps {
            node: self.node.clone(),
            model: self.model.linked.model.stem.clone(),
            before: self.before.clone(),
            title: "Path".to_owned(),
            steps: vec![step],
        }))
    }
}

/// Effect of a press on the marked path: on a knot, on a handle, or between two knots, where a new knot is inserted if
/// `splits`. With Ctrl a knot is removed, a second click turns it into a corner or back, and with Shift handles are
/// pulled out of it. While `extends`, clicks add knots to the path, and a click on the first knot closes it.
pub(super) fn press(
    painted: &PaintSubject,
    model: &Arc<LiveModel>,
    canvas: &impl PaintView,
    at: Pos2,
    PressKind {
        modifiers,
        is_second,
        extends,
        splits,
    }: PressKind,
) -> Option<Press> {
    let stroke = painted.path.as_ref()?;
    let shown = ShownPath::of(model, canvas, stroke)?;
    let mut path = shown.path.clone();
    let held = |path: Path, part: PathPart, grip: Vec2| {
        HeldKnot::new(painted, model, stroke.clone(), false, path, part, at, grip)
    };
    let changed = |path: Path| {
        let held = held(path.clone(), PathPart::Knot(0), Vec2::ZERO);
        Some(Press::Changed(held.laid(&path, canvas)))
    };
    match shown.part_at(at) {
        Some((PathPart::Knot(index), _)) if modifiers.command && path.knots.len() > 1 => {
            path.knots.remove(index);
            changed(path)
        }
        Some((PathPart::Knot(_), _)) if extends && is_second => Some(Press::End),
        Some((PathPart::Knot(0), _)) if extends && !path.is_closed && path.knots.len() > 2 => {
            path.is_closed = true;
            changed(path)
        }
        Some((PathPart::Knot(index), _)) if is_second => {
            let bend = &mut path.knots[index].bend;
            *bend = if *bend == Bend::Corner {
                Bend::Smooth
            } else {
                Bend::Corner
            };
            changed(path)
        }
        Some((PathPart::Knot(index), _)) if modifiers.shift => {
            Some(Press::Hold(held(path, PathPart::Pull(index), Vec2::ZERO).known()))
        }
        Some((part, grip)) => Some(Press::Hold(held(path, part, grip).known())),
        None => {
            let span = shown.span_at(at).filter(|_| splits && !extends)?;
            let place = point_at(model, canvas, at, 1.0, false)?;
            let knot = Knot {
                place,
                bend: Bend::Smooth,
            };
            path.knots.insert(span + 1, knot);
            Some(Press::Hold(held(path, PathPart::Knot(span + 1), Vec2::ZERO)))
        }
    }
}

/// The handle at the other side of a knot.
fn mirrored(model: &LiveModel, knot: &Knot, handle: &StrokePoint) -> Option<StrokePoint> {
    let own = knot.place.site.position;
    led(model, &knot.place, 2.0 * own - handle.site.position)
}

/// Surface point at which a walk from another one toward a place in space ends.
fn led(model: &LiveModel, from: &StrokePoint, to: DVec3) -> Option<StrokePoint> {
    on_surface(model, |surface: &PaintSurface<'_>| surface.led(from, to))
}
