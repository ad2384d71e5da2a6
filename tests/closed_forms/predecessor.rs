//! Defects of the thesis' tool that cannot occur here: blending.

use sabi_plan::Mode;
use sabi_tests::{EvaluationOptions, OnMesh};
use serde_json::{Value as Json, json};

use crate::waves::{Chart, plane};

/// Texels across the plane.
const SIZE: u32 = 64;

/// Precision of half floats below 1.
const HALF: f32 = 1.0 / 2048.0;

/// These nodes, with `ramp` from 0 to 1 along x, on a plane.
fn on_plane(nodes: &Json) -> OnMesh {
    let mut nodes = nodes.clone();
    nodes["ramp"] = json!({ "kind": "surface/position", "params": { "along": [1, 0, 0] } });
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes });
    OnMesh::new(&graph.to_string(), plane(Chart::straight(1.0)).path(), SIZE)
}

/// Values of a result's component on owned texels, beside the values of the mask `ramp` there, in its order.
fn along_the_ramp(on_mesh: &mut OnMesh, target: &str, component: &str) -> Vec<(f32, f32)> {
    let ramp = on_mesh.evaluate("ramp").component("mask");
    let values = on_mesh.evaluate(target).component(component);
    let mut pairs: Vec<(f32, f32)> = on_mesh.owned().map(|(index, _)| (ramp[index], values[index])).collect();
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
    assert!(pairs.first().is_some_and(|first| first.0 < 0.01) && pairs.last().is_some_and(|last| last.0 > 0.99));
    pairs
}

/// Returns one effect over a gray base of roughness 0.5, masked by the ramp.
fn layer(params: Json) -> Json {
    json!({
        "base": { "kind": "source/material", "params": { "color": "#808080", "roughness": 0.5, "metallic": 0.5 } },
        "node": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "ramp" }, "params": params },
    })
}

/// `#808080`, linear.
const GRAY: f32 = 0.215_860_5;

#[test]
fn white_over_gray_with_a_soft_mask_is_never_darker_than_gray() {
    let mut on_mesh = on_plane(&layer(json!({ "color": "#ffffff" })));
    let mut last = GRAY - HALF;
    for (mask, value) in along_the_ramp(&mut on_mesh, "node", "base_color.g") {
        assert!(value >= last, "{value} behind {last} at a mask of {mask}");
        last = value;
        // The mask is exactly the share: neither squared nor multiplied by five.
        let expected = GRAY + (1.0 - GRAY) * mask;
        assert!(
            (value - expected).abs() <= HALF,
            "{value}, not {expected}, at a mask of {mask}"
        );
    }
}

#[test]
fn multiplying_by_white_changes_nothing_at_any_mask() {
    let params = json!({
        "color": "#ffffff", "color_mode": "multiply", "roughness": 1, "roughness_mode": "multiply", "metallic": 1,
        "metallic_mode": "multiply",
    });
    let mut on_mesh = on_plane(&layer(params));
    for (component, expected) in [("base_color.r", GRAY), ("roughness", 0.5), ("metallic", 0.5)] {
        for (mask, value) in along_the_ramp(&mut on_mesh, "node", component) {
            assert!(
                (value - expected).abs() <= HALF / 4.0,
                "{component} is {value} at a mask of {mask}"
            );
        }
    }
}

#[test]
fn a_scalar_multiply_is_continuous_where_the_mask_fades() {
    let mut on_mesh = on_plane(&layer(json!({ "roughness": 0, "roughness_mode": "multiply" })));
    for (mask, value) in along_the_ramp(&mut on_mesh, "node", "roughness") {
        let expected = 0.5 * (1.0 - mask);
        assert!(
            (value - expected).abs() <= HALF,
            "{value}, not {expected}, at a mask of {mask}"
        );
    }
}

#[test]
fn no_mode_jumps_at_the_border_of_a_mask() {
    let modes = "normal add subtract multiply screen overlay soft_light hard_light min max difference divide";
    let mut on_mesh = on_plane(&layer(json!({})));
    for mode in modes.split(' ') {
        let params = json!({
            "color": "#c0c0c0", "color_mode": mode, "roughness": 0.2, "roughness_mode": mode, "metallic": 0.9,
            "metallic_mode": mode,
        });
        set_nodes(&mut on_mesh, layer(params));
        for component in ["base_color.b", "roughness", "metallic"] {
            let pairs = along_the_ramp(&mut on_mesh, "node", component);
            let steps = pairs.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
            // Nothing is steeper than the blend from 0.5 to the result of a division by 0.2, spread over all texels.
            let allowed = 2.5 / SIZE as f32 + 2.0 * HALF;
            assert!(steps.fold(0.0, f32::max) <= allowed, "{mode}: {component} jumps");
            let before = if component.starts_with("base") { GRAY } else { 0.5 };
            let first = pairs[0];
            assert!(
                (first.1 - before).abs() <= 2.5 * first.0 + HALF,
                "{mode}: {component} jumps to {first:?}"
            );
        }
    }
}

fn set_nodes(on_mesh: &mut OnMesh, mut nodes: Json) {
    nodes["ramp"] = json!({ "kind": "surface/position", "params": { "along": [1, 0, 0] } });
    on_mesh.set_graph(&json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string());
}

