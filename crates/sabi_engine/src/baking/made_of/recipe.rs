//! Recipes of bakes: everything on which the maps depend, except the program, the adapter and the content of the files.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use sabi_export::CopyOptions;
use sabi_files::{
    AbsolutePaths, Disk, PathBase, TrustedPaths, absolute, path_from_stored, stored_path, without_detours,
};
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::{Fit, Overrides, Value};
use sabi_surface::atlas::Udim;
use sabi_surface::load::{PartChoice, Up};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::recorded_fit;
use crate::baking::bake_request::BakeRequest;
use crate::baking::seams::Seams;
use crate::error::EngineError;
use crate::evaluating::evaluator::EvaluatorOptions;
use crate::opening::document::OpenGraph;
use crate::opening::linked_model::{ModelOptions, Overlap, SavedReading};
use crate::opening::memory::default_memory_bytes;
use crate::source::paint::without_paint;

/// Recipe of a bake. Paths are absolute, or relative to the folder of the file that contains the recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Graph file.
    pub graph: String,
    /// Text of the graph if it differs from its file: from standard input, or with unsaved changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub document: Option<String>,
    /// The model, and how it is read.
    pub model: ModelRecipe,
    /// Variant of the graph.
    pub variant: Option<String>,
    /// Seed in place of the graph's.
    pub seed: Option<u32>,
    /// Values by exposed knob or `node.param`. Later values override earlier ones.
    pub set: Vec<SetRecipe>,
    /// Fit in place of the graph's.
    #[serde(with = "recorded_fit")]
    #[schemars(with = "Option<recorded_fit::FitText>")]
    pub fit: Option<Fit>,
    /// True to use strokes painted by hand.
    pub paint: bool,
    /// Texels for a unit of UV.
    pub size: u32,
    /// Presets by name or as files; empty for the default preset.
    pub presets: Vec<String>,
    /// Pattern of names that replaces those of the presets.
    pub names: Option<String>,
    /// Channels to export; empty for all.
    pub channels: Vec<String>,
    /// Maps of the model itself that are written in addition to those of the presets.
    #[serde(default)]
    pub mesh_maps: Vec<String>,
    /// Material whose texture set is exported; `None` for all.
    pub material: Option<String>,
    /// True to also export constant channels as maps.
    pub all_maps: bool,
    /// Padding around the charts in texels; `None` to fill everything.
    pub padding: Option<u32>,
    /// Treatment of differences at seams.
    pub seams: Seams,
    /// Options of the copy of the model; `None` for no copy.
    pub copy: Option<CopyOptions>,
    /// Adapter that was asked for.
    #[serde(serialize_with = "as_text", deserialize_with = "from_text")]
    #[schemars(with = "String")]
    pub adapter: AdapterChoice,
    /// Ray caster that was asked for.
    #[serde(serialize_with = "as_text", deserialize_with = "from_text")]
    #[schemars(with = "String")]
    pub caster: CasterChoice,
    /// True if point nodes share kernels.
    pub fuse: bool,
}

/// Model of a recipe, and the options for reading it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelRecipe {
    /// Model file.
    pub file: String,
    /// Number of the UV set.
    pub uv: u32,
    /// Axis of the file that points up.
    pub up: Up,
    /// Factor for all lengths of the file.
    pub scale: f32,
    /// Scene of a glTF file; `None` for the file's default scene.
    pub scene: Option<u32>,
    /// Angle between faces up to which their shading is smooth, in degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
    /// Names of the parts that are used; empty for all except hulls and coarser levels of detail.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<String>,
    /// Names of the parts that are left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// True to turn faces that are inside out, false to leave them even if the graph says otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_faces: Option<bool>,
    /// Folder in which missing files that the model names are searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub textures: Option<String>,
    /// Treatment of overlapping charts.
    pub overlap: Overlap,
    /// Treatment of UVs in several tiles.
    pub udim: Udim,
}

/// A value that overrides the graph's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetRecipe {
    /// Exposed knob or `node.param`.
    pub name: String,
    /// The value in the form of graph files.
    #[serde(deserialize_with = "value")]
    #[schemars(with = "serde_json::Value")]
    pub value: Value,
}

