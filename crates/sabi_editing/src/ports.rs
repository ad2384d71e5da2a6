//! Inputs and outputs that the shown graph has when used as a group. Its instances are adapted to changes.

use std::collections::BTreeMap;

use sabi_engine::catalog::Port;
use sabi_graph::{Edit, GroupInput, NodeId, OutputRef, PortType, SlotRef};
use sabi_nodes::label_of;

use crate::connections::PendingWire;
use crate::names::free_name;
use crate::open_document::OpenDocument;
use crate::{connections, instances};

/// Inputs of the shown graph.
pub fn inputs(document: &OpenDocument) -> &BTreeMap<String, GroupInput> {
    instances::ports(document.contents(), document.shown()).0
}

/// Label of an input of the shown graph.
pub fn input_label(document: &OpenDocument, name: &str) -> String {
    let known = document.own_interface().and_then(|interface| interface.input(name));
    known.map_or_else(|| label_of(name), |port| port.label.clone())
}

/// Label of an output of the shown graph.
pub fn output_label(document: &OpenDocument, name: &str) -> String {
    let known = document
        .own_interface()
        .and_then(|interface| interface.output(Some(name)));
    known.map_or_else(|| label_of(name), |port| port.label.clone())
}

/// Outputs of the shown graph.
pub fn outputs(document: &OpenDocument) -> &BTreeMap<String, OutputRef> {
    instances::ports(document.contents(), document.shown()).1
}

/// Exposes an input of a node as an input of the group. Returns its name.
pub fn expose_input(document: &mut OpenDocument, slot: &SlotRef) -> Option<String> {
    let name = free_name(&slot.name, '_', |name| inputs(document).contains_key(name));
    let input = GroupInput {
        to: vec![slot.clone()],
        ..GroupInput::default()
    };
    if let Err(why) = check_feed(document, None, slot) {
        document.notify(why);
        return None;
    }
    let edit = setting_input(document, &name, Some(input));
    document.edit("Add input", vec![edit]).then_some(name)
}

/// Connects an input of the group to one more input of a node.
pub fn feed(document: &mut OpenDocument, name: &str, slot: &SlotRef) -> bool {
    let Some(mut input) = inputs(document).get(name).cloned() else {
        return document.refuse(format!("the group has no input '{name}'"));
    };
    if input.to.contains(slot) {
        return true;
    }
    if let Err(why) = check_feed(document, Some(&input), slot) {
        return document.refuse(why);
    }
    let mut edits = Vec::new();
    // An input of a node can be fed by only one input of the group: the one connected last.
    if let Some((other, mut known)) = feeding(document, slot) {
        known.to.retain(|fed| fed != slot);
        edits.push(setting_input(document, &other, Some(known)));
    }
    input.to.push(slot.clone());
    edits.push(setting_input(document, name, Some(input)));
    document.edit("Connect input", edits)
}

/// Disconnects an input of a node from the group's input that feeds it.
pub fn unfeed(document: &mut OpenDocument, slot: &SlotRef) -> bool {
    let Some((name, mut input)) = feeding(document, slot) else {
        return false;
    };
    input.to.retain(|fed| fed != slot);
    let edit = setting_input(document, &name, Some(input));
    document.edit("Disconnect input", vec![edit])
}

/// Returns the inputs of these nodes that are fed by the group, each with the name of the group's input.
pub(crate) fn fed_by_group(document: &OpenDocument, is_meant: impl Fn(&NodeId) -> bool) -> Vec<(SlotRef, String)> {
    let inputs = inputs(document).iter();
    let slots = inputs.flat_map(|(name, input)| input.to.iter().map(move |slot| (slot.clone(), name.clone())));
    slots.filter(|(slot, _)| is_meant(&slot.node)).collect()
}

/// Adds the edits after which each of these inputs is fed by the given input of the group, or by no input. Edits that are
/// in the list already are taken into account.
pub(crate) fn refeed(document: &OpenDocument, edits: &mut Vec<Edit>, fed: Vec<(SlotRef, Option<String>)>) {
    let feeds = |name: &str, slot: &SlotRef| fed.iter().any(|(to, by)| to == slot && by.as_deref() == Some(name));
    for (name, input) in inputs(document) {
        let made = edits
            .iter()
            .rposition(|edit| matches!(edit, Edit::SetInput { name: set, .. } if set == name));
        let by_edits = made.and_then(|at| match &edits[at] {
            Edit::SetInput { input, .. } => input.clone(),
            _ => None,
        });
        let before = by_edits.unwrap_or_else(|| input.clone());
        let mut after = before.clone();
        after
            .to
            .retain(|slot| feeds(name, slot) || fed.iter().all(|(known, _)| known != slot));
        for (slot, _) in &fed {
            if feeds(name, slot) && !after.to.contains(slot) {
                after.to.push(slot.clone());
            }
        }
        if after != before {
            edits.push(setting_input(document, name, Some(after)));
        }
    }
}

