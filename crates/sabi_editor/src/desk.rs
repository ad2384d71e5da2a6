//! The graph that is worked on and what is done to it: selection, the group one is in, and every edit as a named step. No
//! window is needed for any of it.

mod arrange;
mod bringing;
mod broken;
mod clipboard;
mod copies;
mod frames;
mod group_files;
mod grouping;
mod groups;
mod healing;
mod heirs;
mod inserting;
mod instances;
mod layered;
mod layers;
mod layout;
mod library;
mod map_names;
mod measures;
mod names;
mod nodes;
mod panel;
mod paths;
mod ports;
mod replacing;
mod selecting;
mod stack;
#[cfg(test)]
mod tests;
mod texture_set;
mod turning;
mod ungrouping;
mod variants;
mod wires;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::catalog::{Catalog, Entry, Faces};
use sabi_engine::{EngineError, Kinds, Session};
use sabi_graph::{Body, Document, Edit, Graph, Node, NodeId, OutputRef, SlotRef};

pub(crate) use arrange::{
    Align, GRID, MARGIN, NODE_WIDTH, PICTURE_SIDE, ROW_HEIGHT, TITLE_HEIGHT, input_row, is_bend, output_row, own_knobs,
    size_of,
};
pub(crate) use library::ENDING;
pub(crate) use panel::PanelKnob;
pub(crate) use stack::{Layer, Stack, StackEnd};
pub(crate) use wires::Merge;

/// Around the nodes of a frame, canvas points.
pub(crate) const FRAME_AROUND: f32 = 20.0;
/// Height of the strip with a frame's title.
pub(crate) const FRAME_STRIP: f32 = 30.0;

/// What a wire that is being dragged is tied to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loose {
    /// It comes from an output and looks for an input.
    From(OutputRef),
    /// It leads into an input and looks for an output.
    Into(SlotRef),
}

/// A knob that something is to be put into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum KnobAt {
    /// One of a node that is seen.
    Node { node: NodeId, knob: String },
    /// One that is published, by its name.
    Panel(String),
}

impl KnobAt {
    pub(crate) fn of_node(node: &NodeId, knob: String) -> KnobAt {
        KnobAt::Node {
            node: node.clone(),
            knob,
        }
    }
}

/// The graph that is worked on.
pub(crate) struct Desk {
    pub(crate) session: Session,
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
        Desk::with_kinds(session, names, kinds, catalog)
    }

    fn with_kinds(session: Session, names: names::Names, kinds: Arc<Kinds>, catalog: Arc<Catalog>) -> Desk {
        // As the session's own, those of one desk are never those of another.
        let first = session.revision();
        let mut desk = Desk {
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
        desk.refresh();
        desk.opened = desk.faces().clone();
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

    /// Rises when files that the graph names were written anew; no other desk has the same.
    pub(crate) fn files_revision(&self) -> u64 {
        self.files_revision
    }

    pub(crate) fn catalog(&self) -> &Arc<Catalog> {
        &self.catalog
    }

    pub(crate) fn document(&self) -> &Document {
        self.session.document()
    }

    /// The graph that is seen: the main one, or the group that was entered.
    pub(crate) fn body(&self) -> Body {
        self.seen.clone()
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
        self.graph_of(&self.seen).unwrap_or(&self.document().graph)
    }

    pub(crate) fn node(&self, id: &NodeId) -> Option<&Node> {
        self.graph().node(id.as_str())
    }

    /// What a node that is seen shows.
    pub(crate) fn face(&self, id: &NodeId) -> Option<&Arc<Entry>> {
        self.faces.1.of(&self.seen, id.as_str())
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

    /// Makes an edit as [`Desk::edit`] does, and selects what came of it.
    fn edit_and_select(&mut self, step: &str, edits: Vec<Edit>, ids: impl IntoIterator<Item = NodeId>) -> bool {
        let is_made = self.edit(step, edits);
        if is_made {
            self.select(ids);
        }
        is_made
    }

    /// Makes an edit as a step of that name; says so where it is refused. Instances of a group follow what it publishes.
    pub(crate) fn edit(&mut self, step: &str, mut edits: Vec<Edit>) -> bool {
        if edits.is_empty() {
            return false;
        }
        edits.extend(self.emptied_frames(&edits));
        let edits = instances::followed(self.document(), edits);
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
    pub(crate) fn undo(&mut self) {
        let before = self.seen_ids();
        let undone = self.session.undo();
        self.tell(undone.map(|step| step.map(|name| format!("Undone: {name}"))), before);
    }

    /// Does the last step again that was undone. Nodes that come back are selected.
    pub(crate) fn redo(&mut self) {
        let before = self.seen_ids();
        let redone = self.session.redo();
        self.tell(
            redone.map(|step| step.map(|name| format!("Done again: {name}"))),
            before,
        );
    }

    /// Takes back what was done since a step began that is not ended yet, as if it had never begun.
    pub(crate) fn take_back(&mut self) {
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
    pub(crate) fn save(&mut self) -> Result<(), EngineError> {
        self.session.save()
    }

    /// Saves the graph to a file, which is its own from then on. In another folder, other node files lie beside it.
    pub(crate) fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        let folder = self.session.graph().folder().to_owned();
        self.session.save_as(path)?;
        if self.session.graph().folder() != folder {
            self.take_kinds(Kinds::beside(Some(path)));
        }
        self.refresh();
        Ok(())
    }

    /// Keeps a sentence for the artist.
    pub(crate) fn say(&mut self, sentence: impl Into<String>) {
        self.notices.push(sentence.into());
    }

    /// Says why something is not done.
    fn refuse(&mut self, sentence: impl Into<String>) -> bool {
        self.say(sentence);
        false
    }

    /// Sentences since the last call.
    pub(crate) fn take_notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    /// Looks again at group files and pictures, since some were saved by somebody else.
    pub(crate) fn files_changed(&mut self, files: &BTreeSet<PathBuf>) {
        self.session.graph().look_again(files);
        self.group_files.look_again(files);
        self.faces.0 = None;
        self.files_revision += 1;
        self.refresh();
    }

    /// Takes what the graph's file holds by now, as a step.
    pub(crate) fn read_again(&mut self) -> Result<(), EngineError> {
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
        let folder = self.session.graph().folder().to_owned();
        let files = &mut self.group_files;
        let mut read = |name: &str| files.read(&folder.join(name));
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
