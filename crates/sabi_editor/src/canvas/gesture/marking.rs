//! Ends of selections in a box or a line, and of cuts.

use egui::{Modifiers, Pos2, Rect, pos2};
use sabi_editing::command::WireCommand;
use sabi_graph::{NodeId, SlotRef};

use super::super::wires::Wire;
use super::super::{Canvas, CanvasContext, node_rect};
use super::Gesture;
use crate::action::Action;

pub(super) fn end_box(
    canvas: &mut Canvas,
    context: &CanvasContext<'_>,
    panel: Rect,
    pointer: Pos2,
    modifiers: Modifiers,
    actions: &mut Vec<Action>,
) {
    let Gesture::Box { from } = std::mem::take(&mut canvas.gesture) else {
        return;
    };
    let to = canvas.camera.view.place(panel, pointer);
    let taken = Rect::from_two_pos(pos2(from[0], from[1]), pos2(to[0], to[1]));
    select(context, modifiers, actions, |rect| taken.intersects(rect));
}

/// Selects the nodes inside; with Shift or Ctrl, in addition to the selection.
fn select(context: &CanvasContext<'_>, modifiers: Modifiers, actions: &mut Vec<Action>, is_in: impl Fn(Rect) -> bool) {
    let document = context.document;
    let inside = document
        .graph()
        .ids()
        .filter(|id| node_rect(document, id).is_some_and(&is_in));
    let mut ids: Vec<NodeId> = inside.cloned().collect();
    if modifiers.shift || modifiers.command {
        ids.extend(document.selection().iter().cloned());
    }
    actions.push(Action::Select(ids));
}

pub(super) fn end_line(
    canvas: &mut Canvas,
    context: &CanvasContext<'_>,
    panel: Rect,
    wires: &[Wire],
    modifiers: Modifiers,
    actions: &mut Vec<Action>,
) {
    let gesture = std::mem::take(&mut canvas.gesture);
    if let Gesture::Lasso { line } = &gesture {
        let view = canvas.camera.view;
        let modifiers = Modifiers {
            alt: false,
            ..modifiers
        };
        select(context, modifiers, actions, |rect| {
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
        actions.push(Action::edit(WireCommand::Disconnect(cut)));
    }
}

/// Returns whether a position is inside a closed line: a ray from it crosses the line an odd number of times.
fn is_inside(line: &[Pos2], place: Pos2) -> bool {
    let closed = line.iter().zip(line.iter().cycle().skip(1));
    let crossings = closed.filter(|(one, other)| {
        let spans = (one.y > place.y) != (other.y > place.y);
        spans && place.x < one.x + (place.y - one.y) / (other.y - one.y) * (other.x - one.x)
    });
    crossings.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasso_contains_the_places_that_it_encloses() {
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
