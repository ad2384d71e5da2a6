//! Wires: connecting, cutting, inserting, healing.

use std::collections::BTreeSet;

use sabi_engine::catalog::Port;
use sabi_graph::{Edit, NodeId, OutputRef, REROUTE_KIND, SlotRef, Value};

use super::{Desk, Loose};

/// How a second mask is put together with the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Merge {
    /// Instead of it.
    Replace,
    /// With a `blend/mask` of this mode.
    Blend(&'static str),
}

impl Merge {
    /// What is offered, with what it is called.
    pub(crate) const OFFERED: [(&'static str, Merge); 5] = [
        ("Multiply", Merge::Blend("multiply")),
        ("Add", Merge::Blend("add")),
        ("Max", Merge::Blend("max")),
        ("Subtract", Merge::Blend("subtract")),
        ("Replace", Merge::Replace),
    ];
}

/// How far a node that makes room stands from the one before it, canvas points.
const BESIDE: f32 = 60.0;

impl Desk {
    /// Ties a wire to an input in place of what was there. What the wire carries has to fit.
    pub(crate) fn connect(&mut self, from: &OutputRef, to: &SlotRef) -> bool {
        if let Err(why) = self.fits(from, to) {
            self.say(why);
            return false;
        }
        let edit = self.tie(from, to);
        self.edit("Connect", vec![edit])
    }

    /// Why a wire cannot lead there.
    pub(crate) fn fits(&self, from: &OutputRef, to: &SlotRef) -> Result<(), String> {
        let input = self
            .input(to)
            .ok_or_else(|| format!("'{}' has no input '{}'", to.node, to.name))?;
        let carried = self.faces.1.carried(&self.body(), from);
        match (carried, input.ty) {
            (Some(carried), Some(takes)) if !takes.accepts(carried) => Err(format!(
                "'{}' takes a {takes}, and this wire carries a {carried}; only masks and colors turn into each other",
                input.label
            )),
            _ => Ok(()),
        }
    }

    /// An input of a node that is seen.
    pub(crate) fn input(&self, slot: &SlotRef) -> Option<&Port> {
        self.face(&slot.node)?.input(&slot.name)
    }

    fn tie(&self, from: &OutputRef, to: &SlotRef) -> Edit {
        Edit::Connect {
            body: self.body(),
            node: to.node.clone(),
            input: to.name.clone(),
            from: self.shortest(from),
        }
    }

    /// A wire from a node's first output names the node alone.
    fn shortest(&self, from: &OutputRef) -> OutputRef {
        let face = self.face(&from.node);
        let is_first = face.is_some_and(|face| {
            let first = face.outputs.first().map(|port| port.name.as_str());
            first.is_some() && first == from.port.as_deref()
        });
        OutputRef {
            node: from.node.clone(),
            port: from.port.clone().filter(|_| !is_first),
        }
    }

    /// What an input reads.
    pub(crate) fn wire_into(&self, slot: &SlotRef) -> Option<&OutputRef> {
        self.node(&slot.node)?.inputs.get(&slot.name)
    }

    /// Takes wires off these inputs.
    pub(crate) fn cut(&mut self, slots: &[SlotRef]) -> bool {
        let tied = slots.iter().filter(|slot| self.wire_into(slot).is_some());
        let edits: Vec<Edit> = tied.map(|slot| self.untie(slot)).collect();
        let step = if edits.len() == 1 { "Disconnect" } else { "Cut wires" };
        self.edit(step, edits)
    }

    fn untie(&self, slot: &SlotRef) -> Edit {
        Edit::Disconnect {
            body: self.body(),
            node: slot.node.clone(),
            input: slot.name.clone(),
        }
    }

    /// Whether a wire that is dropped there should be asked about: a mask is there already, and there are ways to have both.
    pub(crate) fn may_merge(&self, from: &OutputRef, to: &SlotRef) -> bool {
        use sabi_graph::PortType::Mask;
        let takes_mask = self.input(to).is_some_and(|port| port.ty == Some(Mask));
        let carries = self.faces.1.carried(&self.body(), from);
        takes_mask && carries.is_some_and(|ty| Mask.accepts(ty)) && self.wire_into(to).is_some_and(|tied| tied != from)
    }

    /// Ties a second wire to an input that has one: both go through a blend, whose mode says how.
    pub(crate) fn merge(&mut self, from: &OutputRef, to: &SlotRef, how: Merge) -> bool {
        let mode = match (how, self.wire_into(to).cloned()) {
            (Merge::Blend(mode), Some(first)) => Some((mode, first)),
            _ => None,
        };
        let Some((mode, first)) = mode else {
            return self.connect(from, to);
        };
        let Some(reader) = self.node(&to.node) else {
            return false;
        };
        let pos = [reader.pos[0] - 2.0 * BESIDE - super::arrange::NODE_WIDTH, reader.pos[1]];
        let (id, mut node) = self.fresh("blend/mask", pos);
        node.inputs.insert("below".to_owned(), first);
        node.inputs.insert("above".to_owned(), self.shortest(from));
        node.params.insert("mode".to_owned(), Value::Text(mode.to_owned()));
        let blended = OutputRef {
            node: id.clone(),
            port: None,
        };
        let edits = vec![self.adding(&id, node), self.tie(&blended, to)];
        let is_made = self.edit("Blend masks", edits);
        if is_made {
            self.select([id]);
        }
        is_made
    }

