//! Settings: looks, keys, layout and recent files, kept between runs.

pub(crate) mod brush;
pub(crate) mod export;
mod merging;
pub(crate) mod stencil;
pub(crate) mod text_font;
pub(crate) mod viewport;

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sabi_engine::session::BACKUPS;
use sabi_files::{path_encoding, write_whole};
use serde_json::Value as Json;

use crate::command::InputPreset;
use crate::dock::Layout;
use crate::import_options::ImportOptions;
use crate::paths::canonical_if_present;
use crate::theme::ColorScheme;
use brush::BrushChoices;
use export::{ExportChoices, ExportPlace};
use merging::merged;
use stencil::StencilChoices;
use text_font::TextFont;
use viewport::ViewChoices;

const FILE: &str = "settings.json";
const ASIDE: &str = "settings.json.bak";
/// Most graph files that are remembered.
const MOST_RECENT: usize = 12;
/// Most colors of the brush that are remembered.
const MOST_COLORS: usize = 8;
/// Most backups of a graph file.
const MOST_BACKUPS: usize = 9;
/// Most files and folders that are trusted.
const MOST_TRUSTED: usize = 256;
/// Most models on a strip, and among those that are remembered.
pub(crate) const MOST_MODELS: usize = 24;

/// Settings that are kept between runs.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    pub(crate) shade: ColorScheme,
    /// Factor of the size of everything.
    pub(crate) scale: f32,
    #[serde(rename = "habit")]
    pub(crate) input_preset: InputPreset,
    /// Number of backups that are kept of a graph file.
    pub(crate) backups: usize,
    /// Keys of commands that have others than the preset's, by the command's name.
    pub(crate) keys: BTreeMap<String, Vec<String>>,
    /// Recent graph files, the last one first.
    #[serde(with = "path_encoding::list")]
    pub(crate) recent: Vec<PathBuf>,
    /// Models that were shown, the last ones last.
    #[serde(with = "path_encoding::list")]
    pub(crate) models: Vec<PathBuf>,
    /// Models on the strip above the viewport, by the file of the graph that they are shown with.
    #[serde(with = "path_encoding::map")]
    pub(crate) model_strips: BTreeMap<PathBuf, ModelStrip>,
    /// Files and folders that graphs and models may open, the last ones first.
    #[serde(with = "path_encoding::list")]
    pub(crate) trusted: Vec<PathBuf>,
    /// Folders of node files beside graphs that are used.
    #[serde(with = "path_encoding::list")]
    pub(crate) trusted_nodes: Vec<PathBuf>,
    /// Options for reading models that differ from the default.
    #[serde(with = "path_encoding::map")]
    pub(crate) readings: BTreeMap<PathBuf, ImportOptions>,
    /// True if node pictures show texture space.
    pub(crate) is_flat: bool,
    pub(crate) export: ExportChoices,
    /// Export targets of recent graphs.
    #[serde(with = "path_encoding::map")]
    pub(crate) export_places: BTreeMap<PathBuf, ExportPlace>,
    /// Environment of the viewport: a built-in name, or a file.
    pub(crate) environment: String,
    /// Light and picture of the viewport.
    pub(crate) view: ViewChoices,
    pub(crate) brush: BrushChoices,
    /// Font of texts that the brush stamps.
    pub(crate) text_font: TextFont,
    pub(crate) stencil: StencilChoices,
    /// Linear colors that were painted, the last one first.
    pub(crate) brush_colors: Vec<[f32; 3]>,
    /// True if the model shows the clicked node, and not only the outputs.
    pub(crate) follows: bool,
    pub(crate) has_mini_map: bool,
    pub(crate) layout: Option<Layout>,
    /// Keys of node kinds, groups and library files that are shown first.
    pub(crate) favorites: Vec<String>,
    /// True if the library shows effects on the open model. `None` until the user chooses, which counts as true.
    pub(crate) tries_effects: Option<bool>,
}

/// Models on the strip above the viewport, in its order.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ModelStrip {
    #[serde(with = "path_encoding::list")]
    pub(crate) files: Vec<PathBuf>,
}

