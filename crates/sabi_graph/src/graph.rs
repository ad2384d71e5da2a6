//! Nodes and links of a document or a group, on petgraph's stable graph.

use std::collections::{BTreeMap, BTreeSet};

use petgraph::Direction;
use petgraph::stable_graph::{EdgeIndex, NodeIndex, StableDiGraph};
use petgraph::visit::{Dfs, EdgeRef, IntoNeighbors, Reversed, Visitable};

use crate::order;
use crate::problem::{Problem, hint, quoted};
use crate::{KnobCurve, NodeDisplay, NodeId, Note, OutputRef, SlotRef, Value};

/// A knob that a graph exposes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExposedParameter {
    /// The parameters it sets, written `node.param`.
    pub to: Vec<SlotRef>,
    /// Curves for the parameters that do not take the value of the knob directly: value of the parameter over the value of
    /// the knob. A knob with curves has a default.
    pub curves: BTreeMap<SlotRef, KnobCurve>,
    /// Name shown to artists.
    pub label: Option<String>,
    /// One sentence about its effect, for artists.
    pub about: Option<String>,
    /// Title of the section that contains the knob.
    pub section: Option<String>,
    /// Position among the exposed knobs. Knobs without one come last, sorted by name.
    pub order: Option<u32>,
    /// Accepted numbers, lowest and highest. Numbers outside are refused.
    pub range: Option<[f64; 2]>,
    /// Value of the knob while neither a variant nor the user sets it. Without a default, the nodes keep their own values.
    pub default: Option<Value>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

impl ExposedParameter {
    /// Returns this knob with other parameters. Curves of parameters that it no longer sets are removed.
    pub fn with_targets(&self, to: Vec<SlotRef>) -> ExposedParameter {
        let mut curves = self.curves.clone();
        curves.retain(|slot, _| to.contains(slot));
        ExposedParameter {
            to,
            curves,
            ..self.clone()
        }
    }

    /// Returns the parameters that the knob sets, each with its value for this value of the knob.
    pub fn settings(&self, value: &Value) -> impl Iterator<Item = (&SlotRef, Value)> {
        self.to.iter().map(move |slot| match self.curves.get(slot) {
            Some(curve) => (slot, curve.apply(value)),
            None => (slot, value.clone()),
        })
    }
}

/// A titled box around nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The title.
    pub title: Option<String>,
    /// Its color, `#rrggbb`.
    pub color: Option<String>,
    /// The nodes in it; ids of removed nodes are ignored.
    pub nodes: Vec<NodeId>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

/// A node as stored in the file, without its links, which belong to the graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Its kind, such as `noise/simplex` or `noise/simplex@2`.
    pub kind: String,
    /// Parameters that were set.
    pub params: BTreeMap<String, Value>,
    /// Position on the canvas, in canvas points.
    pub pos: [f32; 2],
    /// True if the node is muted: it passes its main input through.
    pub muted: bool,
    /// How it is drawn.
    pub display: NodeDisplay,
    /// Display name, where the artist gave one.
    pub label: Option<String>,
    /// Group of which the node is an instance, by name or file; only for kind `graph/group`.
    pub group: Option<String>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

impl Node {
    /// Creates a node without parameters.
    pub fn new(kind: impl Into<String>) -> Self {
        Node {
            kind: kind.into(),
            ..Node::default()
        }
    }
}

/// Link into a node: the weight of an edge from the node that is read to the one that reads it.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    /// Input of the reader.
    input: String,
    /// Output that is read. It repeats the id of its node, which never changes, so that links can be borrowed.
    from: OutputRef,
}

/// Nodes and links of a document or a group, with its frames, knobs and variants. Every link starts at an existing node,
/// and links form no circle. Only [`Document::apply`](crate::Document::apply) changes a graph.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Nodes and links.
    ///
    /// Not wrapped in `petgraph::acyclic::Acyclic` (petgraph 0.8), for three reasons: it is not `Sync`, while documents
    /// are shared between threads; its error names one node and not the whole cycle; and adding an edge may take time
    /// proportional to the size of the graph.
    pub(crate) net: StableDiGraph<(NodeId, Node), Link>,
    index: BTreeMap<NodeId, NodeIndex>,
    pub(crate) frames: BTreeMap<String, Frame>,
    pub(crate) notes: BTreeMap<String, Note>,
    pub(crate) exposed: BTreeMap<String, ExposedParameter>,
    pub(crate) variants: BTreeMap<String, BTreeMap<String, Value>>,
}

