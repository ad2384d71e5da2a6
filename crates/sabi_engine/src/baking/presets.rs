//! Presets by name: built-in presets, those of the user's folder, and files.

use std::path::{Path, PathBuf};

use sabi_export::preset::{BUILTIN_NAMES, Preset, builtin, builtin_text};
use sabi_files::{Unread, read_plain};

use crate::error::{EngineError, ErrorKind};
use crate::opening::own_folder::own_folder;

/// Most bytes of a preset's file.
const MOST_BYTES: u64 = 1 << 20;
/// Ending of preset files.
const ENDING: &str = "toml";

/// A preset as it is listed.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedPreset {
    /// Name on the command line.
    pub name: String,
    /// File of a preset of the user; `None` for built-in presets.
    pub file: Option<PathBuf>,
    /// The preset, or the reason why its file cannot be used.
    pub preset: Result<Preset, String>,
}

/// Returns the folder of the user's own presets: `SABI_PRESETS`, otherwise `sabi/presets` in the system's folder for settings.
pub fn default_preset_folder() -> Option<PathBuf> {
    own_folder("SABI_PRESETS", "presets")
}

/// Lists the built-in presets, the default first, and then those of a folder sorted by name.
pub fn export_presets(folder: Option<&Path>) -> Vec<ListedPreset> {
    let of_sabi = BUILTIN_NAMES.into_iter().filter_map(|name| {
        Some(ListedPreset {
            name: name.to_owned(),
            file: None,
            preset: builtin(name)?.map_err(|error| error.to_string()),
        })
    });
    let own = own_files(folder).into_iter().map(|(name, file)| ListedPreset {
        preset: read(&file).map_err(|error| error.to_string()),
        name,
        file: Some(file),
    });
    of_sabi.chain(own).collect()
}

/// Returns the text of a preset's file, given by name or path as for [`find_preset`].
pub fn preset_text(name: &str, folder: Option<&Path>) -> Result<String, EngineError> {
    match builtin_text(name) {
        Some(text) => Ok(text.to_owned()),
        None => text_of(&file_of(name, folder)?),
    }
}

/// Finds a preset: a built-in one, one of the user's folder by its file's name, or a file by its path.
pub fn find_preset(name: &str, folder: Option<&Path>) -> Result<Preset, EngineError> {
    match builtin(name) {
        Some(read) => read.map_err(|error| EngineError::of(ErrorKind::Defect, error)),
        None => read(&file_of(name, folder)?),
    }
}

/// Returns the files of these presets, which are given as for [`find_preset`]. Built-in presets have no file.
pub fn preset_files(names: &[String], folder: Option<&Path>) -> Result<Vec<PathBuf>, EngineError> {
    let own = names.iter().filter(|name| builtin_text(name).is_none());
    own.map(|name| file_of(name, folder)).collect()
}

/// Reads a preset's file.
fn read(file: &Path) -> Result<Preset, EngineError> {
    let text = text_of(file)?;
    let parsed = Preset::parse(&file.display().to_string(), &text);
    parsed.map_err(|error| EngineError::of(ErrorKind::BadInput, error))
}

fn text_of(file: &Path) -> Result<String, EngineError> {
    let fault = |kind, why: &str| EngineError::new(kind, format!("the preset {} {why}", file.display()));
    let bytes = read_plain(file, MOST_BYTES).map_err(|unread| match unread {
        Unread::Missing => fault(ErrorKind::MissingInput, "does not exist; check the path"),
        Unread::Folder | Unread::NotPlain => fault(ErrorKind::BadInput, "is a folder or a device, not a file"),
        Unread::TooLarge(_) => fault(ErrorKind::BadInput, "is no preset: it has more than 1 MiB"),
        Unread::Refused(refusal) => fault(ErrorKind::MissingInput, &format!("is not read: {refusal}")),
        Unread::Other(reason) => fault(ErrorKind::MissingInput, &format!("cannot be read: {reason}")),
    })?;
    String::from_utf8(bytes).map_err(|_| fault(ErrorKind::BadInput, "is no text; save it as UTF-8"))
}

/// Returns the file of a preset that is not built in.
fn file_of(name: &str, folder: Option<&Path>) -> Result<PathBuf, EngineError> {
    let own = own_files(folder);
    if let Some((_, file)) = own.iter().find(|(known, _)| known == name) {
        return Ok(file.clone());
    }
    let path = Path::new(name);
    if path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
    {
        return Ok(path.to_owned());
    }
    let known: Vec<&str> = BUILTIN_NAMES
        .into_iter()
        .chain(own.iter().map(|(name, _)| name.as_str()))
        .collect();
    let why = format!(
        "there is no preset '{name}'; there is: {}, or give the path of a .toml file",
        known.join(", ")
    );
    Err(EngineError::new(ErrorKind::Usage, why))
}

/// Returns the preset files of a folder with their names, sorted by name; empty if the folder cannot be read.
fn own_files(folder: Option<&Path>) -> Vec<(String, PathBuf)> {
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    let paths = entries
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()));
    let is_preset = |path: &PathBuf| {
        path.extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
    };
    let mut found: Vec<(String, PathBuf)> = paths
        .filter(is_preset)
        .filter_map(|path| Some((path.file_stem()?.to_string_lossy().into_owned(), path)))
        .filter(|(name, _)| builtin_text(name).is_none())
        .collect();
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: &str =
        "version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\nname = \"a\"\ngray = \"height\"\nformat = \"png8\"\n";

    #[test]
    fn presets_are_found_by_name_in_the_users_folder_and_by_path() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("studio.toml");
        std::fs::write(&file, OWN).expect("written");
        std::fs::write(folder.path().join("broken.toml"), "version = 1").expect("written");
        std::fs::write(folder.path().join("raw.toml"), OWN).expect("written");
        let own = Some(folder.path());
        assert_eq!(find_preset("studio", own).map(|preset| preset.maps.len()), Ok(1));
        assert_eq!(
            find_preset(&file.to_string_lossy(), None).map(|preset| preset.name),
            Ok("own".to_owned())
        );
        assert_eq!(
            find_preset("raw", own).map(|preset| preset.name),
            Ok("raw".to_owned()),
            "Sabi's own"
        );
        assert_eq!(preset_text("studio", own).as_deref(), Ok(OWN));
        let listed = export_presets(own);
        let names: Vec<&str> = listed.iter().map(|listed| listed.name.as_str()).collect();
        assert_eq!(names[..BUILTIN_NAMES.len()], BUILTIN_NAMES);
        assert_eq!(names[BUILTIN_NAMES.len()..], ["broken", "studio"]);
        assert!(listed[BUILTIN_NAMES.len()].preset.is_err());
    }

    #[test]
    fn an_error_for_an_unknown_preset_lists_those_that_exist() {
        let told = |name: &str| find_preset(name, None).expect_err("unknown").to_string();
        assert_eq!(
            told("unrael"),
            "there is no preset 'unrael'; there is: raw, gltf, unreal, unity, godot, blender, materialx, usd, mesh, or \
             give the path of a .toml file"
        );
        assert_eq!(told("gone.toml"), "the preset gone.toml does not exist; check the path");
    }
}
