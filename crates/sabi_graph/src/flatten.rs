//! Flattening: groups inlined, reroutes removed, knobs applied.

mod definitions;
mod error;
mod expand;
mod instance_values;
mod knobs;
mod trace;

use std::collections::BTreeMap;

pub use error::FlattenError;
pub use instance_values::{ReadShared, takes_values};
pub use knobs::INSTANCE_KNOBS;
use petgraph::stable_graph::NodeIndex;

use crate::{Document, Fit, Value, order};

/// A graph for the planner, without groups and reroutes: every link leads from node to node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatGraph {
    /// All nodes, each after the nodes that it reads. Ties are broken by the smallest id.
    pub nodes: Vec<FlatNode>,
}

/// A node of a flat graph.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatNode {
    /// Unique id; inside groups `instance/inner`.
    pub id: String,
    /// Kind without its version.
    pub kind: String,
    /// Version of the kind, 1 when the file does not say.
    pub version: u32,
    /// Parameters that were set, with knobs, variant and overrides applied.
    pub params: BTreeMap<String, Value>,
    /// Links by input port; other inputs are not connected.
    pub inputs: BTreeMap<String, FlatRef>,
    /// True if the node is muted, or an instance around it.
    pub muted: bool,
    /// Seed of the document, then the seeds other than 0 of the instances around the node, outermost first.
    pub seeds: Vec<u32>,
    /// Product of the Scale knobs of the instances around the node; lengths of the node are multiplied by this.
    pub length_scale: f64,
    /// Fit of the document, group or group file that defines the node.
    pub fit: Fit,
    /// Group file that defines the node, relative to the document; `None` for the document itself. Paths in parameters of
    /// the node are relative to that file.
    pub file: Option<String>,
}

/// Source of a link of a [`FlatNode`].
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FlatRef {
    /// Index in [`FlatGraph::nodes`], always before the reader.
    pub node: usize,
    /// The output port; `None` means the node's first.
    pub port: Option<String>,
}

/// Settings applied on top of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Variant to start from.
    pub variant: Option<String>,
    /// Values by exposed knob or `node.param`. Later values win.
    pub set: Vec<(String, Value)>,
    /// Pairs of a kind and a parameter: nodes of this kind keep the default of the parameter, whatever the file says.
    pub left_out: Vec<(String, String)>,
    /// Seed in place of the document's.
    pub seed: Option<u32>,
    /// Fit that replaces the document's fit, for its own nodes and for groups without a fit. Groups with a fit keep it, and
    /// so do group files.
    pub fit: Option<Fit>,
}

impl Overrides {
    /// Returns the overrides with which the editor shows a document: the variant of its preview, if that exists.
    pub fn of_preview(document: &Document) -> Overrides {
        let variant = document.preview.as_ref().and_then(|preview| preview.variant.clone());
        Overrides {
            variant: variant.filter(|name| document.graph.variants().contains_key(name)),
            ..Overrides::default()
        }
    }
}

impl FlatGraph {
    /// Returns the index of the node with this id.
    pub fn find(&self, id: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.id == id)
    }

    /// Returns the indices, in ascending order, of the given nodes and of all nodes that they depend on.
    pub fn upstream(&self, of: &[usize]) -> Vec<usize> {
        let mut wanted = vec![false; self.nodes.len()];
        for &index in of {
            if let Some(slot) = wanted.get_mut(index) {
                *slot = true;
            }
        }
        // Sources come before their readers.
        for index in (0..self.nodes.len()).rev() {
            if wanted[index] {
                for source in self.nodes[index].inputs.values() {
                    wanted[source.node] = true;
                }
            }
        }
        (0..self.nodes.len()).filter(|&index| wanted[index]).collect()
    }
}

/// A result of a node of the document, which may be a group instance or a reroute.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeRef {
    /// The node's id; inside groups `instance/inner`.
    pub node: String,
    /// The output port; `None` means the first.
    pub port: Option<String>,
}

/// Origin of the result of a [`NodeRef`]; `None` where the node does not exist or nothing is connected to it.
pub type ResultOrigin = Result<Option<FlatRef>, FlattenError>;

/// Inlines groups, removes reroutes, and applies knobs, the variant and the overrides. `group_file` reads a group file
/// by its path relative to the document's own file; its error is a sentence.
///
/// # Errors
/// Unknown names (with the nearest known one), values out of range, groups inside themselves.
pub fn flatten(
    document: &Document,
    overrides: &Overrides,
    group_file: &mut dyn FnMut(&str) -> Result<Document, String>,
) -> Result<FlatGraph, FlattenError> {
    flatten_and_find(document, overrides, group_file, &[]).map(|(graph, _)| graph)
}

/// Flattens like [`flatten`], and finds where the results of some nodes come from: the flat graph has no group instances
/// and no reroutes.
///
/// # Errors
/// As [`flatten`].
pub fn flatten_and_find(
    document: &Document,
    overrides: &Overrides,
    group_file: &mut dyn FnMut(&str) -> Result<Document, String>,
    wanted: &[NodeRef],
) -> Result<(FlatGraph, Vec<ResultOrigin>), FlattenError> {
    let all = definitions::Definitions::collect(document, overrides.fit, group_file)?;
    let mut expansion = expand::expand(&all, document.seed, overrides)?;
    let mut nodes = std::mem::take(&mut expansion.nodes);
    let places: Vec<_> = wanted.iter().map(|wanted| expansion.place(&all, wanted)).collect();
    let mut tracer = trace::Tracer::new(&all, &expansion);
    for (node, (instance, id)) in nodes.iter_mut().zip(&expansion.origins) {
        node.inputs = tracer.inputs(*instance, id)?;
        for (kind, param) in &overrides.left_out {
            if node.kind == *kind {
                node.params.remove(param);
            }
        }
    }
    let traced = places.iter().map(|place| match place {
        Some((instance, from)) => tracer.trace(*instance, from),
        None => Ok(None),
    });
    let mut found: Vec<ResultOrigin> = traced.collect();
    let (nodes, place) = in_order(nodes)?;
    for source in found.iter_mut().flatten().flatten() {
        source.node = place[source.node];
    }
    Ok((FlatGraph { nodes }, found))
}

/// Sorts nodes so that each comes after the nodes that it reads, and adjusts their links. Also returns the new index of each node.
fn in_order(nodes: Vec<FlatNode>) -> Result<(Vec<FlatNode>, Vec<usize>), FlattenError> {
    let links = nodes.iter().enumerate();
    let links = links.flat_map(|(reader, node)| node.inputs.values().map(move |source| [source.node, reader]));
    let net = order::net(nodes.len(), links);
    let id = |at: NodeIndex| nodes[at.index()].id.as_str();
    let Some(order) = order::topological(&net, id) else {
        // Neither a graph nor the nesting of groups contains a circle, so the flat graph cannot contain one either.
        let circle = order::cycle(&net, id).unwrap_or_default();
        return Err(FlattenError::Circle {
            nodes: crate::problem::listed(circle.into_iter().map(id)),
        });
    };
    let order: Vec<usize> = order.into_iter().map(NodeIndex::index).collect();
    let mut place = vec![0; nodes.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new;
    }
    let mut taken: Vec<Option<FlatNode>> = nodes.into_iter().map(Some).collect();
    let mut sorted: Vec<FlatNode> = order.into_iter().filter_map(|old| taken[old].take()).collect();
    for node in &mut sorted {
        for source in node.inputs.values_mut() {
            source.node = place[source.node];
        }
    }
    Ok((sorted, place))
}
