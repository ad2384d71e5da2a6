//! Moving, adding and removing layers of a stack: the chain of layers is reconnected, and all other wires stay.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sabi_engine::catalog::Interface;
use sabi_graph::{Edit, NodeId, OutputRef, PortType, SlotRef, Value};

use crate::connections::port_in_wire;
use crate::node_size::NODE_WIDTH;
use crate::open_document::OpenDocument;
use crate::ports::input_label;
use crate::stack::{Layer, LayerLink, Stack, StackEnd, main_input};
use crate::{connections, new_nodes, node_size, nodes, ports, reconnection, stack, wires};

/// Space between a new layer or mask and the node that reads it, canvas points.
const BESIDE: f32 = 60.0;
/// Height of most nodes that output masks, canvas points.
const MASK_HEIGHT: f32 = 280.0;

fn stack_behind(document: &mut OpenDocument, end: &StackEnd) -> Option<Stack> {
    let found = stack::all(document).into_iter().find(|stack| stack.end == *end);
    if found.is_none() {
        document.notify("the output of this stack is gone");
    }
    found
}

/// Moves a layer of a stack to another position, counted from the top.
pub fn move_to(document: &mut OpenDocument, end: &StackEnd, from: usize, to: usize) -> bool {
    let Some(stack) = stack_behind(document, end) else {
        return false;
    };
    if from.max(to) >= stack.layers.len() {
        return document.refuse("there is no such layer");
    }
    if from == to {
        return true;
    }
    if let Some(why) = why_not_move(document, &stack, from.min(to), from.max(to)) {
        return document.refuse(why);
    }
    let edits = reordered(document, &stack, from, to);
    document.edit("Move layer", edits)
}

/// Returns the reason why the layers from `top` down to `bottom` cannot be reordered; none if they can.
fn why_not_move(document: &OpenDocument, stack: &Stack, top: usize, bottom: usize) -> Option<String> {
    let layers = &stack.layers[top..=bottom];
    let held = layers
        .iter()
        .find_map(|layer| layer.shared.clone().or_else(|| layer.is_lowest.clone()));
    if held.is_some() {
        return held;
    }
    let links = &stack.links[top..=bottom + 1];
    if links.iter().any(|link| link.is_shared) {
        return Some(
            "a reroute between these layers has other readers, which would change too; use the canvas".to_owned(),
        );
    }
    let needs_one = |layer: &Layer| {
        let port = document
            .interface(&layer.node)
            .and_then(|interface| main_input(interface));
        port.is_some_and(|port| port.is_required)
    };
    let is_open = stack.links[bottom + 1].from.is_none();
    let needy = layers.iter().find(|layer| is_open && needs_one(layer))?;
    Some(format!("'{}' needs a material below it", needy.title))
}

/// Edits that move a layer to its new position.
fn reordered(document: &OpenDocument, stack: &Stack, from: usize, to: usize) -> Vec<Edit> {
    let (top, bottom) = (from.min(to), from.max(to));
    let mut order: Vec<usize> = (top..=bottom).filter(|at| *at != from).collect();
    order.insert(to - top, from);
    // Each layer reads the next one. The last layer reads the material that was below all of them.
    let readers = std::iter::once(top).chain(order.iter().map(|at| at + 1));
    let sources = order.iter().copied().chain([bottom + 1]);
    let (mut off, mut on) = (Vec::new(), Vec::new());
    for (reader, source) in readers.zip(sources) {
        let (reader, source) = (&stack.links[reader], &stack.links[source]);
        if reader.from == source.from {
            continue;
        }
        // First remove all wires, since a partly connected new order could form a cycle.
        off.extend(
            reader
                .slot
                .as_ref()
                .map(|slot| connections::disconnecting(document, slot)),
        );
        on.extend(link_edit(
            document,
            &stack.end,
            reader.slot.as_ref(),
            source.from.as_ref(),
        ));
    }
    off.into_iter().chain(on).collect()
}

/// Returns an edit that connects an input, or the graph output at the end of a stack, to a result.
fn link_edit(
    document: &OpenDocument,
    end: &StackEnd,
    slot: Option<&SlotRef>,
    from: Option<&OutputRef>,
) -> Option<Edit> {
    match (slot, end) {
        (Some(slot), _) => Some(connections::connecting(document, from?, slot)),
        (None, StackEnd::Port(name)) => Some(Edit::SetOutput {
            body: document.body(),
            name: name.clone(),
            output: Some(from?.clone()),
        }),
        (None, StackEnd::Node(_)) => None,
    }
}

/// Removes a layer. Its readers are connected to the result that it would pass on if it were muted.
pub fn remove(document: &mut OpenDocument, end: &StackEnd, at: usize) -> bool {
    let Some(stack) = stack_behind(document, end) else {
        return false;
    };
    let Some(layer) = stack.layers.get(at) else {
        return document.refuse("there is no such layer");
    };
    if let Some(why) = &layer.shared {
        return document.refuse(why.clone());
    }
    let mut edits = reconnection::reconnecting(document, &BTreeSet::from([layer.node.clone()]));
    edits.push(Edit::RemoveNode {
        body: document.body(),
        id: layer.node.clone(),
    });
    document.edit("Remove layer", edits)
}

