//! Folders of the items of a matrix.

use std::path::{Path, PathBuf};

use sabi_export::folder_name;

use crate::expansion::Draft;

/// Returns the folder of a draft as written in the matrix. The error is a clause.
pub(crate) fn out_folder(draft: &Draft<'_>) -> Result<String, String> {
    let Some(pattern) = &draft.row.out else {
        return Err("there is no 'out'; write, for example, out = \"export/$mesh/$graph(_$variant)\"".to_owned());
    };
    let stem = |name: &String| {
        let stem = Path::new(name).file_stem();
        stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
    };
    let (mesh, graph) = (draft.model.stem(), draft.graph.stem());
    // The graph's own seed is the same in all items.
    let seed = draft.seed.map(|seed| seed.to_string());
    let size = draft.size.to_string();
    let presets = draft.presets.iter().map(stem).collect::<Vec<_>>().join("-");
    let words = [
        ("name", draft.row.name.as_deref()),
        ("mesh", Some(mesh.as_str())),
        ("graph", Some(graph.as_str())),
        ("variant", draft.variant_name.as_deref()),
        ("seed", seed.as_deref()),
        ("size", Some(size.as_str())),
        ("preset", Some(presets.as_str())),
    ];
    folder_name(pattern, &words).map_err(|why| format!("folders cannot be named '{pattern}': {why}"))
}

/// Returns two items of which one would write into the folder of the other, or below it; `None` if there are no such items.
/// Names that differ only in case count as the same, as on some disks.
pub(crate) fn first_clash(folders: &[PathBuf]) -> Option<(usize, usize)> {
    let mut sorted: Vec<(PathBuf, usize)> = folders
        .iter()
        .enumerate()
        .map(|(at, folder)| (folder.to_string_lossy().to_lowercase().into(), at))
        .collect();
    // Paths are compared folder by folder, so that folders below one come directly after it.
    sorted.sort();
    let clash = sorted.windows(2).find(|pair| pair[1].0.starts_with(&pair[0].0))?;
    Some((clash[0].1, clash[1].1))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::first_clash;

    #[test]
    fn folders_that_share_files_are_found() {
        let clash = |folders: &[&str]| first_clash(&folders.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(clash(&["/o/a", "/o/b", "/o/a b", "/o/ab"]), None);
        assert_eq!(clash(&["/o/b", "/o/a", "/o/b"]), Some((0, 2)));
        assert_eq!(clash(&["/o/a/x", "/o/a-b", "/o/a"]), Some((2, 0)), "below it");
        assert_eq!(clash(&["/o/Rust", "/o/rust"]), Some((0, 1)));
    }
}
