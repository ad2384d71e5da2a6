//! Variants, library and random values of the selected group instance.

use std::collections::BTreeSet;

use egui::{RichText, Ui, Vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::GroupCommand;
use sabi_engine::catalog::{Entry, KnobRole, label_of};
use sabi_graph::{GROUP_KIND, INSTANCE_KNOBS, LibrarySource, NodeId};

use super::card::Card;
use crate::action::Action;
use crate::context::ViewContext;
use crate::theme::space;
use crate::trials::Trial;

/// Parameter of an instance that chooses a variant of its group.
const VARIANT: &str = "variant";

/// Knobs of instances that random values leave alone.
pub(super) type Kept = BTreeSet<(NodeId, String)>;

/// Shows the variants, the library and the random values of an instance; nothing for other nodes, and for several.
pub(super) fn show(ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId, face: &Entry, kept: &mut Kept) -> Vec<Action> {
    let document = context.document;
    if document.selection().len() != 1 {
        return Vec::new();
    }
    let Some(name) = document
        .node(id)
        .filter(|node| node.kind == GROUP_KIND)
        .and_then(|node| node.group.as_ref())
    else {
        return Vec::new();
    };
    let mut commands = Vec::new();
    ui.horizontal_wrapped(|ui| {
        let random = ui.button(format!("{} Random", icon::DICE_FIVE));
        let random = random.on_hover_text("Other patterns, and other values near those that the group was made with");
        if random.clicked() {
            let of_node = kept.iter().filter(|(node, _)| node == id);
            commands.push(GroupCommand::Randomize {
                node: id.clone(),
                kept: of_node.map(|(_, knob)| knob.clone()).collect(),
            });
        }
        let keep = ui.menu_button(format!("{} Keep", icon::LOCK_SIMPLE), |ui| {
            keep_menu(ui, id, face, kept)
        });
        keep.response.on_hover_text("Parameters that Random leaves alone");
    });
    commands.extend(variants(ui, context, id, face));
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

/// Variants of the group as cards, each with the picture of the model on which the instance has that variant.
fn variants(ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId, face: &Entry) -> Option<GroupCommand> {
    let knob = face.knobs.iter().find(|knob| knob.name == VARIANT)?;
    let KnobRole::Choice(words) = &knob.ty.role else {
        return None;
    };
    let document = context.document;
    let value = document.node(id)?.params.get(VARIANT).unwrap_or(&knob.ty.default);
    let shown = value.as_text();
    let mut chosen = None;
    ui.add_space(space::TIGHT);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(space::USUAL);
        for (at, word) in words.iter().enumerate() {
            // The first word stands for no variant.
            let name = (at > 0).then(|| word.clone());
            let label = name.as_deref().map_or_else(|| "Base".to_owned(), label_of);
            let card = Card {
                label: &label,
                picture: context.trials.find(Trial::Variant {
                    place: format!("{:?} {id}", document.shown()),
                    instance: Some(id.clone()),
                    name,
                }),
                sign: icon::SWATCHES,
                is_shown: shown == Some(word),
            };
            let response = card.show(ui, context.theme);
            if response
                .on_hover_text("Gives the parameters the values of this variant")
                .clicked()
            {
                let (node, name) = (id.clone(), (at > 0).then(|| word.clone()));
                chosen = Some(GroupCommand::ChooseVariant { node, name });
            }
        }
    });
    chosen
}

fn keep_menu(ui: &mut Ui, id: &NodeId, face: &Entry, kept: &mut Kept) {
    let own = face
        .knobs
        .iter()
        .filter(|knob| knob.name == "seed" || !INSTANCE_KNOBS.contains(&knob.name.as_str()));
    for knob in own {
        let key = (id.clone(), knob.name.clone());
        let mut is_kept = kept.contains(&key);
        if ui.checkbox(&mut is_kept, &knob.label).changed() {
            match is_kept {
                true => kept.insert(key),
                false => kept.remove(&key),
            };
        }
    }
}

/// Link of a group to its library, and what can be done about it.
fn library(ui: &mut Ui, context: &ViewContext<'_>, group: &str, source: &LibrarySource) -> Vec<GroupCommand> {
    let mut commands = Vec::new();
    let outdated = outdated(context);
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
    if outdated.iter().any(|name| name == group) {
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(context.theme.warning, "The library has a newer version.");
            if ui
                .button("Update")
                .on_hover_text("Keeps the values of the parameters")
                .clicked()
            {
                commands.push(GroupCommand::Update(vec![group.to_owned()]));
            }
            if outdated.len() > 1 && ui.button(format!("Update all {}", outdated.len())).clicked() {
                commands.push(GroupCommand::Update(outdated.clone()));
            }
        });
    }
    commands
}

/// Linked groups of the document whose library has another version.
fn outdated(context: &ViewContext<'_>) -> Vec<String> {
    let groups = context.document.contents().groups.iter();
    let is_outdated = |source: &LibrarySource| {
        context
            .library
            .digest(context.document, source)
            .is_some_and(|digest| digest != source.digest)
    };
    let outdated = groups.filter(|(_, group)| group.library.as_ref().is_some_and(is_outdated));
    outdated.map(|(name, _)| name.clone()).collect()
}
