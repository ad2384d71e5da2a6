//! The exposed knobs of the shown graph.

use std::collections::BTreeMap;

use sabi_engine::catalog::Knob;
use sabi_graph::{Edit, ExposedParameter, INSTANCE_KNOBS, NodeId, SlotRef, Value};

use crate::instances::interface_of;
use crate::names::{free_name, knob_label};
use crate::open_document::OpenDocument;
use crate::{instances, shown_variant};

/// A knob that the shown graph exposes.
#[derive(Clone, Debug, PartialEq)]
pub struct ExposedKnob {
    /// Name in files and on command lines.
    pub name: String,
    /// Definition of the exposed knob in the graph.
    pub exposed: ExposedParameter,
    /// Appearance of the knob: that of the first knob that it controls, with its own name and range.
    pub knob: Knob,
    /// Current value, in the shown variant if there is one.
    pub value: Value,
    /// Value that a reset restores: the value without the shown variant; if no variant is shown, the value when the graph
    /// was opened; for a knob that was exposed later, the default of its node's kind. In a group that was added later, it is the
    /// current value.
    pub at_first: Value,
}

/// Returns the exposed knobs in the order in which they are shown. A knob that controls only unknown knobs is left out.
pub fn knobs(document: &OpenDocument) -> Vec<ExposedKnob> {
    let interface = document.own_interface();
    let opened = interface_of(&document.opened, document.shown());
    let variant = shown_variant::values(document).map(|(_, values)| values);
    let set: BTreeMap<&str, &Value> = document.graph().knob_values(variant).collect();
    let knobs = document
        .graph()
        .exposed_in_order()
        .into_iter()
        .filter_map(|(name, exposed)| {
            let knob = interface?.knob(name)?.clone();
            let first = exposed.to.first()?;
            let inner = document.interface(&first.node)?.knob(&first.name)?;
            // If an exposed knob has a default, that is its value.
            let own = &knob.ty.default;
            let opened_with = match opened.map(|interface| interface.knob(name)) {
                Some(Some(before)) => &before.ty.default,
                Some(None) => &inner.ty.default,
                // A group that came later, as an effect of the library does, begins with its own values.
                None => own,
            };
            Some(ExposedKnob {
                at_first: if variant.is_some() { own } else { opened_with }.clone(),
                name: name.to_owned(),
                exposed: exposed.clone(),
                value: set.get(name).map_or(own, |value| *value).clone(),
                knob,
            })
        });
    knobs.collect()
}

/// Exposes a knob of a node under a name of the shown graph that is free.
pub fn expose(document: &mut OpenDocument, id: &NodeId, knob: &str) -> bool {
    if let Some(name) = exposed_as(document, id, knob) {
        let why = format!("this parameter is exposed already, as '{name}'");
        return document.refuse(why);
    }
    let Some(label) = document
        .interface(id)
        .and_then(|interface| interface.knob(knob))
        .map(|knob| knob.label.clone())
    else {
        let title = document.title(id);
        return document.refuse(format!("'{title}' has no parameter '{knob}'"));
    };
    // Every instance has some built-in knobs, whose names are reserved.
    let stem = match INSTANCE_KNOBS.contains(&knob) {
        true => format!(
            "{}_{knob}",
            id.as_str().rsplit_once('_').map_or(id.as_str(), |(stem, _)| stem)
        ),
        false => knob.to_owned(),
    };
    let name = free_name(&stem, '_', |name| document.graph().exposed().contains_key(name));
    let slot = SlotRef {
        node: id.clone(),
        name: knob.to_owned(),
    };
    let exposed = ExposedParameter {
        to: vec![slot],
        label: Some(label),
        ..ExposedParameter::default()
    };
    let edit = exposing(document, &name, exposed);
    document.edit("Expose", vec![edit])
}

/// Adds a knob of a node to the knobs that an exposed knob controls.
pub fn expose_also(document: &mut OpenDocument, id: &NodeId, knob: &str, name: &str) -> bool {
    let Some(mut exposed) = document.graph().exposed().get(name).cloned() else {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    };
    let slot = SlotRef {
        node: id.clone(),
        name: knob.to_owned(),
    };
    let first = exposed
        .to
        .first()
        .and_then(|slot| document.interface(&slot.node)?.knob(&slot.name));
    let own = document.interface(id).and_then(|interface| interface.knob(knob));
    let is_alike = first.zip(own).is_some_and(|(first, own)| {
        let like = |knob: &Knob| (knob.ty.role.clone(), knob.ty.memory);
        like(first) == like(own)
    });
    if !is_alike {
        let exposed = knob_label(document.own_interface(), name);
        let own = own.map_or(knob, |own| &own.label);
        return document.refuse(format!("'{exposed}' holds values of another sort than '{own}'"));
    }
    if exposed.to.contains(&slot) {
        return true;
    }
    exposed.to.push(slot);
    let edit = exposing(document, name, exposed);
    document.edit("Expose", vec![edit])
}

/// Exposes a knob of a node together with those of the selected nodes of its kind.
pub fn expose_of_selected(document: &mut OpenDocument, id: &NodeId, knob: &str) -> bool {
    let kind = |id: &NodeId| document.node(id).map(|node| &node.kind);
    let selected = document.selection().iter();
    let alike = selected.filter(|other| *other != id && kind(other) == kind(id));
    let alike: Vec<NodeId> = alike.cloned().collect();
    document.session.begin("Expose");
    let is_new = expose(document, id, knob);
    if let Some(name) = exposed_as(document, id, knob).map(str::to_owned) {
        for other in alike {
            expose_also(document, &other, knob, &name);
        }
    }
    document.session.end();
    is_new
}

