//! Kinds of a library. Built-in kinds are read when they are first needed: a graph uses few of them, and reading all of
//! them takes longer than a short command.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, OnceLock};

use crate::kind::Kind;
use crate::reader::read_kind;
use crate::shader_files::{Libraries, node_files};
use crate::source_file::SourceFile;

/// Kind of a library.
#[derive(Clone, Debug)]
pub(super) enum KindEntry {
    Read(Arc<Kind>),
    BuiltIn(&'static BuiltIn),
}

/// Kind that is part of the program.
#[derive(Debug)]
pub(super) struct BuiltIn {
    pub(super) id: &'static str,
    path: PathBuf,
    text: &'static str,
    /// True if it had other ids earlier.
    has_former_ids: bool,
    /// The kind once it was read; `None` inside for a faulty file.
    kind: OnceLock<Option<Kind>>,
}

impl BuiltIn {
    /// Returns all built-in kinds.
    pub(super) fn all() -> &'static [BuiltIn] {
        static ALL: LazyLock<Vec<BuiltIn>> = LazyLock::new(|| {
            let unread = |(path, id, text)| BuiltIn::unread(path, id, text);
            node_files().map(unread).collect()
        });
        &ALL
    }

    fn unread(path: PathBuf, id: &'static str, text: &'static str) -> BuiltIn {
        BuiltIn {
            id,
            path,
            text,
            has_former_ids: text.contains("@was"),
            kind: OnceLock::new(),
        }
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

impl KindEntry {
    pub(super) fn kind(&self) -> Option<&Kind> {
        match self {
            KindEntry::Read(kind) => Some(kind),
            KindEntry::BuiltIn(kind) => kind.kind(),
        }
    }

    /// Path of the file.
    pub(super) fn path(&self) -> &Path {
        match self {
            KindEntry::Read(kind) => &kind.path,
            KindEntry::BuiltIn(kind) => &kind.path,
        }
    }

    /// Text of the file.
    pub(super) fn text(&self) -> &str {
        match self {
            KindEntry::Read(kind) => &kind.source,
            KindEntry::BuiltIn(kind) => kind.text,
        }
    }

    /// Returns the kind, if it had this id earlier (`@was`).
    pub(super) fn formerly(&self, id: &str) -> Option<&Kind> {
        let kind = match self {
            KindEntry::BuiltIn(kind) if !kind.has_former_ids => return None,
            _ => self.kind()?,
        };
        kind.formerly.iter().any(|old| old == id).then_some(kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Library;

    const TEXT: &str = "//! Half\n//! Halves a mask.\n\n/// The half.\n/// @input source The mask.\nfn mask(at: Surface, source: f32) -> f32 {\n    return 0.5 * source;\n}\n";

    #[test]
    fn a_built_in_kind_is_read_when_it_is_first_used() {
        let text = |text: String| -> &'static str { text.leak() };
        let plain = text(TEXT.to_owned());
        let renamed = text(TEXT.replace("mask.\n\n", "mask.\n//! @was adjust/third\n\n"));
        for (text, was) in [(plain, None), (renamed, Some("adjust/half"))] {
            let kind = &*Box::leak(Box::new(BuiltIn::unread("half.wgsl".into(), "adjust/half", text)));
            let entry = KindEntry::BuiltIn(kind);
            assert_eq!((entry.path(), entry.text()), (Path::new("half.wgsl"), text));
            assert!(kind.kind.get().is_none(), "nothing asked for it");
            assert_eq!(entry.formerly("adjust/third").map(|kind| kind.id.as_str()), was);
            assert!(entry.formerly("adjust/quarter").is_none());
            assert_eq!(
                kind.kind.get().is_some(),
                was.is_some(),
                "read for its former ids alone"
            );
            assert_eq!(entry.kind().map(|kind| kind.label.as_str()), Some("Half"));
        }
    }

    #[test]
    fn each_built_in_kind_is_read_only_once() {
        let library = Library::builtin();
        assert!(library.kind("no/node").is_none());
        let first = library.kind("noise/simplex").expect("one of them");
        let again = Library::builtin();
        let again = again.kind("noise/simplex").expect("the same");
        assert!(std::ptr::eq(first, again));
    }
}
