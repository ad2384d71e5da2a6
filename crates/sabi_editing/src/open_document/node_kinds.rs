//! Node kinds of the open document. Reading their files takes time, so callers do it where nothing waits for it.

use std::sync::Arc;

use sabi_engine::catalog::Catalog;
use sabi_engine::{Kinds, Session};

use super::OpenDocument;
use crate::new_ids::IdGenerator;

impl OpenDocument {
    /// Opens the document of a session, with the node kinds beside its file.
    pub fn new(session: Session) -> OpenDocument {
        let kinds = Arc::new(Kinds::beside(session.file(), &session.graph().trusted));
        let catalog = Arc::new(Catalog::new(&kinds));
        OpenDocument::with_kinds(session, IdGenerator::random(), kinds, catalog)
    }

    /// Opens the document of a session with the built-in node kinds only. The kinds of its folders are read later.
    pub fn before_kinds(session: Session) -> OpenDocument {
        let kinds = Arc::new(Kinds::builtin());
        let catalog = Arc::new(Catalog::new(&kinds));
        OpenDocument::with_kinds(session, IdGenerator::random(), kinds, catalog)
    }

    /// Sets the node kinds of the document's folders for the first time since the document was opened.
    pub fn first_kinds(&mut self, kinds: Kinds) {
        self.replace_kinds(kinds);
        self.opened = self.interfaces().clone();
    }

    /// Replaces the node kinds after their files changed.
    pub fn replace_kinds(&mut self, kinds: Kinds) {
        self.catalog = Arc::new(Catalog::new(&kinds));
        self.kinds = Arc::new(kinds);
        self.kinds_revision += 1;
        self.refresh();
    }

    /// Returns the node kinds, and a number that increases each time they are read again.
    pub fn kinds(&self) -> (&Arc<Kinds>, u64) {
        (&self.kinds, self.kinds_revision)
    }

    /// Descriptions of all node kinds.
    pub fn catalog(&self) -> &Arc<Catalog> {
        &self.catalog
    }
}
