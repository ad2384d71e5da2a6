//! Settings: looks, keys, layout and recent files, kept between runs.

pub(crate) mod brush;
pub(crate) mod export;
pub(crate) mod stencil;
pub(crate) mod viewport;

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sabi_engine::{stored, write_whole};
use serde_json::Value as Json;

use crate::command::InputPreset;
use crate::dock::Layout;
use crate::import_options::ImportOptions;
use crate::paths::canonical_if_present;
use crate::theme::Shade;
use brush::BrushChoices;
use export::{ExportChoices, ExportPlace};
use stencil::StencilChoices;
use viewport::ViewChoices;

const FILE: &str = "settings.json";
const BACKUP: &str = "settings.json.bak";
/// Files that are remembered.
const MOST_RECENT: usize = 12;
/// Colors of the brush that are remembered.
const MOST_COLORS: usize = 8;
/// Files and folders that are trusted.
const MOST_TRUSTED: usize = 256;
/// Models on the strip.
pub(crate) const MOST_MODELS: usize = 24;

/// Settings that are kept between runs.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    pub(crate) shade: Shade,
    /// Factor of the size of everything.
    pub(crate) scale: f32,
    #[serde(rename = "habit")]
    pub(crate) input_preset: InputPreset,
    /// Keys of commands that have others than the preset's, by the command's name.
    pub(crate) keys: BTreeMap<String, Vec<String>>,
    /// Recent graph files, the last one first.
    #[serde(with = "stored::list")]
    pub(crate) recent: Vec<PathBuf>,
    /// Models on the strip above the viewport.
    #[serde(with = "stored::list")]
    pub(crate) models: Vec<PathBuf>,
    /// Files and folders that graphs and models may open, the last ones first.
    #[serde(with = "stored::list")]
    pub(crate) trusted: Vec<PathBuf>,
    /// Folders of node files beside graphs that are used.
    #[serde(with = "stored::list")]
    pub(crate) trusted_nodes: Vec<PathBuf>,
    /// Options for reading models that differ from the default.
    #[serde(with = "stored::map")]
    pub(crate) readings: BTreeMap<PathBuf, ImportOptions>,
    /// True if node pictures show texture space.
    pub(crate) is_flat: bool,
    pub(crate) export: ExportChoices,
    /// Export targets of recent graphs.
    #[serde(with = "stored::map")]
    pub(crate) export_places: BTreeMap<PathBuf, ExportPlace>,
    /// Environment of the viewport: a built-in name, or a file.
    pub(crate) environment: String,
    /// Light and picture of the viewport.
    pub(crate) view: ViewChoices,
    pub(crate) brush: BrushChoices,
    pub(crate) stencil: StencilChoices,
    /// Linear colors that were painted, the last one first.
    pub(crate) brush_colors: Vec<[f32; 3]>,
    /// True if the model shows the clicked node, and not only the outputs.
    pub(crate) follows: bool,
    pub(crate) has_mini_map: bool,
    pub(crate) layout: Option<Layout>,
    /// Keys of node kinds, groups and library files that are shown first.
    pub(crate) favorites: Vec<String>,
    /// True if the library shows effects on the open model, as it does until that is chosen.
    pub(crate) tries_effects: Option<bool>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            shade: Shade::Dark,
            scale: 1.0,
            input_preset: InputPreset::Default,
            keys: BTreeMap::new(),
            recent: Vec::new(),
            models: Vec::new(),
            trusted: Vec::new(),
            trusted_nodes: Vec::new(),
            readings: BTreeMap::new(),
            is_flat: false,
            export: ExportChoices::default(),
            export_places: BTreeMap::new(),
            environment: "studio".to_owned(),
            view: ViewChoices::default(),
            brush: BrushChoices::default(),
            stencil: StencilChoices::default(),
            brush_colors: Vec::new(),
            follows: true,
            has_mini_map: false,
            layout: None,
            favorites: Vec::new(),
            tries_effects: None,
        }
    }
}

