//! Failures in JSON for scripts: with `--json`, and in the report of a bake.

use serde_json::{Value as Json, json};

use crate::cli_folder::{CLOUDS, CliFolder, RunOutput, graph, software_adapter};

fn error(run: &RunOutput) -> Json {
    let document: Json = serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    document["error"].clone()
}

#[test]
fn with_json_a_failure_is_one_object_on_standard_output() {
    let place = CliFolder::new();
    place.write("faulty.sabi", graph(&CLOUDS.replace("simplex", "simplx")));
    place.write("cut.sabi", &graph(CLOUDS)[..90]);
    let cases: [(&[&str], i32, &str); 5] = [
        (&["info", "none.sabi"], 66, "missing"),
        (&["info", "cut.sabi"], 65, "bad_input"),
        (&["nodes", "noise/simplx"], 2, "usage"),
        (
            &["pack", "clouds.sabi", "--no-mesh", "-o", "cube.glb"],
            73,
            "cannot_write",
        ),
        (&["paint", "info", "cube.glb"], 65, "bad_input"),
    ];
    for (arguments, code, kind) in cases {
        let plain = place.sabi(arguments).fails(code);
        assert_eq!(plain.stdout, "", "{arguments:?}");
        let run = place.sabi(&[arguments, &["--json"]].concat()).fails(code);
        assert_eq!(run.stderr, plain.stderr, "people read the same");
        let error = error(&run);
        assert_eq!(
            (&error["kind"], &error["exit"]),
            (&json!(kind), &json!(code)),
            "{arguments:?}"
        );
        let sentence = error["message"].as_str().unwrap();
        assert!(
            run.stderr.starts_with(&format!("error: {sentence}")),
            "{sentence}: {}",
            run.stderr
        );
    }
}

#[test]
fn several_sentences_are_a_list_and_remedies_name_flags() {
    let place = CliFolder::new();
    let nodes = CLOUDS.replace("\"kind\": \"noise/simplex\"", "\"kind\": \"noise/simplx\"");
    let nodes =
        format!("{nodes},\n    \"rust\": {{ \"kind\": \"output/mask\", \"params\": {{ \"name\": \"mask\" }} }}");
    place.write("faulty.sabi", graph(&nodes));
    let run = place.bake("faulty.sabi", "cube.glb", &["--json"]).fails(65);
    let found = error(&run);
    let messages = found["messages"].as_array().unwrap();
    assert!(messages.len() > 1, "{run:?}");
    assert_eq!(messages[0], found["message"]);
    std::fs::create_dir(place.path("other")).unwrap();
    place.write("other/letter.txt", "");
    let run = place
        .bake("clouds.sabi", "cube.glb", &["--json", "-o", "other"])
        .fails(73);
    let expected = json!({
        "kind": "cannot_write", "exit": 73, "message": "the folder other has files but no earlier maps",
        "remedies": ["choose another folder with -o", "write into this folder anyway with --force"],
    });
    assert_eq!(error(&run), expected);
}

#[test]
fn a_command_line_that_makes_no_sense_is_json_where_it_asks_for_json() {
    let place = CliFolder::new();
    let run = place.sabi(&["info", "a.sabi", "--json", "--colour"]).fails(2);
    let found = error(&run);
    assert_eq!(found["kind"], "usage");
    assert_eq!(found["message"], "unexpected argument '--colour' found");
    assert!(run.stderr.starts_with("error: unexpected argument '--colour' found\n"));
    let missing = error(&place.sabi(&["bake", "a.sabi", "--json"]).fails(2));
    let sentence = "the following required arguments were not provided: --output <DIR> --mesh <FILE>";
    assert_eq!(missing["message"], sentence);
    let plain = place.sabi(&["info", "--", "--json"]).fails(66);
    assert_eq!(plain.stdout, "", "a file with that name");
}

#[test]
fn a_bake_that_fails_writes_its_report() {
    let place = CliFolder::new();
    let more = ["--set", "amout=1", "--report", "out/report.json"];
    let run = place.bake("clouds.sabi", "cube.glb", &more).fails(2);
    assert_eq!(run.stdout, "");
    let sentence = "clouds.sabi: nothing is called \"amout\" (did you mean \"amount\"?); set an exposed knob (\"amount\", \"look\") \
                    or a node's parameter as node.param";
    let expected = json!({
        "sabi": env!("CARGO_PKG_VERSION"), "graph": "clouds.sabi", "mesh": { "file": "cube.glb" },
        "error": { "kind": "usage", "exit": 2, "message": sentence, "remedies": [] },
    });
    let report = |name: &str| serde_json::from_slice::<Json>(&place.read(name)).unwrap();
    assert_eq!(report("out/report.json"), expected);
    assert_eq!(place.listing("out"), ["report.json"]);
    let printed = place
        .bake("clouds.sabi", "cube.glb", &["--set", "amout=1", "--report", "-"])
        .fails(2);
    assert_eq!(serde_json::from_str::<Json>(&printed.stdout).unwrap(), expected);
    software_adapter();
    place
        .bake("clouds.sabi", "cube.glb", &["--report", "out/report.json"])
        .good();
    assert_eq!(
        report("out/report.json")["error"],
        Json::Null,
        "the folder of a failed bake is no foreign one"
    );
    let maps = place.read("out/cube_mask.png");
    place
        .bake("clouds.sabi", "none.glb", &["--report", "out/report.json"])
        .fails(66);
    assert_eq!(report("out/report.json")["error"]["kind"], "missing");
    assert_eq!(place.read("out/cube_mask.png"), maps);
}

#[test]
fn the_report_of_a_failure_replaces_reports_only() {
    let place = CliFolder::new();
    place.write("letter.txt", "dear reader");
    let run = place
        .bake("clouds.sabi", "none.glb", &["--report", "letter.txt"])
        .fails(66);
    assert_eq!(
        run.stderr,
        "error: the report letter.txt is not written: there is a file that is no report; name another one\n\
         error: none.glb: there is no such file; check the path\n"
    );
    assert_eq!(place.read("letter.txt"), b"dear reader");
    place.write("empty.json", "");
    place
        .bake("clouds.sabi", "none.glb", &["--report", "empty.json"])
        .fails(66);
    assert!(place.read("empty.json").starts_with(b"{"));
}

#[test]
fn a_machine_without_an_adapter_is_described_once() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let place = CliFolder::new();
    let nowhere = place.path("no_driver.json");
    let without = |arguments: &[&str]| {
        let mut command = place.command(arguments);
        command
            .env("VK_DRIVER_FILES", &nowhere)
            .env("VK_ICD_FILENAMES", &nowhere);
        crate::cli_folder::done(command.output().unwrap()).fails(4)
    };
    let doctor: Json = serde_json::from_str(&without(&["doctor", "--json"]).stdout).unwrap();
    assert_eq!((&doctor["usable"], &doctor["error"]), (&json!(false), &Json::Null));
    let bake = without(&["bake", "clouds.sabi", "--mesh", "cube.glb", "-o", "out", "--json"]);
    let found = error(&bake);
    assert_eq!((&found["kind"], &found["exit"]), (&json!("no_adapter"), &json!(4)));
}
