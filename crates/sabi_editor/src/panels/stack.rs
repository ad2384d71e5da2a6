//! The chain behind an output as a list of layers, for people who come from layer tools.

mod row;

use egui::{Rect, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::{OpenDocument, Stack, StackEnd};
use sabi_graph::NodeRef;

use super::order;
use crate::action::{Action, LayerAsk};
use crate::app::Editor;
use crate::theme::{Theme, space};

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Layers {
    /// Results of which the panel shows pictures, whether the canvas shows their nodes or not.
    pub(crate) wanted: Vec<NodeRef>,
}

/// The layer that is dragged.
struct Dragged {
    end: StackEnd,
    at: usize,
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let stacks = editor.document.stacks();
    editor.panels.stack.wanted = wanted(editor, &stacks);
    if stacks.is_empty() {
        let sentence = "There is no output yet; add a Material output and wire a material to it.";
        ui.add(egui::Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
        return;
    }
    let editor = &*editor;
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for stack in &stacks {
            ui.push_id(format!("{:?}", stack.end), |ui| list(editor, ui, theme, stack, actions));
            ui.add_space(space::WIDE);
        }
    });
}

/// The results that rows show: of each layer, and of its mask.
fn wanted(editor: &Editor, stacks: &[Stack]) -> Vec<NodeRef> {
    let layers = stacks.iter().flat_map(|stack| &stack.layers);
    let results = layers.flat_map(|layer| {
        let own = editor.reference(&layer.node, None);
        let mask = layer.mask.as_ref();
        let mask = mask.map(|mask| editor.reference(&mask.node, mask.port.clone()));
        std::iter::once(own).chain(mask)
    });
    results.collect()
}

fn list(editor: &Editor, ui: &mut Ui, theme: &Theme, stack: &Stack, actions: &mut Vec<Action>) {
    head(&editor.document, ui, stack, actions);
    let sentence = match (stack.layers.is_empty(), stack.is_plain()) {
        (true, _) => "Nothing leads to this output yet; add a layer, or wire a material to it.",
        (false, false) => "Layers with a lock are read elsewhere too, and stay where they are.",
        (false, true) => "",
    };
    if !sentence.is_empty() {
        ui.add(egui::Label::new(RichText::new(sentence).small().color(theme.quiet)).wrap());
    }
    let mut rows: Vec<Rect> = Vec::new();
    for (at, layer) in stack.layers.iter().enumerate() {
        let response = row::show(editor, ui, theme, layer, |ask| ask_of(stack, at, ask), actions);
        rows.push(response.rect);
        response.dnd_set_drag_payload(Dragged {
            end: stack.end.clone(),
            at,
        });
        response.context_menu(|ui| {
            ui.menu_button("Add above", |ui| kinds(&editor.document, ui, stack, at, actions));
            if ui.button("Show on the canvas").clicked() {
                actions.push(Action::GoTo(editor.document.full_id(&layer.node)));
            }
            if ui.button("Remove").clicked() {
                actions.push(Action::Layer(ask_of(stack, at, row::Ask::Remove)));
            }
        });
    }
    let title = |dragged: &Dragged| {
        let is_ours = dragged.end == stack.end;
        let layer = stack.layers.get(dragged.at).filter(|_| is_ours);
        layer.map(|layer| layer.title.clone())
    };
    if let Some((dragged, gap)) = order::dropped(ui, theme, &rows, title) {
        let from = dragged.at;
        // The gap is counted with the dragged one in its place.
        let to = if gap > from { gap - 1 } else { gap };
        if to != from {
            let end = stack.end.clone();
            actions.push(Action::Layer(LayerAsk::Move { end, from, to }));
        }
    }
}

fn head(document: &OpenDocument, ui: &mut Ui, stack: &Stack, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        ui.strong(&stack.title);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let menu = ui.menu_button(format!("{} Layer", icon::PLUS), |ui| {
                kinds(document, ui, stack, 0, actions)
            });
            menu.response.on_hover_text("Adds a layer on top");
        });
    });
}

/// The kinds that a layer above another one can be.
fn kinds(document: &OpenDocument, ui: &mut Ui, stack: &Stack, at: usize, actions: &mut Vec<Action>) {
    let is_lowest = stack.layers.is_empty();
    for kind in document.layer_kinds(is_lowest) {
        if ui.button(&kind.label).on_hover_text(&kind.summary).clicked() {
            actions.push(Action::Layer(LayerAsk::Add {
                end: stack.end.clone(),
                at,
                kind: kind.id.clone(),
            }));
        }
    }
}

/// What is asked of one row, as it is asked of the stack.
fn ask_of(stack: &Stack, at: usize, ask: row::Ask) -> LayerAsk {
    let node = stack.layers[at].node.clone();
    match ask {
        row::Ask::Toggle => LayerAsk::Toggle(node),
        row::Ask::Opacity(opacity) => LayerAsk::Opacity { node, opacity },
        row::Ask::Remove => LayerAsk::Remove {
            end: stack.end.clone(),
            at,
        },
    }
}
