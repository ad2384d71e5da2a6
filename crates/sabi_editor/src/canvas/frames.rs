//! Frames: titled boxes behind nodes.

use std::collections::BTreeMap;

use egui::{Align2, Color32, FontId, Rect, Sense, Ui, WidgetInfo, WidgetType, vec2};
use sabi_editing::command::{FrameCommand, HistoryCommand};
use sabi_editing::frames::FRAME_STRIP;

use super::frame_rects::rect_of;
use super::gesture::Gesture;
use super::questions::ItemRename;
use super::{Canvas, CanvasContext};
use crate::action::Action;
use crate::theme::type_size;

/// Draws the frames, and adds the requested actions.
pub(super) fn show(canvas: &mut Canvas, ui: &Ui, panel: Rect, context: &CanvasContext<'_>, actions: &mut Vec<Action>) {
    let document = context.document;
    for (id, frame) in document.graph().frames() {
        let Some(rect) = rect_of(document, id).map(|rect| canvas.camera.view.screen_rect(panel, rect)) else {
            continue;
        };
        if !rect.intersects(panel) {
            continue;
        }
        let zoom = canvas.camera.view.zoom;
        let color = frame.color.as_deref().and_then(|code| Color32::from_hex(code).ok());
        let color = color.unwrap_or(context.theme.line);
        ui.painter().rect_filled(rect, 6.0 * zoom, color.gamma_multiply(0.25));
        let strip = Rect::from_min_max(rect.min, egui::pos2(rect.max.x, rect.min.y + FRAME_STRIP * zoom));
        ui.painter().rect_filled(strip, 6.0 * zoom, color.gamma_multiply(0.6));
        let title = frame.title.as_deref().unwrap_or("");
        paint_title(ui, context, strip, zoom, title);
        let response = ui.interact(strip, ui.id().with(("frame", id)), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, format!("Frame {title}")));
        if response.double_clicked() {
            canvas.popups.renaming = Some(ItemRename::frame(id.clone(), title.to_owned()));
        } else if response.clicked() {
            actions.push(Action::edit(FrameCommand::Select(id.clone())));
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            let places = frame
                .nodes
                .iter()
                .filter_map(|id| Some((id.clone(), document.node(id)?.pos)));
            let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(strip.center());
            actions.push(Action::edit(FrameCommand::Select(id.clone())));
            actions.push(Action::edit(HistoryCommand::Begin("Move".to_owned())));
            canvas.gesture = Gesture::Move {
                from: places.collect::<BTreeMap<_, _>>(),
                origin: canvas.camera.view.place(panel, origin),
                is_frame: true,
            };
        }
        response.context_menu(|ui| {
            if ui.button("Next color").clicked() {
                actions.push(Action::edit(FrameCommand::Recolor(id.clone())));
            }
            if ui.button("Rename").clicked() {
                canvas.popups.renaming = Some(ItemRename::frame(id.clone(), title.to_owned()));
            }
            if ui.button("Delete the frame, keep its nodes").clicked() {
                actions.push(Action::edit(FrameCommand::Remove(id.clone())));
            }
        });
    }
}

/// Paints the title of a frame on its strip, or above it where the strip is too low for it at this zoom.
fn paint_title(ui: &Ui, context: &CanvasContext<'_>, strip: Rect, zoom: f32, title: &str) {
    let letters = (type_size::HEADING * zoom).max(9.0);
    let (at, align, room) = if strip.height() < letters {
        let above = strip.with_min_y(strip.top() - 2.0 * letters);
        (strip.left_top(), Align2::LEFT_BOTTOM, above)
    } else {
        let inside = strip.left_center() + vec2(8.0 * zoom, 0.0);
        (inside, Align2::LEFT_CENTER, strip)
    };
    let clipped = ui.painter().with_clip_rect(room.intersect(ui.clip_rect()));
    clipped.text(at, align, title, FontId::proportional(letters), context.theme.text);
}
