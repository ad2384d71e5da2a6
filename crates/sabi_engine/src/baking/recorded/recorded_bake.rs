//! Bakes recorded in reports and manifests.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use rayon::prelude::*;
use sabi_files::{PathBase, TrustedPaths, Unread, absolute, is_local, read_plain, stored_path};
use serde::Deserialize;
use serde_json::Value as Json;

use crate::baking::made_of::inputs::{InputRecord, node_files, records};
use crate::baking::made_of::recipe::{Recipe, made_absolute, path_of};
use crate::baking::report::{BakeAdapter, BakeReport, REPORT_VERSION};
use crate::error::{EngineError, ErrorKind};
use crate::program::Build;
use crate::program::digest;

/// Maximum size of a file of recorded bakes in bytes.
pub(super) const MOST_BYTES: u64 = 64 << 20;
/// Files that a sentence names.
const MOST_NAMED: usize = 5;

/// A recorded bake, with absolute paths.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RecordedBake {
    /// Program that baked.
    pub build: Build,
    /// The bake: graph, model and settings.
    pub recipe: Recipe,
    /// Files that the bake read.
    pub inputs: Vec<InputRecord>,
    /// Adapter that ran the graph.
    adapter: BakeAdapter,
    /// Maps that it wrote.
    outputs: Vec<RecordedFile>,
    /// Documents of materials.
    #[serde(default)]
    documents: Vec<RecordedFile>,
    /// Copy of the model.
    model: Option<RecordedCopy>,
    /// True once another bake has replaced some of the files.
    #[serde(default)]
    pub(super) partly_replaced: bool,
}

/// A file that a bake wrote.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub(super) struct RecordedFile {
    /// Path, relative to the output folder.
    pub(super) path: String,
    /// BLAKE3 of the bytes, hexadecimal.
    pub(super) blake3: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
struct RecordedCopy {
    #[serde(flatten)]
    copy: RecordedFile,
    files: Vec<RecordedFile>,
}

impl RecordedBake {
    /// Reads the report of a bake.
    ///
    /// # Errors
    /// The file is missing, is no report, or does not say how its maps were made.
    pub fn open(path: &Path) -> Result<RecordedBake, EngineError> {
        let fault = |kind, why: &str| EngineError::new(kind, format!("the report {} {why}", path.display()));
        let bad = |why: &str| fault(ErrorKind::BadInput, why);
        let bytes = read_plain(path, MOST_BYTES).map_err(|unread| match unread {
            Unread::Missing => fault(ErrorKind::MissingInput, "does not exist; check the path"),
            Unread::Folder | Unread::NotPlain => bad("is a folder or a device, not a file"),
            Unread::TooLarge(_) => bad(&format!(
                "is no report of a bake: it has more than {} MiB",
                MOST_BYTES >> 20
            )),
            Unread::Refused(refusal) => fault(ErrorKind::MissingInput, &format!("is not read: {refusal}")),
            Unread::Other(reason) => fault(ErrorKind::MissingInput, &format!("cannot be read: {reason}")),
        })?;
        let json: Json =
            serde_json::from_slice(&bytes).map_err(|error| bad(&format!("is no report of a bake: {error}")))?;
        if json.get("error").is_some() {
            return Err(bad("is one of a bake that failed; its command line may be run again"));
        }
        match json.get("version").and_then(Json::as_u64) {
            Some(version) if version > u64::from(REPORT_VERSION) => {
                return Err(bad("is one of a newer Sabi; update this one"));
            }
            Some(version) if version == u64::from(REPORT_VERSION) => {}
            _ => {
                return Err(bad(
                    "does not say how its maps were made; bake again to get one that does",
                ));
            }
        }
        let base = PathBase::of_file(&absolute(path));
        RecordedBake::of(&json, &base).map_err(|why| bad(&format!("is damaged: {why}")))
    }

    /// Reads a bake that is recorded in a file of a base. Returns the reason if it cannot be read.
    pub(super) fn of(json: &Json, base: &PathBase) -> Result<RecordedBake, String> {
        let mut bake = RecordedBake::deserialize(json).map_err(|error| error.to_string())?;
        // Checked before the paths are made absolute, since then the path of another computer looks like a local one.
        bake.refuse_strange_paths(base)?;
        bake.recipe = bake.recipe.with_absolute_paths(base);
        for input in &mut bake.inputs {
            input.path = made_absolute(&input.path, base);
        }
        Ok(bake)
    }

    /// Refuses a record that would cause access to files in places that the user did not name: on another computer, which
    /// would learn the user's name, or outside of the folder of the maps. Returns a clause.
    fn refuse_strange_paths(&self, base: &PathBase) -> Result<(), String> {
        let is_here = |path: &str| is_local(path) && is_local(&path_of(path).to_string_lossy());
        let read = self.inputs.iter().map(|input| input.path.as_str());
        let mut read = read.chain([self.recipe.graph.as_str(), self.recipe.model.file.as_str()]);
        // If the record itself is on another computer, the user has named that computer.
        if is_local(&base.folder().to_string_lossy())
            && let Some(strange) = read.find(|path| !is_here(path))
        {
            let shown = path_of(strange).display().to_string();
            return Err(format!(
                "it names {shown}, which is on another computer and is not looked for"
            ));
        }
        let is_below = |path: &str| {
            let parts: Vec<Component<'_>> = Path::new(path).components().collect();
            is_local(path) && !parts.is_empty() && parts.iter().all(|part| matches!(part, Component::Normal(_)))
        };
        match self.files().find(|file| !is_below(&file.path)) {
            Some(file) => Err(format!("it names the map {}, which is in another folder", file.path)),
            None => Ok(()),
        }
    }

