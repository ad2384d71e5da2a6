//! Outputs of the graph that are separate maps, maps of the model itself, and the memory that maps take.

use sabi_image::{Pixels, decode};
use serde_json::{Value as Json, json};

use crate::cli_folder::{CliFolder, graph};

/// A color above 1 in places, a vector and a mask, each with an output.
const OUTPUTS: &str = r##"    "clouds": { "kind": "noise/simplex" },
    "bright": { "kind": "blend/color", "params": { "mode": "add" }, "inputs": { "below": "clouds", "above": "clouds" } },
    "place": { "kind": "surface/position" },
    "out": { "kind": "output/color", "params": { "name": "tint" }, "inputs": { "source": "bright" } },
    "out_flow": { "kind": "output/vector", "params": { "name": "flow" }, "inputs": { "source": "place.position" } },
    "out_wear": { "kind": "output/mask", "params": { "name": "wear" }, "inputs": { "source": "clouds" } }"##;

fn report(place: &CliFolder, graph: &str, more: &[&str]) -> Json {
    let run = place.bake(graph, "cube.glb", &[more, &["--json"]].concat()).good();
    serde_json::from_str(&run.stdout).unwrap()
}

/// Returns the paths of the maps with their bits and color space.
fn maps(report: &Json) -> Vec<(String, u64, String)> {
    let outputs = report["outputs"].as_array().unwrap().iter();
    let of = |output: &Json| {
        (
            output["path"].as_str().unwrap().to_owned(),
            output["bits"].as_u64().unwrap(),
            output["color_space"].as_str().unwrap().to_owned(),
        )
    };
    outputs.map(of).collect()
}

#[test]
fn masks_colors_and_vectors_are_exported_and_packed_by_name() {
    let place = CliFolder::new();
    place.write("outputs.sabi", graph(OUTPUTS));
    let raw = report(&place, "outputs.sabi", &[]);
    let expected = [
        ("cube_tint.png", 8, "srgb"),
        ("cube_tint.exr", 16, "linear"),
        ("cube_flow.exr", 32, "linear"),
        ("cube_wear.png", 16, "linear"),
    ];
    let mut found = maps(&raw);
    found.retain(|(path, ..)| expected.iter().any(|(known, ..)| known == path));
    assert_eq!(
        found,
        expected.map(|(path, bits, space)| (path.to_owned(), bits, space.to_owned())),
        "{raw:#}"
    );
    let info: Json = serde_json::from_str(&place.sabi(&["info", "outputs.sabi", "--json"]).good().stdout).unwrap();
    assert_eq!(
        info["outputs"],
        json!([
            { "node": "out", "kind": "output/color", "name": "tint" },
            { "node": "out_flow", "kind": "output/vector", "name": "flow" },
            { "node": "out_wear", "kind": "output/mask", "name": "wear" },
        ])
    );
    let preset = |map: &str| {
        format!("version = 1\nname = \"own\"\nabout = \"Own.\"\n[[map]]\nname = \"own\"\nformat = \"png8\"\n{map}\n")
    };
    place.write(
        "own.toml",
        preset("r = \"output(wear)\"\ng = \"output(tint).g\"\nb = \"1 - output(flow).y\""),
    );
    let own = report(&place, "outputs.sabi", &["--preset", "own.toml", "-o", "own"]);
    assert_eq!(
        own["outputs"][0]["components"],
        json!(["output(wear)", "output(tint).g", "1 - output(flow).g"])
    );
    place.write("whole.toml", preset("gray = \"output(tint)\""));
    let refused = place
        .bake("outputs.sabi", "cube.glb", &["--preset", "whole.toml", "-o", "whole"])
        .fails(65);
    assert_eq!(
        refused.stderr,
        "error: the preset own cannot be used: map `own`: `output(tint)`: this output has 3 components and one is needed \
         here; write `.r`, `.g` or `.b` behind it\n"
    );
    assert!(!place.path("whole").exists());
}

/// Returns the 16-bit values of a map, divided by their greatest value, pixel by pixel.
fn shares(place: &CliFolder, name: &str) -> Vec<Vec<f64>> {
    let picture = decode(name, &place.read(&format!("out/{name}"))).unwrap();
    let Pixels::U16(codes) = picture.pixels else {
        panic!("{name} has 16 bits")
    };
    let pixels = codes.chunks(usize::from(picture.channels));
    pixels
        .map(|pixel| pixel.iter().map(|code| f64::from(*code) / 65535.0).collect())
        .collect()
}

