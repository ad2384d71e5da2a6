//! A graph around each node that shows what it does: generic inputs, unless specimens.json knows better.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

/// Hand-made specimens: for a category or a kind the model, knobs, inputs and further nodes.
static HAND_MADE: LazyLock<Value> = LazyLock::new(|| {
    // A test reads it, so a mistake in the file does not get far.
    serde_json::from_str(include_str!("specimens.json")).unwrap_or_default()
});

/// Graph and model of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Specimen {
    /// Name of one of the project's models.
    pub(crate) mesh: String,
    /// The graph; the node in question is called `node`.
    pub(crate) graph: Value,
    /// The node and port of the graph that are seen.
    pub(crate) target: String,
    /// True if the target is a material, which is lit as such.
    pub(crate) is_material: bool,
}

/// The model a category is shown on, unless its kinds say otherwise.
const USUAL_MESH: &str = "figure";

/// The specimen of a node as `sabi nodes --json` describes it, or none where there is nothing to show.
pub(crate) fn specimen(node: &Value, port: &str) -> Option<Specimen> {
    let id = node["id"].as_str()?;
    let (category, _) = id.split_once('/')?;
    if category == "graph" {
        return None;
    }
    let own = &HAND_MADE[id];
    let mesh = [&own["mesh"], &HAND_MADE[category]["mesh"]]
        .into_iter()
        .find_map(Value::as_str)
        .unwrap_or(USUAL_MESH);
    let mut nodes = Map::new();
    let inputs = inputs_of(node, own, &mut nodes)?;
    for (name, node) in own["nodes"].as_object().into_iter().flatten() {
        nodes.insert(name.clone(), node.clone());
    }
    // Most specimens set no parameter.
    let params = own["params"].as_object().cloned().unwrap_or_default();
    nodes.insert(
        "node".to_owned(),
        json!({ "kind": id, "inputs": inputs, "params": params }),
    );
    let outputs = node["outputs"].as_array()?;
    let ty = outputs.iter().find(|output| output["name"] == port)?["type"].as_str()?;
    let (target, is_material) = match own["show"][port].as_str() {
        Some(target) => (target.to_owned(), own["show_material"] == true),
        None => shown(&mut nodes, port, ty),
    };
    if is_material {
        nodes.insert(
            "exported".to_owned(),
            json!({ "kind": "output/material", "inputs": { "material": target } }),
        );
    }
    Some(Specimen {
        mesh: mesh.to_owned(),
        graph: json!({ "format": "sabi", "version": 1, "nodes": nodes }),
        target,
        is_material,
    })
}

/// Returns the connections of a node's inputs, and adds the nodes that stand in for an artist's.
fn inputs_of(node: &Value, own: &Value, nodes: &mut Map<String, Value>) -> Option<Map<String, Value>> {
    let mut inputs = Map::new();
    for input in node["inputs"].as_array().into_iter().flatten() {
        let name = input["name"].as_str()?;
        // The default of a position or direction is better than any generic input.
        let is_filled = input["default"]
            .as_str()
            .is_some_and(|default| default.starts_with("at."));
        if own["inputs"][name].is_string() || is_filled {
            continue;
        }
        let stand_in = format!("into_{name}");
        let ty = input["type"].as_str()?;
        connect(nodes, &stand_in, ty, name);
        let port = if ty == "vector" { ".position" } else { "" };
        inputs.insert(name.to_owned(), json!(format!("{stand_in}{port}")));
    }
    for (name, from) in own["inputs"].as_object().into_iter().flatten() {
        // An empty name leaves the input open.
        if from.as_str().is_some_and(|from| !from.is_empty()) {
            inputs.insert(name.clone(), from.clone());
        }
    }
    Some(inputs)
}

