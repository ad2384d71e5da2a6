//! Effects of `--uv`, `--up` and `--scale` on a model, measured; `--fit` is measured with the bakes.

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

/// A triangle that faces +Z, with two UV sets.
const SHEET: &str = r#"{
  "asset": { "version": "2.0" }, "nodes": [ { "mesh": 0 } ],
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2 } } ] } ],
  "buffers": [ { "byteLength": 84, "uri": "sheet.bin" } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 84 } ],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
    { "bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC2" },
    { "bufferView": 0, "byteOffset": 60, "componentType": 5126, "count": 3, "type": "VEC2" }
  ]
}"#;

/// Legs of the triangle in either UV set.
const LEGS: [f32; 2] = [0.96, 0.48];

fn with_sheet() -> CliFolder {
    let place = CliFolder::new();
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let uvs = LEGS.map(|leg| {
        let (low, high) = (0.5 - leg / 2.0, 0.5 + leg / 2.0);
        [low, high, high, high, low, low]
    });
    let numbers = positions.iter().chain(uvs.as_flattened());
    let bytes: Vec<u8> = numbers.flat_map(|number: &f32| number.to_le_bytes()).collect();
    place.write("sheet.gltf", SHEET);
    place.write("sheet.bin", bytes);
    place
}

fn described(place: &CliFolder, more: &[&str]) -> Json {
    let run = place.sabi(&[&["mesh", "sheet.gltf", "--size", "256", "--json"], more].concat());
    serde_json::from_str(&run.good().stdout).unwrap()
}

#[test]
fn the_uv_set_that_is_asked_for_is_the_one_that_is_laid_out() {
    let place = with_sheet();
    for (set, leg) in LEGS.iter().enumerate() {
        let mesh = described(&place, &["--uv", &set.to_string()]);
        let coverage = mesh["coverage"].as_f64().unwrap();
        let area = f64::from(leg * leg / 2.0);
        // Texels whose centers are covered: at most one row more or less along the longest side.
        assert!(
            (coverage - area).abs() < 1.5 / 256.0,
            "set {set}: {coverage} is not {area}"
        );
    }
}

#[test]
fn the_scale_multiplies_every_length() {
    let place = with_sheet();
    assert_eq!(described(&place, &[])["largest_side"], 1.0);
    assert_eq!(described(&place, &["--scale", "2.5"])["largest_side"], 2.5);
}

#[test]
fn the_axis_that_points_up_is_up_for_the_graph() {
    let place = with_sheet();
    let facing = r#"{
  "format": "sabi",
  "version": 1,
  "name": "facing",
  "nodes": {
    "facing": { "kind": "surface/direction" },
    "out": { "kind": "output/mask", "inputs": { "source": "facing" } }
  }
}
"#;
    place.write("facing.sabi", facing);
    // The whole sheet has one direction, so the mask has one value: 1 if this direction is up.
    for (axis, expected) in [("y", 0.0), ("z", 1.0), ("x", 0.0)] {
        let run = place.bake("facing.sabi", "sheet.gltf", &["--up", axis, "--json", "-q", "--force"]);
        let report: Json = serde_json::from_str(&run.good().stdout).unwrap();
        assert_eq!(report["constants"][0]["value"], expected, "{axis}");
    }
}
