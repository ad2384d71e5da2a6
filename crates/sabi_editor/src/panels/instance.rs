//! Variants, library and random values of the selected group instance.

use egui::{RichText, Ui, Vec2};
use egui_phosphor::regular as icon;
use sabi_editing::OpenDocument;
use sabi_editing::command::GroupCommand;
use sabi_editing::random_knobs::SEED;
use sabi_engine::catalog::Interface;
use sabi_graph::{GROUP_KIND, INSTANCE_KNOBS, LibrarySource, NodeId};
use sabi_nodes::kind::Role;
use sabi_nodes::label_of;

use super::card::{Card, CardSize};
use super::random::{self, LockedParameters};
use super::update;
use crate::action::Action;
use crate::choice_previews::PreviewChoice;
use crate::context::ViewContext;
use crate::theme::{space, type_size};

/// Parameter of an instance that chooses a variant of its group.
const VARIANT: &str = "variant";

/// Group of a node, if the node is a group instance and the only selected node.
fn group_of<'d>(document: &'d OpenDocument, id: &NodeId) -> Option<&'d String> {
    let node = document.node(id).filter(|node| node.kind == GROUP_KIND)?;
    node.group.as_ref().filter(|_| document.selection().len() == 1)
}

/// Shows the random values of an instance; nothing for other nodes, and for several.
pub(super) fn random_values(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    id: &NodeId,
    interface: &Interface,
    state: &mut InstanceState,
) -> Option<Action> {
    group_of(context.document, id)?;
    let own = interface
        .knobs
        .iter()
        .filter(|knob| knob.name == SEED || !INSTANCE_KNOBS.contains(&knob.name.as_str()));
    let own: Vec<(&str, &str)> = own.map(|knob| (knob.name.as_str(), knob.label.as_str())).collect();
    let kept = random::show(ui, id, &own, &mut state.kept)?;
    Some(Action::edit(GroupCommand::Randomize { node: id.clone(), kept }))
}

/// Shows the variants and the library of an instance; nothing for other nodes, and for several.
pub(super) fn show(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    id: &NodeId,
    interface: &Interface,
    state: &mut InstanceState,
) -> Vec<Action> {
    let document = context.document;
    let Some(name) = group_of(document, id) else {
        return Vec::new();
    };
    let mut commands = Vec::new();
    commands.extend(variants(ui, context, id, interface, &mut state.cards));
    let linked = document
        .contents()
        .groups
        .get(name)
        .and_then(|group| group.library.as_ref());
    if let Some(source) = linked {
        commands.extend(library(ui, context, name, source));
    }
    commands.into_iter().map(Action::edit).collect()
}

/// State of the part of the panel that is about instances.
#[derive(Default)]
pub(super) struct InstanceState {
    /// Knobs of instances that random values leave alone.
    kept: LockedParameters<NodeId>,
    /// Size of the cards of variants.
    cards: CardSize,
}

/// Variants of the group as cards, each with the picture of the model on which the instance has that variant.
fn variants(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    id: &NodeId,
    interface: &Interface,
    size: &mut CardSize,
) -> Option<GroupCommand> {
    let knob = interface.knobs.iter().find(|knob| knob.name == VARIANT)?;
    let Role::Choice(words) = &knob.ty.role else {
        return None;
    };
    let document = context.document;
    let value = document.node(id)?.params.get(VARIANT).unwrap_or(&knob.ty.default);
    let shown = value.as_text();
    let mut chosen = None;
    ui.add_space(space::WIDE);
    ui.horizontal(|ui| {
        ui.label(
            RichText::new("VARIANTS")
                .size(type_size::SMALL)
                .color(context.theme.quiet),
        );
        size.switch(ui);
    });
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(space::USUAL);
        for (at, word) in words.iter().enumerate() {
            // The first card is for the values without a variant.
            let name = (at > 0).then(|| word.clone());
            let label = name.as_deref().map_or_else(|| "Base".to_owned(), label_of);
            let card = Card {
                label: &label,
                picture: context.choice_previews.find(PreviewChoice::Variant {
                    place: format!("{:?} {id}", document.shown()),
                    instance: Some(id.clone()),
                    name,
                }),
                sign: icon::SWATCHES,
                is_shown: shown == Some(word),
                size: *size,
            };
            let text = "Gives the parameters the values of this variant";
            if card.show(ui, context.theme, text).clicked() {
                let (node, name) = (id.clone(), (at > 0).then(|| word.clone()));
                chosen = Some(GroupCommand::ChooseVariant { node, name });
            }
        }
    });
    chosen
}

/// Link of a group to its library, with buttons that unlink and update it.
fn library(ui: &mut Ui, context: &ViewContext<'_>, group: &str, source: &LibrarySource) -> Vec<GroupCommand> {
    let mut commands = Vec::new();
    ui.horizontal_wrapped(|ui| {
        let shown = format!("{} {}", icon::LINK_SIMPLE, source.file.replace(':', " / "));
        ui.label(RichText::new(shown).color(context.theme.quiet));
        let unlink = ui.small_button("Unlink");
        if unlink
            .on_hover_text("The group stays as it is, and newer versions are not offered any more")
            .clicked()
        {
            commands.push(GroupCommand::Unlink(group.to_owned()));
        }
    });
    commands.extend(update::of_group(ui, context, group));
    commands
}
