//! Expands group instances, from the outermost inward.

use std::collections::BTreeMap;

use super::definitions::Definitions;
use super::knobs::{self, KnobValues};
use super::{FlatNode, FlattenError, NodeRef, Overrides};
use crate::problem::{hint, listed, quoted};
use crate::{Fit, GROUP_KIND, Graph, Node, NodeId, OutputRef, REROUTE_KIND, Value};

/// Maximum depth of instances inside instances.
const DEPTH_LIMIT: usize = 256;
/// Maximum number of nodes and instances.
const COUNT_LIMIT: usize = 100_000;
/// Maximum number of bytes of ids and parameters.
const BYTE_LIMIT: usize = 256 << 20;

/// The document (number 0) or a group instance.
pub(super) struct Instance {
    /// Number of the graph of the instance.
    pub(super) definition: usize,
    /// Enclosing instance, and the node of this instance in it.
    pub(super) parent: Option<(usize, NodeId)>,
    /// Prefix of the ids of the nodes inside: empty, or `outer/inner/`.
    pub(super) prefix: String,
    depth: usize,
    seeds: Vec<u32>,
    length_scale: f64,
    /// Fit that replaces the fits of the groups inside.
    fit: Option<Fit>,
    muted: bool,
    settings: KnobValues,
}

/// Result of expanding a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum ExpandedNode {
    /// A node of the flat graph, by its number.
    Node(usize),
    /// A group instance, by its number.
    Instance(usize),
    /// A reroute.
    Reroute,
}

/// All instances, expanded.
#[derive(Default)]
pub(super) struct Expansion {
    pub(super) instances: Vec<Instance>,
    /// Nodes of the flat graph without their links, in no particular order.
    pub(super) nodes: Vec<FlatNode>,
    /// Instance and id of each node of the flat graph.
    pub(super) origins: Vec<(usize, NodeId)>,
    /// Results of expanding, by instance and node id.
    pub(super) expanded: BTreeMap<usize, BTreeMap<NodeId, ExpandedNode>>,
    bytes: usize,
}

pub(super) fn expand(all: &Definitions<'_>, seed: u32, overrides: &Overrides) -> Result<Expansion, FlattenError> {
    let mut expansion = Expansion::default();
    expansion.instances.push(Instance {
        definition: 0,
        parent: None,
        prefix: String::new(),
        depth: 0,
        seeds: vec![overrides.seed.unwrap_or(seed)],
        length_scale: 1.0,
        fit: None,
        muted: false,
        settings: knobs::of_overrides(all.get(0).graph, overrides)?,
    });
    let mut next = 0;
    while next < expansion.instances.len() {
        expansion.expand_instance(all, next)?;
        next += 1;
    }
    Ok(expansion)
}

impl Expansion {
    /// Returns the instance that contains a node, and the result inside it; `None` if the node does not exist.
    pub(super) fn place(&self, all: &Definitions<'_>, wanted: &NodeRef) -> Option<(usize, OutputRef)> {
        let (prefix, id) = match wanted.node.rfind('/') {
            Some(at) => wanted.node.split_at(at + 1),
            None => ("", wanted.node.as_str()),
        };
        let instance = self.instances.iter().position(|instance| instance.prefix == prefix)?;
        let (id, expanded) = self.expanded.get(&instance)?.get_key_value(id)?;
        let port = match expanded {
            // A link from an instance must name an output, but a preview of an instance shows the first output.
            ExpandedNode::Instance(inner) if wanted.port.is_none() => all
                .get(self.instances[*inner].definition)
                .outputs
                .keys()
                .next()
                .cloned(),
            _ => wanted.port.clone(),
        };
        Some((instance, OutputRef { node: id.clone(), port }))
    }

    fn expand_instance(&mut self, all: &Definitions<'_>, number: usize) -> Result<(), FlattenError> {
        let definition = all.get(self.instances[number].definition);
        let mut set: BTreeMap<NodeId, Vec<(String, Value)>> = BTreeMap::new();
        for (slot, value) in std::mem::take(&mut self.instances[number].settings) {
            set.entry(slot.node).or_default().push((slot.name, value));
        }
        let mut by_id = BTreeMap::new();
        for (id, node) in definition.graph.nodes() {
            let mut params = node.params.clone();
            params.extend(set.remove(id).into_iter().flatten());
            let path = format!("{}{id}", self.instances[number].prefix);
            self.check_size(&path, &params)?;
            let expanded = match node.kind.as_str() {
                REROUTE_KIND => {
                    check_inputs(&path, definition.graph, id, ["source"])?;
                    ExpandedNode::Reroute
                }
                GROUP_KIND => self.add_instance(all, number, id, node, path, &params)?,
                _ => self.add_node(all, number, id, node, path, params)?,
            };
            by_id.insert(id.clone(), expanded);
        }
        self.expanded.insert(number, by_id);
        Ok(())
    }

