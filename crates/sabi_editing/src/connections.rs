//! Connections of the shown graph, and the edits that connect and disconnect inputs.

use std::collections::{BTreeMap, BTreeSet};

use sabi_engine::catalog::{Interface, Port};
use sabi_graph::{Body, Edit, GROUP_KIND, Graph, GroupInput, NodeId, OutputRef, PortType, REROUTE_KIND, SlotRef};

use crate::instances;
use crate::open_document::OpenDocument;

/// Connected end of a wire that is being dragged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PendingWire {
    /// An output; the wire is dropped on an input.
    From(OutputRef),
    /// An input; the wire is dropped on an output.
    Into(SlotRef),
}

/// Returns whether an input of a node reads this result.
pub fn reads(document: &OpenDocument, slot: &SlotRef, from: &OutputRef) -> bool {
    let read = wire_into(document, slot);
    read.is_some_and(|read| canonical(document, read) == canonical(document, from))
}

/// Input of the group that feeds an input of a node in a graph.
pub(crate) fn feeder<'d>(document: &'d OpenDocument, body: &Body, slot: &SlotRef) -> Option<&'d str> {
    let (inputs, _) = instances::ports(document.contents(), body);
    let feeds = |input: &GroupInput| input.to.contains(slot);
    inputs
        .iter()
        .find(|(_, input)| feeds(input))
        .map(|(name, _)| name.as_str())
}

/// Nodes that a node reads, once for each of its inputs.
pub(crate) fn sources(document: &OpenDocument, id: &NodeId) -> Vec<NodeId> {
    let inputs = document.graph().inputs(id.as_str());
    inputs.into_values().map(|from| from.node.clone()).collect()
}

/// Checks that both ends of a wire exist and that the input accepts the type of the result. The error is the reason why not.
pub(crate) fn check_type(document: &OpenDocument, from: &OutputRef, to: &SlotRef) -> Result<(), String> {
    let Some(input) = input(document, to) else {
        return Err(format!("'{}' has no input '{}'", document.title(&to.node), to.name));
    };
    let source = document.interface(&from.node);
    if source
        .and_then(|interface| interface.output(from.port.as_deref()))
        .is_none()
    {
        let title = document.title(&from.node);
        return Err(match &from.port {
            Some(port) => format!("'{title}' gives no result '{port}'"),
            None => format!("'{title}' gives no result"),
        });
    }
    let Some(carried) = carried(document, from) else {
        return Ok(());
    };
    let refused = |label: &str, takes: PortType| {
        let why = "only masks and colors are converted";
        Err(format!(
            "'{label}' takes a {takes}, and this wire carries a {carried}; {why}"
        ))
    };
    if !is_reroute(document, &to.node) {
        return match input.ty {
            Some(takes) if !takes.accepts(carried) => refused(&input.label, takes),
            _ => Ok(()),
        };
    }
    // A reroute accepts only what all its readers accept.
    match inputs_behind_reroutes(document, &to.node)
        .into_iter()
        .find(|(_, takes)| !takes.accepts(carried))
    {
        Some((label, takes)) => refused(&label, takes),
        None => Ok(()),
    }
}

fn is_reroute(document: &OpenDocument, id: &NodeId) -> bool {
    document.node(id).is_some_and(|node| node.kind == REROUTE_KIND)
}

/// Lists the inputs that a reroute leads to, also through further reroutes, as labels with the accepted types.
fn inputs_behind_reroutes(document: &OpenDocument, id: &NodeId) -> Vec<(String, PortType)> {
    let mut found = Vec::new();
    let mut seen = BTreeSet::from([id.clone()]);
    let mut next = vec![id.clone()];
    while let Some(id) = next.pop() {
        for slot in document.graph().readers(id.as_str()) {
            if is_reroute(document, &slot.node) {
                next.extend(Some(slot.node).filter(|id| seen.insert(id.clone())));
            } else if let Some((port, takes)) = input(document, &slot).and_then(|port| Some((port, port.ty?))) {
                found.push((port.label.clone(), takes));
            }
        }
    }
    found
}

/// Returns the type that a wire from an output carries, if it is known.
pub fn carried(document: &OpenDocument, from: &OutputRef) -> Option<PortType> {
    document.interfaces().carried(document.shown(), from)
}

/// Input of a node of the shown graph.
pub fn input<'d>(document: &'d OpenDocument, slot: &SlotRef) -> Option<&'d Port> {
    document.interface(&slot.node)?.input(&slot.name)
}

