//! Tests of the document: what an artist does with a graph, and that all of it can be undone.

mod arranging;
mod commands;
mod copying;
mod dropping;
mod effect_library;
mod entering;
mod exposed_variants;
mod exposing;
mod finding;
mod framing;
mod group_ports;
mod grouping;
mod hand_layers;
mod inserting;
mod layering;
mod node_edits;
mod node_titles;
mod param_masks;
mod random;
mod random_values;
mod reconnecting;
mod replacing;
mod saving;
mod texture_set_import;
mod wiring;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::OnceLock;

use sabi_engine::{Kinds, Session};
use sabi_graph::{Document, FlatGraph, NodeId, OutputRef, Overrides, SlotRef, Value};

use crate::arrangement::{Align, DistributionAxis};
use crate::connections::PendingWire;
use crate::knob_target::{self, KnobTarget};
use crate::new_ids::IdGenerator;
use crate::node_kinds::NodeKinds;
use crate::node_size::{GRID, NODE_WIDTH, ShownRows};
use crate::open_document::OpenDocument;
use crate::stack::StackEnd;
use crate::wires::MaskMerge;
use crate::{
    arrangement, clipboard, connections, duplication, exposed_knobs, exposed_values, frames, groups, history,
    instance_variants, layers, library, navigation, node_paths, node_replacement, node_size, nodes, ports, selection,
    shown_variant, stack, texture_sets, variants, wires,
};

/// The built-in kinds, read once for all tests.
fn kinds() -> NodeKinds {
    static KINDS: OnceLock<NodeKinds> = OnceLock::new();
    KINDS.get_or_init(|| NodeKinds::new(Kinds::builtin(), 0)).clone()
}

fn document_with(session: Session, seed: u64) -> OpenDocument {
    OpenDocument::with_kinds(session, IdGenerator::seeded(seed), kinds())
}

/// Creates an empty graph whose new ids are the same in every run.
fn document() -> OpenDocument {
    document_with(Session::new(None), 7)
}

/// Opens a graph with these nodes, and with more top-level keys before them.
fn opened(more: &str, nodes: &str) -> OpenDocument {
    let text = format!(r#"{{ "format": "sabi", "version": 1, {more} "nodes": {{ {nodes} }} }}"#);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("test.sabi");
    std::fs::write(&file, &text).expect("a writable folder");
    let session = Session::open(&file, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    document_with(session, 7)
}

fn id(text: &str) -> NodeId {
    text.parse().expect("an id")
}

fn add(document: &mut OpenDocument, kind: &str) -> NodeId {
    nodes::add(document, kind, [0.0, 0.0], None).expect("a built-in kind")
}

fn out(id: &NodeId) -> OutputRef {
    OutputRef {
        node: id.clone(),
        port: None,
    }
}

/// Parses `node` or `node.port`.
fn from(text: &str) -> OutputRef {
    text.parse().expect("a result")
}

/// Parses `node.input`.
fn to(text: &str) -> SlotRef {
    text.parse().expect("an input")
}

fn slot(id: &NodeId, name: &str) -> SlotRef {
    SlotRef {
        node: id.clone(),
        name: name.to_owned(),
    }
}

fn select(document: &mut OpenDocument, ids: &[&str]) {
    document.select(ids.iter().map(|text| id(text)));
}

/// Returns the output that an input reads, as it is written in files; empty if it reads nothing.
fn wire(document: &OpenDocument, text: &str) -> String {
    connections::wire_into(document, &to(text))
        .map(OutputRef::to_string)
        .unwrap_or_default()
}

fn number(x: f64) -> Option<Value> {
    Some(Value::Number(x))
}

fn param(document: &OpenDocument, id: &str, name: &str) -> Option<Value> {
    document.graph().node(id)?.params.get(name).cloned()
}

/// Performs an action that must be one undo step: undo and redo must restore the same bytes, and the saved text must be the
/// text of the document.
fn step<T>(document: &mut OpenDocument, does: impl FnOnce(&mut OpenDocument) -> T) -> T {
    let (before, steps) = (
        document.session.text().to_owned(),
        document.session.undo_names().count(),
    );
    let done = does(document);
    let notices = document.take_notices();
    let after = document.session.text().to_owned();
    let selection = document.selection().clone();
    assert_eq!(
        document.session.undo_names().count(),
        steps + 1,
        "one step: {notices:?}"
    );
    assert_eq!(Document::from_json(&after).as_ref(), Ok(document.contents()));
    history::undo(document);
    assert_eq!(document.session.text(), before);
    history::redo(document);
    assert_eq!(document.session.text(), after);
    document.take_notices();
    for notice in notices {
        document.notify(notice);
    }
    document.select(selection);
    done
}

/// Performs an action that must be refused with a sentence and change nothing.
fn refused<T>(document: &mut OpenDocument, does: impl FnOnce(&mut OpenDocument) -> T) -> String {
    let (before, steps) = (
        document.session.text().to_owned(),
        document.session.undo_names().count(),
    );
    document.take_notices();
    does(document);
    assert_eq!(document.session.text(), before);
    assert_eq!(document.session.undo_names().count(), steps);
    document.take_notices().join("; ")
}

fn flat(document: &OpenDocument) -> FlatGraph {
    let flat = document.session.graph().flatten(&Overrides::default());
    flat.unwrap_or_else(|error| panic!("{error}"))
}

/// Returns hashes of everything that the outputs of a graph depend on. The ids of nodes do not matter.
fn evaluated(document: &OpenDocument) -> Vec<u64> {
    let flat = flat(document);
    let mut known: BTreeMap<usize, u64> = BTreeMap::new();
    for (at, node) in flat.nodes.iter().enumerate() {
        let mut hash = DefaultHasher::new();
        let told = (
            &node.kind,
            node.version,
            &node.params,
            node.muted,
            &node.seeds,
            node.fit,
        );
        format!("{told:?} {}", node.length_scale).hash(&mut hash);
        for (input, from) in &node.inputs {
            // Sources come before their readers.
            (input, known[&from.node], &from.port).hash(&mut hash);
        }
        known.insert(at, hash.finish());
    }
    let outputs = flat.nodes.iter().enumerate();
    let outputs = outputs.filter(|(_, node)| node.kind.starts_with("output/"));
    let mut made: Vec<u64> = outputs.map(|(at, _)| known[&at]).collect();
    made.sort_unstable();
    assert!(!made.is_empty(), "a graph without outputs tells nothing");
    made
}
