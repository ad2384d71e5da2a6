//! Nodes at a low zoom: cards with a picture, a color and, while it can be read, a name.

use egui::{Align2, CornerRadius, FontId, Rect, Response, Ui};
use egui_phosphor::regular as icon;

use super::sensing::interact_node;
use super::snapshot::CanvasNodeId;
use super::{Canvas, CanvasContext, body, node_rect};
use crate::theme::space;

/// Smallest size of names, screen points.
const LEAST_LETTERS: f32 = 8.0;
/// Size of names, canvas points.
const LETTERS: f32 = 26.0;
/// Least width of a card with a name, screen points.
const LEAST_WIDTH: f32 = 26.0;

/// Draws a node as a card.
pub(super) fn show(
    canvas: &Canvas,
    ui: &Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    key: CanvasNodeId,
) -> Option<Response> {
    let shown = &canvas.snapshot.graph[key].user_data;
    let zoom = canvas.camera.view.zoom;
    let rect = canvas
        .camera
        .view
        .screen_rect(panel, node_rect(context.document, &shown.id)?);
    let response = interact_node(ui, key, rect);
    let theme = context.theme;
    let is_selected = context.document.selection().contains(&shown.id);
    ui.painter().add(body::backdrop(theme, shown, rect, zoom, is_selected));
    // Names stay readable as long as a few letters fit.
    let letters = (LETTERS * zoom).max(LEAST_LETTERS);
    let has_name = rect.width() >= LEAST_WIDTH;
    let mut inside = rect.shrink(4.0 * zoom);
    if has_name {
        let strip = Rect::from_min_max(rect.min, egui::pos2(rect.max.x, rect.min.y + letters * 1.5));
        let corner = CornerRadius::same(space::CORNER);
        ui.painter()
            .rect_filled(strip, corner, theme.category(shown.interface.category()));
        let font = FontId::proportional(letters.round());
        let name = body::elided(ui, &shown.title, font, strip.width() - 8.0 * zoom, theme.text);
        let at = Align2::LEFT_CENTER.anchor_size(strip.left_center() + egui::vec2(5.0 * zoom, 0.0), name.size());
        ui.painter().galley(at.min, name, theme.text);
        inside.min.y = strip.max.y;
    }
    let side = inside.width().min(inside.height());
    let state = &shown.state;
    let badge = state.fault.as_ref().map(|_| theme.fault);
    if let Some(color) = badge.or(state.waits.as_ref().map(|_| theme.warning)) {
        let font = FontId::proportional((side * 0.5).round().max(LEAST_LETTERS));
        let at = inside.center();
        ui.painter().text(at, Align2::CENTER_CENTER, icon::WARNING, font, color);
    } else if shown.state.picture.is_some() && side > 6.0 {
        let square = Rect::from_center_size(inside.center(), egui::Vec2::splat(side));
        body::picture(ui, theme, shown, square, zoom);
    }
    if shown.is_pinned {
        let font = FontId::proportional(letters.max(LEAST_LETTERS).round());
        let at = inside.right_top();
        ui.painter()
            .text(at, Align2::RIGHT_TOP, icon::PUSH_PIN, font, theme.accent);
    }
    Some(response)
}