/// Adds the nodes that show a result best: heights as relief in clay, random values as colors, all else as it is.
/// Returns the port to show, and true if it is a material.
fn shown(nodes: &mut Map<String, Value>, port: &str, ty: &str) -> (String, bool) {
    let result = format!("node.{port}");
    match (ty, port) {
        ("mask", "height") => {
            let params = json!({ "color": "#a89c8c", "roughness": 0.55, "height": 1 });
            nodes.insert(
                "shown".to_owned(),
                json!({ "kind": "effect/layer", "inputs": { "height_map": result }, "params": params }),
            );
            ("shown.material".to_owned(), true)
        }
        ("mask", "id") => {
            let stops = json!([
                [0.0, "#264653"],
                [0.14, "#2a9d8f"],
                [0.29, "#8ab17d"],
                [0.43, "#e9c46a"],
                [0.57, "#f4a261"],
                [0.71, "#e76f51"],
                [0.86, "#a8577e"],
                [1.0, "#5f4b8b"],
            ]);
            nodes.insert(
                "shown".to_owned(),
                json!({ "kind": "color/gradient", "inputs": { "source": result }, "params": { "stops": stops } }),
            );
            ("shown.color".to_owned(), false)
        }
        _ => (result, ty == "material"),
    }
}

fn clouds(size: f64, seed: u32) -> Value {
    json!({ "kind": "noise/simplex", "params": { "size": size, "octaves": 5, "seed": seed } })
}

fn cells(size: f64) -> Value {
    json!({ "kind": "noise/cells", "params": { "size": size } })
}

/// Something an artist would connect to an input of that type and name.
fn connect(nodes: &mut Map<String, Value>, id: &str, ty: &str, name: &str) {
    let is_upper = matches!(name, "above" | "by" | "over");
    let source = format!("{id}_source");
    match ty {
        "mask" => {
            let node = match name {
                "mask" => json!({ "kind": "surface/position", "params": { "low": 0.25, "high": 0.75 } }),
                "height" | "height_map" => cells(0.12),
                _ if is_upper => cells(0.16),
                _ => clouds(0.3, 3),
            };
            nodes.insert(id.to_owned(), node);
        }
        "color" => {
            let (node, stops) = if is_upper {
                (
                    cells(0.16),
                    json!([[0.1, "#3b1d10"], [0.45, "#9c4a1c"], [0.9, "#e0a25a"]]),
                )
            } else {
                (
                    clouds(0.3, 3),
                    json!([[0.15, "#1f3a4d"], [0.5, "#5f8f8a"], [0.85, "#e8d9b0"]]),
                )
            };
            nodes.insert(source.clone(), node);
            nodes.insert(
                id.to_owned(),
                json!({ "kind": "color/gradient", "inputs": { "source": source }, "params": { "stops": stops } }),
            );
        }
        "material" => material(nodes, id, &source, is_upper),
        _ => {
            nodes.insert(id.to_owned(), json!({ "kind": "surface/position" }));
        }
    }
}

/// Painted metal above, stained stone below.
fn material(nodes: &mut Map<String, Value>, id: &str, source: &str, is_upper: bool) {
    let (noise, stops) = if is_upper {
        (clouds(0.5, 9), json!([[0.2, "#24506b"], [0.8, "#2f6a8c"]]))
    } else {
        (
            clouds(0.22, 3),
            json!([[0.2, "#5d4a38"], [0.5, "#8a7254"], [0.8, "#b09a78"]]),
        )
    };
    let colors = format!("{id}_colors");
    nodes.insert(source.to_owned(), noise);
    nodes.insert(
        colors.clone(),
        json!({ "kind": "color/gradient", "inputs": { "source": source }, "params": { "stops": stops } }),
    );
    let (roughness, height) = if is_upper { (0.3, 0.004) } else { (0.8, 0.012) };
    let params = json!({ "color": "#ffffff", "roughness": roughness, "height": height });
    nodes.insert(
        id.to_owned(),
        json!({ "kind": "effect/layer", "inputs": { "color_map": colors, "height_map": source }, "params": params }),
    );
}
