//! Edits at random, the same ones for the same seed: knobs are changed, nodes added and removed, wires connected and
//! cut, and now and then steps are undone.

use std::collections::BTreeMap;

use sabi_graph::{Body, Document, Edit, Node, NodeId, OutputRef, Value};

/// A kind of node, one knob of it with its range, its inputs, and whether it gives a material.
type WalkKind = (&'static str, &'static str, [f64; 2], &'static [&'static str], bool);

const KINDS: [WalkKind; 8] = [
    ("noise/simplex", "size", [0.05, 0.5], &[], false),
    ("surface/direction", "reach", [10.0, 170.0], &[], false),
    ("adjust/threshold", "at", [0.0, 1.0], &["source"], false),
    ("adjust/levels", "black", [0.0, 0.5], &["source"], false),
    ("filter/blur", "radius", [0.005, 0.05], &["source"], false),
    ("blend/mask", "opacity", [0.0, 1.0], &["below", "above"], false),
    ("source/material", "roughness", [0.0, 1.0], &[], true),
    ("effect/layer", "opacity", [0.0, 1.0], &["base", "mask"], true),
];

/// Inputs that take a material.
const MATERIALS: [&str; 2] = ["base", "material"];
/// The graph stays about as large as one that is worked on.
const FEW: usize = 10;
const MANY: usize = 40;

/// The graph that a walk begins with.
pub(crate) const FIRST: &str = r##"{ "format": "sabi", "version": 1, "preview": { "size": 64 }, "nodes": {
    "clouds": { "kind": "noise/simplex", "params": { "octaves": 3 } },
    "cut": { "kind": "adjust/threshold", "inputs": { "source": "clouds" } },
    "base": { "kind": "source/material" },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "cut" }, "params": { "color": "#6b3a1e" } },
    "out": { "kind": "output/material", "inputs": { "material": "rust" } } } }"##;

/// Step of a walk.
pub(crate) enum WalkStep {
    /// An edit, which may be refused.
    Edit(Box<Edit>),
    /// Undo of the last step.
    Undo,
    /// Redo of the last step that was undone.
    Redo,
}

/// A random walk through the edits of a graph.
pub(crate) struct Walk {
    state: u64,
    count: usize,
}

impl Walk {
    pub(crate) fn new(seed: u64) -> Walk {
        Walk { state: seed, count: 0 }
    }

    /// A number below `limit`: SplitMix64 (Steele, Lea, Flood 2014).
    fn below(&mut self, limit: usize) -> usize {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % limit.max(1) as u64) as usize
    }

    fn one_of<T: Clone>(&mut self, all: &[T]) -> Option<T> {
        let at = self.below(all.len());
        all.get(at).cloned()
    }

    /// Chooses the next step for a graph.
    pub(crate) fn next(&mut self, document: &Document) -> WalkStep {
        let ids: Vec<NodeId> = document.graph.ids().cloned().collect();
        let edit = match self.below(20) {
            0..10 => self.turn(document, &ids),
            10..14 => self.tie(document, &ids),
            14 | 15 => self.come_or_go(document, &ids),
            16 => self.mute(document, &ids),
            17 | 18 => return WalkStep::Undo,
            _ => return WalkStep::Redo,
        };
        edit.map_or(WalkStep::Undo, |edit| WalkStep::Edit(Box::new(edit)))
    }

    fn turn(&mut self, document: &Document, ids: &[NodeId]) -> Option<Edit> {
        let node = self.one_of(ids)?;
        let (_, knob, [low, high], ..) = kind_of(document, &node)?;
        let share = self.below(1000) as f64 / 999.0;
        Some(Edit::SetParam {
            body: Body::Main,
            node,
            param: (*knob).to_owned(),
            value: Some(Value::Number(low + share * (high - low))),
        })
    }

    fn tie(&mut self, document: &Document, ids: &[NodeId]) -> Option<Edit> {
        let node = self.one_of(ids)?;
        let inputs = match kind_of(document, &node) {
            Some((_, _, _, inputs, _)) => inputs,
            None => &["material"][..],
        };
        let input = self.one_of(inputs)?;
        if self.below(6) == 0 && node.as_str() != "out" {
            return Some(Edit::Disconnect {
                body: Body::Main,
                node,
                input: input.to_owned(),
            });
        }
        Some(Edit::Connect {
            body: Body::Main,
            node,
            input: input.to_owned(),
            from: self.fitting(document, ids, input)?,
        })
    }

    /// A result that an input takes.
    fn fitting(&mut self, document: &Document, ids: &[NodeId], input: &str) -> Option<OutputRef> {
        let fits = |id: &&NodeId| kind_of(document, id).is_some_and(|kind| kind.4 == MATERIALS.contains(&input));
        let fitting: Vec<NodeId> = ids.iter().filter(fits).cloned().collect();
        let node = self.one_of(&fitting)?;
        Some(OutputRef { node, port: None })
    }

    fn come_or_go(&mut self, document: &Document, ids: &[NodeId]) -> Option<Edit> {
        let comes = ids.len() < FEW || (ids.len() < MANY && self.below(2) == 0);
        if !comes {
            let id = self.one_of(ids).filter(|id| id.as_str() != "out")?;
            return Some(Edit::RemoveNode { body: Body::Main, id });
        }
        let (kind, _, _, inputs, _) = self.one_of(&KINDS)?;
        let mut links = BTreeMap::new();
        for input in inputs {
            if let Some(from) = self.fitting(document, ids, input) {
                links.insert((*input).to_owned(), from);
            }
        }
        self.count += 1;
        Some(Edit::AddNode {
            body: Body::Main,
            id: format!("node_{}", self.count).parse().ok()?,
            node: Node::new(kind),
            inputs: links,
        })
    }

    fn mute(&mut self, document: &Document, ids: &[NodeId]) -> Option<Edit> {
        let node = self.one_of(ids).filter(|id| id.as_str() != "out")?;
        Some(Edit::SetMuted {
            body: Body::Main,
            muted: !document.graph.node(node.as_str())?.muted,
            node,
        })
    }
}

fn kind_of(document: &Document, id: &NodeId) -> Option<&'static WalkKind> {
    let node = document.graph.node(id.as_str())?;
    KINDS.iter().find(|(kind, ..)| *kind == node.kind)
}
