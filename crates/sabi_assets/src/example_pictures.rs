//! `cargo xtask pictures`: the example graphs on their models, drawn by `sabi render` for the README, the docs and the window.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::Value;

use crate::small_png::{encode, read};
use xtask::project::{Project, TaskError, create_folder, finish, not_written, write_file};
use xtask::vulkan::{self, Driver};

/// Folder of the pictures, relative to the root.
const FOLDER: &str = "docs/pictures";

/// Folders of the graphs that are drawn, each on the model that it names, with the titles of their parts of the page.
const PARTS: [(&str, &str); 2] = [("examples", "Examples"), ("thesis", "Results of the thesis")];

/// Pixels of a picture, and the bytes that it may take.
const SIZE: [usize; 2] = [400, 300];
const MOST_BYTES: usize = 48 * 1024;

/// The picture at the head of the README, and what draws it.
const HEAD: &str = "head";
const HEAD_SIZE: [usize; 2] = [1280, 640];
const HEAD_BYTES: usize = 320 * 1024;
const HEAD_SCENE: [&str; 5] = [
    "graphs/thesis/rusty-chains.sabi",
    "--mesh",
    "assets/meshes/chain.glb",
    "--texels",
    "2048",
];

/// A graph and the model that it names.
struct Example {
    /// Folder of the graph.
    part: &'static str,
    stem: String,
    /// Model file, relative to the root.
    model: String,
}

/// Lists the graphs by part and name.
fn examples(root: &Path) -> Result<Vec<Example>, TaskError> {
    let mut examples = Vec::new();
    for (part, _) in PARTS {
        let folder = root.join("graphs").join(part);
        let unreadable = |why: &dyn std::fmt::Display| TaskError::new(1, format!("{}: {why}", folder.display()));
        let entries = fs::read_dir(&folder).map_err(|error| unreadable(&error))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "sabi"));
        paths.sort();
        for path in paths {
            let text = fs::read_to_string(&path).map_err(|error| unreadable(&error))?;
            let document: Value = serde_json::from_str(&text).map_err(|error| unreadable(&error))?;
            let named = document["preview"]["mesh"]
                .as_str()
                .and_then(|mesh| mesh.rsplit('/').next());
            let (Some(mesh), Some(stem)) = (named, path.file_stem()) else {
                return Err(unreadable(&format!("{} names no model", path.display())));
            };
            examples.push(Example {
                part,
                stem: stem.to_string_lossy().into_owned(),
                model: format!("assets/meshes/{mesh}"),
            });
        }
    }
    Ok(examples)
}

/// Draws all pictures, or those of the named graphs.
pub(crate) fn run(project: &Project, names: &[String]) -> Result<(), TaskError> {
    let examples = examples(&project.root)?;
    let known = || examples.iter().map(|example| example.stem.as_str()).chain([HEAD]);
    if let Some(unknown) = names.iter().find(|name| !known().any(|known| known == *name)) {
        let all = known().collect::<Vec<_>>().join(", ");
        return Err(TaskError::new(
            2,
            format!("There is no example `{unknown}`. These exist: {all}."),
        ));
    }
    vulkan::ensure(project, Driver::Software)?;
    // Without the editor, as for the demo: pictures and bakes need none of it.
    let build = "build --quiet --release --locked --package sabi --no-default-features";
    let build: Vec<&str> = build.split(' ').collect();
    finish(project.cargo(&build)?, "Building sabi")?;
    let work_folder = project.target.join("pictures");
    for folder in [&work_folder, &project.root.join(FOLDER)] {
        create_folder(folder)?;
    }
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|asked| asked == name);
    for Example { part, stem, model } in examples.iter().filter(|example| is_asked(&example.stem)) {
        let graph = format!("graphs/{part}/{stem}.sabi");
        let scene = [graph.as_str(), "--mesh", model, "--texels", "2048"];
        draw(project, &work_folder, &scene, &format!("{stem}.png"), SIZE, MOST_BYTES)?;
    }
    if is_asked(HEAD) {
        draw(project, &work_folder, &HEAD_SCENE, "head.png", HEAD_SIZE, HEAD_BYTES)?;
    }
    let path = project.root.join(FOLDER).join("README.md");
    write_file(&path, page(&examples))
}

/// All pictures on a page, by part.
fn page(examples: &[Example]) -> String {
    let mut page =
        String::from("# Example graphs\n\nWritten by `cargo xtask pictures`; each on the model that it names.\n");
    for (part, title) in PARTS {
        page += &format!("\n## {title}\n\n");
        for Example { stem, .. } in examples.iter().filter(|example| example.part == part) {
            page += &format!("[{stem}](../../graphs/{part}/{stem}.sabi)\n\n![{stem}]({stem}.png)\n\n");
        }
    }
    page.trim_end().to_owned() + "\n"
}

/// Draws one picture and keeps it with few colors.
fn draw(
    project: &Project,
    work_folder: &Path,
    scene: &[&str],
    name: &str,
    size: [usize; 2],
    most_bytes: usize,
) -> Result<(), TaskError> {
    let drawn = work_folder.join(name);
    let sabi = project.sabi("release");
    let [width, height] = size;
    let mut render = project.command(&sabi)?;
    // The software driver, so that everybody draws the same bytes.
    render
        .args([
            "render",
            "--adapter",
            "cpu",
            "--quiet",
            "--samples",
            "32",
            "--size",
            &format!("{width}x{height}"),
        ])
        .args(scene)
        .arg("-o")
        .arg(&drawn)
        .stdout(Stdio::null());
    finish(render, &format!("Drawing {name}"))?;
    let path = project.root.join(FOLDER).join(name);
    let small = read(&drawn).and_then(|picture| encode(&picture.pixels, size, most_bytes));
    let small = small.map_err(|why| not_written(&path, &why))?;
    write_file(&path, small)?;
    eprintln!("{}", path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_names_a_model_of_the_project() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let examples = examples(&root).unwrap();
        assert!(examples.len() >= 18, "{} examples", examples.len());
        for example in examples {
            assert!(
                root.join(&example.model).is_file(),
                "{}: {}",
                example.stem,
                example.model
            );
        }
    }
}