impl PartialEq for Graph {
    fn eq(&self, other: &Self) -> bool {
        self.nodes().eq(other.nodes())
            && self
                .ids()
                .all(|id| self.inputs(id.as_str()) == other.inputs(id.as_str()))
            && self.frames == other.frames
            && self.notes == other.notes
            && self.exposed == other.exposed
            && self.variants == other.variants
    }
}

impl Graph {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Returns true if there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// All nodes, sorted by id.
    pub fn nodes(&self) -> impl Iterator<Item = (&NodeId, &Node)> {
        self.index.iter().map(|(id, &index)| (id, &self.net[index].1))
    }

    /// All ids, sorted.
    pub fn ids(&self) -> impl Iterator<Item = &NodeId> {
        self.index.keys()
    }

    /// The node of that id.
    pub fn node(&self, id: &str) -> Option<&Node> {
        self.index.get(id).map(|&index| &self.net[index].1)
    }

    /// Links into a node, by input.
    pub fn inputs(&self, id: &str) -> BTreeMap<&str, &OutputRef> {
        let links = self.index.get(id).into_iter().flat_map(|&index| self.links_into(index));
        links.map(|(_, link)| (link.input.as_str(), &link.from)).collect()
    }

    /// The output that an input of a node is linked to. For all inputs of a node, [`Graph::inputs`] is faster.
    pub fn link_into(&self, id: &str, input: &str) -> Option<&OutputRef> {
        let mut links = self.links_into(*self.index.get(id)?);
        links.find(|(_, link)| link.input == input).map(|(_, link)| &link.from)
    }

    /// Links into a node with their edges, in no particular order.
    fn links_into(&self, index: NodeIndex) -> impl Iterator<Item = (EdgeIndex, &Link)> {
        let edges = self.net.edges_directed(index, Direction::Incoming);
        edges.map(|edge| (edge.id(), edge.weight()))
    }

    /// Inputs that are linked to a node, sorted.
    pub fn readers(&self, id: &str) -> Vec<SlotRef> {
        let Some(&index) = self.index.get(id) else {
            return Vec::new();
        };
        let mut readers: Vec<SlotRef> = self
            .net
            .edges_directed(index, Direction::Outgoing)
            .map(|edge| SlotRef {
                node: self.net[edge.target()].0.clone(),
                name: edge.weight().input.clone(),
            })
            .collect();
        readers.sort();
        readers
    }

