//! Manifest of an output folder: the bakes whose files are in it.
//!
//! It is written after all files of a bake are in place, so that every set in it is complete.

use std::collections::BTreeSet;
use std::fs::{Metadata, symlink_metadata};
use std::path::{Path, PathBuf};

use sabi_files::{Disk, FileLock, PathBase, Unread, WholeFile, absolute, read_plain, sweep};
use serde::Serialize;
use serde_json::{Value as Json, json};

use super::recorded_bake::{MOST_BYTES, RecordedBake};
use crate::baking::bake_request::BakeRequest;
use crate::baking::made_of::recipe::{Recipe, moved};
use crate::baking::report::{BakeReport, REPORT_VERSION};
use crate::error::{EngineError, ErrorKind};
use crate::phases::{Progress, stop_if_canceled};
use crate::program::Build;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Hidden folder in an output folder.
pub(super) const FOLDER: &str = ".sabi";
const FILE: &str = "bakes.json";
const LOCK: &str = "lock";

/// The bakes whose files are in a folder.
#[derive(Debug, Default)]
pub(crate) struct Manifest {
    /// Reports with paths relative to the folder.
    bakes: Vec<Json>,
}

/// Refuses an output folder whose hidden folder is a link, which would lead elsewhere, or whose lock is not an ordinary
/// file, since opening it could wait forever.
pub(crate) fn check_own_folder(folder: &Path) -> Result<(), EngineError> {
    let own = folder.join(FOLDER);
    let is_odd =
        |path: &Path, is_meant: fn(&Metadata) -> bool| symlink_metadata(path).is_ok_and(|found| !is_meant(&found));
    let odd = match () {
        () if is_odd(&own, Metadata::is_dir) => (own, "no folder but a link or a file"),
        () if is_odd(&own.join(LOCK), Metadata::is_file) => (own.join(LOCK), "no ordinary file but a link or a pipe"),
        () => return Ok(()),
    };
    let why = format!(
        "cannot write into {}: {} is {}; remove it",
        folder.display(),
        odd.0.display(),
        odd.1
    );
    Err(EngineError::new(ErrorKind::CannotWrite, why).with_remedies([Remedy::OtherFolder]))
}

/// Right to change the files of an output folder. Only one bake at a time has it.
pub(crate) struct FolderChange {
    disk: Disk,
    folder: PathBuf,
    /// Lock of the folder; `None` on file systems without locks.
    _lock: Option<FileLock>,
}

impl FolderChange {
    /// Waits until no other bake changes the files of the folder.
    ///
    /// # Errors
    /// The work was canceled, or the folder's own folder is a link or none.
    pub(crate) fn begin(disk: &Disk, folder: &Path, progress: &dyn Progress) -> Result<FolderChange, EngineError> {
        check_own_folder(folder)?;
        let own = folder.join(FOLDER);
        let (mut is_told, mut canceled) = (false, Ok(()));
        let lock = FileLock::wait(&own.join(LOCK), &mut || {
            if !is_told {
                progress.waits(&format!(
                    "waiting for another bake, which writes into {}",
                    folder.display()
                ));
                is_told = true;
            }
            canceled = stop_if_canceled(progress);
            canceled.is_ok()
        });
        canceled?;
        sweep(&own);
        Ok(FolderChange {
            disk: disk.clone(),
            folder: folder.to_owned(),
            // Without a lock, two bakes at the same moment could lose a record, but that is no reason to write no maps.
            _lock: lock.ok().flatten(),
        })
    }

    /// Records a bake whose files are in place. Warns of documents of earlier bakes that now name maps of this bake.
    pub(crate) fn record(self, report: &mut BakeReport) -> Result<(), EngineError> {
        // A damaged manifest counts as empty.
        let mut manifest = Manifest::read(&self.folder).unwrap_or_default();
        let stale = manifest.make_room(report, &base(&self.folder));
        report.warnings.extend(stale.into_iter().map(Warning::from));
        manifest.bakes.push(json_of(&report.placed(&base(&self.folder)))?);
        let json = json!({ "version": REPORT_VERSION, "bakes": manifest.bakes });
        let text = serde_json::to_string_pretty(&json).map_err(|error| EngineError::of(ErrorKind::Defect, error))?;
        let bytes = format!("{text}\n").into_bytes();
        // A link in its place is replaced and not followed.
        let mut file = WholeFile::create_on(&self.disk, &path(&self.folder))?;
        file.write(&bytes)?;
        Ok(file.commit()?)
    }

