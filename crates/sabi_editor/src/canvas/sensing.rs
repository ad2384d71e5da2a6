//! Ids and rectangles under which whole nodes react to the pointer.

use egui::{Id, Rect, Response, Sense, Ui};

use super::snapshot::CanvasNodeId;

/// Id under which the canvas crate's widget senses clicks and drags of a whole node.
pub(super) fn window_id(ui: &Ui, key: CanvasNodeId) -> Id {
    ui.id().with(key).with((key, "window"))
}

/// Response of a whole node that has no widget of the canvas crate: a card or a reroute.
pub(super) fn interact_node(ui: &Ui, key: CanvasNodeId, rect: Rect) -> Response {
    ui.interact(rect, window_id(ui, key), Sense::click_and_drag())
}
