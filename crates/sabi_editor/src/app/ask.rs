//! What the evaluation is asked for, and what it shows where.

use egui::Context;
use sabi_engine::Seen;
use sabi_engine::view::Picked;
use sabi_graph::{NodeId, NodeRef, PortType};

use super::Editor;
use crate::dock::Panel;
use crate::stage::Wanted;

impl Editor {
    /// What the model shows: the outputs, or the node that is followed or locked.
    pub(super) fn seen(&self) -> Seen {
        let followed = self.shown.clone().filter(|_| self.follows);
        match (followed, &self.locked, self.model_view.wipe) {
            (Some(node), _, _) => Seen::Node(node),
            // While two are compared, the locked one has its own side.
            (None, Some(node), None) => Seen::Node(node.clone()),
            _ => Seen::Outputs,
        }
    }

    /// What the model is compared with.
    pub(super) fn locked_seen(&self) -> Option<Seen> {
        let is_compared = self.model_view.wipe.is_some();
        self.locked.clone().filter(|_| is_compared).map(Seen::Node)
    }

    /// The name of a node that is looked at, with its output where it is not the first.
    pub(super) fn title_of(&self, node: &NodeRef) -> String {
        let own = node.node.rsplit('/').next().unwrap_or(&node.node);
        let title = own
            .parse::<NodeId>()
            .map_or_else(|_| own.to_owned(), |id| self.desk.title(&id));
        match &node.port {
            Some(port) => format!("{title} · {port}"),
            None => title,
        }
    }

    /// A node that is seen, as the evaluation knows it.
    pub(crate) fn reference(&self, id: &NodeId, port: Option<String>) -> NodeRef {
        let first = self
            .desk
            .face(id)
            .and_then(|face| face.outputs.first())
            .map(|port| port.name.clone());
        NodeRef {
            node: self.desk.full_id(id),
            port: port.filter(|port| Some(port) != first.as_ref()),
        }
    }

    /// Looks at a node's result.
    pub(super) fn look_at(&mut self, id: &NodeId, port: Option<String>) {
        let reference = self.reference(id, port);
        match &reference.port {
            Some(port) => self.ports.insert(reference.node.clone(), port.clone()),
            None => self.ports.remove(&reference.node),
        };
        self.shown = Some(reference);
    }

    /// Asks the evaluation for what is seen now.
    pub(super) fn wish(&mut self, context: &Context) {
        let is_there = |node: &NodeRef| {
            let mut graph = &self.desk.document().graph;
            let mut steps = node.node.split('/').peekable();
            while let Some(step) = steps.next() {
                let Some(found) = graph.node(step) else { return false };
                if steps.peek().is_none() {
                    return true;
                }
                let group = found
                    .group
                    .as_ref()
                    .and_then(|name| self.desk.document().groups.get(name));
                let Some(group) = group else { return false };
                graph = &group.graph;
            }
            false
        };
        let gone = |node: &Option<NodeRef>| node.as_ref().is_some_and(|node| !is_there(node));
        let [shown, pinned, locked] = [gone(&self.shown), gone(&self.pinned), gone(&self.locked)];
        if shown {
            self.shown = None;
        }
        if pinned {
            self.pinned = None;
        }
        if locked {
            self.locked = None;
        }
        let mut seen = vec![self.seen()];
        seen.extend(self.locked_seen());
        let inspected = self.pinned.clone().or(self.shown.clone());
        let wanted = Wanted {
            seen,
            inspected,
            thumbnails: self.pictured(),
            is_flat: self.settings.is_flat,
            is_moving: self.is_moving,
        };
        self.stage.ask(&self.desk, wanted);
        // A drag that ends outside of the window ends here.
        if self.is_moving && !context.input(|input| input.pointer.any_down()) {
            self.desk.session.end();
            self.is_moving = false;
            context.request_repaint();
        }
    }

    /// The results that nodes and layers show, as far as they are seen.
    fn pictured(&self) -> Vec<NodeRef> {
        let is_seen = |panel: Panel| self.rects.contains_key(&panel);
        let nodes = self.canvas.visible(&self.desk).into_iter().map(|id| {
            let node = self.desk.full_id(&id);
            NodeRef {
                port: self.ports.get(&node).cloned(),
                node,
            }
        });
        let nodes = nodes.filter(|_| is_seen(Panel::Canvas));
        let layers = self.panels.stack.wanted.iter().cloned();
        nodes.chain(layers.filter(|_| is_seen(Panel::Stack))).collect()
    }

    /// The surface of the model was clicked: where a color is wanted, it is taken.
    pub(super) fn take_picked(&mut self, picked: &Picked) {
        let Some(knob) = self.panels.parameters.eyedropper.take() else {
            return;
        };
        let Some((_, values)) = self.stage.inspected.as_ref() else {
            self.say("There is no texture to take a color from; click the node whose color is wanted first.");
            return;
        };
        let color = matches!(values.ty, PortType::Color | PortType::Material);
        let plane = values.planes.first().filter(|plane| color && plane.components >= 3);
        let Some(plane) = plane else {
            self.say(
                "The texture in the 2D view has no color; click a node that gives one, then take it from the model.",
            );
            return;
        };
        let [x, y] = picked.map_texel.map(|at| at.rem_euclid(values.size as f32) as usize);
        let texel = (y * values.size as usize + x) * plane.components;
        let code = |at: usize| egui::ecolor::gamma_u8_from_linear_f32(plane.values[texel + at].clamp(0.0, 1.0));
        let text = format!("#{:02x}{:02x}{:02x}", code(0), code(1), code(2));
        self.desk.set_at(&knob, sabi_graph::Value::Text(text));
    }

    /// How many problems there are.
    pub(super) fn problem_count(&self) -> usize {
        let stage = &self.stage;
        let failures = usize::from(stage.failure.is_some()) + usize::from(stage.model_failure.is_some());
        let of_kinds = self.desk.kinds().0.faults.len();
        stage.faults.faults.len() + stage.faults.other.len() + of_kinds + failures
    }
}
