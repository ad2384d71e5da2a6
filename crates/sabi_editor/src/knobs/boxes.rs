//! Rectangles of widgets.

use egui::{Pos2, Rect, Ui, Vec2};

use crate::theme::space;

/// Width of the column of dots, which is also the left margin.
pub(super) const DOTS: f32 = 12.0;

/// Allocates a rectangle of the whole width below a row.
pub(super) fn strip(ui: &mut Ui, height: f32) -> Rect {
    let (_, rect) = ui.allocate_space(Vec2::new(ui.available_width(), height));
    rect.with_min_x(rect.left() + DOTS)
}

/// One of several equal parts of a rectangle, side by side.
pub(super) fn share_of(rect: Rect, at: usize, count: usize) -> Rect {
    let gap = space::TIGHT / 2.0;
    let width = (rect.width() + gap) / count as f32;
    let left = rect.left() + width * at as f32;
    Rect::from_min_size(Pos2::new(left, rect.top()), Vec2::new(width - gap, rect.height()))
}

/// Cuts a square off the right end of a rectangle.
pub(super) fn cut_square(rect: &mut Rect) -> Rect {
    let square = rect.with_min_x(rect.right() - rect.height());
    rect.max.x = square.left() - space::TIGHT / 2.0;
    square
}
