//! What the pointer holds: nodes, a wire, a box, a lasso, a knife, the canvas itself.

use std::collections::BTreeMap;

use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui, pos2, vec2};
use sabi_graph::{NodeId, SlotRef};

use super::ports::Place;
use super::questions::MergeQuestion;
use super::wires::{self, Wire};
use super::{AddMenu, Around, Canvas, Purpose, node_rect, ports};
use crate::action::Action;
use crate::desk::{Desk, GRID, Loose};

/// So near an edge of the panel what is dragged pulls the canvas along, screen points.
const EDGE: f32 = 28.0;
/// How fast at most, screen points a second.
const PULL: f32 = 900.0;

/// What the pointer holds.
#[derive(Clone, Debug, Default)]
pub(super) enum Gesture {
    /// Nothing.
    #[default]
    Idle,
    /// The canvas.
    Pan,
    /// The zoom, as in Substance: up is larger.
    Zoom { around: Pos2 },
    /// Nodes: where each stood, and where on the canvas the pointer took them.
    Move {
        from: BTreeMap<NodeId, [f32; 2]>,
        grabbed: [f32; 2],
    },
    /// A wire that is tied at one end; `off` is the input that it was taken off.
    Wire {
        loose: Loose,
        off: Option<SlotRef>,
        /// Taken by a key: it follows the focus and not the pointer.
        by_key: bool,
    },
    /// A box around nodes, from a place on the canvas.
    Box { from: [f32; 2] },
    /// A line around nodes, on the screen.
    Lasso { line: Vec<Pos2> },
    /// A line through wires, on the screen.
    Cut { line: Vec<Pos2> },
}

impl Gesture {
    pub(super) fn wire(loose: Loose, off: Option<SlotRef>) -> Gesture {
        Gesture::Wire {
            loose,
            off,
            by_key: false,
        }
    }

    /// Whether the wire in hand may be dropped there; none where there is no wire.
    pub(super) fn takes(&self, desk: &Desk, place: &Place) -> Option<bool> {
        let Gesture::Wire { loose, .. } = self else {
            return None;
        };
        Some(match (loose, place) {
            (Loose::From(from), Place::Input(to)) => from.node != to.node && desk.fits(from, to).is_ok(),
            (Loose::Into(to), Place::Output(from)) => from.node != to.node && desk.fits(from, to).is_ok(),
            _ => false,
        })
    }

    /// Whether the knife goes through a wire.
    pub(super) fn cuts(&self, wire: &Wire) -> bool {
        let Gesture::Cut { line } = self else {
            return false;
        };
        line.windows(2).any(|piece| wire.is_crossed([piece[0], piece[1]]))
    }

    /// The wire that would take the dragged node; or, with nothing in hand, the one under the pointer.
    pub(super) fn hot_wire<'w>(
        &self,
        canvas: &Canvas,
        desk: &Desk,
        wires: &'w [Wire],
        pointer: Option<Pos2>,
    ) -> Option<&'w SlotRef> {
        let pointer = pointer.filter(|at| canvas.panel.is_some_and(|panel| panel.contains(*at)))?;
        match self {
            Gesture::Idle if !canvas.holds_keys() => wires::under(wires, pointer).map(|wire| &wire.to),
            Gesture::Move { from, .. } if from.len() == 1 => {
                let id = from.keys().next()?;
                let rect = canvas.view.screen_rect(canvas.panel?, node_rect(desk, id)?);
                let crossing = wires.iter().filter(|wire| {
                    let middle = rect.center();
                    wire.to.node != *id && wire.from.node != *id && wire.distance(middle) < rect.height().min(60.0)
                });
                let crossing = crossing
                    .min_by(|one, other| one.distance(rect.center()).total_cmp(&other.distance(rect.center())))?;
                desk.may_insert(id, &crossing.to).then_some(&crossing.to)
            }
            _ => None,
        }
    }
}

impl Canvas {
    /// Takes a node, and with it all that are selected.
    pub(super) fn grab(
        &mut self,
        id: &NodeId,
        response: &Response,
        around: &Around<'_>,
        modifiers: Modifiers,
        actions: &mut Vec<Action>,
    ) {
        let (Some(panel), Some(at)) = (self.panel, response.ctx.input(|input| input.pointer.press_origin())) else {
            return;
        };
        let mut from = around.desk.places();
        if !from.contains_key(id) {
            actions.push(Action::Select(vec![id.clone()]));
            let Some(node) = around.desk.node(id) else { return };
            from = BTreeMap::from([(id.clone(), node.pos)]);
        }
        actions.push(Action::BeginMove);
        if modifiers.alt {
            actions.push(Action::TakeOut);
        }
        self.gesture = Gesture::Move {
            from,
            grabbed: self.view.place(panel, at),
        };
    }
}

