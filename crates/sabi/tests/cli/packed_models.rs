//! Models in the archive of a graph: their own files are packed, and no others.

use std::fs;

use super::packing::bmp;
use crate::cli_folder::CliFolder;

const OBJECT: &str = "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nvt 0.9 0.9\n\
                      usemtl one\nf 1/1 2/2 3/3\nusemtl two\nf 2/2 4/4 3/3\n";
const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": { "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;

/// A graph and a model of two materials with these textures.
fn with_textures([one, two]: [&str; 2]) -> CliFolder {
    let place = CliFolder::new();
    for folder in ["models", "one", "two"] {
        fs::create_dir_all(place.path(folder)).unwrap();
    }
    place.write("plain.sabi", GRAPH);
    place.write("models/model.obj", OBJECT);
    let materials = format!("newmtl one\nmap_Kd {one}\nnewmtl two\nmap_Kd {two}\n");
    place.write("models/model.mtl", materials);
    place
}

fn refusal(place: &CliFolder) -> String {
    let arguments = ["pack", "plain.sabi", "-o", "plain.zip", "--mesh", "models/model.obj"];
    let run = place.sabi(&arguments).fails(65);
    assert!(!place.path("plain.zip").exists());
    run.stderr
}

#[test]
fn a_file_beside_a_model_that_is_none_of_a_model_is_not_sent_along() {
    let place = with_textures(["letter.txt", "letter.txt"]);
    place.write("models/letter.txt", "secret");
    let said = refusal(&place);
    assert!(
        said.contains("letter.txt, which is no picture, and does not end in .bin or .mtl"),
        "{said}"
    );
}

#[test]
fn two_textures_that_would_have_one_place_elsewhere_are_refused() {
    let place = with_textures(["", ""]);
    for name in ["one", "two"] {
        place.write(&format!("{name}/diffuse.bmp"), bmp(99));
    }
    let [one, two] = ["one", "two"].map(|name| place.path(&format!("{name}/diffuse.bmp")));
    let materials = format!(
        "newmtl one\nmap_Kd {}\nnewmtl two\nmap_Kd {}\n",
        one.display(),
        two.display()
    );
    place.write("models/model.mtl", materials);
    let said = refusal(&place);
    assert!(said.contains("which would both be diffuse.bmp elsewhere"), "{said}");
}