/// Edit that connects an input to an output.
pub(crate) fn connecting(document: &OpenDocument, from: &OutputRef, to: &SlotRef) -> Edit {
    Edit::Connect {
        body: document.body(),
        node: to.node.clone(),
        input: to.name.clone(),
        from: canonical(document, from),
    }
}

/// Canonical form of an output: the first output of a node kind has no port name. An output of a group always has one, since
/// the group may get other outputs.
pub(crate) fn canonical(document: &OpenDocument, from: &OutputRef) -> OutputRef {
    let interface = document.interface(&from.node);
    let named = interface.and_then(|interface| Some(port_in_wire(interface, interface.output(from.port.as_deref())?)));
    OutputRef {
        node: from.node.clone(),
        port: named.unwrap_or_else(|| from.port.clone()),
    }
}

/// Returns the output that an input is connected to, if any.
pub fn wire_into<'d>(document: &'d OpenDocument, slot: &SlotRef) -> Option<&'d OutputRef> {
    document.graph().link_into(slot.node.as_str(), &slot.name)
}

/// Wires into a node of a graph from chosen nodes, by input.
pub(crate) fn wires_from(
    graph: &Graph,
    id: &NodeId,
    is_chosen: impl Fn(&NodeId) -> bool,
) -> BTreeMap<String, OutputRef> {
    let inputs = graph.inputs(id.as_str()).into_iter();
    let chosen = inputs.filter(|(_, from)| is_chosen(&from.node));
    chosen.map(|(input, from)| (input.to_owned(), from.clone())).collect()
}

/// Edit that disconnects an input.
pub(crate) fn disconnecting(document: &OpenDocument, slot: &SlotRef) -> Edit {
    Edit::Disconnect {
        body: document.body(),
        node: slot.node.clone(),
        input: slot.name.clone(),
    }
}

/// Returns an edit that gives the parameter of this input its first value, since the wire would otherwise have no visible
/// effect. Returns `None` if the parameter has a value already, or the input has no such parameter.
pub(crate) fn starting(document: &OpenDocument, connected: &Edit, interface: &Interface) -> Option<Edit> {
    let Edit::Connect { body, node, input, .. } = connected else {
        return None;
    };
    let (param, value) = interface.input(input)?.starts.clone()?;
    let is_set = document.node(node).is_some_and(|node| node.params.contains_key(&param));
    (!is_set).then(|| Edit::SetParam {
        body: body.clone(),
        node: node.clone(),
        param,
        value: Some(value),
    })
}

/// Returns an edit that connects a pending wire to the first port of a node that fits; `None` if no port fits. The node
/// need not exist yet.
pub(crate) fn connecting_pending(
    document: &OpenDocument,
    pending: &PendingWire,
    id: &NodeId,
    interface: &Interface,
) -> Option<Edit> {
    let is_free = |port: &Port| document.graph().link_into(id.as_str(), &port.name).is_none();
    match pending {
        PendingWire::From(from) => {
            document.interface(&from.node)?.output(from.port.as_deref())?;
            let carried = carried(document, from);
            let exact = interface
                .plain_inputs()
                .find(|port| port.ty == carried && is_free(port));
            let input = exact.or_else(|| {
                interface
                    .plain_inputs()
                    .find(|port| port.accepts(carried) && is_free(port))
            })?;
            let to = SlotRef {
                node: id.clone(),
                name: input.name.clone(),
            };
            Some(connecting(document, from, &to))
        }
        PendingWire::Into(to) => {
            let output = interface.output_for(input(document, to)?)?;
            Some(Edit::Connect {
                body: document.body(),
                node: to.node.clone(),
                input: to.name.clone(),
                from: OutputRef {
                    node: id.clone(),
                    port: port_in_wire(interface, output),
                },
            })
        }
    }
}

/// Returns whether a node is `source`, or depends on it directly or through other nodes.
pub(crate) fn depends_on(document: &OpenDocument, id: &NodeId, source: &NodeId) -> bool {
    document.graph().upstream([id]).contains(source)
}

/// Returns the port name in a wire from an output: none for the first output of a node kind, always a name for groups.
pub(crate) fn port_in_wire(interface: &Interface, port: &Port) -> Option<String> {
    let is_first = interface.outputs.first().is_some_and(|first| first.name == port.name);
    (!is_first || interface.id == GROUP_KIND).then(|| port.name.clone())
}
