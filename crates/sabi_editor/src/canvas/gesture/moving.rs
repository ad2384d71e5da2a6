//! Drags of nodes, and the wire that a node would be inserted into.

use std::collections::BTreeMap;

use egui::{Key, Pos2, Rect, Response, Ui};
use sabi_editing::command::{ArrangeCommand, FrameCommand, HistoryCommand, WireCommand};
use sabi_editing::node_size::GRID;
use sabi_editing::{OpenDocument, arrangement};
use sabi_graph::{NodeId, SlotRef};

use super::super::wires::{self, Wire};
use super::super::{Canvas, CanvasContext, frame_rects, node_rect};
use super::Gesture;
use crate::action::Action;

impl Gesture {
    /// Wire that the dragged node would be inserted into; while nothing is dragged, the wire under the pointer.
    pub(in crate::canvas) fn highlighted_wire<'w>(
        &self,
        canvas: &Canvas,
        document: &OpenDocument,
        wires: &'w [Wire],
        pointer: Option<Pos2>,
    ) -> Option<&'w SlotRef> {
        let pointer = pointer.filter(|at| canvas.camera.panel.is_some_and(|panel| panel.contains(*at)))?;
        match self {
            Gesture::Idle if !canvas.holds_keys() => wires::under(wires, pointer).map(|wire| &wire.to),
            Gesture::Move {
                from, is_frame: false, ..
            } if from.len() == 1 => {
                let id = from.keys().next()?;
                let rect = canvas
                    .camera
                    .view
                    .screen_rect(canvas.camera.panel?, node_rect(document, id)?);
                // A node is laid on a wire with its middle, or by the place where it is held.
                let distance = |wire: &Wire| wire.distance(rect.center()).min(wire.distance(pointer));
                let is_crossed = |wire: &Wire| {
                    wire.distance(rect.center()) < rect.height().min(60.0) || wire.distance(pointer) < wires::NEAR
                };
                let others = wires.iter().filter(|wire| wire.to.node != *id && wire.from.node != *id);
                let crossing = others
                    .filter(|wire| is_crossed(wire))
                    .min_by(|one, other| distance(one).total_cmp(&distance(other)))?;
                sabi_editing::wires::can_insert(document, id, &crossing.to).then_some(&crossing.to)
            }
            _ => None,
        }
    }
}

/// Begins a drag of a node, together with the selected ones if it is selected.
pub(in crate::canvas) fn begin_move(
    canvas: &mut Canvas,
    id: &NodeId,
    response: &Response,
    context: &CanvasContext<'_>,
    actions: &mut Vec<Action>,
) {
    let (at, modifiers) = response
        .ctx
        .input(|input| (input.pointer.press_origin(), input.modifiers));
    let (Some(panel), Some(at)) = (canvas.camera.panel, at) else {
        return;
    };
    let mut from = arrangement::selected_positions(context.document);
    if !from.contains_key(id) {
        actions.push(Action::Select(vec![id.clone()]));
        let Some(node) = context.document.node(id) else { return };
        from = BTreeMap::from([(id.clone(), node.pos)]);
    }
    actions.push(Action::edit(HistoryCommand::Begin("Move".to_owned())));
    if modifiers.alt {
        actions.push(Action::edit(WireCommand::DetachSelected));
    }
    canvas.gesture = Gesture::Move {
        from,
        origin: canvas.camera.view.place(panel, at),
        is_frame: false,
    };
}

/// Moves the dragged nodes with the pointer.
pub(super) fn drag(
    canvas: &mut Canvas,
    ui: &Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    wires: &[Wire],
    pointer: Pos2,
    actions: &mut Vec<Action>,
) {
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        actions.push(Action::edit(HistoryCommand::Cancel));
        canvas.gesture = Gesture::Idle;
        return;
    }
    canvas.camera.scroll_at_edge(ui, panel, pointer);
    let Gesture::Move { from, origin, is_frame } = &canvas.gesture else {
        return;
    };
    let (is_down, modifiers) = ui.input(|input| (input.pointer.primary_down(), input.modifiers));
    let here = canvas.camera.view.place(panel, pointer);
    let offset = [here[0] - origin[0], here[1] - origin[1]];
    let places = moved(from, offset, modifiers.command);
    actions.push(Action::edit(ArrangeCommand::Move(places)));
    if is_down {
        return;
    }
    let into = canvas
        .gesture
        .highlighted_wire(canvas, context.document, wires, Some(pointer))
        .cloned();
    if let (Some(into), Gesture::Move { from, .. }) = (into, &canvas.gesture)
        && let Some(id) = from.keys().next()
    {
        let node = id.clone();
        actions.push(Action::edit(WireCommand::Insert { node, into }));
    }
    if !is_frame && let Some(frame) = frame_rects::under(&canvas.camera, context.document, pointer) {
        actions.push(Action::edit(FrameCommand::Assign(Some(frame))));
    }
    actions.push(Action::edit(HistoryCommand::End));
    canvas.gesture = Gesture::Idle;
}

/// Places of dragged nodes: the first one is put on the grid, or with `is_free` on whole points, and the others keep their
/// distances to it.
fn moved(from: &BTreeMap<NodeId, [f32; 2]>, offset: [f32; 2], is_free: bool) -> BTreeMap<NodeId, [f32; 2]> {
    let Some(first) = from.values().next() else {
        return BTreeMap::new();
    };
    let snapped = |at: f32| match is_free {
        true => at.round(),
        false => (at / GRID).round() * GRID,
    };
    // In f64, so that the first node is exactly on the grid.
    let offset = [0, 1].map(|axis| f64::from(snapped(first[axis] + offset[axis])) - f64::from(first[axis]));
    let moved = |pos: &[f32; 2]| [0, 1].map(|axis| (f64::from(pos[axis]) + offset[axis]) as f32);
    from.iter().map(|(id, pos)| (id.clone(), moved(pos))).collect()
}
