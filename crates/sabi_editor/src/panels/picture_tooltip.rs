//! Enlarged pictures beside the widget that the pointer rests on.

use egui::epaint::RectShape;
use egui::{Color32, Rect, RectAlign, Response, Sense, TextureId, Tooltip, Ui, Vec2, pos2};

use crate::theme::{Theme, space};

/// Side of the picture.
const SIDE: f32 = 192.0;

/// Shows a large picture beside a widget while the pointer rests on it, with texts below. The place of a picture that
/// is not ready is left free; without `picture`, only the texts are shown.
pub(super) fn show(
    response: &Response,
    theme: &Theme,
    picture: Option<&dyn Fn() -> Option<TextureId>>,
    texts: impl FnOnce(&mut Ui),
) {
    let mut tooltip = Tooltip::for_enabled(response).gap(space::USUAL).width(SIDE);
    tooltip.popup = tooltip.popup.align(RectAlign::LEFT_START);
    tooltip.popup =
        tooltip
            .popup
            .align_alternatives(&[RectAlign::RIGHT_START, RectAlign::LEFT_END, RectAlign::RIGHT_END]);
    tooltip.show(|ui| {
        ui.set_width(SIDE);
        if let Some(picture) = picture {
            let (rect, _) = ui.allocate_exact_size(Vec2::splat(SIDE), Sense::hover());
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().add(match picture() {
                Some(picture) => RectShape::filled(rect, space::CORNER, Color32::WHITE).with_texture(picture, whole),
                None => RectShape::filled(rect, space::CORNER, theme.raised),
            });
        }
        texts(ui);
    });
}
