//! The chain of layers behind an output, as a list.

mod row;

use egui::{Pos2, Rect, RichText, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::command::{KnobCommand, LayerCommand, PaintCommand};
use sabi_editing::hand_layers::HandLayer;
use sabi_editing::stack::{Layer, Stack, StackEnd};
use sabi_editing::{OpenDocument, connections, layers, node_paths, stack};
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, NodeRef, Value};
use sabi_nodes::kind::Role;
use sabi_nodes::label_of;

use super::reordering;
use crate::action::{Action, PaintAction};
use crate::context::{View, ViewContext};
use crate::search::Candidate;
use crate::shown_results::result_of;
use crate::theme::space;

/// Panel of layers.
#[derive(Default)]
pub(crate) struct StackPanel {
    /// Layer that is being renamed.
    renaming: Option<LayerRename>,
    /// Visible parts of the rows of the last frame, with the nodes of their layers.
    rows: Vec<(Rect, NodeId)>,
    /// Results of which the panel shows pictures, whether the canvas shows their nodes or not.
    pub(crate) wanted: Vec<NodeRef>,
}

/// Layer that is being renamed.
struct LayerRename {
    node: NodeId,
    title: String,
    /// True before the field was drawn.
    is_new: bool,
}

impl LayerRename {
    fn of(layer: &Layer) -> LayerRename {
        LayerRename {
            node: layer.node.clone(),
            title: layer.title.clone(),
            is_new: true,
        }
    }
}

/// Layer that is dragged.
struct DraggedLayer {
    end: StackEnd,
    at: usize,
}

impl View for StackPanel {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let stacks = stack::all(context.document);
        self.wanted = wanted(context, &stacks);
        self.rows.clear();
        if stacks.is_empty() {
            let sentence = "There is no output yet; the first layer adds one.";
            ui.add(egui::Label::new(RichText::new(sentence).color(context.theme.quiet)).wrap());
            ui.horizontal_wrapped(|ui| by_hand(ui, None, &mut actions));
            return actions;
        }
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for stack in &stacks {
                ui.push_id(format!("{:?}", stack.end), |ui| {
                    self.list(ui, context, stack, &mut actions);
                });
                ui.add_space(space::WIDE);
            }
        });
        actions
    }
}

impl StackPanel {
    /// Layer under a place of the screen, if a node that is dropped there can become its mask.
    pub(crate) fn mask_target(&self, document: &OpenDocument, interface: &Interface, at: Pos2) -> Option<NodeId> {
        let (_, node) = self.rows.iter().find(|(rect, _)| rect.contains(at))?;
        let slot = layers::mask_input(document, node)?;
        let fits = connections::input(document, &slot).is_some_and(|input| interface.output_for(input).is_some());
        fits.then(|| node.clone())
    }

    /// Visible part of the row of a layer in the last frame.
    pub(crate) fn row_of(&self, node: &NodeId) -> Option<Rect> {
        let row = self.rows.iter().find(|(_, of)| of == node);
        row.map(|(rect, _)| *rect)
    }

    fn list(&mut self, ui: &mut Ui, context: &ViewContext<'_>, stack: &Stack, actions: &mut Vec<Action>) {
        let (document, theme) = (context.document, context.theme);
        head(document, ui, stack, actions);
        let sentence = match (stack.layers.is_empty(), stack.is_plain()) {
            (true, _) => "Nothing leads to this output yet; add a layer, or wire a material to it.",
            (false, false) => "Layers with a lock are used elsewhere in the graph, too: they cannot be moved here.",
            (false, true) => "",
        };
        if !sentence.is_empty() {
            ui.add(egui::Label::new(RichText::new(sentence).small().color(theme.quiet)).wrap());
        }
        let mut rows: Vec<Rect> = Vec::new();
        for (at, layer) in stack.layers.iter().enumerate() {
            let response = row::show(
                ui,
                context,
                layer,
                |change| command_for(stack, at, change),
                &mut self.renaming,
                actions,
            );
            rows.push(response.rect);
            let seen = response.rect.intersect(ui.clip_rect());
            self.rows.push((seen, layer.node.clone()));
            response.dnd_set_drag_payload(DraggedLayer {
                end: stack.end.clone(),
                at,
            });
            response.context_menu(|ui| self.layer_menu(ui, context, stack, at, actions));
        }
        let title = |dragged: &DraggedLayer| {
            let is_ours = dragged.end == stack.end;
            let layer = stack.layers.get(dragged.at).filter(|_| is_ours);
            layer.map(|layer| layer.title.clone())
        };
        if let Some((dragged, gap)) = reordering::dropped(ui, theme, &rows, title) {
            let from = dragged.at;
            // Gaps are counted with the dragged row still in the list.
            let to = if gap > from { gap - 1 } else { gap };
            if to != from {
                let end = stack.end.clone();
                actions.push(Action::edit(LayerCommand::Move { end, from, to }));
            }
        }
    }

    /// Context menu of a layer.
    fn layer_menu(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        stack: &Stack,
        at: usize,
        actions: &mut Vec<Action>,
    ) {
        let document = context.document;
        let layer = &stack.layers[at];
        ui.menu_button("Add above", |ui| kinds(document, ui, stack, at, actions));
        if layers::mask_input(document, &layer.node).is_some() {
            ui.menu_button("Mask", |ui| masks(ui, context, layer, actions));
        }
        modes(ui, document, layer, actions);
        if ui.button("Rename").clicked() {
            self.renaming = Some(LayerRename::of(layer));
        }
        if ui.button("Show in the graph").clicked() {
            actions.push(Action::GoTo(node_paths::full_id(document, &layer.node)));
        }
        if ui.button("Remove").clicked() {
            actions.push(Action::edit(command_for(stack, at, row::RowChange::Remove)));
        }
    }
}

