//! Drags on the canvas: of nodes, wires, selections, cuts and the view itself.

mod marking;
mod moving;
mod wiring;

use std::collections::BTreeMap;

use egui::{CursorIcon, Event, PointerButton, Pos2, Rect, Response, Shape, Stroke, Ui};
use sabi_editing::command::WireCommand;
use sabi_editing::connections::PendingWire;
use sabi_graph::{NodeId, SlotRef};

use super::port_refs::{self, PortRef};
use super::wires::{self, Wire};
use super::{AddMenu, Canvas, CanvasContext, Purpose};
use crate::action::Action;
use crate::command::{InputPreset, Scope};
use crate::mouse::{self, DragAction};
use marking::{end_box, end_line};
pub(super) use moving::begin_move;
use moving::drag;
pub(super) use wiring::connect;
use wiring::{drop_wire, target};

/// Least distance between a press and a release in one frame that count as a drag, screen points.
const FLICK: f32 = 12.0;

/// Current drag.
#[derive(Clone, Debug, Default)]
pub(super) enum Gesture {
    /// No drag.
    #[default]
    Idle,
    /// Drag of the view, by a button.
    Pan { button: PointerButton },
    /// Drag of the zoom, by a button: up is larger.
    Zoom { center: Pos2, button: PointerButton },
    /// Drag of nodes: their positions before it, and the place on the canvas where it began.
    Move {
        from: BTreeMap<NodeId, [f32; 2]>,
        origin: [f32; 2],
        /// True if a whole frame is dragged, which cannot be inserted into a wire or another frame.
        is_frame: bool,
    },
    /// Drag of a wire that is connected at one end; `off` is the input that it was disconnected from.
    Wire {
        pending: PendingWire,
        off: Option<SlotRef>,
        /// True if the drag was started by a key, and follows the keyboard focus instead of the pointer.
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
    /// Returns whether the current cut crosses a wire.
    pub(super) fn cuts(&self, wire: &Wire) -> bool {
        let Gesture::Cut { line } = self else {
            return false;
        };
        line.windows(2).any(|piece| wire.is_crossed([piece[0], piece[1]]))
    }
}

/// Continues the current drag, or begins one.
pub(super) fn advance(
    canvas: &mut Canvas,
    ui: &Ui,
    background: &Response,
    context: &CanvasContext<'_>,
    wires: &[Wire],
    actions: &mut Vec<Action>,
) {
    let Some(panel) = canvas.camera.panel else { return };
    if flick(canvas, ui, context, panel, actions) {
        return;
    }
    begin(canvas, ui, background, panel, context.preset);
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let Some(pointer) = pointer else { return };
    let (delta, modifiers) = ui.input(|input| (input.pointer.delta(), input.modifiers));
    let is_down = |button| ui.input(|input| input.pointer.button_down(button));
    match &mut canvas.gesture {
        Gesture::Idle => click(canvas, ui, background, panel, wires, actions),
        Gesture::Pan { button } => {
            let button = *button;
            canvas.camera.view.pan += delta;
            ui.set_cursor_icon(CursorIcon::Grabbing);
            if !is_down(button) {
                canvas.gesture = Gesture::Idle;
            }
        }
        Gesture::Zoom { center, button } => {
            let (center, button) = (*center, *button);
            canvas.camera.view.zoom_at(panel, center, (-delta.y * 0.01).exp());
            if !is_down(button) {
                canvas.gesture = Gesture::Idle;
            }
        }
        Gesture::Move { .. } => drag(canvas, ui, panel, context, wires, pointer, actions),
        Gesture::Wire { by_key: true, .. } => {}
        Gesture::Wire { .. } => {
            canvas.camera.scroll_at_edge(ui, panel, pointer);
            if !is_down(PointerButton::Primary) {
                drop_wire(canvas, context, panel, pointer, actions);
            }
        }
        Gesture::Box { .. } => {
            canvas.camera.scroll_at_edge(ui, panel, pointer);
            if !is_down(PointerButton::Primary) {
                end_box(canvas, context, panel, pointer, modifiers, actions);
            }
        }
        Gesture::Lasso { line } | Gesture::Cut { line } => {
            if line.last().is_none_or(|last| last.distance(pointer) > 3.0) {
                line.push(pointer);
            }
            if !is_down(PointerButton::Primary) && !is_down(PointerButton::Secondary) {
                end_line(canvas, context, panel, wires, modifiers, actions);
            }
        }
    }
}

/// Connects a wire that was pressed and released within one frame, as happens where frames take long.
fn flick(canvas: &mut Canvas, ui: &Ui, context: &CanvasContext<'_>, panel: Rect, actions: &mut Vec<Action>) -> bool {
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
    let Some(place) = port_refs::at(canvas, context.document, panel, from).filter(|_| is_ours) else {
        return false;
    };
    canvas.gesture = Gesture::from_port(context.document, &place);
    drop_wire(canvas, context, panel, to, actions);
    true
}

/// Begins a drag of the view, a selection or a cut.
fn begin(canvas: &mut Canvas, ui: &Ui, background: &Response, panel: Rect, preset: InputPreset) {
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
    canvas.gesture = match mouse::action_of(preset, Scope::Canvas, modifiers, button) {
        Some(DragAction::Pan) => Gesture::Pan { button },
        Some(DragAction::Zoom) => Gesture::Zoom { center: origin, button },
        Some(DragAction::Cut) => Gesture::Cut { line: vec![origin] },
        Some(DragAction::Lasso) => Gesture::Lasso { line: vec![origin] },
        Some(DragAction::Box) => Gesture::Box {
            from: canvas.camera.view.place(panel, origin),
        },
        Some(DragAction::Orbit | DragAction::Light) | None => Gesture::Idle,
    };
}

/// Handles clicks beside nodes while nothing is dragged.
fn click(canvas: &mut Canvas, ui: &Ui, background: &Response, panel: Rect, wires: &[Wire], actions: &mut Vec<Action>) {
    let Some(pointer) = background.interact_pointer_pos() else {
        return;
    };
    let modifiers = ui.input(|input| input.modifiers);
    let place = canvas.camera.view.place(panel, pointer);
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
        canvas.focus.clear();
    } else if background.secondary_clicked() && !modifiers.command && !modifiers.alt {
        let into = wires::under(wires, pointer).map(|wire| wire.to.clone());
        let purpose = Purpose {
            place,
            into,
            ..Purpose::default()
        };
        canvas.popups.menu = Some(AddMenu::new(pointer, purpose));
    }
}

