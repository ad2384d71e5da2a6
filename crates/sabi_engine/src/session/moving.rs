//! Paths in a graph that is saved to another folder: they lead where they led before.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use sabi_graph::{Document, Relocation};
use sabi_nodes::kind::Role;

use crate::session::whole_file::canonical;
use crate::source;

/// The way from one folder to another.
pub(super) struct Moving {
    from: PathBuf,
    to: PathBuf,
    /// Whether the graph gets its first file: until then it had no folder that paths could begin at.
    is_first: bool,
    /// Parameters that are paths of files, by kind. Nodes in WGSL name no files.
    files: BTreeMap<String, Vec<String>>,
}

/// A graph as a file in folder `to` writes it, out of one in folder `from`: its paths lead where they led.
pub fn moved_to(document: &Document, from: &Path, to: &Path) -> Document {
    match Moving::between(from, to, false) {
        Some(moving) => moving.relocate(|relocation| document.relocated(relocation)),
        None => document.clone(),
    }
}

/// A graph whose paths, which begin at a folder, are whole: they lead there from everywhere.
pub fn with_whole_paths(document: &Document, folder: &Path) -> Document {
    let folder = real(folder);
    let whole = |path: &str| match path.trim().is_empty() {
        true => path.to_owned(),
        false => slashed(&plain(&folder.join(path.replace('\\', "/")))),
    };
    let files = Moving::files();
    let is_file = |kind: &str, param: &str| is_file(&files, kind, param);
    document.relocated(Relocation {
        is_file: &is_file,
        moved: &whole,
    })
}

impl Moving {
    /// The way between two folders; none where both are the same, unless the graph gets its first file there.
    pub(super) fn between(from: &Path, to: &Path, is_first: bool) -> Option<Moving> {
        let [from, to] = [from, to].map(real);
        if from == to && !is_first {
            return None;
        }
        Some(Moving {
            from,
            to,
            is_first,
            files: Moving::files(),
        })
    }

    fn files() -> BTreeMap<String, Vec<String>> {
        let files = source::kinds().into_iter().map(|(id, kind)| {
            let files = kind.params.into_iter().filter(|param| param.ty.role == Role::File);
            (id, files.map(|param| param.name).collect())
        });
        files.collect()
    }

    /// What is done with this move as a relocation.
    pub(super) fn relocate<T>(&self, done: impl FnOnce(Relocation<'_>) -> T) -> T {
        let is_file = |kind: &str, param: &str| is_file(&self.files, kind, param);
        let moved = |path: &str| moved(path, &self.from, &self.to, self.is_first);
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

/// A folder by its one name, as far as it is there.
fn real(folder: &Path) -> PathBuf {
    let whole = canonical(folder).or_else(|_| std::path::absolute(folder));
    plain(&whole.unwrap_or_else(|_| folder.to_owned()))
}

/// A path without steps back and forth.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(plain.components().next_back(), Some(Component::Normal(_))) => {
                plain.pop();
            }
            // Nothing lies above the root.
            Component::ParentDir if plain.has_root() => {}
            part => plain.push(part),
        }
    }
    plain
}

/// A path out of a file in folder `from` as a file in folder `to` writes it: relative where both lie on one drive. Absolute
/// paths stay, since whoever wrote them wanted them so, except in a graph's `first` file, as far as they share more than the
/// root with its folder. Those of nothing stay.
fn moved(path: &str, from: &Path, to: &Path, is_first: bool) -> String {
    let written = path.replace('\\', "/");
    let has_drive = written.as_bytes().get(1) == Some(&b':');
    let is_absolute = written.starts_with('/') || has_drive;
    if path.trim().is_empty() || is_absolute && !is_first {
        return path.to_owned();
    }
    let target = plain(&from.join(&written));
    let [there, here] = [target.components(), to.components()].map(Iterator::collect::<Vec<_>>);
    let shared = there.iter().zip(&here).take_while(|(one, other)| one == other).count();
    let is_near = there[..shared].iter().any(|part| matches!(part, Component::Normal(_)));
    if is_absolute && !is_near {
        return path.to_owned();
    }
    if shared == 0 {
        return slashed(&target);
    }
    let up = std::iter::repeat_n(Component::ParentDir, here.len() - shared);
    slashed(&up.chain(there[shared..].iter().copied()).collect::<PathBuf>())
}

/// As files have it on every system.
fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_where_it_led_from_another_folder() {
        for (path, from, to, written) in [
            ("a.png", "/w/here", "/w/there", "../here/a.png"),
            ("a.png", "/w", "/w/there", "../a.png"),
            ("there/a.png", "/w", "/w/there", "a.png"),
            ("../a.png", "/w/here", "/w", "a.png"),
            ("./b/../a.png", "/w", "/w/x/y", "../../a.png"),
            ("b\\a.png", "/w", "/w/x", "../b/a.png"),
            ("../../../a.png", "/w", "/v", "../a.png"),
            ("/x/a.png", "/w", "/v", "/x/a.png"),
            ("C:\\x\\a.png", "/w", "/v", "C:\\x\\a.png"),
            ("", "/w", "/v", ""),
        ] {
            assert_eq!(
                moved(path, Path::new(from), Path::new(to), false),
                written,
                "{path} from {from} to {to}"
            );
        }
    }

    #[test]
    fn the_first_file_of_a_graph_names_what_is_near_by_the_way_there() {
        for (path, to, written) in [
            ("/w/assets/a.png", "/w/graphs", "../assets/a.png"),
            ("/w/a.png", "/w", "a.png"),
            ("/x/a.png", "/w", "/x/a.png"),
            ("b/a.png", "/w", "../here/b/a.png"),
            ("", "/w", ""),
        ] {
            assert_eq!(
                moved(path, Path::new("/here"), Path::new(to), true),
                written,
                "{path} in {to}"
            );
        }
    }

    #[test]
    fn only_the_picture_of_an_image_is_a_file() {
        let files = Moving::files();
        assert!(is_file(&files, "source/image", "file"));
        assert!(!is_file(&files, "source/image", "projection") && !is_file(&files, "noise/simplex", "file"));
        let stays = |is_first| Moving::between(Path::new("/w/./v"), Path::new("/w/v"), is_first);
        assert!(stays(false).is_none() && stays(true).is_some());
    }
}
