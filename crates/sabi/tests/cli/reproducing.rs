//! Maps that are made again, are there already, or are not as they should be.

use std::fs;

use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

const MAPS: [&str; 2] = ["cube_base_color.png", "cube_roughness.png"];

fn maps(place: &CliFolder, folder: &str) -> Vec<String> {
    let mut names = place.listing(folder);
    names.retain(|name| name.ends_with(".png") || name.ends_with(".exr"));
    names
}

#[test]
fn a_report_makes_its_maps_again_from_another_place_and_to_the_same_bytes() {
    let place = CliFolder::new();
    place.write("look.toml", "[set]\namount = 0.25\n");
    let settings = [
        "--set-file",
        "look.toml",
        "--seed",
        "7",
        "--fit",
        "0.5",
        "--preset",
        "raw",
        "--preset",
        "unreal",
        "--padding",
        "3",
        "--model",
        "--all-maps",
        "--report",
        "reports/first.json",
    ];
    fs::create_dir(place.path("reports")).unwrap();
    place.bake("rust.sabi", "cube.glb", &settings).good();
    let again = place
        .sabi(&[
            "bake",
            "--from",
            "reports/first.json",
            "-o",
            "again",
            "--report",
            "again/report.json",
        ])
        .good();
    assert!(
        again.stderr.contains("all with the bytes that it records"),
        "{}",
        again.stderr
    );
    let names = maps(&place, "out");
    assert!(names.len() > 8, "{names:?}");
    for name in &names {
        assert_eq!(
            place.read(&format!("out/{name}")),
            place.read(&format!("again/{name}")),
            "{name}"
        );
    }
    let [first, second] = ["reports/first.json", "again/report.json"].map(|file| {
        let mut json: Json = serde_json::from_slice(&place.read(file)).unwrap();
        json["recipe"].take()
    });
    assert_eq!(first["graph"], "../rust.sabi");
    assert_eq!(first, second, "both are one folder below the graph");
}

#[test]
fn a_graph_from_standard_input_is_in_its_report() {
    let place = CliFolder::new();
    let text = place.read("rust.sabi");
    let arguments = [
        "bake",
        "-",
        "--mesh",
        "cube.glb",
        "--adapter",
        "cpu",
        "--size",
        "64",
        "-o",
        "out",
        "--report",
        "report.json",
    ];
    place.sabi_reading(&arguments, &text).good();
    fs::remove_file(place.path("rust.sabi")).unwrap();
    place.sabi(&["bake", "--from", "report.json", "-o", "again"]).good();
    for name in maps(&place, "out") {
        assert_eq!(
            place.read(&format!("out/{name}")),
            place.read(&format!("again/{name}")),
            "{name}"
        );
    }
}

#[test]
fn what_has_changed_since_a_report_is_named_and_not_baked() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "cube.glb", &["--report", "report.json"]).good();
    let text = String::from_utf8(place.read("rust.sabi")).unwrap();
    place.write("rust.sabi", text.replace("0.01", "0.02"));
    let refused = place.sabi(&["bake", "--from", "report.json", "-o", "again"]).fails(65);
    assert!(
        refused.stderr.contains("rust.sabi has changed since the bake"),
        "{}",
        refused.stderr
    );
    assert!(!place.path("again").exists());
    place.write("rust.sabi", text);
    place.sabi(&["bake", "--from", "report.json", "-o", "again"]).good();
}

#[test]
fn maps_that_differ_from_the_report_are_named_and_end_with_3() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "cube.glb", &["--report", "report.json"]).good();
    let mut report: Json = serde_json::from_slice(&place.read("report.json")).unwrap();
    report["outputs"][0]["blake3"] = "0".repeat(64).into();
    let path = report["outputs"][0]["path"].as_str().unwrap().to_owned();
    place.write("report.json", report.to_string());
    let differs = place.sabi(&["bake", "--from", "report.json", "-o", "again"]).fails(3);
    assert!(
        differs
            .stderr
            .ends_with(&format!("error: {path} has other bytes than before\n")),
        "{}",
        differs.stderr
    );
}

