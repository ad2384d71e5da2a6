//! Reroutes: dots in wires with a port at each end, without a title or a picture.

use egui::{Rect, Response, Stroke, StrokeKind, Ui};
use sabi_graph::OutputRef;

use super::sensing::interact_node;
use super::snapshot::CanvasNodeId;
use super::{Canvas, CanvasContext, node_rect};

/// Draws a reroute.
pub(super) fn show(
    canvas: &Canvas,
    ui: &Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    key: CanvasNodeId,
) -> Option<Response> {
    let shown = &canvas.snapshot.graph[key].user_data;
    let rect = canvas
        .camera
        .view
        .screen_rect(panel, node_rect(context.document, &shown.id)?);
    let response = interact_node(ui, key, rect);
    let theme = context.theme;
    let passed = OutputRef {
        node: shown.id.clone(),
        port: None,
    };
    let color = theme.port(context.document.interfaces().carried(&context.document.body(), &passed));
    let outline = match (context.document.selection().contains(&shown.id), &shown.state.fault) {
        (true, _) => Stroke::new(2.0, theme.accent),
        (false, Some(_)) => Stroke::new(1.5, theme.fault),
        (false, None) => Stroke::new(1.0, color),
    };
    let fill = if response.hovered() {
        theme.hovered
    } else {
        theme.raised
    };
    let radius = rect.height() / 2.0;
    ui.painter().rect(rect, radius, fill, outline, StrokeKind::Inside);
    ui.painter().circle_filled(rect.center(), radius * 0.4, color);
    Some(response)
}
