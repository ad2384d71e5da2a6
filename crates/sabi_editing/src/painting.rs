//! Painting: strokes of paint nodes, and paint nodes on top of masks.

use std::collections::BTreeMap;
use std::sync::Arc;

use sabi_graph::{Edit, NodeId, OutputRef, PortType, Value};
use sabi_paint::{Step, Stroke, StrokeList};

use crate::node_size::size_of;
use crate::open_document::OpenDocument;
use crate::stack::{self, Layer};
use crate::{connections, new_nodes};

/// Kind of the nodes that are painted on.
pub const PAINT: &str = "source/paint";
/// Parameter of a paint node that names its strokes.
pub const STROKES: &str = "strokes";
/// Parameter of a paint node with the value of the mask where nothing is painted.
pub(crate) const EMPTY: &str = "empty";
/// Space between a node and the paint node behind it, canvas points.
const GAP: f32 = 60.0;

/// Returns the versions of strokes that a paint node refers to, one for each model; `None` for other nodes.
pub fn strokes_of(document: &OpenDocument, node: &NodeId) -> Option<String> {
    let node = document.node(node).filter(|node| node.kind == PAINT)?;
    Some(match node.params.get(STROKES) {
        Some(Value::Text(versions)) => versions.clone(),
        _ => String::new(),
    })
}

/// Returns the strokes of a paint node on a model; `None` if nothing is painted there.
pub fn strokes_on(document: &OpenDocument, node: &NodeId, model: &str) -> Option<Arc<StrokeList>> {
    let open = document.session.graph();
    open.strokes.on_model(&open.path, model, &strokes_of(document, node)?)
}

/// Layer that shows what is painted on a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaintedLayer {
    /// Title of the layer.
    pub title: String,
    /// True if the node is only the mask of the layer, which has its color from elsewhere.
    pub is_mask_alone: bool,
}

/// Returns the layer whose mask a paint node is; none if it is no mask of a layer that leads to an output.
pub fn painted_layer(document: &OpenDocument, node: &NodeId) -> Option<PaintedLayer> {
    let stacks = stack::all(document);
    let mut layers = stacks.iter().flat_map(|stack| &stack.layers);
    let is_mask = |layer: &&Layer| layer.mask.as_ref().is_some_and(|mask| mask.node == *node);
    let layer = layers.find(is_mask)?;
    let colors = document.graph().link_into(layer.node.as_str(), "color_map");
    Some(PaintedLayer {
        title: layer.title.clone(),
        is_mask_alone: colors.is_none_or(|from| from.node != *node),
    })
}

/// Returns whether any node reads a result of this one.
pub fn is_read(document: &OpenDocument, node: &NodeId) -> bool {
    !document.graph().readers(node.as_str()).is_empty()
}

/// Replaces the strokes of a paint node on a model by the strokes `before` plus one stroke on top. While the brush moves,
/// `before` stays the version before the stroke began.
pub fn stroke(document: &mut OpenDocument, node: &NodeId, model: &str, before: &str, stroke: Arc<Stroke>) -> bool {
    take_steps(document, node, model, before, "Stroke", &[Step::Add(stroke)])
}

/// Applies several changes to the strokes of a paint node on a model, starting from an earlier version, as one undo step.
pub fn take_steps(
    document: &mut OpenDocument,
    node: &NodeId,
    model: &str,
    before: &str,
    name: &str,
    steps: &[Step],
) -> bool {
    if strokes_of(document, node).is_none() {
        return document.refuse("a brush paints on Paint nodes alone");
    }
    let open = document.session.graph();
    let after = open.strokes.after_steps(&open.path, model, before, steps);
    let edit = Edit::SetParam {
        body: document.body(),
        node: node.clone(),
        param: STROKES.to_owned(),
        value: Some(Value::Text(after)),
    };
    document.edit(name, vec![edit])
}

/// Adds a paint node on top of a mask, so that its strokes cover the mask for all readers, and selects it. If `node` is a
/// paint node, it is only selected.
pub fn paint_over(document: &mut OpenDocument, node: &NodeId) -> Option<NodeId> {
    if strokes_of(document, node).is_some() {
        return Some(node.clone());
    }
    let interface = document.interface(node).cloned()?;
    let Some(port) = interface
        .outputs
        .iter()
        .find(|port| port.ty == Some(PortType::Mask))
        .map(|port| port.name.clone())
    else {
        document.refuse(format!("'{}' gives no mask to paint over", document.title(node)));
        return None;
    };
    let own = document.node(node)?;
    let place = [own.pos[0] + size_of(&interface)[0] + GAP, own.pos[1]];
    let (id, paint) = new_nodes::of_kind(document, PAINT, place);
    let from = OutputRef {
        node: node.clone(),
        port: Some(port.clone()),
    };
    let inputs = BTreeMap::from([("base".to_owned(), from)]);
    let mut edits = vec![new_nodes::addition(document, &id, paint, inputs)];
    // A wire that names no port reads the first one.
    let is_first = interface.outputs.first().is_some_and(|first| first.name == port);
    let reads_port = |from: &OutputRef| from.port.as_ref().map_or(is_first, |read| *read == port);
    let readers = document.graph().readers(node.as_str()).into_iter();
    for slot in readers.filter(|slot| connections::wire_into(document, slot).is_some_and(reads_port)) {
        let behind = OutputRef {
            node: id.clone(),
            port: Some("mask".to_owned()),
        };
        edits.push(Edit::link(document.body(), slot.node, slot.name, Some(behind)));
    }
    document
        .edit_and_select("Paint over", edits, [id.clone()])
        .then_some(id)
}
