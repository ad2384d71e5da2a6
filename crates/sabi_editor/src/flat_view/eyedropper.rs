//! Colors taken from the 2D view.

use egui::ecolor::gamma_u8_from_linear_f32;
use egui::{CursorIcon, Rect, Response};
use sabi_engine::live::InspectedResult;
use sabi_graph::PortType;

use super::FlatView;
use crate::action::ClickedColor;

impl FlatView {
    /// Clicked color. Of a material, its base color whatever plane is shown.
    pub(super) fn clicked_color(
        &self,
        response: &Response,
        square: Rect,
        values: &InspectedResult,
    ) -> Option<ClickedColor> {
        response.clone().on_hover_cursor(CursorIcon::Crosshair);
        let at = response.interact_pointer_pos().filter(|_| response.clicked())?;
        let has_color = matches!(values.ty, PortType::Color | PortType::Material);
        let plane = values.planes.first().filter(|plane| has_color && plane.components >= 3);
        let Some(plane) = plane else {
            return Some(Err(
                "The texture has no color; click a node that gives one, then take it.".to_owned(),
            ));
        };
        let Some((_, texel)) = self.texel_at(at, square, values.size) else {
            return Some(Err(
                "There is no texture under the pointer to take a color from.".to_owned()
            ));
        };
        let numbers = plane.values.get(texel * plane.components..)?;
        let code = |at: usize| {
            numbers
                .get(at)
                .map_or(0, |number| gamma_u8_from_linear_f32(number.clamp(0.0, 1.0)))
        };
        Some(Ok([code(0), code(1), code(2)]))
    }
}
