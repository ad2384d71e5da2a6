//! The stroke that is being drawn.

use std::sync::Arc;

use egui::Pos2;
use sabi_editing::command::PaintCommand;
use sabi_engine::live::LiveModel;
use sabi_graph::NodeId;
use sabi_paint::{Action as BrushAction, Area, Eye, Stencil, Stroke, StrokePoint};

use super::decal::{Decal, sized};
use super::under::touched_at;
use super::{PaintSubject, PaintView};
use crate::action::{Action, PaintAction};
use crate::pen::PenState;
use crate::settings::brush::BrushChoices;

/// Distance on the screen between two points of a stroke, in points. It does not depend on how often the mouse reports.
const STEP: f32 = 3.0;

/// A stroke from its first touch on.
pub(super) struct OpenStroke {
    pub(super) node: NodeId,
    /// Versions of the node's strokes before this one.
    before: String,
    model: Arc<LiveModel>,
    brush: BrushChoices,
    action: BrushAction,
    /// Place that it copies from.
    pub(super) source: Option<StrokePoint>,
    /// Eye that looks at the model.
    pub(super) eye: Option<Eye>,
    /// Stencil that it is painted through.
    pub(super) stencil: Option<Arc<Stencil>>,
    points: Vec<StrokePoint>,
    /// Decal, if the brush lays one instead of a line.
    decal: Option<Decal>,
    /// Last place of the brush on the screen at which a surface point was looked up.
    last: Pos2,
    /// Place of the brush on the screen, to which the pointer has pulled it.
    hand: Pos2,
    /// Pen at that place.
    pen: PenState,
    /// True if the next point starts a new run, since the pointer was outside of the model.
    starts: bool,
}

impl OpenStroke {
    /// Creates a stroke that begins at a place of the screen with a pen.
    pub(super) fn new(
        painted: &PaintSubject,
        model: &Arc<LiveModel>,
        action: BrushAction,
        at: Pos2,
        pen: PenState,
    ) -> OpenStroke {
        OpenStroke {
            node: painted.node.clone(),
            before: painted.strokes.clone(),
            model: model.clone(),
            brush: painted.brush.clone(),
            action,
            source: None,
            eye: None,
            stencil: None,
            points: Vec::new(),
            decal: None,
            last: at,
            hand: at,
            pen,
            starts: true,
        }
    }

    /// Place of the brush on the screen.
    pub(super) fn brush_place(&self) -> Pos2 {
        self.hand
    }

    /// Last point of the stroke, with the name of its model.
    pub(super) fn last_point(&self) -> Option<(String, StrokePoint)> {
        let last = self.points.last()?;
        Some((self.model.linked.model.stem.clone(), *last))
    }

    /// Starts the stroke at a point of the model, if the view shows it. The stroke then runs straight on the screen
    /// from there.
    pub(super) fn begin_at(&mut self, from: Option<StrokePoint>, canvas: &impl PaintView) {
        let Some((from, place)) = from.and_then(|from| Some((from, canvas.place(&self.model, from.site)?))) else {
            return;
        };
        self.last = place;
        self.brush = sized(&self.brush, &self.model, canvas, &from);
        self.points = vec![StrokePoint { starts: true, ..from }];
        self.starts = false;
    }

    /// Adds places of the pointer. Returns the action that lays the stroke, if it has changed.
    pub(super) fn add(&mut self, places: &[(Pos2, PenState)], canvas: &impl PaintView) -> Option<Action> {
        if self.area().is_single() {
            return self.drag_decal(places, canvas);
        }
        let known = self.points.len();
        for (pointer, pen) in places {
            self.hand = pulled(self.hand, *pointer, self.brush.lag);
            let way = self.hand - self.last;
            let steps = (way.length() / STEP).floor() as usize;
            let (start, first) = (self.last, self.pen);
            if self.points.is_empty() {
                self.look(start, canvas);
            }
            for step in 1..=steps {
                let share = step as f32 * STEP / way.length();
                self.pen = PenState::between([first, *pen], share);
                self.last = start + way * share;
                self.look(self.last, canvas);
            }
        }
        (self.points.len() > known).then(|| self.lay())
    }

    /// Area that it acts on: strokes that change paint act along their line only.
    pub(super) fn area(&self) -> Area {
        if self.action.adjusts() {
            Area::Way
        } else {
            self.brush.area
        }
    }

    /// Lays a decal at the first place, and turns and sizes it by the drag from there.
    fn drag_decal(&mut self, places: &[(Pos2, PenState)], canvas: &impl PaintView) -> Option<Action> {
        let (at, _) = places.last()?;
        if self.points.is_empty() {
            self.look(*at, canvas);
            let placed = self.points.first()?;
            self.decal = Some(Decal::new(&self.model, canvas, placed, *at));
        }
        if let Some(decal) = &mut self.decal {
            decal.drag(*at);
        }
        Some(self.lay())
    }

    /// Adds the surface point under a place of the screen to the stroke.
    fn look(&mut self, at: Pos2, canvas: &impl PaintView) {
        let point = touched_at(&self.model, canvas, at, self.pen, self.starts);
        if let Some(first) = point.as_ref().filter(|_| self.points.is_empty()) {
            self.brush = sized(&self.brush, &self.model, canvas, first);
        }
        self.starts = point.is_none();
        self.points.extend(point);
    }

    /// The action that lays the stroke so far.
    fn lay(&self) -> Action {
        let linked = &self.model.linked;
        let mut brush = self.brush.brush(linked.largest_side);
        if let Some(decal) = &self.decal {
            brush = decal.shape(brush);
        }
        let stroke = Stroke {
            action: self.action,
            area: self.area(),
            eye: self.eye,
            source: self.source,
            copy_of: self.brush.copy_of_stroke(self.action),
            stencil: self.stencil.clone(),
            ..Stroke::new(brush.bounded(), self.points.clone())
        };
        Action::Paint(PaintAction::Lay(PaintCommand::Stroke {
            node: self.node.clone(),
            model: linked.model.stem.clone(),
            before: self.before.clone(),
            stroke: Arc::new(stroke),
        }))
    }
}

/// Place of a brush that the pointer pulls by a string of this length, once the pointer has moved.
fn pulled(brush: Pos2, pointer: Pos2, length: f32) -> Pos2 {
    let way = pointer - brush;
    let distance = way.length();
    if distance <= length {
        return brush;
    }
    brush + way * ((distance - length) / distance)
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn a_brush_on_a_string_stays_until_the_string_is_tight_and_follows_then() {
        let brush = pos2(10.0, 10.0);
        assert_eq!(pulled(brush, pos2(14.0, 10.0), 5.0), brush);
        assert_eq!(pulled(brush, pos2(18.0, 10.0), 5.0), pos2(13.0, 10.0));
        assert_eq!(pulled(brush, pos2(18.0, 10.0), 0.0), pos2(18.0, 10.0));
    }
}
