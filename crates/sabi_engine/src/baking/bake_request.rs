//! What to bake, and what of that is settled before anything is read.

use std::path::PathBuf;

use sabi_export::preset::{self, Holds, Preset};
use sabi_export::{Channel, NamePattern, SetOptions};

use crate::baking::seams::Seams;
use crate::error::{EngineError, ErrorKind};
use crate::evaluating::evaluator::EvaluatorOptions;

/// What maps are usually called.
pub const DEFAULT_NAMES: &str = NamePattern::DEFAULT;

/// What to bake.
pub struct BakeRequest {
    /// The graph file.
    pub graph: PathBuf,
    /// Model, overrides, fit, adapter.
    pub evaluator: EvaluatorOptions,
    /// Folder for the maps.
    pub output: PathBuf,
    /// Presets by name.
    pub presets: Vec<String>,
    /// How maps are called, without their endings: text with `{material}`, `{channel}`, `{graph}` and `{size}` in it; none
    /// for what they are usually called.
    pub names: Option<String>,
    /// Only maps of these channels, and `masks` for all masks of the graph's own; none for all.
    pub channels: Vec<String>,
    /// Only the set of this material.
    pub material: Option<String>,
    /// Whether channels that are the same all over get maps too.
    pub all_maps: bool,
    /// How far maps reach out of the charts, texels; none for everywhere.
    pub padding: Option<u32>,
    /// What becomes of differences at seams.
    pub seams: Seams,
    /// Whether point nodes are fused.
    pub fuse: bool,
    /// Whether a folder that has files but no earlier maps is taken all the same.
    pub force: bool,
    /// Whether a glTF copy of the model that uses the maps is written too.
    pub model: bool,
    /// The file that the caller writes the report to: refused if it is one of those that the bake reads.
    pub report: Option<PathBuf>,
}

/// Names of all presets, the one that is taken unless told otherwise first.
pub fn export_presets() -> impl Iterator<Item = &'static str> {
    ["raw"].into_iter()
}

/// How far maps reach out of the charts unless told otherwise, texels: as coarser levels of a map shrink it, the same part of
/// it stays covered.
pub fn default_padding(size: u32) -> u32 {
    (size / 128).max(2)
}

/// Stands for all masks of the graph's own, where channels are named.
const MASKS: &str = "masks";

/// Names of all channels that a bake writes maps of, and `masks`.
pub fn export_channels() -> Vec<String> {
    let channels = Channel::ALL.map(|channel| channel.name().into_owned());
    channels.into_iter().chain([MASKS.to_owned()]).collect()
}

/// How maps of a request are called.
pub(crate) fn names(request: &BakeRequest) -> Result<NamePattern, EngineError> {
    let Some(pattern) = &request.names else {
        return Ok(NamePattern::default());
    };
    let graph = request.graph.file_stem().unwrap_or_default().to_string_lossy();
    let size = request.evaluator.model.size.to_string();
    let parsed = NamePattern::parse(pattern, &[("graph", &graph), ("size", &size)]);
    parsed.map_err(|error| EngineError::of(ErrorKind::Usage, error))
}

/// Why maps cannot be called so; none where they can.
pub fn why_no_names(pattern: &str) -> Option<String> {
    let parsed = NamePattern::parse(pattern, &[("graph", "graph"), ("size", "1024")]);
    parsed.err().map(|error| error.to_string())
}

/// The preset without the maps that are not asked for.
fn chosen(mut preset: Preset, channels: &[String]) -> Result<Preset, EngineError> {
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
        preset: chosen(preset::raw(), &request.channels)?,
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
            chosen(preset::raw(), &channels).map(|preset| preset.maps.len())
        };
        assert_eq!(stays(&[]), Ok(preset::raw().maps.len()));
        assert_eq!(stays(&["normal"]), Ok(1));
        assert_eq!(stays(&["height", "masks"]), Ok(3), "height has two files");
        let told = stays(&["hieght"]).expect_err("nobody knows it").to_string();
        let why = "there is no channel 'hieght'; there is: base_color, opacity, roughness, metallic, occlusion, height, \
                   normal, emission, masks";
        assert_eq!(told, why);
    }

    #[test]
    fn maps_reach_out_as_far_as_coarser_levels_need() {
        assert_eq!([256, 512, 2048, 8192].map(default_padding), [2, 4, 16, 64]);
    }
}
