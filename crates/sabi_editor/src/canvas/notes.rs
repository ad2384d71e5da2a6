//! Notes: texts on the canvas, behind the nodes.

use egui::{Align2, Color32, FontId, Id, Pos2, Rect, Response, Sense, Ui, WidgetInfo, WidgetType, pos2, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::NoteCommand;
use sabi_editing::notes::{LEAST_NOTE_WIDTH, NOTE_WIDTH, NoteChange};
use sabi_graph::Note;

use super::camera::CanvasCamera;
use super::{Canvas, CanvasContext};
use crate::action::Action;
use crate::theme::{Theme, type_size};

/// Space around the text, canvas points.
const AROUND: f32 = 8.0;
/// Side of the corner that changes the width, canvas points.
const CORNER: f32 = 14.0;
/// Text of a note that has none.
const EMPTY: &str = "Double-click to write";

/// Note while it is dragged, with its place and width then.
pub(super) struct DraggedNote {
    id: String,
    pos: [f32; 2],
    width: f32,
}

/// Text of a note while it is typed.
pub(super) struct NoteText {
    /// The note; `None` for one that is yet to be added.
    id: Option<String>,
    /// Its upper left corner, canvas points.
    place: [f32; 2],
    width: f32,
    text: String,
    is_just_opened: bool,
}

impl NoteText {
    /// Text of a note that is added at a place of the canvas.
    pub(super) fn of_new(place: [f32; 2]) -> NoteText {
        NoteText {
            id: None,
            place,
            width: NOTE_WIDTH,
            text: String::new(),
            is_just_opened: true,
        }
    }

    fn of(id: &str, note: &Note) -> NoteText {
        NoteText {
            id: Some(id.to_owned()),
            place: note.pos,
            width: note.width,
            text: note.text.clone(),
            is_just_opened: true,
        }
    }
}

/// Draws the notes, and adds the requested actions.
pub(super) fn show(canvas: &mut Canvas, ui: &Ui, panel: Rect, context: &CanvasContext<'_>, actions: &mut Vec<Action>) {
    for (id, note) in context.document.graph().notes() {
        let dragged = canvas.dragged_note.as_ref().filter(|dragged| dragged.id == *id);
        let (pos, width) = dragged.map_or((note.pos, note.width), |dragged| (dragged.pos, dragged.width));
        let zoom = canvas.camera.view.zoom;
        let corner = canvas.camera.view.screen(panel, pos);
        let rect = paint(ui, context.theme, note, corner, width * zoom, zoom);
        if !rect.intersects(panel) {
            continue;
        }
        let key = ui.id().with(("note", id));
        let body = ui.interact(rect, key, Sense::click_and_drag());
        body.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, format!("Note: {}", note.text)));
        let grip = Rect::from_min_max(rect.max - vec2(CORNER, CORNER) * zoom, rect.max);
        let grip = ui.interact(grip, key.with("width"), Sense::drag());
        if body.double_clicked() {
            canvas.popups.note = Some(NoteText::of(id, note));
        }
        drag(canvas, id, note, [&body, &grip], actions);
        body.context_menu(|ui| {
            let change = |change| {
                Action::edit(NoteCommand::Change {
                    note: id.clone(),
                    change,
                })
            };
            if ui.button("Next color").clicked() {
                actions.push(change(NoteChange::NextColor));
            }
            if ui.button("Delete the note").clicked() {
                actions.push(Action::edit(NoteCommand::Remove(id.clone())));
            }
        });
    }
}

