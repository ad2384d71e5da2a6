use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::Document;

/// Returns the warnings about unknown keys of a graph with these members.
fn told(members: &str) -> Vec<String> {
    let text = format!("{{ \"format\": \"sabi\", \"version\": 1,\n{members} }}");
    Document::from_json(&text).expect("unknown keys are no errors");
    let keys = unknown_keys(&text).first.into_iter();
    keys.map(|key| format!("{}:{}: {key}", key.line, key.column)).collect()
}

#[test]
fn a_misspelled_key_is_reported_with_its_place_and_a_suggestion() {
    let cases = [
        (
            r#""nodes": { "a": { "kind": "x", "parms": { "size": 3 } } }"#,
            r#"2:32: node "a" has a key "parms", which nothing reads; did you mean "params"?"#,
        ),
        (
            r#""nodes": { "a": { "kind": "x", "input": { "mask": "b" } } }"#,
            r#"2:32: node "a" has a key "input", which nothing reads; did you mean "inputs"?"#,
        ),
        (
            r#""nodes": {}, "exposd": {}"#,
            r#"2:14: the graph has a key "exposd", which nothing reads; did you mean "exposed"?"#,
        ),
        (
            r#""groups": { "g": { "nodes": { "a": { "kind": "x", "pose": [0, 0] } } } }, "nodes": {}"#,
            r#"2:51: node "a" of group "g" has a key "pose", which nothing reads; did you mean "pos"?"#,
        ),
        (
            r#""preview": { "model": "a.glb", "views": { "v": { "lens": 1 } } }, "nodes": {}"#,
            r#"2:14: "preview" of the graph has a key "model", which nothing reads; there is also "mesh", "textures", "parts", "without", "turn_faces", "size", "variant""#,
        ),
        (
            r#""nodes": { "a": { "kind": "x" } }, "exposed": { "k": { "to": ["a.b"], "defaults": 1 } }"#,
            r#"2:71: exposed "k" has a key "defaults", which nothing reads; did you mean "default"?"#,
        ),
        (
            r#""nodes": { "a": { "kind": "x", "inputs": {}, "Inputs": {} } }"#,
            r#"2:46: node "a" has a key "Inputs", which nothing reads; there is also "group", "label", "params", "pos", "muted", "rows", "named_wires""#,
        ),
    ];
    for (members, sentence) in cases {
        assert_eq!(told(members).first().map(String::as_str), Some(sentence), "{members}");
    }
    let view = told(r#""preview": { "model": "a.glb", "views": { "v": { "lens": 1 } } }, "nodes": {}"#);
    assert!(view[1].starts_with(r#"2:50: view "v" has a key "lens""#), "{view:?}");
}

#[test]
fn of_very_many_unknown_keys_the_first_are_described() {
    let keys: String = (0..5000).map(|key| format!("\"k{key}\": 1, ")).collect();
    let text = format!(r#"{{ "format": "sabi", "version": 1, {keys} "nodes": {{}} }}"#);
    let found = unknown_keys(&text);
    assert_eq!((found.first.len(), found.more), (100, 4900));
    assert_eq!(found.first[99].key, "k99");
}

#[test]
fn names_and_values_are_no_keys() {
    let members = r#""nodes": { "parms": { "kind": "x", "params": { "parms": { "input": 1 } }, "inputs": {} } },
        "exposed": { "exposd": { "to": ["parms.parms"] } }, "variants": { "parms": { "exposd": 1 } }"#;
    assert_eq!(told(members), Vec::<String>::new());
    assert_eq!(unknown_keys("no graph"), UnknownKeys::default());
}

#[test]
fn every_known_key_is_read_and_every_other_one_is_kept() {
    let text = r##"{ "format": "sabi", "version": 1, "x": 1, "name": "n", "about": "a", "words": ["w"],
        "preview": { "mesh": "m.glb", "textures": "t", "parts": ["p"], "without": ["w"], "turn_faces": true, "size": 64, "variant": "v", "x": 1,
            "views": { "v": { "target": [0, 0, 0], "yaw": 1, "pitch": 1, "distance": 1, "parallel": true, "x": 1 } } },
        "fit": "metres", "seed": 1,
        "exposed": { "k": { "to": ["a.p"], "curves": { "a.p": [[0, 0], [1, 1]] }, "label": "l", "about": "a", "section": "s",
            "order": 1, "range": [0, 1], "default": 1, "x": 1 } },
        "variants": { "v": { "k": 1 } },
        "frames": { "f": { "title": "t", "color": "#fff", "nodes": ["a"], "x": 1 } },
        "notes": { "n": { "text": "t", "pos": [0, 0], "width": 9, "color": "#fff", "x": 1 } },
        "groups": { "g": { "name": "n", "about": "a", "words": ["w"], "library": { "file": "f", "digest": "d", "x": 1 },
            "fit": 2, "exposed": {}, "variants": {}, "frames": {}, "notes": {}, "x": 1,
            "inputs": { "i": { "to": ["b.in"], "type": "mask", "label": "l", "x": 1 } }, "outputs": { "o": "b" },
            "nodes": { "b": { "kind": "x" } } } },
        "inputs": {}, "outputs": {},
        "nodes": { "a": { "kind": "graph/group", "group": "g", "label": "l", "inputs": {}, "params": { "p": 1 }, "pos": [1, 2],
            "muted": true, "rows": "none", "named_wires": true, "x": 1 } } }"##;
    let document = Document::from_json(text).expect("a graph");
    let saved = document.to_json();
    assert_eq!(Document::from_json(&saved), Ok(document));
    assert_eq!(unknown_keys(text).first.len(), OBJECTS.len(), "an x in each object");
    assert_eq!(unknown_keys(&saved).first.len(), OBJECTS.len(), "all are kept");
    let members = saved.matches("\": ").count();
    for object in OBJECTS {
        for key in object.keys {
            let is_empty = matches!(key.value, ValueShape::Map(_) | ValueShape::Objects(_))
                && text.contains(&format!("\"{}\": {{}}", key.name));
            assert!(
                is_empty || saved.contains(&format!("\"{}\":", key.name)),
                "{} {}",
                object.name,
                key.name
            );
        }
    }
    assert!(members > 60, "{members}");
}

fn docs(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(file)
}

fn read(file: &str) -> String {
    fs::read_to_string(docs(file)).unwrap_or_default().replace("\r\n", "\n")
}

#[test]
fn the_schema_in_the_documentation_is_that_of_the_code() {
    let schema = format_schema();
    if std::env::var("SABI_BLESS").is_ok_and(|kind| kind == "schema") {
        fs::write(docs("sabi.schema.json"), &schema).expect("the documentation can be written");
    }
    assert!(
        read("sabi.schema.json") == schema,
        "docs/sabi.schema.json is not what the code reads; `cargo xtask bless schema` writes it again"
    );
}

/// Rows of the tables on the documentation page, by name of the object.
#[test]
fn the_page_of_the_format_lists_exactly_the_keys_of_the_code() {
    let page = read("graph-file.md");
    for object in format_objects() {
        let heading = format!("\n### {}\n\n{}\n\n", object.name, object.about);
        let (_, after) = page
            .split_once(&heading)
            .unwrap_or_else(|| panic!("a section{heading}"));
        let rows: Vec<&str> = after.lines().skip(2).take_while(|line| line.starts_with('|')).collect();
        let expected: Vec<String> = object
            .keys
            .iter()
            .map(|key| {
                let needed = if key.is_needed { ", needed" } else { "" };
                format!("| `{}` | {}{needed} | {} |", key.name, key.value, key.about)
            })
            .collect();
        assert_eq!(rows, expected, "of {}", object.name);
    }
    assert_eq!(page.matches("\n### ").count(), OBJECTS.len());
}

#[test]
fn a_git_conflict_is_reported_as_such() {
    let text = "{ \"format\": \"sabi\", \"version\": 1, \"nodes\": {\n<<<<<<< HEAD\n  \"a\": { \"kind\": \"x\" }\n=======\n  \"b\": { \"kind\": \
                \"x\" }\n>>>>>>> other\n} }";
    let told = |text: &str| {
        Document::from_json(text)
            .expect_err("a conflict")
            .with_name("a.sabi")
            .to_string()
    };
    assert_eq!(
        told(text),
        "a.sabi:2:1: \"<<<<<<< HEAD\" is a conflict marker of git: two versions of the graph were merged and differ here; keep one \
         side or both, and remove the lines that begin with <<<<<<<, ======= and >>>>>>>"
    );
    // A marker that was left in the file when the others were removed.
    let rest = text.replace("<<<<<<< HEAD\n", "").replace("=======\n", ",");
    assert!(
        told(&rest).starts_with("a.sabi:4:1: \">>>>>>> other\" is a conflict marker"),
        "{}",
        told(&rest)
    );
    assert!(told(&rest.replace(">>>>>>> other\n", "]")).contains("is expected here"));
}
