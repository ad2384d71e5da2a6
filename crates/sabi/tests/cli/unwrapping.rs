//! Models without UVs, and models whose charts share places.

use serde_json::Value as Json;

use crate::cli_folder::{CliFolder, done, graph};

/// A cube of two materials without texture coordinates; of the second, one face has some.
const BARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    usemtl wood\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl steel\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// Two squares that face away from each other, in one place of the unit square.
const STACKED: &str = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\n\
    vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nf 1/1 2/2 3/3 4/4\nf 5/1 6/2 7/3 8/4\n";

/// 1 where the surface faces +z, 0 where it faces away.
const FRONT: &str = r#"    "front": { "kind": "surface/direction", "params": { "toward": [0, 0, 1] } },
    "out": { "kind": "output/mask", "inputs": { "source": "front" } }"#;

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_model_without_uvs_is_baked_onto_one_sheet_for_all_its_materials() {
    let place = CliFolder::new();
    place.write("bare.obj", BARE);
    let run = place
        .bake("rust.sabi", "bare.obj", &["--report", "out/report.json"])
        .good();
    assert!(
        run.stderr
            .contains("The model has no UVs, so it was unwrapped onto one sheet for all its materials."),
        "{}",
        run.stderr
    );
    let maps = place.listing("out");
    assert!(maps.contains(&"bare_base_color.png".to_owned()), "{maps:?}");
    assert!(
        !maps.iter().any(|map| map.contains("wood") || map.contains("steel")),
        "{maps:?}"
    );
    let report = json(std::str::from_utf8(&place.read("out/report.json")).unwrap());
    let unwrapped = &report["mesh"]["unwrapped"];
    assert_eq!(unwrapped["uv_set"], 0);
    // Four texels at 1024, so a quarter of one at 64.
    assert_eq!(unwrapped["gap_texels"].as_f64(), Some(0.25));
    assert_eq!(report["unwrapping_cached"], false);
    assert_eq!(report["mesh"]["overlap"]["texels"], 0);
    // Again, from the disk cache, and anew with one thread.
    let before = place.read("out/bare_base_color.png");
    let bake = |threads: &str, more: &[&str]| {
        let arguments = [
            &[
                "bake",
                "rust.sabi",
                "--mesh",
                "bare.obj",
                "--adapter",
                "cpu",
                "--size",
                "64",
                "--json",
            ],
            more,
        ];
        let mut command = place.command(&arguments.concat());
        json(
            &done(command.env("RAYON_NUM_THREADS", threads).output().unwrap())
                .good()
                .stdout,
        )
    };
    assert_eq!(bake("2", &["-o", "again"])["unwrapping_cached"], true);
    assert_eq!(place.read("again/bare_base_color.png"), before);
    assert_eq!(bake("1", &["-o", "anew", "--no-cache"])["unwrapping_cached"], false);
    assert_eq!(place.read("anew/bare_base_color.png"), before);
}

#[test]
fn pairs_beyond_those_that_are_counted_are_told() {
    let place = CliFolder::new();
    let quad = |at: u32| {
        let corners = ["0 0", "1 0", "1 1", "0 1"].map(|corner| format!("v {corner} {at}\n"));
        corners.concat() + "f -4/1 -3/2 -2/3 -1/4\n"
    };
    let quads: String = (0..150).map(quad).collect();
    place.write(
        "many.obj",
        format!("vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\n{quads}"),
    );
    let run = place.sabi(&["mesh", "many.obj", "--size", "16", "--json"]).good();
    let overlap = &json(&run.stdout)["overlap"];
    assert_eq!(
        (&overlap["stacked"], &overlap["more_than_counted"]),
        (&Json::from(10_000), &Json::from(true))
    );
    assert!(run.stderr.contains("(at least 10000 stacked)"), "{}", run.stderr);
}