/// Goes on with what is in hand, or takes something.
pub(super) fn advance(
    canvas: &mut Canvas,
    ui: &Ui,
    ground: &Response,
    around: &Around<'_>,
    wires: &[Wire],
    actions: &mut Vec<Action>,
) {
    let Some(panel) = canvas.panel else { return };
    begin(canvas, ui, ground, panel);
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let Some(pointer) = pointer else { return };
    let (delta, modifiers) = ui.input(|input| (input.pointer.delta(), input.modifiers));
    let is_down = |button| ui.input(|input| input.pointer.button_down(button));
    match &mut canvas.gesture {
        Gesture::Idle => rest(canvas, ui, ground, panel, around, wires, actions),
        Gesture::Pan => {
            canvas.view.pan += delta;
            ui.set_cursor_icon(CursorIcon::Grabbing);
            if !is_down(PointerButton::Middle) && !is_down(PointerButton::Primary) {
                canvas.gesture = Gesture::Idle;
            }
        }
        Gesture::Zoom { around } => {
            let around = *around;
            canvas.view.zoom_at(panel, around, (-delta.y * 0.01).exp());
            if !is_down(PointerButton::Secondary) {
                canvas.gesture = Gesture::Idle;
            }
        }
        Gesture::Move { .. } => drag(canvas, ui, panel, around, wires, pointer, actions),
        Gesture::Wire { by_key: true, .. } => {}
        Gesture::Wire { .. } => {
            pull(canvas, ui, panel, pointer);
            if !is_down(PointerButton::Primary) {
                drop_wire(canvas, around, panel, pointer, actions);
            }
        }
        Gesture::Box { .. } => {
            pull(canvas, ui, panel, pointer);
            if !is_down(PointerButton::Primary) {
                end_box(canvas, around, panel, pointer, modifiers, actions);
            }
        }
        Gesture::Lasso { line } | Gesture::Cut { line } => {
            if line.last().is_none_or(|last| last.distance(pointer) > 3.0) {
                line.push(pointer);
            }
            if !is_down(PointerButton::Primary) && !is_down(PointerButton::Secondary) {
                end_line(canvas, around, panel, wires, modifiers, actions);
            }
        }
    }
}

/// Takes the canvas, a box, a lasso or a knife.
fn begin(canvas: &mut Canvas, ui: &Ui, ground: &Response, panel: Rect) {
    if !matches!(canvas.gesture, Gesture::Idle) || canvas.holds_keys() {
        return;
    }
    let (pressed, at, modifiers) = ui.input(|input| {
        let pressed = [PointerButton::Middle, PointerButton::Secondary].map(|it| input.pointer.button_pressed(it));
        (pressed, input.pointer.interact_pos(), input.modifiers)
    });
    let Some(at) = at.filter(|at| panel.contains(*at)) else {
        return;
    };
    let is_ours = ui.ctx().layer_id_at(at).is_none_or(|layer| layer == ui.layer_id());
    let [middle, secondary] = pressed;
    if middle && is_ours {
        canvas.gesture = Gesture::Pan;
    } else if secondary && is_ours && modifiers.command {
        canvas.gesture = Gesture::Cut { line: vec![at] };
    } else if secondary && is_ours && modifiers.alt {
        canvas.gesture = Gesture::Zoom { around: at };
    } else if ground.drag_started_by(PointerButton::Primary) {
        let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
        canvas.gesture = match (modifiers.alt, modifiers.shift && modifiers.command) {
            (true, _) => Gesture::Lasso { line: vec![origin] },
            (_, true) => Gesture::Pan,
            _ => Gesture::Box {
                from: canvas.view.place(panel, origin),
            },
        };
    }
}

/// Clicks beside nodes, with nothing in hand.
fn rest(
    canvas: &mut Canvas,
    ui: &Ui,
    ground: &Response,
    panel: Rect,
    around: &Around<'_>,
    wires: &[Wire],
    actions: &mut Vec<Action>,
) {
    let Some(pointer) = ground.interact_pointer_pos() else {
        return;
    };
    let modifiers = ui.input(|input| input.modifiers);
    let place = canvas.view.place(panel, pointer);
    if ground.double_clicked() {
        if let Some(wire) = wires::under(wires, pointer) {
            let into = wire.to.clone();
            actions.push(Action::Reroute { into, place });
        }
    } else if ground.clicked() {
        match wires::under(wires, pointer) {
            Some(wire) if modifiers.alt => actions.push(Action::Cut(vec![wire.to.clone()])),
            _ => actions.push(Action::Select(Vec::new())),
        }
        canvas.port = None;
    } else if ground.secondary_clicked() && !modifiers.command && !modifiers.alt {
        let into = wires::under(wires, pointer).map(|wire| wire.to.clone());
        let purpose = Purpose {
            place,
            into,
            ..Purpose::default()
        };
        let _ = around;
        canvas.menu = Some(AddMenu::new(pointer, purpose));
    }
}

