//! `cargo xtask library`: the groups of the effect library on models, drawn by `sabi render`, with a page about each.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::{Map, Value, json};

use crate::project::{Project, TaskError, create_folder, finish, not_written, write_file};
use crate::small_png::{Picture, encode, read};
use crate::vulkan::{self, Driver};

/// Folder of the pages and pictures, relative to the root.
const FOLDER: &str = "docs/library";
/// Folder of the groups, relative to the root.
const GROUPS: &str = "graphs/library";
/// Categories in the order of the page, with their titles.
const CATEGORIES: [(&str, &str); 4] = [
    ("base", "Base materials"),
    ("generator", "Generators"),
    ("weathering", "Weathering"),
    ("finish", "Finish"),
];

/// Size of a picture of one model or variant, and bytes that a strip of them may take.
const TILE: [usize; 2] = [320, 240];
const MOST_BYTES: usize = 72 * 1024;

/// Models of groups that suit others better than the usual ones.
const MODELS: &[(&str, [&str; 3])] = &[
    ("bare_metal", ["chain", "barrel", "figure"]),
    ("cut_stone", ["column", "figure", "wall"]),
    ("concrete", ["wall", "column", "bench"]),
    ("plaster", ["wall", "column", "figure"]),
    ("masonry", ["wall", "column", "figure"]),
    ("wood", ["table", "chair", "barrel"]),
    ("ceramic", ["figure", "column", "chair"]),
    ("cloth_and_leather", ["chair", "figure", "crate"]),
    ("rust", ["chain", "barrel", "crate"]),
    ("patina", ["figure", "column", "barrel"]),
    ("moss", ["figure", "wall", "bench"]),
    ("lichen", ["figure", "column", "wall"]),
    ("broken_edges", ["column", "wall", "bench"]),
    ("cracks", ["wall", "figure", "column"]),
    ("water_stains", ["wall", "figure", "crate"]),
    ("damp_wall", ["wall", "column", "figure"]),
    ("mold", ["wall", "figure", "crate"]),
    ("plaster_off_masonry", ["wall", "column", "figure"]),
    ("weathered_wood", ["bench", "table", "barrel"]),
];
const USUAL_MODELS: [&str; 3] = ["crate", "bench", "figure"];

/// Bases that groups lie over in their pictures.
const BASES: &[(&str, &str)] = &[
    ("patina", "bare_metal"),
    ("rust", "bare_metal"),
    ("soot_and_heat", "bare_metal"),
    ("moss", "cut_stone"),
    ("lichen", "cut_stone"),
    ("broken_edges", "cut_stone"),
    ("cracks", "plaster"),
    ("water_stains", "plaster"),
    ("damp_wall", "plaster"),
    ("mold", "plaster"),
    ("weathered_wood", "wood"),
    ("snow_cover", "cut_stone"),
];
const USUAL_BASE: &str = "painted_metal";

/// A group of the library.
struct Group {
    category: String,
    stem: String,
    path: PathBuf,
    document: Value,
}

/// Draws the pictures of all groups or of those named, and writes the page.
pub(crate) fn run(project: &Project, names: &[String]) -> Result<(), TaskError> {
    let groups = groups(&project.root)?;
    if let Some(unknown) = names
        .iter()
        .find(|name| groups.iter().all(|group| group.stem != **name))
    {
        return Err(TaskError::new(2, format!("There is no group `{unknown}` in {GROUPS}.")));
    }
    vulkan::ensure(project, Driver::Software)?;
    finish(
        project.cargo(&["build", "--quiet", "--release", "--locked", "--package", "sabi"])?,
        "Building sabi",
    )?;
    let work = project.target.join("library");
    for folder in [&work, &project.root.join(FOLDER)] {
        create_folder(folder)?;
    }
    for group in groups
        .iter()
        .filter(|group| names.is_empty() || names.contains(&group.stem))
    {
        draw_group(project, &groups, group, &work)?;
    }
    write_file(&project.root.join(FOLDER).join("README.md"), page(&groups))
}

/// Lists the groups by category and name.
fn groups(root: &Path) -> Result<Vec<Group>, TaskError> {
    let mut groups = Vec::new();
    for (category, _) in CATEGORIES {
        let folder = root.join(GROUPS).join(category);
        let unreadable = |error: &dyn std::fmt::Display| TaskError::new(1, format!("{}: {error}", folder.display()));
        let entries = fs::read_dir(&folder).map_err(|error| unreadable(&error))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "sabi"));
        paths.sort();
        for path in paths {
            let text = fs::read_to_string(&path).map_err(|error| unreadable(&error))?;
            let document = serde_json::from_str(&text).map_err(|error| unreadable(&error))?;
            let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            groups.push(Group {
                category: category.to_owned(),
                stem: stem.unwrap_or_default(), // A file with an ending has a stem.
                path,
                document,
            });
        }
    }
    Ok(groups)
}

impl Group {
    fn models(&self) -> [&'static str; 3] {
        let own = MODELS.iter().find(|(stem, _)| *stem == self.stem);
        own.map_or(USUAL_MODELS, |(_, models)| *models)
    }

