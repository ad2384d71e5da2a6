//! Buffers and images that the model stores in separate files.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use sabi_files::{PathBase, data_uri};
use sabi_surface::load::named_file;
use serde_json::{Value as Json, json};

use super::container::Container;
use super::edit::{push, remove};
use super::picture_slots::{media_type, uri_of};
use super::{CopiedFile, CopySource};
use crate::names::file_stem;

/// Media type of buffers (glTF 2.0, 3.6.1.1).
pub(super) const BUFFER_TYPE: &str = "application/octet-stream";

/// Copies the buffers and images to which the file of a model refers, if they are in its folder. `is_new` returns true for
/// those of the bake, by list and index. `stem` is the name for buffers, and `is_taken` returns true for file names that
/// the bake already uses. Returns warnings about files that were not copied.
pub(super) fn bring_along(
    document: &mut Json,
    source: CopySource<'_>,
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
            match companion(source, &uri) {
                None => {}
                Some(Err(warning)) => warnings.push(warning),
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

/// Embeds the buffers and images to which the file of a model refers: images of a `.glb` in its binary chunk, everything
/// else as data URIs. Returns warnings about files that were not embedded.
pub(super) fn embed(document: &mut Json, container: &mut Container, source: CopySource<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    let mut views: BTreeMap<String, usize> = BTreeMap::new();
    for list in ["buffers", "images"] {
        for index in 0..document[list].as_array().map_or(0, Vec::len) {
            let Some(uri) = document[list][index]["uri"].as_str().map(str::to_owned) else {
                continue;
            };
            let bytes = match companion(source, &uri) {
                None => continue,
                Some(Err(warning)) => {
                    warnings.push(warning);
                    continue;
                }
                Some(Ok((bytes, _))) => bytes,
            };
            if list == "buffers" {
                document[list][index]["uri"] = json!(data_uri(BUFFER_TYPE, &bytes));
                continue;
            }
            let kind = document[list][index]["mimeType"].as_str().map(str::to_owned);
            let kind = kind.unwrap_or_else(|| media_type(&bytes).unwrap_or(BUFFER_TYPE).to_owned());
            let known = views.get(&uri).copied();
            let view = known.or_else(|| Some(push(document, "bufferViews", container.put(&bytes)?)));
            let image = &mut document[list][index];
            match view {
                Some(view) => {
                    views.insert(uri, view);
                    remove(image, "uri");
                    image["mimeType"] = json!(kind);
                    image["bufferView"] = json!(view);
                }
                None => image["uri"] = json!(data_uri(&kind, &bytes)),
            }
        }
    }
    warnings
}

/// Makes the first buffer of a `.glb`, if it is a file, its binary chunk.
pub(super) fn adopt_first_buffer(document: &mut Json, container: &mut Container, source: CopySource<'_>) {
    let Some(uri) = document["buffers"][0]["uri"].as_str() else {
        return;
    };
    if let Some(Ok((bytes, _))) = companion(source, uri)
        && container.adopt(bytes)
    {
        remove(&mut document["buffers"][0], "uri");
    }
}

/// Reads a file to which a model refers; `None` if the URI is not a file name. The error is a warning.
fn companion(source: CopySource<'_>, uri: &str) -> Option<Result<(Vec<u8>, PathBuf), String>> {
    let CopySource { path, model, .. } = source;
    Some(match named_file(path, model, uri)? {
        Err(reason) => Err(format!(
            "the copy of the model names {uri} as the model does, but it was not copied: {reason}"
        )),
        // A downloaded model must not be able to collect other files of this computer.
        Ok((_, file)) if !PathBase::of_file(path).is_above(&file) => Err(format!(
            "the copy of the model names {uri} as the model does, but it was not copied: it lies outside of the model's folder; \
             copy it by hand if it belongs to the model"
        )),
        Ok((bytes, file)) => Ok((bytes, file)),
    })
}

/// Returns a free name for a copied file: a buffer is named after the model, an image keeps its own name.
fn free_name(file: &Path, list: &str, stem: &str, take: &mut dyn FnMut(&str) -> bool) -> String {
    let part = |part: Option<&OsStr>| part.map_or_else(String::new, |part| file_stem(&part.to_string_lossy()));
    let first = match part(file.file_stem()) {
        _ if list == "buffers" => stem.to_owned(),
        own if own.is_empty() => "picture".to_owned(),
        own => own,
    };
    free_file_name(&first, &part(file.extension()), take)
}

/// Returns a name for which `take` returns true: `first` with the ending, or with a number before it.
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
