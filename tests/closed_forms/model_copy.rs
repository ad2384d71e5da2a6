//! A copy of a model that uses its new maps shows what was baked: `source/model → output/material` on the copy gives the
//! maps that it was made of.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::{
    AdapterChoice, BakeRequest, DEFAULT_BUDGET_BYTES, ModelOptions, Overrides, Prepared, Silent, WorkpieceOptions, bake,
};
use sabi_export::{Cover, layouts};
use sabi_image::{Pixels, decode};
use sabi_tests::{device, project};
use serde_json::Value as Json;

const SIZE: u32 = 128;

/// Everything varies: two layers of noise on a plain material.
const WORN: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e", "roughness": 0.3, "metallic": 1.0 } },
    "noise": { "kind": "noise/simplex", "params": { "size": 0.3 } },
    "layer": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "noise", "height_map": "noise" }, "params": {
        "color": "#6b3a1e", "roughness": 0.9, "metallic": 0.0, "height": 0.02, "alpha": 0.25, "alpha_on": true,
        "emission": "#ff8000", "emission_on": true, "emission_strength": 4.0 } },
    "out": { "kind": "output/material", "inputs": { "material": "layer" } } } }"##;

/// One value all over, and an emission above 1.
const PLAIN: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e", "roughness": 0.7, "metallic": 0.25 } },
    "out": { "kind": "output/material", "inputs": { "material": "base" } } } }"##;

const MODEL: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;

fn bake_to(folder: &Path, graph: &str, model: &Path, copies_model: bool) -> Json {
    // Says what to do where there is no software driver.
    device();
    fs::create_dir_all(folder).unwrap();
    let path = folder.join("graph.sabi");
    fs::write(&path, graph).unwrap();
    let request = BakeRequest {
        graph: path,
        workpiece: WorkpieceOptions {
            model: ModelOptions::new(model, SIZE),
            overrides: Overrides::default(),
            fit: None,
            adapter: AdapterChoice::Cpu,
            budget_bytes: DEFAULT_BUDGET_BYTES,
        },
        output: folder.join("out"),
        presets: Vec::new(),
        material: None,
        all_maps: false,
        padding: None,
        fuse: true,
        force: false,
        model: copies_model,
    };
    bake(&request, &Silent).unwrap_or_else(|error| panic!("{error}")).json
}

/// Codes of a map, as a part of the highest one.
fn codes(path: &Path) -> Vec<f64> {
    let name = path.display().to_string();
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{name}: {error}"));
    match decode(&name, &bytes).unwrap().pixels {
        Pixels::U8(codes) => codes.into_iter().map(|code| f64::from(code) / 255.0).collect(),
        Pixels::U16(codes) => codes.into_iter().map(|code| f64::from(code) / 65535.0).collect(),
        Pixels::F32(values) => values.into_iter().map(f64::from).collect(),
    }
}

/// Where charts have their own texels: rings and padding may show what a picture is over its edge.
fn owned(model: &Path) -> Vec<bool> {
    let prepared = Prepared::open(&ModelOptions::new(model, SIZE), &Silent).unwrap();
    let layout = layouts(&prepared.atlas).remove(0);
    layout.cover.iter().map(|cover| *cover == Cover::Owned).collect()
}

/// The largest difference of two maps where charts have their own texels.
fn furthest(owned: &[bool], files: [PathBuf; 2]) -> f64 {
    let [was, is] = files.map(|file| codes(&file));
    assert_eq!(was.len(), is.len());
    let components = was.len() / owned.len();
    let pairs = was.iter().zip(&is).enumerate();
    pairs
        .filter(|(at, _)| owned[at / components])
        .map(|(_, (was, is))| (was - is).abs())
        .fold(0.0, f64::max)
}

fn constants(report: &Json) -> Vec<String> {
    let entries = report["constants"].as_array().unwrap().iter();
    entries
        .map(|entry| format!("{} {}", entry["channel"], entry["value"]))
        .collect()
}

/// Bakes a graph on a model and the copy's own looks on the copy: the folders of the maps, and the two reports.
fn there_and_back(folder: &Path, graph: &str, model: &Path) -> ([PathBuf; 2], [Json; 2]) {
    let first = bake_to(&folder.join("first"), graph, model, true);
    let copy = folder.join("first/out").join(first["model"]["path"].as_str().unwrap());
    let second = bake_to(&folder.join("second"), MODEL, &copy, false);
    (
        ["first/out", "second/out"].map(|part| folder.join(part)),
        [first, second],
    )
}

#[test]
fn a_copied_model_shows_the_maps_that_were_baked() {
    let folder = tempfile::tempdir().unwrap();
    let ([first, second], reports) = there_and_back(folder.path(), WORN, &project("assets/meshes/bench.glb"));
    assert_eq!(
        reports[0]["constants"],
        serde_json::json!([{
            "channel": "occlusion", "material": "bench", "value": 1.0
        }])
    );
    let owned = owned(&project("assets/meshes/bench.glb"));
    let both = |file: &str| [&first, &second].map(|folder| folder.join(file));
    // A copy's maps are 8 bit: half a step when they were made, and half a step of rounding now; dithering moves a value
    // by a step. A normal's length is lost with its last digits, which moves its parts by half a step more. A code of
    // emission stands for four times as much light in the copy as in the map.
    for (channel, steps) in [
        ("base_color", 1.0),
        ("opacity", 1.0),
        ("roughness", 2.0),
        ("metallic", 2.0),
        ("normal", 1.5),
        ("emission", 3.0),
    ] {
        let furthest = furthest(&owned, both(&format!("bench_{channel}.png")));
        assert!(furthest <= steps / 255.0 + 1e-6, "{channel}: {furthest}");
    }
    // The curve is steepest at 1: 2.3 steps of light for a step of code.
    let highest = codes(&first.join("bench_emission.exr")).into_iter().fold(0.0, f64::max);
    assert!(highest > 2.0);
    let furthest = furthest(&owned, both("bench_emission.exr"));
    assert!(furthest < 2.3 / 255.0 * highest, "{furthest}");
}

#[test]
fn a_copied_model_has_the_very_values_of_constant_channels() {
    let folder = tempfile::tempdir().unwrap();
    let (_, reports) = there_and_back(folder.path(), PLAIN, &project("assets/meshes/cube.glb"));
    let [was, is] = reports.each_ref().map(constants);
    assert!(was.contains(&"\"roughness\" 0.7".to_owned()), "{was:?}");
    assert_eq!(was, is);
}