/// Lists the kinds that a layer can have: kinds that change the material below; for the lowest layer, all kinds that output a material.
pub fn kinds(document: &OpenDocument, is_lowest: bool) -> Vec<Arc<Interface>> {
    let gives = |entry: &Interface| entry.outputs.iter().any(|port| port.ty == Some(PortType::Material));
    let entries = document.catalog().entries();
    let fit = entries.filter(|entry| gives(entry) && (is_lowest || main_input(entry).is_some()));
    fit.cloned().collect()
}

/// Adds a node of a kind above a layer. At the position after the last layer, it is added below all layers, if the stack
/// has no lowest layer.
pub fn add(document: &mut OpenDocument, end: &StackEnd, at: usize, kind: &str) -> Option<NodeId> {
    let Some(entry) = document.catalog().entry(kind).cloned() else {
        document.notify(format!("there is no node kind '{kind}'"));
        return None;
    };
    add_entry(document, end, at, &entry, None)
}

/// Adds an instance of a group of the document, as [`add`] adds a node.
pub fn add_instance(document: &mut OpenDocument, end: &StackEnd, at: usize, group: &str) -> Option<NodeId> {
    let Some(entry) = document.interfaces().of_group(group).cloned() else {
        document.notify(format!("there is no group '{group}'"));
        return None;
    };
    add_entry(document, end, at, &entry, Some(group))
}

fn add_entry(
    document: &mut OpenDocument,
    end: &StackEnd,
    at: usize,
    entry: &Interface,
    group: Option<&str>,
) -> Option<NodeId> {
    let stack = stack_behind(document, end)?;
    let output = entry.outputs.iter().find(|port| port.ty == Some(PortType::Material));
    let link = stack.links.get(at).filter(|link| link.slot.is_some() || at == 0);
    let (output, link) = match (output, link) {
        (None, _) => {
            document.notify(format!("'{}' gives no material", entry.label));
            return None;
        }
        (_, None) => {
            document.notify("nothing can lie below the material at the bottom");
            return None;
        }
        (Some(output), Some(link)) => (output, link),
    };
    if let Some(why) = why_not_between(document, link, main_input(entry).is_some(), &entry.label) {
        document.notify(why);
        return None;
    }
    let (pos, moves) = place_of_layer(document, link, node_size::size_of(entry));
    let (id, mut node) = new_nodes::of_kind(document, &entry.id, pos);
    node.group = group.map(str::to_owned);
    let below = main_input(entry).zip(link.from.as_ref());
    let below = below.map(|(port, from)| (port.name.clone(), connections::canonical(document, from)));
    let inputs = below.into_iter().collect();
    let given = OutputRef {
        node: id.clone(),
        port: port_in_wire(entry, output),
    };
    let mut edits = vec![new_nodes::addition(document, &id, node, inputs)];
    edits.extend(link_edit(document, end, link.slot.as_ref(), Some(&given)));
    edits.extend(moves);
    let is_made = document.edit(&format!("Add layer {}", entry.label), edits);
    is_made.then(|| {
        document.select([id.clone()]);
        id
    })
}

/// Adds a node of a kind, or an instance of a group, on top of the material that a node outputs. All readers of the node
/// then read the layer.
pub(crate) fn add_over(document: &mut OpenDocument, id: &NodeId, kind: &str, group: Option<&str>) -> Option<NodeId> {
    let entry = match group {
        Some(group) => document.interfaces().of_group(group),
        None => document.catalog().entry(kind),
    };
    let entry = entry.cloned()?;
    let given = |interface: &Interface| {
        let port = interface
            .outputs
            .iter()
            .find(|port| port.ty == Some(PortType::Material));
        port.map(|port| port_in_wire(interface, port))
    };
    let from = OutputRef {
        node: id.clone(),
        port: document.interface(id).and_then(|interface| given(interface))?,
    };
    let (input, output) = main_input(&entry).zip(given(&entry))?;
    let is_read = |read: Option<&OutputRef>| read.is_some_and(|read| connections::canonical(document, read) == from);
    let mut readers = document.graph().readers(id.as_str());
    readers.retain(|slot| is_read(connections::wire_into(document, slot)));
    let outputs = ports::outputs(document).iter();
    let outputs: Vec<String> = outputs
        .filter(|(_, from)| is_read(Some(from)))
        .map(|(name, _)| name.clone())
        .collect();
    let link = LayerLink {
        slot: readers.first().cloned(),
        from: Some(from.clone()),
        is_shared: false,
    };
    let (pos, moves) = place_of_layer(document, &link, node_size::size_of(&entry));
    let (new, mut node) = new_nodes::of_kind(document, &entry.id, pos);
    node.group = group.map(str::to_owned);
    let inputs = BTreeMap::from([(input.name.clone(), from)]);
    let layer = OutputRef {
        node: new.clone(),
        port: output,
    };
    let mut edits = vec![new_nodes::addition(document, &new, node, inputs)];
    let connected = |slot: &SlotRef| Edit::Connect {
        body: document.body(),
        node: slot.node.clone(),
        input: slot.name.clone(),
        from: layer.clone(),
    };
    edits.extend(readers.iter().map(connected));
    edits.extend(outputs.into_iter().map(|name| Edit::SetOutput {
        body: document.body(),
        name,
        output: Some(layer.clone()),
    }));
    edits.extend(moves);
    document
        .edit(&format!("Add layer {}", entry.label), edits)
        .then_some(new)
}

