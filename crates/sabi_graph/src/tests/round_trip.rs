//! Saving a loaded document adds and removes nothing.

use proptest::prelude::*;

use super::config;
use super::random::a_document;
use crate::{Document, OutputRef, Value};

const NEWEST: &str = include_str!("../../tests_data/version_1.sabi");

#[test]
fn saving_a_loaded_file_gives_the_same_bytes() {
    let document = Document::from_json(NEWEST).unwrap_or_else(|error| panic!("{}", error.with_name("version_1.sabi")));
    assert_eq!(document.to_json(), NEWEST);
}

#[test]
fn layout_and_order_of_the_text_do_not_matter() {
    let mut words: Vec<&str> = NEWEST.lines().map(str::trim).collect();
    words.insert(0, "\u{feff}");
    let flat = words
        .join("")
        .replace("seed\": 4000000000", "seed\": 4.0e9")
        .replace("0.33333334", "0.333333333333");
    assert_eq!(Document::from_json(&flat).unwrap().to_json(), NEWEST);
}

#[test]
fn version_0_is_migrated_to_the_newest_version() {
    let document = Document::from_json(include_str!("../../tests_data/version_0.sabi")).unwrap();
    let link = |graph: &crate::Graph, id| graph.link_into(id, "source").map(OutputRef::to_string);
    assert_eq!(link(&document.graph, "levels_1").as_deref(), Some("grain_1.mask"));
    assert_eq!(link(&document.groups["grain"].graph, "flip").as_deref(), Some("noise"));
    assert_eq!(
        document.graph.node("levels_1").unwrap().params["gamma"],
        Value::Number(2.5)
    );
    assert!(document.to_json().contains("\"version\": 1,"));
    assert!(!document.to_json().contains("edges"));
}

#[test]
fn the_smallest_valid_file_has_three_keys() {
    let text = "{\n  \"format\": \"sabi\",\n  \"version\": 1,\n  \"nodes\": {}\n}\n";
    assert_eq!(Document::default().to_json(), text);
    assert_eq!(Document::from_json(text), Ok(Document::default()));
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn loading_a_saved_document_gives_the_same_document(document in a_document()) {
        let text = document.to_json();
        let loaded = Document::from_json(&text);
        prop_assert_eq!(loaded.as_ref(), Ok(&document), "{}", text);
        prop_assert_eq!(document.to_json(), text);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "[\\[\\]{}\",:0-9a-z\\\\ .-]{0,60}") {
        let _ = Document::from_json(&text);
    }

    #[test]
    fn a_damaged_file_is_either_read_or_gives_an_error_within_the_file(at in 0..NEWEST.len(), c in any::<char>()) {
        let mut text: Vec<char> = NEWEST.chars().collect();
        let at = at.min(text.len() - 1);
        text[at] = c;
        let text: String = text.into_iter().collect();
        if let Err(error) = Document::from_json(&text) {
            let line = text.split('\n').nth(error.line - 1);
            prop_assert!(line.is_some_and(|line| error.column <= line.chars().count() + 1), "{}", error);
        }
    }

    #[test]
    fn a_truncated_file_is_an_error(at in 0..NEWEST.len() - 2) {
        prop_assume!(NEWEST.is_char_boundary(at));
        prop_assert!(Document::from_json(&NEWEST[..at]).is_err());
    }
}

#[test]
fn the_example_graphs_are_in_canonical_form() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../graphs");
    let folders = [folder.to_owned(), format!("{folder}/thesis")];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let files = files.map(|entry| entry.unwrap().path());
    for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "sabi")) {
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(
            Document::from_json(&text).unwrap().to_json(),
            text,
            "{}",
            path.display()
        );
    }
}