    /// Adds a node to the total size and checks the limits. Nested groups grow exponentially, so a small file could
    /// otherwise fill the memory.
    fn check_size(&mut self, path: &str, params: &BTreeMap<String, Value>) -> Result<(), FlattenError> {
        let values: usize = params.iter().map(|(name, value)| name.len() + size_bytes(value)).sum();
        // Each node has a fixed cost besides the length of its texts.
        self.bytes += 256 + path.len() + values;
        if self.bytes > BYTE_LIMIT || self.instances.len() + self.nodes.len() >= COUNT_LIMIT {
            return Err(FlattenError::TooLarge { count: COUNT_LIMIT });
        }
        Ok(())
    }

    fn add_instance(
        &mut self,
        all: &Definitions<'_>,
        number: usize,
        id: &NodeId,
        node: &Node,
        path: String,
        params: &BTreeMap<String, Value>,
    ) -> Result<ExpandedNode, FlattenError> {
        let outer = &self.instances[number];
        let Some(&definition) = all.instances.get(&(outer.definition, id.clone())) else {
            return Err(FlattenError::GroupNotNamed {
                instance: quoted(&path),
            });
        };
        if outer.depth == DEPTH_LIMIT {
            return Err(FlattenError::TooDeep { limit: DEPTH_LIMIT });
        }
        let group = all.get(definition);
        let graph = all.get(outer.definition).graph;
        check_inputs(&path, graph, id, group.inputs.keys().map(String::as_str))?;
        let knobs = knobs::of_instance(group.graph, &path, params)?;
        let length_scale = outer.length_scale * knobs.scale;
        if !(length_scale.is_finite() && length_scale > 0.0) {
            return Err(FlattenError::ScaleOverflow {
                instance: quoted(&path),
            });
        }
        let mut seeds = outer.seeds.clone();
        // Seed 0 changes nothing: the nodes of the instance give the same results as they would outside of a group.
        if knobs.seed != 0 {
            seeds.push(knobs.seed);
        }
        let instance = Instance {
            definition,
            parent: Some((number, id.clone())),
            prefix: format!("{path}/"),
            depth: outer.depth + 1,
            seeds,
            length_scale,
            fit: knobs.fit.or(outer.fit),
            muted: outer.muted || node.muted,
            settings: knobs.settings,
        };
        self.instances.push(instance);
        Ok(ExpandedNode::Instance(self.instances.len() - 1))
    }

    fn add_node(
        &mut self,
        all: &Definitions<'_>,
        number: usize,
        id: &NodeId,
        node: &Node,
        path: String,
        params: BTreeMap<String, Value>,
    ) -> Result<ExpandedNode, FlattenError> {
        let outer = &self.instances[number];
        let definition = all.get(outer.definition);
        let (kind, version) = kind_and_version(&path, &node.kind)?;
        self.nodes.push(FlatNode {
            id: path,
            kind,
            version,
            params,
            inputs: BTreeMap::new(),
            muted: outer.muted || node.muted,
            seeds: outer.seeds.clone(),
            length_scale: outer.length_scale,
            fit: outer.fit.unwrap_or(definition.fit),
            file: definition.file.map(str::to_owned),
        });
        self.origins.push((number, id.clone()));
        Ok(ExpandedNode::Node(self.nodes.len() - 1))
    }
}

/// Refuses links into inputs that an instance or reroute does not have.
fn check_inputs<'a>(
    path: &str,
    graph: &Graph,
    id: &NodeId,
    known: impl IntoIterator<Item = &'a str>,
) -> Result<(), FlattenError> {
    let known: Vec<&str> = known.into_iter().collect();
    match graph
        .inputs(id.as_str())
        .into_keys()
        .find(|input| !known.contains(input))
    {
        None => Ok(()),
        Some(input) => Err(FlattenError::NoSuchInput {
            node: quoted(path),
            input: quoted(input),
            hint: hint(input, known.iter().copied()),
            known: listed(known),
        }),
    }
}

/// `noise/simplex@2` is kind `noise/simplex` in version 2.
fn kind_and_version(path: &str, kind: &str) -> Result<(String, u32), FlattenError> {
    let Some((name, version)) = kind.split_once('@') else {
        return Ok((kind.to_owned(), 1));
    };
    match version.parse::<u32>() {
        Ok(number) if number > 0 && !name.is_empty() => Ok((name.to_owned(), number)),
        _ => Err(FlattenError::BadVersion {
            node: quoted(path),
            kind: quoted(kind),
        }),
    }
}

/// Approximate size of a value in bytes.
fn size_bytes(value: &Value) -> usize {
    const SELF: usize = 32;
    SELF + match value {
        Value::Text(text) => text.len(),
        Value::List(items) => items.iter().map(size_bytes).sum(),
        Value::Object(members) => members.iter().map(|(key, value)| key.len() + size_bytes(value)).sum(),
        Value::Null | Value::Bool(_) | Value::Number(_) => 0,
    }
}
