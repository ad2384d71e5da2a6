//! The open document as an artist edits it: selection, the entered group, the clipboard, history, and every edit as a named
//! undo step. Needs no window and is tested without one.

mod arrangement;
mod clipboard;
mod document_settings;
mod duplication;
mod evaluability;
mod frames;
mod group_files;
mod group_import;
mod group_instances;
mod group_ports;
mod grouping;
mod groups;
mod layered_drawing;
mod layers;
mod layout;
mod library;
mod new_ids;
mod node_paths;
mod node_replacement;
mod nodes;
mod panel;
mod panel_values;
mod reconnection;
mod references;
mod relative_paths;
mod selection;
mod stack;
#[cfg(test)]
mod tests;
mod texture_map_names;
mod texture_sets;
mod ungrouping;
mod variants;
mod wire_insertion;
mod wires;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::catalog::{Catalog, Entry, Faces};
use sabi_engine::{EngineError, Kinds, Session};
use sabi_graph::{Body, Document, Edit, Graph, Node, NodeId, OutputRef, SlotRef};

pub use arrangement::{
    Align, GRID, MARGIN, NODE_WIDTH, PICTURE_SIDE, ROW_HEIGHT, TITLE_HEIGHT, input_row, is_bend, output_row, own_knobs,
    size_of,
};
pub use library::GRAPH_EXTENSION;
pub use panel::PanelKnob;
pub use stack::{Layer, Stack, StackEnd};
pub use wires::MaskMerge;

/// Space between a frame's border and its nodes, canvas points.
pub const FRAME_AROUND: f32 = 20.0;
/// Height of a frame's title bar, canvas points.
pub const FRAME_STRIP: f32 = 30.0;

/// Connected end of a wire that is being dragged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PendingWire {
    /// An output; the wire is dropped on an input.
    From(OutputRef),
    /// An input; the wire is dropped on an output.
    Into(SlotRef),
}

/// Knob that receives a value from elsewhere, such as a file dialog or an eyedropper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KnobTarget {
    /// A knob of a node in the shown graph.
    Node {
        /// Node that has the knob.
        node: NodeId,
        /// Name of the knob.
        knob: String,
    },
    /// A published knob, by its name.
    Panel(String),
}

impl KnobTarget {
    /// A knob of a node in the shown graph.
    pub fn of_node(node: &NodeId, knob: String) -> KnobTarget {
        KnobTarget::Node {
            node: node.clone(),
            knob,
        }
    }
}

/// Document that is open in the editor, with everything that belongs to editing it but is not saved with it.
pub struct OpenDocument {
    /// The document with its file, undo history and recovery file.
    pub session: Session,
    kinds: Arc<Kinds>,
    /// Rises when node files were read again.
    kinds_revision: u64,
    catalog: Arc<Catalog>,
    /// Rises when pictures or group files were written anew.
    files_revision: u64,
    /// What nodes show, of a revision of the document and of the kinds.
    faces: (Option<(u64, u64)>, Faces),
    /// What they showed when the graph was opened.
    opened: Faces,
    group_files: group_files::GroupFiles,
    /// Instances that were entered, outermost first.
    inside: Vec<NodeId>,
    /// The graph that they lead to.
    seen: Body,
    selection: BTreeSet<NodeId>,
    names: new_ids::IdGenerator,
    /// Sentences that the artist has not seen yet.
    notices: Vec<String>,
}

impl OpenDocument {
    /// Opens the document of a session, with the node kinds beside its file.
    pub fn new(session: Session) -> OpenDocument {
        OpenDocument::with_names(session, new_ids::IdGenerator::random())
    }

    fn with_names(session: Session, names: new_ids::IdGenerator) -> OpenDocument {
        let kinds = Arc::new(Kinds::beside(session.file()));
        let catalog = Arc::new(Catalog::new(&kinds));
        OpenDocument::with_kinds(session, names, kinds, catalog)
    }

