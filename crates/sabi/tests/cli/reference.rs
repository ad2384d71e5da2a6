//! The node reference in docs/nodes is what the nodes say.

// The text is made here once more, by the same code as `cargo xtask reference`.
#[path = "../../../sabi_assets/src/reference/pages.rs"]
mod pages;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

/// Kept small, since every clone brings them along.
const MOST_BYTES_OF_A_PICTURE: u64 = 25 * 1024;
const MOST_BYTES_OF_ALL: u64 = 4 * 1024 * 1024;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Files below docs/nodes, as paths from there, with their sizes.
fn files() -> io::Result<Vec<(String, u64)>> {
    let folder = root().join("docs/nodes");
    let mut files = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(prefix) = folders.pop() {
        for entry in fs::read_dir(folder.join(&prefix))? {
            let entry = entry?;
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.file_type()?.is_dir() {
                folders.push(format!("{name}/"));
            } else {
                files.push((name, entry.metadata()?.len()));
            }
        }
    }
    files.sort();
    Ok(files)
}

#[test]
fn the_reference_is_what_the_nodes_say() {
    let place = CliFolder::new();
    let nodes: Vec<Json> = serde_json::from_str(&place.sabi(&["nodes", "--json"]).good().stdout).unwrap();
    let pages = pages::pages(&nodes, &|path| root().join(path).is_file());
    let mut stale: BTreeSet<String> = BTreeSet::new();
    for (name, text) in &pages {
        let written = fs::read_to_string(root().join("docs/nodes").join(name)).unwrap_or_default();
        if written.replace("\r\n", "\n") != *text {
            stale.insert(name.clone());
        }
    }
    let known: BTreeSet<String> = nodes
        .iter()
        .flat_map(|node| pages::pictures_of(node).into_iter().map(|(_, name)| name))
        .chain(pages.into_iter().map(|(name, _)| name))
        .collect();
    let left = files().unwrap().into_iter().map(|(name, _)| name);
    stale.extend(left.filter(|name| !known.contains(name)));
    assert!(
        stale.is_empty(),
        "docs/nodes does not say what the nodes say in {stale:?}: run `cargo xtask reference` and look at what changed."
    );
}

#[test]
fn the_pictures_of_the_reference_are_small() {
    let mut total = 0;
    for (name, bytes) in files().unwrap() {
        total += bytes;
        let is_small = !name.ends_with(".png") || bytes <= MOST_BYTES_OF_A_PICTURE;
        assert!(is_small, "docs/nodes/{name} takes {bytes} bytes");
    }
    assert!(total <= MOST_BYTES_OF_ALL, "docs/nodes takes {total} bytes");
}
