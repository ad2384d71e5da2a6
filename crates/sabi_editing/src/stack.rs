//! The graph as stacks of layers: the chain of materials behind each output, top layer first.

use sabi_engine::catalog::{Interface, Port};
use sabi_graph::{GROUP_KIND, NodeId, OutputRef, PortType, REROUTE_KIND, SlotRef};

use crate::open_document::OpenDocument;
use crate::ports::input_label;
use crate::{connections, instances, ports};

/// Output that a stack leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StackEnd {
    /// An output node.
    Node(NodeId),
    /// An output of the shown graph, by its name.
    Port(String),
}

/// Layer: a node that changes the material below it, or the material at the bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Node of the layer.
    pub node: NodeId,
    /// Title of the node.
    pub title: String,
    /// True if the node is muted, which hides the layer.
    pub is_muted: bool,
    /// Opacity of the layer; none if the node's kind has no such knob.
    pub opacity: Option<f64>,
    /// Source of the mask; `None` if nothing is connected or the node's kind has no mask.
    pub mask: Option<OutputRef>,
    /// Nodes outside of the chain that read the layer. They would change too if this layer or a layer below it were moved.
    pub also_read_by: Vec<NodeId>,
    /// Reason why the layer cannot be moved or removed without changing more than this stack; `None` if it can.
    pub shared: Option<String>,
    /// Reason why no layer can be added below this layer; `None` if that is possible.
    pub is_lowest: Option<String>,
}

/// The chain of materials behind an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    /// Output that it leads to.
    pub end: StackEnd,
    /// Title of the output.
    pub title: String,
    /// Layers, top layer first.
    pub layers: Vec<Layer>,
    pub(crate) links: Vec<LayerLink>,
}

/// Connection from a layer, or from the end of the stack, to the layer below.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayerLink {
    /// Input that reads the layer below: an input of the layer above, or of the last reroute on the way. `None` if an
    /// output of the group reads it, and below the material at the bottom.
    pub(crate) slot: Option<SlotRef>,
    /// Output that is read, if anything is connected.
    pub(crate) from: Option<OutputRef>,
    /// True if a reroute on the way has other readers.
    pub(crate) is_shared: bool,
}

impl Stack {
    /// Returns whether no layer or reroute of the stack has other readers, so that all layers can be moved.
    pub fn is_plain(&self) -> bool {
        self.layers.iter().all(|layer| layer.shared.is_none()) && !self.links.iter().any(|link| link.is_shared)
    }
}

/// Stacks of the shown graph, one for each material output.
pub fn all(document: &OpenDocument) -> Vec<Stack> {
    let nodes = document.graph().nodes();
    let ends = nodes.filter(|(id, _)| {
        let interface = document.interface(id);
        interface.is_some_and(|interface| interface.category() == "output" && material_input(document, id).is_some())
    });
    let ends: Vec<StackEnd> = ends.map(|(id, _)| StackEnd::Node(id.clone())).collect();
    let (_, outputs) = instances::ports(document.contents(), document.shown());
    let given = outputs
        .iter()
        .filter(|(_, from)| connections::carried(document, from) == Some(PortType::Material));
    let ports = given.map(|(name, _)| StackEnd::Port(name.clone()));
    ends.into_iter().chain(ports).map(|end| of(document, end)).collect()
}

fn of(document: &OpenDocument, end: StackEnd) -> Stack {
    let (title, slot, from) = match &end {
        StackEnd::Node(id) => {
            let slot = material_input(document, id);
            let from = slot
                .as_ref()
                .and_then(|slot| connections::wire_into(document, slot).cloned());
            (document.title(id), slot, from)
        }
        StackEnd::Port(name) => (name.clone(), None, ports::outputs(document).get(name).cloned()),
    };
    let mut stack = Stack {
        end,
        title,
        layers: Vec::new(),
        links: vec![link(document, slot, from)],
    };
    // Wires form no cycle, so this loop ends.
    while let Some(at) = stack.links.last().and_then(|link| link.from.clone()) {
        let slot = material_input(document, &at.node);
        let from = slot
            .as_ref()
            .and_then(|slot| connections::wire_into(document, slot).cloned());
        let link = link(document, slot, from);
        let above = &stack.links[stack.links.len() - 1];
        let layer = layer(document, &at, above, &link);
        stack.layers.push(layer);
        stack.links.push(link);
    }
    stack
}

