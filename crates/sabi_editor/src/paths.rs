//! File paths as the window compares and shows them, and the endings that tell the type of a file.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use sabi_editing::library::GRAPH_EXTENSION;
use sabi_files::canonical;

/// Endings of font files.
pub(crate) const FONTS: [&str; 3] = ["ttf", "otf", "ttc"];

/// Endings of images that nodes read.
pub(crate) const IMAGES: [&str; 8] = ["png", "jpg", "jpeg", "exr", "hdr", "tga", "bmp", "webp"];

/// Canonical path of a file, or the path as it is where there is no such file.
pub(crate) fn canonical_if_present(file: &Path) -> PathBuf {
    canonical(file).unwrap_or_else(|_| file.to_owned())
}

/// Path of a file in the canonical path of its folder. The file's own name stays: the target of a link may have another
/// name, and other files beside it.
pub(crate) fn in_canonical_folder(file: &Path) -> PathBuf {
    match (file.parent(), file.file_name()) {
        (Some(folder), Some(name)) => canonical_if_present(folder).join(name),
        _ => file.to_owned(),
    }
}

/// Name of a file for people. Of a path that ends in `..`, all of it.
pub(crate) fn file_name(file: &Path) -> Cow<'_, str> {
    file.file_name().unwrap_or(file.as_os_str()).to_string_lossy()
}

/// Name of a file without its ending, for people.
pub(crate) fn file_stem(file: &Path) -> Cow<'_, str> {
    file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy()
}

/// Ending of a file in lower case, if it has one.
pub(crate) fn lowercase_ending(file: &Path) -> Option<String> {
    file.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}

/// Path of a graph file, with its ending exactly once: a whole file name may have been typed before an ending that
/// stayed in the field.
pub(crate) fn with_graph_ending(path: PathBuf) -> PathBuf {
    let is_graph_file = |path: &Path| {
        let ending = path.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(GRAPH_EXTENSION))
    };
    let is_graph = is_graph_file(&path);
    if is_graph && path.file_stem().is_some_and(|stem| is_graph_file(Path::new(stem))) {
        return with_graph_ending(path.with_extension(""));
    }
    let Some(name) = path.file_name().filter(|_| !is_graph) else {
        return path;
    };
    let mut name = name.to_owned();
    name.push(".");
    name.push(GRAPH_EXTENSION);
    path.with_file_name(name)
}

/// A path with an ending behind its name, unless it has that already.
pub(crate) fn with_ending(path: PathBuf, ending: &str) -> PathBuf {
    let has_it = path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
    if has_it {
        path
    } else {
        path.with_added_extension(ending)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graph_file_gets_its_ending_once() {
        for typed in ["a", "a.sabi", "a.sabi.sabi", "a.SABI.sabi"] {
            let found = with_graph_ending(PathBuf::from("graphs").join(typed));
            assert!(
                found == Path::new("graphs/a.sabi") || found == Path::new("graphs/a.SABI"),
                "{typed}: {found:?}"
            );
        }
        assert_eq!(
            with_graph_ending(PathBuf::from("old.stone")),
            Path::new("old.stone.sabi")
        );
    }
}