    fn with_kinds(
        session: Session,
        names: new_ids::IdGenerator,
        kinds: Arc<Kinds>,
        catalog: Arc<Catalog>,
    ) -> OpenDocument {
        // As the session's own, those of one document are never those of another.
        let first = session.revision();
        let mut document = OpenDocument {
            session,
            catalog,
            kinds,
            kinds_revision: first,
            files_revision: first,
            faces: (None, Faces::default()),
            opened: Faces::default(),
            group_files: group_files::GroupFiles::default(),
            inside: Vec::new(),
            seen: Body::Main,
            selection: BTreeSet::new(),
            names,
            notices: Vec::new(),
        };
        document.refresh();
        document.opened = document.faces().clone();
        document
    }

    /// Replaces the node kinds after their files changed.
    pub fn take_kinds(&mut self, kinds: Kinds) {
        self.catalog = Arc::new(Catalog::new(&kinds));
        self.kinds = Arc::new(kinds);
        self.kinds_revision += 1;
        self.refresh();
    }

    /// Node kinds, and a number that rises each time they are read again.
    pub fn kinds(&self) -> (&Arc<Kinds>, u64) {
        (&self.kinds, self.kinds_revision)
    }

    /// Number that rises each time a file that the graph names was written; no other open document has the same.
    pub fn files_revision(&self) -> u64 {
        self.files_revision
    }

    /// Descriptions of all node kinds.
    pub fn catalog(&self) -> &Arc<Catalog> {
        &self.catalog
    }

    /// Contents of the document, as its file holds them after a save.
    pub fn contents(&self) -> &Document {
        self.session.document()
    }

    /// The graph that is seen: the main one, or the group that was entered.
    pub fn body(&self) -> Body {
        self.seen.clone()
    }

    /// The main graph and the groups that were entered, one for each step.
    fn bodies(&self) -> Vec<Body> {
        let mut bodies = vec![Body::Main];
        for id in &self.inside {
            let graph = self.graph_of(&bodies[bodies.len() - 1]);
            let group = graph.and_then(|graph| graph.node(id.as_str())?.group.clone());
            match group.filter(|name| self.contents().groups.contains_key(name)) {
                Some(name) => bodies.push(Body::Group(name)),
                None => break,
            }
        }
        bodies
    }

    fn graph_of(&self, body: &Body) -> Option<&Graph> {
        self.contents().body(body).ok()
    }

    /// The nodes that are seen.
    pub fn graph(&self) -> &Graph {
        // The body is one that is there.
        self.graph_of(&self.seen).unwrap_or(&self.contents().graph)
    }

    /// A node of the shown graph.
    pub fn node(&self, id: &NodeId) -> Option<&Node> {
        self.graph().node(id.as_str())
    }

    /// What a node that is seen shows.
    pub fn face(&self, id: &NodeId) -> Option<&Arc<Entry>> {
        self.faces.1.of(&self.seen, id.as_str())
    }

    /// Ports and knobs that the nodes of all graphs of the document show.
    pub fn faces(&self) -> &Faces {
        &self.faces.1
    }

    /// What a node is called: the artist's name for it, or its kind's.
    pub fn title(&self, id: &NodeId) -> String {
        let own = self.node(id).and_then(|node| node.label.clone());
        own.or_else(|| self.face(id).map(|face| face.label.clone()))
            .unwrap_or_else(|| id.to_string())
    }

    /// The name by which the evaluation knows a node that is seen: the instances it is in, then its own id.
    pub fn full_id(&self, id: &NodeId) -> String {
        let steps = self.bodies().len() - 1;
        let path = self.inside.iter().take(steps).chain([id]).map(NodeId::as_str);
        path.collect::<Vec<_>>().join("/")
    }

    /// Makes an edit as [`OpenDocument::edit`] does, and selects what came of it.
    fn edit_and_select(&mut self, step: &str, edits: Vec<Edit>, ids: impl IntoIterator<Item = NodeId>) -> bool {
        let is_made = self.edit(step, edits);
        if is_made {
            self.select(ids);
        }
        is_made
    }

