//! The stencil: a picture over the view, through which strokes are painted.

use egui::{Slider, Ui};
use egui_phosphor::regular as icon;
use sabi_paint::PicturePart;

use super::choice;
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;
use crate::settings::stencil::SIZES;

/// Shows the choices for the stencil.
pub(super) fn show(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    let chosen = &context.settings.stencil;
    let mut stencil = chosen.clone();
    if ui
        .button(format!("{} A picture to paint through…", icon::IMAGE))
        .clicked()
    {
        actions.push(Action::Paint(PaintAction::AskForStencil));
    }
    let brush = context.settings.brush.picture.as_ref();
    let has_picture = stencil.picture.is_some();
    if let Some(own) = brush.filter(|own| stencil.picture.as_ref() != Some(*own)) {
        let button = ui.button("The picture of the brush");
        if button
            .on_hover_text("Paint through the picture that the brush stamps")
            .clicked()
        {
            stencil = crate::settings::stencil::StencilChoices::with_picture(own.clone());
        }
    }
    ui.add_enabled_ui(has_picture, |ui| {
        ui.checkbox(&mut stencil.is_used, "Paint through it")
            .on_hover_text("Strokes in the viewport leave what the picture over it lets through");
    });
    if let Some(tip) = &mut stencil.picture {
        ui.horizontal(|ui| choice(ui, "Lets through", &mut tip.part, &PicturePart::ALL));
        ui.add(Slider::new(&mut stencil.size, SIZES).logarithmic(true).text("Width"))
            .on_hover_text("Half of its longer side, in halves of the height of the view. Drag its right handle");
        let turn = Slider::new(&mut stencil.angle_degrees, -180.0..=180.0).suffix("°");
        ui.add(turn.text("Tilt"))
            .on_hover_text("Turn counter-clockwise. Drag its right handle");
        if ui.button("To the middle").clicked() {
            stencil = stencil.centered();
        }
    }
    if stencil != *chosen {
        actions.push(Action::Paint(PaintAction::ChooseStencil(Box::new(stencil))));
    }
    actions
}
