//! Invalid graph files: each gives a sentence that says where the error is and how to correct it.

use std::fs::File;

use crate::cli_folder::{CLOUDS, CliFolder, graph};

const OUT: &str = r#"    "out": { "kind": "output/mask", "inputs": { "source": "clouds" } }"#;

/// Returns a graph with the node `clouds` as given, and an output that reads it.
fn with(clouds: &str) -> String {
    graph(&format!("    {clouds},\n{OUT}"))
}

fn refused(place: &CliFolder, content: impl AsRef<[u8]>, words: &str) {
    refused_with(place, content, &[], words);
}

fn refused_with(place: &CliFolder, content: impl AsRef<[u8]>, more: &[&str], words: &str) {
    place.write("bad.sabi", content);
    place.refuses("bad.sabi", "cube.glb", more, 65, words);
}

#[test]
fn links_that_go_wrong_are_shown_in_the_file() {
    let place = CliFolder::new();
    refused(
        &place,
        with(
            "\"clouds\": { \"kind\": \"adjust/invert\", \"inputs\": { \"source\": \"turned\" } },\n    \"turned\": { \"kind\": \
             \"adjust/invert\", \"inputs\": { \"source\": \"clouds\" } }",
        ),
        "bad.sabi:8:64: node \"clouds\", input \"source\": the nodes feed each other in a circle: clouds → turned → \
         clouds; remove one of these links",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "adjust/invert", "inputs": { "source": "cluds" } }"#),
        "bad.sabi:8:64: node \"clouds\", input \"source\": there is no node \"cluds\" (did you mean \"clouds\"?)",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "source/material" }"#),
        "bad.sabi:9:49: input 'source' of node 'out' takes a mask, but 'clouds' gives a material; connect a mask",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "noise/simplex" }"#).replace(r#": "clouds" }"#, r#": "clouds.mesk" }"#),
        "bad.sabi:9:49: input 'source' of node 'out' asks 'clouds' for 'mesk', which it does not give; did you mean 'mask'?",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "filter/smooth" }"#),
        "bad.sabi:8:5: input 'source' of node 'clouds' (filter/smooth) must be connected to a mask",
    );
}