/// Nodes follow the pointer.
fn drag(
    canvas: &mut Canvas,
    ui: &Ui,
    panel: Rect,
    around: &Around<'_>,
    wires: &[Wire],
    pointer: Pos2,
    actions: &mut Vec<Action>,
) {
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        actions.push(Action::TakeBack);
        canvas.gesture = Gesture::Idle;
        return;
    }
    pull(canvas, ui, panel, pointer);
    let Gesture::Move { from, grabbed } = &canvas.gesture else {
        return;
    };
    let (is_down, modifiers) = ui.input(|input| (input.pointer.primary_down(), input.modifiers));
    let here = canvas.view.place(panel, pointer);
    let offset = [here[0] - grabbed[0], here[1] - grabbed[1]];
    let snapped = |at: f32| match modifiers.command {
        true => at.round(),
        false => (at / GRID).round() * GRID,
    };
    let places = from
        .iter()
        .map(|(id, pos)| (id.clone(), [snapped(pos[0] + offset[0]), snapped(pos[1] + offset[1])]));
    actions.push(Action::Move(places.collect()));
    if is_down {
        return;
    }
    let into = canvas
        .gesture
        .hot_wire(canvas, around.desk, wires, Some(pointer))
        .cloned();
    if let (Some(into), Gesture::Move { from, .. }) = (into, &canvas.gesture)
        && let Some(id) = from.keys().next()
    {
        let node = id.clone();
        actions.push(Action::Insert { node, into });
    }
    if let Some(frame) = super::frames::under(canvas, around.desk, pointer) {
        actions.push(Action::PutIntoFrame(Some(frame)));
    }
    actions.push(Action::EndMove);
    canvas.gesture = Gesture::Idle;
}

/// What is held at an edge pulls the canvas along.
fn pull(canvas: &mut Canvas, ui: &Ui, panel: Rect, pointer: Pos2) {
    let over = |at: f32, low: f32, high: f32| {
        let below = (low + EDGE - at).clamp(0.0, EDGE);
        let above = (at - high + EDGE).clamp(0.0, EDGE);
        (below - above) / EDGE
    };
    let way = vec2(
        over(pointer.x, panel.left(), panel.right()),
        over(pointer.y, panel.top(), panel.bottom()),
    );
    if way != egui::Vec2::ZERO {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        canvas.view.pan += way * PULL * seconds;
        ui.ctx().request_repaint();
    }
}

fn drop_wire(canvas: &mut Canvas, around: &Around<'_>, panel: Rect, pointer: Pos2, actions: &mut Vec<Action>) {
    let target = ports::target(canvas, around, panel, pointer);
    let Gesture::Wire { loose, off, .. } = std::mem::take(&mut canvas.gesture) else {
        return;
    };
    match target {
        Some(place) => canvas.tie(around.desk, loose, place, off, pointer, actions),
        None => match off {
            Some(slot) => actions.push(Action::Cut(vec![slot])),
            None => {
                let purpose = Purpose {
                    place: canvas.view.place(panel, pointer),
                    loose: Some(loose),
                    ..Purpose::default()
                };
                canvas.menu = Some(AddMenu::new(pointer, purpose));
            }
        },
    }
}

impl Canvas {
    /// Ties a wire, or asks how where a mask is there already.
    pub(super) fn tie(
        &mut self,
        desk: &Desk,
        loose: Loose,
        place: Place,
        off: Option<SlotRef>,
        at: Pos2,
        actions: &mut Vec<Action>,
    ) {
        let (from, to) = match (loose, place) {
            (Loose::From(from), Place::Input(to)) => (from, to),
            (Loose::Into(to), Place::Output(from)) => (from, to),
            _ => return,
        };
        if off.as_ref() == Some(&to) {
            return;
        }
        if off.is_none() && desk.may_merge(&from, &to) {
            self.merge = Some(MergeQuestion::new(at, from, to));
        } else {
            actions.push(Action::Connect { from, to, off });
        }
    }
}

