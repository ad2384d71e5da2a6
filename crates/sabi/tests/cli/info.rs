//! `sabi info`: knobs, variants, outputs and files of a graph.

use serde_json::{Value as Json, json};

use crate::cli_folder::{CLOUDS, CliFolder, graph};

/// A graph with knobs of several sorts, a group, a picture and a node of its own.
const PANEL: &str = r##"{
  "format": "sabi", "version": 1, "name": "Panel", "about": "All sorts of knobs.", "seed": 5, "fit": "metres",
  "exposed": {
    "width": { "to": ["edges.width"], "label": "Edge width", "order": 2 },
    "paint": { "to": ["base.color"], "about": "Color of the paint.", "order": 1, "section": "Look" },
    "turn": { "to": ["facing.reach"], "section": "Look" },
    "wear": { "to": ["grain.amount", "clouds.gain"], "curves": { "clouds.gain": [[0, 0.2], [1, 0.9]] },
      "range": [0, 1], "default": 0.25 },
    "lost": { "to": ["odd.size"] }
  },
  "variants": { "red": { "paint": "#ff0000" }, "blue": { "paint": "#0000ff", "wear": 1 } },
  "groups": { "speckle": { "exposed": { "amount": { "to": ["n.gain"] } }, "outputs": { "mask": "n" },
    "nodes": { "n": { "kind": "noise/simplex" } } } },
  "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e" } },
    "clouds": { "kind": "noise/simplex", "params": { "mode": "ridged" } },
    "edges": { "kind": "surface/edges", "params": { "width": 0.03 } },
    "facing": { "kind": "own/facing" },
    "grain": { "kind": "graph/group", "group": "speckle" },
    "odd": { "kind": "noise/simplx" },
    "out": { "kind": "output/material", "inputs": { "material": "base" }, "params": { "materials": "wood, iron" } },
    "photo": { "kind": "source/image", "params": { "file": "pictures/photo.png" } },
    "scan": { "kind": "source/image", "params": { "file": "scan.png" } },
    "worn": { "kind": "output/mask", "inputs": { "source": "edges" }, "params": { "name": "wear" } }
  }
}
"##;

/// A node with an angle.
const FACING: &str = "//! Facing\n//! Selects what faces up.\n\nstruct Params {\n    /// How far it reaches.\n    \
    /// @angle @range 0 180 @default 60\n    reach: f32,\n}\n\n/// How much it faces up.\n\
    fn mask(at: Surface, params: Params) -> f32 {\n    return at.normal.y * params.reach;\n}\n";

fn panel() -> CliFolder {
    let place = CliFolder::new();
    std::fs::create_dir_all(place.path("nodes/own")).unwrap();
    std::fs::create_dir_all(place.path("pictures")).unwrap();
    place.write("nodes/own/facing.wgsl", FACING);
    place.write("pictures/photo.png", "a picture is not read");
    place.write("panel.sabi", PANEL);
    place
}

