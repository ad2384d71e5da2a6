//! Wires: connecting, cutting, bending, healing.

use std::collections::BTreeSet;

use sabi_engine::catalog::{Entry, Port};
use sabi_graph::{Edit, GROUP_KIND, NodeId, OutputRef, PortType, REROUTE_KIND, SlotRef, Value};

use super::arrangement::{BEND_SIZE, NODE_WIDTH};
use super::{OpenDocument, PendingWire};

/// How a second mask is put together with the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskMerge {
    /// Instead of it.
    Replace,
    /// With a `blend/mask` of this mode.
    Blend(&'static str),
}

impl MaskMerge {
    /// What is offered, with what it is called.
    pub const OFFERED: [(&'static str, MaskMerge); 5] = [
        ("Multiply", MaskMerge::Blend("multiply")),
        ("Add", MaskMerge::Blend("add")),
        ("Max", MaskMerge::Blend("max")),
        ("Subtract", MaskMerge::Blend("subtract")),
        ("Replace", MaskMerge::Replace),
    ];
}

/// How far a node that makes room stands from the one before it, canvas points.
const BESIDE: f32 = 60.0;

impl OpenDocument {
    /// Ties a wire to an input in place of what was there. What the wire carries has to fit.
    pub fn connect(&mut self, from: &OutputRef, to: &SlotRef) -> bool {
        if let Err(why) = self.fits(from, to) {
            return self.refuse(why);
        }
        let edit = self.tie(from, to);
        self.edit("Connect", vec![edit])
    }

    /// Why a wire cannot lead there.
    pub fn fits(&self, from: &OutputRef, to: &SlotRef) -> Result<(), String> {
        self.carries_what_fits(from, to)?;
        if !self.is_made_from(&from.node, &to.node) {
            return Ok(());
        }
        let [one, other] = [&from.node, &to.node].map(|id| self.title(id));
        Err(match from.node == to.node {
            true => format!("'{one}' cannot read its own result"),
            false => format!("'{one}' is made from '{other}'; this wire would lead in a circle"),
        })
    }

    /// Why a wire that leads there carries something else.
    pub(super) fn carries_what_fits(&self, from: &OutputRef, to: &SlotRef) -> Result<(), String> {
        let Some(input) = self.input(to) else {
            return Err(format!("'{}' has no input '{}'", self.title(&to.node), to.name));
        };
        let source = self.face(&from.node);
        if source.and_then(|face| face.output(from.port.as_deref())).is_none() {
            let title = self.title(&from.node);
            return Err(match &from.port {
                Some(port) => format!("'{title}' gives no result '{port}'"),
                None => format!("'{title}' gives no result"),
            });
        }
        let Some(carried) = self.carried(from) else {
            return Ok(());
        };
        let refused = |label: &str, takes: PortType| {
            let why = "only masks and colors turn into each other";
            Err(format!(
                "'{label}' takes a {takes}, and this wire carries a {carried}; {why}"
            ))
        };
        if !self.is_reroute(&to.node) {
            return match input.ty {
                Some(takes) if !takes.accepts(carried) => refused(&input.label, takes),
                _ => Ok(()),
            };
        }
        // A bend takes whatever those take who read it.
        match self
            .behind_bends(&to.node)
            .into_iter()
            .find(|(_, takes)| !takes.accepts(carried))
        {
            Some((label, takes)) => refused(&label, takes),
            None => Ok(()),
        }
    }

    fn is_reroute(&self, id: &NodeId) -> bool {
        self.node(id).is_some_and(|node| node.kind == REROUTE_KIND)
    }

    /// The inputs that a reroute leads to in the end, each with what it takes.
    fn behind_bends(&self, id: &NodeId) -> Vec<(String, PortType)> {
        let mut found = Vec::new();
        let mut seen = BTreeSet::from([id.clone()]);
        let mut next = vec![id.clone()];
        while let Some(id) = next.pop() {
            for slot in self.graph().readers(id.as_str()) {
                if self.is_reroute(&slot.node) {
                    next.extend(Some(slot.node).filter(|id| seen.insert(id.clone())));
                } else if let Some((port, takes)) = self.input(&slot).and_then(|port| Some((port, port.ty?))) {
                    found.push((port.label.clone(), takes));
                }
            }
        }
        found
    }

