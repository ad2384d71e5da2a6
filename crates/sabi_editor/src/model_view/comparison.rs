//! Comparison of two results on the model: the line between their pictures.

use egui::{CursorIcon, PointerButton, Pos2, Rect, Response, Ui};

/// Distance at which the line reacts to the pointer, points.
const REACH: f32 = 8.0;

/// Line between the pictures of two results.
#[derive(Default)]
pub(crate) struct Comparison {
    /// Left edge of the pinned result's picture as a share of the width; `None` without a comparison.
    pub(crate) share: Option<f32>,
    /// True if the current drag moves the line.
    is_dragged: bool,
}

impl Comparison {
    /// Puts the line in the middle when a comparison begins, and removes it when the comparison ends.
    pub(super) fn follow(&mut self, is_compared: bool) {
        self.share = is_compared.then(|| self.share.unwrap_or(0.5));
    }

    /// Moves the line by a drag that began on it. Over the line, the cursor shows that it can be dragged. Returns
    /// whether the current drag moves the line.
    pub(super) fn drag(&mut self, ui: &Ui, response: &Response, rect: Rect) -> bool {
        let Some(line) = self.share.map(|share| rect.left() + share * rect.width()) else {
            self.is_dragged = false;
            return false;
        };
        let (origin, at) = ui.input(|input| (input.pointer.press_origin(), input.pointer.latest_pos()));
        let is_near = |at: Option<Pos2>| at.is_some_and(|at| (at.x - line).abs() < REACH);
        if response.drag_started_by(PointerButton::Primary) {
            self.is_dragged = is_near(origin);
        }
        self.is_dragged &= response.dragged_by(PointerButton::Primary);
        if self.is_dragged || !response.dragged() && is_near(response.hover_pos()) {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        if let Some(at) = at.filter(|_| self.is_dragged) {
            self.share = Some(((at.x - rect.left()) / rect.width()).clamp(0.02, 0.98));
        }
        self.is_dragged
    }
}
