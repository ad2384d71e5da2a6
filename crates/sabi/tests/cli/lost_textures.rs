//! Pictures of a model that are not where it says are found in another folder, which the command line or the graph names.

use std::fs;

use crate::cli_folder::CliFolder;
use crate::packing::bmp;

const MODEL: &str =
    "mtllib truck.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl paint\nf 1/1 2/2 3/3\n";
const LOOK: &str = "newmtl paint\nmap_Kd C:\\art\\2019\\Wood.bmp\n";
const GONE: &str = "`Wood.bmp` is not where the model says";

fn place() -> CliFolder {
    let place = CliFolder::new();
    for folder in ["models", "pictures/deep"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    place.write("models/truck.obj", MODEL);
    place.write("models/truck.mtl", LOOK);
    place.write("pictures/deep/wood.bmp", bmp(90));
    place
}

fn graph(preview: &str) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "preview": {{ {preview} }}, "nodes": {{ "own": {{ "kind": "source/model" }},
            "out": {{ "kind": "output/material", "inputs": {{ "material": "own" }} }} }} }}"#
    )
}

/// Returns whether a bake of the graph has a map of base color, which only the picture makes vary, and what it told.
fn bake(place: &CliFolder, graph: &str, more: &[&str]) -> (bool, String) {
    let _ = fs::remove_dir_all(place.path("out"));
    let done = place
        .bake(graph, "models/truck.obj", &[&["--report", "r.json"], more].concat())
        .good();
    let has_map = place.listing("out").iter().any(|file| file.contains("base_color"));
    (has_map, done.stderr)
}

#[test]
fn a_picture_that_is_gone_is_told_and_found_in_the_folder_that_is_named() {
    let place = place();
    let told = place.sabi(&["mesh", "models/truck.obj", "--size", "64"]).good().stderr;
    let advice = format!("{GONE}; choose the folder in which they are with --textures");
    assert!(told.contains(&advice), "{told}");
    let found = ["mesh", "models/truck.obj", "--size", "64", "--textures", "pictures"];
    let told = place.sabi(&found).good().stderr;
    assert!(!told.contains("Wood.bmp"), "{told}");
    let nowhere = ["mesh", "models/truck.obj", "--size", "64", "--textures", "models"];
    assert!(place.sabi(&nowhere).good().stderr.contains(GONE));
}

#[test]
fn the_folder_of_lost_pictures_is_kept_by_a_graph_and_by_a_report() {
    let place = place();
    place.write("plain.sabi", graph(r#""mesh": "models/truck.obj""#));
    place.write(
        "kept.sabi",
        graph(r#""mesh": "models/truck.obj", "textures": "pictures""#),
    );
    let (has_map, told) = bake(&place, "plain.sabi", &[]);
    assert!(!has_map && told.contains(GONE), "{told}");
    let (has_map, told) = bake(&place, "plain.sabi", &["--textures", "pictures"]);
    assert!(has_map && !told.contains(GONE), "{told}");
    let again = ["bake", "--from", "r.json", "-o", "again"];
    let told = place.sabi(&again).good().stderr;
    assert!(!told.contains(GONE), "{told}");
    let (has_map, told) = bake(&place, "kept.sabi", &[]);
    assert!(has_map && !told.contains(GONE), "{told}");
}

#[test]
fn a_graph_may_not_look_for_pictures_where_it_may_open_nothing() {
    let (place, outside) = (place(), CliFolder::new());
    outside.write("wood.bmp", bmp(10));
    let folder = outside.path("").display().to_string().replace('\\', "/");
    place.write(
        "kept.sabi",
        graph(&format!(r#""mesh": "models/truck.obj", "textures": "{folder}""#)),
    );
    let (_, told) = bake(&place, "kept.sabi", &[]);
    assert!(told.contains("--trust") && told.contains("Wood.bmp"), "{told}");
    let (_, told) = bake(&place, "kept.sabi", &["--trust", &folder]);
    assert!(!told.contains("Wood.bmp"), "{told}");
}

#[test]
fn a_packed_model_finds_its_pictures_where_it_says() {
    let place = place();
    place.write(
        "kept.sabi",
        graph(r#""mesh": "models/truck.obj", "textures": "pictures""#),
    );
    place.sabi(&["pack", "kept.sabi", "-o", "kept.zip"]).good();
    place.sabi(&["unpack", "kept.zip", "-o", "there"]).good();
    let graph = String::from_utf8(place.read("there/kept.sabi")).unwrap();
    assert!(!graph.contains("textures"), "{graph}");
    let told = place
        .sabi(&["mesh", "there/models/truck.obj", "--size", "64"])
        .good()
        .stderr;
    assert!(!told.contains("Wood.bmp"), "{told}");
}
