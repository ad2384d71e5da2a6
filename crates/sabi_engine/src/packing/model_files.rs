//! A model and the files that it names: vertex data, pictures, materials.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_files::{FolderSearch, PathBase, Refusal, TrustedPaths, Unread, Uri, read_plain, without_detours};
use sabi_surface::load::{LoadOptions, MAX_FILE_BYTES, PartChoice, gltf_json, load_bytes};

use super::entries::{is_picture, is_usual_ending};
use crate::error::{EngineError, ErrorKind};
use crate::opening::linked_model::SavedReading;
use crate::opening::memory::default_memory_bytes;

/// A model and the files that it names.
pub(super) struct ModelFiles {
    /// The model file.
    pub(super) path: PathBuf,
    /// Files that it names: the path from its folder at which it finds them, and their path on this machine.
    named: BTreeMap<String, PathBuf>,
    /// Missing files that it names, as written in the model.
    pub(super) missing: Vec<String>,
}

impl ModelFiles {
    /// Reads the file of a model and finds the files that it refers to, as far as it may open them.
    ///
    /// # Errors
    /// The model cannot be loaded, names two files that would have the same place, or names a file of a type that
    /// models do not use: a model from an unknown source must not make its user send other files along.
    pub(super) fn read(path: &Path, trusted: &TrustedPaths, reading: &SavedReading) -> Result<ModelFiles, EngineError> {
        let search = ModelFileSearch::of_model(path, trusted, reading)?;
        if let Some(refusal) = search.refused.first() {
            let refused = EngineError::refused(refusal);
            return Err(refused.map_messages(|why| format!("{} names a file that is not read: {why}", path.display())));
        }
        let shown = path.display();
        let refused = |why: String| EngineError::new(ErrorKind::BadInput, format!("{shown} names {why}"));
        if let Some((file, advice)) = &search.strange {
            return Err(refused(format!("{}, {advice}", file.display())));
        }
        Ok(ModelFiles {
            path: path.to_owned(),
            missing: search.missing(),
            named: placed(search.named).map_err(refused)?,
        })
    }

    /// Returns true if it names no other files.
    pub(super) fn is_alone(&self) -> bool {
        self.named.is_empty()
    }

    /// Returns the largest number of folders that its paths lead up from its own.
    pub(super) fn levels_up(&self) -> usize {
        let up = |place: &String| place.split('/').take_while(|part| *part == "..").count();
        self.named.keys().map(up).max().unwrap_or(0)
    }

    /// Returns the names of its files in an archive, the model's first, if the model is in this folder of the archive.
    pub(super) fn placed_in(&self, folder: &str) -> Vec<(PathBuf, String)> {
        let own = self
            .path
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let named = self.named.iter().map(|(place, path)| (path.clone(), place.clone()));
        let all = std::iter::once((self.path.clone(), own)).chain(named);
        all.map(|(path, place)| (path, joined(folder, &place))).collect()
    }
}

/// Returns a model's file by its name, and those that it names as it writes them. Files that are missing are left out.
///
/// # Errors
/// The model cannot be loaded.
pub(crate) fn files_of_model(path: &Path, trusted: &TrustedPaths) -> Result<BTreeMap<String, PathBuf>, EngineError> {
    let whole = SavedReading {
        parts: PartChoice::all(),
        ..SavedReading::default()
    };
    let mut files = ModelFileSearch::of_model(path, trusted, &whole)?.named;
    let own = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    files.insert(own.into_owned(), path.to_owned());
    Ok(files)
}

/// Returns files by the paths from the model's folder at which the model finds them, or a sentence about two files with the same path.
fn placed(named: BTreeMap<String, PathBuf>) -> Result<BTreeMap<String, PathBuf>, String> {
    let mut placed: BTreeMap<String, PathBuf> = BTreeMap::new();
    for (written, found) in named {
        let place = place_of(&written);
        if let Some(other) = placed.get(&place).filter(|other| **other != found) {
            return Err(format!(
                "{} and {}, which would both be {place} elsewhere; give one of them another name",
                other.display(),
                found.display()
            ));
        }
        placed.insert(place, found);
    }
    Ok(placed)
}

/// Files that were looked for.
struct ModelFileSearch<'t> {
    base: PathBase,
    trusted: &'t TrustedPaths,
    /// Folder in which files are searched that are not where the model expects them.
    elsewhere: Option<FolderSearch>,
    refused: Vec<Refusal>,
    named: BTreeMap<String, PathBuf>,
    missing: Vec<String>,
    /// A file that does not belong to a model, with advice.
    strange: Option<(PathBuf, &'static str)>,
}

