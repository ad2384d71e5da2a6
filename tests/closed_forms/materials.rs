//! Materials that are split, combined, adjusted and dented.

use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, NodeResult, OnMesh, project};
use serde_json::{Map, Value as Json, json};

const CHANNELS: [&str; 15] = [
    "base_color",
    "alpha",
    "roughness",
    "metallic",
    "occlusion",
    "height",
    "slope",
    "emission",
    "coat",
    "coat_roughness",
    "anisotropy",
    "sheen",
    "sheen_roughness",
    "subsurface",
    "transmission",
];

/// Components to compare, without the normal: where a height jumps at the cube's edge, the normal depends on more than the material.
const COMPONENTS: [&str; 23] = [
    "base_color.r",
    "base_color.g",
    "base_color.b",
    "alpha",
    "roughness",
    "metallic",
    "occlusion",
    "height",
    "slope.x",
    "slope.y",
    "slope.z",
    "emission.r",
    "emission.b",
    "coat",
    "coat_roughness",
    "anisotropy.x",
    "anisotropy.y",
    "anisotropy.z",
    "sheen.r",
    "sheen_roughness",
    "subsurface.r",
    "subsurface.b",
    "transmission",
];

/// Returns a graph of `varied`, a material that sets every channel, and these nodes.
fn graph(nodes: Json) -> String {
    let clouds = |seed: u32| json!({ "kind": "noise/simplex", "params": { "size": 0.6, "octaves": 2, "seed": seed } });
    let tinted = json!({ "kind": "color/gradient", "inputs": { "source": "one" },
                         "params": { "stops": [[0.2, "#20304a"], [0.8, "#e0b070"]] } });
    let varied = json!({ "kind": "material/combine", "inputs": {
        "base_color": "tinted", "alpha": "one", "roughness": "two", "metallic": "one", "occlusion": "two", "height": "one",
        "slope": "place.position", "emission": "tinted", "coat": "two", "coat_roughness": "one",
        "anisotropy": "place.position", "sheen": "tinted", "sheen_roughness": "two", "subsurface": "tinted",
        "transmission": "one" } });
    let mut all = json!({
        "one": clouds(1), "two": clouds(2), "tinted": tinted, "place": { "kind": "surface/position" }, "varied": varied,
    });
    let (all, more) = (all.as_object_mut().expect("nodes"), nodes.as_object().expect("nodes"));
    all.extend(more.clone());
    json!({ "format": "sabi", "version": 1, "nodes": all }).to_string()
}

fn on_cube(nodes: Json) -> OnMesh {
    OnMesh::new(&graph(nodes), &project("assets/meshes/cube.glb"), 64)
}

fn hold_equal(on_mesh: &OnMesh, what: &str, one: &NodeResult, other: &NodeResult) {
    for component in COMPONENTS {
        let (was, is) = (one.component(component), other.component(component));
        for (index, _) in on_mesh.owned() {
            assert_eq!(was[index], is[index], "{what}: {component}");
        }
    }
}

#[test]
fn what_is_split_and_combined_again_is_the_same() {
    let inputs: Map<String, Json> = CHANNELS
        .iter()
        .map(|channel| ((*channel).to_owned(), json!(format!("apart.{channel}"))))
        .collect();
    let mut on_mesh = on_cube(json!({
        "apart": { "kind": "material/split", "inputs": { "material": "varied" } },
        "again": { "kind": "material/combine", "inputs": inputs },
    }));
    for mode in [Mode::Bake { fuse: true }, Mode::Bake { fuse: false }, Mode::Interactive] {
        let mut as_mode = |node| {
            on_mesh.evaluate_as(
                node,
                EvaluationOptions {
                    mode,
                    ..EvaluationOptions::baked()
                },
            )
        };
        let (varied, again) = (as_mode("varied"), as_mode("again"));
        hold_equal(&on_mesh, &format!("{mode:?}"), &varied, &again);
    }
}

#[test]
fn alone_both_are_the_plain_material() {
    let mut on_mesh = on_cube(json!({
        "plain": { "kind": "effect/layer", "params": { "opacity": 0 } },
        "combined": { "kind": "material/combine" },
    }));
    let (plain, combined) = (on_mesh.evaluate("plain"), on_mesh.evaluate("combined"));
    for component in &COMPONENTS[..7] {
        let (was, is) = (plain.component(component), combined.component(component));
        for (index, _) in on_mesh.owned() {
            // The plain gray is 0.214, the knob's color its nearest 8-bit code.
            assert!(
                (was[index] - is[index]).abs() < 2.5e-3,
                "{component}: {} and {}",
                was[index],
                is[index]
            );
        }
    }
}

#[test]
fn an_adjustment_with_nothing_set_or_an_empty_mask_changes_nothing() {
    let strong = json!({
        "hue": 90, "saturation": 2, "value": 0.5, "roughness": 0.3, "metallic": 1, "height": 0.1, "height_scale": 3,
        "slope_scale": 0, "roughness_scale": 0.5,
    });
    let adjusted = |mask: &str, params: Json| json!({ "kind": "material/adjust", "inputs": { "material": "varied", "mask": mask }, "params": params });
    let mut faded = strong.clone();
    faded["opacity"] = json!(0);
    let mut on_mesh = on_cube(json!({
        "none": { "kind": "adjust/levels", "params": { "high": 0 } },
        "default": adjusted("two", json!({})),
        "masked": adjusted("none", strong),
        "faded": adjusted("two", faded),
    }));
    let varied = on_mesh.evaluate("varied");
    for node in ["default", "masked", "faded"] {
        let evaluated = on_mesh.evaluate(node);
        hold_equal(&on_mesh, node, &varied, &evaluated);
    }
}