/// Moves a note by a drag of its body, or changes its width by one of its corner; the edit is made once the drag ends.
fn drag(canvas: &mut Canvas, id: &str, note: &Note, [body, grip]: [&Response; 2], actions: &mut Vec<Action>) {
    if body.drag_started() || grip.drag_started() {
        canvas.dragged_note = Some(DraggedNote {
            id: id.to_owned(),
            pos: note.pos,
            width: note.width,
        });
    }
    let Some(dragged) = canvas.dragged_note.as_mut().filter(|dragged| dragged.id == id) else {
        return;
    };
    let zoom = canvas.camera.view.zoom;
    let moved = body.drag_delta() / zoom;
    dragged.pos = [dragged.pos[0] + moved.x, dragged.pos[1] + moved.y];
    dragged.width = (dragged.width + grip.drag_delta().x / zoom).max(LEAST_NOTE_WIDTH);
    if body.drag_stopped() || grip.drag_stopped() {
        let change = if dragged.width == note.width {
            NoteChange::Move(dragged.pos)
        } else {
            NoteChange::Width(dragged.width)
        };
        actions.push(Action::edit(NoteCommand::Change {
            note: id.to_owned(),
            change,
        }));
        canvas.dragged_note = None;
    }
}

/// Paints a note with its upper left corner and width on the screen, and returns its rectangle.
fn paint(ui: &Ui, theme: &Theme, note: &Note, corner: Pos2, width: f32, zoom: f32) -> Rect {
    let font = FontId::proportional((type_size::BODY * zoom * 2.0).round().max(2.0) / 2.0);
    let (text, color) = match note.text.is_empty() {
        true => (EMPTY, theme.quiet),
        false => (note.text.as_str(), theme.text),
    };
    let galley = ui
        .painter()
        .layout(text.to_owned(), font, color, (width - 2.0 * AROUND * zoom).max(1.0));
    let rect = Rect::from_min_size(corner, vec2(width, galley.size().y + 2.0 * AROUND * zoom));
    let fill = note.color.as_deref().and_then(|code| Color32::from_hex(code).ok());
    let fill = fill.unwrap_or(theme.line);
    ui.painter().rect_filled(rect, 4.0 * zoom, fill.gamma_multiply(0.45));
    let strip = Rect::from_min_max(rect.min, pos2(rect.min.x + 3.0 * zoom, rect.max.y));
    ui.painter().rect_filled(strip, 0.0, fill);
    ui.painter().galley(corner + vec2(AROUND, AROUND) * zoom, galley, color);
    let letters = FontId::proportional((CORNER * zoom * 0.8).max(1.0));
    ui.painter()
        .text(rect.max, Align2::RIGHT_BOTTOM, icon::NOTCHES, letters, theme.quiet);
    rect
}

/// Shows the field in which a note is written. A click beside it, Ctrl+Enter and Escape close it and keep the text,
/// which can be undone.
pub(super) fn write(open: &mut Option<NoteText>, ui: &Ui, camera: &CanvasCamera, actions: &mut Vec<Action>) {
    let (Some(writing), Some(panel)) = (open.as_mut(), camera.panel) else {
        return;
    };
    let corner = camera.view.screen(panel, writing.place);
    let width = writing.width * camera.view.zoom;
    let area = egui::Area::new(Id::new("writing a note"))
        .order(egui::Order::Foreground)
        .current_pos(corner)
        .constrain(true);
    let shown = area.show(ui.ctx(), |ui| {
        let frame = egui::Frame::popup(ui.style());
        let field = egui::TextEdit::multiline(&mut writing.text)
            .desired_width(width.max(180.0))
            .desired_rows(3);
        let field = frame.show(ui, |ui| ui.add(field)).inner;
        field.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, "Note"));
        if std::mem::take(&mut writing.is_just_opened) {
            field.request_focus();
        }
        field.lost_focus()
    });
    let is_done = ui.input(|input| input.key_pressed(egui::Key::Enter) && input.modifiers.command);
    if !shown.inner && !is_done {
        return;
    }
    let Some(NoteText { id, place, text, .. }) = open.take() else {
        return;
    };
    let text = text.trim_end().to_owned();
    match id {
        Some(note) => actions.push(Action::edit(NoteCommand::Change {
            note,
            change: NoteChange::Text(text),
        })),
        None if text.is_empty() => {}
        None => actions.push(Action::edit(NoteCommand::Add { place, text })),
    }
}