/// Returns the name under which a knob of a node is exposed; `None` if it is not.
pub fn exposed_as<'d>(document: &'d OpenDocument, id: &NodeId, knob: &str) -> Option<&'d str> {
    let is_meant = |slot: &SlotRef| slot.node == *id && slot.name == knob;
    let mut exposed = document.graph().exposed().iter();
    exposed
        .find(|(_, known)| known.to.iter().any(is_meant))
        .map(|(name, _)| name.as_str())
}

/// Exposes a knob no longer.
pub fn unexpose(document: &mut OpenDocument, name: &str) -> bool {
    let edit = Edit::Unexpose {
        body: document.body(),
        name: name.to_owned(),
    };
    document.edit("Stop exposing", vec![edit])
}

/// Exposes a knob of a node no longer. Other knobs that the same exposed knob controls stay.
pub fn unexpose_knob(document: &mut OpenDocument, id: &NodeId, knob: &str) -> bool {
    let Some(name) = exposed_as(document, id, knob).map(str::to_owned) else {
        return false;
    };
    let Some(exposed) = document.graph().exposed().get(&name) else {
        return false;
    };
    let kept = exposed.to.iter().filter(|slot| slot.node != *id || slot.name != knob);
    let exposed = exposed.with_targets(kept.cloned().collect());
    if exposed.to.is_empty() {
        return unexpose(document, &name);
    }
    let edit = exposing(document, &name, exposed);
    document.edit("Stop exposing", vec![edit])
}

/// Renames an exposed knob, in files, variants and all instances.
pub fn rename(document: &mut OpenDocument, name: &str, to: &str) -> bool {
    let to = to.trim();
    let Some(exposed) = document.graph().exposed().get(name).cloned() else {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    };
    if name == to {
        return true;
    }
    if document.graph().exposed().contains_key(to) {
        return document.refuse(format!("there is a parameter '{to}' already; choose another name"));
    }
    if INSTANCE_KNOBS.contains(&to) {
        return document.refuse(format!("every group has a parameter '{to}'; choose another name"));
    }
    let mut edits = vec![exposing(document, to, exposed)];
    for (variant, values) in document.graph().variants() {
        let mut values = values.clone();
        if let Some(value) = values.remove(name) {
            values.insert(to.to_owned(), value);
            edits.push(Edit::SetVariant {
                body: document.body(),
                name: variant.clone(),
                values: Some(values),
            });
        }
    }
    edits.push(Edit::Unexpose {
        body: document.body(),
        name: name.to_owned(),
    });
    for (body, id, node) in instances::of_body(document.contents(), document.shown()) {
        let Some(value) = node.params.get(name).cloned() else {
            continue;
        };
        for (param, value) in [(name, None), (to, Some(value))] {
            edits.push(Edit::SetParam {
                body: body.clone(),
                node: id.clone(),
                param: param.to_owned(),
                value,
            });
        }
    }
    let is_ours = instances::is_instance_of(document.contents(), document.shown());
    edits.extend(instances::renamed_knobs(
        document.contents(),
        |body, slot| is_ours(body, slot) && slot.name == name,
        to,
    ));
    document.edit("Rename parameter", edits)
}

/// Changes the definition of an exposed knob.
fn change(document: &mut OpenDocument, step: &str, name: &str, change: impl FnOnce(&mut ExposedParameter)) -> bool {
    let Some(mut exposed) = document.graph().exposed().get(name).cloned() else {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    };
    change(&mut exposed);
    let edit = exposing(document, name, exposed);
    document.edit(step, vec![edit])
}

/// Sets the label of an exposed knob; an empty one restores that of the knob that it controls.
pub fn set_label(document: &mut OpenDocument, name: &str, label: &str) -> bool {
    let label = Some(label.trim().to_owned()).filter(|label| !label.is_empty());
    change(document, "Rename parameter", name, |knob| knob.label = label)
}

/// Sets the section of an exposed knob; an empty one is none.
pub fn set_section(document: &mut OpenDocument, name: &str, section: &str) -> bool {
    let section = Some(section.trim().to_owned()).filter(|section| !section.is_empty());
    change(document, "Move parameter", name, |knob| knob.section = section)
}

/// Moves an exposed knob before another one and into its section, or to the end.
pub fn move_knob(document: &mut OpenDocument, name: &str, before: Option<&str>) -> bool {
    let graph = document.graph();
    let mut names: Vec<&str> = graph.exposed_in_order().into_iter().map(|(name, _)| name).collect();
    if !names.contains(&name) {
        return document.refuse(format!("there is no exposed parameter '{name}'"));
    }
    if before == Some(name) {
        return true;
    }
    names.retain(|other| *other != name);
    let at = before.and_then(|before| names.iter().position(|other| *other == before));
    let at = at.unwrap_or(names.len());
    let beside = names
        .get(at)
        .or(names.last())
        .and_then(|other| graph.exposed().get(*other));
    let section = beside.map(|other| other.section.clone());
    names.insert(at, name);
    let mut edits = Vec::new();
    for (order, known) in (1..).zip(&names) {
        let Some(mut exposed) = graph.exposed().get(*known).cloned() else {
            continue;
        };
        exposed.order = Some(order);
        if let Some(section) = section.as_ref().filter(|_| *known == name) {
            exposed.section = section.clone();
        }
        edits.push(exposing(document, known, exposed));
    }
    document.edit("Move parameter", edits)
}

/// Edit that sets the definition of an exposed knob.
pub(crate) fn exposing(document: &OpenDocument, name: &str, knob: ExposedParameter) -> Edit {
    Edit::Expose {
        body: document.body(),
        name: name.to_owned(),
        knob,
    }
}
