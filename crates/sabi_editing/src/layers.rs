//! Layers of a stack moved, added and removed: the chain is wired anew, and everything else stays.

use std::collections::BTreeSet;
use std::sync::Arc;

use sabi_engine::catalog::Entry;
use sabi_graph::{Edit, NodeId, OutputRef, PortType, SlotRef};

use super::arrangement::NODE_WIDTH;
use super::stack::{Link, main_input};
use super::wires::port_in_wire;
use super::{Layer, OpenDocument, Stack, StackEnd};

/// Between a layer that is added and the node that reads it, canvas points.
const BESIDE: f32 = 60.0;

impl OpenDocument {
    fn stack_behind(&mut self, end: &StackEnd) -> Option<Stack> {
        let found = self.stacks().into_iter().find(|stack| stack.end == *end);
        if found.is_none() {
            self.say("the output of this stack is gone");
        }
        found
    }

    /// Moves a layer of a stack to another place, counted from the top.
    pub fn move_layer(&mut self, end: &StackEnd, from: usize, to: usize) -> bool {
        let Some(stack) = self.stack_behind(end) else {
            return false;
        };
        if from.max(to) >= stack.layers.len() {
            return self.refuse("there is no such layer");
        }
        if from == to {
            return true;
        }
        if let Some(why) = self.why_not_move(&stack, from.min(to), from.max(to)) {
            return self.refuse(why);
        }
        let edits = self.reordered(&stack, from, to);
        self.edit("Move layer", edits)
    }

    /// Why the layers from `top` down to `bottom` cannot change places.
    fn why_not_move(&self, stack: &Stack, top: usize, bottom: usize) -> Option<String> {
        let layers = &stack.layers[top..=bottom];
        let held = layers
            .iter()
            .find_map(|layer| layer.shared.clone().or_else(|| layer.is_lowest.clone()));
        if held.is_some() {
            return held;
        }
        let links = &stack.links[top..=bottom + 1];
        if links.iter().any(|link| link.is_shared) {
            return Some(
                "a bend between these layers is also read by others, which would change too; use the canvas".to_owned(),
            );
        }
        let needs_one = |layer: &Layer| {
            let port = self.face(&layer.node).and_then(|face| main_input(face));
            port.is_some_and(|port| port.is_required)
        };
        let is_open = stack.links[bottom + 1].from.is_none();
        let needy = layers.iter().find(|layer| is_open && needs_one(layer))?;
        Some(format!("'{}' needs a material below it", needy.title))
    }

    /// The edits that bring a layer to its new place.
    fn reordered(&self, stack: &Stack, from: usize, to: usize) -> Vec<Edit> {
        let (top, bottom) = (from.min(to), from.max(to));
        let mut order: Vec<usize> = (top..=bottom).filter(|at| *at != from).collect();
        order.insert(to - top, from);
        // Each reads what comes next; the last what lay below them all.
        let readers = std::iter::once(top).chain(order.iter().map(|at| at + 1));
        let sources = order.iter().copied().chain([bottom + 1]);
        let (mut off, mut on) = (Vec::new(), Vec::new());
        for (reader, source) in readers.zip(sources) {
            let (reader, source) = (&stack.links[reader], &stack.links[source]);
            if reader.from == source.from {
                continue;
            }
            // All come off first: on the way from one order to the other wires could lead in a circle.
            off.extend(reader.slot.as_ref().map(|slot| self.untie(slot)));
            on.extend(self.led_to(&stack.end, reader.slot.as_ref(), source.from.as_ref()));
        }
        off.into_iter().chain(on).collect()
    }

    /// The edit that has an input, or the output that a stack ends in, read a result.
    fn led_to(&self, end: &StackEnd, slot: Option<&SlotRef>, from: Option<&OutputRef>) -> Option<Edit> {
        match (slot, end) {
            (Some(slot), _) => Some(self.tie(from?, slot)),
            (None, StackEnd::Port(name)) => Some(Edit::SetOutput {
                body: self.body(),
                name: name.clone(),
                output: Some(from?.clone()),
            }),
            (None, StackEnd::Node(_)) => None,
        }
    }

