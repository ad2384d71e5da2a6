//! Losses of a bake: channels that presets leave out, and maps that store less than their channel or need a factor.

use std::collections::BTreeMap;

use sabi_export::{BakeWriter, Channel, CutMap, SetOptions, UnmappedChannels};

use crate::baking::bake_request::BakeRequest;
use crate::baking::map_encoder::WrittenMaps;

/// Records the channels that the presets leave out. Warns of these, of emission that a map stores divided by a factor, and
/// of clipped values.
pub(super) fn tell_losses(request: &BakeRequest, options: &SetOptions, writer: &BakeWriter, written: &mut WrittenMaps) {
    // If only some channels are exported, the user did not request the others.
    if request.channels.is_empty() {
        written.left_out = writer.left_out(options);
    }
    let for_materials: Vec<&str> = options
        .presets
        .iter()
        .filter(|named| named.preset.maps_of(&Channel::BaseColor).next().is_some())
        .map(|named| named.preset.name.as_str())
        .collect();
    let matter = written
        .left_out
        .iter()
        .filter(|left| for_materials.contains(&left.preset.as_str()));
    let left_out = matter.filter_map(left_out_sentence);
    let scaled = scaled_sentences(written);
    let cut = cut_sentences(writer.cut_maps());
    let sentences: Vec<String> = left_out.chain(scaled).chain(cut).collect();
    written.warnings.extend(sentences.into_iter().map(Into::into));
}

/// Returns a sentence on channels that a preset for whole materials does not store. Relief is in its normal map, without the height.
fn left_out_sentence(left: &UnmappedChannels) -> Option<String> {
    let channels = left.channels.iter().filter(|channel| **channel != Channel::Height);
    let names: Vec<String> = channels.map(|channel| channel.name().replace('_', " ")).collect();
    let (UnmappedChannels { preset, material, .. }, what) = (left, names.join(", "));
    (!names.is_empty()).then(|| {
        format!(
            "the preset {preset} has no place for {what} of '{material}', which is left out; the preset raw has a map for every \
             channel"
        )
    })
}

/// Returns a sentence for each material whose emission is divided by a factor, for all its tiles together. Where the preset writes the
/// same emission as OpenEXR, undivided, its documents apply the factor to the other file, and there is nothing to do.
fn scaled_sentences(written: &WrittenMaps) -> Vec<String> {
    let mut found: BTreeMap<(&str, &str), (&str, f32, usize)> = BTreeMap::new();
    for output in &written.outputs {
        let Some(scale) = output.scale else { continue };
        let is_undivided_beside = written.outputs.iter().any(|other| {
            let is_same = other.preset == output.preset && other.material == output.material;
            is_same && other.channel == output.channel && other.scale.is_none() && other.path.ends_with(".exr")
        });
        if is_undivided_beside {
            continue;
        }
        let of_material = (output.preset.as_str(), output.material.as_str());
        found.entry(of_material).or_insert((&output.path, scale, 0)).2 += 1;
    }
    let sentence = |((_, material), (path, scale, files)): ((&str, &str), (&str, f32, usize))| {
        let more = match files {
            1 => "holds".to_owned(),
            files => format!("and {} more hold", files - 1),
        };
        format!(
            "{path} {more} the emission of '{material}' divided by {scale}, since it exceeds 1: set the strength of the emission to \
             {scale} where the map is used"
        )
    };
    found.into_iter().map(sentence).collect()
}

/// Returns a sentence for each channel whose values are clipped in maps.
fn cut_sentences(cut: &[CutMap]) -> Vec<String> {
    let mut found: BTreeMap<(&str, &Channel, &str), (&CutMap, usize)> = BTreeMap::new();
    for map in cut {
        let of_channel = (map.preset.as_str(), &map.channel, map.material.as_str());
        let (highest, files) = found.entry(of_channel).or_insert((map, 0));
        *files += 1;
        if map.peak > highest.peak {
            *highest = map;
        }
    }
    let sentence = |(_, (map, files)): (_, (&CutMap, usize))| {
        let CutMap {
            path,
            channel,
            material,
            peak,
            ..
        } = map;
        let more = match files {
            1 => "is".to_owned(),
            files => format!("and {} more are", files - 1),
        };
        let way = match channel {
            Channel::Emission => "give the map `normalize = true`, or a format of floats, in its preset",
            _ => "give the map a format of floats in its preset",
        };
        format!(
            "{path} {more} cut at 1, and {} of '{material}' goes up to {peak}; {way}",
            channel.name().replace('_', " ")
        )
    };
    found.into_iter().map(sentence).collect()
}
