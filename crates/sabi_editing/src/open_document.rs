//! The open document: the state that every edit needs. All edits are applied here.

mod node_kinds;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::catalog::{Catalog, Interface, Interfaces};
use sabi_engine::{EngineError, Kinds, Session};
use sabi_files::PathBase;
use sabi_graph::{Body, Document, Edit, EditError, Graph, Node, NodeId};

use crate::current_interfaces::CurrentInterfaces;
use crate::document_trust::Trust;
use crate::group_files::GroupFiles;
use crate::instances::interface_of;
use crate::library_folder::LibraryFolder;
use crate::new_ids::IdGenerator;
use crate::{evaluability, follow_up};

/// Document that is open in the editor, with the state of editing that is not saved with it.
///
/// The edits themselves are functions of the other modules that take `&mut OpenDocument`.
pub struct OpenDocument {
    /// The document with its file, undo history and recovery file.
    pub session: Session,
    kinds: Arc<Kinds>,
    kinds_revision: u64,
    catalog: Arc<Catalog>,
    files_revision: u64,
    interfaces: CurrentInterfaces,
    /// Ports and knobs of the nodes when the document was opened.
    opened: Interfaces,
    group_files: GroupFiles,
    /// Entered group instances, outermost first.
    instance_path: Vec<NodeId>,
    /// Graph that is shown: the graph of the innermost entered instance, or the main graph.
    shown: Body,
    selection: BTreeSet<NodeId>,
    pub(crate) ids: IdGenerator,
    notices: Vec<String>,
    /// Folders of libraries. Links of groups refer to libraries by name.
    pub library_folders: Vec<LibraryFolder>,
    pub(crate) trust: Trust,
}

/// The nodes that are shown, before a step of the history.
struct ShownNodes {
    /// Number of instances that are entered.
    entered_instances: usize,
    ids: BTreeSet<NodeId>,
}