#[test]
fn maps_of_the_model_need_no_node() {
    let place = CliFolder::new();
    let report = report(
        &place,
        "clouds.sabi",
        &["--mesh-map", "id,position", "--mesh-map", "world_normal,curvature"],
    );
    let paths: Vec<String> = maps(&report).into_iter().map(|(path, ..)| path).collect();
    assert_eq!(
        paths,
        [
            "cube_mask.png",
            "cube_world_normal.png",
            "cube_position.png",
            "cube_curvature.png"
        ]
    );
    assert_eq!(report["constants"][0]["channel"], "id", "a cube is one part");
    assert_eq!(report["mesh"]["bounds"], json!([[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]]));
    let (normals, positions) = (
        shares(&place, "cube_world_normal.png"),
        shares(&place, "cube_position.png"),
    );
    let bends = shares(&place, "cube_curvature.png");
    let is_covered = |normal: &&Vec<f64>| normal.iter().any(|share| (share - 0.5).abs() > 0.01);
    assert!(normals.iter().filter(is_covered).count() > 2000);
    for ((normal, position), bend) in normals.iter().zip(&positions).zip(&bends) {
        // Texels beyond the padding have no direction.
        if !is_covered(&normal) {
            continue;
        }
        // Each face of a cube points along an axis, and all its positions are at the same end of that axis.
        let axis = (0..3).find(|axis| (normal[*axis] - 0.5).abs() > 0.49);
        let axis = axis.unwrap_or_else(|| panic!("{normal:?}"));
        assert!((position[axis] - normal[axis]).abs() < 0.01, "{normal:?} {position:?}");
        let edge = (0..3)
            .filter(|other| *other != axis)
            .map(|other| (position[other] - 0.5).abs());
        // A cube is convex beside its edges and flat elsewhere, except in texels that are denoised together with those beside an edge.
        if edge.fold(0.0, f64::max) < 0.3 {
            assert!((bend[0] - 0.5).abs() < 1e-3, "{position:?} {bend:?}");
        } else {
            assert!(bend[0] > 0.49, "{position:?} {bend:?}");
        }
    }
    let unknown = place.bake("clouds.sabi", "cube.glb", &["--mesh-map", "ao"]).fails(2);
    assert!(
        unknown
            .stderr
            .contains("there is no map `ao` of the model; there is: id, material_id, world_normal"),
        "{}",
        unknown.stderr
    );
}

#[test]
fn the_report_and_the_summary_tell_the_memory_in_an_engine() {
    let place = CliFolder::new();
    let run = place.bake("rust.sabi", "cube.glb", &["--report", "out.json"]).good();
    let report: Json = serde_json::from_slice(&place.read("out.json")).unwrap();
    let of = |channel: &str| {
        let outputs = report["outputs"].as_array().unwrap();
        let output = outputs.iter().find(|output| output["channel"] == channel).unwrap();
        (
            output["engine_format"].as_str().unwrap().to_owned(),
            output["engine_bytes"].as_u64().unwrap(),
        )
    };
    // 64² pixels are 341 blocks down to 4², and a block for each of 2² and 1².
    assert_eq!(of("base_color"), ("BC7".to_owned(), 343 * 16));
    assert_eq!(of("normal"), ("BC5".to_owned(), 343 * 16));
    let outputs = report["outputs"].as_array().unwrap().iter();
    let sum: u64 = outputs.map(|output| output["engine_bytes"].as_u64().unwrap()).sum();
    assert_eq!(
        (
            report["engine"]["bytes"].as_u64(),
            report["engine"]["sets"][0]["bytes"].as_u64()
        ),
        (Some(sum), Some(sum))
    );
    let said = "in an engine: BC7, BC5, ";
    assert!(
        run.stderr.contains(said) && run.stderr.contains("with mips"),
        "{}",
        run.stderr
    );
}

#[test]
fn dithered_maps_are_the_same_on_any_number_of_threads_and_others_with_another_seed() {
    let place = CliFolder::new();
    let baked = |threads: &str, seed: &str, out: &str| {
        let mut command = place.command(&[
            "bake",
            "rust.sabi",
            "--mesh",
            "cube.glb",
            "--adapter",
            "cpu",
            "--size",
            "64",
        ]);
        let run = command
            .args(["--seed", seed, "--mesh-map", "thickness", "-o", out])
            .env("RAYON_NUM_THREADS", threads);
        assert!(run.output().unwrap().status.success());
        ["cube_roughness.png", "cube_thickness.png"].map(|name| place.read(&format!("{out}/{name}")))
    };
    let (one, five) = (baked("1", "4", "one"), baked("5", "4", "five"));
    assert_eq!(one, five);
    // The thickness does not depend on the seed, but its noise does.
    assert_ne!(one[1], baked("5", "5", "other")[1]);
}