impl Settings {
    /// Settings in a folder; those of a new installation with a sentence where they cannot be read.
    pub(crate) fn load(folder: Option<&Path>) -> (Settings, Option<String>) {
        let read = match folder.map(|folder| fs::read_to_string(folder.join(FILE))) {
            None => return (Settings::default(), None),
            Some(Err(error)) if error.kind() == ErrorKind::NotFound => return (Settings::default(), None),
            Some(Err(error)) => Err(error.to_string()),
            Some(Ok(text)) => serde_json::from_str::<Settings>(&text).map_err(|error| error.to_string()),
        };
        match read {
            Ok(settings) => (settings.sanitized(), None),
            Err(error) => {
                // The next save must not overwrite it: it may be of a newer version.
                let aside = folder.map(|folder| fs::rename(folder.join(FILE), folder.join(BACKUP)));
                let place = match aside {
                    Some(Ok(())) => format!(" The others are in {BACKUP}."),
                    _ => String::new(),
                };
                let why = format!(
                    "The settings could not be read ({error}), so that those of a new installation are used.{place}"
                );
                (Settings::default(), Some(why))
            }
        }
    }

    /// Remembers the color of the brush as the one that was painted last.
    pub(crate) fn remember_brush_color(&mut self) {
        let color = self.brush.color;
        self.brush_colors.retain(|known| *known != color);
        self.brush_colors.insert(0, color);
        self.brush_colors.truncate(MOST_COLORS);
    }

    /// Saves the settings that differ from `before`. The others stay as another window has saved them since.
    ///
    /// # Errors
    /// A sentence, where the file cannot be written.
    pub(crate) fn save(&self, folder: &Path, before: &Json) -> Result<(), String> {
        let file = folder.join(FILE);
        let mut kept = match fs::read(&file).map(|bytes| serde_json::from_slice(&bytes)) {
            Ok(Ok(Json::Object(kept))) => kept,
            _ => serde_json::Map::new(),
        };
        if let Json::Object(now) = self.to_json() {
            for (name, value) in now {
                if before.get(&name) != Some(&value) || !kept.contains_key(&name) {
                    kept.insert(name, value);
                }
            }
        }
        let text = format!("{:#}", Json::Object(kept));
        write_whole(&file, text.as_bytes()).map_err(|error| {
            format!(
                "the settings cannot be kept in {}: {}",
                folder.display(),
                error.reason()
            )
        })
    }

    /// Settings as the file has them.
    pub(crate) fn to_json(&self) -> Json {
        // Cannot fail: every field has a form in JSON, and maps have text as keys.
        serde_json::to_value(self).unwrap_or_default()
    }

    /// Puts a graph file first among the recent ones.
    pub(crate) fn remember(&mut self, file: &Path) {
        let file = canonical_if_present(file);
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.recent.truncate(MOST_RECENT);
    }

    /// Export target of a graph.
    pub(crate) fn export_place(&self, graph: &Path) -> ExportPlace {
        let file = canonical_if_present(graph);
        // A graph that was never exported has an empty target.
        self.export_places.get(&file).cloned().unwrap_or_default()
    }

    /// Remembers the export target of a graph, and forgets those of graphs that are no longer recent.
    pub(crate) fn remember_export(&mut self, graph: &Path, place: &ExportPlace) {
        let file = canonical_if_present(graph);
        self.export_places.insert(file.clone(), place.clone());
        let recent = &self.recent;
        self.export_places
            .retain(|graph, _| *graph == file || recent.contains(graph));
    }

    /// Trusts a file or folder from now on; of very many, those that were trusted long ago are forgotten.
    pub(crate) fn trust(&mut self, path: &Path) {
        remember_path(&mut self.trusted, path);
    }

    /// Uses the node files of a folder from now on.
    pub(crate) fn trust_nodes(&mut self, folder: &Path) {
        remember_path(&mut self.trusted_nodes, folder);
    }

    /// Options for reading a model.
    pub(crate) fn reading(&self, model: &Path) -> ImportOptions {
        let known = self.readings.get(&canonical_if_present(model)).copied();
        // A model without options of its own is read with the default.
        known.unwrap_or_default()
    }

    /// Remembers the options for reading a model.
    pub(crate) fn remember_reading(&mut self, model: &Path, reading: ImportOptions) {
        let model = canonical_if_present(model);
        if reading == ImportOptions::default() {
            self.readings.remove(&model);
        } else {
            self.readings.insert(model, reading);
        }
    }

    fn sanitized(mut self) -> Settings {
        self.scale = if self.scale.is_finite() {
            self.scale.clamp(0.5, 3.0)
        } else {
            1.0
        };
        self.models.truncate(MOST_MODELS);
        self.recent.truncate(MOST_RECENT);
        self.export = self.export.sanitized();
        self.view = self.view.sanitized();
        self.brush = self.brush.sanitized();
        self.stencil = self.stencil.sanitized();
        self.readings
            .values_mut()
            .for_each(|reading| *reading = reading.sanitized());
        self
    }
}

