//! Bake requests, and checks of them that need no file.

use std::path::{Path, PathBuf};

use sabi_export::preset::{BUILTIN_NAMES, Map, MapContent, Preset};
use sabi_export::{
    Channel, CopyOptions, MeshMap, NamePattern, NamedPreset, OutputKind, Padding, SetOptions, file_stem,
};
use sabi_files::Disk;
use sabi_gpu::{AdapterChoice, CasterChoice, DEFAULT_BUDGET_BYTES};
use sabi_graph::Overrides;

use crate::baking::presets::find_preset;
use crate::baking::seams::Seams;
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::EvaluatorOptions;
use crate::faults::FaultList;
use crate::opening::linked_model::ModelOptions;

/// Name of the default preset.
pub const DEFAULT_PRESET: &str = BUILTIN_NAMES[0];

/// Request for a bake.
pub struct BakeRequest {
    /// Graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit and adapter.
    pub evaluator: EvaluatorOptions,
    /// Folder for the maps.
    pub output: PathBuf,
    /// Names of export presets, or paths of preset files; empty for the default.
    pub presets: Vec<String>,
    /// Folder with presets of the user's own.
    pub preset_folder: Option<PathBuf>,
    /// Pattern of map names without file extension that replaces those of the presets, with tokens as in docs/presets.md.
    pub names: Option<String>,
    /// Channels to export, and `masks`, `colors` and `vectors` for all outputs of a kind; empty for all.
    pub channels: Vec<String>,
    /// Names of maps of the model itself that are written in addition to those of the presets.
    pub mesh_maps: Vec<String>,
    /// Material whose texture set is exported; `None` for all.
    pub material: Option<String>,
    /// True to also export constant channels as maps.
    pub all_maps: bool,
    /// Padding around the charts in texels; `None` to fill everything.
    pub padding: Option<u32>,
    /// Treatment of differences at seams.
    pub seams: Seams,
    /// True to fuse point nodes.
    pub fuse: bool,
    /// True to write into a folder that has files but no earlier maps.
    pub force: bool,
    /// Options of a glTF copy of the model with the new maps; `None` for no copy.
    pub model: Option<CopyOptions>,
    /// File to which the caller writes the report. It is refused if the bake reads it.
    pub report: Option<PathBuf>,
    /// Disk that files are written to.
    pub disk: Disk,
}

impl BakeRequest {
    /// Padding of the maps.
    pub(super) fn map_padding(&self) -> Padding {
        self.padding.map_or(Padding::Infinite, Padding::Texels)
    }

    /// Creates a request without options, and without a folder for the maps.
    pub fn plain(graph: &Path, model: &Path, size: u32) -> BakeRequest {
        BakeRequest {
            graph: graph.to_owned(),
            evaluator: EvaluatorOptions {
                model: ModelOptions::new(model, size),
                overrides: Overrides::default(),
                fit: None,
                adapter: AdapterChoice::Auto,
                caster: CasterChoice::default(),
                budget_bytes: DEFAULT_BUDGET_BYTES,
            },
            output: PathBuf::new(),
            presets: Vec::new(),
            preset_folder: None,
            names: None,
            channels: Vec::new(),
            mesh_maps: Vec::new(),
            material: None,
            all_maps: false,
            padding: Some(default_padding(size)),
            seams: Seams::default(),
            fuse: true,
            force: false,
            model: None,
            report: None,
            disk: Disk::default(),
        }
    }
}

/// Returns the padding for a game engine in texels. It grows with the size, so that the same mip levels are covered.
pub fn default_padding(size: u32) -> u32 {
    (size / 128).max(2)
}

/// Preset with all maps of the model itself.
const MESH_PRESET: &str = "mesh";

/// Lists the names of all maps of the model itself.
pub fn mesh_map_names() -> Vec<&'static str> {
    MeshMap::ALL.iter().map(|map| map.name()).collect()
}