fn feeding(document: &OpenDocument, slot: &SlotRef) -> Option<(String, GroupInput)> {
    let name = connections::feeder(document, document.shown(), slot)?.to_owned();
    let input = inputs(document).get(&name)?.clone();
    Some((name, input))
}

/// Checks that an input of the group (or, for `None`, a new input) can feed an input of a node. The error is the reason why not.
fn check_feed(document: &OpenDocument, input: Option<&GroupInput>, slot: &SlotRef) -> Result<(), String> {
    let Some(port) = connections::input(document, slot) else {
        return Err(format!("'{}' has no input '{}'", document.title(&slot.node), slot.name));
    };
    let Some(input) = input else {
        return match connections::feeder(document, document.shown(), slot) {
            Some(name) => Err(format!(
                "the group's input '{}' leads there already",
                input_label(document, name)
            )),
            None => Ok(()),
        };
    };
    let fed = input.to.iter().find_map(|slot| connections::input(document, slot)?.ty);
    let carried: Option<PortType> = input.ty.or(fed);
    match (carried, port.ty) {
        (Some(carried), Some(takes)) if !takes.accepts(carried) => Err(format!(
            "'{}' takes a {takes}, and this input of the group carries a {carried}",
            port.label
        )),
        _ => Ok(()),
    }
}

/// Lists the unconnected inputs of nodes that an input of the group could feed. Inputs for masks that multiply parameters come last.
pub fn feedable(document: &OpenDocument, name: &str) -> Vec<SlotRef> {
    let Some(input) = inputs(document).get(name) else {
        return Vec::new();
    };
    let interfaces = || {
        document
            .graph()
            .ids()
            .filter_map(|id| Some((id, document.interface(id)?)))
    };
    let slot = |id: &NodeId, port: &Port| SlotRef {
        node: id.clone(),
        name: port.name.clone(),
    };
    let plain = interfaces().flat_map(|(id, interface)| interface.plain_inputs().map(move |port| slot(id, port)));
    let masks = interfaces().flat_map(|(id, interface)| interface.param_masks.iter().map(move |port| slot(id, port)));
    let is_free = |slot: &SlotRef| {
        connections::wire_into(document, slot).is_none()
            && connections::feeder(document, document.shown(), slot).is_none()
    };
    plain
        .chain(masks)
        .filter(|slot| is_free(slot) && check_feed(document, Some(input), slot).is_ok())
        .collect()
}

/// All outputs of the nodes in the shown graph.
pub fn results(document: &OpenDocument) -> Vec<OutputRef> {
    let all = document.graph().ids().flat_map(|id| {
        let ports = document
            .interface(id)
            .into_iter()
            .flat_map(|interface| &interface.outputs);
        ports.map(|port| OutputRef {
            node: id.clone(),
            port: Some(port.name.clone()),
        })
    });
    all.collect()
}

/// Returns the name under which a port is exposed; `None` if it is not.
pub fn exposed_as<'d>(document: &'d OpenDocument, port: &PendingWire) -> Option<&'d str> {
    match port {
        PendingWire::Into(slot) => connections::feeder(document, document.shown(), slot),
        PendingWire::From(result) => {
            let result = connections::canonical(document, result);
            let mut outputs = outputs(document).iter();
            let given = outputs.find(|(_, from)| connections::canonical(document, from) == result);
            given.map(|(name, _)| name.as_str())
        }
    }
}

/// Removes an input of the group.
pub fn remove_input(document: &mut OpenDocument, name: &str) -> bool {
    let edit = setting_input(document, name, None);
    document.edit("Remove input", vec![edit])
}

/// Sets the label of an input of the group; an empty one restores its name.
pub fn set_input_label(document: &mut OpenDocument, name: &str, label: &str) -> bool {
    let Some(input) = inputs(document).get(name).cloned() else {
        return document.refuse(format!("the group has no input '{name}'"));
    };
    let label = Some(label.trim().to_owned()).filter(|label| !label.is_empty());
    let edit = setting_input(document, name, Some(GroupInput { label, ..input }));
    document.edit("Rename input", vec![edit])
}

