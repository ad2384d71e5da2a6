//! Kinds of a library. Those that come with the program are read when they are first needed: a graph has a few of them, and reading all
//! takes longer than a short command.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, OnceLock};

use crate::kind::Kind;
use crate::reader::read_kind;
use crate::shader_files::{Libraries, node_files};
use crate::source_file::SourceFile;

/// Kind of a library.
#[derive(Clone, Debug)]
pub(super) enum Entry {
    Read(Arc<Kind>),
    BuiltIn(&'static BuiltIn),
}

/// Kind that comes with the program.
#[derive(Debug)]
pub(super) struct BuiltIn {
    pub(super) id: &'static str,
    path: PathBuf,
    text: &'static str,
    /// None for a faulty file, which a test finds.
    kind: OnceLock<Option<Kind>>,
}

impl BuiltIn {
    /// All of them.
    pub(super) fn all() -> &'static [BuiltIn] {
        static ALL: LazyLock<Vec<BuiltIn>> = LazyLock::new(|| {
            let unread = |(path, id, text)| BuiltIn {
                id,
                path,
                text,
                kind: OnceLock::new(),
            };
            node_files().map(unread).collect()
        });
        &ALL
    }

    fn kind(&self) -> Option<&Kind> {
        let read = || {
            let file = SourceFile {
                path: self.path.clone(),
                id: self.id.to_owned(),
                text: self.text.to_owned(),
            };
            read_kind(&file, Libraries::builtin()).ok()
        };
        self.kind.get_or_init(read).as_ref()
    }
}

impl Entry {
    pub(super) fn kind(&self) -> Option<&Kind> {
        match self {
            Entry::Read(kind) => Some(kind),
            Entry::BuiltIn(kind) => kind.kind(),
        }
    }

    /// Path of the file.
    pub(super) fn path(&self) -> &Path {
        match self {
            Entry::Read(kind) => &kind.path,
            Entry::BuiltIn(kind) => &kind.path,
        }
    }

    /// Text of the file.
    pub(super) fn text(&self) -> &str {
        match self {
            Entry::Read(kind) => &kind.source,
            Entry::BuiltIn(kind) => kind.text,
        }
    }

    /// The kind, if it had this id earlier (`@was`).
    pub(super) fn formerly(&self, id: &str) -> Option<&Kind> {
        // A file without the word need not be read.
        let kind = self.text().contains(id).then(|| self.kind())??;
        kind.formerly.iter().any(|old| old == id).then_some(kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Library;

    #[test]
    fn a_kind_that_comes_with_the_program_is_read_when_it_is_asked_for() {
        let is_read = |id: &str| {
            let mut all = BuiltIn::all().iter();
            all.any(|kind| kind.id == id && kind.kind.get().is_some())
        };
        // Other tests of this process may have read others.
        let library = Library::builtin();
        assert!(library.kind("no/node").is_none());
        let kind = library.kind("noise/simplex").expect("one of them");
        assert!(is_read("noise/simplex"));
        let again = Library::builtin();
        let again = again.kind("noise/simplex").expect("the same");
        assert!(std::ptr::eq(kind, again), "it is read once");
    }
}
