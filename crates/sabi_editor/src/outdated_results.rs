//! Cover over results that still are of the previous model, and the buttons that cancel the reading of a model.

use egui::{Align2, Button, FontId, Painter, Rect, Ui, Vec2, WidgetInfo, WidgetType, vec2};

use crate::action::{Action, ModelAction};
use crate::activity_text::activity_text;
use crate::evaluation::Evaluation;
use crate::files::examples;
use crate::paths::file_stem;
use crate::theme::{Theme, type_size};

/// Opacity of the cover.
const COVER: f32 = 0.7;

/// Distance from the middle of a result to the button that cancels, in points.
const BUTTON_BELOW: f32 = 36.0;
/// Size of that button, points.
const BUTTON: Vec2 = vec2(90.0, 24.0);

/// Covers a result while its model is being replaced, with a button that keeps the previous model.
pub(crate) fn cover_with_cancel(ui: &mut Ui, rect: Rect, evaluation: &Evaluation, theme: &Theme) -> Option<Action> {
    cover(&ui.painter_at(rect), rect, evaluation, theme);
    let button = || cancel(ui, rect, "Keep the model that was there before");
    evaluation.model.is_replacing().then(button)?
}

/// Shows a button that cancels the reading of the first model, in place of which a small one is shown.
pub(crate) fn cancel_first(ui: &mut Ui, rect: Rect, evaluation: &Evaluation) -> Option<Action> {
    let model = &evaluation.model;
    let is_left = model.is_first() && !examples::is_own_model(model.file());
    is_left.then(|| cancel(ui, rect, "Show a small model instead"))?
}

fn cancel(ui: &mut Ui, rect: Rect, tooltip: &str) -> Option<Action> {
    let place = Rect::from_center_size(rect.center() + vec2(0.0, BUTTON_BELOW), BUTTON);
    let button = ui.put(place, Button::new("Cancel")).on_hover_text(tooltip);
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Cancel reading the model"));
    button.clicked().then_some(Action::Model(ModelAction::CancelReading))
}

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
