//! Cover over results that are still of the model before.

use egui::{Align2, FontId, Painter, Rect};

use crate::activity_text::activity_text;
use crate::evaluation::Evaluation;
use crate::paths::file_stem;
use crate::theme::{Theme, type_size};

/// Opacity of the cover.
const COVER: f32 = 0.7;

/// Dims a result, and says which model is awaited and what is being done.
pub(crate) fn cover(painter: &Painter, rect: Rect, evaluation: &Evaluation, theme: &Theme) {
    painter.rect_filled(rect, 0.0, theme.background.gamma_multiply(COVER));
    let model = file_stem(evaluation.model.file());
    let doing = evaluation.activity().map(|activity| activity_text(&activity));
    let text = match doing {
        Some(doing) => format!("{model}\n{doing}"),
        None => model.into_owned(),
    };
    let font = FontId::proportional(type_size::BODY);
    painter.text(rect.center(), Align2::CENTER_CENTER, text, font, theme.text);
}