    /// Returns the files that the bake wrote, relative to the output folder.
    pub(super) fn files(&self) -> impl Iterator<Item = &RecordedFile> {
        let copy = self
            .model
            .iter()
            .flat_map(|model| std::iter::once(&model.copy).chain(&model.files));
        self.outputs.iter().chain(&self.documents).chain(copy)
    }

    /// Returns the documents that the bake wrote, relative to the output folder.
    pub(super) fn documents(&self) -> impl Iterator<Item = &str> {
        self.documents.iter().map(|document| document.path.as_str())
    }

    /// Returns the files that the bake read and that have changed since, with a sentence each; empty if none has changed.
    pub(super) fn changed_inputs(&self) -> Vec<(String, String)> {
        let now = records(self.inputs.iter().map(|input| path_of(&input.path)));
        let known: BTreeSet<&InputRecord> = self.inputs.iter().collect();
        let changed = now.iter().filter(|input| !known.contains(input));
        let mut sentences: Vec<(String, String)> = changed
            .map(|input| {
                let shown = path_of(&input.path).display().to_string();
                let message = match input.blake3 {
                    Some(_) => format!("{shown} has changed since the bake"),
                    None => format!("{shown} is missing or cannot be read any more"),
                };
                (shown, message)
            })
            .collect();
        let new = self.new_node_files().into_iter();
        sentences.extend(new.map(|path| {
            let shown = path.display().to_string();
            (shown.clone(), format!("the node file {shown} is new since the bake"))
        }));
        sentences
    }

    /// Returns true if no file that the bake read has changed. `digest` returns the present hashes.
    pub(super) fn is_up_to_date(&self, mut digest: impl FnMut(&Path) -> Option<String>) -> bool {
        let is_same = |input: &InputRecord| digest(&path_of(&input.path)) == input.blake3;
        self.inputs.iter().all(is_same) && self.new_node_files().is_empty()
    }

    /// Returns the node files that did not exist during the bake.
    fn new_node_files(&self) -> Vec<PathBuf> {
        let is_known = |path: &Path| {
            let stored = stored_path(&absolute(path));
            self.inputs.iter().any(|input| input.path == stored)
        };
        let mut files = node_files(&path_of(&self.recipe.graph), &TrustedPaths::default());
        files.retain(|path| !is_known(path));
        files
    }

    /// Refuses to repeat a bake if files that it read have changed.
    pub fn refuse_changed_inputs(&self) -> Result<(), EngineError> {
        let changed = self.changed_inputs().into_iter();
        let mut changed: Vec<String> = changed.map(|(_, sentence)| sentence).collect();
        if changed.is_empty() {
            return Ok(());
        }
        let more = changed.len().saturating_sub(MOST_NAMED);
        changed.truncate(MOST_NAMED);
        if more > 0 {
            changed.push(format!("so it is with {more} more files"));
        }
        changed.push("the same maps cannot be made any more; bake with a command line of its own".to_owned());
        Err(EngineError::several(ErrorKind::BadInput, changed))
    }

    /// Returns sentences on the differences between the files of a repeated bake and of this one; empty if all bytes are the same.
    pub fn differences(&self, repeated: &BakeReport) -> Vec<String> {
        let now: Vec<(&str, &str)> = repeated.written_files().collect();
        let known: Vec<(&str, &str)> = self
            .files()
            .map(|file| (file.path.as_str(), file.blake3.as_str()))
            .collect();
        let of = |files: &[(&str, &str)], path: &str| {
            files
                .iter()
                .find(|(known, _)| *known == path)
                .map(|(_, blake3)| (*blake3).to_owned())
        };
        let mut sentences = Vec::new();
        for (path, blake3) in &known {
            match of(&now, path) {
                None => sentences.push(format!("{path} was not written again")),
                Some(other) if other != *blake3 => sentences.push(format!("{path} has other bytes than before")),
                Some(_) => {}
            }
        }
        let new = now.iter().filter(|(path, _)| of(&known, path).is_none());
        sentences.extend(new.map(|(path, _)| format!("{path} was not written before")));
        if !sentences.is_empty() && self.adapter != repeated.adapter {
            sentences.push(format!(
                "the report is of another adapter: {}, and this is {}",
                self.adapter.name, repeated.adapter.name
            ));
        }
        if !sentences.is_empty() && self.build != *Build::current() {
            sentences.push(format!(
                "the report is of another program: Sabi {} for {}",
                self.build.version, self.build.system
            ));
        }
        sentences
    }

    /// Returns the files in a folder that differ from those that the bake wrote, with a sentence each; empty if none does.
    pub(super) fn damaged_files(&self, folder: &Path) -> Vec<(String, String)> {
        let files: Vec<&RecordedFile> = self.files().collect();
        let damage = |file: &&RecordedFile| {
            let message = match digest(&folder.join(&file.path)) {
                None => format!("{} is missing or cannot be read", file.path),
                Some((_, found)) if found != file.blake3 => format!("{} is not as it was baked", file.path),
                Some(_) => return None,
            };
            Some((file.path.clone(), message))
        };
        files.par_iter().filter_map(damage).collect()
    }
}
