//! Bake requests, and checks of them that need no file.

use std::path::PathBuf;

use sabi_export::preset::{self, Holds, Preset};
use sabi_export::{Channel, CopyOptions, NamePattern, SetOptions};

use crate::baking::seams::Seams;
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::EvaluatorOptions;

/// Default pattern of map names.
pub const DEFAULT_NAMES: &str = NamePattern::DEFAULT;

/// Request for a bake.
pub struct BakeRequest {
    /// Graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit and adapter.
    pub evaluator: EvaluatorOptions,
    /// Folder for the maps.
    pub output: PathBuf,
    /// Names of export presets.
    pub presets: Vec<String>,
    /// Pattern of map names without file extension, with the fields `{material}`, `{channel}`, `{graph}` and `{size}`; none for
    /// the default.
    pub names: Option<String>,
    /// Channels to export, and `masks` for all mask outputs; empty for all.
    pub channels: Vec<String>,
    /// Material whose texture set is exported; none for all.
    pub material: Option<String>,
    /// True to export constant channels as maps, too.
    pub all_maps: bool,
    /// Padding around the charts, texels; none to fill everything.
    pub padding: Option<u32>,
    /// Treatment of differences at seams.
    pub seams: Seams,
    /// True to fuse point nodes.
    pub fuse: bool,
    /// True to write into a folder that has files but no earlier maps.
    pub force: bool,
    /// Options of a glTF copy of the model with the new maps; none for no copy.
    pub model: Option<CopyOptions>,
    /// File that the caller writes the report to; refused if the bake reads it.
    pub report: Option<PathBuf>,
}

/// Lists the names of all export presets, the default first.
pub fn export_presets() -> impl Iterator<Item = &'static str> {
    ["raw"].into_iter()
}

/// Returns the padding for a game engine, texels: it grows with the size, so that the same mip levels are covered.
pub fn default_padding(size: u32) -> u32 {
    (size / 128).max(2)
}

/// Name of all mask outputs in a list of channels.
const MASKS: &str = "masks";

/// Lists the names of all channels of a bake, and `masks`.
pub fn export_channels() -> Vec<String> {
    let channels = Channel::ALL.map(|channel| channel.name().into_owned());
    channels.into_iter().chain([MASKS.to_owned()]).collect()
}

/// Parses the name pattern of a request.
pub(crate) fn names(request: &BakeRequest) -> Result<NamePattern, EngineError> {
    let Some(pattern) = &request.names else {
        return Ok(NamePattern::default());
    };
    let graph = request.graph.file_stem().unwrap_or_default().to_string_lossy(); // A graph file has a name.
    let size = request.evaluator.model.size.to_string();
    let parsed = NamePattern::parse(pattern, &[("graph", &graph), ("size", &size)]);
    parsed.map_err(|error| EngineError::of(ErrorKind::Usage, error))
}

/// Explains why a name pattern is not valid; none where it is.
pub fn name_pattern_fault(pattern: &str) -> Option<String> {
    let parsed = NamePattern::parse(pattern, &[("graph", "graph"), ("size", "1024")]);
    parsed.err().map(|error| error.to_string())
}

/// Filters the maps of a preset by channels.
fn with_channels(mut preset: Preset, channels: &[String]) -> Result<Preset, EngineError> {
    let known = export_channels();
    if let Some(unknown) = channels.iter().find(|name| !known.contains(name)) {
        let why = format!("there is no channel '{unknown}'; there is: {}", known.join(", "));
        return Err(EngineError::new(ErrorKind::Usage, why));
    }
    let is_asked = |holds: &Holds| match holds {
        Holds::Channel(channel) => channels.iter().any(|name| *name == channel.name()),
        Holds::EveryMask => channels.iter().any(|name| name == MASKS),
    };
    preset.maps.retain(|map| channels.is_empty() || is_asked(&map.holds));
    Ok(preset)
}

pub(crate) fn set_options(request: &BakeRequest) -> Result<SetOptions, EngineError> {
    for name in &request.presets {
        if !export_presets().any(|known| known == name) {
            let known = export_presets().collect::<Vec<_>>().join(", ");
            let why = format!("there is no preset '{name}'; there is: {known}");
            return Err(EngineError::new(ErrorKind::Usage, why));
        }
    }
    Ok(SetOptions {
        preset: with_channels(preset::raw(), &request.channels)?,
        names: names(request)?,
        all_maps: request.all_maps,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_is_left_with_the_maps_that_are_asked_for() {
        let stays = |channels: &[&str]| {
            let channels: Vec<String> = channels.iter().map(|name| (*name).to_owned()).collect();
            with_channels(preset::raw(), &channels).map(|preset| preset.maps.len())
        };
        assert_eq!(stays(&[]), Ok(preset::raw().maps.len()));
        assert_eq!(stays(&["normal"]), Ok(1));
        assert_eq!(stays(&["height", "masks"]), Ok(3), "height has two files");
        let told = stays(&["hieght"]).expect_err("nobody knows it").to_string();
        let why = "there is no channel 'hieght'; there is: base_color, opacity, roughness, metallic, occlusion, height, \
                   normal, emission, coat, coat_roughness, anisotropy, sheen, sheen_roughness, subsurface, transmission, \
                   masks";
        assert_eq!(told, why);
    }

    #[test]
    fn maps_reach_out_as_far_as_coarser_levels_need() {
        assert_eq!([256, 512, 2048, 8192].map(default_padding), [2, 4, 16, 64]);
    }
}
