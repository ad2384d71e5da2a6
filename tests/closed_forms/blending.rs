//! Results of every mode for two values, compared with its formula.

use sabi_tests::{OnMesh, project};
use serde_json::{Value as Json, json};

/// A mode by its name.
type BlendFormula<T> = (&'static str, fn(T, T) -> T);

fn hard_light(below: f64, above: f64) -> f64 {
    if above > 0.5 {
        1.0 - 2.0 * (1.0 - below) * (1.0 - above)
    } else {
        2.0 * below * above
    }
}

const MODES: [BlendFormula<f64>; 12] = [
    ("normal", |_, above| above),
    ("add", |below, above| below + above),
    ("subtract", |below, above| below - above),
    ("multiply", |below, above| below * above),
    ("screen", |below, above| 1.0 - (1.0 - below) * (1.0 - above)),
    ("overlay", |below, above| hard_light(above, below)),
    ("soft_light", |below, above| {
        (1.0 - 2.0 * above) * below * below + 2.0 * above * below
    }),
    ("hard_light", hard_light),
    ("min", f64::min),
    ("max", f64::max),
    ("difference", |below, above| (below - above).abs()),
    ("divide", |below, above| below / above.max(1e-3)),
];

/// Value of the upper input that leaves the lower input unchanged, for modes that have such a value.
const NEUTRAL: [(&str, f64); 12] = [
    ("add", 0.0),
    ("subtract", 0.0),
    ("multiply", 1.0),
    ("screen", 0.0),
    ("soft_light", 0.5),
    ("hard_light", 0.5),
    ("min", 1.0),
    ("max", 0.0),
    ("difference", 0.0),
    ("divide", 1.0),
    // Overlay depends on the lower input: it has no neutral value, but black and white are not changed.
    ("overlay", 0.0),
    ("overlay", 1.0),
];

const WEIGHTS: [f64; 3] = [0.0, 0.5, 1.0];

/// Returns a graph in which `below` and `above` are ramps that cross each other, so that every texel of the cube is a different pair.
fn graph(kind: &str, params: &Json) -> String {
    let ramp = |along: [f64; 3]| json!({ "kind": "surface/position", "params": { "along": along } });
    let tinted = |source: &str, stops: Json| json!({ "kind": "color/gradient", "inputs": { "source": source }, "params": { "stops": stops } });
    let (below, above) = if kind == "blend/mask" {
        ("one", "other")
    } else {
        ("below", "above")
    };
    json!({ "format": "sabi", "version": 1, "nodes": {
        "one": ramp([1.0, 0.4, 0.2]), "other": ramp([0.1, 1.0, -0.6]),
        "below": tinted("one", json!([[0, "#000000"], [0.3, "#c02010"], [0.6, "#3080e0"], [1, "#ffffff"]])),
        "above": tinted("other", json!([[0, "#ffffff"], [0.4, "#208040"], [0.7, "#e0e020"], [1, "#000000"]])),
        "node": { "kind": kind, "inputs": { "below": below, "above": above }, "params": params },
    } })
    .to_string()
}

fn on_cube(graph: &str) -> OnMesh {
    OnMesh::new(graph, &project("assets/meshes/cube.glb"), 32)
}

fn components(on_mesh: &mut OnMesh, node: &str, names: &[&str]) -> Vec<Vec<f64>> {
    let evaluated = on_mesh.evaluate(node);
    let owned: Vec<usize> = on_mesh.owned().map(|(index, _)| index).collect();
    let of = |name: &&str| {
        let values = evaluated.component(name);
        owned.iter().map(|index| f64::from(values[*index])).collect()
    };
    names.iter().map(of).collect()
}

#[test]
fn every_mode_of_masks_is_its_formula_at_every_weight() {
    let mut on_mesh = on_cube(&graph("blend/mask", &json!({})));
    let below = components(&mut on_mesh, "one", &["mask"]).remove(0);
    let above = components(&mut on_mesh, "other", &["mask"]).remove(0);
    for (mode, formula) in MODES {
        for weight in WEIGHTS {
            on_mesh.set_graph(&graph("blend/mask", &json!({ "mode": mode, "opacity": weight })));
            let values = components(&mut on_mesh, "node", &["mask"]).remove(0);
            for ((below, above), value) in below.iter().zip(&above).zip(values) {
                let expected = below + (formula(*below, *above) - below) * weight;
                let is_close = (value - expected).abs() <= 1e-6 * expected.abs().max(1.0);
                assert!(
                    is_close,
                    "{mode} of {below} and {above} at {weight}: {value}, not {expected}"
                );
                assert!(
                    weight > 0.0 || value == *below,
                    "{mode} at 0 is not exactly what is below"
                );
            }
        }
    }
}

#[test]
fn every_mode_with_its_neutral_value_changes_nothing() {
    let mut on_mesh = on_cube(&graph("blend/mask", &json!({})));
    let varied = components(&mut on_mesh, "one", &["mask"]).remove(0);
    for (mode, neutral) in NEUTRAL {
        let (wired, knob) = if mode == "overlay" {
            ("above", "below")
        } else {
            ("below", "above")
        };
        on_mesh.set_graph(
            &json!({ "format": "sabi", "version": 1, "nodes": {
                "one": { "kind": "surface/position", "params": { "along": [1, 0.4, 0.2] } },
                "node": { "kind": "blend/mask", "inputs": { wired: "one" }, "params": { "mode": mode, knob: neutral } },
            } })
            .to_string(),
        );
        for (one, value) in varied.iter().zip(components(&mut on_mesh, "node", &["mask"]).remove(0)) {
            let kept = if mode == "overlay" { neutral } else { *one };
            assert!(
                (value - kept).abs() < 1e-6,
                "{mode} with {neutral}: {one} became {value}"
            );
        }
    }
}

type Rgb = [f64; 3];

fn light([r, g, b]: Rgb) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn least(color: Rgb) -> f64 {
    color.into_iter().fold(f64::INFINITY, f64::min)
}

fn most(color: Rgb) -> f64 {
    color.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// W3C, "Compositing and Blending Level 1", 10.2: ClipColor.
fn clip(color: Rgb) -> Rgb {
    let (gray, least, most) = (light(color), least(color), most(color));
    let mut clipped = color;
    if least < 0.0 {
        clipped = clipped.map(|part| gray + (part - gray) * gray / (gray - least));
    }
    if most > 1.0 {
        clipped = clipped.map(|part| gray + (part - gray) * (1.0 - gray) / (most - gray));
    }
    clipped
}

/// SetLum.
fn with_light(color: Rgb, wanted: f64) -> Rgb {
    let change = wanted - light(color);
    clip(color.map(|part| part + change))
}

fn saturation(color: Rgb) -> f64 {
    most(color) - least(color)
}

/// SetSat.
fn with_saturation(color: Rgb, wanted: f64) -> Rgb {
    let (low, spread) = (least(color), saturation(color));
    color.map(|part| {
        if spread > 0.0 {
            (part - low) * wanted / spread
        } else {
            0.0
        }
    })
}

const COLOR_MODES: [BlendFormula<Rgb>; 4] = [
    ("hue", |below, above| {
        with_light(with_saturation(above, saturation(below)), light(below))
    }),
    ("saturation", |below, above| {
        with_light(with_saturation(below, saturation(above)), light(below))
    }),
    ("color", |below, above| with_light(above, light(below))),
    ("luminosity", |below, above| with_light(below, light(above))),
];

#[test]
fn every_mode_of_colors_is_its_formula_at_every_weight() {
    const RGB: [&str; 3] = ["color.r", "color.g", "color.b"];
    let mut on_mesh = on_cube(&graph("blend/color", &json!({})));
    let below = components(&mut on_mesh, "below", &RGB);
    let above = components(&mut on_mesh, "above", &RGB);
    let apart = MODES.map(|(mode, formula)| {
        let each = move |below: Rgb, above: Rgb| std::array::from_fn(|at| formula(below[at], above[at]));
        (mode, Box::new(each) as Box<dyn Fn(Rgb, Rgb) -> Rgb>)
    });
    let whole = COLOR_MODES.map(|(mode, formula)| (mode, Box::new(formula) as Box<dyn Fn(Rgb, Rgb) -> Rgb>));
    for (mode, formula) in apart.into_iter().chain(whole) {
        for weight in WEIGHTS {
            on_mesh.set_graph(&graph("blend/color", &json!({ "mode": mode, "opacity": weight })));
            let values = components(&mut on_mesh, "node", &RGB);
            for pixel in 0..values[0].len() {
                let [below, above, value]: [Rgb; 3] =
                    [&below, &above, &values].map(|all| std::array::from_fn(|at| all[at][pixel]));
                let blended = formula(below, above);
                // Inputs and result are half floats. A component of a color has an error of up to 2⁻¹¹, and scaling to a
                // saturation or a division enlarges the error.
                let allowed = match mode {
                    "hue" => 1e-3 + 1e-3 * saturation(below) / saturation(above).max(1e-4),
                    "saturation" => 1e-3 + 1e-3 * saturation(above) / saturation(below).max(1e-4),
                    "divide" => 4e-3,
                    _ => 2e-3,
                };
                for at in 0..3 {
                    let expected = below[at] + (blended[at] - below[at]) * weight;
                    let is_close = (value[at] - expected).abs() <= allowed * expected.abs().max(1.0);
                    assert!(
                        is_close,
                        "{mode} of {below:?} and {above:?} at {weight}: {value:?}, not {blended:?}"
                    );
                }
            }
        }
    }
}
