//! Curves, clamping and stretching of masks.

use sabi_tests::{OnMesh, project};
use serde_json::{Value as Json, json};

/// A node of one kind over `source`, which runs from −0.5 to 1.5 up the cube.
fn graph(kind: &str, params: &Json) -> String {
    json!({ "format": "sabi", "version": 1, "nodes": {
        "ramp": { "kind": "surface/position" },
        "source": { "kind": "adjust/remap", "inputs": { "source": "ramp" }, "params": { "to_low": -0.5, "to_high": 1.5 } },
        "node": { "kind": kind, "inputs": { "source": "source" }, "params": params },
    } })
    .to_string()
}

/// Values between −0.5 and 1.5, in rising order, with their results.
fn bent(kind: &str, params: Json) -> Vec<(f32, f32)> {
    let mut on_mesh = OnMesh::new(&graph(kind, &params), &project("assets/meshes/cube.glb"), 128);
    let source = on_mesh.evaluate("source").component("mask");
    let node = on_mesh.evaluate("node").component("mask");
    let mut pairs: Vec<(f32, f32)> = on_mesh.owned().map(|(index, _)| (source[index], node[index])).collect();
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
    assert!(pairs[0].0 < -0.4 && pairs[pairs.len() - 1].0 > 1.4);
    pairs
}

#[test]
fn a_straight_curve_changes_nothing_between_its_ends_and_is_held_outside() {
    for params in [json!({}), json!({ "points": [[0, 0], [0.25, 0.25], [1, 1]] })] {
        for (x, y) in bent("adjust/curve", params) {
            assert_eq!(y, x.clamp(0.0, 1.0));
        }
    }
}

#[test]
fn a_curve_goes_through_its_points_and_never_overshoots() {
    let points = [[0.0, 0.1], [0.1, 0.1], [0.2, 0.9], [0.5, 0.9], [0.6, 0.2], [1.0, 0.8]];
    let rising = |x: f32| points.windows(2).find(|ends| x >= ends[0][0] && x < ends[1][0]);
    let pairs = bent("adjust/curve", json!({ "points": points }));
    for (x, y) in &pairs {
        let [low, high] = match rising(*x) {
            Some(ends) => [ends[0][1].min(ends[1][1]), ends[0][1].max(ends[1][1])],
            None if *x < 0.0 => [0.1; 2],
            None => [0.8; 2],
        };
        assert!((low..=high).contains(y), "{y} at {x} is not between {low} and {high}");
    }
    for [x, y] in points {
        let nearest = pairs
            .iter()
            .min_by(|one, other| (one.0 - x).abs().total_cmp(&(other.0 - x).abs()));
        let (at, value) = nearest.copied().unwrap_or_default();
        // The steepest slope that the interpolation allows is twice that of the steepest line between neighboring points.
        assert!(
            (value - y).abs() <= 16.0 * (at - x).abs() + 1e-6,
            "{value} at {at}, not {y} at {x}"
        );
    }
    for pair in pairs.windows(2).filter(|pair| pair[0].0 > 0.1 && pair[1].0 < 0.5) {
        // A cubic's own rounding.
        assert!(pair[1].1 >= pair[0].1 - 1e-6, "falls where the points rise: {pair:?}");
    }
}

#[test]
fn two_points_at_one_place_are_a_step_and_points_need_no_order() {
    let sorted = bent(
        "adjust/curve",
        json!({ "points": [[0, 0], [0.5, 0], [0.5, 1], [1, 1]] }),
    );
    for (x, y) in &sorted {
        assert_eq!(*y, if *x < 0.5 { 0.0 } else { 1.0 }, "at {x}");
    }
    let shuffled = bent(
        "adjust/curve",
        json!({ "points": [[1, 1], [0.5, 0], [0, 0], [0.5, 1]] }),
    );
    assert_eq!(sorted, shuffled);
}

#[test]
fn a_full_curve_uses_its_last_point() {
    let points: Vec<[f32; 2]> = (0..16).map(|at| [at as f32 / 15.0, (at % 2) as f32]).collect();
    let last = bent("adjust/curve", json!({ "points": points }));
    assert_eq!(last[last.len() - 1].1, 1.0);
    let mut step = points;
    step[14] = [1.0, 0.0];
    let last = bent("adjust/curve", json!({ "points": step }));
    assert_eq!(last[last.len() - 1].1, 1.0, "a step at the end is its upper side");
}

#[test]
fn one_point_is_that_value_everywhere() {
    for (_, y) in bent("adjust/curve", json!({ "points": [[0.4, 0.7]] })) {
        assert_eq!(y, 0.7);
    }
}

#[test]
fn clamp_keeps_values_between_both_ends_in_any_order() {
    for [low, high] in [[0.2, 0.7], [0.7, 0.2]] {
        for (x, y) in bent("adjust/clamp", json!({ "low": low, "high": high })) {
            assert_eq!(y, x.clamp(0.2, 0.7));
        }
    }
}

#[test]
fn remap_goes_on_in_a_line_and_is_a_step_where_there_is_nothing_to_stretch() {
    for (x, y) in bent("adjust/remap", json!({})) {
        assert_eq!(y, x, "the default changes nothing");
    }
    let params = json!({ "from_low": 0.5, "from_high": 0.25, "to_low": -1, "to_high": 3 });
    for (x, y) in bent("adjust/remap", params) {
        let expected = -1.0 + 4.0 * (x - 0.5) / -0.25;
        assert!((y - expected).abs() < 1e-5, "{y} at {x}, not {expected}");
    }
    let params = json!({ "from_low": 0.5, "from_high": 0.5, "to_low": -1, "to_high": 3 });
    for (x, y) in bent("adjust/remap", params) {
        assert_eq!(y, if x < 0.5 { -1.0 } else { 3.0 }, "at {x}");
    }
}
