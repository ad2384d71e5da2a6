//! Rewriting of paths when a graph is saved to another folder, so that they lead to the same files.

use std::collections::BTreeMap;
use std::path::Path;

use sabi_files::{AbsolutePaths, NotText, PathBase, absolute, canonical, without_detours};
use sabi_graph::{Document, Relocation};
use sabi_nodes::kind::Role;

use crate::source;

/// Move of a graph from one folder to another.
pub(super) struct PathRewrite {
    from: PathBase,
    to: PathBase,
    /// Treatment of absolute paths.
    absolute: AbsolutePaths,
    /// Parameters that hold paths of files, by kind. Nodes in WGSL have no such parameters.
    files: BTreeMap<String, Vec<String>>,
}

/// Returns a graph of a file in folder `from` for a file in folder `to`, with paths to the same files.
pub fn relocate_paths(document: &Document, from: &Path, to: &Path) -> Document {
    match PathRewrite::between(from, to, false) {
        Some(rewrite) => rewrite.relocate(|relocation| document.relocated(relocation)),
        None => document.clone(),
    }
}

/// Returns a graph whose paths are absolute. Relative paths start from `folder`.
pub fn with_absolute_paths(document: &Document, folder: &Path) -> Document {
    let base = canonical_base(folder);
    document_with_paths(document, &|path| or_unchanged(base.rewrite_absolute(path), path))
}

/// Returns a graph with the paths that `moved` returns for those of its model, pictures and group files.
pub fn document_with_paths(document: &Document, moved: &dyn Fn(&str) -> String) -> Document {
    let files = PathRewrite::files();
    let is_file = |kind: &str, param: &str| is_file(&files, kind, param);
    document.relocated(Relocation {
        is_file: &is_file,
        moved,
    })
}

impl PathRewrite {
    /// Creates the move between two folders; `None` if both are the same, unless the graph is saved for the first time:
    /// before that, there was no folder from which relative paths could start.
    pub(super) fn between(from: &Path, to: &Path, is_first: bool) -> Option<PathRewrite> {
        let [from, to] = [from, to].map(canonical_base);
        if from == to && !is_first {
            return None;
        }
        Some(PathRewrite {
            from,
            to,
            absolute: match is_first {
                true => AbsolutePaths::Shorten,
                false => AbsolutePaths::Keep,
            },
            files: PathRewrite::files(),
        })
    }

    fn files() -> BTreeMap<String, Vec<String>> {
        let files = source::kinds().into_iter().map(|(id, kind)| {
            let files = kind.params.into_iter().filter(|param| param.ty.role == Role::File);
            (id, files.map(|param| param.name).collect())
        });
        files.collect()
    }

    /// Calls `done` with this move as a relocation.
    pub(super) fn relocate<T>(&self, done: impl FnOnce(Relocation<'_>) -> T) -> T {
        let is_file = |kind: &str, param: &str| is_file(&self.files, kind, param);
        let moved = |path: &str| or_unchanged(self.to.rewrite(path, &self.from, self.absolute), path);
        done(Relocation {
            is_file: &is_file,
            moved: &moved,
        })
    }
}

fn is_file(files: &BTreeMap<String, Vec<String>>, kind: &str, param: &str) -> bool {
    let files = files.get(kind);
    files.is_some_and(|files| files.iter().any(|known| known == param))
}

/// Returns the base of a folder, in canonical form if the folder exists.
fn canonical_base(folder: &Path) -> PathBase {
    let whole = canonical(folder).unwrap_or_else(|_| absolute(folder));
    PathBase::of_folder(without_detours(&whole))
}

/// Returns a rewritten path. A path with a name that is not Unicode cannot be written, so it is not changed, and its node
/// reports the missing file.
fn or_unchanged(rewritten: Result<String, NotText>, written: &str) -> String {
    rewritten.unwrap_or_else(|_| written.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_picture_of_an_image_is_a_file() {
        let files = PathRewrite::files();
        assert!(is_file(&files, "source/image", "file"));
        assert!(!is_file(&files, "source/image", "projection") && !is_file(&files, "noise/simplex", "file"));
        let stays = |is_first| PathRewrite::between(Path::new("/w/./v"), Path::new("/w/v"), is_first);
        assert!(stays(false).is_none() && stays(true).is_some());
    }
}