#[test]
fn what_is_no_report_to_bake_from_is_told() {
    let place = CliFolder::new();
    place.write("old.json", r#"{ "sabi": "0.1.0", "graph": "a.sabi" }"#);
    place.write("new.json", r#"{ "version": 99 }"#);
    place.write("failed.json", r#"{ "error": {} }"#);
    place.write("none.json", "maps");
    place.write("damaged.json", r#"{ "version": 2, "recipe": 1 }"#);
    for (file, code, words) in [
        (
            "old.json",
            65,
            "does not say how its maps were made; bake again to get one that does",
        ),
        ("new.json", 65, "is one of a newer Sabi; update this one"),
        (
            "failed.json",
            65,
            "is one of a bake that failed; its command line may be run again",
        ),
        (
            "none.json",
            65,
            "is no report of a bake: expected value at line 1 column 1",
        ),
        ("damaged.json", 65, "is damaged: "),
        ("missing.json", 66, "does not exist; check the path"),
        (".", 65, "is a folder or a device, not a file"),
    ] {
        let told = place.sabi(&["bake", "--from", file, "-o", "again"]).fails(code);
        let words = format!("error: the report {file} {words}");
        assert!(told.stderr.starts_with(&words), "{words}: {}", told.stderr);
    }
    place
        .sabi(&["bake", "--from", "old.json", "-o", "again", "--size", "32"])
        .fails(2);
    place.sabi(&["bake", "-o", "again"]).fails(2);
}

#[test]
fn the_same_bake_again_does_nothing_until_something_changes() {
    let place = CliFolder::new();
    let bake = |more: &[&str]| place.bake("rust.sabi", "cube.glb", more).good();
    let is_done = |more: &[&str]| bake(more).stderr.contains("Baked rust.sabi");
    assert!(is_done(&[]));
    let files = bake(&[]);
    assert!(!files.stderr.contains("Baked"), "{}", files.stderr);
    assert!(files.stderr.contains("Nothing to do: "), "{}", files.stderr);
    let listed = MAPS.iter().all(|map| files.stdout.contains(map));
    assert!(listed, "{}", files.stdout);
    let told: Json = serde_json::from_str(&bake(&["--json"]).stdout).unwrap();
    assert_eq!((&told["up_to_date"], &told["size"]), (&Json::Bool(true), &64.into()));
    assert!(is_done(&["--again"]));
    assert!(is_done(&["--set", "rust.height=0.02"]), "another recipe");
    assert!(is_done(&[]), "and back");
    assert!(!is_done(&[]));
    let path = place.path("rust.sabi");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("#6b3a1e", "#6b3a1f")).unwrap();
    assert!(is_done(&[]), "another graph");
    fs::write(place.path("out").join(MAPS[0]), b"damaged").unwrap();
    assert!(is_done(&[]), "a damaged map");
    fs::create_dir_all(place.path("nodes/own")).unwrap();
    place.write("nodes/notes.wgsl", "// beside the categories, where no node is read");
    assert!(!is_done(&[]), "a file that is not read");
    place.write("nodes/own/notes.wgsl", "// no node");
    assert!(is_done(&[]), "another node file");
    assert!(!is_done(&[]));
}

#[test]
fn a_changed_color_encodes_only_the_map_that_hangs_on_it() {
    let place = CliFolder::new();
    let cached = |more: &[&str]| {
        let run = place
            .bake("rust.sabi", "cube.glb", &[&["--json"], more].concat())
            .good();
        let report: Json = serde_json::from_str(&run.stdout).unwrap();
        report["maps_cached"].clone()
    };
    assert_eq!(cached(&[]), serde_json::json!([]));
    let others = [
        "cube_roughness.png",
        "cube_height.exr",
        "cube_height.png",
        "cube_normal.png",
    ];
    assert_eq!(cached(&["--set", "rust.color=#112233"]), serde_json::json!(others));
    assert_eq!(
        cached(&["--set", "rust.color=#112244", "--no-cache"]),
        serde_json::json!([])
    );
    let all = cached(&["-o", "elsewhere"]);
    assert_eq!(all.as_array().unwrap().len(), others.len() + 1);
    for map in others {
        assert_eq!(
            place.read(&format!("out/{map}")),
            place.read(&format!("elsewhere/{map}")),
            "{map}"
        );
    }
}

#[test]
fn a_size_of_the_cache_that_is_no_number_is_told() {
    let place = CliFolder::new();
    let mut command = place.command(&["bake", "rust.sabi", "--mesh", "cube.glb", "--size", "64", "-o", "out"]);
    let told = crate::cli_folder::done(command.env("SABI_CACHE_MIB", "many").output().unwrap()).fails(2);
    assert_eq!(told.stderr, "error: SABI_CACHE_MIB takes a number of MiB, not 'many'\n");
}

#[test]
fn verify_finds_damage_staleness_strangers_and_what_is_left_over() {
    let place = CliFolder::new();
    place
        .bake("rust.sabi", "cube.glb", &["--report", "out/report.json"])
        .good();
    let good = place.sabi(&["verify", "out"]).good();
    assert!(
        good.stdout.starts_with("out: good, ") && good.stdout.ends_with(" of 1 bake\n"),
        "{}",
        good.stdout
    );
    place.write(&format!("out/{}", MAPS[0]), b"damaged");
    fs::remove_file(place.path("out").join(MAPS[1])).unwrap();
    place.write("out/notes.txt", b"mine");
    place.write("out/.sabi-Ab12.tmp", b"half");
    let model = place.read("sphere.glb");
    place.write("cube.glb", model);
    let bad = place.sabi(&["verify", "out", "--json"]).fails(3);
    let json: Json = serde_json::from_str(&bad.stdout).unwrap();
    let findings = json[0]["findings"].as_array().unwrap();
    let found: Vec<(&str, &str)> = findings
        .iter()
        .map(|finding| (finding["kind"].as_str().unwrap(), finding["message"].as_str().unwrap()))
        .collect();
    let stale = format!(
        "{} has changed since the bake",
        fs::canonicalize(place.path("cube.glb")).unwrap().display()
    );
    assert_eq!(
        found,
        [
            ("damaged", "cube_base_color.png is not as it was baked"),
            ("damaged", "cube_roughness.png is missing or cannot be read"),
            ("stale", stale.as_str()),
            ("stranger", "notes.txt was not written by a bake that the folder knows"),
            (
                "left_over",
                ".sabi-Ab12.tmp is left of a bake that was killed; the next bake removes it"
            ),
        ]
    );
}

#[test]
fn a_folder_without_a_manifest_is_told() {
    let place = CliFolder::new();
    fs::create_dir(place.path("maps")).unwrap();
    let told = place.sabi(&["verify", "maps"]).fails(66);
    assert!(
        told.stderr.starts_with("error: maps has no manifest of bakes"),
        "{}",
        told.stderr
    );
    let told = place.sabi(&["verify", "none"]).fails(66);
    assert_eq!(told.stderr, "error: none is no folder; give the folder of the maps\n");
    fs::create_dir(place.path("maps/.sabi")).unwrap();
    place.write("maps/.sabi/bakes.json", "{");
    let told = place.sabi(&["verify", "maps"]).fails(65);
    assert!(
        told.stderr.starts_with("error: maps has a damaged manifest, "),
        "{}",
        told.stderr
    );
}

#[test]
fn bakes_into_one_folder_are_all_remembered_until_their_files_are_replaced() {
    let place = CliFolder::new();
    let verified = || place.sabi(&["verify", "out"]);
    place.bake("rust.sabi", "cube.glb", &[]).good();
    place.bake("clouds.sabi", "sphere.glb", &[]).good();
    assert!(verified().good().stdout.contains("of 2 bakes"));
    place
        .bake(
            "rust.sabi",
            "cube.glb",
            &["--channel", "roughness", "--set", "rust.height=0.02"],
        )
        .good();
    assert!(
        verified().good().stdout.contains("of 3 bakes"),
        "the first one has its other maps still"
    );
    let again = place.bake("rust.sabi", "cube.glb", &[]).good();
    assert!(
        again.stderr.contains("Baked"),
        "a part of its maps is of another bake: {}",
        again.stderr
    );
    assert!(verified().good().stdout.contains("of 2 bakes"));
}