#[test]
fn an_empty_mask_and_a_channel_that_is_off_leave_what_is_below() {
    let off = json!({
        "color_on": false, "roughness_on": false, "metallic_on": false, "height_on": false, "color": "#ffffff",
    });
    let nodes = |params: Json, mask: &str| {
        json!({
            "none": { "kind": "adjust/levels", "params": { "high": 0 } },
            "base": { "kind": "material/combine", "inputs": { "roughness": "ramp", "height": "ramp", "alpha": "ramp" } },
            "node": { "kind": "effect/layer", "inputs": { "base": "base", "mask": mask }, "params": params },
        })
    };
    let cases = [
        (
            "an empty mask",
            nodes(json!({ "color": "#ffffff", "height": 1, "roughness": 0 }), "none"),
        ),
        ("channels off", nodes(off, "ramp")),
    ];
    for (name, nodes) in cases {
        let mut on_mesh = on_plane(&nodes);
        let (base, layered) = (on_mesh.evaluate("base"), on_mesh.evaluate("node"));
        for component in ["base_color.r", "alpha", "roughness", "metallic", "occlusion", "height"] {
            let (was, is) = (base.component(component), layered.component(component));
            for (index, _) in on_mesh.owned() {
                assert_eq!(was[index], is[index], "{name}: {component}");
            }
        }
    }
}

/// The masks in a chain, each stored by itself.
fn stored_apart(on_mesh: &mut OnMesh, node: &str) -> Vec<f32> {
    let mode = Mode::Bake { fuse: false };
    on_mesh
        .evaluate_as(
            node,
            EvaluationOptions {
                mode,
                ..EvaluationOptions::baked()
            },
        )
        .component("mask")
}

#[test]
fn masks_are_not_clamped_between_nodes() {
    let number = |value: f64| json!({ "kind": "adjust/levels", "params": { "low": value, "high": value } });
    let blend = |below: &str, above: &str, mode: &str| json!({ "kind": "blend/mask", "inputs": { "below": below, "above": above }, "params": { "mode": mode } });
    let mut on_mesh = on_plane(&json!({
        "large": number(0.75),
        "twice": blend("large", "large", "add"),
        "once": blend("twice", "large", "subtract"),
        "less": blend("large", "twice", "subtract"),
        "back": blend("less", "twice", "add"),
    }));
    for (node, expected) in [("twice", 1.5), ("once", 0.75), ("less", -0.75), ("back", 0.75)] {
        let values = stored_apart(&mut on_mesh, node);
        assert!(on_mesh.owned().all(|(index, _)| values[index] == expected), "{node}");
    }
}

#[test]
fn a_mask_has_more_than_256_levels() {
    let narrow = |low: f64, high: f64, source: &str| {
        json!({ "kind": "adjust/remap", "inputs": { "source": source },
                "params": { "from_low": low, "from_high": high, "to_low": 0.5, "to_high": 0.501 } })
    };
    let widened = json!({ "kind": "adjust/remap", "inputs": { "source": "narrow" },
                          "params": { "from_low": 0.5, "from_high": 0.501 } });
    let mut on_mesh = on_plane(&json!({ "narrow": narrow(0.0, 1.0, "ramp"), "widened": widened }));
    let ramp = on_mesh.evaluate("ramp").component("mask");
    let values = stored_apart(&mut on_mesh, "widened");
    for (index, _) in on_mesh.owned() {
        // A 32-bit float near 0.5 has steps of 6e-8, here stretched by 1000.
        assert!(
            (values[index] - ramp[index]).abs() < 2e-4,
            "{} of {}",
            values[index],
            ramp[index]
        );
    }
}

#[test]
fn multiply_and_subtract_as_the_bottom_most_mask_do_not_wipe_it() {
    for (mode, expected) in [("multiply", [0.0, 1.0]), ("subtract", [1.0, 0.0])] {
        let node = json!({ "kind": "blend/mask", "inputs": { "above": "ramp" }, "params": { "mode": mode } });
        let mut on_mesh = on_plane(&json!({ "node": node }));
        for (mask, value) in along_the_ramp(&mut on_mesh, "node", "mask") {
            let expected = expected[0] + (expected[1] - expected[0]) * mask;
            assert!((value - expected).abs() < 1e-6, "{mode}: {value} at {mask}");
        }
    }
}

#[test]
fn roughness_0_and_metallic_0_below_a_half_covering_layer_count_as_0() {
    let nodes = json!({
        "base": { "kind": "source/material", "params": { "roughness": 0, "metallic": 0 } },
        "node": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "ramp" },
                  "params": { "roughness": 1, "metallic": 1, "height": -0.02, "height_mode": "normal" } },
    });
    let mut on_mesh = on_plane(&nodes);
    for (component, full) in [("roughness", 1.0), ("metallic", 1.0), ("height", -0.02)] {
        for (mask, value) in along_the_ramp(&mut on_mesh, "node", component) {
            assert!(
                (value - full * mask).abs() <= HALF,
                "{component} is {value} at a mask of {mask}"
            );
        }
    }
}