    /// Removes a layer; what reads it reads what muting it would give.
    pub fn remove_layer(&mut self, end: &StackEnd, at: usize) -> bool {
        let Some(stack) = self.stack_behind(end) else {
            return false;
        };
        let Some(layer) = stack.layers.get(at) else {
            return self.refuse("there is no such layer");
        };
        if let Some(why) = &layer.shared {
            return self.refuse(why.clone());
        }
        let mut edits = self.healing(&BTreeSet::from([layer.node.clone()]));
        edits.push(Edit::RemoveNode {
            body: self.body(),
            id: layer.node.clone(),
        });
        self.edit("Remove layer", edits)
    }

    /// The kinds that a layer can be: those that change the material below them, or, where there is none, all that give one.
    pub fn layer_kinds(&self, is_lowest: bool) -> Vec<Arc<Entry>> {
        let gives = |entry: &Entry| entry.outputs.iter().any(|port| port.ty == Some(PortType::Material));
        let entries = self.catalog.entries();
        let fit = entries.filter(|entry| gives(entry) && (is_lowest || main_input(entry).is_some()));
        fit.cloned().collect()
    }

    /// Adds a node of a kind above a layer, or, past the last one, at the bottom where nothing is.
    pub fn add_layer(&mut self, end: &StackEnd, at: usize, kind: &str) -> Option<NodeId> {
        let stack = self.stack_behind(end)?;
        let Some(entry) = self.catalog.entry(kind).cloned() else {
            self.say(format!("there is no node kind '{kind}'"));
            return None;
        };
        let output = entry.outputs.iter().find(|port| port.ty == Some(PortType::Material));
        let link = stack.links.get(at).filter(|link| link.slot.is_some() || at == 0);
        let (output, link) = match (output, link) {
            (None, _) => {
                self.say(format!("'{}' gives no material", entry.label));
                return None;
            }
            (_, None) => {
                self.say("nothing can lie below the material at the bottom");
                return None;
            }
            (Some(output), Some(link)) => (output, link),
        };
        if let Some(why) = self.why_not_between(link, main_input(&entry).is_some(), &entry.label) {
            self.say(why);
            return None;
        }
        let pos = self.place_of_layer(link);
        let (id, mut node) = self.fresh(kind, pos);
        if let (Some(port), Some(from)) = (main_input(&entry), &link.from) {
            node.inputs.insert(port.name.clone(), self.shortest(from));
        }
        let given = OutputRef {
            node: id.clone(),
            port: port_in_wire(&entry, output),
        };
        let mut edits = vec![self.adding(&id, node)];
        edits.extend(self.led_to(end, link.slot.as_ref(), Some(&given)));
        let is_made = self.edit("Add layer", edits);
        is_made.then(|| {
            self.select([id.clone()]);
            id
        })
    }

    fn why_not_between(&self, link: &Link, takes_material: bool, label: &str) -> Option<String> {
        if link.is_shared {
            return Some("a bend there is also read by others, which would change too; use the canvas".to_owned());
        }
        if let Some(name) = link.slot.as_ref().and_then(|slot| self.feeder(&self.seen, slot)) {
            return Some(format!(
                "what comes in through the group's input '{name}' would go past the layer; use the canvas"
            ));
        }
        let hides = link.from.is_some() && !takes_material;
        hides.then(|| format!("'{label}' takes no material, and would hide all layers below it"))
    }

    /// Left of what reads it, or right of what it reads.
    fn place_of_layer(&self, link: &Link) -> [f32; 2] {
        let place = |id: &NodeId| self.node(id).map(|node| node.pos);
        let reader = link.slot.as_ref().and_then(|slot| place(&slot.node));
        let source = link.from.as_ref().and_then(|from| place(&from.node));
        let step = NODE_WIDTH + BESIDE;
        match (reader, source) {
            (Some(reader), Some(source)) => [0, 1].map(|axis| (reader[axis] + source[axis]) / 2.0),
            (Some([x, y]), None) => [x - step, y],
            (None, Some([x, y])) => [x + step, y],
            (None, None) => [0.0; 2],
        }
    }
}
