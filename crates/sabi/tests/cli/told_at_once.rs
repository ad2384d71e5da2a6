//! All faults of a request are told at once, and each in a sentence that leads on.

use std::fs;

use serde_json::{Value as Json, json};

use crate::cli_folder::{CliFolder, graph};

#[test]
fn all_wrong_values_of_a_command_line_are_told() {
    let place = CliFolder::new();
    let run = place.bake(
        "rust.sabi",
        "cube.glb",
        &[
            "--variant",
            "havy",
            "--set",
            "amont=1",
            "--set",
            "amount=2",
            "--set",
            "clouds.octaves=3000",
            "--set",
            "rust.hight=1",
        ],
    );
    assert_eq!(run.code, Some(2), "{run:?}");
    let told: Vec<&str> = run.stderr.lines().collect();
    let words = [
        "there is no variant \"havy\" (did you mean \"heavy\"?)",
        "nothing is called \"amont\" (did you mean \"amount\"?)",
        "\"amount\" is 2, but goes from 0 to 1",
        "parameter 'octaves' of node 'clouds' (noise/simplex) takes a whole number from",
        "node 'rust' (effect/layer) has no parameter 'hight'; did you mean 'height'?",
    ];
    assert_eq!(told.len(), words.len(), "{told:#?}");
    for (line, words) in told.iter().zip(words) {
        assert!(line.starts_with("error: rust.sabi: ") && line.contains(words), "{line}");
    }
    let run = place.bake(
        "rust.sabi",
        "cube.glb",
        &["--set", "amount", "--set", "=1", "--set-file", "none.toml"],
    );
    assert_eq!(run.stderr.lines().count(), 3, "{}", run.stderr);
    let run = place.bake(
        "rust.sabi",
        "cube.glb",
        &["--preset", "a", "--preset", "b", "--channel", "c", "--channel", "d"],
    );
    assert_eq!(run.stderr.lines().count(), 2, "{}", run.stderr);
    let run = place.bake("rust.sabi", "cube.glb", &["--channel", "c", "--channel", "d"]);
    assert_eq!(run.stderr.lines().count(), 2, "{}", run.stderr);
}

#[test]
fn all_wrong_values_of_a_matrix_are_told() {
    let place = CliFolder::new();
    let plan = |matrix: &str| {
        place.write("matrix.toml", matrix);
        let run = place.sabi(&["plan", "matrix.toml"]).fails(65);
        run.stderr.lines().map(str::to_owned).collect::<Vec<String>>()
    };
    let told = plan(
        "version = 1\nlimit = 0\n[[bake]]\nmodels = \"cube.glb\"\ngraphs = \"rust.sabi\"\nsizes = 1\npading = 2\n[[bake]]\nname = \"b\"\n",
    );
    assert_eq!(told.len(), 5, "{told:#?}");
    // Once the file can be read, all of its items.
    let told = plan(
        "version = 1\nout = \"o/$mesh/$preset\"\n[[bake]]\nmodels = [\"cube.glb\", \"none.glb\"]\ngraphs = [\"rust.sabi\", \"gone.sabi\"]\nvariants \
         = \"havy\"\n[[bake]]\nmodels = \"sphere.glb\"\ngraphs = \"rust.sabi\"\nset = { amont = 1 }\npresets = [\"unrael\"]\n[[bake]]\nmodels = \
         \"cube.glb\"\ngraphs = \"rust.sabi\"\nset_file = [\"a.toml\", \"b.toml\"]\n",
    );
    for words in ["none.glb", "gone.sabi", "a.toml", "b.toml"] {
        assert!(told.iter().any(|line| line.contains(words)), "{words}: {told:#?}");
    }
    let told = plan(
        "version = 1\nout = \"o/$mesh/$preset\"\n[[bake]]\nmodels = \"cube.glb\"\ngraphs = \"rust.sabi\"\nvariants = \"havy\"\n[[bake]]\nmodels = \
         \"sphere.glb\"\ngraphs = \"rust.sabi\"\nset = { amont = 1, \"rust.hight\" = 2 }\npresets = [\"unrael\"]\n",
    );
    for words in ["\"havy\"", "\"amont\"", "'hight'", "'unrael'"] {
        assert!(told.iter().any(|line| line.contains(words)), "{words}: {told:#?}");
    }
}