/// Follows a wire through reroutes to its source.
fn link(document: &OpenDocument, slot: Option<SlotRef>, from: Option<OutputRef>) -> LayerLink {
    let mut link = LayerLink {
        slot,
        from,
        is_shared: false,
    };
    while let Some(reroute) = link.from.as_ref().map(|from| from.node.clone()) {
        if document.node(&reroute).is_none_or(|node| node.kind != REROUTE_KIND) {
            break;
        }
        link.is_shared |= document.graph().readers(reroute.as_str()).len() + output_count(document, &reroute) > 1;
        link.from = document.graph().link_into(reroute.as_str(), "source").cloned();
        link.slot = Some(SlotRef {
            node: reroute,
            name: "source".to_owned(),
        });
    }
    link
}

fn output_count(document: &OpenDocument, id: &NodeId) -> usize {
    ports::outputs(document)
        .values()
        .filter(|from| from.node == *id)
        .count()
}

/// Input for the material that a node changes.
fn material_input(document: &OpenDocument, id: &NodeId) -> Option<SlotRef> {
    let port = main_input(document.interface(id)?)?;
    Some(SlotRef {
        node: id.clone(),
        name: port.name.clone(),
    })
}

fn layer(document: &OpenDocument, at: &OutputRef, above: &LayerLink, below: &LayerLink) -> Layer {
    let id = &at.node;
    let interface = document.interface(id);
    let node = document.node(id);
    let opacity = interface.and_then(|interface| interface.knob("opacity"));
    let opacity = opacity.and_then(|knob| {
        let set = node.and_then(|node| node.params.get("opacity"));
        set.unwrap_or(&knob.ty.default).as_number()
    });
    let is_of_chain = |slot: &SlotRef| above.slot.as_ref() == Some(slot);
    let readers = document.graph().readers(id.as_str()).into_iter();
    let mut also_read_by: Vec<NodeId> = readers
        .filter(|slot| !is_of_chain(slot))
        .map(|slot| slot.node)
        .collect();
    also_read_by.dedup();
    // The end of this stack may itself be one of the outputs that read the node.
    let given = output_count(document, id) - usize::from(above.slot.is_none());
    Layer {
        node: id.clone(),
        title: document.title(id),
        is_muted: node.is_some_and(|node| node.muted),
        opacity,
        mask: document.graph().link_into(id.as_str(), "mask").cloned(),
        shared: shared_reason(document, id, &also_read_by, given > 0),
        also_read_by,
        is_lowest: lowest_reason(document, id, below),
    }
}

fn shared_reason(document: &OpenDocument, id: &NodeId, others: &[NodeId], is_given: bool) -> Option<String> {
    let title = document.title(id);
    if let Some(other) = others.first() {
        let other = document.title(other);
        return Some(format!(
            "'{title}' is also read by '{other}', which would change too; use the canvas"
        ));
    }
    is_given
        .then(|| format!("'{title}' is also given to an output of the group, which would change too; use the canvas"))
}

fn lowest_reason(document: &OpenDocument, id: &NodeId, below: &LayerLink) -> Option<String> {
    let title = document.title(id);
    let Some(slot) = &below.slot else {
        return Some(format!(
            "'{title}' is the material at the bottom; nothing can lie below it"
        ));
    };
    let feeder = connections::feeder(document, document.shown(), slot)?;
    Some(format!(
        "'{title}' lies on the group's input '{}'; no layer can come between",
        input_label(document, feeder)
    ))
}

/// Input for the material that a node with these ports changes.
pub(crate) fn main_input(interface: &Interface) -> Option<&Port> {
    let mut inputs = interface
        .inputs
        .iter()
        .filter(|port| port.ty == Some(PortType::Material));
    if interface.id != GROUP_KIND {
        return inputs.next();
    }
    // Inputs of a group are sorted by name, so the first one need not be the material below.
    let inputs: Vec<&Port> = inputs.collect();
    let named = ["base", "below", "material"];
    let named = named
        .iter()
        .find_map(|name| inputs.iter().find(|port| port.name == *name));
    named.or(inputs.first()).copied()
}