    /// Makes an edit as a step of that name; says so where it is refused. Instances of a group follow what it publishes.
    pub fn edit(&mut self, step: &str, mut edits: Vec<Edit>) -> bool {
        if edits.is_empty() {
            return false;
        }
        edits.extend(self.emptied_frames(&edits));
        let edits = group_instances::followed(self.contents(), edits);
        if let Some(why) = self.why_nothing_would_be_left(&edits) {
            return self.refuse(why);
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

    /// Takes the last step back. Nodes that come back are selected.
    pub fn undo(&mut self) {
        let before = self.seen_ids();
        let undone = self.session.undo();
        self.tell(undone.map(|step| step.map(|name| format!("Undone: {name}"))), before);
    }

    /// Does the last step again that was undone. Nodes that come back are selected.
    pub fn redo(&mut self) {
        let before = self.seen_ids();
        let redone = self.session.redo();
        self.tell(
            redone.map(|step| step.map(|name| format!("Done again: {name}"))),
            before,
        );
    }

    /// Takes back what was done since a step began that is not ended yet, as if it had never begun.
    pub fn take_back(&mut self) {
        if let Err(error) = self.session.cancel() {
            self.say(error.to_string());
        }
        self.refresh();
    }

    fn seen_ids(&self) -> (usize, BTreeSet<NodeId>) {
        (self.inside.len(), self.graph().ids().cloned().collect())
    }

    fn tell(&mut self, told: Result<Option<String>, sabi_graph::EditError>, before: (usize, BTreeSet<NodeId>)) {
        match told {
            Ok(sentence) => self.notices.extend(sentence),
            Err(error) => self.say(error.to_string()),
        }
        self.refresh();
        let (depth, ids) = before;
        let came: Vec<NodeId> = self.graph().ids().filter(|id| !ids.contains(*id)).cloned().collect();
        if depth == self.inside.len() && !came.is_empty() {
            self.select(came);
        }
    }

    /// Saves the graph to its file.
    pub fn save(&mut self) -> Result<(), EngineError> {
        self.session.save()
    }

    /// Saves the graph to a file, which is its own from then on. In another folder, other node files lie beside it.
    pub fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        let folder = self.session.graph().folder().to_owned();
        self.session.save_as(path)?;
        if self.session.graph().folder() != folder {
            self.take_kinds(Kinds::beside(Some(path)));
        }
        self.refresh();
        Ok(())
    }

    /// Keeps a sentence for the artist.
    pub fn say(&mut self, sentence: impl Into<String>) {
        self.notices.push(sentence.into());
    }

    /// Says why something is not done.
    fn refuse(&mut self, sentence: impl Into<String>) -> bool {
        self.say(sentence);
        false
    }

    /// Sentences since the last call.
    pub fn take_notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    /// Looks again at group files and pictures, since some were saved by somebody else.
    pub fn files_changed(&mut self, files: &BTreeSet<PathBuf>) {
        self.session.graph().look_again(files);
        self.group_files.look_again(files);
        self.faces.0 = None;
        self.files_revision += 1;
        self.refresh();
    }

    /// Takes what the graph's file holds by now, as a step.
    pub fn read_again(&mut self) -> Result<(), EngineError> {
        let read = self.session.read_again();
        self.refresh();
        read
    }

    /// Brings what follows from the document up to date.
    fn refresh(&mut self) {
        let now = (self.session.revision(), self.kinds_revision);
        if self.faces.0 == Some(now) {
            return;
        }
        let base = self.session.graph().base();
        let files = &mut self.group_files;
        let mut read = |name: &str| files.read(&base.resolve(name));
        let faces = Faces::new(&self.catalog, self.session.document(), &mut read);
        self.faces = (Some(now), faces);
        let depth = self.bodies().len() - 1;
        if depth < self.inside.len() {
            // What was selected is in a graph that is not seen any more.
            self.inside.truncate(depth);
            self.selection.clear();
        }
        self.look();
        self.forget_what_is_gone();
    }

    /// Turns to the graph that the entered instances lead to.
    fn look(&mut self) {
        self.seen = self.bodies().pop().unwrap_or_default();
    }
}