#[test]
fn a_pattern_of_variants_may_fit_none_of_one_graph_but_not_of_all() {
    let place = CliFolder::new();
    place.write("plain.sabi", "{ \"format\": \"sabi\", \"version\": 1, \"nodes\": { \"n\": { \"kind\": \"noise/simplex\" }, \"o\": { \"kind\": \
                               \"output/mask\", \"inputs\": { \"source\": \"n\" } } } }");
    let plan = |variants: &str| {
        let matrix = format!(
            "version = 1\nout = \"o/$graph(_$variant)\"\n[[bake]]\nmodels = \"cube.glb\"\ngraphs = [\"clouds.sabi\", \
             \"plain.sabi\"]\nvariants = {variants}\n"
        );
        place.write("matrix.toml", matrix);
        place.sabi(&["plan", "matrix.toml"])
    };
    for (variants, items) in [("[\"\", \"*\"]", 3), ("[\"\", \"hea*\"]", 3)] {
        let run = plan(variants).good();
        assert!(
            run.stderr.starts_with(&format!("Planned {items} items")),
            "{}",
            run.stderr
        );
    }
    let none = plan("[\"\", \"dese*\"]").fails(65);
    assert_eq!(
        none.stderr,
        "error: matrix.toml: bake 1: none of its graphs has a variant that fits 'dese*'\n"
    );
    let nothing = plan("[\"*\"]").fails(65);
    assert!(
        nothing
            .stderr
            .contains("plain.sabi has no variant that is asked for; add \"\" to 'variants' for its own values"),
        "{}",
        nothing.stderr
    );
}