/// Folder of the settings of this user.
pub(crate) fn default_folder() -> Option<PathBuf> {
    let set = |name: &str| {
        std::env::var_os(name)
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
    };
    let home = || set("HOME");
    let base = if cfg!(windows) {
        set("APPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|home| home.join("Library/Application Support"))
    } else {
        set("XDG_CONFIG_HOME").or_else(|| home().map(|home| home.join(".config")))
    };
    base.map(|base| base.join("sabi"))
}

fn remember_path(paths: &mut Vec<PathBuf>, path: &Path) {
    let path = canonical_if_present(path);
    paths.retain(|known| *known != path);
    paths.insert(0, path);
    paths.truncate(MOST_TRUSTED);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut kept = Settings {
            scale: 1.5,
            input_preset: InputPreset::Blender,
            ..Settings::default()
        };
        kept.remember(Path::new("one.sabi"));
        kept.remember(Path::new("two.sabi"));
        kept.remember(Path::new("one.sabi"));
        kept.save(folder.path(), &Json::Null).expect("saved");
        let (read, fault) = Settings::load(Some(folder.path()));
        assert_eq!(fault, None);
        assert_eq!((read.scale, read.input_preset), (1.5, InputPreset::Blender));
        assert_eq!(read.recent, [PathBuf::from("one.sabi"), PathBuf::from("two.sabi")]);
    }

    #[cfg(unix)]
    #[test]
    fn settings_with_a_path_that_is_not_utf_8_come_back() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().expect("a folder");
        let file = Path::new(std::ffi::OsStr::from_bytes(b"/no such folder/a\xff.sabi"));
        let mut kept = Settings::default();
        kept.remember(file);
        kept.models.push(file.to_owned());
        kept.remember_export(file, &ExportPlace::default());
        kept.readings.insert(file.to_owned(), ImportOptions::default());
        kept.save(folder.path(), &Json::Null).expect("saved");
        let (read, fault) = Settings::load(Some(folder.path()));
        assert_eq!(fault, None);
        assert_eq!(
            (read.recent.as_slice(), read.models.as_slice()),
            ([file.to_owned()].as_slice(), [file.to_owned()].as_slice())
        );
        assert!(read.export_places.contains_key(file) && read.readings.contains_key(file));
    }

    #[test]
    fn settings_that_cannot_be_read_are_said_put_aside_and_begun_anew() {
        for damaged in [b"{ \"scale\": \"huge\" }".as_slice(), b"{ \"scale\": 1.5 \xff }"] {
            let folder = tempfile::tempdir().expect("a folder");
            fs::write(folder.path().join(FILE), damaged).expect("written");
            let (read, fault) = Settings::load(Some(folder.path()));
            assert_eq!(read.scale, 1.0);
            assert!(fault.expect("a sentence").starts_with("The settings could not be read"));
            assert_eq!(fs::read(folder.path().join(BACKUP)).expect("a file"), damaged);
        }
    }

    #[test]
    fn two_windows_keep_what_each_of_them_changed() {
        let folder = tempfile::tempdir().expect("a folder");
        let began = Settings::default();
        let (mut one, mut other) = (began.clone(), began.clone());
        one.input_preset = InputPreset::Blender;
        one.save(folder.path(), &began.to_json()).expect("saved");
        other.scale = 1.5;
        other.save(folder.path(), &began.to_json()).expect("saved");
        let (read, _) = Settings::load(Some(folder.path()));
        assert_eq!((read.scale, read.input_preset), (1.5, InputPreset::Blender));
    }

    #[test]
    fn what_a_newer_version_keeps_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(FILE), r#"{ "scale": 2.0, "newer": [1] }"#).expect("written");
        let (read, _) = Settings::load(Some(folder.path()));
        let changed = Settings {
            scale: 1.5,
            ..read.clone()
        };
        changed.save(folder.path(), &read.to_json()).expect("saved");
        let text = fs::read_to_string(folder.path().join(FILE)).expect("a file");
        let kept: Json = serde_json::from_str(&text).expect("settings");
        assert_eq!((&kept["newer"][0], &kept["scale"]), (&Json::from(1), &Json::from(1.5)));
    }
}
