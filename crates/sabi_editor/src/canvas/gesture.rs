//! What the pointer holds: nodes, a wire, a box, a lasso, a knife, the canvas itself.

mod carrying;
mod marking;

use std::collections::BTreeMap;

use egui::{CursorIcon, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui, vec2};
use sabi_graph::{NodeId, SlotRef};

use super::ports::Place;
use super::questions::MergeQuestion;
use super::wires::{self, Wire};
use super::{AddMenu, Around, Canvas, Purpose, ports};
use crate::action::{Action, WireAsk};
use crate::desk::{Desk, Loose};
use carrying::drag;
use marking::{end_box, end_line};

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
        /// A whole frame is moved, which goes into no wire and no other frame.
        is_frame: bool,
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
        Gesture::Idle => rest(canvas, ui, ground, panel, wires, actions),
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
fn rest(canvas: &mut Canvas, ui: &Ui, ground: &Response, panel: Rect, wires: &[Wire], actions: &mut Vec<Action>) {
    let Some(pointer) = ground.interact_pointer_pos() else {
        return;
    };
    let modifiers = ui.input(|input| input.modifiers);
    let place = canvas.view.place(panel, pointer);
    if ground.double_clicked() {
        if let Some(wire) = wires::under(wires, pointer) {
            let into = wire.to.clone();
            actions.push(Action::Wire(WireAsk::Reroute { into, place }));
        }
    } else if ground.clicked() {
        match wires::under(wires, pointer) {
            Some(wire) if modifiers.alt => actions.push(Action::Wire(WireAsk::Cut(vec![wire.to.clone()]))),
            _ => actions.push(Action::Select(Vec::new())),
        }
        canvas.leave_port();
    } else if ground.secondary_clicked() && !modifiers.command && !modifiers.alt {
        let into = wires::under(wires, pointer).map(|wire| wire.to.clone());
        let purpose = Purpose {
            place,
            into,
            ..Purpose::default()
        };
        canvas.menu = Some(AddMenu::new(pointer, purpose));
    }
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
            Some(slot) => actions.push(Action::Wire(WireAsk::Cut(vec![slot]))),
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
            actions.push(Action::Wire(WireAsk::Connect { from, to, off }));
        }
    }
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
