//! Claims about the desk: what an artist does with a graph, and that all of it can be taken back.

mod arranging;
mod copying;
mod frames;
mod grouping;
mod healing;
mod inserting;
mod layers;
mod nodes;
mod panel;
mod ports;
mod random;
mod replacing;
mod saving;
mod seeing;
mod texture_sets;
mod variants;
mod wires;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, OnceLock};

use sabi_engine::catalog::Catalog;
use sabi_engine::{Kinds, Overrides, Session};
use sabi_graph::{Document, FlatGraph, NodeId, OutputRef, SlotRef, Value};

use super::names::Names;
use super::{Desk, Loose};

/// The built-in kinds, read once for all tests.
fn kinds() -> (Arc<Kinds>, Arc<Catalog>) {
    static KINDS: OnceLock<(Arc<Kinds>, Arc<Catalog>)> = OnceLock::new();
    let read = || {
        let kinds = Arc::new(Kinds::builtin());
        let catalog = Arc::new(Catalog::new(&kinds));
        (kinds, catalog)
    };
    KINDS.get_or_init(read).clone()
}

fn desk_with(session: Session, seed: u64) -> Desk {
    let (kinds, catalog) = kinds();
    Desk::with_kinds(session, Names::seeded(seed), kinds, catalog)
}

/// An empty graph, with names that are the same in every run.
fn desk() -> Desk {
    desk_with(Session::new(None), 7)
}

/// A graph with these nodes, and more top-level keys before them.
fn opened(more: &str, nodes: &str) -> Desk {
    let text = format!(r#"{{ "format": "sabi", "version": 1, {more} "nodes": {{ {nodes} }} }}"#);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("test.sabi");
    std::fs::write(&file, &text).expect("a writable folder");
    let session = Session::open(&file, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    desk_with(session, 7)
}

fn id(text: &str) -> NodeId {
    text.parse().expect("an id")
}

fn add(desk: &mut Desk, kind: &str) -> NodeId {
    desk.add(kind, [0.0, 0.0], None).expect("a built-in kind")
}

fn out(id: &NodeId) -> OutputRef {
    OutputRef {
        node: id.clone(),
        port: None,
    }
}

/// `node` or `node.port`.
fn from(text: &str) -> OutputRef {
    text.parse().expect("a result")
}

/// `node.input`.
fn to(text: &str) -> SlotRef {
    text.parse().expect("an input")
}

fn slot(id: &NodeId, name: &str) -> SlotRef {
    SlotRef {
        node: id.clone(),
        name: name.to_owned(),
    }
}

fn select(desk: &mut Desk, ids: &[&str]) {
    desk.select(ids.iter().map(|text| id(text)));
}

/// What an input reads, as the file has it; empty where it reads nothing.
fn wire(desk: &Desk, text: &str) -> String {
    desk.wire_into(&to(text)).map(OutputRef::to_string).unwrap_or_default()
}

fn number(x: f64) -> Option<Value> {
    Some(Value::Number(x))
}

fn param(desk: &Desk, id: &str, name: &str) -> Option<Value> {
    desk.graph().node(id)?.params.get(name).cloned()
}

/// Does something that has to be one step: undo leads back to the same bytes, redo forth to the same bytes, and the text is
/// that of the document.
fn step<T>(desk: &mut Desk, does: impl FnOnce(&mut Desk) -> T) -> T {
    let (before, steps) = (desk.session.text().to_owned(), desk.session.undo_names().count());
    let done = does(desk);
    let notices = desk.take_notices();
    let after = desk.session.text().to_owned();
    let selection = desk.selection().clone();
    assert_eq!(desk.session.undo_names().count(), steps + 1, "one step: {notices:?}");
    assert_eq!(Document::from_json(&after).as_ref(), Ok(desk.document()));
    desk.undo();
    assert_eq!(desk.session.text(), before);
    desk.redo();
    assert_eq!(desk.session.text(), after);
    desk.take_notices();
    desk.notices = notices;
    desk.select(selection);
    done
}

/// Does something that has to be refused with a sentence and change nothing.
fn refused<T>(desk: &mut Desk, does: impl FnOnce(&mut Desk) -> T) -> String {
    let (before, steps) = (desk.session.text().to_owned(), desk.session.undo_names().count());
    desk.take_notices();
    does(desk);
    assert_eq!(desk.session.text(), before);
    assert_eq!(desk.session.undo_names().count(), steps);
    desk.take_notices().join("; ")
}

fn flat(desk: &Desk) -> FlatGraph {
    let flat = desk.session.graph().flatten(&Overrides::default());
    flat.unwrap_or_else(|error| panic!("{error}"))
}

/// What the outputs of a graph are made of, whatever ids the nodes have.
fn evaluated(desk: &Desk) -> Vec<u64> {
    let flat = flat(desk);
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
            // Sources stand before their readers.
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