#[test]
fn a_material_without_uvs_is_unwrapped_onto_a_sheet_of_its_own_and_the_rest_keeps_its_uvs() {
    let place = CliFolder::new();
    let wood = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nusemtl wood\nf 4/1 3/2 2/3 1/4\n";
    let steel = "usemtl steel\nf 5 6 7 8\nf 1 2 6 5\n";
    place.write("wood.obj", wood);
    place.write("both.obj", format!("{wood}{steel}"));
    let run = place.bake("rust.sabi", "both.obj", &["--model", "--report", "out/report.json"]);
    let run = run.good();
    let told = "A part of the model has no UVs (material `steel`), so the surface of this material was unwrapped onto a \
                sheet of its own; the rest keeps its UVs.";
    assert!(run.stderr.contains(told), "{}", run.stderr);
    let report = json(std::str::from_utf8(&place.read("out/report.json")).unwrap());
    assert_eq!(report["mesh"]["unwrapped"]["pieces"], 1);
    let materials: Vec<&str> = report["outputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|map| map["material"].as_str().unwrap())
        .collect();
    assert!(
        materials.contains(&"wood") && materials.contains(&"steel"),
        "{materials:?}"
    );
    // The copy has the layout of the maps as a second set of the wood, and as the first one that the steel has.
    let copy = place.read("out/both.glb");
    let text_length = u32::from_le_bytes(copy[12..16].try_into().unwrap()) as usize;
    let document = json(std::str::from_utf8(&copy[20..20 + text_length]).unwrap());
    for primitive in document["meshes"][0]["primitives"].as_array().unwrap() {
        assert!(primitive["attributes"]["TEXCOORD_1"].is_number(), "{primitive}");
    }
    // Its part of the layout is as it was, so that its own map is that of the wood alone, seen from nowhere else.
    place
        .bake(
            "rust.sabi",
            "wood.obj",
            &["-o", "alone", "--report", "alone/report.json"],
        )
        .good();
    let alone = json(std::str::from_utf8(&place.read("alone/report.json")).unwrap());
    let size = |report: &Json| report["mesh"]["charts"].as_u64().unwrap();
    assert_eq!(size(&report), size(&alone) + 2);
}

#[test]
fn charts_that_share_a_place_get_the_first_result_their_mean_or_places_of_their_own() {
    let place = CliFolder::new();
    place.write("stacked.obj", STACKED);
    place.write(
        "front.sabi",
        graph(FRONT)
            .replace("clouds.gain", "front.reach")
            .replace("clouds.mode", "front.fade"),
    );
    let baked = |overlap: &str| {
        let run = place.bake("front.sabi", "stacked.obj", &["--overlap", overlap, "--json"]);
        let run = run.good();
        (json(&run.stdout), run.stderr)
    };
    let constant = |report: &Json| report["constants"][0]["value"].as_f64();
    let (first, told) = baked("first");
    assert_eq!(constant(&first), Some(1.0), "{first}");
    let overlap = &first["mesh"]["overlap"];
    assert_eq!(
        (&overlap["share"], &overlap["stacked"]),
        (&Json::from(1.0), &Json::from(1))
    );
    assert_eq!(overlap["materials"][0]["material"], "stacked");
    assert!(
        told.contains(
            "UV charts overlap on 100.0 % of the surface (1 stacked), most of them in 'stacked': the maps have the \
             result of the first chart there; take the mean of overlapping charts with --overlap merge, or unwrap the \
             model with --overlap unwrap"
        ),
        "{told}"
    );
    let (merged, _) = baked("merge");
    assert_eq!(constant(&merged), Some(0.5), "{merged}");
    let (apart, told) = baked("unwrap");
    assert_eq!(apart["mesh"]["overlap"]["texels"], 0);
    assert_eq!(apart["mesh"]["unwrapped"]["uv_set"], 1);
    assert_eq!(constant(&apart), None, "black and white side by side");
    assert!(!told.contains("overlap"), "{told}");
}