impl ModelStrip {
    /// Puts a model at the end, unless it is on the strip already.
    pub(crate) fn add(&mut self, model: &Path) {
        if !self.files.iter().any(|known| known == model) {
            self.files.push(model.to_owned());
        }
        if self.files.len() > MOST_MODELS {
            self.files.remove(0);
        }
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            shade: ColorScheme::Dark,
            scale: 1.0,
            input_preset: InputPreset::Default,
            backups: BACKUPS,
            keys: BTreeMap::new(),
            recent: Vec::new(),
            models: Vec::new(),
            model_strips: BTreeMap::new(),
            trusted: Vec::new(),
            trusted_nodes: Vec::new(),
            readings: BTreeMap::new(),
            is_flat: false,
            export: ExportChoices::default(),
            export_places: BTreeMap::new(),
            environment: "studio".to_owned(),
            view: ViewChoices::default(),
            brush: BrushChoices::default(),
            text_font: TextFont::default(),
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
    /// Reads the settings in a folder. Where they cannot be read, returns those of a new installation, with a sentence
    /// about why.
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
                let aside = folder.map(|folder| fs::rename(folder.join(FILE), folder.join(ASIDE)));
                let place = match aside {
                    Some(Ok(())) => format!(" The others are in {ASIDE}."),
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

    /// Saves the settings that differ from `before`. Settings that another window has saved since are kept, unless this
    /// one has changed the same. A file that cannot be read as settings is put aside; a sentence says so.
    ///
    /// # Errors
    /// The file cannot be written; the error is a sentence, and the file is unchanged.
    pub(crate) fn save(&self, folder: &Path, before: &Json) -> Result<Option<String>, String> {
        let file = folder.join(FILE);
        let refused = |why: String| format!("the settings cannot be kept in {}: {why}", folder.display());
        let write = |name: &str, bytes: &[u8]| {
            let written = write_whole(&folder.join(name), bytes);
            written.map_err(|error| refused(error.reason()))
        };
        let mut told = None;
        let found = match fs::read(&file) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(refused(error.to_string())),
        };
        let theirs = match serde_json::from_slice(&found) {
            Ok(Json::Object(theirs)) => theirs,
            _ => {
                if !found.is_empty() {
                    write(ASIDE, &found)?;
                    told = Some(format!(
                        "Another program has damaged the settings, which were saved again. What it wrote is in {ASIDE}."
                    ));
                }
                serde_json::Map::new()
            }
        };
        write(FILE, format!("{:#}", merged(before, self.to_json(), theirs)).as_bytes())?;
        Ok(told)
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

    /// Models that are shown with a graph; empty if it was never open here.
    pub(crate) fn model_strip(&self, graph: &Path) -> ModelStrip {
        let strip = self.model_strips.get(&canonical_if_present(graph));
        strip.cloned().unwrap_or_default() // A new strip begins with the model of the graph.
    }

    /// Remembers the models that are shown with a graph, and forgets those of graphs that are no longer recent.
    pub(crate) fn remember_model_strip(&mut self, graph: &Path, strip: &ModelStrip) {
        let file = canonical_if_present(graph);
        self.model_strips.insert(file.clone(), strip.clone());
        let recent = &self.recent;
        self.model_strips
            .retain(|graph, _| *graph == file || recent.contains(graph));
    }

    /// Remembers a model as the last one that was shown.
    pub(crate) fn remember_model(&mut self, model: &Path) {
        self.models.retain(|known| known != model);
        self.models.push(model.to_owned());
        if self.models.len() > MOST_MODELS {
            self.models.remove(0);
        }
    }

    /// Trusts a file or folder from now on. Beyond [`MOST_TRUSTED`], those that were trusted first are forgotten.
    pub(crate) fn trust(&mut self, path: &Path) {
        remember_path(&mut self.trusted, path);
    }

    /// Uses the node files of a folder from now on.
    pub(crate) fn trust_nodes(&mut self, folder: &Path) {
        remember_path(&mut self.trusted_nodes, folder);
    }

    /// Options for reading a model.
    pub(crate) fn reading(&self, model: &Path) -> ImportOptions {
        let known = self.readings.get(&canonical_if_present(model)).cloned();
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
        self.backups = self.backups.min(MOST_BACKUPS);
        self.models.truncate(MOST_MODELS);
        self.model_strips
            .values_mut()
            .for_each(|strip| strip.files.truncate(MOST_MODELS));
        self.recent.truncate(MOST_RECENT);
        self.brush_colors
            .retain(|color| color.iter().all(|channel| channel.is_finite()));
        self.brush_colors.truncate(MOST_COLORS);
        self.export = self.export.sanitized();
        self.view = self.view.sanitized();
        self.brush = self.brush.sanitized();
        self.stencil = self.stencil.sanitized();
        self.readings
            .values_mut()
            .for_each(|reading| *reading = reading.clone().sanitized());
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
mod tests;
