//! Adjustments of colors: properties that stay unchanged, and rotations of the hue.

use sabi_tests::{OnMesh, project};
use serde_json::{Value as Json, json};

const RGB: [&str; 3] = ["color.r", "color.g", "color.b"];

type Rgb = [f32; 3];

/// A color node over a gradient through these colors.
fn graph(stops: &[&str], params: &Json) -> String {
    let last = (stops.len() - 1) as f64;
    let stops: Vec<Json> = stops
        .iter()
        .enumerate()
        .map(|(at, color)| json!([at as f64 / last, color]))
        .collect();
    json!({ "format": "sabi", "version": 1, "nodes": {
        "ramp": { "kind": "surface/position" },
        "source": { "kind": "color/gradient", "inputs": { "source": "ramp" }, "params": { "stops": stops } },
        "node": { "kind": "color/adjust", "inputs": { "source": "source" }, "params": params },
    } })
    .to_string()
}

const VIVID: [&str; 8] = [
    "#000000", "#ff0000", "#ffff00", "#00ff00", "#00ffff", "#0000ff", "#ff00ff", "#ffffff",
];
const GRAYS: [&str; 2] = ["#000000", "#ffffff"];
const PAINTS: [&str; 5] = ["#6b3a1e", "#3c5a6e", "#808080", "#a09040", "#d8c8b0"];

/// Colors before and after.
fn adjusted(stops: &[&str], params: Json) -> Vec<(Rgb, Rgb)> {
    let mut on_mesh = OnMesh::new(&graph(stops, &params), &project("assets/meshes/cube.glb"), 64);
    let [source, node] = ["source", "node"].map(|id| {
        let evaluated = on_mesh.evaluate(id);
        RGB.map(|name| evaluated.component(name))
    });
    let at = |(index, _): (usize, u32)| {
        (
            [0, 1, 2].map(|part| source[part][index]),
            [0, 1, 2].map(|part: usize| node[part][index]),
        )
    };
    on_mesh.owned().map(at).collect()
}

fn light([r, g, b]: Rgb) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn spread(color: Rgb) -> f32 {
    color.iter().copied().fold(0.0, f32::max) - color.iter().copied().fold(f32::INFINITY, f32::min)
}

/// Error of two roundings to half floats of a value up to 1.
const ROUNDING: f32 = 1.0 / 1024.0;

#[test]
fn defaults_change_nothing() {
    for (was, is) in adjusted(&VIVID, json!({})) {
        assert_eq!(was, is);
    }
}

#[test]
fn grays_stay_gray_whatever_is_set() {
    for params in [
        json!({ "hue": 90 }),
        json!({ "hue": -170, "saturation": 10 }),
        json!({ "saturation": 3 }),
        json!({ "gamma": 2.2, "hue": 40, "value": 0.5 }),
    ] {
        for (was, is) in adjusted(&GRAYS, params.clone()) {
            assert!(
                spread(is) <= ROUNDING * is[0].max(0.05),
                "{params}: {was:?} became {is:?}"
            );
        }
    }
}

#[test]
fn hue_and_saturation_keep_the_luminance_and_the_range() {
    for params in [
        json!({ "hue": 30 }),
        json!({ "hue": 120 }),
        json!({ "hue": 180 }),
        json!({ "hue": -75, "saturation": 0.5 }),
        json!({ "saturation": 0 }),
        json!({ "hue": 60, "saturation": 10 }),
    ] {
        for (was, is) in adjusted(&VIVID, params.clone()) {
            assert!(
                (light(was) - light(is)).abs() <= ROUNDING,
                "{params}: {was:?} became {is:?}"
            );
            assert!(
                is.iter().all(|part| (0.0..=1.0).contains(part)),
                "{params}: {was:?} became {is:?}"
            );
        }
    }
}

#[test]
fn a_hue_turned_there_and_back_is_the_same() {
    let there_and_back = |text: String| {
        let mut graph: Json = serde_json::from_str(&text).expect("a graph");
        graph["nodes"]["turned"] = graph["nodes"]["node"].clone();
        graph["nodes"]["node"]["inputs"]["source"] = json!("turned");
        graph["nodes"]["node"]["params"]["hue"] = json!(-25);
        graph.to_string()
    };
    let text = there_and_back(graph(&PAINTS, &json!({ "hue": 25 })));
    let mut on_mesh = OnMesh::new(&text, &project("assets/meshes/cube.glb"), 64);
    let [source, turned, node] = ["source", "turned", "node"].map(|id| {
        let evaluated = on_mesh.evaluate(id);
        RGB.map(|name| evaluated.component(name))
    });
    let (mut furthest, mut largest) = (0.0_f32, 0.0_f32);
    for (index, _) in on_mesh.owned() {
        for part in 0..3 {
            furthest = furthest.max((turned[part][index] - source[part][index]).abs());
            largest = largest.max((node[part][index] - source[part][index]).abs());
        }
    }
    assert!(furthest > 0.05, "nothing was turned: {furthest}");
    // No color here is so vivid that it has to be desaturated on the way.
    assert!(largest < 2.0 * ROUNDING, "{largest}");
}

#[test]
fn red_turned_by_its_angle_to_green_in_oklab_is_green() {
    // Oklab's hue angles of sRGB's red and green (B. Ottosson): 29.23° and 142.50°.
    let is_green = adjusted(&["#b02020", "#b02020"], json!({ "hue": 113.27 }));
    for (was, [red, green, blue]) in is_green {
        assert!(
            green > 2.0 * red && green > 2.0 * blue,
            "{was:?} became {:?}",
            [red, green, blue]
        );
    }
}

#[test]
fn value_multiplies_the_light_and_gamma_keeps_black_and_white() {
    for (was, is) in adjusted(&PAINTS, json!({ "value": 0.5 })) {
        for part in 0..3 {
            assert!((is[part] - 0.5 * was[part]).abs() <= ROUNDING);
        }
    }
    for (was, is) in adjusted(&GRAYS, json!({ "gamma": 2 })) {
        // Half floats below 0.01 are coarse compared with the result of a root.
        let allowed = if was[0] < 0.01 { 0.01 } else { 2.0 * ROUNDING };
        assert!((is[1] - was[1].sqrt()).abs() <= allowed, "{was:?} became {is:?}");
    }
}
