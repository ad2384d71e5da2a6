//! Sentences below rows.

use egui::{Color32, FontId, Id, Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, WidgetType};

use crate::theme::type_size;

/// Draws a sentence below a row, and makes room for it.
pub(super) fn sentence(ui: &mut Ui, id: Id, left: f32, text: &str, color: Color32) {
    let right = ui.max_rect().right();
    let font = FontId::proportional(type_size::SMALL);
    let galley = ui
        .painter()
        .layout(text.to_owned(), font, color, (right - left).max(40.0));
    let (_, rect) = ui.allocate_space(Vec2::new(ui.available_width(), galley.size().y));
    let place = Pos2::new(left, rect.top());
    let response = ui.interact(Rect::from_min_size(place, galley.size()), id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, text));
    ui.painter().galley(place, galley, color);
}
