//! Text of node files with line numbers, quiet comments and marked errors.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{Align2, FontId, Galley, Sense, TextEdit, Ui, WidgetInfo, WidgetType, pos2, vec2};

use crate::theme::{Theme, space, type_size};
use crate::type_ahead;

/// Width of the line numbers, points.
const NUMBERS: f32 = 30.0;

/// Shows a text that can be selected and copied.
pub(super) fn show(ui: &mut Ui, theme: &Theme, text: &str) {
    egui::ScrollArea::horizontal().show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let numbers = ui.allocate_exact_size(vec2(NUMBERS, 0.0), Sense::hover()).0;
            let galley = laid_out(ui, theme, text, &[]);
            number(ui, theme, &galley, numbers.left_top(), &[]);
            ui.add(egui::Label::new(galley).selectable(true).extend());
        });
    });
}

/// Shows a text that can be edited. Returns whether it was changed.
pub(super) fn edit(ui: &mut Ui, theme: &Theme, text: &mut String, faulty: &[u32]) -> bool {
    let area = egui::ScrollArea::both().auto_shrink(false);
    let shown = area.show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let numbers = ui.allocate_exact_size(vec2(NUMBERS, 0.0), Sense::hover()).0;
            let mut layout = |ui: &Ui, text: &dyn egui::TextBuffer, _: f32| laid_out(ui, theme, text.as_str(), faulty);
            let edit = TextEdit::multiline(text)
                .code_editor()
                .desired_width(f32::INFINITY)
                .desired_rows(12)
                .frame(egui::Frame::NONE)
                .layouter(&mut layout)
                .show(ui);
            type_ahead::mark_multiline(&edit.response.response);
            edit.response
                .response
                .widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Text of the node"));
            let corner = pos2(numbers.left(), edit.galley_pos.y);
            number(ui, theme, &edit.galley, corner, faulty);
            edit.response.response.changed()
        })
        .inner
    });
    shown.inner
}

fn font() -> FontId {
    FontId::monospace(type_size::BODY)
}

/// Layout of the text without line wrapping.
fn laid_out(ui: &Ui, theme: &Theme, text: &str, faulty: &[u32]) -> Arc<Galley> {
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    for (line, number) in text.split_inclusive('\n').zip(1..) {
        let (code, comment) = line.split_at(line.find("//").unwrap_or(line.len()));
        for (part, color) in [(code, theme.text), (comment, theme.quiet)] {
            let mut format = TextFormat::simple(font(), color);
            if faulty.contains(&number) {
                format.background = theme.fault.gamma_multiply(0.25);
            }
            job.append(part, 0.0, format);
        }
    }
    if text.is_empty() {
        // Gives an empty text the height of a line, and with it a caret.
        job.append("", 0.0, TextFormat::simple(font(), theme.text));
    }
    ui.ctx().fonts_mut(|fonts| fonts.layout_job(job))
}

/// Draws the line numbers of a text.
fn number(ui: &Ui, theme: &Theme, galley: &Galley, corner: egui::Pos2, faulty: &[u32]) {
    let right = corner.x + NUMBERS - space::USUAL;
    for (row, number) in galley.rows.iter().zip(1..) {
        let color = if faulty.contains(&number) {
            theme.fault
        } else {
            theme.line
        };
        let at = pos2(right, corner.y + row.rect().center().y);
        ui.painter()
            .text(at, Align2::RIGHT_CENTER, number.to_string(), font(), color);
    }
}