    /// What is carried by a wire from there.
    pub fn carried(&self, from: &OutputRef) -> Option<PortType> {
        self.faces().carried(&self.seen, from)
    }

    /// An input of a node that is seen.
    pub fn input(&self, slot: &SlotRef) -> Option<&Port> {
        self.face(&slot.node)?.input(&slot.name)
    }

    pub(super) fn tie(&self, from: &OutputRef, to: &SlotRef) -> Edit {
        Edit::Connect {
            body: self.body(),
            node: to.node.clone(),
            input: to.name.clone(),
            from: self.shortest(from),
        }
    }

    /// A wire from a node's first output names the node alone; one from a group always says which it means, since the group
    /// may get another.
    pub(super) fn shortest(&self, from: &OutputRef) -> OutputRef {
        let face = self.face(&from.node);
        let named = face.and_then(|face| Some(port_in_wire(face, face.output(from.port.as_deref())?)));
        OutputRef {
            node: from.node.clone(),
            port: named.unwrap_or_else(|| from.port.clone()),
        }
    }

    /// What an input reads.
    pub fn wire_into(&self, slot: &SlotRef) -> Option<&OutputRef> {
        self.node(&slot.node)?.inputs.get(&slot.name)
    }

    /// Takes wires off these inputs.
    pub fn cut(&mut self, slots: &[SlotRef]) -> bool {
        let tied = slots.iter().filter(|slot| self.wire_into(slot).is_some());
        let edits: Vec<Edit> = tied.map(|slot| self.untie(slot)).collect();
        let step = if edits.len() == 1 { "Disconnect" } else { "Cut wires" };
        self.edit(step, edits)
    }

    pub(super) fn untie(&self, slot: &SlotRef) -> Edit {
        Edit::Disconnect {
            body: self.body(),
            node: slot.node.clone(),
            input: slot.name.clone(),
        }
    }

    /// Whether a wire that is dropped there should be asked about: a mask is there already, and there are ways to have both.
    pub fn may_merge(&self, from: &OutputRef, to: &SlotRef) -> bool {
        use sabi_graph::PortType::Mask;
        let takes_mask = self.input(to).is_some_and(|port| port.ty == Some(Mask));
        let carries = self.carried(from);
        let is_other = |tied: &OutputRef| self.shortest(tied) != self.shortest(from);
        takes_mask && carries.is_some_and(|ty| Mask.accepts(ty)) && self.wire_into(to).is_some_and(is_other)
    }

    /// Ties a second wire to an input that has one: both go through a blend, whose mode says how.
    pub fn merge(&mut self, from: &OutputRef, to: &SlotRef, how: MaskMerge) -> bool {
        let mode = match (how, self.wire_into(to).cloned()) {
            (MaskMerge::Blend(mode), Some(first)) => Some((mode, first)),
            _ => None,
        };
        let Some((mode, first)) = mode else {
            return self.connect(from, to);
        };
        if let Err(why) = self.fits(from, to) {
            return self.refuse(why);
        }
        let Some(reader) = self.node(&to.node) else {
            return false;
        };
        let pos = [reader.pos[0] - 2.0 * BESIDE - NODE_WIDTH, reader.pos[1]];
        let (id, mut node) = self.fresh("blend/mask", pos);
        node.inputs.insert("below".to_owned(), first);
        node.inputs.insert("above".to_owned(), self.shortest(from));
        node.params.insert("mode".to_owned(), Value::Text(mode.to_owned()));
        let blended = OutputRef {
            node: id.clone(),
            port: None,
        };
        let edits = vec![self.adding(&id, node), self.tie(&blended, to)];
        self.edit_and_select("Blend masks", edits, [id])
    }

