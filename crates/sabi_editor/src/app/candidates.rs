//! Nodes and groups that can be added to the open graph.

use std::collections::BTreeSet;

use sabi_editing::{OpenDocument, library};

use crate::action::LibraryKind;
use crate::search::{Candidate, LibraryGroup, candidates};

/// Nodes and groups that can be added, with the state that they were listed for.
#[derive(Default)]
pub(super) struct Candidates {
    pub(super) all: Vec<Candidate>,
    /// State that `all` was listed for: the numbers of the interfaces and of the node kinds, and the graph's own
    /// groups.
    of: Option<(u64, u64, Vec<String>)>,
    /// Revision of the graph that `own` was made for.
    revision: Option<u64>,
    own: Vec<String>,
}

impl Candidates {
    /// Updates the list, if the graph, the node kinds or the library have changed (`has_changed`). The graph's own groups
    /// wait for the end of the drag of a parameter, since each of its frames has a new revision.
    pub(super) fn refresh(
        &mut self,
        document: &OpenDocument,
        library_groups: &[LibraryGroup],
        has_changed: bool,
        is_dragging: bool,
    ) {
        let revision = document.session.revision();
        if has_changed || (self.revision != Some(revision) && !is_dragging) {
            self.revision = Some(revision);
            self.own = own_groups(document, library_groups);
        }
        let now = (
            document.interfaces_number(),
            document.node_kinds().revision,
            self.own.clone(),
        );
        if self.of.as_ref() == Some(&now) && !has_changed {
            return;
        }
        let (catalog, interfaces) = (document.catalog(), document.interfaces());
        self.all = candidates(catalog, interfaces, &now.2, library_groups);
        self.of = Some(now);
    }
}

/// Names of the graph's groups that are neither linked to a library nor saved in one with the same content: those are
/// listed with the library, and would be listed twice.
fn own_groups(document: &OpenDocument, library_groups: &[LibraryGroup]) -> Vec<String> {
    let saved = library_groups.iter().filter(|group| group.library != LibraryKind::Sabi);
    let in_library = saved.filter_map(|group| library::group_in(document, &group.graph, &group.file));
    let in_library: BTreeSet<String> = in_library.collect();
    let groups = document.contents().groups.iter();
    let own = groups.filter(|(name, group)| group.library.is_none() && !in_library.contains(*name));
    own.map(|(name, _)| name.clone()).collect()
}
