//! The chain behind an output as a list of layers, for people who come from layer tools.

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_graph::NodeId;

use crate::action::Action;
use crate::app::Editor;
use crate::desk::{Layer, Stack, StackEnd};
use crate::theme::{Theme, space};

/// The kind that a new layer is.
const NEW_LAYER: &str = "effect/layer";

/// What is asked of a layer.
enum Asked {
    Toggle(NodeId),
    Opacity(NodeId, f64),
    Move { from: usize, to: usize },
    Remove(usize),
    Add(usize),
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let stacks = editor.desk.stacks();
    if stacks.is_empty() {
        ui.colored_label(
            theme.quiet,
            "There is no output yet; add a Material output and wire a material to it.",
        );
        return;
    }
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for stack in stacks {
            let asked = list(editor, ui, theme, &stack, actions);
            if let Some(asked) = asked {
                perform(editor, &stack.end, asked);
            }
            ui.add_space(space::WIDE);
        }
    });
}

fn list(editor: &Editor, ui: &mut Ui, theme: &Theme, stack: &Stack, actions: &mut Vec<Action>) -> Option<Asked> {
    let mut asked = None;
    ui.horizontal(|ui| {
        ui.strong(&stack.title);
        if ui
            .button(format!("{} Layer", icon::PLUS))
            .on_hover_text("Adds a layer on top")
            .clicked()
        {
            asked = Some(Asked::Add(0));
        }
    });
    if !stack.is_plain() {
        ui.colored_label(
            theme.quiet,
            "Some layers are read elsewhere too; those stay where they are.",
        );
    }
    for (at, layer) in stack.layers.iter().enumerate() {
        let response = row(editor, ui, theme, layer, at, &mut asked, actions);
        response.dnd_set_drag_payload(at);
        if let Some(from) = response.dnd_release_payload::<usize>() {
            asked = Some(Asked::Move { from: *from, to: at });
        }
        if response.dnd_hover_payload::<usize>().is_some() {
            let rect = response.rect;
            ui.painter()
                .hline(rect.x_range(), rect.top(), egui::Stroke::new(2.0, theme.accent));
        }
    }
    asked
}

fn row(
    editor: &Editor,
    ui: &mut Ui,
    theme: &Theme,
    layer: &Layer,
    at: usize,
    asked: &mut Option<Asked>,
    actions: &mut Vec<Action>,
) -> egui::Response {
    let is_selected = editor.desk.is_selected(&layer.node);
    let fill = if is_selected {
        theme.accent.gamma_multiply(0.25)
    } else {
        theme.raised
    };
    let frame = egui::Frame::new()
        .fill(fill)
        .corner_radius(space::CORNER)
        .inner_margin(4);
    let shown = frame.show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        ui.horizontal(|ui| {
            let eye = if layer.is_muted { icon::EYE_SLASH } else { icon::EYE };
            let eye = ui.button(eye);
            eye.widget_info(|| {
                egui::WidgetInfo::selected(
                    egui::WidgetType::Checkbox,
                    true,
                    !layer.is_muted,
                    format!("Show {}", layer.title),
                )
            });
            if eye.clicked() {
                *asked = Some(Asked::Toggle(layer.node.clone()));
            }
            let picture = editor.thumbnail_of(&layer.node);
            if let Some(picture) = picture {
                ui.add(egui::Image::new((picture, egui::Vec2::splat(34.0))));
            }
            ui.vertical(|ui| {
                ui.label(RichText::new(&layer.title).color(if layer.is_muted { theme.quiet } else { theme.text }));
                if let Some(mask) = &layer.mask {
                    let text = format!("where {}", editor.desk.title(&mask.node));
                    ui.label(RichText::new(text).small().color(theme.quiet));
                }
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if layer.shared.is_none()
                    && ui
                        .small_button(icon::TRASH)
                        .on_hover_text("Remove; what is above heals")
                        .clicked()
                {
                    *asked = Some(Asked::Remove(at));
                }
                if let Some(mut opacity) = layer.opacity {
                    let drag = egui::DragValue::new(&mut opacity)
                        .range(0.0..=1.0)
                        .speed(0.01)
                        .fixed_decimals(2);
                    let drag = ui.add(drag).on_hover_text("Opacity");
                    if drag.changed() {
                        *asked = Some(Asked::Opacity(layer.node.clone(), opacity));
                    }
                }
            });
        });
    });
    let id = ui.id().with(("layer", &layer.node));
    let handle = shown
        .response
        .rect
        .with_max_x(shown.response.rect.right() - 90.0)
        .with_min_x(shown.response.rect.left() + 34.0);
    let response = ui.interact(handle, id, egui::Sense::click_and_drag());
    response
        .widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::SelectableLabel, true, is_selected, &layer.title));
    if response.clicked() {
        actions.push(Action::Select(vec![layer.node.clone()]));
        actions.push(Action::Show {
            node: layer.node.clone(),
            port: None,
        });
    }
    match &layer.shared {
        Some(why) => response.on_hover_text(why),
        None => response,
    }
}

fn perform(editor: &mut Editor, end: &StackEnd, asked: Asked) {
    let desk = &mut editor.desk;
    match asked {
        Asked::Toggle(id) => {
            desk.toggle_layer(&id);
        }
        Asked::Opacity(id, opacity) => {
            desk.set_layer_opacity(&id, opacity);
        }
        Asked::Move { from, to } => {
            desk.move_layer(end, from, to);
        }
        Asked::Remove(at) => {
            desk.remove_layer(end, at);
        }
        Asked::Add(at) => {
            desk.add_layer(end, at, NEW_LAYER);
        }
    }
}
