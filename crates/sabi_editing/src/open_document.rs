//! The open document: the state that every edit needs. All edits are applied here.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::catalog::{Catalog, Interface, Interfaces};
use sabi_engine::{EngineError, Kinds, Session};
use sabi_files::PathBase;
use sabi_graph::{Body, Document, Edit, Graph, Node, NodeId};

use crate::current_interfaces::CurrentInterfaces;
use crate::document_trust::Trust;
use crate::group_files::GroupFiles;
use crate::instances::interface_of;
use crate::library_folder::LibraryFolder;
use crate::new_ids::IdGenerator;
use crate::node_kinds::NodeKinds;
use crate::place::Place;
use crate::{evaluability, follow_up};

/// Document that is open in the editor, with the state of editing that is not saved with it.
///
/// The edits themselves are functions of the other modules that take `&mut OpenDocument`.
pub struct OpenDocument {
    /// The document with its file, undo history and recovery file.
    pub session: Session,
    node_kinds: NodeKinds,
    files_revision: u64,
    interfaces: CurrentInterfaces,
    /// Ports and knobs of the nodes when the document was opened.
    pub(crate) opened: Interfaces,
    group_files: GroupFiles,
    place: Place,
    selection: BTreeSet<NodeId>,
    pub(crate) ids: IdGenerator,
    notices: Vec<String>,
    /// Folders of libraries. Links of groups refer to libraries by name.
    pub library_folders: Vec<LibraryFolder>,
    pub(crate) trust: Trust,
}

impl OpenDocument {
    /// Opens the document of a session, with the node kinds beside its file.
    pub fn new(session: Session) -> OpenDocument {
        let kinds = Kinds::beside(session.file(), &session.graph().trusted);
        OpenDocument::with_kinds(session, IdGenerator::random(), NodeKinds::new(kinds, 0))
    }

    /// Opens the document of a session with the built-in node kinds only. The kinds of its folders are read later.
    pub fn before_kinds(session: Session) -> OpenDocument {
        OpenDocument::with_kinds(session, IdGenerator::random(), NodeKinds::new(Kinds::builtin(), 0))
    }

    pub(crate) fn with_kinds(session: Session, ids: IdGenerator, node_kinds: NodeKinds) -> OpenDocument {
        // Revisions of a session are unique in the process, so numbers that continue from its first revision are, too.
        let first = session.revision();
        let mut document = OpenDocument {
            session,
            node_kinds: NodeKinds {
                revision: first,
                ..node_kinds
            },
            files_revision: first,
            interfaces: CurrentInterfaces::default(),
            opened: Interfaces::default(),
            group_files: GroupFiles::default(),
            place: Place::default(),
            selection: BTreeSet::new(),
            ids,
            notices: Vec::new(),
            library_folders: Vec::new(),
            trust: Trust::default(),
        };
        document.refresh();
        document.opened = document.interfaces().clone();
        document
    }

    /// Sets the node kinds of the document's folders for the first time since the document was opened.
    pub fn first_kinds(&mut self, kinds: Kinds) {
        self.replace_kinds(kinds);
        self.opened = self.interfaces().clone();
    }

    /// Replaces the node kinds after their files changed.
    pub fn replace_kinds(&mut self, kinds: Kinds) {
        self.node_kinds = NodeKinds::new(kinds, self.node_kinds.revision + 1);
        self.refresh();
    }

    /// The node kinds.
    pub fn node_kinds(&self) -> &NodeKinds {
        &self.node_kinds
    }

    /// Descriptions of all node kinds.
    pub fn catalog(&self) -> &Catalog {
        &self.node_kinds.catalog
    }

    /// Returns a number that increases each time a file that the graph refers to was written. The numbers of different open
    /// documents are always different.
    pub fn files_revision(&self) -> u64 {
        self.files_revision
    }

    /// Returns the contents of the document, as they would be saved.
    pub fn contents(&self) -> &Document {
        self.session.document()
    }

    /// Name of the shown graph within the document: the main graph, or the group that was entered.
    pub fn shown(&self) -> &Body {
        self.place.shown()
    }

    /// Copy of [`OpenDocument::shown`], which edits take by value.
    pub fn body(&self) -> Body {
        self.shown().clone()
    }

    /// The shown graph.
    pub fn graph(&self) -> &Graph {
        // `shown` always names an existing graph: `refresh` leaves groups that were removed.
        self.graph_of(self.shown()).unwrap_or(&self.contents().graph)
    }

    pub(crate) fn graph_of(&self, body: &Body) -> Option<&Graph> {
        self.contents().body(body).ok()
    }

    /// The shown graph and the entered instances.
    pub(crate) fn place(&self) -> &Place {
        &self.place
    }

    /// Shows the graph of these nested group instances, and clears the selection.
    pub(crate) fn show_graph_at(&mut self, instance_path: Vec<NodeId>) {
        self.place.enter(self.session.document(), instance_path);
        self.selection.clear();
    }

    /// A node of the shown graph.
    pub fn node(&self, id: &NodeId) -> Option<&Node> {
        self.graph().node(id.as_str())
    }

    /// Ports and knobs of a node of the shown graph.
    pub fn interface(&self, id: &NodeId) -> Option<&Arc<Interface>> {
        self.interfaces().of(self.shown(), id.as_str())
    }

    /// Ports and knobs of the nodes of all graphs of the document.
    pub fn interfaces(&self) -> &Interfaces {
        &self.interfaces.interfaces
    }

    /// Returns a number that increases each time ports and knobs of nodes may have changed. The numbers of different open
    /// documents are always different.
    pub fn interfaces_number(&self) -> u64 {
        self.interfaces.number
    }

