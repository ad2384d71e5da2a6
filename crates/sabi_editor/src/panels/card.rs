//! Cards to choose from: a picture of the model with a name below it.

use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align2, Color32, FontId, Rect, Response, Sense, Stroke, StrokeKind, TextureId, Ui, Vec2, WidgetInfo, WidgetType,
    pos2,
};
use egui_phosphor::regular as icon;

use super::picture_tooltip;
use crate::theme::{Theme, space, type_size};

/// Height of the name below the picture.
const NAME: f32 = 18.0;

/// Size of a card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum CardSize {
    /// Four beside each other in a usual panel.
    #[default]
    Small,
    /// Two beside each other, to compare them.
    Large,
}

impl CardSize {
    /// Width of a card, and height of its picture.
    fn side(self) -> f32 {
        match self {
            CardSize::Small => 84.0,
            CardSize::Large => 148.0,
        }
    }

    /// Switch between the sizes.
    pub(super) fn switch(&mut self, ui: &mut Ui) {
        let is_large = *self == CardSize::Large;
        let switch = ui.add(egui::Button::selectable(is_large, icon::ARROWS_OUT_SIMPLE).small());
        switch.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_large, "Larger pictures"));
        if switch.on_hover_text("Larger pictures, to compare variants").clicked() {
            *self = match self {
                CardSize::Small => CardSize::Large,
                CardSize::Large => CardSize::Small,
            };
        }
    }
}

/// Card of something that can be chosen.
pub(super) struct Card<'a> {
    pub(super) label: &'a str,
    pub(super) picture: Option<TextureId>,
    /// Sign in the place of a picture that is not made yet.
    pub(super) sign: &'a str,
    pub(super) is_shown: bool,
    pub(super) size: CardSize,
}

impl Card<'_> {
    /// Shows the card. While the pointer rests on it, a larger picture with a text is shown beside it.
    pub(super) fn show(&self, ui: &mut Ui, theme: &Theme, text: &str) -> Response {
        let side = self.size.side();
        let (rect, response) = ui.allocate_exact_size(Vec2::new(side, side + NAME), Sense::click());
        response.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, self.is_shown, self.label));
        if ui.is_rect_visible(rect) {
            self.paint(ui, theme, rect, response.hovered() || response.has_focus());
        }
        let picture = || self.picture;
        let picture: Option<&dyn Fn() -> Option<TextureId>> = match self.picture {
            Some(_) => Some(&picture),
            None => None,
        };
        picture_tooltip::show(&response, theme, picture, |ui| {
            ui.strong(self.label);
            ui.label(text);
        });
        response
    }

    fn paint(&self, ui: &Ui, theme: &Theme, rect: Rect, is_hovered: bool) {
        let fill = if is_hovered { theme.hovered } else { theme.raised };
        ui.painter().rect_filled(rect, space::CORNER, fill);
        let square = Rect::from_min_size(rect.min, Vec2::splat(self.size.side())).shrink(3.0);
        match self.picture {
            Some(picture) => {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(picture, square, whole, Color32::WHITE);
            }
            None => {
                let font = FontId::proportional(type_size::TITLE);
                let (at, align) = (square.center(), Align2::CENTER_CENTER);
                ui.painter().text(at, align, self.sign, font, theme.line);
            }
        }
        let room = rect.with_min_y(square.bottom()).shrink2(Vec2::new(4.0, 0.0));
        let color = if self.is_shown { theme.text } else { theme.quiet };
        let font = FontId::proportional(type_size::SMALL);
        let mut job = LayoutJob::simple_singleline(self.label.to_owned(), font, color);
        job.wrap = TextWrapping::truncate_at_width(room.width());
        let name = ui.painter().layout_job(job);
        let at = Align2::CENTER_CENTER.align_size_within_rect(name.size(), room);
        ui.painter().galley(at.min, name, color);
        if self.is_shown {
            let line = Stroke::new(1.5, theme.accent);
            ui.painter().rect_stroke(rect, space::CORNER, line, StrokeKind::Inside);
        }
    }
}