/// Formula for the new value of a channel.
type ChannelFormula = fn(f32) -> f32;

#[test]
fn an_adjustment_does_to_each_channel_what_its_name_says() {
    let params = json!({
        "roughness": 0.1, "roughness_scale": 0.5, "metallic": -1, "height": -0.25, "height_scale": 2, "slope_scale": -1,
        "value": 0.5, "opacity": 0.5,
    });
    let node = json!({ "kind": "material/adjust", "inputs": { "material": "varied" }, "params": params });
    let mut on_mesh = on_cube(json!({ "node": node }));
    let (varied, adjusted) = (on_mesh.evaluate("varied"), on_mesh.evaluate("node"));
    let expected: [(&str, ChannelFormula); 7] = [
        ("base_color.r", |was| 0.75 * was),
        ("alpha", |was| was),
        ("roughness", |was| was + 0.5 * (0.1 - 0.5 * was)),
        ("metallic", |was| (was - 0.5).max(0.0)),
        ("height", |was| was + 0.5 * (was - 0.25)),
        ("slope.y", |_| 0.0),
        ("emission.r", |was| was),
    ];
    for (component, formula) in expected {
        let (was, is) = (varied.component(component), adjusted.component(component));
        for (index, _) in on_mesh.owned() {
            let expected = formula(was[index]);
            // Half floats.
            assert!(
                (is[index] - expected).abs() < 1e-3,
                "{component}: {} became {}",
                was[index],
                is[index]
            );
        }
    }
}

/// Returns mask and height of a relief over a flat material, sorted by mask.
fn relief(params: Json) -> Vec<(f32, f32)> {
    let node = json!({ "kind": "effect/relief", "inputs": { "mask": "ramp" }, "params": params });
    let mut on_mesh = on_cube(json!({ "ramp": { "kind": "surface/position" }, "node": node }));
    let mask = on_mesh.evaluate("ramp").component("mask");
    let height = on_mesh.evaluate("node").component("height");
    let mut pairs: Vec<(f32, f32)> = on_mesh.owned().map(|(index, _)| (mask[index], height[index])).collect();
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
    pairs
}

#[test]
fn every_profile_of_a_relief_goes_from_nothing_to_its_depth_without_a_jump() {
    let depth = 0.02;
    let profiles = [
        ("sunk", -1.0),
        ("raised", 1.0),
        ("dent", -1.0),
        ("bump", 1.0),
        ("groove", -1.0),
        ("ridge", 1.0),
        ("cut", -1.0),
        ("plateau", 1.0),
    ];
    for (profile, side) in profiles {
        let pairs = relief(json!({ "depth": depth, "profile": profile }));
        let (first, last) = (pairs[0], pairs[pairs.len() - 1]);
        assert!(first.1.abs() <= 1.1 * depth * first.0, "{profile} begins at {first:?}");
        assert!(
            (last.1 - side * depth).abs() <= 1.1 * depth * (1.0 - last.0),
            "{profile} ends at {last:?}"
        );
        let steepest = if matches!(profile, "cut" | "plateau") { 7.6 } else { 3.0 };
        for pair in pairs.windows(2) {
            let (run, rise) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            assert!(
                rise.abs() <= steepest * depth * run + 1e-7,
                "{profile} jumps at {pair:?}"
            );
        }
        let against = pairs.iter().map(|(_, height)| -side * height).fold(0.0, f32::max);
        if matches!(profile, "groove" | "ridge") {
            assert!(
                (0.18..0.22).contains(&(against / depth)),
                "the burr of {profile} is {against} high"
            );
        } else {
            assert_eq!(against, 0.0, "{profile} goes the other way");
        }
    }
}

#[test]
fn a_relief_changes_only_the_height_and_the_roughness() {
    let node = json!({ "kind": "effect/relief", "inputs": { "base": "varied", "mask": "two", "height_map": "one" },
                       "params": { "depth": 0.1, "roughness": -0.25, "profile": "raised" } });
    let mut on_mesh = on_cube(json!({ "node": node }));
    let (before, after) = (on_mesh.evaluate("varied"), on_mesh.evaluate("node"));
    let [one, two] = ["one", "two"].map(|id| on_mesh.evaluate(id).component("mask"));
    for component in COMPONENTS {
        let (was, is) = (before.component(component), after.component(component));
        for (index, _) in on_mesh.owned() {
            let expected = match component {
                "height" => was[index] + 0.1 * one[index] * two[index],
                "roughness" => (was[index] - 0.25 * two[index]).clamp(0.0, 1.0),
                _ => was[index],
            };
            let allowed = match component {
                "height" => 1e-6,
                // Half floats, below 1.
                "roughness" => 1e-3,
                _ => 0.0,
            };
            assert!(
                (is[index] - expected).abs() <= allowed,
                "{component}: {} became {}",
                was[index],
                is[index]
            );
        }
    }
}
