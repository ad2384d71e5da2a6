//! Ports and knobs of the nodes of a document. They are listed again only after edits that may change them, which moving a
//! slider does not.

use sabi_engine::Session;
use sabi_engine::catalog::{Catalog, Interfaces, ReadGroup};
use sabi_graph::{Body, Document, Edit, SlotRef};

/// Ports and knobs of the nodes of the open document.
#[derive(Default)]
pub(crate) struct CurrentInterfaces {
    pub(crate) interfaces: Interfaces,
    /// Revisions of the document and of the kinds when they were listed; `None` if files have changed since.
    of: Option<(u64, u64)>,
    /// Increases each time they are listed. The numbers of different open documents are always different.
    pub(crate) number: u64,
}

impl CurrentInterfaces {
    /// Lets the next refresh list everything again, since files that the graph refers to have changed.
    pub(crate) fn look_again(&mut self) {
        self.of = None;
    }

    /// Lists ports and knobs again if the document or the kinds have changed. Returns whether those of any node may have changed.
    pub(crate) fn refresh(
        &mut self,
        session: &Session,
        catalog: &Catalog,
        kinds_revision: u64,
        read: ReadGroup<'_>,
    ) -> bool {
        let now = (session.revision(), kinds_revision);
        if self.of == Some(now) {
            return false;
        }
        let document = session.document();
        let known = self.of.filter(|(_, kinds)| *kinds == kinds_revision);
        let edits = known.and_then(|(revision, _)| session.edits_since(revision));
        let change = edits.map_or(InterfaceChange::Any, |edits| InterfaceChange::of(document, edits));
        match change {
            InterfaceChange::None => {}
            InterfaceChange::Whole => self.interfaces.refresh_whole(document),
            InterfaceChange::Any => {
                self.interfaces = Interfaces::new(catalog, document, read);
                // Revisions of a session are unique in the process, so this number is unique, too.
                self.number = session.revision().max(self.number + 1);
            }
        }
        self.of = Some(now);
        change == InterfaceChange::Any
    }
}

/// Effect of an edit on the ports and knobs of nodes. For two edits, the larger effect counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum InterfaceChange {
    /// No effect.
    None,
    /// Defaults of the exposed knobs of the main graph, for files that use it as a group.
    Whole,
    /// Possibly the ports and knobs of any node.
    Any,
}

impl InterfaceChange {
    /// Returns the effect of edits that were already applied to `document`.
    fn of(document: &Document, edits: &[Edit]) -> InterfaceChange {
        let changes = edits.iter().map(|edit| InterfaceChange::of_one(document, edit));
        changes.max().unwrap_or(InterfaceChange::None)
    }

    fn of_one(document: &Document, edit: &Edit) -> InterfaceChange {
        match edit {
            Edit::Batch(edits) => InterfaceChange::of(document, edits),
            Edit::SetParam { body, node, param, .. } => {
                let is_set = |slot: &SlotRef| slot.node == *node && slot.name == *param;
                let graph = document.body(body);
                let mut exposed = graph.iter().flat_map(|graph| graph.exposed().values());
                match body {
                    _ if !exposed.any(|knob| knob.to.iter().any(is_set)) => InterfaceChange::None,
                    Body::Main => InterfaceChange::Whole,
                    Body::Group(_) => InterfaceChange::Any,
                }
            }
            Edit::Move { .. }
            | Edit::SetMuted { .. }
            | Edit::SetDisplay { .. }
            | Edit::SetNote { .. }
            | Edit::AddFrame { .. }
            | Edit::RemoveFrame { .. }
            | Edit::SetPreview { .. }
            | Edit::SetFit { .. }
            | Edit::SetSeed { .. } => InterfaceChange::None,
            _ => InterfaceChange::Any,
        }
    }
}
