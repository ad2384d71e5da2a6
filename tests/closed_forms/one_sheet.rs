//! Several outputs on the one sheet of a model without texture coordinates: every texel from the output of its material.

use std::fs;
use std::path::Path;

use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions};
use sabi_engine::phases::NoProgress;
use sabi_export::{Cover, NONE, Padding, PaddingMap, SetLayout, layouts};
use sabi_surface::atlas::GHOST_BIT;
use serde_json::Value as Json;

use crate::model_copy::{bake_to, codes};

/// Large enough for room between the charts beyond their rings of two texels.
const SIZE: u32 = 512;

/// A cube, half of it wood, half of it steel.
const CUBE: &str = "mtllib cube.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    usemtl wood\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl steel\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const LIBRARY: &str = "newmtl wood\nKd 0 1 0\nnewmtl steel\nKd 0 0 1\n";

/// Red for wood and blue for steel.
const BOTH: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "red": { "kind": "source/material", "params": { "color": "#ff0000", "roughness": 0.75, "metallic": 1.0 } },
    "blue": { "kind": "source/material", "params": { "color": "#0000ff", "roughness": 0.75, "metallic": 0.0 } },
    "wood": { "kind": "output/material", "params": { "materials": "wood" }, "inputs": { "material": "red" } },
    "rest": { "kind": "output/material", "inputs": { "material": "blue" } } } }"##;

/// Red with dents for wood, and nothing for steel.
const WOOD: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "red": { "kind": "source/material", "params": { "color": "#ff0000" } },
    "noise": { "kind": "noise/simplex", "params": { "size": 0.3 } },
    "layer": { "kind": "effect/layer", "inputs": { "base": "red", "mask": "noise", "height_map": "noise" }, "params": {
        "color": "#ff0000", "height": 0.05 } },
    "wood": { "kind": "output/material", "params": { "materials": "wood" }, "inputs": { "material": "layer" } } } }"##;

/// Writes the model and bakes a graph on it. Returns the report, the sheet's layout, and for each pixel with a value the
/// material from which it comes.
fn baked(folder: &Path, graph: &str) -> (Json, SetLayout, Vec<Option<u32>>) {
    fs::write(folder.join("cube.obj"), CUBE).expect("a model");
    fs::write(folder.join("cube.mtl"), LIBRARY).expect("a library");
    let options = ModelOptions::new(&folder.join("cube.obj"), SIZE);
    let linked = LinkedModel::open(&options, &NoProgress).expect("a model");
    let report = bake_to(folder, graph, options, true);
    let atlas = &linked.atlas;
    let layout = layouts(atlas).remove(0);
    let material_of = |pixel: u32| {
        let texel = *layout.source.get(pixel as usize)?;
        let owner = atlas.owners[texel as usize];
        let chart = if owner & GHOST_BIT == 0 {
            atlas.triangle_chart[owner as usize]
        } else {
            atlas.ghosts[(owner & !GHOST_BIT) as usize].chart
        };
        Some(atlas.charts[chart as usize].material)
    };
    let padding = PaddingMap::new(&layout, Padding::Infinite);
    let materials: Vec<Option<u32>> = padding.sources().map(material_of).collect();
    assert!(materials.iter().all(Option::is_some));
    // Both have their part, of the charts and of what is around them.
    for cover in [true, false] {
        for material in [0, 1] {
            let of = layout.source.iter().zip(&materials);
            let count = of
                .filter(|(source, of)| (**source != NONE) == cover && **of == Some(material))
                .count();
            assert!(count > 50, "{count} pixels of material {material}, covered: {cover}");
        }
    }
    (report, layout, materials)
}

/// The colors of a map by material, wherever these pixels count.
fn assert_colors(folder: &Path, materials: &[Option<u32>], colors: [[f64; 3]; 2], counts: impl Fn(usize) -> bool) {
    let codes = codes(&folder.join("out/cube_base_color.png"));
    let pixels = codes.chunks_exact(3).zip(materials).enumerate();
    for (pixel, (code, material)) in pixels.filter(|(pixel, _)| counts(*pixel)) {
        assert_eq!(Some(code), material.map(|at| &colors[at as usize][..]), "pixel {pixel}");
    }
}

fn channels(report: &Json) -> Vec<String> {
    let constants = report["constants"].as_array().into_iter().flatten();
    constants
        .map(|constant| format!("{} {}", constant["channel"], constant["value"]))
        .collect()
}

const RED: [f64; 3] = [1.0, 0.0, 0.0];
const BLUE: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn each_texel_is_read_from_the_output_of_its_material() {
    let folder = tempfile::tempdir().unwrap();
    let (report, _, materials) = baked(folder.path(), BOTH);
    assert_colors(folder.path(), &materials, [RED, BLUE], |_| true);
    let metallic = codes(&folder.path().join("out/cube_metallic.png"));
    for (code, material) in metallic.iter().zip(&materials) {
        assert_eq!(*code, if *material == Some(0) { 1.0 } else { 0.0 });
    }
    // What they agree on is one number.
    let constants = channels(&report);
    assert!(constants.contains(&"\"roughness\" 0.75".to_owned()), "{constants:?}");
    assert!(
        !constants.iter().any(|constant| constant.contains("base_color")),
        "{constants:?}"
    );
    // Both materials of the copy wear the same maps.
    let copy = ModelOptions::new(&folder.path().join("out/cube.glb"), SIZE);
    let copy = LinkedModel::load_model(&copy, &NoProgress).unwrap();
    let names: Vec<&str> = copy.materials.iter().map(|material| &material.name[..]).collect();
    assert_eq!(names, ["wood", "steel"]);
    assert!(copy.materials[0].base_color.is_some());
    assert_eq!(copy.materials[0].base_color, copy.materials[1].base_color);
}

#[test]
fn a_material_without_an_output_keeps_its_own_looks() {
    let folder = tempfile::tempdir().unwrap();
    let (report, layout, materials) = baked(folder.path(), WOOD);
    // The ring around a chart shows what the model has on the other side of the edge, where that is its own looks.
    let is_owned = |pixel: usize| layout.cover[pixel] == Cover::Owned;
    assert_colors(folder.path(), &materials, [RED, BLUE], is_owned);
    let normals = codes(&folder.path().join("out/cube_normal.png"));
    let mut leaning = 0;
    for (normal, material) in normals.chunks_exact(3).zip(&materials) {
        // A step of 16 bits.
        let is_flat = (normal[0] - 0.5).abs() < 2e-5 && (normal[1] - 0.5).abs() < 2e-5 && normal[2] == 1.0;
        assert!(is_flat || *material == Some(0), "{normal:?}");
        leaning += usize::from(!is_flat);
    }
    assert!(leaning > 1000, "{leaning}");
    let warnings = report["warnings"].to_string();
    let sentence = "the material 'steel' keeps the maps it has, since no output serves it; to bake it, list it in 'materials' \
                    of an output";
    assert!(warnings.contains(sentence), "{warnings}");
}
