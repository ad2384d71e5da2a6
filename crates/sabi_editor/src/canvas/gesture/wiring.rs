//! Wires that are dragged: where they begin, the port that they would be dropped at, and the drop.

use egui::{Pos2, Rect, pos2};
use sabi_editing::command::WireCommand;
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, connections, wires};
use sabi_graph::{OutputRef, SlotRef};

use super::super::popups::Popups;
use super::super::port_question::{self, PortChoices, PortQuestion};
use super::super::port_refs::{self, PortRef, ports_of};
use super::super::questions::MergeQuestion;
use super::super::{AddMenu, Canvas, CanvasContext, Purpose, node_rect};
use super::Gesture;
use crate::action::Action;

impl Gesture {
    pub(in crate::canvas) fn wire(pending: PendingWire, off: Option<SlotRef>) -> Gesture {
        Gesture::Wire {
            pending,
            off,
            by_key: false,
        }
    }

    /// Drag that begins at a port: of a new wire or, at a connected input, of its wire.
    pub(in crate::canvas) fn from_port(document: &OpenDocument, place: &PortRef) -> Gesture {
        if let PortRef::Input(slot) = place
            && let Some(from) = connections::wire_into(document, slot)
        {
            return Gesture::wire(PendingWire::From(from.clone()), Some(slot.clone()));
        }
        Gesture::wire(place.pending_wire(), None)
    }

    /// Returns whether the dragged wire may be dropped at a port; `None` if no wire is dragged.
    pub(in crate::canvas) fn accepts(&self, document: &OpenDocument, place: &PortRef) -> Option<bool> {
        let Gesture::Wire { pending, .. } = self else {
            return None;
        };
        Some(ends(pending, place).is_some_and(|(from, to)| wires::check(document, from, to).is_ok()))
    }

    /// Rank of a port among those that accept the dragged wire, lower first: free ports first, then ports of the wire's
    /// type.
    pub(in crate::canvas) fn cost(&self, document: &OpenDocument, place: &PortRef) -> (bool, bool) {
        let Gesture::Wire { pending, .. } = self else {
            return (false, false);
        };
        let Some((from, to)) = ends(pending, place) else {
            return (true, true);
        };
        let is_connected = matches!(place, PortRef::Input(_)) && connections::wire_into(document, to).is_some();
        let converts =
            connections::input(document, to).is_none_or(|port| port.ty != connections::carried(document, from));
        (is_connected, converts)
    }
}

/// Ends of a pending wire that is dropped at a port; `None` where both are inputs or both outputs.
fn ends<'w>(pending: &'w PendingWire, place: &'w PortRef) -> Option<(&'w OutputRef, &'w SlotRef)> {
    match (pending, place) {
        (PendingWire::From(from), PortRef::Input(to)) | (PendingWire::Into(to), PortRef::Output(from)) => {
            Some((from, to))
        }
        _ => None,
    }
}

/// Port that the dragged wire would be dropped at: the nearest port that accepts it, or on a node's body the best one of the
/// node, unless a question is asked there. A free port is better than a connected one, and a port of the wire's type is better than
/// one that converts.
pub(in crate::canvas) fn target(
    canvas: &Canvas,
    context: &CanvasContext<'_>,
    panel: Rect,
    pointer: Pos2,
) -> Option<PortRef> {
    let document = context.document;
    let here = canvas.camera.view.place(panel, pointer);
    let here = pos2(here[0], here[1]);
    let margin = 24.0;
    let mut best: Option<(f32, PortRef)> = None;
    let mut under: Option<((bool, bool), PortRef)> = None;
    for id in document.graph().ids() {
        let Some(rect) = node_rect(document, id).filter(|rect| rect.expand(margin).contains(here)) else {
            continue;
        };
        for (place, _) in ports_of(document, id) {
            if canvas.gesture.accepts(document, &place) != Some(true) {
                continue;
            }
            let Some(at) = place.position(document) else { continue };
            let distance = here.distance(pos2(at[0], at[1]));
            let cost = canvas.gesture.cost(document, &place);
            if rect.contains(here)
                && is_plain(document, &place)
                && under.as_ref().is_none_or(|(least, _)| cost < *least)
            {
                under = Some((cost, place.clone()));
            }
            if distance < margin && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, place));
            }
        }
    }
    let under = under.filter(|_| best.is_none() && choices(canvas, document, panel, pointer).is_none());
    best.map(|(_, place)| place).or(under.map(|(_, place)| place))
}

