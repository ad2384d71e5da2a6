//! Check whether an output folder may be written into without `force`.

use std::fs;
use std::path::Path;

use sabi_export::{Channel, NamePattern};
use sabi_graph::FlatGraph;

use crate::source::{OUTPUT_MASK, mask_name};

/// Returns true if a folder has files, but none that look like maps of an earlier bake of this graph, named by
/// `pattern` or the default pattern. A missing or empty folder is not foreign; hidden files do not count, nor does the `report`
/// that the bake replaces, since one that failed leaves nothing else.
pub(crate) fn is_foreign_folder(
    folder: &Path,
    graph: &FlatGraph,
    pattern: &NamePattern,
    report: Option<&Path>,
) -> bool {
    let Ok(entries) = fs::read_dir(folder) else {
        return false;
    };
    let names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .filter(|name| !name.starts_with('.') && report != Some(&folder.join(name)))
        .collect();
    let masks = graph.nodes.iter().filter(|node| node.kind == OUTPUT_MASK);
    let masks = masks.map(|node| Channel::Mask(mask_name(node)));
    let channels: Vec<Channel> = Channel::ALL.into_iter().chain(masks).collect();
    let patterns = [pattern, &NamePattern::default()];
    let is_one = |name: &String| patterns.iter().any(|pattern| is_map(name, pattern, &channels));
    !names.is_empty() && !names.iter().any(is_one)
}

/// Returns true if a file name looks like that of a map: `wood_base_color.png`, `wood_height.1001.exr`.
fn is_map(name: &str, pattern: &NamePattern, channels: &[Channel]) -> bool {
    let Some(stem) = name.strip_suffix(".png").or_else(|| name.strip_suffix(".exr")) else {
        return false;
    };
    let stem = match stem.rsplit_once('.') {
        Some((stem, tile)) if tile.len() == 4 && tile.bytes().all(|byte| byte.is_ascii_digit()) => stem,
        _ => stem,
    };
    channels.iter().any(|channel| pattern.may_give(stem, channel))
}

#[cfg(test)]
mod tests {
    use sabi_export::{Channel, NamePattern};

    use super::is_map;

    #[test]
    fn maps_are_known_by_their_names() {
        let pattern = NamePattern::default();
        let channels = [Channel::BaseColor, Channel::Height, Channel::Mask("wear".into())];
        for name in ["wood_base_color.png", "wood_height.1001.exr", "a.b_wear.png"] {
            assert!(is_map(name, &pattern, &channels), "{name}");
        }
        for name in [
            "holiday.png",
            "base_color.png",
            "wood_base_color.txt",
            "wood_height.12.exr",
            "thesis.doc",
        ] {
            assert!(!is_map(name, &pattern, &channels), "{name}");
        }
    }
}
