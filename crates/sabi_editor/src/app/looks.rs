//! Which results are looked at: in the 2D view, on the model, and beside it for comparison.

use sabi_engine::ViewSubject;
use sabi_graph::{NodeId, NodeRef};

use super::Editor;
use crate::action::LookAsk;
use crate::model_view::Showing;

impl Editor {
    /// What the model shows: the locked node, or else the one that it follows, or else the outputs.
    pub(super) fn seen(&self) -> ViewSubject {
        // While two are compared, the locked one has its own side.
        let locked = self.locked.as_ref().filter(|_| self.model_view.wipe.is_none());
        // A node has no color but its own to give to its own knob.
        let is_asking = |node: &&NodeRef| self.takes_color_for(&node.node);
        let followed = self
            .followed
            .as_ref()
            .filter(|node| self.settings.follows && !is_asking(node));
        locked
            .or(followed)
            .map_or(ViewSubject::Outputs, |node| ViewSubject::Node(node.clone()))
    }

    /// What the model is compared with.
    pub(super) fn locked_seen(&self) -> Option<ViewSubject> {
        let is_compared = self.model_view.wipe.is_some();
        self.locked.clone().filter(|_| is_compared).map(ViewSubject::Node)
    }

    /// What the 2D view shows.
    pub(super) fn inspected(&self) -> Option<&NodeRef> {
        self.pinned.as_ref().or(self.shown.as_ref())
    }

    /// What the model shows, in words.
    pub(super) fn showing(&self) -> Showing {
        let name = |node: &Option<NodeRef>| node.as_ref().map(|node| self.title_of(node));
        let seen = self.seen();
        let words = |seen: &ViewSubject| match seen {
            ViewSubject::Outputs => "Outputs".to_owned(),
            ViewSubject::Node(node) if self.locked.as_ref() == Some(node) => format!("Locked: {}", self.title_of(node)),
            ViewSubject::Node(node) => format!("Follows: {}", self.title_of(node)),
        };
        let fault = match &seen {
            ViewSubject::Node(node) => self.stage.fault(&node.node).or(self.stage.waits(&node.node)).cloned(),
            ViewSubject::Outputs => self.fault_of_outputs().cloned(),
        };
        Showing {
            words: words(&seen),
            other: self.locked_seen().as_ref().map(words),
            fault,
            follows: self.settings.follows,
            clicked: name(&self.shown),
            locked: name(&self.locked),
        }
    }

    /// Why what the outputs show is not what they would show by now.
    fn fault_of_outputs(&self) -> Option<&String> {
        let stage = &self.stage;
        let outputs = self.document.contents().graph.nodes();
        let mut outputs = outputs.filter(|(_, node)| node.kind.starts_with("output/"));
        let of_model = stage.model_failure.as_ref().or(stage.failure.as_ref());
        of_model.or_else(|| outputs.find_map(|(id, _)| stage.fault(id.as_str()).or(stage.waits(id.as_str()))))
    }

    /// The name of a node that is looked at, with its output where it is not the first.
    pub(super) fn title_of(&self, node: &NodeRef) -> String {
        let title = self.document.title_at(&node.node);
        match &node.port {
            Some(port) => format!("{title} · {port}"),
            None => title,
        }
    }

    /// A node that is seen, as the evaluation knows it.
    pub(crate) fn reference(&self, id: &NodeId, port: Option<String>) -> NodeRef {
        let outputs = self.document.face(id).map_or(&[][..], |face| &face.outputs);
        let others = outputs.iter().skip(1).map(|port| &port.name);
        NodeRef {
            node: self.document.full_id(id),
            port: port.filter(|port| others.clone().any(|other| other == port)),
        }
    }

    /// The result of a node that was chosen last: its first one where none was.
    pub(super) fn chosen(&self, id: &NodeId) -> NodeRef {
        let port = self.ports.get(&self.document.full_id(id)).cloned();
        self.reference(id, port)
    }

    /// Looks at a node's result: at that of this output, or at the one that was chosen last.
    pub(crate) fn look_at(&mut self, id: &NodeId, port: Option<String>) {
        let reference = match port {
            Some(port) => self.reference(id, Some(port)),
            None => self.chosen(id),
        };
        match &reference.port {
            Some(port) => self.ports.insert(reference.node.clone(), port.clone()),
            None => self.ports.remove(&reference.node),
        };
        self.followed = Some(reference.clone());
        self.shown = Some(reference);
    }

    /// Selects these nodes; where it is none, the model shows the outputs again.
    pub(super) fn select(&mut self, ids: Vec<NodeId>) {
        if ids.is_empty() {
            self.followed = None;
        }
        self.document.select(ids);
    }

    /// Nothing of the graph is looked at any more, since it is another one.
    pub(super) fn look_at_nothing(&mut self) {
        [self.shown, self.followed, self.pinned, self.locked] = [const { None }; 4];
        self.ports.clear();
        self.panels.parameters.eyedropper = None;
        self.stage.forget_nodes();
    }

    /// Looks no longer at nodes that are gone.
    pub(super) fn look_away_from_gone(&mut self) {
        let document = &self.document;
        for looked_at in [&mut self.shown, &mut self.followed, &mut self.pinned, &mut self.locked] {
            looked_at.take_if(|node| !document.has(&node.node));
        }
        self.ports.retain(|node, _| document.has(node));
    }

    /// Looks at one node wherever another one was looked at.
    pub(super) fn look_on(&mut self, gone: &str, id: &NodeId) {
        let reference = self.reference(id, None);
        for looked_at in [&mut self.shown, &mut self.followed, &mut self.pinned, &mut self.locked] {
            if looked_at.as_ref().is_some_and(|node| node.node == gone) {
                *looked_at = Some(reference.clone());
            }
        }
    }

    /// Keeps a node's result in the 2D view, or lets it go where it is kept.
    pub(super) fn pin(&mut self, node: &NodeId) {
        let reference = Some(self.chosen(node));
        self.pinned = if self.pinned == reference { None } else { reference };
    }

    /// Does what is asked of what is shown where.
    pub(super) fn look(&mut self, asked: LookAsk) {
        let is_compared = self.model_view.wipe.is_some();
        match asked {
            LookAsk::Outputs | LookAsk::Follow => {
                self.settings.follows = asked == LookAsk::Follow;
                if !is_compared {
                    self.locked = None;
                }
            }
            LookAsk::Lock => self.locked = self.shown.clone(),
            LookAsk::Release => self.locked = None,
            LookAsk::Compare => {
                if !is_compared && self.locked.is_none() {
                    self.locked = self.shown.clone();
                }
                self.model_view.wipe = if is_compared { None } else { Some(0.5) };
            }
            LookAsk::Unpin => self.pinned = None,
        }
    }
}
