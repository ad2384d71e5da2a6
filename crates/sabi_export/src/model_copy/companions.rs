//! Buffers and pictures that the model names in files of their own.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::Path;

use sabi_surface::load::named_file;
use serde_json::{Value as Json, json};

use super::CopiedFile;
use super::pictures::uri_of;
use crate::names::file_stem;

/// Copies the buffers and pictures that the file at `path` names, as far as they lie in its folder; `is_new` returns
/// true for those of the bake, by list and index. `stem` names buffers, and `is_taken` returns true for file names that the bake uses already.
/// Returns warnings about files that were not copied.
pub(super) fn bring_along(
    document: &mut Json,
    path: &Path,
    stem: &str,
    is_new: &dyn Fn(&str, usize) -> bool,
    is_taken: &dyn Fn(&str) -> bool,
    files: &mut Vec<CopiedFile>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let mut own: BTreeSet<String> = files.iter().map(|file| file.name.to_lowercase()).collect();
    let mut take = |name: &str| !is_taken(name) && own.insert(name.to_lowercase());
    let mut brought: Vec<(String, String)> = Vec::new();
    for list in ["buffers", "images"] {
        let entries = document.get_mut(list).and_then(Json::as_array_mut);
        for (index, entry) in entries.into_iter().flatten().enumerate() {
            let Some(uri) = entry["uri"]
                .as_str()
                .filter(|_| !is_new(list, index))
                .map(str::to_owned)
            else {
                continue;
            };
            if let Some((_, name)) = brought.iter().find(|(from, _)| *from == uri) {
                entry["uri"] = json!(uri_of(name));
                continue;
            }
            match named_file(path, &uri) {
                None => {}
                Some(Err(reason)) => warnings.push(format!(
                    "the copy of the model names {uri} as the model does, but it was not copied: {reason}"
                )),
                // A downloaded model must not collect other files of this computer.
                Some(Ok((_, file))) if !is_beside(path, &file) => warnings.push(format!(
                    "the copy of the model names {uri} as the model does, but it was not copied: it lies outside of the model's \
                     folder; copy it by hand if it belongs to the model"
                )),
                Some(Ok((bytes, file))) => {
                    let name = free_name(&file, list, stem, &mut take);
                    entry["uri"] = json!(uri_of(&name));
                    brought.push((uri, name.clone()));
                    files.push(CopiedFile { name, bytes });
                }
            }
        }
    }
    warnings
}

/// Returns whether a file is in the model's folder or below, with links and `..` resolved.
fn is_beside(model: &Path, file: &Path) -> bool {
    let folder = match model.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), file.canonicalize()) {
        (Ok(folder), Ok(file)) => file.starts_with(folder),
        _ => false,
    }
}

/// A plain name for a copied file: a buffer goes by the model's name, a picture by its own.
fn free_name(file: &Path, list: &str, stem: &str, take: &mut dyn FnMut(&str) -> bool) -> String {
    let part = |part: Option<&OsStr>| part.map_or_else(String::new, |part| file_stem(&part.to_string_lossy()));
    let first = match part(file.file_stem()) {
        _ if list == "buffers" => stem.to_owned(),
        own if own.is_empty() => "picture".to_owned(),
        own => own,
    };
    free_file_name(&first, &part(file.extension()), take)
}

/// A name of which `take` returns true: `first` with the ending, or with a number before it.
pub(super) fn free_file_name(first: &str, ending: &str, take: &mut dyn FnMut(&str) -> bool) -> String {
    let mut number = 1;
    loop {
        let name = match number {
            1 => format!("{first}.{ending}"),
            number => format!("{first}_{number}.{ending}"),
        };
        if take(&name) {
            return name;
        }
        number += 1;
    }
}
