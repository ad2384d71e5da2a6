//! Wires: connecting, disconnecting, merging, rerouting.

mod insertion;

use std::collections::BTreeMap;

use sabi_engine::catalog::Port;
use sabi_graph::{Edit, NodeId, OutputRef, REROUTE_KIND, SlotRef, Value};

use crate::node_size::{NODE_WIDTH, REROUTE_SIZE};
use crate::open_document::OpenDocument;
use crate::{connections, new_nodes, ports, reconnection};

pub use insertion::{can_insert, can_insert_new, insert};
pub(crate) use insertion::{room_between, uncovering};

/// Method by which a second mask is merged with the first mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskMerge {
    /// The second replaces the first.
    Replace,
    /// A `blend/mask` node of this mode combines both.
    Blend(&'static str),
}

impl MaskMerge {
    /// Methods that are offered, with their labels.
    pub const OFFERED: [(&'static str, MaskMerge); 5] = [
        ("Multiply", MaskMerge::Blend("multiply")),
        ("Add", MaskMerge::Blend("add")),
        ("Max", MaskMerge::Blend("max")),
        ("Subtract", MaskMerge::Blend("subtract")),
        ("Replace", MaskMerge::Replace),
    ];
}

/// Space between a new blend node and its reader, canvas points.
const BESIDE: f32 = 60.0;

/// Connects an output to an input, replacing its current connection. The types must be compatible.
pub fn connect(document: &mut OpenDocument, from: &OutputRef, to: &SlotRef) -> bool {
    if let Err(why) = check(document, from, to) {
        return document.refuse(why);
    }
    let edit = connections::connecting(document, from, to);
    let interface = document.interface(&to.node);
    let started = interface.and_then(|interface| connections::starting(document, &edit, interface));
    let edits = std::iter::once(edit).chain(started).collect();
    document.edit(&connecting_step(document, from, to), edits)
}

/// Name of the step that connects an output to an input: `Connect Clouds to Levels`.
pub(crate) fn connecting_step(document: &OpenDocument, from: &OutputRef, to: &SlotRef) -> String {
    format!("Connect {} to {}", document.title(&from.node), document.title(&to.node))
}

/// Checks that a wire can connect an output to an input: the types are compatible, and no cycle is closed. The error is the
/// reason why not.
pub fn check(document: &OpenDocument, from: &OutputRef, to: &SlotRef) -> Result<(), String> {
    connections::check_type(document, from, to)?;
    if !connections::depends_on(document, &from.node, &to.node) {
        return Ok(());
    }
    let [one, other] = [&from.node, &to.node].map(|id| document.title(id));
    Err(match from.node == to.node {
        true => format!("'{one}' cannot read its own result"),
        false => format!("'{one}' depends on '{other}' already; this wire would close a loop"),
    })
}

/// Lists the inputs of a node that accept a wire from an output: normal inputs, and inputs for masks that multiply parameters.
pub fn accepting(document: &OpenDocument, from: &OutputRef, id: &NodeId) -> [Vec<SlotRef>; 2] {
    let Some(interface) = document.interface(id) else {
        return [Vec::new(), Vec::new()];
    };
    let accepting = |port: &Port| {
        let slot = SlotRef {
            node: id.clone(),
            name: port.name.clone(),
        };
        check(document, from, &slot).is_ok().then_some(slot)
    };
    let plain = interface.plain_inputs().filter_map(accepting).collect();
    [plain, interface.param_masks.iter().filter_map(accepting).collect()]
}

/// Disconnects these inputs.
pub fn disconnect(document: &mut OpenDocument, slots: &[SlotRef]) -> bool {
    let connected = slots
        .iter()
        .filter(|slot| connections::wire_into(document, slot).is_some());
    let edits: Vec<Edit> = connected
        .map(|slot| connections::disconnecting(document, slot))
        .collect();
    let step = if edits.len() == 1 { "Disconnect" } else { "Cut wires" };
    document.edit(step, edits)
}

/// Removes the mask that multiplies a parameter, whatever its source is.
pub fn remove_mask(document: &mut OpenDocument, slot: &SlotRef) -> bool {
    let wired = connections::wire_into(document, slot).map(|_| connections::disconnecting(document, slot));
    let mut edits: Vec<Edit> = wired.into_iter().collect();
    ports::refeed(document, &mut edits, vec![(slot.clone(), None)]);
    document.edit("Remove the mask", edits)
}

/// Returns whether a wire that is dropped on an input can be merged with another mask that is connected there already.
pub fn can_merge(document: &OpenDocument, from: &OutputRef, to: &SlotRef) -> bool {
    use sabi_graph::PortType::Mask;
    let takes_mask = connections::input(document, to).is_some_and(|port| port.ty == Some(Mask));
    let carries = connections::carried(document, from);
    let is_other =
        |known: &OutputRef| connections::canonical(document, known) != connections::canonical(document, from);
    takes_mask
        && carries.is_some_and(|ty| Mask.accepts(ty))
        && connections::wire_into(document, to).is_some_and(is_other)
}

/// Connects a second output to an input that is connected already: a new blend node combines both.
pub fn merge(document: &mut OpenDocument, from: &OutputRef, to: &SlotRef, how: MaskMerge) -> bool {
    let mode = match (how, connections::wire_into(document, to).cloned()) {
        (MaskMerge::Blend(mode), Some(first)) => Some((mode, first)),
        _ => None,
    };
    let Some((mode, first)) = mode else {
        return connect(document, from, to);
    };
    if let Err(why) = check(document, from, to) {
        return document.refuse(why);
    }
    let Some(reader) = document.node(&to.node) else {
        return false;
    };
    let pos = [reader.pos[0] - 2.0 * BESIDE - NODE_WIDTH, reader.pos[1]];
    let (id, mut node) = new_nodes::of_kind(document, "blend/mask", pos);
    let above = connections::canonical(document, from);
    let inputs = BTreeMap::from([("below".to_owned(), first), ("above".to_owned(), above)]);
    node.params.insert("mode".to_owned(), Value::Text(mode.to_owned()));
    let blended = OutputRef {
        node: id.clone(),
        port: None,
    };
    let edits = vec![
        new_nodes::addition(document, &id, node, inputs),
        connections::connecting(document, &blended, to),
    ];
    document.edit_and_select("Blend masks", edits, [id])
}

/// Adds a reroute to the wire that leads to an input, centered at a place.
pub fn reroute(document: &mut OpenDocument, to: &SlotRef, pos: [f32; 2]) -> bool {
    let Some(from) = connections::wire_into(document, to).cloned() else {
        return false;
    };
    let corner = [pos[0] - REROUTE_SIZE[0] / 2.0, pos[1] - REROUTE_SIZE[1] / 2.0];
    let (id, node) = new_nodes::of_kind(document, REROUTE_KIND, corner);
    let inputs = BTreeMap::from([("source".to_owned(), from)]);
    let rerouted = OutputRef {
        node: id.clone(),
        port: None,
    };
    let edits = vec![
        new_nodes::addition(document, &id, node, inputs),
        connections::connecting(document, &rerouted, to),
    ];
    document.edit("Add reroute", edits)
}

/// Disconnects the selected nodes, and connects their readers to their sources.
pub fn detach_selected(document: &mut OpenDocument) -> bool {
    let ids = document.selection().clone();
    let mut edits = reconnection::reconnecting(document, &ids);
    let fed = ports::fed_by_group(document, |id| ids.contains(id));
    ports::refeed(
        document,
        &mut edits,
        fed.into_iter().map(|(slot, _)| (slot, None)).collect(),
    );
    for id in &ids {
        let outside = connections::wires_from(document.graph(), id, |from| !ids.contains(from));
        let slots = outside.into_keys().map(|name| SlotRef { node: id.clone(), name });
        edits.extend(slots.map(|slot| connections::disconnecting(document, &slot)));
    }
    document.edit("Detach and reconnect its neighbors", edits)
}

/// Swaps the first two inputs of the same type of each selected node: their sources, and the knobs that apply while they are unconnected.
pub fn swap_inputs(document: &mut OpenDocument) -> bool {
    let mut edits = Vec::new();
    let mut fed = Vec::new();
    for id in document.selection() {
        let Some((interface, node)) = document.interface(id).zip(document.node(id)) else {
            continue;
        };
        let slot = |port: &Port| SlotRef {
            node: id.clone(),
            name: port.name.clone(),
        };
        let mut pairs = interface.plain_inputs().enumerate().flat_map(|(at, one)| {
            let rest = interface.plain_inputs().skip(at + 1);
            rest.filter(|other| other.ty == one.ty).map(move |other| (one, other))
        });
        let feeder = |port: &Port| connections::feeder(document, document.shown(), &slot(port)).map(str::to_owned);
        let wire = |port: &Port| document.graph().link_into(id.as_str(), &port.name);
        let is_connected = |port: &Port| wire(port).is_some() || feeder(port).is_some();
        let Some((one, other)) = pairs.find(|(one, other)| is_connected(one) || is_connected(other)) else {
            continue;
        };
        for (to, from) in [(one, other), (other, one)] {
            fed.push((slot(to), feeder(from)));
            edits.push(match wire(from) {
                Some(from) => connections::connecting(document, from, &slot(to)),
                None => connections::disconnecting(document, &slot(to)),
            });
            if [to, from]
                .iter()
                .all(|port| interface.knob(&port.name).is_some_and(|knob| knob.is_of_input))
            {
                edits.push(Edit::SetParam {
                    body: document.body(),
                    node: id.clone(),
                    param: to.name.clone(),
                    value: node.params.get(&from.name).cloned(),
                });
            }
        }
    }
    ports::refeed(document, &mut edits, fed);
    document.edit("Swap inputs", edits)
}