    /// The edit that ties a loose wire to a node of the given face at its first port that fits; none where none does.
    pub(super) fn tie_loose(&self, loose: &Loose, id: &NodeId, face: &sabi_engine::catalog::Entry) -> Option<Edit> {
        match loose {
            Loose::From(from) => {
                let carried = self.faces.1.carried(&self.body(), from);
                let input = face.input_for(carried)?;
                let to = SlotRef {
                    node: id.clone(),
                    name: input.name.clone(),
                };
                Some(self.tie(from, &to))
            }
            Loose::Into(to) => {
                let output = face.output_for(self.input(to)?)?;
                let is_first = face.outputs.first().is_some_and(|first| first.name == output.name);
                let from = OutputRef {
                    node: id.clone(),
                    port: (!is_first).then(|| output.name.clone()),
                };
                Some(self.tie(&from, to))
            }
        }
    }

    /// Puts a node into the wire that leads to an input: it reads what the input read, and the input reads it.
    pub(crate) fn insert(&mut self, id: &NodeId, to: &SlotRef) -> bool {
        let edits = self.inserting(id, to);
        match edits {
            Some(edits) => self.edit("Insert", edits),
            None => false,
        }
    }

    /// Whether a node may be put into a wire, for showing it beforehand.
    pub(crate) fn may_insert(&self, id: &NodeId, to: &SlotRef) -> bool {
        self.inserting(id, to).is_some()
    }

    fn inserting(&self, id: &NodeId, to: &SlotRef) -> Option<Vec<Edit>> {
        let from = self.wire_into(to)?.clone();
        let is_tied = from.node == *id || to.node == *id || !self.graph().readers(id.as_str()).is_empty();
        let node = self.node(id)?;
        if is_tied || !node.inputs.is_empty() {
            return None;
        }
        let face = self.face(id)?.clone();
        let into = self.tie_loose(&Loose::From(from), id, &face)?;
        let out = self.tie_loose(&Loose::Into(to.clone()), id, &face)?;
        Some(vec![into, out])
    }

    /// Puts a bend into the wire that leads to an input.
    pub(crate) fn reroute(&mut self, to: &SlotRef, pos: [f32; 2]) -> bool {
        let Some(from) = self.wire_into(to).cloned() else {
            return false;
        };
        let (id, mut node) = self.fresh(REROUTE_KIND, pos);
        node.inputs.insert("source".to_owned(), from);
        let bend = OutputRef {
            node: id.clone(),
            port: None,
        };
        let edits = vec![self.adding(&id, node), self.tie(&bend, to)];
        self.edit("Bend wire", edits)
    }

    /// The edits that tie everybody who reads these nodes to what the nodes pass on, as muting them would.
    pub(super) fn healing(&self, ids: &BTreeSet<NodeId>) -> Vec<Edit> {
        let mut edits = Vec::new();
        for id in ids {
            for slot in self.graph().readers(id.as_str()) {
                if ids.contains(&slot.node) {
                    continue;
                }
                let tied = self.wire_into(&slot).cloned();
                let passed = tied.and_then(|from| self.passed_on(&from, ids));
                let fitting = passed.filter(|from| self.fits(from, &slot).is_ok());
                edits.push(match fitting {
                    Some(from) => self.tie(&from, &slot),
                    None => self.untie(&slot),
                });
            }
        }
        edits
    }

    /// What comes out of a wire when the nodes `gone` are mere wires: their first input of the same type.
    fn passed_on(&self, from: &OutputRef, gone: &BTreeSet<NodeId>) -> Option<OutputRef> {
        let mut at = from.clone();
        // Wires lead in no circle, so that this ends.
        while gone.contains(&at.node) {
            let face = self.face(&at.node)?;
            let ty = face.output(at.port.as_deref())?.ty;
            let node = self.node(&at.node)?;
            let fitting = face.inputs.iter().filter(|port| port.ty == ty);
            at = fitting.filter_map(|port| node.inputs.get(&port.name)).next()?.clone();
        }
        Some(at)
    }

    /// Takes the selected nodes out of their wires, which heal behind them.
    pub(crate) fn take_out(&mut self) -> bool {
        let ids = self.selection.clone();
        let mut edits = self.healing(&ids);
        for id in &ids {
            let Some(node) = self.node(id) else { continue };
            let outside = node.inputs.iter().filter(|(_, from)| !ids.contains(&from.node));
            edits.extend(outside.map(|(input, _)| {
                self.untie(&SlotRef {
                    node: id.clone(),
                    name: input.clone(),
                })
            }));
        }
        self.edit("Take out of the wires", edits)
    }

    /// Swaps what the first two inputs of the same type read.
    pub(crate) fn swap_inputs(&mut self) -> bool {
        let mut edits = Vec::new();
        for id in &self.selection {
            let Some((face, node)) = self.face(id).zip(self.node(id)) else {
                continue;
            };
            let slot = |port: &Port| SlotRef {
                node: id.clone(),
                name: port.name.clone(),
            };
            let pairs = face.inputs.iter().enumerate().flat_map(|(at, one)| {
                let rest = face.inputs[at + 1..].iter();
                rest.filter(|other| other.ty == one.ty).map(move |other| (one, other))
            });
            let is_tied = |port: &Port| node.inputs.contains_key(&port.name);
            let Some((one, other)) = pairs.into_iter().find(|(one, other)| is_tied(one) || is_tied(other)) else {
                continue;
            };
            for (to, from) in [(one, other), (other, one)] {
                edits.push(match node.inputs.get(&from.name) {
                    Some(from) => self.tie(from, &slot(to)),
                    None => self.untie(&slot(to)),
                });
            }
        }
        self.edit("Swap inputs", edits)
    }
}