impl OpenDocument {
    pub(crate) fn with_kinds(
        session: Session,
        ids: IdGenerator,
        kinds: Arc<Kinds>,
        catalog: Arc<Catalog>,
    ) -> OpenDocument {
        // Revisions of a session are unique in the process, so numbers that continue from its first revision are, too.
        let first = session.revision();
        let mut document = OpenDocument {
            session,
            catalog,
            kinds,
            kinds_revision: first,
            files_revision: first,
            interfaces: CurrentInterfaces::default(),
            opened: Interfaces::default(),
            group_files: GroupFiles::default(),
            instance_path: Vec::new(),
            shown: Body::Main,
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
        &self.shown
    }

    /// Copy of [`OpenDocument::shown`], which edits take by value.
    pub fn body(&self) -> Body {
        self.shown.clone()
    }

    /// The shown graph.
    pub fn graph(&self) -> &Graph {
        // `shown` always names an existing graph: `refresh` leaves groups that were removed.
        self.graph_of(&self.shown).unwrap_or(&self.contents().graph)
    }

    pub(crate) fn graph_of(&self, body: &Body) -> Option<&Graph> {
        self.contents().body(body).ok()
    }

    /// Returns the graphs of the entered instances that exist, outermost first, without the main graph.
    pub(crate) fn entered_graphs(&self) -> Vec<Body> {
        let mut entered: Vec<Body> = Vec::new();
        for id in &self.instance_path {
            let graph = self.graph_of(entered.last().unwrap_or(&Body::Main));
            let group = graph.and_then(|graph| graph.node(id.as_str())?.group.clone());
            let Some(name) = group.filter(|name| self.contents().groups.contains_key(name)) else {
                break;
            };
            entered.push(Body::Group(name));
        }
        entered
    }

    /// Entered group instances, outermost first.
    pub(crate) fn instance_path(&self) -> &[NodeId] {
        &self.instance_path
    }

    /// Shows the graph of these nested group instances, and clears the selection.
    pub(crate) fn show_graph_at(&mut self, instance_path: Vec<NodeId>) {
        self.instance_path = instance_path;
        self.shown = self.entered_graphs().pop().unwrap_or(Body::Main);
        self.selection.clear();
    }

    /// A node of the shown graph.
    pub fn node(&self, id: &NodeId) -> Option<&Node> {
        self.graph().node(id.as_str())
    }

    /// Ports and knobs of a node of the shown graph.
    pub fn interface(&self, id: &NodeId) -> Option<&Arc<Interface>> {
        self.interfaces().of(&self.shown, id.as_str())
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
        interface_of(self.interfaces(), &self.shown)
    }

    /// Ports and knobs that instances of the shown graph had when the document was opened.
    pub(crate) fn own_interface_when_opened(&self) -> Option<&Arc<Interface>> {
        interface_of(&self.opened, &self.shown)
    }

    /// Returns the title of a node of the shown graph: its own label, or the label of its kind.
    pub fn title(&self, id: &NodeId) -> String {
        let own = self.node(id).and_then(|node| node.label.clone());
        own.or_else(|| self.interface(id).map(|interface| interface.label.clone()))
            .unwrap_or_else(|| id.to_string())
    }

    /// Returns the id of a node of the shown graph in the evaluation: the ids of the entered instances and its own id,
    /// separated by slashes.
    pub fn full_id(&self, id: &NodeId) -> String {
        let path = self.instance_path.iter().chain([id]).map(NodeId::as_str);
        path.collect::<Vec<_>>().join("/")
    }

    /// Selected nodes of the shown graph.
    pub fn selection(&self) -> &BTreeSet<NodeId> {
        &self.selection
    }

    /// Returns whether a node is selected.
    pub fn is_selected(&self, id: &NodeId) -> bool {
        self.selection.contains(id)
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
        let OpenDocument {
            session, shown, ids, ..
        } = self;
        let contents = session.document();
        ids.id(stem, contents.body(shown).unwrap_or(&contents.graph), taken) // `shown` names an existing graph, see `graph`
    }

    /// Generates an id with the same stem as another id.
    pub(crate) fn new_id_like(&mut self, id: &NodeId, taken: &BTreeSet<NodeId>) -> NodeId {
        let stem = id.as_str().rsplit_once('_').map_or(id.as_str(), |(stem, _)| stem);
        self.new_id(stem, taken)
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
        let edits = follow_up::completed(self.contents(), &self.shown, edits);
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

    /// Undoes the last step, and selects the nodes that come back.
    pub fn undo(&mut self) {
        let before = self.shown_nodes();
        let undone = self.session.undo();
        self.after_history(undone, "Undone", &before);
    }

    /// Redoes the last step that was undone, and selects the nodes that come back.
    pub fn redo(&mut self) {
        let before = self.shown_nodes();
        let redone = self.session.redo();
        self.after_history(redone, "Redone", &before);
    }

    /// Cancels the step that was started with `session.begin`: the document is restored to its state before the step.
    pub fn cancel_step(&mut self) {
        if let Err(error) = self.session.cancel() {
            self.notify(error.to_string());
        }
        self.refresh();
    }

    /// The shown nodes, to find the nodes that undo or redo restores.
    fn shown_nodes(&self) -> ShownNodes {
        ShownNodes {
            entered_instances: self.instance_path.len(),
            ids: self.graph().ids().cloned().collect(),
        }
    }

    fn after_history(&mut self, moved: Result<Option<String>, EditError>, verb: &str, before: &ShownNodes) {
        match moved {
            Ok(step) => self.notices.extend(step.map(|name| format!("{verb}: {name}"))),
            Err(error) => self.notify(error.to_string()),
        }
        self.refresh();
        let ids = self.graph().ids();
        let returned: Vec<NodeId> = ids.filter(|id| !before.ids.contains(*id)).cloned().collect();
        if before.entered_instances == self.instance_path.len() && !returned.is_empty() {
            self.select(returned);
        }
    }

    /// Saves the document to its file.
    pub fn save(&mut self) -> Result<(), EngineError> {
        self.session.save()
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
    fn refresh(&mut self) {
        let session = &self.session;
        let has_changed = self.interfaces.refresh(
            session,
            &self.catalog,
            self.kinds_revision,
            &mut self.group_files.reader(session.graph()),
        );
        if !has_changed {
            return;
        }
        let mut entered = self.entered_graphs();
        if entered.len() < self.instance_path.len() {
            // An entered instance does not exist any more: show the innermost graph that still exists.
            self.show_graph_at(self.instance_path[..entered.len()].to_vec());
        } else {
            self.shown = entered.pop().unwrap_or(Body::Main);
        }
        let selection = std::mem::take(&mut self.selection);
        self.select(selection);
    }
}