#[test]
fn all_folders_are_verified_though_one_has_no_record() {
    let place = CliFolder::new();
    place.bake("clouds.sabi", "cube.glb", &[]).good();
    fs::create_dir(place.path("empty")).unwrap();
    place.bake("clouds.sabi", "cube.glb", &["-o", "bad"]).good();
    place.write("bad/stranger.txt", "?");
    let run = place.sabi(&["verify", "empty", "out", "none", "bad"]).fails(66);
    assert_eq!(
        run.stdout,
        "out: good, 1 file of 1 bake\nbad: 1 finding in 1 file of 1 bake\n"
    );
    assert!(
        run.stderr.contains("error: empty has no manifest of bakes"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("error: none is no folder"), "{}", run.stderr);
    let run = place.sabi(&["verify", "empty", "out", "--json"]).fails(66);
    let verified: Json = serde_json::from_str(&run.stdout).unwrap();
    assert!(
        verified[0]["error"].as_str().unwrap().contains("has no manifest"),
        "{verified}"
    );
    assert_eq!((&verified[1]["files"], &verified[1]["error"]), (&json!(1), &Json::Null));
    place.sabi(&["verify", "out", "bad"]).fails(3);
}

#[test]
fn a_mistyped_command_is_told_whatever_follows_it() {
    let place = CliFolder::new();
    let sentence = |word: &str, meant: &str| {
        format!("error: there is no file '{word}' to edit, and no such command; did you mean 'sabi {meant}'?\n")
    };
    for (arguments, meant) in [
        (&["bakee", "rust.sabi"][..], "bake"),
        (&["bakee", "rust.sabi", "--mesh", "cube.glb", "-o", "out"], "bake"),
        (&["bakee"], "bake"),
        (&["chek", "rust.sabi", "--json"], "check"),
        (&["-q", "rendr", "rust.sabi"], "render"),
    ] {
        let run = place.sabi(arguments).fails(2);
        let word = arguments.iter().find(|word| !word.starts_with('-')).unwrap();
        assert_eq!(run.stderr, sentence(word, meant), "{arguments:?}");
        if arguments.contains(&"--json") {
            assert!(run.stdout.contains("did you mean 'sabi check'?"), "{}", run.stdout);
        }
    }
    let run = place.sabi(&["rust.sabi", "clouds.sabi"]).fails(2);
    assert!(run.stderr.contains("'clouds.sabi'"), "{}", run.stderr);
}

#[test]
fn a_node_that_is_not_there_is_told_with_those_that_are_most_alike() {
    let place = CliFolder::new();
    let nodes: Vec<String> = (0..200)
        .map(|at| format!("    \"grain_{at:03}\": {{ \"kind\": \"noise/simplex\" }},"))
        .collect();
    let more = "    \"clouds\": { \"kind\": \"noise/simplex\" },\n    \"out\": { \"kind\": \"output/mask\", \"inputs\": { \"source\": \"clouds\" } }";
    place.write("many.sabi", graph(&format!("{}\n{more}", nodes.join("\n"))));
    let run = place.sabi(&[
        "preview",
        "many.sabi",
        "--mesh",
        "cube.glb",
        "--node",
        "scratches_of_all",
        "-o",
        "x.png",
    ]);
    assert_eq!(run.code, Some(2), "{run:?}");
    assert!(
        run.stderr.len() < 250 && run.stderr.contains(" and 197 more"),
        "{}",
        run.stderr
    );
    let run = place.sabi(&[
        "preview",
        "many.sabi",
        "--mesh",
        "cube.glb",
        "--node",
        "grain_20",
        "-o",
        "x.png",
    ]);
    assert!(run.stderr.contains("did you mean 'grain_"), "{}", run.stderr);
}

#[test]
fn a_file_that_is_no_report_is_called_so() {
    let place = CliFolder::new();
    place.write("notes.json", "not JSON");
    let run = place.sabi(&["bake", "--from", "notes.json", "-o", "out"]).fails(65);
    assert!(
        run.stderr
            .starts_with("error: the report notes.json is no report of a bake: "),
        "{}",
        run.stderr
    );
}

#[test]
fn a_path_that_nothing_may_open_is_told_without_advice_to_trust_it() {
    let place = CliFolder::new();
    let picture = |path: &str| {
        graph(&format!(
            "    \"clouds\": {{ \"kind\": \"noise/simplex\" }},\n    \"photo\": {{ \"kind\": \"source/image\", \"params\": {{ \"file\": \
             \"{path}\" }} }},\n    \"out\": {{ \"kind\": \"output/color\", \"inputs\": {{ \"source\": \"photo\" }} }}"
        ))
    };
    place.write("far.sabi", picture("//server/share/photo.png"));
    let run = place.bake("far.sabi", "cube.glb", &[]);
    assert!(
        run.stderr.contains("//server/share/photo.png is on another computer"),
        "{}",
        run.stderr
    );
    assert!(!run.stderr.contains("--trust"), "{}", run.stderr);
    let outside = tempfile::NamedTempFile::with_suffix(".png").unwrap();
    place.write("near.sabi", picture(&outside.path().display().to_string()));
    let run = place.bake("near.sabi", "cube.glb", &[]);
    assert!(run.stderr.contains("--trust"), "{}", run.stderr);
}

#[test]
fn names_that_differ_by_capital_letters_alone_are_both_told() {
    let place = CliFolder::new();
    let masks = "    \"clouds\": { \"kind\": \"noise/simplex\" },\n    \"a\": { \"kind\": \"output/mask\", \"inputs\": { \"source\": \"clouds\" }, \
                 \"params\": { \"name\": \"wear\" } },\n    \"b\": { \"kind\": \"output/mask\", \"inputs\": { \"source\": \"clouds\" }, \"params\": { \
                 \"name\": \"Wear\" } }";
    place.write("masks.sabi", graph(masks));
    let run = place.bake("masks.sabi", "cube.glb", &[]).fails(65);
    assert_eq!(
        run.stderr,
        "error: masks.sabi: nodes 'a' and 'b' (output/mask) export maps named 'wear' and 'Wear', which are one file on systems that \
         ignore capital letters; give one of them another name\n"
    );
}

#[test]
fn info_warns_of_every_file_that_is_not_there() {
    let place = CliFolder::new();
    let graph = "{ \"format\": \"sabi\", \"version\": 1, \"preview\": { \"mesh\": \"gone.glb\" }, \"nodes\": { \"p\": { \"kind\": \"source/paint\", \
                 \"params\": { \"strokes\": \"0123456789abcdef\" } }, \"o\": { \"kind\": \"output/mask\", \"inputs\": { \"source\": \"p\" } } } }";
    place.write("shown.sabi", graph);
    let run = place.sabi(&["info", "shown.sabi", "--json"]).good();
    let found: Json = serde_json::from_str(&run.stdout).unwrap();
    let missing = found["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|file| file["exists"] == false);
    let warnings = found["warnings"].to_string();
    let mut count = 0;
    for file in missing {
        let path = file["path"].as_str().unwrap();
        assert!(warnings.contains(path), "{path}: {warnings}");
        count += 1;
    }
    assert!(
        count >= 1 && warnings.contains("the graph is shown on the model"),
        "{found}"
    );
}

#[test]
fn a_broken_node_of_ones_own_is_told_once() {
    let place = CliFolder::new();
    fs::create_dir_all(place.path("nodes/own")).unwrap();
    place.write("nodes/own/odd.wgsl", "//! Odd\n//! Is broken.\n\nfn mask( -> f32 {\n");
    place.write("own.sabi", graph("    \"clouds\": { \"kind\": \"own/odd\" },\n    \"out\": { \"kind\": \"output/mask\", \"inputs\": { \"source\": \"clouds\" } }"));
    let run = place.sabi(&["check", "own.sabi", "--json"]).fails(65);
    let found: Json = serde_json::from_str(&run.stdout).unwrap();
    let (errors, warnings) = (&found[0]["errors"], &found[0]["warnings"]);
    assert!(errors.to_string().contains("odd.wgsl"), "{found}");
    assert!(!warnings.to_string().contains("odd.wgsl"), "{found}");
    // A graph that does not use it is warned.
    let run = place.sabi(&["check", "rust.sabi", "--json"]).good();
    assert!(run.stdout.contains("odd.wgsl"), "{}", run.stdout);
    place.sabi(&["check", "rust.sabi", "--strict"]).fails(65);
}

#[test]
fn keys_that_nothing_reads_are_told_by_check_info_and_bake_and_fail_a_strict_check() {
    let place = CliFolder::new();
    place.write(
        "odd.sabi",
        graph(
            "    \"clouds\": { \"kind\": \"noise/simplex\", \"parms\": { \"octaves\": 2 } },\n    \"out\": { \"kind\": \
                                   \"output/mask\", \"inputs\": { \"source\": \"clouds\" } }",
        ),
    );
    let sentence = "odd.sabi:8:42: node \"clouds\" has a key \"parms\", which nothing reads; did you mean \"params\"?";
    let run = place.sabi(&["check", "odd.sabi"]).good();
    assert!(run.stderr.contains(&format!("{sentence}\n")), "{}", run.stderr);
    let strict = place.sabi(&["check", "--strict", "odd.sabi", "rust.sabi"]).fails(65);
    assert!(
        strict.stderr.contains(sentence) && strict.stdout.contains("odd.sabi: 1 error\nrust.sabi: good"),
        "{strict:?}"
    );
    let run = place.sabi(&["info", "odd.sabi", "--json"]).good();
    assert!(run.stdout.contains("which nothing reads"), "{}", run.stdout);
    let run = place.bake("odd.sabi", "cube.glb", &[]).good();
    assert!(run.stderr.contains(&format!("warning: {sentence}\n")), "{}", run.stderr);
}