impl<'t> ModelFileSearch<'t> {
    /// Reads a model, and looks for the files that it names.
    fn of_model(
        path: &Path,
        trusted: &'t TrustedPaths,
        reading: &SavedReading,
    ) -> Result<ModelFileSearch<'t>, EngineError> {
        let shown = path.display();
        let bytes = read_plain(path, MAX_FILE_BYTES).map_err(|unread| match unread {
            Unread::Missing => EngineError::new(
                ErrorKind::MissingInput,
                format!("{shown}: there is no such file; check the path"),
            ),
            _ => EngineError::new(
                ErrorKind::BadInput,
                format!("{shown}: the file cannot be read as a model"),
            ),
        })?;
        let mut search = ModelFileSearch {
            base: PathBase::of_file(path),
            trusted,
            elsewhere: reading.textures.as_deref().map(FolderSearch::new),
            refused: Vec::new(),
            named: BTreeMap::new(),
            missing: Vec::new(),
            strange: None,
        };
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let options = LoadOptions {
            parts: reading.parts.clone(),
            memory_bytes: default_memory_bytes(),
            ..LoadOptions::default()
        };
        let loaded = load_bytes(&name, &bytes, &mut |written| search.find(written), &options);
        // The error about a file that may not be opened explains more than one about the parts that are missing without it.
        if search.refused.is_empty() {
            loaded?;
        }
        search.forget_own_library(path, &bytes);
        // Those that no material shows are copied with the model by a bake.
        for uri in uris(&bytes) {
            if let Uri::Beside(decoded) = Uri::parse(&uri) {
                let _ = search.find(&decoded).or_else(|_| search.find(&uri));
            }
        }
        Ok(search)
    }

    /// Forgets that the material library with the model's own name is missing, which the reader of OBJ looks for although the file does
    /// not name it.
    fn forget_own_library(&mut self, path: &Path, bytes: &[u8]) {
        let Some(library) = path.file_stem().map(|stem| format!("{}.mtl", stem.to_string_lossy())) else {
            return;
        };
        let is_named = bytes.windows(library.len()).any(|part| part == library.as_bytes());
        if !is_named {
            self.missing.retain(|missing| *missing != library);
        }
    }

    fn find(&mut self, written: &str) -> Result<Vec<u8>, String> {
        let read = match (
            self.trusted.read_of_model(&self.base, written, MAX_FILE_BYTES),
            &mut self.elsewhere,
        ) {
            (Err(Unread::Missing), Some(elsewhere)) => elsewhere.find(self.trusted, written).and_then(|place| {
                let bytes = self.trusted.read_found(&place, MAX_FILE_BYTES)?;
                Ok((bytes, place))
            }),
            (read, _) => read,
        };
        match read {
            Ok((bytes, place)) => {
                if let Some(advice) = self.strangeness(&place).filter(|_| !is_picture(written, &bytes)) {
                    self.strange.get_or_insert((place.clone(), advice));
                }
                self.named.insert(written.to_owned(), without_detours(&place));
                return Ok(bytes);
            }
            Err(Unread::Missing) => {}
            Err(Unread::Refused(refusal)) => {
                let why = refusal.to_string();
                self.refused.push(refusal);
                return Err(why);
            }
            Err(_) => return Err("it cannot be read".to_owned()),
        }
        if !self.missing.iter().any(|known| known == written) {
            self.missing.push(written.to_owned());
        }
        Err("there is no such file".to_owned())
    }

    /// Returns the reason, with advice, why a file that is not a picture does not belong to a model; `None` for data of a model.
    fn strangeness(&self, file: &Path) -> Option<&'static str> {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        if !self.base.is_above(file) {
            Some("which is outside of its folder and no picture; copy it into the folder if it belongs to the model")
        } else if ending.is_none_or(|ending| !is_usual_ending(&ending)) {
            Some(
                "which is no picture, and does not end in .bin or .mtl as data of a model does; rename it if it belongs to the model",
            )
        } else {
            None
        }
    }

    /// Returns paths that led nowhere. A file that was found with another spelling is not missing.
    fn missing(&self) -> Vec<String> {
        let is_spelled = |written: &str| {
            let spellings = self.named.keys().chain(&self.missing).filter(|other| *other != written);
            let mut decoded = spellings.map(|other| Uri::parse(other));
            let is_it = |uri: Uri<'_>| matches!(uri, Uri::Beside(path) if path == written);
            decoded.any(is_it)
        };
        let missing = self.missing.iter().filter(|written| !is_spelled(written));
        missing.cloned().collect()
    }
}

/// Returns URIs of buffers and pictures of a glTF file; none for other files.
fn uris(bytes: &[u8]) -> Vec<String> {
    let json = match bytes.strip_prefix(b"glTF") {
        // A header of 12 bytes, of which 4 have been read, then the length and type of the first chunk, and the chunk.
        Some(rest) => {
            let length = rest
                .get(8..12)
                .and_then(|length| length.try_into().ok())
                .map(u32::from_le_bytes);
            length.and_then(|length| rest.get(16..)?.get(..length as usize))
        }
        None => Some(bytes),
    };
    let Some(Ok(document)) = json.map(gltf_json) else {
        return Vec::new();
    };
    let lists = ["buffers", "images"]
        .into_iter()
        .filter_map(|list| document.get(list)?.as_array());
    let uris = lists.flatten().filter_map(|entry| entry.get("uri")?.as_str());
    uris.map(str::to_owned).collect()
}

/// Returns the path from the model's folder at which the model finds a file that it names. On another machine, an absolute
/// path leads nowhere, and the bare name is searched beside the model.
fn place_of(written: &str) -> String {
    let slashed = written.replace('\\', "/");
    let has_drive = slashed.as_bytes().get(1) == Some(&b':');
    if slashed.starts_with('/') || has_drive {
        return slashed.rsplit('/').next().unwrap_or(&slashed).to_owned();
    }
    let direct = without_detours(Path::new(&slashed));
    direct.to_string_lossy().replace('\\', "/")
}

/// Returns the name of a path from a folder of the archive. `..` leads to the parent folder.
fn joined(folder: &str, place: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in place.split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}