/// Lists the names of all channels of a bake, and those of the kinds of outputs.
pub fn export_channels() -> Vec<String> {
    let channels = Channel::ALL.map(|channel| channel.name().into_owned());
    let outputs = OutputKind::ALL.map(|kind| kind.plural().to_owned());
    channels.into_iter().chain(outputs).collect()
}

/// Returns the file stem of the documents of a bake: the model, the material if only one is baked, and variant and seed if
/// the names of the maps contain them. Therefore a document replaces another one together with the maps that it names.
/// `None` if only some channels are exported, since documents of these would replace complete ones.
fn document_stem(request: &BakeRequest, presets: &[NamedPreset]) -> Option<String> {
    let words = NameWords::of(request);
    let is_in_names = |word: &str| {
        let with_documents = presets.iter().filter(|named| !named.preset.documents.is_empty());
        let mut patterns = with_documents.map(|named| request.names.as_deref().unwrap_or(&named.preset.names));
        patterns.any(|pattern| pattern.contains(&format!("${word}")) || pattern.contains(&format!("{{{word}}}")))
    };
    let variant = words.variant.filter(|_| is_in_names("variant"));
    let seed = words.seed.filter(|_| is_in_names("seed"));
    let parts = [Some(words.mesh), request.material.clone(), variant, seed];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let stem = match file_stem(&parts.join("_")) {
        stem if stem.is_empty() => "model".to_owned(),
        stem => stem,
    };
    request.channels.is_empty().then_some(stem)
}

/// Values for the tokens of name patterns of a bake.
struct NameWords {
    graph: String,
    mesh: String,
    variant: Option<String>,
    seed: Option<String>,
}

impl NameWords {
    fn of(request: &BakeRequest) -> NameWords {
        let stem = |path: &Path| {
            let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            // A file has a name. A path that ends with `..` is refused when it is read.
            stem.unwrap_or_default()
        };
        let overrides = &request.evaluator.overrides;
        NameWords {
            graph: stem(&request.graph),
            mesh: stem(&request.evaluator.model.path),
            variant: overrides.variant.clone(),
            seed: overrides.seed.map(|seed| seed.to_string()),
        }
    }

    /// Parses a pattern for a preset.
    fn parse(&self, pattern: &str, preset: &str) -> Result<NamePattern, EngineError> {
        let words = NamePattern::WORDS.map(|word| {
            let stands_for = match word {
                "project" | "graph" => Some(self.graph.as_str()),
                "mesh" => Some(self.mesh.as_str()),
                "variant" => self.variant.as_deref(),
                "seed" => self.seed.as_deref(),
                _ => Some(preset),
            };
            (word, stands_for)
        });
        let parsed = NamePattern::parse(pattern, &words);
        parsed.map_err(|error| EngineError::of(ErrorKind::Usage, error))
    }
}

/// Explains why a name pattern is not valid; `None` if it is valid.
pub fn name_pattern_fault(pattern: &str) -> Option<String> {
    let words = NamePattern::WORDS.map(|word| (word, Some(word)));
    let parsed = NamePattern::parse(pattern, &words);
    parsed.err().map(|error| error.to_string())
}

/// Filters the maps of a preset by channels. Maps of the model itself are kept.
fn with_channels(mut preset: Preset, channels: &[String]) -> Result<Preset, EngineError> {
    let known = export_channels();
    let unknown: Vec<String> = channels
        .iter()
        .filter(|name| !known.contains(name))
        .map(|unknown| format!("there is no channel '{unknown}'; there is: {}", known.join(", ")))
        .collect();
    if !unknown.is_empty() {
        return Err(EngineError::several(ErrorKind::Usage, unknown));
    }
    let is_named = |channel: &Channel| channels.iter().any(|name| *name == channel.name());
    let is_asked = |map: &Map| match &map.content {
        MapContent::Every(kind) => channels.iter().any(|name| name == kind.plural()),
        MapContent::Packed(_) => {
            let mut packed = map.channels().into_iter();
            packed.any(|channel| matches!(channel, Channel::Mesh(_)) || is_named(channel))
        }
    };
    preset.maps.retain(|map| channels.is_empty() || is_asked(map));
    Ok(preset)
}

