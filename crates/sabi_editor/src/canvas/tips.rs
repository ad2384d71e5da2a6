//! What is said of a node to those who point at it.

use egui::{Rect, Response, Sense, Ui};

use super::Around;
use super::shown::NodeSummary;

/// Widest line of it.
const WIDEST: f32 = 280.0;

/// Says what a node is and what is wrong with it over a part of it.
pub(super) fn show(ui: &Ui, around: &Around<'_>, shown: &NodeSummary, node: &Response, part: Rect) {
    let part = ui.interact(part, node.id.with("tip"), Sense::hover());
    part.on_hover_ui(|ui| {
        ui.set_max_width(WIDEST);
        ui.strong(&shown.title);
        if shown.title != shown.face.label {
            ui.colored_label(around.theme.quiet, &shown.face.label);
        }
        ui.label(&shown.face.summary);
        if let Some(fault) = &shown.state.fault {
            ui.colored_label(around.theme.fault, fault);
        }
        if let Some(waits) = &shown.state.waits {
            ui.colored_label(around.theme.warning, waits);
        }
    });
}
