//! The groups of the effect library: results are numbers in range in every variant, and Amount is a share of the surface.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::effect_library::effect_library;
use sabi_gpu::ResultCache;
use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, NodeResult, OnMesh, project};
use serde_json::{Value, json};

/// Models that shares are measured on.
const MODELS: [&str; 6] = ["crate", "bench", "figure", "column", "chain", "barrel"];

/// Groups for which Amount is not the share of the surface that the mask covers, each with its reason.
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

/// A graph with an instance of a group over a plain gray material.
fn instance(file: &Path, params: Value) -> String {
    let gray = json!({ "kind": "source/material", "params": { "color": "#808080" } });
    let has_material = !is_base(file);
    let inputs = if has_material {
        json!({ "material": "gray" })
    } else {
        json!({})
    };
    let instance = json!({ "kind": "graph/group", "group": file, "params": params, "inputs": inputs });
    // Nodes that change nothing, since an instance has no results of its own.
    let material = json!({ "kind": "material/adjust", "inputs": { "material": "g.material" } });
    let mask = json!({ "kind": "adjust/clamp", "inputs": { "source": "g.mask" } });
    let nodes = json!({ "g": instance, "gray": gray, "mask": mask, "material": material });
    json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string()
}

/// Evaluates a result with one kernel for each kind of node, which all groups share; fused kernels would take longer to compile
/// than they run here.
fn evaluate(on_mesh: &mut OnMesh, node: &str) -> NodeResult {
    let asked = EvaluationOptions {
        mode: Mode::Interactive,
        cache: None,
    };
    on_mesh.evaluate_as(node, asked)
}

/// Returns the settings of a group that are tested: its own values and each variant.
fn looks(document: &Value) -> Vec<Value> {
    let variants = document["variants"].as_object().into_iter().flatten();
    let variants = variants.map(|(name, _)| json!({ "variant": name }));
    std::iter::once(json!({})).chain(variants).collect()
}

