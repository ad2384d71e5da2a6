//! The chain behind an output as a list of layers.

mod row;

use egui::{Rect, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::command::LayerCommand;
use sabi_editing::stack::{Stack, StackEnd};
use sabi_editing::{OpenDocument, layers, stack};
use sabi_graph::NodeRef;

use super::reordering;
use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::looks::result_of;
use crate::theme::space;

/// Panel of layers.
#[derive(Default)]
pub(crate) struct Layers {
    /// Results of which the panel shows pictures, whether the canvas shows their nodes or not.
    pub(crate) wanted: Vec<NodeRef>,
}

/// Layer that is dragged.
struct Dragged {
    end: StackEnd,
    at: usize,
}

impl View for Layers {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let stacks = stack::all(context.document);
        self.wanted = wanted(context.document, &stacks);
        if stacks.is_empty() {
            let sentence = "There is no output yet; add a Material output and wire a material to it.";
            ui.add(egui::Label::new(RichText::new(sentence).color(context.theme.quiet)).wrap());
            return actions;
        }
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for stack in &stacks {
                ui.push_id(format!("{:?}", stack.end), |ui| list(ui, context, stack, &mut actions));
                ui.add_space(space::WIDE);
            }
        });
        actions
    }
}

/// Results that rows show: of each layer, and of its mask.
fn wanted(document: &OpenDocument, stacks: &[Stack]) -> Vec<NodeRef> {
    let layers = stacks.iter().flat_map(|stack| &stack.layers);
    let results = layers.flat_map(|layer| {
        let own = result_of(document, &layer.node, None);
        let mask = layer.mask.as_ref();
        let mask = mask.map(|mask| result_of(document, &mask.node, mask.port.clone()));
        std::iter::once(own).chain(mask)
    });
    results.collect()
}

fn list(ui: &mut Ui, context: &ViewContext<'_>, stack: &Stack, actions: &mut Vec<Action>) {
    let (document, theme) = (context.document, context.theme);
    head(document, ui, stack, actions);
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
        let response = row::show(ui, context, layer, |change| command_for(stack, at, change), actions);
        rows.push(response.rect);
        response.dnd_set_drag_payload(Dragged {
            end: stack.end.clone(),
            at,
        });
        response.context_menu(|ui| {
            ui.menu_button("Add above", |ui| kinds(document, ui, stack, at, actions));
            if ui.button("Show on the canvas").clicked() {
                actions.push(Action::GoTo(document.full_id(&layer.node)));
            }
            if ui.button("Remove").clicked() {
                actions.push(Action::edit(command_for(stack, at, row::RowChange::Remove)));
            }
        });
    }
    let title = |dragged: &Dragged| {
        let is_ours = dragged.end == stack.end;
        let layer = stack.layers.get(dragged.at).filter(|_| is_ours);
        layer.map(|layer| layer.title.clone())
    };
    if let Some((dragged, gap)) = reordering::dropped(ui, theme, &rows, title) {
        let from = dragged.at;
        // The gap is counted with the dragged row in its place.
        let to = if gap > from { gap - 1 } else { gap };
        if to != from {
            let end = stack.end.clone();
            actions.push(Action::edit(LayerCommand::Move { end, from, to }));
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

/// Menu of the kinds that a layer can have.
fn kinds(document: &OpenDocument, ui: &mut Ui, stack: &Stack, at: usize, actions: &mut Vec<Action>) {
    let is_lowest = stack.layers.is_empty();
    for kind in layers::kinds(document, is_lowest) {
        if ui.button(&kind.label).on_hover_text(&kind.summary).clicked() {
            actions.push(Action::edit(LayerCommand::Add {
                end: stack.end.clone(),
                at,
                kind: kind.id.clone(),
            }));
        }
    }
}

/// Command for the change of a row.
fn command_for(stack: &Stack, at: usize, change: row::RowChange) -> LayerCommand {
    let node = stack.layers[at].node.clone();
    match change {
        row::RowChange::Toggle => LayerCommand::Toggle(node),
        row::RowChange::Opacity(opacity) => LayerCommand::SetOpacity { node, opacity },
        row::RowChange::Remove => LayerCommand::Remove {
            end: stack.end.clone(),
            at,
        },
    }
}