    /// These nodes and all nodes that they depend on. Nodes that do not exist are left out.
    pub fn upstream<'i>(&self, of: impl IntoIterator<Item = &'i NodeId>) -> BTreeSet<NodeId> {
        self.reached(Reversed(&self.net), of)
    }

    /// These nodes and all nodes that depend on them. Nodes that do not exist are left out.
    pub fn downstream<'i>(&self, of: impl IntoIterator<Item = &'i NodeId>) -> BTreeSet<NodeId> {
        self.reached(&self.net, of)
    }

    fn reached<'i, G>(&self, net: G, from: impl IntoIterator<Item = &'i NodeId>) -> BTreeSet<NodeId>
    where
        G: IntoNeighbors<NodeId = NodeIndex> + Visitable<NodeId = NodeIndex>,
    {
        let mut walk = Dfs::empty(net);
        let mut reached = BTreeSet::new();
        for &start in from.into_iter().filter_map(|id| self.index.get(id)) {
            walk.move_to(start);
            while let Some(at) = walk.next(net) {
                reached.insert(self.net[at].0.clone());
            }
        }
        reached
    }

    /// Returns all ids, each after the ids of the nodes that it reads. Ties are broken by the smallest id.
    pub fn topological_order(&self) -> Vec<NodeId> {
        let order = order::topological(&self.net, |at| &self.net[at].0);
        let order = order.unwrap_or_else(|| unreachable!("links that close a circle are refused"));
        self.named(order)
    }

    /// Titled boxes, by id.
    pub fn frames(&self) -> &BTreeMap<String, Frame> {
        &self.frames
    }

    /// Texts on the canvas, by id.
    pub fn notes(&self) -> &BTreeMap<String, Note> {
        &self.notes
    }

    /// Exposed knobs, by name.
    pub fn exposed(&self) -> &BTreeMap<String, ExposedParameter> {
        &self.exposed
    }

    /// Returns the exposed knobs in their order, by position and name. A section is placed where its first knob is.
    pub fn exposed_in_order(&self) -> Vec<(&str, &ExposedParameter)> {
        let mut knobs: Vec<(&str, &ExposedParameter)> =
            self.exposed.iter().map(|(name, knob)| (name.as_str(), knob)).collect();
        knobs.sort_by_key(|(_, knob)| knob.order.unwrap_or(u32::MAX));
        let mut sections: Vec<Option<&str>> = Vec::new();
        for (_, knob) in &knobs {
            if !sections.contains(&knob.section.as_deref()) {
                sections.push(knob.section.as_deref());
            }
        }
        knobs.sort_by_key(|(_, knob)| sections.iter().position(|title| *title == knob.section.as_deref()));
        knobs
    }

    /// Returns the variants by name; each has values by knob.
    pub fn variants(&self) -> &BTreeMap<String, BTreeMap<String, Value>> {
        &self.variants
    }

    /// Returns the values of exposed knobs in a variant, or without one: defaults of the knobs, overridden by values of
    /// the variant. Parameters that no knob sets keep the values of their nodes.
    pub fn knob_values<'g>(
        &'g self,
        variant: Option<&'g BTreeMap<String, Value>>,
    ) -> impl Iterator<Item = (&'g str, &'g Value)> {
        let defaults = self.exposed.iter();
        let defaults = defaults.filter_map(|(name, knob)| Some((name.as_str(), knob.default.as_ref()?)));
        let of_variant = variant.into_iter().flatten();
        defaults.chain(of_variant.map(|(name, value)| (name.as_str(), value)))
    }

    fn named(&self, nodes: Vec<NodeIndex>) -> Vec<NodeId> {
        nodes.into_iter().map(|at| self.net[at].0.clone()).collect()
    }

    /// petgraph index of a node, or the error that it does not exist.
    pub(crate) fn find(&self, id: &str) -> Result<NodeIndex, Problem> {
        self.index.get(id).copied().ok_or_else(|| self.no_such_node(id))
    }

    /// Error that a node does not exist, with the nearest id.
    pub(crate) fn no_such_node(&self, id: &str) -> Problem {
        Problem::NoSuchNode {
            name: quoted(id),
            hint: hint(id, self.index.keys().map(NodeId::as_str)),
        }
    }

    /// Returns the node with this id.
    pub(crate) fn node_mut(&mut self, id: &NodeId) -> Result<&mut Node, Problem> {
        let index = self.find(id.as_str())?;
        Ok(&mut self.net[index].1)
    }

    /// Adds a node without links.
    pub(crate) fn insert(&mut self, id: NodeId, node: Node) -> Result<(), Problem> {
        if self.index.contains_key(&id) {
            return Err(Problem::NodeExists { id });
        }
        let index = self.net.add_node((id.clone(), node));
        self.index.insert(id, index);
        Ok(())
    }

    /// Removes a node and its links. No other node may read it.
    pub(crate) fn remove(&mut self, id: &NodeId) -> Result<Node, Problem> {
        let index = self.find(id.as_str())?;
        let removed = self.net.remove_node(index);
        let (_, node) = removed.ok_or_else(|| self.no_such_node(id.as_str()))?;
        self.index.remove(id);
        Ok(node)
    }

    /// Links an input that has no link yet, without checking for circles.
    pub(crate) fn link(&mut self, reader: &NodeId, input: String, from: OutputRef) -> Result<(), Problem> {
        let target = self.find(reader.as_str())?;
        let source = self.find(from.node.as_str())?;
        if source == target {
            return Err(Problem::SelfLink { id: reader.clone() });
        }
        self.net.add_edge(source, target, Link { input, from });
        Ok(())
    }

    /// Unlinks an input; gives the removed link.
    pub(crate) fn unlink(&mut self, reader: &NodeId, input: &str) -> Result<Option<OutputRef>, Problem> {
        let target = self.find(reader.as_str())?;
        let link = self.links_into(target).find(|(_, link)| link.input == input);
        let edge = link.map(|(edge, _)| edge);
        Ok(edge.and_then(|edge| self.net.remove_edge(edge)).map(|link| link.from))
    }

    /// Refuses a link from `from` to `reader` that would close a circle.
    pub(crate) fn circle_closed_by(&self, from: &NodeId, reader: &NodeId) -> Result<(), Problem> {
        let (source, target) = (self.find(from.as_str())?, self.find(reader.as_str())?);
        match order::shortest_path(&self.net, |at| &self.net[at].0, [target, source]) {
            Some(nodes) => Err(Problem::Cycle {
                nodes: self.named(nodes),
            }),
            None => Ok(()),
        }
    }

    /// Refuses links that lead in a circle.
    pub(crate) fn check_order(&self) -> Result<(), Problem> {
        match order::cycle(&self.net, |at| &self.net[at].0) {
            Some(nodes) => Err(Problem::Cycle {
                nodes: self.named(nodes),
            }),
            None => Ok(()),
        }
    }
}
