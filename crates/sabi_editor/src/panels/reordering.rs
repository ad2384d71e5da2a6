//! Rows that are reordered by dragging, with a line where the dragged one would be inserted.

use std::any::Any;
use std::sync::Arc;

use egui::{Align2, Area, DragAndDrop, Frame, Id, Order, Rect, Stroke, Ui, vec2};

use crate::theme::Theme;

/// Distance outside of a list at which it accepts a dropped row, points.
const NEAR: f32 = 12.0;

/// Shows the dragged row and the line where it would be inserted. Once it is dropped, returns it and the index of the row
/// that it goes before. `title` gives its title, or `None` if it belongs to another list.
pub(crate) fn dropped<P: Any + Send + Sync>(
    ui: &Ui,
    theme: &Theme,
    rows: &[Rect],
    title: impl FnOnce(&P) -> Option<String>,
) -> Option<(Arc<P>, usize)> {
    let payload = DragAndDrop::payload::<P>(ui.ctx())?;
    let at = ui.input(|input| input.pointer.interact_pos())?;
    let title = title(&payload)?;
    ghost(ui, at, &title);
    let all = rows.iter().fold(Rect::NOTHING, |all, row| all.union(*row));
    if !all.expand(NEAR).contains(at) {
        return None;
    }
    let gap = rows.iter().filter(|row| row.center().y < at.y).count();
    let between = ui.spacing().item_spacing.y / 2.0;
    let y = match (rows.get(gap), rows.last()) {
        (Some(next), _) => next.top() - between,
        (None, Some(last)) => last.bottom() + between,
        (None, None) => return None,
    };
    let stroke = Stroke::new(2.0, theme.accent);
    ui.painter().hline(all.x_range(), y, stroke);
    ui.painter().circle(egui::pos2(all.left(), y), 3.5, theme.panel, stroke);
    let is_released = ui.input(|input| input.pointer.any_released());
    is_released.then_some((payload, gap))
}

/// Shows the title of the dragged row beside the pointer.
pub(crate) fn ghost(ui: &Ui, at: egui::Pos2, title: &str) {
    ui.set_cursor_icon(egui::CursorIcon::Grabbing);
    Area::new(Id::new("what is dragged"))
        .order(Order::Tooltip)
        .interactable(false)
        .pivot(Align2::LEFT_CENTER)
        .fixed_pos(at + vec2(14.0, 0.0))
        .show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| ui.label(title));
        });
}