/// Returns whether a port is not the input for the mask of a parameter.
fn is_plain(document: &OpenDocument, place: &PortRef) -> bool {
    let PortRef::Input(slot) = place else { return true };
    document
        .interface(&slot.node)
        .is_none_or(|interface| interface.param_mask(&slot.name).is_none())
}

/// Inputs to choose from where the dragged wire is dropped on a node.
fn choices(canvas: &Canvas, document: &OpenDocument, panel: Rect, pointer: Pos2) -> Option<PortChoices> {
    let Gesture::Wire {
        pending: PendingWire::From(from),
        ..
    } = &canvas.gesture
    else {
        return None;
    };
    port_question::choices(canvas, document, panel, from, pointer)
}

/// Drops the dragged wire. On a port, connects it, or shows why the port refuses it; on the body of a node, asks which
/// parameter it multiplies; on free space, opens the menu of nodes that fit it. A wire that was taken from an input is
/// disconnected if it is dropped on free space.
pub(super) fn drop_wire(
    canvas: &mut Canvas,
    context: &CanvasContext<'_>,
    panel: Rect,
    pointer: Pos2,
    actions: &mut Vec<Action>,
) {
    let document = context.document;
    let target = target(canvas, context, panel, pointer);
    let aimed = port_refs::at(canvas, document, panel, pointer);
    let choices = choices(canvas, document, panel, pointer);
    let Gesture::Wire { pending, off, .. } = std::mem::take(&mut canvas.gesture) else {
        return;
    };
    if let Some(port) = target {
        return connect(&mut canvas.popups, document, pending, off, &port, pointer, actions);
    }
    if let Some(reason) = aimed.and_then(|port| refusal(document, &pending, &port)) {
        return actions.push(Action::Notice(reason));
    }
    if let (Some(choices), PendingWire::From(from)) = (choices, &pending) {
        canvas.popups.ports = Some(PortQuestion::new(pointer, from.clone(), off, choices));
        return;
    }
    match off {
        Some(slot) => actions.push(Action::edit(WireCommand::Disconnect(vec![slot]))),
        None => {
            let purpose = Purpose {
                place: canvas.camera.view.place(panel, pointer),
                pending: Some(pending),
                ..Purpose::default()
            };
            canvas.popups.menu = Some(AddMenu::new(pointer, purpose));
        }
    }
}

/// Reason why a port refuses a wire; `None` if it accepts the wire, or if both ends would be inputs or outputs.
fn refusal(document: &OpenDocument, pending: &PendingWire, port: &PortRef) -> Option<String> {
    let (from, to) = ends(pending, port)?;
    wires::check(document, from, to).err()
}

/// Connects a wire to a port. `off` is the input from which the wire was taken. If a mask is connected to an input that
/// already has one, a question at a place of the screen asks how to merge them.
pub(in crate::canvas) fn connect(
    popups: &mut Popups,
    document: &OpenDocument,
    pending: PendingWire,
    off: Option<SlotRef>,
    port: &PortRef,
    at: Pos2,
    actions: &mut Vec<Action>,
) {
    let Some((from, to)) = ends(&pending, port) else {
        return;
    };
    let (from, to) = (from.clone(), to.clone());
    if off.as_ref() == Some(&to) {
        return;
    }
    if off.is_none() && wires::can_merge(document, &from, &to) {
        popups.merge = Some(MergeQuestion::new(at, from, to));
    } else {
        actions.push(Action::edit(WireCommand::Connect { from, to, off }));
    }
}