#[test]
fn every_variant_of_every_group_gives_numbers_in_range_and_colors_that_exist() {
    let bench = project("assets/meshes/bench.glb");
    let mut wrong = Vec::new();
    for (file, document) in groups() {
        let mut on_mesh = OnMesh::new(&instance(&file, json!({})), &bench, 64);
        for params in looks(&document) {
            on_mesh.set_graph(&instance(&file, params.clone()));
            let material = evaluate(&mut on_mesh, "material");
            for channel in ["base_color.r", "base_color.g", "base_color.b", "roughness", "metallic"] {
                let values = material.component(channel);
                let outside = on_mesh
                    .owned()
                    .find(|(index, _)| !(-1e-3..=1.0 + 1e-3).contains(&values[*index]));
                if let Some((index, _)) = outside {
                    wrong.push(format!("{} {params}: {channel} is {}", file.display(), values[index]));
                }
            }
            let [dielectric, metal] = unsafe_shares(&on_mesh, &material);
            if dielectric > 0.05 || metal > 0.05 {
                wrong.push(format!(
                    "{} {params}: {dielectric:.2} and {metal:.2} of the texels have colors that nothing has",
                    file.display()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Share of the surface that the mask of a group covers.
fn share_of(on_mesh: &mut OnMesh) -> f64 {
    let mask = evaluate(on_mesh, "mask").component("mask");
    on_mesh.mean(&mask)
}

#[test]
fn amount_is_the_share_of_the_surface_that_a_group_covers_on_any_model() {
    let mut wrong = Vec::new();
    let is_share = |file: &Path| {
        let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        !is_base(file) && OTHER_AMOUNTS.iter().all(|(name, _)| Some(*name) != stem.as_deref())
    };
    let shares: Vec<PathBuf> = groups()
        .into_iter()
        .map(|(file, _)| file)
        .filter(|file| is_share(file))
        .collect();
    for model in MODELS {
        let mesh = project(&format!("assets/meshes/{model}.glb"));
        let mut on_mesh = OnMesh::new(&instance(&shares[0], json!({})), &mesh, 96);
        for file in &shares {
            let graph = instance(file, json!({ "amount": 0.3 }));
            on_mesh.set_graph(&graph);
            let mut share = share_of(&mut on_mesh);
            if (share - 0.3).abs() > 0.02 {
                // Borders of a few texels are too wide or too narrow on a small map, so a larger one is used.
                share = share_of(&mut OnMesh::new(&graph, &mesh, 256));
            }
            if (share - 0.3).abs() > 0.02 {
                wrong.push(format!("{} covers {share:.3} of the {model}", file.display()));
            }
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

/// Shares of the texels of a material whose base color does not exist: of anything but metal, and of metal.
fn unsafe_shares(on_mesh: &OnMesh, material: &NodeResult) -> [f64; 2] {
    let [red, green, blue] = ["r", "g", "b"].map(|part| material.component(&format!("base_color.{part}")));
    let metallic = material.component("metallic");
    let mut unsafe_texels = [0_usize; 2];
    let mut all = 0;
    for (index, _) in on_mesh.owned() {
        let light = 0.2126 * red[index] + 0.7152 * green[index] + 0.0722 * blue[index];
        let is_metal = metallic[index] > 0.5;
        let [low, high] = if is_metal { SAFE_METAL } else { SAFE_DIELECTRIC };
        unsafe_texels[usize::from(is_metal)] += usize::from(!(low..=high).contains(&f64::from(light)));
        all += 1;
    }
    unsafe_texels.map(|count| count as f64 / f64::from(all))
}

/// Radii that separate fine, middle and broad differences, as shares of the model.
const SCALES: [f32; 3] = [0.008, 0.04, 0.2];
/// Minimum standard deviation of the roughness of a base material at each of the three scales, fine to broad. Most of the
/// fine differences are finer than the texels here.
const LEAST_SPREADS: [f64; 3] = [0.002, 0.004, 0.004];

#[test]
fn base_materials_vary_in_roughness_at_three_sizes() {
    let figure = project("assets/meshes/figure.glb");
    let mut wrong = Vec::new();
    for (file, document) in groups().into_iter().filter(|(file, _)| is_base(file)) {
        let graph = |params: &Value| {
            let mut graph: Value = serde_json::from_str(&instance(&file, params.clone())).expect("a graph");
            graph["nodes"]["channels"] = json!({ "kind": "material/split", "inputs": { "material": "material" } });
            for (number, radius) in SCALES.iter().enumerate() {
                let inputs = json!({ "source": "channels.roughness" });
                let blur = json!({ "kind": "filter/blur", "inputs": inputs, "params": { "radius": radius } });
                graph["nodes"][format!("blur_{number}")] = blur;
            }
            graph.to_string()
        };
        let mut on_mesh = OnMesh::new(&graph(&json!({})), &figure, 128);
        let mut cache = ResultCache::new(1 << 30);
        for params in looks(&document) {
            on_mesh.set_graph(&graph(&params));
            let levels = ["channels.roughness", "blur_0", "blur_1", "blur_2"].map(|node| {
                let asked = EvaluationOptions {
                    mode: Mode::Interactive,
                    cache: Some(&mut cache),
                };
                on_mesh.evaluate_as(node, asked).component("mask")
            });
            let spreads = [0, 1, 2].map(|scale| {
                let apart: Vec<f32> = levels[scale]
                    .iter()
                    .zip(&levels[scale + 1])
                    .map(|(finer, coarser)| (finer - coarser).powi(2))
                    .collect();
                on_mesh.mean(&apart).sqrt()
            });
            if spreads.iter().zip(LEAST_SPREADS).any(|(spread, least)| *spread < least) {
                wrong.push(format!(
                    "{} {params}: the roughness varies by {spreads:.4?}",
                    file.display()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Base materials that are laid in rows, which are intended to repeat.
const REGULAR: [&str; 4] = ["masonry", "cloth_and_leather", "concrete", "wood"];

#[test]
fn no_base_material_repeats() {
    // One side of a cube: a square of texels that are next to each other on the surface.
    let cube = project("assets/meshes/cube.glb");
    let mut wrong = Vec::new();
    for (file, _) in groups().into_iter().filter(|(file, _)| is_base(file)) {
        let stem = file.file_stem().expect("a file").to_string_lossy().into_owned();
        if REGULAR.contains(&stem.as_str()) {
            continue;
        }
        let mut on_mesh = OnMesh::new(&instance(&file, json!({})), &cube, 256);
        let green = evaluate(&mut on_mesh, "material").component("base_color.g");
        let side = without_outliers(square(&on_mesh, &green));
        let repeats = highest_correlation(&side);
        if repeats > 0.6 {
            wrong.push(format!("{stem} is like itself by {repeats:.2} somewhere else"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Values of the largest square of owned texels, row by row. Charts do not touch, so it lies on one of them.
fn square(on_mesh: &OnMesh, values: &[f32]) -> Vec<Vec<f32>> {
    let texels: BTreeMap<[u32; 3], usize> = on_mesh
        .owned()
        .map(|(index, _)| {
            let [page, x, y] = on_mesh.texel(index);
            ([page, y, x], index)
        })
        .collect();
    // Side of the largest square that ends at each texel, from those that end above, left and in between.
    let mut sides: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for [page, y, x] in texels.keys().copied() {
        let ended = |up: u32, left: u32| {
            let at = [page, y.checked_sub(up)?, x.checked_sub(left)?];
            sides.get(&at).copied()
        };
        let before = [ended(1, 0), ended(0, 1), ended(1, 1)].map(|side| side.unwrap_or(0)); // None where no texel is.
        sides.insert([page, y, x], 1 + before[0].min(before[1]).min(before[2]));
    }
    let (end, side) = sides.iter().max_by_key(|(_, side)| **side).expect("texels");
    let [page, bottom, right] = *end;
    let rows = (bottom + 1 - side..=bottom).map(|y| {
        let row = (right + 1 - side..=right).map(|x| values[texels[&[page, y, x]]]);
        row.collect()
    });
    rows.collect()
}

/// A picture whose values lie within two standard deviations of their mean: a few bright chips on edges that face each other are no
/// repetition.
fn without_outliers(rows: Vec<Vec<f32>>) -> Vec<Vec<f32>> {
    let values: Vec<f64> = rows.iter().flatten().map(|value| f64::from(*value)).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    let [low, high] = [-2.0, 2.0].map(|times| (mean + times * variance.sqrt()) as f32);
    let limited = |row: Vec<f32>| row.into_iter().map(|value| value.clamp(low, high)).collect();
    rows.into_iter().map(limited).collect()
}

/// Highest correlation of a picture with itself, moved by an eighth to a half of its sides.
fn highest_correlation(rows: &[Vec<f32>]) -> f32 {
    let (height, width) = (rows.len(), rows[0].len());
    assert!(height >= 48 && width >= 48, "{width} × {height} texels are too few");
    let moves = |side: usize| (0..side / 2).step_by(2);
    let mut highest = 0.0_f32;
    for down in moves(height) {
        for right in moves(width) {
            if down < height / 8 && right < width / 8 {
                continue;
            }
            let pairs = (0..height - down).step_by(2).flat_map(|y| {
                let pair = move |x: usize| (rows[y][x], rows[y + down][x + right]);
                (0..width - right).step_by(2).map(pair)
            });
            highest = highest.max(correlation(pairs));
        }
    }
    highest
}

fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f32 {
    let mut sums = [0.0_f64; 6];
    for (one, other) in pairs {
        let (one, other) = (f64::from(one), f64::from(other));
        for (sum, value) in sums
            .iter_mut()
            .zip([1.0, one, other, one * one, other * other, one * other])
        {
            *sum += value;
        }
    }
    let [count, one, other, of_one, of_other, both] = sums;
    let [mean_one, mean_other] = [one / count, other / count];
    let variance = (of_one / count - mean_one.powi(2)) * (of_other / count - mean_other.powi(2));
    ((both / count - mean_one * mean_other) / variance.max(1e-18).sqrt()) as f32
}
