//! Drags on the canvas: of nodes, wires, selections, cuts and the view itself.

mod marking;
mod moving;
mod wiring;

use std::collections::BTreeMap;

use egui::{CursorIcon, Event, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui, vec2};
use sabi_editing::command::WireCommand;
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, connections};
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::port_refs::{self, PortRef};
use super::questions::MergeQuestion;
use super::wires::{self, Wire};
use super::{AddMenu, Canvas, CanvasContext, Purpose};
use crate::action::Action;
use crate::command::{InputPreset, Scope};
use crate::mouse::{self, DragAction};
use marking::{end_box, end_line};
use moving::drag;
use wiring::target;

/// Distance from an edge of the panel at which a drag scrolls the canvas, screen points.
pub(super) const EDGE: f32 = 28.0;
/// Least distance between a press and a release in one frame that count as a drag, screen points.
const FLICK: f32 = 12.0;
/// Highest speed of scrolling, screen points a second.
const PULL: f32 = 900.0;

/// Current drag.
#[derive(Clone, Debug, Default)]
pub(super) enum Gesture {
    /// No drag.
    #[default]
    Idle,
    /// Drag of the view, by a button.
    Pan { button: PointerButton },
    /// Drag of the zoom, by a button: up is larger.
    Zoom { around: Pos2, button: PointerButton },
    /// Drag of nodes: their places before, and the place on the canvas where the drag began.
    Move {
        from: BTreeMap<NodeId, [f32; 2]>,
        grabbed: [f32; 2],
        /// Whether a whole frame is dragged, which cannot be put into a wire or another frame.
        is_frame: bool,
    },
    /// Drag of a wire that is connected at one end; `off` is the input that it was disconnected from.
    Wire {
        loose: PendingWire,
        off: Option<SlotRef>,
        /// Whether the drag began by a key, and follows the keyboard focus and not the pointer.
        by_key: bool,
    },
    /// Selection in a box, from a place on the canvas.
    Box { from: [f32; 2] },
    /// Selection in a closed line, on the screen.
    Lasso { line: Vec<Pos2> },
    /// Cut through wires along a line, on the screen.
    Cut { line: Vec<Pos2> },
}

impl Gesture {
    pub(super) fn wire(loose: PendingWire, off: Option<SlotRef>) -> Gesture {
        Gesture::Wire {
            loose,
            off,
            by_key: false,
        }
    }

    /// Whether the dragged wire may be dropped at a port; none without a dragged wire.
    pub(super) fn takes(&self, document: &OpenDocument, place: &PortRef) -> Option<bool> {
        let Gesture::Wire { loose, .. } = self else {
            return None;
        };
        let ends = ends(loose, place);
        Some(
            ends.is_some_and(|(from, to)| {
                from.node != to.node && sabi_editing::wires::check(document, from, to).is_ok()
            }),
        )
    }

    /// Rank of a port among those that take the dragged wire, lower first: free ports first, then ports of the wire's
    /// type.
    pub(super) fn cost(&self, document: &OpenDocument, place: &PortRef) -> (bool, bool) {
        let Gesture::Wire { loose, .. } = self else {
            return (false, false);
        };
        let Some((from, to)) = ends(loose, place) else {
            return (true, true);
        };
        let is_taken = matches!(place, PortRef::Input(_)) && connections::wire_into(document, to).is_some();
        let converts =
            connections::input(document, to).is_none_or(|port| port.ty != connections::carried(document, from));
        (is_taken, converts)
    }

    /// Whether the current cut goes through a wire.
    pub(super) fn cuts(&self, wire: &Wire) -> bool {
        let Gesture::Cut { line } = self else {
            return false;
        };
        line.windows(2).any(|piece| wire.is_crossed([piece[0], piece[1]]))
    }
}

/// Ends of a pending wire that is dropped at a port; none where both are inputs or both outputs.
fn ends<'w>(loose: &'w PendingWire, place: &'w PortRef) -> Option<(&'w OutputRef, &'w SlotRef)> {
    match (loose, place) {
        (PendingWire::From(from), PortRef::Input(to)) | (PendingWire::Into(to), PortRef::Output(from)) => {
            Some((from, to))
        }
        _ => None,
    }
}

