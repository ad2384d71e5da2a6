//! The graph that is worked on and what is done to it: selection, the group one is in, and every edit as a named step. No
//! window is needed for any of it.

mod arrange;
mod clipboard;
mod frames;
mod groups;
mod layered;
mod names;
mod nodes;
mod selecting;
#[cfg(test)]
mod tests;
mod wires;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use sabi_engine::catalog::{Catalog, Entry, Faces};
use sabi_engine::{Kinds, Session};
use sabi_graph::{Body, Document, Edit, Graph, Node, NodeId, OutputRef, SlotRef};

pub(crate) use arrange::Align;
pub(crate) use wires::Merge;

/// What a wire that is being dragged is tied to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loose {
    /// It comes from an output and looks for an input.
    From(OutputRef),
    /// It leads into an input and looks for an output.
    Into(SlotRef),
}

/// The graph that is worked on.
pub(crate) struct Desk {
    pub(crate) session: Session,
    kinds: Arc<Kinds>,
    /// Rises when node files were read again.
    kinds_revision: u64,
    catalog: Arc<Catalog>,
    /// What nodes show, of a revision of the document and of the kinds.
    faces: (Option<(u64, u64)>, Faces),
    /// Instances that were entered, outermost first.
    inside: Vec<NodeId>,
    selection: BTreeSet<NodeId>,
    names: names::Names,
    /// Sentences that the artist has not seen yet.
    notices: Vec<String>,
}

impl Desk {
    /// A desk with this session on it.
    pub(crate) fn new(session: Session) -> Desk {
        Desk::with_names(session, names::Names::random())
    }

    fn with_names(session: Session, names: names::Names) -> Desk {
        let kinds = Arc::new(Kinds::beside(session.file()));
        let catalog = Arc::new(Catalog::new(&kinds));
        let mut desk = Desk {
            session,
            catalog,
            kinds,
            kinds_revision: 0,
            faces: (None, Faces::default()),
            inside: Vec::new(),
            selection: BTreeSet::new(),
            names,
            notices: Vec::new(),
        };
        desk.refresh();
        desk
    }

    /// Takes other node kinds, since their files changed.
    pub(crate) fn take_kinds(&mut self, kinds: Kinds) {
        self.catalog = Arc::new(Catalog::new(&kinds));
        self.kinds = Arc::new(kinds);
        self.kinds_revision += 1;
        self.refresh();
    }

    pub(crate) fn kinds(&self) -> (&Arc<Kinds>, u64) {
        (&self.kinds, self.kinds_revision)
    }

    pub(crate) fn catalog(&self) -> &Arc<Catalog> {
        &self.catalog
    }

    pub(crate) fn document(&self) -> &Document {
        self.session.document()
    }

    /// The graph that is seen: the main one, or the group that was entered.
    pub(crate) fn body(&self) -> Body {
        self.bodies().pop().unwrap_or_default()
    }

    /// The main graph and the groups that were entered, one for each step.
    fn bodies(&self) -> Vec<Body> {
        let mut bodies = vec![Body::Main];
        for id in &self.inside {
            let graph = self.graph_of(&bodies[bodies.len() - 1]);
            let group = graph.and_then(|graph| graph.node(id.as_str())?.group.clone());
            match group.filter(|name| self.document().groups.contains_key(name)) {
                Some(name) => bodies.push(Body::Group(name)),
                None => break,
            }
        }
        bodies
    }

    fn graph_of(&self, body: &Body) -> Option<&Graph> {
        self.document().body(body).ok()
    }

    /// The nodes that are seen.
    pub(crate) fn graph(&self) -> &Graph {
        // The body is one that is there.
        self.graph_of(&self.body()).unwrap_or(&self.document().graph)
    }

    pub(crate) fn node(&self, id: &NodeId) -> Option<&Node> {
        self.graph().node(id.as_str())
    }

    /// What a node that is seen shows.
    pub(crate) fn face(&self, id: &NodeId) -> Option<&Arc<Entry>> {
        self.faces.1.of(&self.body(), id.as_str())
    }

    pub(crate) fn faces(&self) -> &Faces {
        &self.faces.1
    }

    /// What a node is called: the artist's name for it, or its kind's.
    pub(crate) fn title(&self, id: &NodeId) -> String {
        let own = self.node(id).and_then(|node| node.label.clone());
        own.or_else(|| self.face(id).map(|face| face.label.clone()))
            .unwrap_or_else(|| id.to_string())
    }

    /// The name by which the evaluation knows a node that is seen: the instances it is in, then its own id.
    pub(crate) fn full_id(&self, id: &NodeId) -> String {
        let steps = self.bodies().len() - 1;
        let path = self.inside.iter().take(steps).chain([id]).map(NodeId::as_str);
        path.collect::<Vec<_>>().join("/")
    }

    /// Makes an edit as a step of that name; says so where it is refused.
    pub(crate) fn edit(&mut self, step: &str, edits: Vec<Edit>) -> bool {
        if edits.is_empty() {
            return false;
        }
        let edit = match <[Edit; 1]>::try_from(edits) {
            Ok([one]) => one,
            Err(several) => Edit::Batch(several),
        };
        let made = self.session.edit(step, edit);
        if let Err(error) = &made {
            self.say(error.to_string());
        }
        self.refresh();
        made.is_ok()
    }

    /// Takes the last step back.
    pub(crate) fn undo(&mut self) {
        let undone = self.session.undo();
        self.tell(undone.map(|step| step.map(|name| format!("Undone: {name}"))));
    }

    /// Does the last step again that was undone.
    pub(crate) fn redo(&mut self) {
        let redone = self.session.redo();
        self.tell(redone.map(|step| step.map(|name| format!("Done again: {name}"))));
    }

    fn tell(&mut self, told: Result<Option<String>, sabi_graph::EditError>) {
        match told {
            Ok(sentence) => self.notices.extend(sentence),
            Err(error) => self.say(error.to_string()),
        }
        self.refresh();
    }

    /// Keeps a sentence for the artist.
    pub(crate) fn say(&mut self, sentence: impl Into<String>) {
        self.notices.push(sentence.into());
    }

    /// Sentences since the last call.
    pub(crate) fn take_notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    /// Brings what follows from the document up to date.
    fn refresh(&mut self) {
        let now = (self.session.revision(), self.kinds_revision);
        if self.faces.0 == Some(now) {
            return;
        }
        let folder = self.session.graph().folder().to_owned();
        let mut read = |name: &str| read_group(&folder, name);
        let faces = Faces::new(&self.catalog, self.document(), &mut read);
        self.faces = (Some(now), faces);
        // What is gone is neither entered nor selected.
        let depth = self.bodies().len() - 1;
        self.inside.truncate(depth);
        let gone: Vec<NodeId> = self
            .selection
            .iter()
            .filter(|id| self.node(id).is_none())
            .cloned()
            .collect();
        for id in gone {
            self.selection.remove(&id);
        }
    }
}

/// A graph file that is used as a group.
fn read_group(folder: &Path, name: &str) -> Option<Document> {
    // What is wrong with it, the evaluation says.
    sabi_engine::OpenGraph::open(&folder.join(name))
        .ok()
        .map(|open| open.document)
}