    /// Group that it lies over in pictures; none for a base material.
    fn base<'g>(&self, groups: &'g [Group]) -> Option<&'g Group> {
        if self.category == "base" {
            return None;
        }
        let own = BASES.iter().find(|(stem, _)| *stem == self.stem);
        let stem = own.map_or(USUAL_BASE, |(_, base)| *base);
        groups.iter().find(|group| group.stem == stem)
    }

    fn text(&self, key: &str) -> &str {
        self.document.get(key).and_then(Value::as_str).unwrap_or("") // The page shows what there is.
    }

    /// Variants, the group's own values first.
    fn variants(&self) -> Vec<Option<&str>> {
        let named = self.document.get("variants").and_then(Value::as_object);
        let named = named.into_iter().flat_map(Map::keys).map(|name| Some(name.as_str()));
        std::iter::once(None).chain(named).collect()
    }

    /// A graph that shows the group over its base.
    fn shown(&self, groups: &[Group], variant: Option<&str>) -> Value {
        let mut nodes = Map::new();
        let mut instance = json!({ "kind": "graph/group", "group": self.path });
        if let Some(variant) = variant {
            instance["params"] = json!({ "variant": variant });
        }
        if let Some(base) = self.base(groups) {
            nodes.insert("base".to_owned(), json!({ "kind": "graph/group", "group": base.path }));
            instance["inputs"] = json!({ "material": "base.material" });
        }
        nodes.insert("shown".to_owned(), instance);
        let output = json!({ "kind": "output/material", "inputs": { "material": "shown.material" } });
        nodes.insert("out".to_owned(), output);
        json!({ "format": "sabi", "version": 1, "nodes": nodes })
    }
}

/// Draws a group on its models, and its variants on the first of them.
fn draw_group(project: &Project, groups: &[Group], group: &Group, work: &Path) -> Result<(), TaskError> {
    let [first, ..] = group.models();
    let on_models = group.models().map(|model| (None, model));
    strip(project, groups, group, work, &on_models, &group.stem)?;
    let variants: Vec<(Option<&str>, &str)> = group.variants().into_iter().map(|variant| (variant, first)).collect();
    strip(
        project,
        groups,
        group,
        work,
        &variants[1..],
        &format!("{}.variants", group.stem),
    )
}

/// Draws pictures side by side.
fn strip(
    project: &Project,
    groups: &[Group],
    group: &Group,
    work: &Path,
    shots: &[(Option<&str>, &str)],
    name: &str,
) -> Result<(), TaskError> {
    let mut tiles = Vec::new();
    for (number, (variant, model)) in shots.iter().enumerate() {
        let graph = work.join(format!("{name}_{number}.sabi"));
        write_file(&graph, group.shown(groups, *variant).to_string())?;
        let drawn = work.join(format!("{name}_{number}.png"));
        let mut render = project.command(&project.sabi("release"))?;
        let [width, height] = TILE;
        render
            .arg("render")
            .arg(&graph)
            .args(["--adapter", "cpu", "--quiet", "--texels", "1024", "--samples", "16"])
            .args(["--size", &format!("{width}x{height}")])
            .args(["--mesh", &format!("assets/meshes/{model}.glb")])
            .arg("-o")
            .arg(&drawn)
            .stdout(Stdio::null());
        finish(render, &format!("Drawing {name}"))?;
        tiles.push(read(&drawn).map_err(|why| not_written(&drawn, &why))?);
    }
    let path = project.root.join(FOLDER).join(format!("{name}.png"));
    let size = [TILE[0] * tiles.len(), TILE[1]];
    let small = encode(&side_by_side(&tiles), size, MOST_BYTES).map_err(|why| not_written(&path, &why))?;
    write_file(&path, small)?;
    eprintln!("{}", path.display());
    Ok(())
}

/// Pixels of pictures of one size, from left to right.
fn side_by_side(tiles: &[Picture]) -> Vec<[u8; 3]> {
    let [width, height] = TILE;
    let rows = (0..height).flat_map(|row| {
        tiles
            .iter()
            .map(move |tile| &tile.pixels[row * width..(row + 1) * width])
    });
    rows.flatten().copied().collect()
}

/// The page about all groups.
fn page(groups: &[Group]) -> String {
    let mut page = String::from(
        "# The effect library\n\nWritten by `cargo xtask library` from `graphs/library`. Each group is drawn on three models with the \
         same parameters, and in its variants on the first of them; all but base materials lie over one. Every group has the \
         parameters Seed (other patterns), Scale (multiplies its lengths) and Fit (whether lengths are shares of the piece, shares of \
         the model, or metres) besides its own. How to make your own: [a smart material step by step](own-material.md).\n",
    );
    for (category, title) in CATEGORIES {
        let _ = write!(page, "\n## {title}\n"); // Writing to a string does not fail.
        for group in groups.iter().filter(|group| group.category == category) {
            let (stem, name) = (&group.stem, group.text("name"));
            let _ = write!(
                page,
                "\n### {name}\n\n{}\n\n![{name} on three models]({stem}.png)\n\n",
                group.text("about")
            );
            let _ = writeln!(page, "| Parameter | Effect |\n|---|---|");
            for (label, about) in knobs(&group.document) {
                let _ = writeln!(page, "| {label} | {about} |");
            }
            let variants: Vec<String> = group
                .variants()
                .into_iter()
                .flatten()
                .map(|variant| variant.replace('_', " "))
                .collect();
            let _ = write!(
                page,
                "\nVariants: {}.\n\n![variants of {name}]({stem}.variants.png)\n",
                variants.join(", ")
            );
        }
    }
    page
}

/// Labels and descriptions of the published knobs, in their order.
fn knobs(document: &Value) -> Vec<(String, String)> {
    let exposed = document.get("exposed").and_then(Value::as_object);
    let mut knobs: Vec<(u64, String, String)> = exposed
        .into_iter()
        .flatten()
        .map(|(name, knob)| {
            let text = |key: &str| knob.get(key).and_then(Value::as_str).map(str::to_owned);
            let order = knob.get("order").and_then(Value::as_u64).unwrap_or(u64::MAX); // Those without one come last.
            (
                order,
                text("label").unwrap_or_else(|| name.clone()),
                text("about").unwrap_or_default(), // A page shows what there is.
            )
        })
        .collect();
    knobs.sort();
    knobs.into_iter().map(|(_, label, about)| (label, about)).collect()
}
