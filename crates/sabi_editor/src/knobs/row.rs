//! Rows of the panel: name, value and menu of a parameter.

use egui::{
    Align2, Event, Id, Key, Layout, Modifiers, Popup, PopupKind, Pos2, Rect, Sense, Ui, Vec2, ViewportCommand,
    WidgetInfo, WidgetType,
};
use egui_phosphor::regular as icon;
use sabi_graph::Value;
use sabi_nodes::kind::Role;

use super::boxes::DOTS;
use super::knob_ui::KnobUi;
use super::sentence::sentence;
use super::text_painting::write;
use super::values::{KnobValue, read};
use super::{KnobEvent, KnobRow, ParamMask, choice, color, curve, doc, numbers, stops, text};
use crate::theme::{space, type_size};

/// Share of a row that the column of names takes, within limits.
const NAMES: f32 = 0.36;
const NARROWEST_NAMES: f32 = 70.0;
const WIDEST_NAMES: f32 = 150.0;
/// Passes after which a clipboard without an answer counts as empty.
const PATIENCE: u64 = 3;

pub(super) fn show(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>) {
    let id = ui.make_persistent_id(&row.knob.name);
    let (_, head) = ui.allocate_space(Vec2::new(ui.available_width(), space::ROW));
    let names = (head.width() * NAMES).clamp(NARROWEST_NAMES, WIDEST_NAMES);
    let column = head.with_min_x(head.left() + DOTS + names);
    knob_ui.age_fault(ui.ctx(), id);
    dot(ui, knob_ui, row, id, head.with_max_x(head.left() + DOTS));
    name(
        ui,
        knob_ui,
        row,
        id,
        Rect::from_x_y_ranges(head.left() + DOTS..=column.left() - space::TIGHT, head.y_range()),
    );
    match row.wired {
        Some(from) => wired(ui, knob_ui, row, id, column, from),
        None => widget(ui, knob_ui, row, id, column),
    }
    if let ParamMask::Of(mask) = row.mask {
        let text = format!("× mask of {mask}");
        sentence(ui, id.with("mask"), column.left(), &text, knob_ui.theme.quiet);
    }
    if let Some(text) = knob_ui.fault_of(id) {
        sentence(ui, id.with("fault"), column.left(), &text, knob_ui.theme.fault);
    }
    let bottom = ui.cursor().top().max(head.bottom());
    menu(ui, knob_ui, row, id, head.with_max_y(bottom));
    paste(ui, knob_ui, row, id);
}

fn widget(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    let mut held = read(row.knob, row.current());
    if held.is_none() {
        let there = shortened(&row.current().to_json());
        let text = format!(
            "This holds {there}, but takes {}: set it anew, or reset it.",
            row.knob.ty.expectation()
        );
        sentence(ui, id.with("unreadable"), rect.left(), &text, knob_ui.theme.fault);
        held = read(row.knob, &row.knob.ty.default);
    }
    match (held, &row.knob.ty.role) {
        (Some(KnobValue::Numbers(held)), _) => numbers::show(ui, knob_ui, row, id, rect, held),
        (Some(KnobValue::On(is_on)), _) => choice::toggle(ui, knob_ui, row, id, rect, is_on),
        (Some(KnobValue::Text(word)), Role::Choice(words)) => choice::choice(ui, knob_ui, row, id, rect, words, word),
        (Some(KnobValue::Text(path)), Role::File) => text::file(ui, knob_ui, row, id, rect, path),
        (Some(KnobValue::Text(held)), _) => text::text(ui, knob_ui, row, id, rect, held),
        (Some(KnobValue::Color(held)), _) => color::show(ui, knob_ui, row, id, rect, held),
        (Some(KnobValue::Stops(held)), _) => stops::show(ui, knob_ui, row, id, rect, held),
        (Some(KnobValue::Points(held)), _) => curve::show(ui, knob_ui, row, id, rect, held),
        // Values measured on the model cannot be set.
        (None, _) => {}
    }
}

/// Text of a value, shortened.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Shows a dot where a value differs from the default; a click resets it.
fn dot(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    if !row.is_changed() {
        return;
    }
    // The keyboard has the menu and Backspace for this, so that Tab does not stop at every dot.
    let response = ui.interact(rect, id.with("dot"), Sense::CLICK);
    response.widget_info(|| {
        let name = format!("Reset {}", row.knob.label);
        WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name)
    });
    let radius = if response.hovered() { 3.5 } else { 2.5 };
    let middle = Pos2::new(rect.left() + 4.0, rect.center().y);
    ui.painter().circle_filled(middle, radius, knob_ui.theme.accent);
    if response.on_hover_text("Changed: click to reset").clicked() {
        knob_ui.reset(row);
    }
}

fn name(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    let theme = knob_ui.theme;
    let response = ui.interact(rect, id.with("name"), Sense::hover());
    let mut room = rect;
    if row.exposed.is_some() && !knob_ui.is_panel {
        let sign = write(
            ui.painter(),
            rect,
            Align2::RIGHT_CENTER,
            icon::SLIDERS_HORIZONTAL,
            type_size::BODY,
            theme.accent,
        );
        room.max.x -= sign + space::TIGHT;
    }
    let color = if response.hovered() || row.is_changed() {
        theme.text
    } else {
        theme.quiet
    };
    write(
        ui.painter(),
        room,
        Align2::LEFT_CENTER,
        &knob_ui.short_label(&row.knob.label),
        type_size::BODY,
        color,
    );
    response.on_hover_ui(|ui| doc::show(ui, theme, row));
}

