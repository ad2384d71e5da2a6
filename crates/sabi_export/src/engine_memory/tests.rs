use super::*;
use crate::preset::{Content, builtin};

#[test]
fn the_bytes_of_a_texture_are_those_of_its_blocks_in_all_levels() {
    let cases = [
        // (4^11 - 1) / 3 blocks from 4096 to 4 pixels, and one for each of 2 and 1.
        (EngineFormat::Bc7, [4096, 4096], 16 * ((4_u64.pow(11) - 1) / 3 + 2)),
        (EngineFormat::Bc7, [4096, 4096], 22_369_648),
        (EngineFormat::Bc5, [2048, 2048], 16 * ((4_u64.pow(10) - 1) / 3 + 2)),
        (EngineFormat::Bc4, [2048, 2048], 8 * ((4_u64.pow(10) - 1) / 3 + 2)),
        (EngineFormat::Bc6h, [4, 4], 16 * 3),
        (EngineFormat::Bc4, [1, 1], 8),
        // 10 × 6 pixels are 3 × 2 blocks, 5 × 3 are 2 × 1, 2 × 1 and 1 × 1 are one each.
        (EngineFormat::Bc4, [10, 6], 8 * (6 + 2 + 1 + 1)),
        // A quarter of the pixels in each level.
        (EngineFormat::R16, [1024, 1024], 2 * (4_u64.pow(11) - 1) / 3),
        (EngineFormat::Rgba16Float, [2, 2], 8 * 5),
        (EngineFormat::Rg16Float, [8, 1], 4 * (8 + 4 + 2 + 1)),
        (EngineFormat::Bc7, [0, 0], 16),
    ];
    for (format, size, bytes) in cases {
        assert_eq!(format.bytes(size), bytes, "{format:?} {size:?}");
    }
}

/// Formats of the maps of a preset, with their names.
fn formats(preset: &str) -> Vec<(String, EngineFormat)> {
    let preset = builtin(preset).unwrap().unwrap();
    let of = |map: crate::preset::Map| match &map.content {
        Content::Packed(components) => Some((map.name.clone(), EngineFormat::of(components, map.format))),
        _ => None,
    };
    preset.maps.into_iter().filter_map(of).collect()
}

#[test]
fn the_format_follows_the_use_of_a_map() {
    let raw = formats("raw");
    let of = |name: &str| {
        let found = raw.iter().filter(|(known, _)| known == name);
        found.map(|(_, format)| *format).collect::<Vec<_>>()
    };
    assert_eq!(of("base_color"), [EngineFormat::Bc7]);
    assert_eq!(of("roughness"), [EngineFormat::Bc4]);
    assert_eq!(of("normal"), [EngineFormat::Bc5], "of 16 bits, too");
    assert_eq!(of("height"), [EngineFormat::R16Float, EngineFormat::R16]);
    assert_eq!(of("emission"), [EngineFormat::Bc7, EngineFormat::Bc6h]);
    assert_eq!(
        formats("unity")[..2],
        [
            ("BaseMap".to_owned(), EngineFormat::Bc7),
            ("MaskMap".to_owned(), EngineFormat::Bc7)
        ]
    );
}

#[test]
fn textures_are_summed_up_by_set() {
    let output = |material: &str, udim, engine_format: EngineFormat| OutputRecord {
        path: String::new(),
        preset: "raw".into(),
        channel: String::new(),
        components: Vec::new(),
        material: material.into(),
        width: 64,
        height: 64,
        bits: 8,
        color_space: "linear",
        udim,
        range: None,
        engine_format,
        engine_bytes: engine_format.bytes([64, 64]),
        blake3: String::new(),
    };
    let outputs = [
        output("wood", Some(1001), EngineFormat::Bc4),
        output("wood", Some(1001), EngineFormat::Bc7),
        output("wood", Some(1002), EngineFormat::Bc4),
    ];
    let memory = EngineMemory::of(&outputs);
    // 341 blocks from 64 to 4 pixels, and two more.
    let (bc4, bc7) = (8 * 343, 16 * 343);
    let sets: Vec<(Option<u32>, u64)> = memory.sets.iter().map(|set| (set.udim, set.bytes)).collect();
    assert_eq!(sets, [(Some(1001), bc4 + bc7), (Some(1002), bc4)]);
    assert_eq!(memory.bytes, 2 * bc4 + bc7);
    assert_eq!(memory.formats, [EngineFormat::Bc7, EngineFormat::Bc4]);
    let large = EngineMemory {
        bytes: 12_900_000,
        ..memory
    };
    assert_eq!(
        large.sentence().as_deref(),
        Some("12.3 MiB in an engine: BC7 and BC4, with mips")
    );
    assert_eq!(EngineMemory::of(&[]).sentence(), None);
}