fn end_box(
    canvas: &mut Canvas,
    around: &Around<'_>,
    panel: Rect,
    pointer: Pos2,
    modifiers: Modifiers,
    actions: &mut Vec<Action>,
) {
    let Gesture::Box { from } = std::mem::take(&mut canvas.gesture) else {
        return;
    };
    let to = canvas.view.place(panel, pointer);
    let taken = Rect::from_two_pos(pos2(from[0], from[1]), pos2(to[0], to[1]));
    select(around, modifiers, actions, |rect| taken.intersects(rect));
}

/// Selects what is inside; with Shift or Ctrl, besides what was.
fn select(around: &Around<'_>, modifiers: Modifiers, actions: &mut Vec<Action>, is_in: impl Fn(Rect) -> bool) {
    let desk = around.desk;
    let inside = desk.graph().ids().filter(|id| node_rect(desk, id).is_some_and(&is_in));
    let mut ids: Vec<NodeId> = inside.cloned().collect();
    if modifiers.shift || modifiers.command {
        ids.extend(desk.selection().iter().cloned());
    }
    actions.push(Action::Select(ids));
}

fn end_line(
    canvas: &mut Canvas,
    around: &Around<'_>,
    panel: Rect,
    wires: &[Wire],
    modifiers: Modifiers,
    actions: &mut Vec<Action>,
) {
    let gesture = std::mem::take(&mut canvas.gesture);
    if let Gesture::Lasso { line } = &gesture {
        let view = canvas.view;
        let modifiers = Modifiers {
            alt: false,
            ..modifiers
        };
        select(around, modifiers, actions, |rect| {
            is_inside(line, view.screen_rect(panel, rect).center())
        });
        return;
    }
    let cut: Vec<SlotRef> = wires
        .iter()
        .filter(|wire| gesture.cuts(wire))
        .map(|wire| wire.to.clone())
        .collect();
    if !cut.is_empty() {
        actions.push(Action::Cut(cut));
    }
}

/// Whether a place is inside a closed line: a ray from it crosses the line an odd number of times.
fn is_inside(line: &[Pos2], place: Pos2) -> bool {
    let closed = line.iter().zip(line.iter().cycle().skip(1));
    let crossings = closed.filter(|(one, other)| {
        let spans = (one.y > place.y) != (other.y > place.y);
        spans && place.x < one.x + (place.y - one.y) / (other.y - one.y) * (other.x - one.x)
    });
    crossings.count() % 2 == 1
}

/// Draws what is in hand.
pub(super) fn draw(canvas: &Canvas, ui: &Ui, panel: Rect, around: &Around<'_>) {
    let theme = around.theme;
    let painter = ui.painter();
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    let line = Stroke::new(1.5, theme.accent);
    match &canvas.gesture {
        Gesture::Wire { loose, by_key, .. } => {
            let place = match loose {
                Loose::From(from) => Place::Output(from.clone()),
                Loose::Into(to) => Place::Input(to.clone()),
            };
            let Some(tied) = place.on_canvas(around.desk) else {
                return;
            };
            let tied = canvas.view.screen(panel, tied);
            let target = match by_key {
                true => canvas.port_place(around.desk),
                false => ports::target(canvas, around, panel, pointer),
            };
            let end = target.and_then(|place| place.on_canvas(around.desk));
            let end = end.map_or(pointer, |place| canvas.view.screen(panel, place));
            let ends = match loose {
                Loose::From(_) => [tied, end],
                Loose::Into(_) => [end, tied],
            };
            wires::draw_curve(painter, wires::curve(ends, canvas.view.zoom), theme.accent, 2.5);
        }
        Gesture::Box { from } => {
            let rect = Rect::from_two_pos(canvas.view.screen(panel, *from), pointer);
            painter.rect(
                rect,
                2.0,
                theme.accent.gamma_multiply(0.12),
                line,
                egui::StrokeKind::Inside,
            );
        }
        Gesture::Lasso { line: points } => {
            painter.add(Shape::closed_line(points.clone(), line));
        }
        Gesture::Cut { line: points } => {
            painter.add(Shape::line(points.clone(), Stroke::new(2.0, theme.fault)));
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasso_holds_what_it_goes_around() {
        let line = [
            pos2(0.0, 0.0),
            pos2(100.0, 0.0),
            pos2(50.0, 50.0),
            pos2(100.0, 100.0),
            pos2(0.0, 100.0),
        ];
        assert!(is_inside(&line, pos2(20.0, 50.0)));
        assert!(!is_inside(&line, pos2(80.0, 50.0)), "in the notch");
        assert!(!is_inside(&line, pos2(-5.0, 50.0)));
    }
}
