//! `cargo xtask reference`: a page for every node in docs/nodes, with a picture of each of its results.

#[cfg(test)]
mod tests;

mod pages;
mod picture;
mod scene;
mod specimen;
mod studio;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::place::{Place, Stop, finish};
use crate::vulkan::{self, Driver};

/// Where the pages are, from the root.
const FOLDER: &str = "docs/nodes";

/// Writes pages and pictures again; `--text` leaves the pictures, ids of kinds take only theirs.
pub(crate) fn run(place: &Place, arguments: &[String]) -> Result<(), Stop> {
    let text_only = arguments.iter().any(|argument| argument == "--text");
    let asked: BTreeSet<&str> = arguments
        .iter()
        .map(String::as_str)
        .filter(|argument| *argument != "--text")
        .collect();
    finish(
        place.cargo(&["build", "--quiet", "--locked", "--package", "sabi"])?,
        "Building sabi",
    )?;
    let sabi = place
        .target
        .join("debug")
        .join(format!("sabi{}", std::env::consts::EXE_SUFFIX));
    let nodes = describe(place, &sabi)?;
    if let Some(unknown) = asked.iter().find(|id| nodes.iter().all(|node| node["id"] != **id)) {
        let why = format!("There is no node `{unknown}`. `sabi nodes` lists all.");
        return Err(Stop::new(2, why));
    }
    let folder = place.root.join(FOLDER);
    if !text_only {
        vulkan::ensure(place, Driver::Software)?;
        let chosen = |node: &&Value| asked.is_empty() || asked.contains(node["id"].as_str().unwrap_or_default());
        let of_kinds: Vec<&Value> = nodes.iter().filter(chosen).collect();
        studio::Studio::open(place, &sabi)?.shoot(&of_kinds, &folder)?;
    }
    write(&place.root, &folder, &nodes)
}

/// What `sabi nodes --json` says.
fn describe(place: &Place, sabi: &Path) -> Result<Vec<Value>, Stop> {
    let output = place
        .command(sabi)?
        .args(["nodes", "--json"])
        // Nobody's own nodes belong into the project's pages.
        .env("SABI_NODES", place.target.join("reference/no_nodes"))
        .output()
        .map_err(|error| Stop::new(1, format!("{} could not be started: {error}.", sabi.display())))?;
    serde_json::from_slice(&output.stdout).map_err(|error| {
        let words = String::from_utf8_lossy(&output.stderr);
        Stop::new(
            1,
            format!("`sabi nodes --json` gave no list of nodes ({error}): {words}"),
        )
    })
}

/// Writes the pages and takes away what no node has any more.
fn write(root: &Path, folder: &Path, nodes: &[Value]) -> Result<(), Stop> {
    let pages = pages::pages(nodes, &|path| root.join(path).is_file());
    let cannot = |path: &Path, error: std::io::Error| {
        Stop::new(
            1,
            format!(
                "{} cannot be written: {error}. Free or unlock the disk.",
                path.display()
            ),
        )
    };
    let mut kept = BTreeSet::new();
    for (name, text) in &pages {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| cannot(parent, error))?;
        }
        fs::write(&path, text).map_err(|error| cannot(&path, error))?;
        kept.insert(path);
    }
    for node in nodes {
        kept.extend(pages::pictures_of(node).into_iter().map(|(_, name)| folder.join(name)));
    }
    let categories = fs::read_dir(folder).map_err(|error| cannot(folder, error))?;
    for category in categories.flatten().filter(|entry| entry.path().is_dir()) {
        for file in fs::read_dir(category.path()).into_iter().flatten().flatten() {
            if !kept.contains(&file.path()) {
                fs::remove_file(file.path()).map_err(|error| cannot(&file.path(), error))?;
            }
        }
    }
    eprintln!("{FOLDER}: {} nodes.", nodes.len());
    Ok(())
}
