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

use xtask::project::{Project, TaskError, create_folder, finish, not_written, output_of, write_file};
use xtask::vulkan::{self, Driver};

/// Folder of the pages, relative to the root.
const FOLDER: &str = "docs/nodes";

/// Writes pages and pictures again; `--text` leaves the pictures, ids of kinds take only theirs.
pub(crate) fn run(project: &Project, arguments: &[String]) -> Result<(), TaskError> {
    let text_only = arguments.iter().any(|argument| argument == "--text");
    let asked: BTreeSet<&str> = arguments
        .iter()
        .map(String::as_str)
        .filter(|argument| *argument != "--text")
        .collect();
    finish(
        project.cargo(&["build", "--quiet", "--locked", "--package", "sabi"])?,
        "Building sabi",
    )?;
    let sabi = project.sabi("debug");
    let nodes = describe(project, &sabi)?;
    if let Some(unknown) = asked.iter().find(|id| nodes.iter().all(|node| node["id"] != **id)) {
        let why = format!("There is no node `{unknown}`. `sabi nodes` lists all.");
        return Err(TaskError::new(2, why));
    }
    let folder = project.root.join(FOLDER);
    if !text_only {
        vulkan::ensure(project, Driver::Software)?;
        let chosen = |node: &&Value| asked.is_empty() || asked.contains(node["id"].as_str().unwrap_or_default());
        let of_kinds: Vec<&Value> = nodes.iter().filter(chosen).collect();
        studio::Studio::open(project, &sabi)?.shoot(&of_kinds, &folder)?;
    }
    write(&project.root, &folder, &nodes)
}

/// Runs `sabi nodes --json` and returns its list of nodes.
fn describe(project: &Project, sabi: &Path) -> Result<Vec<Value>, TaskError> {
    let mut command = project.command(sabi)?;
    command.args(["nodes", "--json"]);
    // The pages describe the project\'s own nodes only.
    command.env("SABI_NODES", project.target.join("reference/no_nodes"));
    let output = output_of(&mut command)?;
    serde_json::from_slice(&output.stdout).map_err(|error| {
        let words = String::from_utf8_lossy(&output.stderr);
        TaskError::failed(format!("`sabi nodes --json` gave no list of nodes ({error}): {words}"))
    })
}

/// Writes the pages and takes away what no node has any more.
fn write(root: &Path, folder: &Path, nodes: &[Value]) -> Result<(), TaskError> {
    let pages = pages::pages(nodes, &|path| root.join(path).is_file());
    let mut kept = BTreeSet::new();
    for (name, text) in &pages {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            create_folder(parent)?;
        }
        write_file(&path, text)?;
        kept.insert(path);
    }
    for node in nodes {
        kept.extend(pages::pictures_of(node).into_iter().map(|(_, name)| folder.join(name)));
    }
    let categories = fs::read_dir(folder).map_err(|error| not_written(folder, &error))?;
    for category in categories.flatten().filter(|entry| entry.path().is_dir()) {
        for file in fs::read_dir(category.path()).into_iter().flatten().flatten() {
            if !kept.contains(&file.path()) {
                fs::remove_file(file.path()).map_err(|error| not_written(&file.path(), &error))?;
            }
        }
    }
    eprintln!("{FOLDER}: {} nodes.", nodes.len());
    Ok(())
}
