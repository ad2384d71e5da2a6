//! Graphs of choices, as if they were made.

use sabi_editing::{OpenDocument, linked_groups, node_paths, variants};
use sabi_engine::OpenGraph;
use sabi_graph::{Graph, Node, NodeRef};

use super::{PreviewChoice, PreviewSource};
use crate::shown_results::material_port;

/// The graph of a choice, and the node whose result is shown; without a node, all outputs are shown.
pub(super) fn preview_graph(
    choice: &PreviewChoice,
    source: &PreviewSource<'_>,
) -> Option<(OpenGraph, Option<NodeRef>)> {
    let document = source.document;
    match choice {
        PreviewChoice::Variant { instance, name, .. } => {
            let graph = variants::graph_with_variant(document, instance.as_ref(), name.as_deref())?;
            let shown = instance.as_ref().filter(|_| !has_outputs(&graph.document.graph));
            let node = shown.map(|id| NodeRef {
                node: node_paths::full_id(document, id),
                port: document
                    .interface(id)
                    .and_then(|interface| material_port(&interface.outputs)),
            });
            Some((graph, node))
        }
        PreviewChoice::Update { groups, is_after } => {
            let graph = match is_after {
                true => linked_groups::updated(document, groups)?,
                false => document.session.graph().clone(),
            };
            let node = match has_outputs(&graph.document.graph) {
                true => None,
                false => Some(first_instance(document, groups)?),
            };
            Some((graph, node))
        }
        PreviewChoice::Effect(file) => {
            let group = source.library.group(file)?;
            let text = serde_json::json!({
                "format": "sabi",
                "version": 1,
                "nodes": { EFFECT: { "kind": "graph/group", "group": file.file_name()?.to_str()? } },
            });
            let text = text.to_string();
            let graph = OpenGraph {
                document: sabi_graph::Document::from_json(&text).ok()?,
                text: text.into(),
                trusted: group.graph.trusted.clone(),
                ..OpenGraph::empty(file.with_file_name(BESIDE))
            };
            let node = NodeRef {
                node: EFFECT.to_owned(),
                port: material_port(&group.interface.outputs),
            };
            Some((graph, Some(node)))
        }
    }
}

fn has_outputs(graph: &Graph) -> bool {
    graph.nodes().any(|(_, node)| node.kind.starts_with("output/"))
}

/// Material of the first instance of one of these groups.
fn first_instance(document: &OpenDocument, groups: &[String]) -> Option<NodeRef> {
    let is_of = |node: &Node| node.group.as_ref().is_some_and(|group| groups.contains(group));
    let (id, node) = document.contents().graph.nodes().find(|(_, node)| is_of(node))?;
    let interface = document.interfaces().of_group(node.group.as_ref()?)?;
    Some(NodeRef {
        node: id.to_string(),
        port: material_port(&interface.outputs),
    })
}

/// Name of the only node of a graph that tries an effect, and of its file, which is never written.
const EFFECT: &str = "effect";
const BESIDE: &str = "trial.sabi";