/// Shows the node that is connected to an input, in place of its value.
fn wired(ui: &Ui, knob_ui: &KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, from: &str) {
    let response = ui.interact(rect, id.with("wired"), Sense::hover());
    let text = format!("from {from}");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, ui.is_enabled(), &row.knob.label));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_value(text.as_str()));
    let theme = knob_ui.theme;
    let sign = write(
        ui.painter(),
        rect,
        Align2::LEFT_CENTER,
        icon::PLUGS_CONNECTED,
        type_size::BODY,
        theme.quiet,
    );
    let rest = rect.with_min_x(rect.left() + sign + space::TIGHT);
    write(
        ui.painter(),
        rest,
        Align2::LEFT_CENTER,
        &text,
        type_size::BODY,
        theme.quiet,
    );
}

/// Returns whether the secondary button was clicked in a row, which opens the menu of its parameter.
pub(super) fn is_menu_asked(ui: &Ui, rect: Rect) -> bool {
    ui.rect_contains_pointer(rect) && ui.input(|input| input.pointer.secondary_clicked())
}

/// Shows the menu of a parameter, opened by the secondary button or Shift+F10.
pub(super) fn menu(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect) {
    let pointed = is_menu_asked(ui, rect);
    if pointed && let Some(place) = ui.input(|input| input.pointer.interact_pos()) {
        knob_ui.memory.menu = Some((id, place));
    }
    let is_focused = || {
        let focused = ui.memory(|memory| memory.focused());
        let response = focused.and_then(|focused| ui.ctx().read_response(focused));
        response.is_some_and(|response| rect.contains(response.rect.center()))
    };
    let is_keyed = ui.input(|input| input.key_pressed(Key::F10) && input.modifiers.shift);
    if is_keyed && is_focused() && ui.input_mut(|input| input.consume_key(Modifiers::SHIFT, Key::F10)) {
        knob_ui.memory.menu = Some((id, rect.left_top() + Vec2::splat(space::ROW)));
    }
    let Some((_, place)) = knob_ui.memory.menu.filter(|(of, _)| *of == id) else {
        return;
    };
    let mut is_open = true;
    let popup = Popup::new(id.with("menu"), ui.ctx().clone(), place, ui.layer_id())
        .kind(PopupKind::Menu)
        .layout(Layout::top_down_justified(egui::Align::Min))
        .style(egui::containers::menu::menu_style)
        .open_bool(&mut is_open);
    popup.show(|ui| items(ui, knob_ui, row, id));
    if !is_open {
        knob_ui.memory.menu = None;
    }
}

fn items(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id) {
    let knob = || row.knob.name.clone();
    let can_reset = row.differs || row.value.is_some();
    if ui.add_enabled(can_reset, egui::Button::new("Reset")).clicked() {
        knob_ui.reset(row);
    }
    ui.separator();
    match row.exposed {
        None if ui.button("Expose parameter").clicked() => knob_ui.events.push(KnobEvent::Expose { knob: knob() }),
        Some(_) if ui.button("Stop exposing").clicked() => knob_ui.events.push(KnobEvent::Unexpose { knob: knob() }),
        _ => {}
    }
    match row.mask {
        ParamMask::NotTaken => {}
        ParamMask::Unlinked => {
            if ui.button("Multiply by a mask…").clicked() {
                knob_ui.events.push(KnobEvent::AddMask { knob: knob() });
            }
            if ui.button("Expose its mask as an input").clicked() {
                knob_ui.events.push(KnobEvent::ExposeMask { knob: knob() });
            }
        }
        ParamMask::Of(_) => {
            if ui.button("Remove the mask").clicked() {
                knob_ui.events.push(KnobEvent::RemoveMask { knob: knob() });
            }
        }
    }
    ui.separator();
    if ui.add_enabled(!row.differs, egui::Button::new("Copy value")).clicked() {
        ui.copy_text(row.current().to_json());
    }
    if ui
        .add_enabled(row.wired.is_none(), egui::Button::new("Paste value"))
        .clicked()
    {
        knob_ui.memory.pasting = Some((id, ui.ctx().cumulative_pass_nr()));
        ui.ctx().send_viewport_cmd(ViewportCommand::RequestPaste);
    }
}

/// Takes the contents of the clipboard for the row that requested it.
pub(super) fn paste(ui: &Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id) {
    let Some((_, since)) = knob_ui.memory.pasting.filter(|(of, _)| *of == id) else {
        return;
    };
    if ui.ctx().cumulative_pass_nr() > since + PATIENCE {
        knob_ui.memory.pasting = None;
        return;
    }
    let answer = ui.input_mut(|input| {
        let at = input.events.iter().position(|event| matches!(event, Event::Paste(_)))?;
        match input.events.remove(at) {
            Event::Paste(text) => Some(text),
            _ => None,
        }
    });
    let Some(answer) = answer else { return };
    knob_ui.memory.pasting = None;
    let answer = answer.trim();
    let ty = &row.knob.ty;
    // "Copy value" copies JSON; other programs copy text as it is typed.
    let copied = Value::from_json(answer).filter(|value| ty.takes(value));
    match copied.or_else(|| ty.parse(answer).ok()) {
        Some(value) => knob_ui.set(row, value),
        None => {
            let there = shortened(answer);
            let text = format!(
                "The clipboard holds \"{there}\", but {} takes {}.",
                row.knob.label,
                ty.expectation()
            );
            knob_ui.fault(id, text);
        }
    }
}