/// Filters the preset of the model's own maps by their names.
fn with_mesh_maps(mut preset: Preset, names: &[String]) -> Result<Preset, EngineError> {
    let wanted = names.iter().map(|name| MeshMap::of_name(name));
    let wanted: Vec<MeshMap> = wanted
        .collect::<Result<_, String>>()
        .map_err(|why| EngineError::new(ErrorKind::Usage, why))?;
    let is_asked = |channel: &Channel| matches!(channel, Channel::Mesh(map) if wanted.contains(map));
    preset.maps.retain(|map| map.channels().into_iter().any(is_asked));
    Ok(preset)
}

/// Returns the options for writing the sets of a request: its presets with the names of their files.
pub(crate) fn set_options(request: &BakeRequest) -> Result<SetOptions, EngineError> {
    let default = [DEFAULT_PRESET.to_owned()];
    let wanted = if request.presets.is_empty() {
        &default[..]
    } else {
        &request.presets
    };
    let words = NameWords::of(request);
    let (mut presets, mut faults) = (Vec::new(), FaultList::default());
    for name in wanted {
        let preset = find_preset(name, request.preset_folder.as_deref());
        match preset.and_then(|preset| with_channels(preset, &request.channels)) {
            Ok(preset) => presets.push(preset),
            Err(error) => faults.add(error),
        }
    }
    if !request.mesh_maps.is_empty() {
        match find_preset(MESH_PRESET, None).and_then(|preset| with_mesh_maps(preset, &request.mesh_maps)) {
            Ok(preset) => presets.push(preset),
            Err(error) => faults.add(error),
        }
    }
    faults.into_result_of_first()?;
    let named = |preset: Preset| {
        let pattern = request.names.as_deref().unwrap_or(&preset.names);
        let names = words.parse(pattern, &preset.name)?;
        Ok(NamedPreset { preset, names })
    };
    let presets: Vec<NamedPreset> = presets.into_iter().map(named).collect::<Result<_, EngineError>>()?;
    Ok(SetOptions {
        document_stem: document_stem(request, &presets),
        presets,
        all_maps: request.all_maps,
        dither_seed: 0,
    })
}

#[cfg(test)]
mod tests {
    use sabi_export::preset;

    use super::*;

    #[test]
    fn a_preset_keeps_only_the_maps_of_the_requested_channels() {
        let stays = |channels: &[&str]| {
            let channels: Vec<String> = channels.iter().map(|name| (*name).to_owned()).collect();
            with_channels(preset::raw().expect("the preset"), &channels).map(|preset| preset.maps.len())
        };
        assert_eq!(stays(&[]), Ok(preset::raw().expect("the preset").maps.len()));
        assert_eq!(stays(&["normal"]), Ok(1));
        assert_eq!(stays(&["height", "masks"]), Ok(3), "height has two files");
        let mesh = find_preset(MESH_PRESET, None).expect("the preset");
        let named = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            with_mesh_maps(mesh.clone(), &names).map(|preset| preset.maps.len())
        };
        assert_eq!(
            (named(&["id", "position"]), named(&mesh_map_names())),
            (Ok(2), Ok(MeshMap::ALL.len()))
        );
        assert_eq!(with_channels(mesh.clone(), &["normal".to_owned()]), Ok(mesh));
        let told = stays(&["hieght"]).expect_err("nobody knows it").to_string();
        let why = "there is no channel 'hieght'; there is: base_color, opacity, roughness, metallic, occlusion, height, \
                   normal, emission, coat, coat_roughness, anisotropy, sheen, sheen_roughness, subsurface, transmission, \
                   masks, colors, vectors";
        assert_eq!(told, why);
    }

    #[test]
    fn padding_grows_with_the_size_as_coarser_mip_levels_need() {
        assert_eq!([256, 512, 2048, 8192].map(default_padding), [2, 4, 16, 64]);
    }
}