impl ModelRecipe {
    /// Returns the paths from which the model may open the files that it names: its folder, and those that the request named.
    fn trusted(&self) -> TrustedPaths {
        let own = TrustedPaths::of_file(&path_of(&self.file));
        let textures = self.textures.as_deref().map(path_of);
        textures.iter().fold(own, |trusted, folder| trusted.with_path(folder))
    }
}

impl Recipe {
    /// Returns the recipe of a request, with absolute paths.
    pub fn of(request: &BakeRequest, document: Option<String>) -> Recipe {
        let (evaluator, model) = (&request.evaluator, &request.evaluator.model);
        let overrides = &evaluator.overrides;
        let set = overrides.set.iter().map(|(name, value)| SetRecipe {
            name: name.clone(),
            value: value.clone(),
        });
        Recipe {
            graph: absolute_text(&request.graph),
            document,
            model: ModelRecipe {
                file: absolute_text(&model.path),
                uv: model.uv,
                up: model.up,
                scale: model.scale,
                scene: model.scene,
                smooth_degrees: model.smooth_degrees,
                parts: model.reading.parts.parts.clone(),
                without: model.reading.parts.without.clone(),
                turn_faces: model.reading.turn_faces,
                textures: model.reading.textures.as_deref().map(absolute_text),
                overlap: model.overlap,
                udim: model.udim,
            },
            variant: overrides.variant.clone(),
            seed: overrides.seed,
            set: set.collect(),
            fit: evaluator.fit.or(overrides.fit),
            paint: !overrides.left_out.contains(&without_paint()),
            size: model.size,
            presets: request.presets.iter().map(|name| preset_text(name)).collect(),
            names: request.names.clone(),
            channels: request.channels.clone(),
            mesh_maps: request.mesh_maps.clone(),
            material: request.material.clone(),
            all_maps: request.all_maps,
            padding: request.padding,
            seams: request.seams,
            copy: request.model,
            adapter: evaluator.adapter.clone(),
            caster: evaluator.caster,
            fuse: request.fuse,
        }
    }

    /// Returns the request for a recipe with absolute paths, with this output folder. `cache_dir` and `preset_folder` are
    /// those of this machine.
    pub fn request(&self, output: &Path, cache_dir: Option<PathBuf>, preset_folder: Option<PathBuf>) -> BakeRequest {
        let model = &self.model;
        let set = self.set.iter().map(|set| (set.name.clone(), set.value.clone()));
        BakeRequest {
            graph: path_of(&self.graph),
            evaluator: EvaluatorOptions {
                model: ModelOptions {
                    path: path_of(&model.file),
                    uv: model.uv,
                    up: model.up,
                    scale: model.scale,
                    scene: model.scene,
                    smooth_degrees: model.smooth_degrees,
                    reading: SavedReading {
                        parts: PartChoice {
                            parts: model.parts.clone(),
                            without: model.without.clone(),
                        },
                        turn_faces: model.turn_faces,
                        textures: model.textures.as_deref().map(path_of),
                    },
                    overlap: model.overlap,
                    udim: model.udim,
                    size: self.size,
                    cache_dir,
                    trusted: model.trusted(),
                    memory_bytes: default_memory_bytes(),
                },
                overrides: Overrides {
                    variant: self.variant.clone(),
                    set: set.collect(),
                    left_out: (!self.paint).then(without_paint).into_iter().collect(),
                    seed: self.seed,
                    fit: self.fit,
                },
                fit: self.fit,
                adapter: self.adapter.clone(),
                caster: self.caster,
                budget_bytes: DEFAULT_BUDGET_BYTES,
            },
            output: output.to_owned(),
            presets: self.presets.clone(),
            preset_folder,
            disk: Disk::default(),
            names: self.names.clone(),
            channels: self.channels.clone(),
            mesh_maps: self.mesh_maps.clone(),
            material: self.material.clone(),
            all_maps: self.all_maps,
            padding: self.padding,
            seams: self.seams,
            fuse: self.fuse,
            force: false,
            model: self.copy,
            report: None,
        }
    }

