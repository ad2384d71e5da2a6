//! Wires that are dragged: where they begin and where they would be dropped.

use egui::{Pos2, Rect, pos2};
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, connections};

use super::super::port_refs::{PortRef, places};
use super::super::{Canvas, CanvasContext, node_rect};
use super::Gesture;

impl Gesture {
    /// Drag that begins at a port: of a wire from it or, at an input that has one, of that wire.
    pub(in crate::canvas) fn taken_at(document: &OpenDocument, place: &PortRef) -> Gesture {
        if let PortRef::Input(slot) = place
            && let Some(from) = connections::wire_into(document, slot)
        {
            return Gesture::wire(PendingWire::From(from.clone()), Some(slot.clone()));
        }
        Gesture::wire(place.loose(), None)
    }
}

/// Port that the dragged wire would be dropped at: the nearest that takes it, or on a node's body the first that does. A free
/// port goes before one that has a wire, and one of the wire's type before one that converts.
pub(in crate::canvas) fn target(
    canvas: &Canvas,
    around: &CanvasContext<'_>,
    panel: Rect,
    pointer: Pos2,
) -> Option<PortRef> {
    let document = around.document;
    let here = canvas.view.place(panel, pointer);
    let here = pos2(here[0], here[1]);
    let margin = 24.0;
    let mut best: Option<(f32, PortRef)> = None;
    let mut under: Option<((bool, bool), PortRef)> = None;
    for id in document.graph().ids() {
        let Some(rect) = node_rect(document, id).filter(|rect| rect.expand(margin).contains(here)) else {
            continue;
        };
        for (place, _) in places(document, id) {
            if canvas.gesture.takes(document, &place) != Some(true) {
                continue;
            }
            let Some(at) = place.on_canvas(document) else { continue };
            let distance = here.distance(pos2(at[0], at[1]));
            let cost = canvas.gesture.cost(document, &place);
            if rect.contains(here) && under.as_ref().is_none_or(|(least, _)| cost < *least) {
                under = Some((cost, place.clone()));
            }
            if distance < margin && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, place));
            }
        }
    }
    best.map(|(_, place)| place).or(under.map(|(_, place)| place))
}
