//! Cards of exposed parameters: names, section, range and default.

use egui::{DragValue, Rect, RichText, Sense, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::ExposedCommand;
use sabi_editing::exposed_knobs::ExposedKnob;
use sabi_graph::Value;

use crate::panels::reordering;
use crate::panels::text_field::TextField;
use crate::theme::{Theme, space};

/// Dragged parameter, by its name.
struct DraggedParameter(String);

pub(super) fn show(ui: &mut Ui, theme: &Theme, panel: &[ExposedKnob], commands: &mut Vec<ExposedCommand>) {
    let rows: Vec<Rect> = panel.iter().map(|knob| card(ui, theme, knob, commands)).collect();
    let title = |dragged: &DraggedParameter| {
        let knob = panel.iter().find(|knob| knob.name == dragged.0)?;
        Some(knob.knob.label.clone())
    };
    if let Some((dragged, gap)) = reordering::dropped(ui, theme, &rows, title) {
        let before = panel.get(gap).map(|knob| knob.name.clone());
        let name = dragged.0.clone();
        commands.push(ExposedCommand::Move { name, before });
    }
}

fn card(ui: &mut Ui, theme: &Theme, knob: &ExposedKnob, commands: &mut Vec<ExposedCommand>) -> Rect {
    let frame = egui::Frame::new()
        .fill(theme.raised)
        .corner_radius(space::CORNER)
        .inner_margin(6);
    let shown = frame.show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        ui.visuals_mut().extreme_bg_color = theme.panel;
        head(ui, theme, knob, commands);
        names(ui, knob, commands);
        if is_number(&knob.value) {
            range(ui, theme, knob, commands);
        }
        default_value(ui, theme, knob, commands);
    });
    shown.response.rect
}

/// Handle for dragging, label, and the button that removes the parameter from the panel.
fn head(ui: &mut Ui, theme: &Theme, knob: &ExposedKnob, commands: &mut Vec<ExposedCommand>) {
    ui.horizontal(|ui| {
        let sign = RichText::new(icon::DOTS_SIX_VERTICAL).color(theme.quiet);
        let handle = ui.add(egui::Label::new(sign).sense(Sense::drag()));
        handle.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, format!("Move {}", knob.knob.label)));
        handle
            .on_hover_cursor(egui::CursorIcon::Grab)
            .dnd_set_drag_payload(DraggedParameter(knob.name.clone()));
        let label = TextField {
            name: "Label",
            hint: &knob.name,
            held: &knob.knob.label,
            width: ui.available_width() - 52.0,
        };
        if let Some(label) = label.show(ui, ("label", &knob.name)) {
            let name = knob.name.clone();
            commands.push(ExposedCommand::SetLabel { name, label });
        }
        let off = ui.small_button(icon::TRASH);
        off.widget_info(|| {
            let name = format!("Remove {} from the panel", knob.knob.label);
            WidgetInfo::labeled(WidgetType::Button, true, name)
        });
        if off.on_hover_text("Stop exposing").clicked() {
            commands.push(ExposedCommand::Remove(knob.name.clone()));
        }
    });
}

/// Name in files, and section.
fn names(ui: &mut Ui, knob: &ExposedKnob, commands: &mut Vec<ExposedCommand>) {
    ui.horizontal(|ui| {
        let half = ((ui.available_width() - space::USUAL) / 2.0 - space::USUAL).floor();
        let name = TextField {
            name: "Name in files",
            hint: "name in files",
            held: &knob.name,
            width: half,
        };
        if let Some(to) = name.show(ui, ("name", &knob.name)) {
            let name = knob.name.clone();
            commands.push(ExposedCommand::Rename { name, to });
        }
        let section = TextField {
            name: "Section",
            hint: "no section",
            held: knob.exposed.section.as_deref().unwrap_or(""),
            width: half,
        };
        if let Some(section) = section.show(ui, ("section", &knob.name)) {
            let name = knob.name.clone();
            commands.push(ExposedCommand::SetSection { name, section });
        }
    });
}

/// Range of the parameter.
fn range(ui: &mut Ui, theme: &Theme, knob: &ExposedKnob, commands: &mut Vec<ExposedCommand>) {
    ui.horizontal(|ui| {
        ui.colored_label(theme.quiet, "Range");
        let own = knob.exposed.range;
        let [mut low, mut high] = own.unwrap_or_else(|| knob.knob.ty.slider());
        let speed = ((high - low).abs() / 200.0).max(1e-4);
        let end = |ui: &mut Ui, end: &mut f64, name: &str| {
            let response = ui.add(DragValue::new(end).speed(speed).update_while_editing(false));
            response.widget_info(|| WidgetInfo::labeled(WidgetType::DragValue, true, name));
            response.changed()
        };
        let mut has_changed = end(ui, &mut low, "Lowest value");
        ui.colored_label(theme.quiet, "to");
        has_changed |= end(ui, &mut high, "Highest value");
        let name = knob.name.clone();
        if has_changed {
            let range = Some([low.min(high), high.max(low)]);
            commands.push(ExposedCommand::SetRange { name, range });
        } else if own.is_some() && sign(ui, icon::X, "Reset to the range of the node").clicked() {
            commands.push(ExposedCommand::SetRange { name, range: None });
        }
    });
}

/// Default of the parameter.
fn default_value(ui: &mut Ui, theme: &Theme, knob: &ExposedKnob, commands: &mut Vec<ExposedCommand>) {
    ui.horizontal(|ui| {
        let name = knob.name.clone();
        match &knob.exposed.default {
            Some(held) => {
                ui.colored_label(theme.quiet, format!("Default {}", held.to_json()));
                if sign(ui, icon::X, "Reset the default to the node's value").clicked() {
                    commands.push(ExposedCommand::SetDefault { name, default: None });
                }
            }
            None => {
                let keep = ui.small_button(format!("{} Set as default", icon::PUSH_PIN));
                let tooltip = "Uses the present value as the default, whatever its nodes are set to";
                if keep.on_hover_text(tooltip).clicked() {
                    let default = Some(knob.value.clone());
                    commands.push(ExposedCommand::SetDefault { name, default });
                }
            }
        }
    });
}

fn sign(ui: &mut Ui, sign: &str, name: &str) -> egui::Response {
    let response = ui.small_button(sign);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
    response.on_hover_text(name)
}

fn is_number(value: &Value) -> bool {
    let one = std::slice::from_ref(value);
    value
        .as_list()
        .unwrap_or(one)
        .iter()
        .all(|part| part.as_number().is_some())
}
