//! Groups of the effect library as their files say, and graphs that show them.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::CATEGORIES;
use xtask::project::TaskError;

/// Folder of the groups, relative to the root.
pub(super) const GROUPS: &str = "graphs/library";

/// Models of groups that suit others better than the usual ones.
const MODELS: &[(&str, [&str; 3])] = &[
    ("bare_metal", ["chain", "barrel", "figure"]),
    ("cut_stone", ["column", "figure", "wall"]),
    ("concrete", ["cube", "column", "bench"]),
    ("plaster", ["cube", "figure", "column"]),
    ("masonry", ["cube", "column", "figure"]),
    ("wood", ["table", "chair", "barrel"]),
    ("ceramic", ["figure", "column", "chair"]),
    ("cloth_and_leather", ["chair", "figure", "crate"]),
    ("rust", ["chain", "barrel", "crate"]),
    ("patina", ["figure", "column", "barrel"]),
    ("moss", ["figure", "wall", "bench"]),
    ("lichen", ["figure", "column", "wall"]),
    ("broken_edges", ["cube", "column", "bench"]),
    ("cracks", ["cube", "figure", "column"]),
    ("water_stains", ["cube", "figure", "crate"]),
    ("damp_wall", ["cube", "wall", "figure"]),
    ("mold", ["cube", "figure", "wall"]),
    ("plaster_off_masonry", ["cube", "column", "figure"]),
    ("weathered_wood", ["bench", "table", "barrel"]),
    ("dents", ["barrel", "crate", "bench"]),
    ("paint_crackle", ["figure", "crate", "bench"]),
    ("sun_dose", ["figure", "crate", "bench"]),
    ("smudges", ["figure", "barrel", "crate"]),
    ("wet", ["figure", "barrel", "bench"]),
    ("markings", ["barrel", "crate", "bench"]),
    ("soot_and_heat", ["crate", "barrel", "chain"]),
    ("match_reference", ["figure", "crate", "bench"]),
    ("occlusion_and_bevel", ["crate", "figure", "column"]),
    ("plastic_and_rubber", ["figure", "chair", "barrel"]),
    ("touch_wear", ["bench", "figure", "crate"]),
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
    ("peeling_paint", "wood"),
    ("snow_cover", "wood"),
];
const USUAL_BASE: &str = "painted_metal";

/// A group of the library.
pub(super) struct LibraryGroup {
    pub(super) category: String,
    pub(super) stem: String,
    pub(super) path: PathBuf,
    pub(super) document: Value,
}

/// Lists the groups by category and name.
pub(super) fn groups(root: &Path) -> Result<Vec<LibraryGroup>, TaskError> {
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
            groups.push(LibraryGroup {
                category: category.to_owned(),
                stem: stem.unwrap_or_default(), // A file with an ending has a stem.
                path,
                document,
            });
        }
    }
    Ok(groups)
}

impl LibraryGroup {
    pub(super) fn models(&self) -> [&'static str; 3] {
        let own = MODELS.iter().find(|(stem, _)| *stem == self.stem);
        own.map_or(USUAL_MODELS, |(_, models)| *models)
    }

    /// Group that it lies over in pictures; none for a base material.
    fn base<'g>(&self, groups: &'g [LibraryGroup]) -> Option<&'g LibraryGroup> {
        if self.category == "base" {
            return None;
        }
        let own = BASES.iter().find(|(stem, _)| *stem == self.stem);
        let stem = own.map_or(USUAL_BASE, |(_, base)| *base);
        groups.iter().find(|group| group.stem == stem)
    }

    pub(super) fn text(&self, key: &str) -> &str {
        self.document.get(key).and_then(Value::as_str).unwrap_or("") // The page shows what there is.
    }

    /// Variants, the group's own values first.
    pub(super) fn variants(&self) -> Vec<Option<&str>> {
        let named = self.document.get("variants").and_then(Value::as_object);
        let named = named.into_iter().flat_map(Map::keys).map(|name| Some(name.as_str()));
        std::iter::once(None).chain(named).collect()
    }

    /// A graph that shows the group over its base.
    pub(super) fn shown(&self, groups: &[LibraryGroup], variant: Option<&str>) -> Value {
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
