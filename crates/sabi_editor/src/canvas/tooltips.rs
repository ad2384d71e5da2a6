//! Tooltips of nodes.

use egui::{Rect, RectAlign, Response, Sense, Tooltip, Ui};

use super::CanvasContext;
use super::node_summary::NodeSummary;

/// Width of a tooltip, points.
const WIDEST: f32 = 280.0;

/// Shows the tooltip of a node beside it while the pointer rests over a part of it. A tooltip below the pointer would
/// cover the node.
pub(super) fn show(ui: &Ui, context: &CanvasContext<'_>, shown: &NodeSummary, node: &Response, part: Rect) {
    let part = ui.interact(part, node.id.with("tip"), Sense::hover());
    let mut tooltip = Tooltip::for_enabled(&part);
    tooltip.popup = tooltip
        .popup
        .anchor(node.rect)
        .align(RectAlign::RIGHT_START)
        .align_alternatives(&[RectAlign::LEFT_START]);
    tooltip.show(|ui| {
        ui.set_max_width(WIDEST);
        ui.strong(&shown.title);
        if shown.title != shown.interface.label {
            ui.colored_label(context.theme.quiet, &shown.interface.label);
        }
        ui.label(&shown.interface.summary);
        if let Some(fault) = &shown.state.fault {
            ui.colored_label(context.theme.fault, fault);
        }
        if let Some(waits) = &shown.state.waits {
            ui.colored_label(context.theme.warning, waits);
        }
    });
}
