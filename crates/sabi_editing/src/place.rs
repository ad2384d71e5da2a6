//! Graph of a document that is shown, and the group instances that were entered to get there.

use sabi_graph::{Body, Document, NodeId};

/// Graph that is shown.
#[derive(Default)]
pub(crate) struct Place {
    /// Entered group instances, outermost first.
    instance_path: Vec<NodeId>,
    /// The graph of the innermost entered instance, or the main graph.
    shown: Body,
}

impl Place {
    /// Name of the shown graph.
    pub(crate) fn shown(&self) -> &Body {
        &self.shown
    }

    /// Entered group instances, outermost first.
    pub(crate) fn instance_path(&self) -> &[NodeId] {
        &self.instance_path
    }

    /// Returns the graphs of the entered instances that exist in a document, outermost first, without the main graph.
    pub(crate) fn entered_graphs(&self, document: &Document) -> Vec<Body> {
        let mut entered: Vec<Body> = Vec::new();
        for id in &self.instance_path {
            let graph = document.body(entered.last().unwrap_or(&Body::Main)).ok();
            let group = graph.and_then(|graph| graph.node(id.as_str())?.group.clone());
            let Some(name) = group.filter(|name| document.groups.contains_key(name)) else {
                break;
            };
            entered.push(Body::Group(name));
        }
        entered
    }

    /// Enters these nested group instances of a document, as far as they exist.
    pub(crate) fn enter(&mut self, document: &Document, instance_path: Vec<NodeId>) {
        self.instance_path = instance_path;
        self.shown = self.entered_graphs(document).pop().unwrap_or(Body::Main);
    }

    /// Follows a change of the document. If an entered instance does not exist any more, the innermost graph that still
    /// exists is shown. Returns whether instances were left.
    pub(crate) fn follow(&mut self, document: &Document) -> bool {
        let mut entered = self.entered_graphs(document);
        let has_left = entered.len() < self.instance_path.len();
        self.instance_path.truncate(entered.len());
        self.shown = entered.pop().unwrap_or(Body::Main);
        has_left
    }
}
