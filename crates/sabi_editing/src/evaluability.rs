//! Edits that would leave no graph to evaluate. What is wrong with a node is told at that node, and the rest goes on; what is
//! wrong with an instance of a group takes the whole graph, and is refused instead.

use sabi_engine::PathBase;
use sabi_graph::{Document, Edit, GROUP_KIND, Overrides, flatten};

use super::OpenDocument;
use super::group_files::GroupFiles;

impl OpenDocument {
    /// Why nothing could be evaluated after these edits, where something can be now.
    pub(super) fn why_nothing_would_be_left(&mut self, edits: &[Edit]) -> Option<String> {
        if edits.iter().all(|edit| self.is_harmless(edit)) {
            return None;
        }
        let mut after = self.contents().clone();
        // One that is refused breaks nothing.
        after.apply(Edit::Batch(edits.to_vec())).ok()?;
        let base = self.session.graph().base();
        let why = why_broken(&after, &base, &mut self.group_files)?;
        let is_broken_anyway = why_broken(self.session.document(), &base, &mut self.group_files).is_some();
        (!is_broken_anyway).then_some(why)
    }

    fn is_harmless(&self, edit: &Edit) -> bool {
        match edit {
            Edit::Batch(edits) => edits.iter().all(|edit| self.is_harmless(edit)),
            Edit::SetParam { body, node, .. } => {
                let node = self.graph_of(body).and_then(|graph| graph.node(node.as_str()));
                node.is_none_or(|node| node.kind != GROUP_KIND)
            }
            Edit::Move { .. }
            | Edit::SetLabel { .. }
            | Edit::SetMuted { .. }
            | Edit::Disconnect { .. }
            | Edit::AddFrame { .. }
            | Edit::RemoveFrame { .. }
            | Edit::RenameDocument { .. }
            | Edit::SetPreview { .. }
            | Edit::SetFit { .. }
            | Edit::SetSeed { .. } => true,
            _ => false,
        }
    }
}

fn why_broken(document: &Document, base: &PathBase, files: &mut GroupFiles) -> Option<String> {
    let mut read = |name: &str| {
        let file = files.read(&base.resolve(name));
        file.ok_or_else(|| "it cannot be read; open it to see why".to_owned())
    };
    let flat = flatten(document, &Overrides::default(), &mut read);
    flat.err().map(|error| error.to_string())
}