fn described(place: &CliFolder, name: &str) -> Json {
    let run = place.sabi(&["info", name, "--json"]).good();
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn the_knobs_of_a_graph_are_listed_in_the_order_of_its_panel() {
    let found = described(&panel(), "panel.sabi");
    let names: Vec<&str> = found["knobs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|knob| knob["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["paint", "turn", "width", "lost", "wear"]);
    assert_eq!(
        found["knobs"][0],
        json!({ "name": "paint", "label": "Paint", "doc": "Color of the paint.", "section": "Look", "to": ["base.color"],
            "takes": "color", "default": "#808080", "value": "#3c5a6e" })
    );
    let turn = &found["knobs"][1];
    assert_eq!((&turn["unit"], &turn["range"]), (&json!("degrees"), &json!([0, 180])));
    assert_eq!((&turn["default"], &turn["value"]), (&json!(60), &json!(60)));
    let width = &found["knobs"][2];
    assert_eq!(
        (&width["label"], &width["takes"]),
        (&json!("Edge width"), &json!("length"))
    );
    assert_eq!((&width["unit"], &width["value"]), (&json!("fit"), &json!(0.03)));
    let wear = &found["knobs"][4];
    assert_eq!((&wear["takes"], &wear["value"]), (&json!("number"), &json!(0.25)));
    assert_eq!(
        (&wear["range"], &wear["to"]),
        (&json!([0, 1]), &json!(["grain.amount", "clouds.gain"]))
    );
}

#[test]
fn a_knob_of_an_unknown_node_is_listed_without_a_type() {
    let found = described(&panel(), "panel.sabi");
    let lost = json!({ "name": "lost", "label": "Lost", "doc": "", "to": ["odd.size"], "takes": null, "default": null,
        "value": null });
    assert_eq!(found["knobs"][3], lost);
}

#[test]
fn variants_outputs_and_groups_are_described() {
    let found = described(&panel(), "panel.sabi");
    assert_eq!((&found["name"], &found["version"]), (&json!("Panel"), &json!(1)));
    assert_eq!(
        (&found["fit"], &found["seed"], &found["nodes"]),
        (&json!("metres"), &json!(5), &json!(10))
    );
    let variants = json!([
        { "name": "blue", "values": { "paint": "#0000ff", "wear": 1 } },
        { "name": "red", "values": { "paint": "#ff0000" } },
    ]);
    assert_eq!(found["variants"], variants);
    let outputs = json!([
        { "node": "out", "kind": "output/material", "materials": "wood, iron" },
        { "node": "worn", "kind": "output/mask", "name": "wear" },
    ]);
    assert_eq!(found["outputs"], outputs);
    assert_eq!(
        found["groups"],
        json!([{ "name": "speckle", "label": "speckle", "library": null }])
    );
}

#[test]
fn the_files_of_a_graph_are_listed_with_whether_they_exist() {
    let place = panel();
    let run = place.sabi(&["info", "panel.sabi", "--json"]).good();
    let found: Json = serde_json::from_str(&run.stdout).unwrap();
    let files: Vec<(&str, Option<&str>, bool)> = found["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|file| {
            (
                file["role"].as_str().unwrap(),
                file["written"].as_str(),
                file["exists"].as_bool().unwrap(),
            )
        })
        .collect();
    let expected = [
        ("node", None, true),
        ("picture", Some("pictures/photo.png"), true),
        ("picture", Some("scan.png"), false),
    ];
    assert_eq!(files, expected);
    let path = found["files"][0]["path"].as_str().unwrap();
    assert!(
        std::path::Path::new(path).is_absolute() && path.ends_with("facing.wgsl"),
        "{path}"
    );
    let missing = "panel.sabi: node 'scan' (source/image) names the picture ";
    assert!(
        run.stderr.contains(missing) && run.stderr.contains("scan.png, which is missing\n"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_graph_without_one_of_its_group_files_is_described_as_far_as_it_can_be() {
    let place = CliFolder::new();
    let nodes = format!("{CLOUDS},\n    \"g\": {{ \"kind\": \"graph/group\", \"group\": \"none.sabi\" }}");
    place.write("lacks.sabi", graph(&nodes));
    let found = described(&place, "lacks.sabi");
    assert_eq!((&found["nodes"], &found["outputs"]), (&Json::Null, &json!([])));
    assert_eq!(found["knobs"][0]["name"], "amount");
    assert_eq!(found["files"][0]["role"], "group");
    assert_eq!(
        (&found["files"][0]["written"], &found["files"][0]["exists"]),
        (&json!("none.sabi"), &json!(false))
    );
    let warnings = found["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let words = warnings[0].as_str().unwrap();
    assert!(
        words.starts_with("lacks.sabi: node 'g' (graph/group) names the group file "),
        "{words}"
    );
    assert!(words.ends_with("none.sabi, which is missing"), "{words}");
}

#[test]
fn people_get_the_same_as_a_table() {
    let place = CliFolder::new();
    let page = place.sabi(&["info", "clouds.sabi"]).good();
    assert_eq!(page.stderr, "");
    let expected = "\
test

graph     clouds.sabi
version   1
nodes     2
fit       unit
seed      0

Knobs
  amount  0.5  number from 0 to 1     Strength of each layer relative to the one before. [clouds.gain]
  look    fbm  fbm | billow | ridged  ";
    assert!(page.stdout.starts_with(expected), "{}", page.stdout);
    assert!(
        page.stdout
            .contains("\n\nVariants\n  heavy  amount=0.9\n\nOutputs\n  out  output/mask  map mask\n")
    );
    let missing = place.sabi(&["info", "none.sabi"]).fails(66);
    assert_eq!(
        missing.stderr,
        "error: none.sabi: there is no such file; check the path\n"
    );
}
