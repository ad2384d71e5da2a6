//! A graph file as data: the main graph, its groups, and what is published of them.

use std::collections::BTreeMap;

use crate::{Graph, NodeId, OutputRef, PortType, SlotRef, Value};

/// A graph file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The name people see; empty when the file has none.
    pub name: String,
    /// What to look at while editing.
    pub preview: Option<Preview>,
    /// How the model is scaled for this graph.
    pub fit: Fit,
    /// Seed of the whole document; 0 unless the file says otherwise.
    pub seed: u32,
    /// The main graph.
    pub graph: Graph,
    /// Groups defined in this file, by name.
    pub groups: BTreeMap<String, GroupDef>,
    /// Inputs of the main graph when another file uses this one as a group.
    pub inputs: BTreeMap<String, GroupInput>,
    /// Outputs of the main graph when another file uses this one as a group.
    pub outputs: BTreeMap<String, OutputRef>,
    /// Top-level keys that this version does not know, kept as they are.
    pub extra: BTreeMap<String, Value>,
}

impl Document {
    /// The same, with these nodes of its main graph as ones of another kind.
    pub fn with_kind<'a>(&self, nodes: impl IntoIterator<Item = &'a NodeId>, kind: &str) -> Document {
        let mut document = self.clone();
        for id in nodes {
            if let Ok(node) = document.graph.node_mut(id) {
                node.kind = kind.to_owned();
            }
        }
        document
    }

    /// An empty document of that name.
    pub fn new(name: impl Into<String>) -> Self {
        Document {
            name: name.into(),
            ..Document::default()
        }
    }

    /// This document without what only its picture on a canvas needs: where nodes stand, and frames. Two that are equal then
    /// give the same results.
    pub fn without_places(&self) -> Document {
        let mut bare = self.clone();
        let groups = bare.groups.values_mut().map(|group| &mut group.graph);
        for graph in groups.chain([&mut bare.graph]) {
            graph.frames.clear();
            for (_, node) in graph.net.node_weights_mut() {
                node.pos = [0.0; 2];
            }
        }
        bare
    }
}

/// What the editor shows the graph on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// The model, as a path relative to the graph file.
    pub mesh: Option<String>,
    /// Side of the preview's textures in texels.
    pub size: Option<u32>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

/// What counts as length 1 on the model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fit {
    /// The model's largest side.
    #[default]
    Unit,
    /// One metre.
    Metres,
    /// This many metres; above zero.
    Length(f64),
}

/// A group: a graph that other graphs use as one node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupDef {
    /// The name people see, when it differs from the one it is filed under.
    pub name: Option<String>,
    /// The fit its lengths were made for; `None` means that of the document.
    pub fit: Option<Fit>,
    /// Its nodes, knobs, variants and frames.
    pub graph: Graph,
    /// Its inputs, by name.
    pub inputs: BTreeMap<String, GroupInput>,
    /// Its outputs, by name.
    pub outputs: BTreeMap<String, OutputRef>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

/// An input of a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupInput {
    /// The inputs of nodes inside that it feeds, written `node.input`.
    pub to: Vec<SlotRef>,
    /// What it carries, when the file says so.
    pub ty: Option<PortType>,
    /// Name shown to artists.
    pub label: Option<String>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}