    /// Returns the ports and knobs of instances of the shown graph.
    pub fn own_interface(&self) -> Option<&Arc<Interface>> {
        interface_of(self.interfaces(), self.shown())
    }

    /// Returns the title of a node of the shown graph: its own label, or the label of its kind.
    pub fn title(&self, id: &NodeId) -> String {
        let own = self.node(id).and_then(|node| node.label.clone());
        own.or_else(|| self.interface(id).map(|interface| interface.label.clone()))
            .unwrap_or_else(|| id.to_string())
    }

    /// Selected nodes of the shown graph.
    pub fn selection(&self) -> &BTreeSet<NodeId> {
        &self.selection
    }

    /// Returns the selected node, if exactly one node is selected.
    pub fn selected_one(&self) -> Option<&NodeId> {
        let mut ids = self.selection.iter();
        ids.next().filter(|_| ids.next().is_none())
    }

    /// Selects the nodes of this list that exist, and no others.
    pub fn select(&mut self, ids: impl IntoIterator<Item = NodeId>) {
        let ids = ids.into_iter().filter(|id| self.node(id).is_some());
        self.selection = ids.collect();
    }

    /// Generates an id that is neither in the shown graph nor among `taken`: a readable stem with a random end.
    pub(crate) fn new_id(&mut self, stem: &str, taken: &BTreeSet<NodeId>) -> NodeId {
        let contents = self.session.document();
        // The shown graph exists, see `graph`.
        let graph = contents.body(self.place.shown()).unwrap_or(&contents.graph);
        self.ids.id(stem, graph, taken)
    }

    /// Reads a graph file that a file of the base uses as a group; `None` if it cannot be read.
    pub(crate) fn read_group_file(&mut self, base: &PathBase, written: &str) -> Option<Document> {
        let file = self.group_files.read(base, &self.session.graph().trusted, written);
        file.map(Arc::unwrap_or_clone)
    }

    /// Applies edits as [`OpenDocument::edit`] does, and selects nodes if they were applied.
    pub(crate) fn edit_and_select(
        &mut self,
        step: &str,
        edits: Vec<Edit>,
        ids: impl IntoIterator<Item = NodeId>,
    ) -> bool {
        let is_made = self.edit(step, edits);
        if is_made {
            self.select(ids);
        }
        is_made
    }

    /// Applies edits and the edits that follow from them as one undo step with this name. Returns whether they were
    /// applied. If they are refused, a notice is added.
    pub fn edit(&mut self, step: &str, edits: Vec<Edit>) -> bool {
        if edits.is_empty() {
            return false;
        }
        let edits = follow_up::completed(self.contents(), self.shown(), edits);
        if let Some(why) = self.why_not_evaluable_after(&edits) {
            return self.refuse(why);
        }
        let edit = match <[Edit; 1]>::try_from(edits) {
            Ok([one]) => one,
            Err(several) => Edit::Batch(several),
        };
        let made = self.session.edit(step, edit);
        if let Err(error) = &made {
            self.notify(error.to_string());
        }
        self.refresh();
        made.is_ok()
    }

    /// Applies an edit that is not part of the history: undo does not revert it, and redo stays possible.
    pub fn edit_aside(&mut self, edit: Edit) {
        match self.session.edit_aside(edit) {
            Ok(()) => self.refresh(),
            Err(error) => self.notify(error.to_string()),
        }
    }

    /// Applies an edit that may be refused. If it is, nothing changes and no notice is added.
    pub(crate) fn edit_quietly(&mut self, step: &str, edit: Edit) {
        if self.session.edit(step, edit).is_ok() {
            self.refresh();
        }
    }

    fn why_not_evaluable_after(&mut self, edits: &[Edit]) -> Option<String> {
        let mut read = self.group_files.shared_reader(self.session.graph());
        evaluability::reason_lost_by(self.session.document(), edits, &mut read)
    }

    /// Saves the document to another file, which becomes the document's file. The node kinds beside that file are not read.
    pub fn save_as(&mut self, path: &Path) -> Result<(), EngineError> {
        self.session.save_as(path)?;
        self.refresh();
        Ok(())
    }

    /// Reads the document's file again and replaces the contents by it, as one undo step.
    pub fn read_again(&mut self) -> Result<(), EngineError> {
        let read = self.session.reload();
        self.refresh();
        read
    }

    /// Reads changed group files and images again.
    pub fn files_changed(&mut self, files: &BTreeSet<PathBuf>) {
        self.session.graph().look_again(files);
        self.group_files.look_again(files);
        self.interfaces.look_again();
        self.files_revision += 1;
        self.refresh();
    }

    /// Adds a sentence for the artist to the notices.
    pub fn notify(&mut self, sentence: impl Into<String>) {
        self.notices.push(sentence.into());
    }

    /// Adds the reason why an edit is refused to the notices; returns `false`.
    pub(crate) fn refuse(&mut self, why: impl Into<String>) -> bool {
        self.notify(why);
        false
    }

    /// Takes the notices since the last call.
    pub fn take_notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }

    /// Updates what is derived from the document: ports and knobs of nodes, the shown graph and the selection.
    pub(crate) fn refresh(&mut self) {
        let session = &self.session;
        let has_changed = self.interfaces.refresh(
            session,
            &self.node_kinds.catalog,
            self.node_kinds.revision,
            &mut self.group_files.reader(session.graph()),
        );
        if !has_changed {
            return;
        }
        if self.place.follow(self.session.document()) {
            self.selection.clear();
        }
        let selection = std::mem::take(&mut self.selection);
        self.select(selection);
    }
}