    /// Gives up the right without a record. Removes the hidden folder if it has no manifest.
    pub(crate) fn abandon(self) {
        let own = self.folder.join(FOLDER);
        if !path(&self.folder).exists() {
            // A folder that cannot be removed is hidden, and the next bake uses it.
            let _ = std::fs::remove_file(own.join(LOCK));
            let _ = std::fs::remove_dir(&own);
        }
    }
}

impl Manifest {
    /// Reads the manifest of a folder; an empty one if there is none. Returns the reason if a manifest is damaged.
    pub(super) fn read(folder: &Path) -> Result<Manifest, String> {
        // The manifest decides which files are read, also outside of the folder, so it must not be a link.
        if symlink_metadata(folder.join(FOLDER)).is_ok_and(|found| found.is_symlink()) {
            return Err("its folder is a link".to_owned());
        }
        let bytes = match read_plain(&path(folder), MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(Unread::Missing) => return Ok(Manifest::default()),
            Err(Unread::Other(reason)) => return Err(reason),
            Err(Unread::Folder | Unread::NotPlain | Unread::TooLarge(_) | Unread::Refused(_)) => {
                return Err("it is no file of records".to_owned());
            }
        };
        let json: Json = serde_json::from_slice(&bytes).map_err(|error| error.to_string())?;
        match json.get("bakes") {
            Some(Json::Array(bakes)) => Ok(Manifest { bakes: bakes.clone() }),
            _ => Err("it lists no bakes".to_owned()),
        }
    }

    /// Returns the bakes with absolute paths, or the reason why a bake cannot be read.
    pub(super) fn recorded(&self, folder: &Path) -> Result<Vec<RecordedBake>, String> {
        let base = base(folder);
        self.bakes.iter().map(|bake| RecordedBake::of(bake, &base)).collect()
    }

    /// Removes an earlier bake of the same set from the manifest, and files of the same names from other bakes. Returns
    /// sentences about remaining documents that name such files.
    fn make_room(&mut self, report: &BakeReport, base: &PathBase) -> Vec<String> {
        let report = report.placed(base);
        let written: BTreeSet<&str> = report.written_files().map(|(path, _)| path).collect();
        let mut stale = Vec::new();
        let recipe = report.recipe.clone();
        self.bakes.retain_mut(|earlier| {
            // A record that cannot be read counts as empty.
            let Ok(known) = RecordedBake::of(earlier, base) else {
                return false;
            };
            let count = known.files().count();
            let left = known
                .files()
                .filter(|file| !written.contains(file.path.as_str()))
                .count();
            // A bake whose names contain another seed or variant keeps all of its files.
            if left < count && is_same_set(&known.recipe, &recipe.clone().with_absolute_paths(base)) {
                return false;
            }
            if left < count {
                without_files(earlier, &written);
                stale.extend(known.documents().filter(|document| !written.contains(document)).map(|document| {
                    format!(
                        "{document} of an earlier bake names maps that this one has replaced; bake it again into a folder of its own, or \
                         remove it"
                    )
                }));
            }
            left > 0
        });
        stale
    }

    /// Returns a wanted bake by this program whose files are all in place.
    fn finished(&self, folder: &Path, mut is_wanted: impl FnMut(&RecordedBake) -> bool) -> Option<FinishedBake> {
        let base = base(folder);
        let recorded = self.bakes.iter().filter_map(|json| {
            let bake = RecordedBake::of(json, &base).ok()?;
            Some(FinishedBake {
                json: json.clone(),
                bake,
            })
        });
        let mut is_finished = |FinishedBake { bake, .. }: &FinishedBake| {
            !bake.partly_replaced
                && bake.build == *Build::current()
                && is_wanted(bake)
                && bake.damaged_files(folder).is_empty()
        };
        recorded.into_iter().find(|finished| is_finished(finished))
    }
}

/// A bake whose files are all in place.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedBake {
    json: Json,
    bake: RecordedBake,
}