#[test]
fn kinds_and_values_that_nobody_knows_are_named() {
    let place = CliFolder::new();
    refused(
        &place,
        with(r#""clouds": { "kind": "noise/simplx" }"#),
        "bad.sabi:8:5: node 'clouds' is of kind 'noise/simplx', which no loaded node file describes; did you mean 'noise/simplex'?",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "noise/simplex", "params": { "octaves": "three" } }"#),
        "bad.sabi:8:54: parameter 'octaves' of node 'clouds' (noise/simplex) takes a whole number from 1 to 16, not \"three\"",
    );
    refused(
        &place,
        with(r#""clouds": { "kind": "noise/simplex", "params": { "octaves": 3000 } }"#),
        "bad.sabi:8:54: parameter 'octaves' of node 'clouds' (noise/simplex) takes a whole number from 1 to 16, not 3000",
    );
    refused(
        &place,
        graph(r#"    "clouds": { "kind": "noise/simplex" }"#),
        "bad.sabi: the graph has no output; add a node of kind 'output/material' and connect its material",
    );
}

#[test]
fn all_faults_are_told_before_the_model_is_looked_at() {
    let place = CliFolder::new();
    place.write(
        "bad.sabi",
        graph(
            r#"    "a": { "kind": "noise/simplx" },
    "b": { "kind": "noise/simplex", "params": { "octaves": 3000 } },
    "clouds": { "kind": "blend/mask", "inputs": { "below": "a", "above": "b" } },
    "one": { "kind": "output/mask", "inputs": { "source": "clouds" } },
    "two": { "kind": "output/mask", "inputs": { "source": "clouds" } }"#,
        ),
    );
    let words = "bad.sabi: nodes 'one' and 'two' (output/mask) both export a map named 'mask'; give one of them another \
                 name\nerror: bad.sabi:9:49: parameter 'octaves' of node 'b' (noise/simplex) takes a whole number from 1 to 16, \
                 not 3000\nerror: bad.sabi:8:5: node 'a' is of kind 'noise/simplx', which no loaded node file describes; did you \
                 mean 'noise/simplex'?";
    place.refuses("bad.sabi", "none.glb", &[], 65, words);
    let checked = place.sabi(&["check", "bad.sabi"]).fails(65);
    assert_eq!(checked.stdout, "bad.sabi: 3 errors\n");
    let clash = words.lines().next().unwrap();
    assert!(checked.stderr.contains(clash), "{}", checked.stderr);
}

#[test]
fn a_group_file_that_is_not_there_ends_with_66_and_a_damaged_one_with_65() {
    let place = CliFolder::new();
    let text = with(r#""clouds": { "kind": "graph/group", "group": "group.sabi" }"#)
        .replace(r#": "clouds" }"#, r#": "clouds.mask" }"#);
    place.write("bad.sabi", text);
    let words = |why: &str| {
        format!("bad.sabi: node \"clouds\" needs the group file \"group.sabi\", which cannot be read: group.sabi{why}")
    };
    let missing = words(": there is no such file; check the path");
    place.refuses("bad.sabi", "cube.glb", &[], 66, &missing);
    let checked = place.sabi(&["check", "bad.sabi"]).fails(66);
    assert_eq!(checked.stderr, format!("{missing}\n"));
    place.write("group.sabi", "");
    let damaged = words(":1:1: the file ends where a value is expected; it may have been cut off");
    place.refuses("bad.sabi", "cube.glb", &[], 65, &damaged);
    // A variant in the file that cannot be used is a fault of the file, whichever command reads it.
    let text = graph(CLOUDS).replace(r#""amount": 0.9"#, r#""amount": 7"#);
    refused_with(
        &place,
        text,
        &["--variant", "heavy"],
        "bad.sabi: \"amount\" is 7, but goes from 0 to 1; choose a value in that range",
    );
}

#[test]
fn a_graph_whose_outputs_are_muted_says_so() {
    let place = CliFolder::new();
    let text = graph(CLOUDS).replace(r#""kind": "output/mask","#, r#""kind": "output/mask", "muted": true,"#);
    refused(
        &place,
        text,
        "bad.sabi: the graph's only output 'out' is muted; unmute it",
    );
    let checked = place.sabi(&["check", "bad.sabi"]).good();
    assert_eq!(
        checked.stderr,
        "bad.sabi: warning: the graph's only output 'out' is muted; unmute it\n"
    );
    assert_eq!(checked.stdout, "bad.sabi: good, 2 nodes in 0 passes, 1 warning\n");
}

#[test]
fn an_unknown_parameter_is_kept_and_told() {
    let place = CliFolder::new();
    let text = with(r#""clouds": { "kind": "noise/simplex", "params": { "octavs": 3 } }"#);
    place.write("newer.sabi", &text);
    let run = place.bake("newer.sabi", "cube.glb", &[]).good();
    assert!(
        run.stderr.starts_with(
            "warning: newer.sabi: node 'clouds' (noise/simplex) has no parameter 'octavs'; it is kept and ignored; did you mean \
             'octaves'?\n"
        ),
        "{}",
        run.stderr
    );
    assert_eq!(place.read("newer.sabi"), text.as_bytes());
}

#[test]
fn files_that_are_no_graphs_are_refused() {
    let place = CliFolder::new();
    let whole = graph(CLOUDS);
    refused(
        &place,
        &whole[..whole.find("clouds.gain").unwrap()],
        "bad.sabi:5:35: the file ends inside the text that begins here; it may have been cut off",
    );
    refused(
        &place,
        whole.replace("\"version\": 1", "\"version\": 7"),
        "bad.sabi:3:14: written by a newer Sabi (version 7; this one reads up to 1); open it with that one, or install \
         it here",
    );
    refused(
        &place,
        "",
        "bad.sabi:1:1: the file ends where a value is expected; it may have been cut off",
    );
    refused(
        &place,
        b"\xff\xfe\x00",
        "bad.sabi: the file is not text: byte 0 is not UTF-8; graphs are JSON",
    );
    refused(
        &place,
        "{\"asset\": {}}",
        "bad.sabi:1:1: this is not a Sabi graph: it must be an object that begins with \"format\": \"sabi\"",
    );
    refused(
        &place,
        "[".repeat(200_000),
        "bad.sabi:1:130: values are nested more than 128 deep here; flatten them",
    );
}

#[test]
fn a_huge_file_is_refused_before_it_is_read() {
    let place = CliFolder::new();
    let file = File::create(place.path("huge.sabi")).unwrap();
    file.set_len(3 << 40).or_else(|_| file.set_len(65 << 20)).unwrap();
    let run = place.bake("huge.sabi", "cube.glb", &[]).fails(65);
    assert!(
        run.stderr.starts_with("error: huge.sabi: the file has "),
        "{}",
        run.stderr
    );
    assert!(run.stderr.ends_with(" MiB; graphs have at most 64\n"), "{}", run.stderr);
}

#[test]
fn a_graph_that_is_not_there_ends_with_66() {
    let place = CliFolder::new();
    let words = "none.sabi: there is no such file; check the path";
    place.refuses("none.sabi", "cube.glb", &[], 66, words);
    place.refuses(".", "cube.glb", &[], 66, ".: this is a folder; name a .sabi file");
}
