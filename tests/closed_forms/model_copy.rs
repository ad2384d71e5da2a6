//! A copy of a model with its new maps shows the baked result: `source/model → output/material` on the copy gives the maps
//! from which it was made. The same holds for copies of models that were unwrapped, whose triangles keep their positions.

#![allow(clippy::unwrap_used, reason = "a test that cannot bake has failed")]

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::baking::{BakeRequest, Seams, bake};
use sabi_engine::opening::linked_model::{LinkedModel, ModelOptions, Overlap};
use sabi_engine::phases::NoProgress;
use sabi_export::{CopyOptions, Cover, layouts, set_names};
use sabi_image::{Pixels, decode};
use sabi_surface::model::Model;
use sabi_tests::{MeshFile, Quad, adapter, device, project, report_file};
use serde_json::Value as Json;

pub(crate) const SIZE: u32 = 128;

/// Everything varies: two layers of noise on a material that has a coat and a sheen of its own.
const WORN: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "bare": { "kind": "source/material", "params": { "color": "#3c5a6e", "roughness": 0.3, "metallic": 1.0 } },
    "base": { "kind": "effect/layer", "inputs": { "base": "bare" }, "params": { "color_on": false, "roughness_on": false,
        "metallic_on": false, "coat": 0.4, "coat_roughness": 0.05, "sheen": "#402010", "sheen_roughness": 0.2 } },
    "noise": { "kind": "noise/simplex", "params": { "size": 0.3 } },
    "layer": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "noise", "height_map": "noise" }, "params": {
        "color": "#6b3a1e", "roughness": 0.9, "metallic": 0.0, "height": 0.02, "alpha": 0.25, "alpha_on": true,
        "emission": "#ff8000", "emission_on": true, "emission_strength": 4.0, "coat": 0.8, "coat_roughness": 0.3,
        "sheen": "#4060a0", "sheen_roughness": 0.5, "subsurface": "#ff8040", "subsurface_transmission": 0.5 } },
    "fibers": { "kind": "noise/anisotropic" },
    "brushed": { "kind": "effect/layer", "inputs": { "base": "layer", "anisotropy_direction": "fibers.direction" },
        "params": { "color_on": false, "roughness_on": false, "metallic_on": false, "occlusion_on": false, "coat_on": false,
        "sheen_on": false, "subsurface_on": false, "anisotropy": 0.6 } },
    "out": { "kind": "output/material", "inputs": { "material": "brushed" } } } }"##;

/// One value all over, and an emission above 1.
const PLAIN: &str = r##"{ "format": "sabi", "version": 1, "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e", "roughness": 0.7, "metallic": 0.25 } },
    "out": { "kind": "output/material", "inputs": { "material": "base" } } } }"##;

const MODEL: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;

pub(crate) fn bake_to(folder: &Path, graph: &str, model: ModelOptions, copies_model: bool) -> Json {
    // Says what to do where there is no software driver.
    device();
    fs::create_dir_all(folder).expect("a folder");
    let path = folder.join("graph.sabi");
    fs::write(&path, graph).expect("a graph");
    let mut request = BakeRequest {
        output: folder.join("out"),
        padding: None,
        // Written values are compared with values that are read back, texel by texel.
        seams: if copies_model { Seams::Erase } else { Seams::Keep },
        model: copies_model.then(CopyOptions::default),
        ..BakeRequest::plain(&path, &model.path, model.size)
    };
    request.evaluator.model = model;
    request.evaluator.adapter = adapter();
    report_file(&bake(&request, &NoProgress).unwrap_or_else(|error| panic!("{error}")))
}

/// Codes of a map, as a part of the highest one.
pub(crate) fn codes(path: &Path) -> Vec<f64> {
    let name = path.display().to_string();
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{name}: {error}"));
    match decode(&name, &bytes).expect("a map").pixels {
        Pixels::U8(codes) => codes.into_iter().map(|code| f64::from(code) / 255.0).collect(),
        Pixels::U16(codes) => codes.into_iter().map(|code| f64::from(code) / 65535.0).collect(),
        Pixels::F32(values) => values.into_iter().map(f64::from).collect(),
    }
}

