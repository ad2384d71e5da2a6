//! Rewriting of strokes: without their history, or on another model.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::read_plain;
use sabi_paint::file::{FILE_LIMIT_BYTES, whole};
use sabi_paint::{Step, StrokeBook, Version};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Strokes, StrokesState, paint_folder, versions_of};

/// A file of strokes before and after it was flattened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FlattenedFile {
    /// Model that was painted on.
    pub model: String,
    /// Strokes that the graph names.
    pub strokes: usize,
    /// Size of the file before.
    pub bytes_before: u64,
    /// Its size without history.
    pub bytes: u64,
}

/// The strokes on a model without their history.
#[derive(Default)]
pub(crate) struct FlattenedStrokes {
    book: StrokeBook,
    /// For each earlier version, the version that replaces it.
    after: BTreeMap<Version, Version>,
    strokes: usize,
}

impl FlattenedStrokes {
    /// Returns the names of its versions in the form in which a node stores them.
    pub(crate) fn versions(&self) -> String {
        let names = self.after.values().map(Version::to_string);
        names.collect::<Vec<String>>().join(" ")
    }

    /// Its file.
    fn file(&self, model: &str) -> Vec<u8> {
        let versions: Vec<Version> = self.after.values().copied().collect();
        whole(model, &self.book, &versions)
    }
}

/// Returns an unused name for a copy of a file of strokes. An earlier copy must not be replaced, since it may have the only history.
fn free_backup(file: &Path) -> PathBuf {
    let numbered = (2..).map(|number: u32| format!("strokes.bak{number}"));
    let mut endings = std::iter::once("strokes.bak".to_owned()).chain(numbered);
    let free = endings.find(|ending| !file.with_extension(ending).exists());
    file.with_extension(free.unwrap_or_else(|| "strokes.bak".to_owned())) // Never: the numbers do not end.
}

impl Strokes {
    /// Versions of a node with the same strokes and no history, which are added to those of their models.
    ///
    /// # Errors
    /// The end of a sentence about a version that is not known.
    pub(crate) fn flattened(
        &self,
        written: &str,
        models: &mut BTreeMap<String, FlattenedStrokes>,
    ) -> Result<String, String> {
        let mut state = self.lock();
        let mut names = Vec::new();
        for version in versions_of(written) {
            let list = state.book.list(version);
            let known = list.zip(state.models.get(&version).cloned());
            let (list, model) = known.ok_or_else(|| {
                format!("names the strokes {version}, which no file beside the graph holds; restore that file first")
            })?;
            let flattened = models.entry(model.clone()).or_default();
            let after = match flattened.after.get(&version) {
                Some(after) => *after,
                None => {
                    flattened.strokes += list.strokes.len();
                    let steps = list.strokes.iter().map(|stroke| Step::Add(stroke.clone()));
                    steps.fold(Version::EMPTY, |before, step| {
                        state.book.push(before, &step);
                        flattened.book.push(before, &step)
                    })
                }
            };
            // A version without strokes is not stored in a file.
            if after != Version::EMPTY {
                flattened.after.insert(version, after);
                state.models.insert(after, model);
                names.push(after.to_string());
            }
        }
        Ok(names.join(" "))
    }

    /// Returns the sizes of the files of strokes, and their sizes after flattening.
    pub(crate) fn file_sizes(
        &self,
        graph: &Path,
        flattened: &BTreeMap<String, FlattenedStrokes>,
    ) -> Vec<FlattenedFile> {
        let state = self.lock();
        let files = flattened.iter().map(|(model, flattened)| {
            let file = state.file_of(&paint_folder(graph), model);
            FlattenedFile {
                model: model.clone(),
                strokes: flattened.strokes,
                bytes_before: std::fs::metadata(file).map_or(0, |metadata| metadata.len()),
                bytes: flattened.file(model).len() as u64,
            }
        });
        files.collect()
    }

    /// Copies the files of strokes, with `.bak` behind their names, or `.bak2` and so on where there are copies already.
    ///
    /// # Errors
    /// A file cannot be read, or the disk refuses.
    pub(crate) fn copy_files(
        &self,
        graph: &Path,
        flattened: &BTreeMap<String, FlattenedStrokes>,
    ) -> Result<(), String> {
        let state = self.lock();
        for model in flattened.keys() {
            let file = state.file_of(&paint_folder(graph), model);
            let shown = file.display();
            let bytes = read_plain(&file, FILE_LIMIT_BYTES)
                .map_err(|_| format!("{shown} cannot be read any more; nothing was changed"))?;
            state
                .disk
                .write_whole(&free_backup(&file), &bytes)
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Replaces the files of strokes.
    ///
    /// # Errors
    /// The disk refuses; files that were not replaced are as they were.
    pub(crate) fn replace_files(
        &self,
        graph: &Path,
        flattened: &BTreeMap<String, FlattenedStrokes>,
    ) -> Result<(), String> {
        let mut state = self.lock();
        for (model, flattened) in flattened {
            let file = state.file_of(&paint_folder(graph), model);
            state
                .disk
                .write_whole(&file, &flattened.file(model))
                .map_err(|error| error.to_string())?;
            state.read_file(&file);
        }
        Ok(())
    }

    /// Names of the models that versions were painted on, in order.
    pub(crate) fn models_of(&self, written: &str) -> Vec<String> {
        let state = self.lock();
        let mut models: Vec<String> = versions_of(written)
            .filter_map(|version| state.models.get(&version).cloned())
            .collect();
        models.sort();
        models.dedup();
        models
    }

    /// Returns the versions of a node with other strokes on a model. Adds the number of their points to `points`.
    pub(crate) fn painted_anew(&self, model: &str, written: &str, steps: &[Step], points: &mut usize) -> String {
        let mut state = self.lock();
        let mut version = Version::EMPTY;
        for step in steps {
            if let Step::Add(stroke) = step {
                *points += stroke.points.len();
            }
            version = state.book.push(version, step);
        }
        state.models.insert(version, model.to_owned());
        let is_other =
            |state: &StrokesState, version: &Version| state.models.get(version).is_none_or(|other| other != model);
        let others: Vec<Version> = versions_of(written)
            .filter(|version| is_other(&state, version))
            .collect();
        let own = (version != Version::EMPTY).then_some(version);
        let names = own.into_iter().chain(others).map(|version| version.to_string());
        names.collect::<Vec<String>>().join(" ")
    }
}