/// Menus of the blend modes of a layer's node.
fn modes(ui: &mut Ui, document: &OpenDocument, layer: &Layer, actions: &mut Vec<Action>) {
    let Some((interface, node)) = document.interface(&layer.node).zip(document.node(&layer.node)) else {
        return;
    };
    let modes = interface.knobs.iter().filter_map(|knob| match &knob.ty.role {
        Role::Choice(words) if knob.name.ends_with("mode") => Some((knob, words)),
        _ => None,
    });
    for (knob, words) in modes {
        let now = node.params.get(&knob.name).unwrap_or(&knob.ty.default).as_text();
        ui.menu_button(&knob.label, |ui| {
            for word in words {
                if ui.radio(now == Some(word), label_of(word)).clicked() {
                    let (node, knob) = (layer.node.clone(), knob.name.clone());
                    let value = Some(Value::Text(word.clone()));
                    actions.push(Action::edit(KnobCommand::Set { node, knob, value }));
                }
            }
        });
    }
}

/// Menu of nodes that can be the mask of a layer, by category.
fn masks(ui: &mut Ui, context: &ViewContext<'_>, layer: &Layer, actions: &mut Vec<Action>) {
    let document = context.document;
    if layer.mask.is_some() && ui.button("No mask").clicked() {
        actions.push(Action::edit(LayerCommand::RemoveMask(layer.node.clone())));
    }
    painted_masks(ui, layer, actions);
    let Some(input) = layers::mask_input(document, &layer.node) else {
        return;
    };
    let Some(input) = connections::input(document, &input) else {
        return;
    };
    // Nodes without required inputs give a mask at once.
    let gives = |candidate: &&Candidate| {
        let interface = &candidate.interface;
        interface.output_for(input).is_some() && !interface.inputs.iter().any(|port| port.is_required)
    };
    let found: Vec<&Candidate> = context.candidates.iter().filter(gives).collect();
    let mut sections: Vec<&str> = found.iter().map(|candidate| candidate.section.as_str()).collect();
    sections.dedup();
    for section in sections {
        ui.menu_button(label_of(section), |ui| {
            for candidate in found.iter().filter(|candidate| candidate.section == section) {
                let entry = ui
                    .button(&candidate.interface.label)
                    .on_hover_text(&candidate.interface.summary);
                if entry.clicked() {
                    actions.push(Action::edit(LayerCommand::AddMask {
                        node: layer.node.clone(),
                        source: candidate.new.clone(),
                    }));
                }
            }
        });
    }
}

/// Entries for masks that are painted: from black or white, or over the mask that is there.
fn painted_masks(ui: &mut Ui, layer: &Layer, actions: &mut Vec<Action>) {
    for (title, empty, tooltip) in [
        ("Black, to paint", 0.0, "The layer shows only where you paint"),
        ("White, to paint", 1.0, "The layer shows everywhere but where you paint"),
    ] {
        if ui.button(title).on_hover_text(tooltip).clicked() {
            let node = layer.node.clone();
            actions.push(Action::edit(LayerCommand::PaintMask { node, empty }));
            let value = Some(1.0 - empty as f32);
            actions.push(Action::Paint(PaintAction::PaintSelected { value }));
        }
    }
    if let Some(mask) = &layer.mask {
        let paint = ui.button("Paint over it");
        if paint.on_hover_text("Strokes lie over the mask that is there").clicked() {
            actions.push(Action::edit(PaintCommand::Over(mask.node.clone())));
            actions.push(Action::Paint(PaintAction::PaintSelected { value: None }));
        }
    }
    ui.separator();
}

/// Results that rows show: of each layer, and of its mask.
fn wanted(context: &ViewContext<'_>, stacks: &[Stack]) -> Vec<NodeRef> {
    let document = context.document;
    let layers = stacks.iter().flat_map(|stack| &stack.layers);
    let results = layers.flat_map(|layer| {
        let own = context.looks.chosen(document, &layer.node);
        let mask = layer.mask.as_ref();
        let mask = mask.map(|mask| result_of(document, &mask.node, mask.port.clone()));
        std::iter::once(own).chain(mask)
    });
    results.collect()
}

fn head(document: &OpenDocument, ui: &mut Ui, stack: &Stack, actions: &mut Vec<Action>) {
    ui.add(egui::Label::new(RichText::new(&stack.title).strong()).truncate());
    ui.horizontal_wrapped(|ui| {
        by_hand(ui, Some(&stack.end), actions);
        let menu = ui.menu_button(format!("{} Layer", icon::PLUS), |ui| {
            kinds(document, ui, stack, 0, actions)
        });
        menu.response.on_hover_text("Adds a layer of any kind on top");
    });
}

/// Buttons that add painted or filled layers, on top of a stack or with an output of their own.
fn by_hand(ui: &mut Ui, end: Option<&StackEnd>, actions: &mut Vec<Action>) {
    for (what, title) in HandLayer::ALL {
        let (sign, tooltip) = match what {
            HandLayer::Paint => (
                icon::PAINT_BRUSH,
                "Adds a layer whose place and color you paint on the model",
            ),
            HandLayer::Fill => (icon::PAINT_BUCKET, "Adds a layer of one color over all of the surface"),
        };
        let button = ui.button(format!("{sign} {}", title.trim_end_matches(" layer")));
        button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, title));
        if button.on_hover_text(tooltip).clicked() {
            let end = end.cloned();
            actions.push(Action::edit(LayerCommand::AddByHand { end, what }));
            if what == HandLayer::Paint {
                actions.push(Action::Paint(PaintAction::PaintSelected { value: None }));
            }
        }
    }
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
