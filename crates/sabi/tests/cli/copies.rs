//! `--model`: a copy of the model that uses the maps.

use serde_json::Value as Json;

use crate::place::Place;

#[test]
fn a_copy_of_the_model_lies_beside_the_maps_and_in_the_report() {
    let place = Place::new();
    let run = place.bake("rust.sabi", "cube.glb", &["--model", "--json"]).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["model"]["path"], "cube.glb");
    assert_eq!(report["model"]["files"], Json::Array(Vec::new()), "its maps are in it");
    assert!(
        run.stderr.contains(": 5 maps and cube.glb in out, in "),
        "{}",
        run.stderr
    );
    assert!(place.listing("out").contains(&"cube.glb".to_owned()));
    let twice = place.bake("rust.sabi", "cube.glb", &["--model", "-o", "twice"]).good();
    assert!(twice.stdout.contains("cube.glb"), "{}", twice.stdout);
    assert_eq!(
        place.read("out/cube.glb"),
        place.read("twice/cube.glb"),
        "the same bytes"
    );
    place.sabi(&["mesh", "out/cube.glb"]).good();
}

#[test]
fn a_copy_never_takes_the_place_of_the_model() {
    let place = Place::new();
    let before = place.read("cube.glb");
    let run = place
        .bake("rust.sabi", "cube.glb", &["--model", "-o", ".", "--force"])
        .fails(73);
    let words =
        "cube.glb is read by this very bake and would be replaced by its own result; choose another folder with -o";
    assert!(run.stderr.trim_end().ends_with(words), "{}", run.stderr);
    assert_eq!(place.read("cube.glb"), before);
}

#[test]
fn udim_tiles_cannot_be_one_picture_of_a_copy() {
    let place = Place::new();
    let tiles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\n\
                 vt 1.1 0.1\nvt 1.9 0.9\nvt 1.1 0.9\nusemtl wood\nf 1/1 2/2 3/3\nf 2/4 4/5 3/6\n";
    place.write("tiles.obj", tiles);
    place.refuses(
        "rust.sabi",
        "tiles.obj",
        &["--model"],
        65,
        "--model cannot be done: 'wood' lies in the UDIM tiles 1001, 1002, and a material of glTF has one picture for \
         each map; bake without --model, or move its UVs into one tile",
    );
}

#[test]
fn a_model_that_was_unwrapped_has_no_copy_and_says_so() {
    let place = Place::new();
    place.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.refuses(
        "rust.sabi",
        "bare.obj",
        &["--model"],
        65,
        "--model cannot be done for a model that was unwrapped anew: copies keep the UVs of the file; bake without \
         --model, or unwrap the model in the program that made it",
    );
}
