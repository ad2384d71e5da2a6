//! Tests of the built-in nodes.

#![allow(clippy::unwrap_used, reason = "a test that finds no node has failed")]

use sabi_nodes::kind::{Channel, ChannelWrite};
use sabi_nodes::{Library, SourceFile, read_kind};

#[test]
fn every_built_in_node_and_library_is_valid() {
    let (files, libraries) = Library::builtin_files();
    let count = files.len();
    let (library, faults) = Library::load(files, libraries);
    let shown: Vec<String> = faults.iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", shown.join("\n\n"));
    assert_eq!(library.kinds().count(), count);
}

#[test]
fn a_layer_sets_the_channels_that_are_switched_on() {
    let library = Library::builtin();
    let layer = library.kind("effect/layer").unwrap();
    let material = layer.output(Some("material")).unwrap();
    let toggles = |channel| {
        let writes = material.channels.iter().filter(|write| write.channel == channel);
        let named = |index: &usize| layer.params[*index].name.as_str();
        let names = writes.map(|write| write.unless_off.iter().map(named).collect::<Vec<_>>());
        names.collect::<Vec<_>>()
    };
    assert_eq!(toggles(Channel::Height), [["height_on"]]);
    assert_eq!(toggles(Channel::Emission), [["emission_on"]]);
    // Color and alpha share a texture, and so do roughness and metallic. Either of the two sets the shared channel.
    assert_eq!(toggles(Channel::Color), [["color_on"], ["alpha_on"]]);
    assert_eq!(
        toggles(Channel::Surface),
        [["roughness_on"], ["metallic_on"], ["occlusion_on"]]
    );
}

#[test]
fn a_layer_without_a_coat_only_covers_the_coat_below() {
    let library = Library::builtin();
    let layer = library.kind("effect/layer").unwrap();
    let material = layer.output(Some("material")).unwrap();
    let needs = |channel| {
        let writes = material.channels.iter().filter(move |write| write.channel == channel);
        let of_write = |write: &ChannelWrite| {
            let params = write.unless_off.iter().map(|index| layer.params[*index].name.clone());
            let inputs = write.unless_open.iter().map(|index| layer.inputs[*index].name.clone());
            params.chain(inputs).collect::<Vec<_>>()
        };
        writes.map(of_write).collect::<Vec<_>>()
    };
    assert_eq!(needs(Channel::Coat), [["coat", "coat_on"]]);
    assert_eq!(needs(Channel::Anisotropy), [["anisotropy", "anisotropy_on"]]);
    assert_eq!(needs(Channel::Sheen), [["sheen", "sheen_on"]]);
    let through = [
        ["subsurface", "subsurface_on"],
        ["subsurface_transmission", "subsurface_on"],
    ];
    assert_eq!(needs(Channel::Subsurface), through);
}

#[test]
fn a_blend_of_materials_passes_their_channels_on() {
    let library = Library::builtin();
    let blend = library.kind("material/blend").unwrap();
    assert_eq!(blend.output(None).unwrap().channels, []);
}

#[test]
fn relief_and_light_are_not_stored_where_they_are_zero() {
    let library = Library::builtin();
    let needs = |id: &str, channel| {
        let kind = library.kind(id).unwrap();
        let write = kind.outputs[0].channels.iter().find(|write| write.channel == channel)?;
        let params = write.unless_off.iter().map(|index| kind.params[*index].name.as_str());
        let inputs = write.unless_open.iter().map(|index| kind.inputs[*index].name.as_str());
        Some(params.chain(inputs).collect::<Vec<_>>())
    };
    assert_eq!(needs("material/combine", Channel::Height), Some(vec!["height"]));
    assert_eq!(needs("material/combine", Channel::Slope), Some(vec!["slope"]));
    assert_eq!(needs("material/combine", Channel::Emission), Some(vec!["emission"]));
    assert_eq!(needs("material/adjust", Channel::Height), Some(vec!["height"]));
    assert_eq!(needs("material/adjust", Channel::Slope), None);
    // The slope of the layer below is kept or fades. If the layer has no slope itself, it sets none where there was none.
    assert_eq!(
        needs("effect/layer", Channel::Slope),
        Some(vec!["slope_strength", "slope"])
    );
    assert_eq!(
        needs("effect/relief", Channel::Height),
        Some(vec!["depth", "height_map"])
    );
}

#[test]
fn no_damaged_node_makes_the_reader_panic() {
    let (files, libraries) = Library::builtin_files();
    for file in files {
        let lines: Vec<&str> = file.text.lines().collect();
        for skipped in (0..lines.len()).step_by(3) {
            let without = [&lines[..skipped], &lines[skipped + 1..]].concat().join("\n");
            let cut = lines[..skipped].join("\n");
            for text in [without, cut] {
                let damaged = SourceFile { text, ..file.clone() };
                let faults = read_kind(&damaged, &libraries).err().unwrap_or_default();
                for fault in faults {
                    assert!(
                        !fault.message.contains("gave up"),
                        "{} without line {skipped}: {fault}",
                        file.id
                    );
                }
            }
        }
    }
}
