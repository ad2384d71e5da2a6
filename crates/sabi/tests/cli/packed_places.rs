//! Names and folders of files in a packed graph that cannot stay unchanged.

use std::fs;

use serde_json::Value as Json;

use crate::cli_folder::{CLOUDS, CliFolder, graph};

/// A picture of one pixel.
const BMP: &[u8] = b"BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0\0\0\0\0\x04\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x50\x50\x50\0";

/// A graph of image nodes that name these files.
fn images(files: &[&str]) -> String {
    let nodes = files
        .iter()
        .enumerate()
        .map(|(index, file)| format!(r#""n{index}": {{ "kind": "source/image", "params": {{ "file": "{file}" }} }}"#));
    let nodes: Vec<String> = nodes.collect();
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{ {} }} }}"#,
        nodes.join(", ")
    )
}

/// Packs a graph without a model and unpacks it to `out`; returns the files that its image nodes name.
fn packed(place: &CliFolder, graph: &str) -> Vec<String> {
    place
        .sabi(&["pack", graph, "--no-mesh", "-o", "packed.zip", "--force"])
        .good();
    let _ = fs::remove_dir_all(place.path("out"));
    let unpacked = place.sabi(&["unpack", "packed.zip", "-o", "out"]).good();
    let text = fs::read(place.path(unpacked.stdout.trim_end())).unwrap();
    let graph: Json = serde_json::from_slice(&text).unwrap();
    let nodes = graph["nodes"].as_object().unwrap().values();
    nodes
        .map(|node| node["params"]["file"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
#[cfg(target_os = "linux")]
fn a_picture_whose_name_some_system_cannot_hold_gets_another_one() {
    let place = CliFolder::new();
    fs::create_dir(place.path("art")).unwrap();
    let files = ["art/a:b.bmp", "art/A.bmp", "art/a.bmp", "art/nul.bmp", "art/c.bmp"];
    for file in files {
        place.write(file, BMP);
    }
    place.write("odd.sabi", images(&files));
    let expected = [
        "files/a_b.bmp",
        "art/A.bmp",
        "files/a.bmp",
        "files/file_nul.bmp",
        "art/c.bmp",
    ];
    assert_eq!(packed(&place, "odd.sabi"), expected);
    place.write("aux.sabi", graph(CLOUDS));
    let run = place.sabi(&["pack", "aux.sabi", "--no-mesh", "-o", "a.zip"]).fails(65);
    assert!(
        run.stderr
            .ends_with("aux.sabi cannot be packed: 'aux.sabi' is the name of a device on Windows; rename it\n"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_path_that_is_given_to_a_group_file_is_kept_or_refused() {
    let place = CliFolder::new();
    place.write("sabi.toml", "");
    fs::create_dir_all(place.path("shot/groups")).unwrap();
    fs::create_dir_all(place.path("far")).unwrap();
    let group = r#"{ "format": "sabi", "version": 1, "exposed": { "photo": { "to": ["img.file"] } }, "outputs": { "mask": "img.mask" },
        "nodes": { "img": { "kind": "source/image" } } }"#;
    for folder in ["shot/groups", "far"] {
        place.write(&format!("{folder}/stain.sabi"), group);
        place.write(&format!("{folder}/a.bmp"), BMP);
    }
    let outer = |group: &str| {
        format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
  "g": {{ "kind": "graph/group", "group": "{group}", "params": {{ "photo": "a.bmp" }} }},
  "out": {{ "kind": "output/mask", "inputs": {{ "source": "g.mask" }} }} }} }}"#
        )
    };
    place.write("shot/near.sabi", outer("groups/stain.sabi"));
    let pack = |graph: &str| place.sabi(&["pack", graph, "--no-mesh", "-o", "a.zip", "--force"]);
    pack("shot/near.sabi").good();
    place.sabi(&["unpack", "a.zip"]).good();
    place.sabi(&["check", "a/near.sabi"]).good();
    assert_eq!(place.listing("a/groups"), ["a.bmp", "stain.sabi"]);
    // Here, too, the picture is placed beside the group file, but if another file has its name there, it has to be placed
    // in another folder.
    place.write("shot/far.sabi", outer("../far/stain.sabi"));
    pack("shot/far.sabi").good();
    fs::create_dir(place.path("other")).unwrap();
    place.write("other/a.bmp", BMP);
    let both = outer("../far/stain.sabi").replace(
        r#""out": "#,
        r#""n": { "kind": "source/image", "params": { "file": "../cube/a.bmp" } }, "out": "#,
    );
    fs::rename(place.path("other"), place.path("cube")).unwrap();
    place.write("shot/far.sabi", both);
    let run = pack("shot/far.sabi").fails(65);
    let words = "node 'g/img' (source/image) gets the path a.bmp from outside of its group file, so that it cannot be rewritten; copy the \
                 group file and the picture below the folder of the graph\n";
    assert!(run.stderr.ends_with(words), "{}", run.stderr);
}

#[test]
fn strokes_of_a_group_file_go_where_it_goes() {
    let place = CliFolder::new();
    place.write("sabi.toml", "");
    for folder in ["shot", "library/worn.paint/pictures"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    let strokes = "sabi paint 1\nmodel: cube\n\n";
    place.write("library/worn.paint/cube.strokes", strokes);
    place.write("library/worn.paint/pictures/0123456789abcdef.png", "pixels");
    place.write("library/worn.paint/cube.strokes.bak", "old");
    place.write("library/worn.paint/notes.txt", "own");
    place.write(
        "library/worn.sabi",
        r#"{ "format": "sabi", "version": 1, "nodes": { "hand": { "kind": "source/paint" } } }"#,
    );
    place.write(
        "shot/a.sabi",
        r#"{ "format": "sabi", "version": 1, "nodes": { "g": { "kind": "graph/group", "group": "../library/worn.sabi" } } }"#,
    );
    place
        .sabi(&["pack", "shot/a.sabi", "--no-mesh", "-o", "new/a.zip"])
        .good();
    let unpacked = place.sabi(&["unpack", "new/a.zip", "--json"]).good();
    let report: Json = serde_json::from_str(&unpacked.stdout).unwrap();
    let expected = [
        "a.sabi",
        "files/worn.paint/cube.strokes",
        "files/worn.paint/pictures/0123456789abcdef.png",
        "files/worn.sabi",
        "pack.json",
    ];
    assert_eq!(report["files"], Json::from(expected.to_vec()));
    assert_eq!(report["model"], Json::Null);
}

#[test]
fn a_model_below_the_folder_of_the_graph_stays_there_and_the_packed_graph_names_it() {
    let place = CliFolder::new();
    fs::create_dir(place.path("models")).unwrap();
    fs::rename(place.path("cube.glb"), place.path("models/cube.glb")).unwrap();
    place
        .sabi(&["pack", "clouds.sabi", "--mesh", "models/cube.glb", "-o", "a.zip"])
        .good();
    let unpacked = place.sabi(&["unpack", "a.zip", "--json"]).good();
    let report: Json = serde_json::from_str(&unpacked.stdout).unwrap();
    assert_eq!(
        report["files"],
        Json::from(vec!["clouds.sabi", "models/cube.glb", "pack.json"])
    );
    assert_eq!(report["model"], "a/models/cube.glb");
    let graph: Json = serde_json::from_slice(&place.read("a/clouds.sabi")).unwrap();
    assert_eq!(graph["preview"]["mesh"], "models/cube.glb");
}
