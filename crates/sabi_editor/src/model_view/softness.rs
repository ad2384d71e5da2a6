//! Check whether the view is soft because the maps have fewer texels than the view has pixels.

use std::sync::{Arc, Weak};

use egui::{Align2, CursorIcon, FontId, Rect, Response, Sense, Stroke, Ui, WidgetInfo, WidgetType, vec2};
use sabi_editing::command::DocumentCommand;
use sabi_engine::live::LiveModel;
use sabi_engine::rendering::Softness;
use sabi_view::Camera;

use super::{ModelView, Subject, subject_menus};
use crate::action::Action;
use crate::bars::LARGEST_SIZE;
use crate::evaluation::Evaluation;
use crate::theme::{Theme, space, type_size};

/// Softness of the last view at rest: found again for another camera, size or model.
#[derive(Default)]
pub(super) struct SoftnessCache {
    of: Option<(Weak<LiveModel>, Camera, [u32; 2])>,
    found: Option<Softness>,
}

impl SoftnessCache {
    fn of(&mut self, model: &Arc<LiveModel>, camera: Camera, pixels: [u32; 2]) -> Option<Softness> {
        let known = self.of.as_ref();
        let is_same = known.is_some_and(|(known, of_camera, of_pixels)| {
            known.ptr_eq(&Arc::downgrade(model)) && *of_camera == camera && *of_pixels == pixels
        });
        if !is_same {
            self.of = Some((Arc::downgrade(model), camera, pixels));
            self.found = Softness::of_view(&model.linked.model.mesh, &camera, pixels, model.size);
        }
        self.found
    }
}

/// Says in the corner of the view that it is soft, and offers a size that is not.
pub(super) fn show(
    view: &mut ModelView,
    ui: &mut Ui,
    rect: Rect,
    evaluation: &Evaluation,
    subject: &Subject<'_>,
    actions: &mut Vec<Action>,
) {
    // A coarse picture is soft for a moment only; a length is drawn in the same corner.
    let full = evaluation.model.size();
    let model = evaluation.results.picture(subject.shown).map(|picture| &picture.model);
    let Some(model) = model.filter(|model| model.size == full && view.length.is_none()) else {
        return;
    };
    if view.navigation.is_moving() || subject.is_moving {
        return;
    }
    let pixels = [rect.width(), rect.height()].map(|side| (side * ui.pixels_per_point()).round().max(1.0) as u32);
    let Some(softness) = view.softness.of(model, view.navigation.camera, pixels) else {
        return;
    };
    let wide = softness.texel_pixels;
    let text = match softness.enough {
        Some(enough) if enough <= LARGEST_SIZE => format!("Soft: a texel is {wide:.1} pixels wide"),
        Some(enough) => format!("Soft: a texel is {wide:.1} pixels wide; an export at {enough} texels is sharp"),
        None => format!("Soft from so near: a texel is {wide:.1} pixels wide"),
    };
    let place = subject_menus::CaptionPlace {
        at: rect.left_bottom() + vec2(10.0, -10.0),
        align: Align2::LEFT_CENTER,
        within: rect.shrink(space::TIGHT),
    };
    let caption = view.captions.write(ui, subject.theme, "softness", &place, &text);
    let Some(enough) = softness.enough.filter(|enough| *enough <= LARGEST_SIZE) else {
        return;
    };
    let words = format!("Work at {enough} texels");
    if link(view, ui, subject.theme, caption, &words).clicked() {
        actions.push(Action::edit(DocumentCommand::SetSize(enough)));
    }
}

/// Link beside a caption. With an id of its own, it does not change the ids of the widgets after it, such as open menus.
fn link(view: &mut ModelView, ui: &Ui, theme: &Theme, beside: Rect, text: &str) -> Response {
    let font = FontId::proportional(type_size::SMALL);
    let words = ui.painter().layout_no_wrap(text.to_owned(), font, theme.accent);
    // Leaves room for the borders of both.
    let left = beside.right_center() + vec2(space::USUAL + 2.0, 0.0);
    let place = view.captions.free(Align2::LEFT_CENTER.anchor_size(left, words.size()));
    let ground = place.expand2(vec2(4.0, 2.0));
    ui.painter()
        .rect_filled(ground, space::CORNER, theme.background.gamma_multiply(0.6));
    let link = ui.interact(place, ui.id().with("sharper"), Sense::click());
    link.widget_info(|| WidgetInfo::labeled(WidgetType::Link, true, text));
    if link.hovered() || link.has_focus() {
        let line = Stroke::new(1.0, theme.accent);
        ui.painter().hline(place.x_range(), place.bottom(), line);
    }
    ui.painter().galley(place.min, words, theme.accent);
    link.on_hover_cursor(CursorIcon::PointingHand)
        .on_hover_text("The maps get as many texels as the view has pixels")
}