/// Continues the current drag, or begins one.
pub(super) fn advance(
    canvas: &mut Canvas,
    ui: &Ui,
    background: &Response,
    around: &CanvasContext<'_>,
    wires: &[Wire],
    actions: &mut Vec<Action>,
) {
    let Some(panel) = canvas.panel else { return };
    if flick(canvas, ui, around, panel, actions) {
        return;
    }
    begin(canvas, ui, background, panel, around.habit);
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let Some(pointer) = pointer else { return };
    let (delta, modifiers) = ui.input(|input| (input.pointer.delta(), input.modifiers));
    let is_down = |button| ui.input(|input| input.pointer.button_down(button));
    match &mut canvas.gesture {
        Gesture::Idle => rest(canvas, ui, background, panel, wires, actions),
        Gesture::Pan { button } => {
            let button = *button;
            canvas.view.pan += delta;
            ui.set_cursor_icon(CursorIcon::Grabbing);
            if !is_down(button) {
                canvas.gesture = Gesture::Idle;
            }
        }
        Gesture::Zoom { around, button } => {
            let (around, button) = (*around, *button);
            canvas.view.zoom_at(panel, around, (-delta.y * 0.01).exp());
            if !is_down(button) {
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

/// Connects a wire that was pressed and released within one frame, as happens where frames take long.
fn flick(canvas: &mut Canvas, ui: &Ui, around: &CanvasContext<'_>, panel: Rect, actions: &mut Vec<Action>) -> bool {
    if !matches!(canvas.gesture, Gesture::Idle) || canvas.holds_keys() {
        return false;
    }
    let button = |event: &Event, is_press: bool| match event {
        Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            ..
        } if *pressed == is_press => Some(*pos),
        _ => None,
    };
    let ends = ui.input(|input| {
        let at = input.events.iter().position(|event| button(event, true).is_some())?;
        let from = button(&input.events[at], true)?;
        let to = input.events[at..].iter().find_map(|event| button(event, false))?;
        Some((from, to))
    });
    let Some((from, to)) = ends.filter(|(from, to)| panel.contains(*from) && from.distance(*to) > FLICK) else {
        return false;
    };
    let is_ours = ui.ctx().layer_id_at(from).is_none_or(|layer| layer == ui.layer_id());
    let Some(place) = port_refs::at(canvas, around.document, panel, from).filter(|_| is_ours) else {
        return false;
    };
    canvas.gesture = Gesture::taken_at(around.document, &place);
    drop_wire(canvas, around, panel, to, actions);
    true
}

/// Begins a drag of the view, a selection or a cut.
fn begin(canvas: &mut Canvas, ui: &Ui, background: &Response, panel: Rect, habit: InputPreset) {
    if !matches!(canvas.gesture, Gesture::Idle) || canvas.holds_keys() {
        return;
    }
    let (at, modifiers) = ui.input(|input| (input.pointer.interact_pos(), input.modifiers));
    let Some(at) = at.filter(|at| panel.contains(*at)) else {
        return;
    };
    let is_ours = ui.ctx().layer_id_at(at).is_none_or(|layer| layer == ui.layer_id());
    // The other buttons count anywhere on the canvas, the primary one only beside nodes.
    let pressed = [PointerButton::Middle, PointerButton::Secondary].into_iter();
    let mut pressed = pressed.filter(|it| is_ours && ui.input(|input| input.pointer.button_pressed(*it)));
    let dragged = background.drag_started_by(PointerButton::Primary);
    let Some(button) = pressed.next().or(dragged.then_some(PointerButton::Primary)) else {
        return;
    };
    let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
    canvas.gesture = match mouse::meant(habit, Scope::Canvas, modifiers, button) {
        Some(DragAction::Pan) => Gesture::Pan { button },
        Some(DragAction::Zoom) => Gesture::Zoom { around: origin, button },
        Some(DragAction::Cut) => Gesture::Cut { line: vec![origin] },
        Some(DragAction::Lasso) => Gesture::Lasso { line: vec![origin] },
        Some(DragAction::Box) => Gesture::Box {
            from: canvas.view.place(panel, origin),
        },
        Some(DragAction::Orbit | DragAction::Light) | None => Gesture::Idle,
    };
}

/// Handles clicks beside nodes while nothing is dragged.
fn rest(canvas: &mut Canvas, ui: &Ui, background: &Response, panel: Rect, wires: &[Wire], actions: &mut Vec<Action>) {
    let Some(pointer) = background.interact_pointer_pos() else {
        return;
    };
    let modifiers = ui.input(|input| input.modifiers);
    let place = canvas.view.place(panel, pointer);
    if background.double_clicked() {
        if let Some(wire) = wires::under(wires, pointer) {
            let into = wire.to.clone();
            actions.push(Action::edit(WireCommand::Reroute { into, place }));
        }
    } else if background.clicked() {
        match wires::under(wires, pointer) {
            Some(wire) if modifiers.alt => actions.push(Action::edit(WireCommand::Disconnect(vec![wire.to.clone()]))),
            _ => actions.push(Action::Select(Vec::new())),
        }
        canvas.leave_port();
    } else if background.secondary_clicked() && !modifiers.command && !modifiers.alt {
        let into = wires::under(wires, pointer).map(|wire| wire.to.clone());
        let purpose = Purpose {
            place,
            into,
            ..Purpose::default()
        };
        canvas.menu = Some(AddMenu::new(pointer, purpose));
    }
}

/// Scrolls the canvas while a drag is near an edge.
pub(super) fn pull(canvas: &mut Canvas, ui: &Ui, panel: Rect, pointer: Pos2) {
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

fn drop_wire(canvas: &mut Canvas, around: &CanvasContext<'_>, panel: Rect, pointer: Pos2, actions: &mut Vec<Action>) {
    let target = target(canvas, around, panel, pointer);
    let Gesture::Wire { loose, off, .. } = std::mem::take(&mut canvas.gesture) else {
        return;
    };
    match target {
        Some(place) => canvas.tie(around.document, loose, place, off, pointer, actions),
        None => match off {
            Some(slot) => actions.push(Action::edit(WireCommand::Disconnect(vec![slot]))),
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
    /// Connects a wire, or asks how to merge masks where the input has one already.
    pub(super) fn tie(
        &mut self,
        document: &OpenDocument,
        loose: PendingWire,
        place: PortRef,
        off: Option<SlotRef>,
        at: Pos2,
        actions: &mut Vec<Action>,
    ) {
        let Some((from, to)) = ends(&loose, &place) else {
            return;
        };
        let (from, to) = (from.clone(), to.clone());
        if off.as_ref() == Some(&to) {
            return;
        }
        if off.is_none() && sabi_editing::wires::can_merge(document, &from, &to) {
            self.merge = Some(MergeQuestion::new(at, from, to));
        } else {
            actions.push(Action::edit(WireCommand::Connect { from, to, off }));
        }
    }
}

/// Draws the current drag.
pub(super) fn draw(canvas: &Canvas, ui: &Ui, panel: Rect, around: &CanvasContext<'_>) {
    let theme = around.theme;
    let painter = ui.painter();
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    let line = Stroke::new(1.5, theme.accent);
    match &canvas.gesture {
        Gesture::Wire { loose, by_key, .. } => {
            let place = match loose {
                PendingWire::From(from) => PortRef::Output(from.clone()),
                PendingWire::Into(to) => PortRef::Input(to.clone()),
            };
            let Some(tied) = place.on_canvas(around.document) else {
                return;
            };
            let tied = canvas.view.screen(panel, tied);
            let target = match by_key {
                true => canvas.port_place(around.document),
                false => target(canvas, around, panel, pointer),
            };
            let end = target.and_then(|place| place.on_canvas(around.document));
            let end = end.map_or(pointer, |place| canvas.view.screen(panel, place));
            let ends = match loose {
                PendingWire::From(_) => [tied, end],
                PendingWire::Into(_) => [end, tied],
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