impl FinishedBake {
    /// Files of the bake, relative to the output folder.
    pub fn files(&self) -> Vec<String> {
        self.bake.files().map(|file| file.path.clone()).collect()
    }

    /// Returns the warnings of the bake as sentences.
    pub fn warnings(&self) -> Vec<String> {
        let warnings = self.json["warnings"].as_array().into_iter().flatten();
        warnings
            .filter_map(|warning| Some(warning.as_str()?.to_owned()))
            .collect()
    }

    /// Returns the report of the bake for a file of a base, or with absolute paths if there is none.
    pub fn report(&self, base: Option<&PathBase>) -> Result<Json, EngineError> {
        let (mut recipe, mut inputs) = (self.bake.recipe.clone(), self.bake.inputs.clone());
        if let Some(base) = base {
            recipe = recipe.moved(base, base);
            for input in &mut inputs {
                input.path = moved(&input.path, base, base);
            }
        }
        let mut json = self.json.clone();
        json["recipe"] = json_of(&recipe)?;
        json["inputs"] = json_of(&inputs)?;
        json["up_to_date"] = Json::Bool(true);
        Ok(json)
    }
}

/// Returns the requested bake if its output folder has exactly the files that it would write, made by this program from
/// files that have not changed.
pub fn finished_bake(request: &BakeRequest) -> Option<FinishedBake> {
    let manifest = Manifest::read(&request.output).ok()?;
    let wanted = Recipe::of(request, None);
    let is_wanted = |bake: &RecordedBake| bake.recipe == wanted && bake.changed_inputs().is_empty();
    manifest.finished(&request.output, is_wanted)
}

/// Returns true if the output folder of a request has exactly the files that it would write, made on any adapter. `digest`
/// returns the present hashes of files.
pub fn is_finished_on_any_machine(request: &BakeRequest, mut digest: impl FnMut(&Path) -> Option<String>) -> bool {
    let wanted = Recipe::of(request, None).on_any_machine();
    let manifest = Manifest::read(&request.output).unwrap_or_default(); // A damaged manifest counts as empty.
    let is_wanted = |bake: &RecordedBake| bake.recipe.on_any_machine() == wanted && bake.is_up_to_date(&mut digest);
    manifest.finished(&request.output, is_wanted).is_some()
}

/// Converts a document to JSON. It goes through text, in which numbers of single precision have their shortest form.
fn json_of(document: &impl Serialize) -> Result<Json, EngineError> {
    let json = serde_json::to_string(document).and_then(|text| serde_json::from_str(&text));
    json.map_err(|error| EngineError::of(ErrorKind::Defect, error))
}

/// Returns true if two bakes write the files of the same set, so that the later replaces the earlier.
fn is_same_set(one: &Recipe, other: &Recipe) -> bool {
    let set = |recipe: &Recipe| {
        (
            recipe.graph.clone(),
            recipe.model.file.clone(),
            recipe.material.clone(),
            recipe.presets.clone(),
            recipe.names.clone(),
            recipe.channels.clone(),
        )
    };
    set(one) == set(other)
}

/// Removes files from a recorded bake, which is then no longer complete.
fn without_files(bake: &mut Json, written: &BTreeSet<&str>) {
    let is_left = |file: &Json| file["path"].as_str().is_some_and(|path| !written.contains(path));
    for list in ["outputs", "documents"] {
        if let Some(files) = bake.get_mut(list).and_then(Json::as_array_mut) {
            files.retain(is_left);
        }
    }
    if bake.get("model").is_some_and(|model| !is_left(model))
        && let Some(members) = bake.as_object_mut()
    {
        members.remove("model");
    }
    if let Some(files) = bake.get_mut("model").and_then(|model| model["files"].as_array_mut()) {
        files.retain(is_left);
    }
    bake["partly_replaced"] = Json::Bool(true);
}

/// Returns true if bakes into a folder were recorded.
pub(crate) fn has_record(folder: &Path) -> bool {
    path(folder).is_file()
}

/// The manifest's file.
pub(super) fn path(folder: &Path) -> PathBuf {
    folder.join(FOLDER).join(FILE)
}

/// Returns the base of the paths in the manifest of a folder.
fn base(folder: &Path) -> PathBase {
    PathBase::of_folder(absolute(folder))
}
