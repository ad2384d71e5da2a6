//! Text in rectangles, cut off at their ends.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, FontId, Painter, Rect};

/// Writes a line into a rectangle. Returns its width.
pub(super) fn write(painter: &Painter, within: Rect, align: Align2, text: &str, size: f32, color: Color32) -> f32 {
    if text.is_empty() || within.width() <= 0.0 {
        return 0.0;
    }
    let mut job = LayoutJob::simple_singleline(text.to_owned(), FontId::proportional(size), color);
    job.wrap = TextWrapping::truncate_at_width(within.width());
    let galley = painter.layout_job(job);
    let placed = align.align_size_within_rect(galley.size(), within);
    painter.galley(placed.min, galley, color);
    placed.width()
}

/// Width of a line.
pub(super) fn width(painter: &Painter, text: &str, size: f32) -> f32 {
    let font = FontId::proportional(size);
    painter
        .layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER)
        .size()
        .x
}