/// Draws the current drag.
pub(super) fn draw(canvas: &Canvas, ui: &Ui, panel: Rect, context: &CanvasContext<'_>) {
    let theme = context.theme;
    let painter = ui.painter();
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    let line = Stroke::new(1.5, theme.accent);
    match &canvas.gesture {
        Gesture::Wire { pending, by_key, .. } => {
            let place = match pending {
                PendingWire::From(from) => PortRef::Output(from.clone()),
                PendingWire::Into(to) => PortRef::Input(to.clone()),
            };
            let Some(fixed) = place.position(context.document) else {
                return;
            };
            let fixed = canvas.camera.view.screen(panel, fixed);
            let target = match by_key {
                true => canvas.focus.port(context.document),
                false => target(canvas, context, panel, pointer),
            };
            let end = target.and_then(|place| place.position(context.document));
            let end = end.map_or(pointer, |place| canvas.camera.view.screen(panel, place));
            let ends = match pending {
                PendingWire::From(_) => [fixed, end],
                PendingWire::Into(_) => [end, fixed],
            };
            wires::draw_curve(painter, wires::curve(ends, canvas.camera.view.zoom), theme.accent, 2.5);
        }
        Gesture::Box { from } => {
            let rect = Rect::from_two_pos(canvas.camera.view.screen(panel, *from), pointer);
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
