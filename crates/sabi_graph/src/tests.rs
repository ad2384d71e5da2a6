//! Tests of the whole crate.

mod edits;
mod errors;
mod exposed_knobs;
mod finding;
mod fits;
mod flat;
mod group_files;
mod instance_values;
mod moved_documents;
mod random;
mod round_trip;

use proptest::test_runner::Config as ProptestConfig;

use crate::{Document, FlatGraph, FlattenError, Overrides, flatten};

/// Configuration of the random tests; a failure is reproduced from its printed input, not from a file.
fn config() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(200)
    }
}

/// Creates a document of this version with these lines for `nodes`, and with more top-level keys before them.
fn document(more: &str, nodes: &str) -> Document {
    let text = format!(r#"{{ "format": "sabi", "version": 1, {more} "nodes": {{ {nodes} }} }}"#);
    Document::from_json(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Flattens a document that uses no group files.
fn flat(document: &Document, overrides: &Overrides) -> Result<FlatGraph, FlattenError> {
    flatten(document, overrides, &mut |_| Err("no files in this test".to_owned()))
}
