//! Any text is a document or a fault; a document survives being saved, inlined and planned.

use std::sync::LazyLock;

use sabi_graph::{Document, FlatGraph, Overrides, flatten};
use sabi_nodes::Library;
use sabi_plan::{Mode, Target};

use crate::planning::planned;

static LIBRARY: LazyLock<Library> = LazyLock::new(Library::builtin);

pub fn survives(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let Ok(document) = Document::from_json(text) else {
        return;
    };
    let saved = document.to_json();
    let again = Document::from_json(&saved).expect("what was saved can be read");
    assert_eq!(saved, again.to_json(), "saving again changes nothing");
    let flat = flatten(&document, &Overrides::default(), &mut |path| {
        Err(format!("{path} is not there"))
    });
    if let Ok(graph) = flat {
        plan(&graph);
    }
}

/// Plans every node in both ways of cutting.
pub fn plan(graph: &FlatGraph) {
    let targets: Vec<Target> = (0..graph.nodes.len()).map(|node| Target { node, port: None }).collect();
    for mode in [Mode::Interactive, Mode::Bake { fuse: true }] {
        planned(graph, &LIBRARY, &targets, mode);
    }
}