fn why_not_between(document: &OpenDocument, link: &LayerLink, takes_material: bool, label: &str) -> Option<String> {
    if link.is_shared {
        return Some("a reroute there has other readers, which would change too; use the canvas".to_owned());
    }
    if let Some(name) = link
        .slot
        .as_ref()
        .and_then(|slot| connections::feeder(document, document.shown(), slot))
    {
        return Some(format!(
            "the group's input '{}' would bypass the layer; use the canvas",
            input_label(document, name)
        ));
    }
    let hides = link.from.is_some() && !takes_material;
    hides.then(|| format!("'{label}' takes no material, and would hide all layers below it"))
}

/// Returns a place for a layer of this size in a link where it covers no other node, and edits that move the nodes behind
/// it out of the way.
fn place_of_layer(document: &OpenDocument, link: &LayerLink, size: [f32; 2]) -> ([f32; 2], Vec<Edit>) {
    let place = |id: &NodeId| document.node(id).map(|node| node.pos);
    let reader = link.slot.as_ref().map(|slot| &slot.node);
    let source = link.from.as_ref().map(|from| &from.node);
    let step = NODE_WIDTH + BESIDE;
    let near = match (reader.and_then(place), source.and_then(place)) {
        (Some(reader), Some(source)) => [0, 1].map(|axis| (reader[axis] + source[axis]) / 2.0),
        (Some([x, y]), None) => [x - step, y],
        (None, Some([x, y])) => [x + step, y],
        (None, None) => [0.0; 2],
    };
    let (between, moves) = match reader {
        Some(reader) => wires::room_between(document, near, size, source, reader, None),
        None => (near, Vec::new()),
    };
    let moved = |id: &NodeId| {
        moves
            .iter()
            .any(|edit| matches!(edit, Edit::Move { node, .. } if node == id))
    };
    let staying: Vec<&NodeId> = document.graph().ids().filter(|id| !moved(id)).collect();
    let free = wires::uncovering(document, between, size, &staying);
    (free, moves)
}

/// Input for the mask of a layer, if its node takes one.
pub fn mask_input(document: &OpenDocument, id: &NodeId) -> Option<SlotRef> {
    let input = document.interface(id)?.inputs.iter().find(|port| port.name == "mask")?;
    Some(SlotRef {
        node: id.clone(),
        name: input.name.clone(),
    })
}

/// Returns a place for a new mask of a layer: below and before the layer, where it covers no other node.
pub(crate) fn place_of_mask(document: &OpenDocument, id: &NodeId) -> [f32; 2] {
    let [x, y] = document.node(id).map_or([0.0; 2], |node| node.pos);
    let below = [x - NODE_WIDTH - BESIDE, y + node_size::of(document, id)[1] / 2.0];
    let nodes: Vec<&NodeId> = document.graph().ids().collect();
    wires::uncovering(document, below, [NODE_WIDTH, MASK_HEIGHT], &nodes)
}

/// Returns the input for the mask of a layer. If its node has none, a notice is added.
pub(crate) fn expect_mask_input(document: &mut OpenDocument, id: &NodeId) -> Option<SlotRef> {
    let slot = mask_input(document, id);
    if slot.is_none() {
        let title = document.title(id);
        document.notify(format!("'{title}' takes no mask"));
    }
    slot
}

/// Disconnects the mask of a layer.
pub fn remove_mask(document: &mut OpenDocument, id: &NodeId) -> bool {
    expect_mask_input(document, id).is_some_and(|slot| wires::disconnect(document, &[slot]))
}

/// Shows or hides a layer.
pub fn toggle(document: &mut OpenDocument, id: &NodeId) -> bool {
    let Some(is_muted) = document.node(id).map(|node| node.muted) else {
        return false;
    };
    nodes::set_muted(document, [id.clone()], !is_muted)
}

/// Sets the opacity of a layer.
pub fn set_opacity(document: &mut OpenDocument, id: &NodeId, opacity: f64) -> bool {
    let Some(knob) = document.interface(id).and_then(|interface| interface.knob("opacity")) else {
        let title = document.title(id);
        return document.refuse(format!("'{title}' has no Opacity"));
    };
    let [low, high] = knob.ty.range.unwrap_or([0.0, 1.0]);
    if opacity.is_nan() {
        return document.refuse("an Opacity is a number");
    }
    nodes::set_knob(document, id, "opacity", Some(Value::Number(opacity.clamp(low, high))))
}
