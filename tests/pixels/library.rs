//! The groups of the effect library: results are numbers in range in every variant, and Amount is a share of the surface.

use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::effect_library;
use sabi_tests::{OnMesh, project};
use serde_json::{Value, json};

/// Models that shares are measured on, one for each group in turn.
const MODELS: [&str; 6] = ["crate", "bench", "figure", "column", "chain", "barrel"];

/// Groups whose mask is no share of the surface that Amount tells, each with its reason.
const OTHER_AMOUNTS: [(&str, &str); 5] = [
    (
        "dents",
        "Amount is the share in which dents lie, and the mask is the dents",
    ),
    ("markings", "Amount is the share of a band before it is worn"),
    ("match_reference", "Amount is a strength"),
    (
        "per_part_random",
        "the mask is a random value of each piece, of which Amount picks some",
    ),
    (
        "scratches",
        "Amount is the share in which scratches lie, and the mask is the scratches",
    ),
];

/// Files of the library with what they hold, by category and name.
fn groups() -> Vec<(PathBuf, Value)> {
    let sorted = |folder: &Path| {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.sort();
        paths
    };
    let root = effect_library(Path::new("")).expect("the library of the project");
    let files = sorted(&root).into_iter().flat_map(|category| sorted(&category));
    files
        .map(|file| {
            let text = fs::read_to_string(&file).expect("a graph");
            (file, serde_json::from_str(&text).expect("JSON"))
        })
        .collect()
}

fn instance(file: &Path, params: Value) -> String {
    let instance = json!({ "kind": "graph/group", "group": file, "params": params });
    // Nodes that change nothing, since an instance has no results of its own.
    let material = json!({ "kind": "material/adjust", "inputs": { "material": "g.material" } });
    let mask = json!({ "kind": "adjust/clamp", "inputs": { "source": "g.mask" } });
    let nodes = json!({ "g": instance, "mask": mask, "material": material });
    json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string()
}

#[test]
fn every_variant_of_every_group_gives_numbers_in_range() {
    let bench = project("assets/meshes/bench.glb");
    for (file, document) in groups() {
        let mut on_mesh = OnMesh::new(&instance(&file, json!({})), &bench, 64);
        let variants = document["variants"].as_object().into_iter().flatten();
        let variants: Vec<Value> = variants.map(|(name, _)| json!({ "variant": name })).collect();
        for params in std::iter::once(json!({})).chain(variants) {
            on_mesh.set_graph(&instance(&file, params.clone()));
            let material = on_mesh.evaluate("material");
            for (channel, low, high) in [
                ("base_color.r", 0.0, 1.0),
                ("base_color.g", 0.0, 1.0),
                ("base_color.b", 0.0, 1.0),
                ("roughness", 0.0, 1.0),
                ("metallic", 0.0, 1.0),
            ] {
                let values = material.component(channel);
                for (index, _) in on_mesh.owned() {
                    let value = values[index];
                    assert!(
                        (low - 1e-3..=high + 1e-3).contains(&value),
                        "{} {params}: {channel} is {value}",
                        file.display()
                    );
                }
            }
        }
    }
}

#[test]
fn amount_is_the_share_of_the_surface_that_a_group_covers() {
    let mut wrong = Vec::new();
    let is_share = |file: &Path| {
        let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        !is_base(file) && OTHER_AMOUNTS.iter().all(|(name, _)| Some(*name) != stem.as_deref())
    };
    let shares = groups().into_iter().filter(|(file, _)| is_share(file));
    for (number, (file, _)) in shares.enumerate() {
        let model = MODELS[number % MODELS.len()];
        let mesh = project(&format!("assets/meshes/{model}.glb"));
        let mut on_mesh = OnMesh::new(&instance(&file, json!({ "amount": 0.3 })), &mesh, 256);
        let mask = on_mesh.evaluate("mask").component("mask");
        let share = on_mesh.mean(&mask);
        if (share - 0.3).abs() > 0.02 {
            wrong.push(format!("{} covers {share:.3} of the {model}", file.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Base materials cover all of the surface; their Amount is the strength of a variation.
fn is_base(file: &Path) -> bool {
    file.parent().is_some_and(|folder| folder.ends_with("base"))
}

/// Ranges of base colors that physically based renderers expect, linear luminance: of anything but metal, and of bare metal.
const SAFE_DIELECTRIC: [f64; 2] = [0.012, 0.87];
const SAFE_METAL: [f64; 2] = [0.2, 1.0];

#[test]
fn base_materials_have_colors_that_exist_and_a_roughness_that_varies() {
    let figure = project("assets/meshes/figure.glb");
    let mut wrong = Vec::new();
    for (file, document) in groups().into_iter().filter(|(file, _)| is_base(file)) {
        let mut on_mesh = OnMesh::new(&instance(&file, json!({})), &figure, 128);
        let variants = document["variants"].as_object().into_iter().flatten();
        let variants: Vec<Value> = variants.map(|(name, _)| json!({ "variant": name })).collect();
        for params in std::iter::once(json!({})).chain(variants) {
            on_mesh.set_graph(&instance(&file, params.clone()));
            let material = on_mesh.evaluate("material");
            let [red, green, blue] = ["r", "g", "b"].map(|part| material.component(&format!("base_color.{part}")));
            let [roughness, metallic] = ["roughness", "metallic"].map(|channel| material.component(channel));
            let mut unsafe_texels = [0_usize; 2];
            let mut all = 0;
            for (index, _) in on_mesh.owned() {
                let light = 0.2126 * red[index] + 0.7152 * green[index] + 0.0722 * blue[index];
                let is_metal = metallic[index] > 0.5;
                let [low, high] = if is_metal { SAFE_METAL } else { SAFE_DIELECTRIC };
                unsafe_texels[usize::from(is_metal)] += usize::from(!(low..=high).contains(&f64::from(light)));
                all += 1;
            }
            let mean = on_mesh.mean(&roughness);
            let squares: Vec<f32> = roughness.iter().map(|value| (value - mean as f32).powi(2)).collect();
            let deviation = on_mesh.mean(&squares).sqrt();
            let share = |count: usize| count as f64 / all as f64;
            let [dielectric, metal] = unsafe_texels.map(share);
            if dielectric > 0.05 || metal > 0.05 || deviation < 0.01 {
                wrong.push(format!(
                    "{} {params}: {dielectric:.2} and {metal:.2} of the texels are out of range, roughness ± {deviation:.3}",
                    file.display()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
