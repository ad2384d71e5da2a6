//! Cards to choose from: a picture of the model with a name below it.

use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align2, Color32, FontId, Rect, Response, Sense, Stroke, StrokeKind, TextureId, Ui, Vec2, WidgetInfo, WidgetType,
    pos2,
};

use crate::theme::{Theme, space, type_size};

/// Width of a card, and height of its picture.
const SIDE: f32 = 84.0;
/// Height of the name below it.
const NAME: f32 = 18.0;

/// Card of something that can be chosen.
pub(super) struct Card<'a> {
    pub(super) label: &'a str,
    pub(super) picture: Option<TextureId>,
    /// Sign in the place of a picture that is not made yet.
    pub(super) sign: &'a str,
    pub(super) is_shown: bool,
}

impl Card<'_> {
    pub(super) fn show(&self, ui: &mut Ui, theme: &Theme) -> Response {
        let (rect, response) = ui.allocate_exact_size(Vec2::new(SIDE, SIDE + NAME), Sense::click());
        response.widget_info(|| WidgetInfo::selected(WidgetType::Button, true, self.is_shown, self.label));
        if ui.is_rect_visible(rect) {
            self.paint(ui, theme, rect, response.hovered() || response.has_focus());
        }
        response
    }

    fn paint(&self, ui: &Ui, theme: &Theme, rect: Rect, is_hovered: bool) {
        let fill = if is_hovered { theme.hovered } else { theme.raised };
        ui.painter().rect_filled(rect, space::CORNER, fill);
        let square = Rect::from_min_size(rect.min, Vec2::splat(SIDE)).shrink(3.0);
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