/// Renames an input of the group, in files and in all its instances.
pub fn rename_input(document: &mut OpenDocument, name: &str, to: &str) -> bool {
    let to = to.trim();
    let Some(input) = inputs(document).get(name).cloned() else {
        return document.refuse(format!("the group has no input '{name}'"));
    };
    if name == to {
        return true;
    }
    if inputs(document).contains_key(to) {
        return document.refuse(format!("the group has an input '{to}' already; choose another name"));
    }
    let mut edits = vec![
        setting_input(document, name, None),
        setting_input(document, to, Some(input)),
    ];
    for (body, node, _) in instances::of_body(document.contents(), document.shown()) {
        let graph = document.graph_of(&body);
        let Some(from) = graph.and_then(|graph| graph.link_into(node.as_str(), name)).cloned() else {
            continue;
        };
        let input = name.to_owned();
        edits.push(Edit::Disconnect {
            body: body.clone(),
            node: node.clone(),
            input,
        });
        let (body, input) = (body.clone(), to.to_owned());
        edits.push(Edit::Connect {
            body,
            node,
            input,
            from,
        });
    }
    let is_ours = instances::is_instance_of(document.contents(), document.shown());
    edits.extend(instances::renamed_inputs(
        document.contents(),
        |body, slot| is_ours(body, slot) && slot.name == name,
        to,
    ));
    document.edit("Rename input", edits)
}

/// Exposes an output of a node as an output of the group. Returns its name.
pub fn expose_output(document: &mut OpenDocument, from: &OutputRef) -> Option<String> {
    let port = document
        .interface(&from.node)
        .and_then(|interface| interface.output(from.port.as_deref()));
    let Some(stem) = port.map(|port| port.name.clone()) else {
        document.notify(format!("'{}' gives no such result", document.title(&from.node)));
        return None;
    };
    let name = free_name(&stem, '_', |name| outputs(document).contains_key(name));
    let edit = setting_output(document, &name, Some(connections::canonical(document, from)));
    document.edit("Add output", vec![edit]).then_some(name)
}

/// Connects an output of the group to another output of a node.
pub fn retarget_output(document: &mut OpenDocument, name: &str, from: &OutputRef) -> bool {
    if !outputs(document).contains_key(name) {
        return document.refuse(format!("the group has no output '{name}'"));
    }
    let interface = document.interface(&from.node);
    if interface
        .and_then(|interface| interface.output(from.port.as_deref()))
        .is_none()
    {
        let title = document.title(&from.node);
        return document.refuse(format!("'{title}' gives no such result"));
    }
    let edit = setting_output(document, name, Some(connections::canonical(document, from)));
    document.edit("Connect output", vec![edit])
}

/// Removes an output of the group.
pub fn remove_output(document: &mut OpenDocument, name: &str) -> bool {
    let edit = setting_output(document, name, None);
    document.edit("Remove output", vec![edit])
}

/// Renames an output of the group, in files and in all its instances.
pub fn rename_output(document: &mut OpenDocument, name: &str, to: &str) -> bool {
    let to = to.trim();
    let Some(output) = outputs(document).get(name).cloned() else {
        return document.refuse(format!("the group has no output '{name}'"));
    };
    if name == to {
        return true;
    }
    if outputs(document).contains_key(to) {
        return document.refuse(format!("the group has an output '{to}' already; choose another name"));
    }
    let mut edits = vec![
        setting_output(document, name, None),
        setting_output(document, to, Some(output)),
    ];
    for (body, id, _) in instances::of_body(document.contents(), document.shown()) {
        let Some(graph) = document.graph_of(&body) else {
            continue;
        };
        let renamed = OutputRef {
            node: id.clone(),
            port: Some(to.to_owned()),
        };
        let is_meant = |from: &&OutputRef| from.node == id && from.port.as_deref() == Some(name);
        for slot in graph.readers(id.as_str()) {
            let tied = graph.link_into(slot.node.as_str(), &slot.name);
            edits.extend(tied.filter(is_meant).map(|_| Edit::Connect {
                body: body.clone(),
                node: slot.node,
                input: slot.name,
                from: renamed.clone(),
            }));
        }
        let (_, outputs) = instances::ports(document.contents(), &body);
        for (outer, _) in outputs.iter().filter(|(_, from)| is_meant(from)) {
            let (body, name, output) = (body.clone(), outer.clone(), Some(renamed.clone()));
            edits.push(Edit::SetOutput { body, name, output });
        }
    }
    document.edit("Rename output", edits)
}

fn setting_input(document: &OpenDocument, name: &str, input: Option<GroupInput>) -> Edit {
    Edit::SetInput {
        body: document.body(),
        name: name.to_owned(),
        input,
    }
}

fn setting_output(document: &OpenDocument, name: &str, output: Option<OutputRef>) -> Edit {
    Edit::SetOutput {
        body: document.body(),
        name: name.to_owned(),
        output,
    }
}