/// Returns, for each material, the texels that belong to charts. Rings and padding may show pixels beyond the edge of a picture.
fn owned(model: &LinkedModel) -> Vec<Vec<bool>> {
    let of_layout = layouts(&model.atlas).into_iter();
    of_layout
        .map(|layout| layout.cover.iter().map(|cover| *cover == Cover::Owned).collect())
        .collect()
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
    let entries = report["constants"].as_array().into_iter().flatten();
    entries
        .map(|entry| format!("{} {}", entry["channel"], entry["value"]))
        .collect()
}

/// Bakes a graph on a model, and the copy's own looks on the copy. Returns the folders of the maps, and the two reports.
fn there_and_back(folder: &Path, graph: &str, model: &Path) -> ([PathBuf; 2], [Json; 2]) {
    let first = bake_to(&folder.join("first"), graph, ModelOptions::new(model, SIZE), true);
    let copy = folder
        .join("first/out")
        .join(first["model"]["path"].as_str().expect("a copy"));
    let second = bake_to(&folder.join("second"), MODEL, ModelOptions::new(&copy, SIZE), false);
    (
        ["first/out", "second/out"].map(|part| folder.join(part)),
        [first, second],
    )
}

/// Largest difference of a channel of a copy from the map, in steps of 8 bits. A copy's maps are 8 bit: half a step
/// from writing them, and half a step from the rounding now; dithering moves a value by a step. A normal's length is
/// lost with its last digits, which moves its components by half a step more. A code of emission stands for four times
/// as much light in the copy as in the map.
const STEPS: [(&str, f64); 13] = [
    ("base_color", 1.0),
    ("opacity", 1.0),
    ("roughness", 2.0),
    ("metallic", 2.0),
    ("normal", 1.5),
    ("emission", 3.0),
    ("coat", 2.0),
    ("coat_roughness", 2.0),
    // A direction is made longer or shorter to a unit again.
    ("anisotropy", 2.0),
    ("sheen", 1.0),
    ("sheen_roughness", 2.0),
    // Share and color are apart in the copy.
    ("subsurface", 1.0),
    ("transmission", 2.0),
];

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
    let model = ModelOptions::new(&project("assets/meshes/bench.glb"), SIZE);
    let owned = owned(&LinkedModel::open(&model, &NoProgress).unwrap()).remove(0);
    let both = |file: &str| [&first, &second].map(|folder| folder.join(file));
    for (channel, steps) in STEPS {
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
    assert!(
        !was.iter().any(|entry| entry.contains("coat")),
        "a set without a coat mentions none: {was:?}"
    );
    assert_eq!(was, is);
}

/// A sculpture of two materials with vertex colors and without texture coordinates: a lumpy ring.
fn ring() -> String {
    let (around, across) = (14, 9);
    let turn = |at: usize, of: usize| (at % of) as f64 / of as f64 * std::f64::consts::TAU;
    let mut text = "o ring\n".to_owned();
    for i in 0..around {
        for j in 0..across {
            let (a, b) = (turn(i, around), turn(j, across));
            let radius = 1.0 + (0.35 + 0.05 * (3.0 * a).sin() * (2.0 * b).cos()) * b.cos();
            let place = [radius * a.cos(), 0.4 * b.sin(), radius * a.sin()];
            let color = [a.cos().abs(), b.sin().abs(), 0.5];
            let numbers: Vec<String> = place.iter().chain(&color).map(f64::to_string).collect();
            text += &format!("v {}\n", numbers.join(" "));
        }
    }
    for i in 0..around {
        if i % (around / 2) == 0 {
            text += ["usemtl wood\n", "usemtl steel\n"][i / (around / 2)];
        }
        for j in 0..across {
            let at = |i: usize, j: usize| 1 + (i % around) * across + j % across;
            let corners = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)].map(|at| at.to_string());
            text += &format!("f {}\n", corners.join(" "));
        }
    }
    text
}

