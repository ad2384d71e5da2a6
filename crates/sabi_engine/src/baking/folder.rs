//! Check whether an output folder may be written into without `force`.

use std::fs;
use std::path::Path;

use sabi_export::preset::{MapContent, MapFormat};
use sabi_export::{Channel, NamedPreset, SetOptions};
use sabi_graph::FlatGraph;

use crate::baking::recorded::manifest::has_record;
use crate::error::{EngineError, ErrorKind};
use crate::source::map_output;

/// Returns true if a folder has files, but neither a record of earlier bakes nor files that look like maps or documents of
/// an earlier bake of this graph with these options or the default preset. A missing or empty folder is not foreign. Hidden
/// files do not count, and neither does `report`, which the bake replaces: a failed bake leaves only its report.
pub(crate) fn is_foreign_folder(
    folder: &Path,
    graph: &FlatGraph,
    options: &SetOptions,
    report: Option<&Path>,
) -> Result<bool, EngineError> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Ok(false);
    };
    if has_record(folder) {
        // The names may contain the seed or the variant of the earlier bake.
        return Ok(false);
    }
    let names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .filter(|name| !name.starts_with('.') && report != Some(&folder.join(name)))
        .collect();
    let outputs: Vec<Channel> = graph.nodes.iter().filter_map(map_output).collect();
    let default = SetOptions::raw().map_err(|error| EngineError::of(ErrorKind::Defect, error))?;
    let documents = options.document_names();
    let is_one = |name: &String| {
        let mut presets = options.presets.iter().chain(&default.presets);
        documents.contains(name) || presets.any(|preset| is_map(name, preset, &outputs))
    };
    Ok(!names.is_empty() && !names.iter().any(is_one))
}

/// Returns true if a file name looks like that of a map: `wood_base_color.png`, `wood_height.1001.exr`.
fn is_map(name: &str, NamedPreset { preset, names }: &NamedPreset, outputs: &[Channel]) -> bool {
    let may_be = |word: &str, format: MapFormat| {
        let stem = name
            .strip_suffix(format.ending())
            .and_then(|stem| stem.strip_suffix('.'));
        stem.is_some_and(|stem| names.may_give(stem, word))
    };
    preset.maps.iter().any(|map| match map.content {
        MapContent::Every(kind) => {
            let mut its = outputs.iter().filter(|output| output.output_kind() == Some(kind));
            its.any(|output| may_be(&output.name(), map.format))
        }
        MapContent::Packed(_) => may_be(&map.name, map.format),
    })
}

#[cfg(test)]
mod tests {
    use sabi_export::NamePattern;
    use sabi_export::preset::builtin;

    use super::*;

    #[test]
    fn maps_are_recognized_by_their_names() {
        let [raw] = &SetOptions::raw().expect("the preset").presets[..] else {
            panic!("one preset")
        };
        let outputs = [Channel::Mask("wear".into()), Channel::Vector("flow".into())];
        for name in [
            "wood_base_color.png",
            "wood_height.1001.exr",
            "a.b_wear.png",
            "wood_flow.exr",
        ] {
            assert!(is_map(name, raw, &outputs), "{name}");
        }
        for name in [
            "holiday.png",
            "base_color.png",
            "wood_base_color.txt",
            "wood_height.tga",
            "wood_flow.png",
            "wood_roughness.12.png",
            "thesis.doc",
        ] {
            assert!(!is_map(name, raw, &outputs), "{name}");
        }
        let preset = builtin("unreal").expect("a preset").expect("that is read");
        let names = NamePattern::parse(&preset.names, &[]).expect("a pattern");
        let unreal = NamedPreset { preset, names };
        assert!(is_map("T_wood_ORM.1002.png", &unreal, &outputs));
        assert!(!is_map("wood_ORM.png", &unreal, &outputs));
    }
}