    /// The edit that ties a loose wire to a node of the given face at its first port that fits; none where none does.
    pub(super) fn tie_loose(&self, loose: &PendingWire, id: &NodeId, face: &Entry) -> Option<Edit> {
        let own = self.node(id).map(|node| &node.inputs);
        let is_free = |port: &Port| own.is_none_or(|inputs| !inputs.contains_key(&port.name));
        match loose {
            PendingWire::From(from) => {
                self.face(&from.node)?.output(from.port.as_deref())?;
                let carried = self.carried(from);
                let exact = face.inputs.iter().find(|port| port.ty == carried && is_free(port));
                let input = exact.or_else(|| face.inputs.iter().find(|port| port.accepts(carried) && is_free(port)))?;
                let to = SlotRef {
                    node: id.clone(),
                    name: input.name.clone(),
                };
                Some(self.tie(from, &to))
            }
            PendingWire::Into(to) => {
                let output = face.output_for(self.input(to)?)?;
                Some(Edit::Connect {
                    body: self.body(),
                    node: to.node.clone(),
                    input: to.name.clone(),
                    from: OutputRef {
                        node: id.clone(),
                        port: port_in_wire(face, output),
                    },
                })
            }
        }
    }

    /// Whether a node is another one, or made from it.
    pub(super) fn is_made_from(&self, id: &NodeId, source: &NodeId) -> bool {
        let mut seen = BTreeSet::from([id.clone()]);
        let mut next = vec![id.clone()];
        while let Some(id) = next.pop() {
            if id == *source {
                return true;
            }
            next.extend(
                self.neighbors(&id, true)
                    .into_iter()
                    .filter(|id| seen.insert(id.clone())),
            );
        }
        false
    }

    /// Puts a bend into the wire that leads to an input, with its middle at a place.
    pub fn reroute(&mut self, to: &SlotRef, pos: [f32; 2]) -> bool {
        let Some(from) = self.wire_into(to).cloned() else {
            return false;
        };
        let corner = [pos[0] - BEND_SIZE[0] / 2.0, pos[1] - BEND_SIZE[1] / 2.0];
        let (id, mut node) = self.fresh(REROUTE_KIND, corner);
        node.inputs.insert("source".to_owned(), from);
        let bend = OutputRef {
            node: id.clone(),
            port: None,
        };
        let edits = vec![self.adding(&id, node), self.tie(&bend, to)];
        self.edit("Bend wire", edits)
    }

    /// Takes the selected nodes out of their wires, which heal behind them.
    pub fn take_out(&mut self) -> bool {
        let ids = self.selection.clone();
        let mut edits = self.healing(&ids);
        let fed = self.fed_by_group(|id| ids.contains(id));
        self.refeed(&mut edits, fed.into_iter().map(|(slot, _)| (slot, None)).collect());
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

    /// Swaps the first two inputs of the same type of each selected node: what they read, and the knobs that stand in for it.
    pub fn swap_inputs(&mut self) -> bool {
        let mut edits = Vec::new();
        let mut fed = Vec::new();
        for id in &self.selection {
            let Some((face, node)) = self.face(id).zip(self.node(id)) else {
                continue;
            };
            let slot = |port: &Port| SlotRef {
                node: id.clone(),
                name: port.name.clone(),
            };
            let mut pairs = face.inputs.iter().enumerate().flat_map(|(at, one)| {
                let rest = face.inputs[at + 1..].iter();
                rest.filter(|other| other.ty == one.ty).map(move |other| (one, other))
            });
            let feeder = |port: &Port| self.feeder(&self.seen, &slot(port)).map(str::to_owned);
            let is_tied = |port: &Port| node.inputs.contains_key(&port.name) || feeder(port).is_some();
            let Some((one, other)) = pairs.find(|(one, other)| is_tied(one) || is_tied(other)) else {
                continue;
            };
            for (to, from) in [(one, other), (other, one)] {
                fed.push((slot(to), feeder(from)));
                edits.push(match node.inputs.get(&from.name) {
                    Some(from) => self.tie(from, &slot(to)),
                    None => self.untie(&slot(to)),
                });
                if [to, from]
                    .iter()
                    .all(|port| face.knob(&port.name).is_some_and(|knob| knob.is_of_input))
                {
                    edits.push(Edit::SetParam {
                        body: self.body(),
                        node: id.clone(),
                        param: to.name.clone(),
                        value: node.params.get(&from.name).cloned(),
                    });
                }
            }
        }
        self.refeed(&mut edits, fed);
        self.edit("Swap inputs", edits)
    }
}

/// How a wire names an output of a node: not at all where it is the first one of a kind.
pub(super) fn port_in_wire(face: &Entry, port: &Port) -> Option<String> {
    let is_first = face.outputs.first().is_some_and(|first| first.name == port.name);
    (!is_first || face.id == GROUP_KIND).then(|| port.name.clone())
}