    /// Returns the recipe without options that may differ from machine to machine, on which the maps depend only by rounding.
    pub fn on_any_machine(&self) -> Recipe {
        Recipe {
            adapter: AdapterChoice::Auto,
            caster: CasterChoice::Auto,
            ..self.clone()
        }
    }

    /// Path of the graph, of a recipe with absolute paths.
    pub fn graph_path(&self) -> PathBuf {
        path_of(&self.graph)
    }

    /// Path of the model, of a recipe with absolute paths.
    pub fn model_path(&self) -> PathBuf {
        path_of(&self.model.file)
    }

    /// Opens the graph that is contained in the recipe, whose paths are absolute; `None` if the graph is in its file.
    pub fn open_document(&self) -> Option<Result<OpenGraph, EngineError>> {
        let text = self.document.as_ref()?;
        Some(OpenGraph::read(path_of(&self.graph), text.as_bytes()))
    }

    /// Converts the paths of a recipe in a file of the base `from` to the base `to`.
    pub fn moved(self, from: &PathBase, to: &PathBase) -> Recipe {
        self.with_paths(|path| moved(path, from, to))
    }

    /// Converts the paths of a recipe in a file of this base to absolute paths.
    pub fn with_absolute_paths(self, base: &PathBase) -> Recipe {
        self.with_paths(|path| made_absolute(path, base))
    }

    fn with_paths(mut self, rewritten: impl Fn(&str) -> String) -> Recipe {
        let presets = self.presets.iter_mut().filter(|preset| is_preset_file(preset));
        for path in [&mut self.graph, &mut self.model.file].into_iter().chain(presets) {
            *path = rewritten(path);
        }
        self
    }
}

/// Converts a path in a file of one base to another base. A path that is not text stays absolute.
pub fn moved(written: &str, from: &PathBase, to: &PathBase) -> String {
    let rewritten = to.rewrite(written, from, AbsolutePaths::Shorten);
    rewritten.unwrap_or_else(|_| written.to_owned())
}

/// Converts a path in a file of a base to an absolute path. A path that is not text is already absolute.
pub(crate) fn made_absolute(written: &str, base: &PathBase) -> String {
    match path_from_stored(written) {
        Some(path) if path.is_absolute() => written.to_owned(),
        _ => base.rewrite_absolute(written).unwrap_or_else(|_| written.to_owned()),
    }
}

/// Returns the file to which a recorded absolute path leads.
pub(crate) fn path_of(recorded: &str) -> PathBuf {
    path_from_stored(recorded).unwrap_or_else(|| PathBuf::from(recorded))
}

fn absolute_text(path: &Path) -> String {
    stored_path(&without_detours(&absolute(path)))
}

fn preset_text(name: &str) -> String {
    if is_preset_file(name) {
        absolute_text(Path::new(name))
    } else {
        name.to_owned()
    }
}

/// Returns true if a preset is given as a file: names of presets have no extension.
pub fn is_preset_file(preset: &str) -> bool {
    Path::new(preset)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

fn as_text<S: Serializer>(choice: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(choice)
}

fn from_text<'de, T, D>(deserializer: D) -> Result<T, D::Error>
where
    T: FromStr<Err: Display>,
    D: Deserializer<'de>,
{
    let text = String::deserialize(deserializer)?;
    text.parse().map_err(serde::de::Error::custom)
}

fn value<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Value, D::Error> {
    let json = serde_json::Value::deserialize(deserializer)?;
    value_of(&json).ok_or_else(|| serde::de::Error::custom("a number is not finite"))
}

/// Returns the value of a graph that a JSON value represents.
fn value_of(json: &serde_json::Value) -> Option<Value> {
    use serde_json::Value as Json;
    Some(match json {
        Json::Null => Value::Null,
        Json::Bool(yes) => Value::Bool(*yes),
        Json::Number(number) => Value::Number(number.as_f64().filter(|number| number.is_finite())?),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(items) => Value::List(items.iter().map(value_of).collect::<Option<_>>()?),
        Json::Object(members) => {
            let members = members.iter().map(|(key, json)| Some((key.clone(), value_of(json)?)));
            Value::Object(members.collect::<Option<_>>()?)
        }
    })
}
