//! Tooltips of nodes.

use egui::{Rect, Response, Sense, Ui};

use super::CanvasContext;
use super::node_summary::NodeSummary;

/// Width of a tooltip, points.
const WIDEST: f32 = 280.0;

/// Shows the tooltip of a node over a part of it.
pub(super) fn show(ui: &Ui, context: &CanvasContext<'_>, shown: &NodeSummary, node: &Response, part: Rect) {
    let part = ui.interact(part, node.id.with("tip"), Sense::hover());
    part.on_hover_ui(|ui| {
        ui.set_max_width(WIDEST);
        ui.strong(&shown.title);
        if shown.title != shown.face.label {
            ui.colored_label(context.theme.quiet, &shown.face.label);
        }
        ui.label(&shown.face.summary);
        if let Some(fault) = &shown.state.fault {
            ui.colored_label(context.theme.fault, fault);
        }
        if let Some(waits) = &shown.state.waits {
            ui.colored_label(context.theme.warning, waits);
        }
    });
}