/// Two squares with the same texture coordinates.
fn stacked() -> Vec<u8> {
    let square = |z: f32| Quad {
        corners: [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    };
    MeshFile::new(vec![square(0.0), square(1.0)]).glb()
}

/// Properties of every triangle that a copy must keep, as exact bits: material, positions and texture coordinates.
fn triangles(model: &Model) -> Vec<(String, Vec<u32>)> {
    let mesh = &model.mesh;
    let of = |(corners, material): (&[u32; 3], &u32)| {
        let values = corners.iter().flat_map(|&at| {
            let at = at as usize;
            let uv = mesh.uvs.get(at).into_iter().flatten();
            mesh.positions[at].iter().chain(uv).map(|value| value.to_bits())
        });
        (model.materials[*material as usize].name.clone(), values.collect())
    };
    let mut all: Vec<_> = mesh.triangles.iter().zip(&mesh.triangle_material).map(of).collect();
    all.sort_unstable();
    all
}

/// Compares the maps of each material of a copy with those of the sheet.
fn assert_shows(folder: &Path, stem: &str, copy: &LinkedModel) {
    let names = set_names(&copy.model);
    assert_eq!(owned(copy).len(), names.len());
    for (owned, of_set) in owned(copy).iter().zip(&names) {
        for (channel, steps) in STEPS {
            let files = [
                folder.join(format!("first/out/{stem}_{channel}.png")),
                folder.join(format!("second/out/{of_set}_{channel}.png")),
            ];
            // On a flat model the scratches have one direction, which both reports give as a constant.
            if channel == "anisotropy" && files.iter().all(|file| !file.exists()) {
                continue;
            }
            let furthest = furthest(owned, files);
            assert!(
                furthest <= steps / 255.0 + 1e-6,
                "{stem} {of_set} {channel}: {furthest}"
            );
        }
    }
}

#[test]
fn a_copy_of_an_unwrapped_model_shows_the_maps_that_were_baked_and_keeps_its_triangles() {
    let bench = fs::read(project("assets/meshes/bench.glb")).unwrap();
    // Named so, it is an attribute of the file's own that nobody knows.
    let mut bare = bench.clone();
    let names: Vec<usize> = (0..bare.len() - 9)
        .filter(|&at| bare[at..].starts_with(b"\"TEXCOORD_"))
        .collect();
    names.into_iter().for_each(|at| bare[at + 1] = b'_');
    let cases = [
        ("ring.obj", ring().into_bytes(), Overlap::First, 0),
        ("bare.glb", bare, Overlap::First, 0),
        ("stacked.glb", stacked(), Overlap::Unwrap, 1),
    ];
    for (name, bytes, overlap, uv) in cases {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let options = ModelOptions {
            overlap,
            ..ModelOptions::new(&path, SIZE)
        };
        let first = bake_to(&folder.path().join("first"), WORN, options, true);
        assert_eq!(first["mesh"]["unwrapped"]["uv_set"], uv, "{name}");
        let copy = folder
            .path()
            .join("first/out")
            .join(first["model"]["path"].as_str().unwrap());
        let of_copy = |uv| ModelOptions {
            uv,
            ..ModelOptions::new(&copy, SIZE)
        };
        bake_to(&folder.path().join("second"), MODEL, of_copy(uv), false);
        let linked = LinkedModel::open(&of_copy(uv), &NoProgress).unwrap();
        assert_eq!(linked.unwrapped, None, "{name}");
        assert_shows(folder.path(), name.split('.').next().unwrap(), &linked);
        // The sets that the model had are still there, before the new one.
        let [mut was, mut is] =
            [&path, &copy].map(|path| LinkedModel::load_model(&ModelOptions::new(path, SIZE), &NoProgress).unwrap());
        if uv == 0 {
            for model in [&mut was, &mut is] {
                model.mesh.uvs.clear();
            }
        }
        // Viewers would multiply the maps by vertex colors.
        assert!(is.mesh.colors.is_empty(), "{name}");
        assert_eq!(was.parts, is.parts, "{name}");
        assert!(triangles(&was) == triangles(&is), "{name}");
        // One picture of each kind, however many materials: color and opacity, packed, normal, emission, coat, anisotropy,
        // sheen, subsurface, transmission.
        // On a flat one the direction of scratches is a number.
        let is_flat = name == "stacked.glb";
        assert_eq!(is.images.len(), 9 - usize::from(is_flat), "{name}");
    }
}
