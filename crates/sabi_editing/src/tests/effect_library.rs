//! The graphs of the effect library: how they are written, and what every group offers.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use sabi_engine::effect_library::effect_library;
use sabi_engine::{OpenGraph, Session};
use sabi_files::TrustedPaths;
use sabi_graph::{Document, Fit, GROUP_KIND, PortType};

use super::{arrangement, document_with};
use crate::library_folder::LibraryFolder;
use crate::{history, library, linked_groups, nodes, trust};

/// Minimum number of groups in the library.
const FEWEST: usize = 46;
/// Groups whose lengths are shares of the whole model, each with its reason.
const OF_THE_WHOLE_MODEL: [(&str, &str); 5] = [
    ("Masonry", "bricks are as large on all pieces of a wall"),
    ("Plaster off masonry", "bricks are as large on all pieces of a wall"),
    (
        "Ground splash",
        "water splashes and rises as high on all pieces that stand on the ground",
    ),
    (
        "Damp wall",
        "water rises as high on all pieces that stand on the ground",
    ),
    (
        "Markings",
        "stripes are painted over joints, once the object is put together",
    ),
];
/// Maximum number of knobs that a group exposes.
const MOST_KNOBS: usize = 9;

fn folder() -> PathBuf {
    effect_library(Path::new("")).expect("the library of the project")
}

/// Files of the library by category.
fn files() -> BTreeMap<String, Vec<PathBuf>> {
    let sorted = |folder: &Path| {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.sort();
        paths
    };
    let categories = sorted(&folder()).into_iter();
    let named = categories.map(|category| (category.file_name().unwrap().to_string_lossy().into_owned(), category));
    named.map(|(name, category)| (name, sorted(&category))).collect()
}

pub(super) fn all_files() -> Vec<PathBuf> {
    files().into_values().flatten().collect()
}

/// Returns all graphs of the project.
pub(super) fn all_graphs() -> impl Iterator<Item = PathBuf> {
    all_files().into_iter().chain(examples())
}

fn is_without_places(document: &Document) -> bool {
    document.graph.nodes().all(|(_, node)| node.pos == [0.0; 2])
}

#[test]
fn every_graph_of_the_project_is_stored_as_the_editor_saves_it() {
    let bless = std::env::var("SABI_BLESS").is_ok_and(|what| what == "library");
    let mut wrong = Vec::new();
    for file in all_graphs() {
        let session = Session::open(&file, None).unwrap_or_else(|error| panic!("{error}"));
        let mut document = document_with(session, 7);
        if bless && is_without_places(document.contents()) {
            arrangement::lay_out(&mut document);
        }
        let text = document.contents().to_json();
        let is_laid_out = !is_without_places(document.contents());
        if bless {
            fs::write(&file, &text).expect("a writable folder");
        } else if fs::read_to_string(&file).expect("a file") != text || !is_laid_out {
            wrong.push(file.display().to_string());
        }
    }
    assert!(
        wrong.is_empty(),
        "`cargo xtask bless library` lays these out and writes them anew:\n{}",
        wrong.join("\n")
    );
}

/// Example graphs, which use groups of the library by their files.
fn examples() -> Vec<PathBuf> {
    let graphs = folder().parent().expect("a folder of graphs").to_owned();
    let of = |name: &str| {
        let entries = fs::read_dir(graphs.join(name)).expect("a folder");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "sabi"));
        paths.sort();
        paths
    };
    ["examples", "thesis"].into_iter().flat_map(of).collect()
}

#[test]
fn every_group_of_the_library_offers_the_standard_knobs() {
    let files = files();
    let categories: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(categories, ["base", "finish", "generator", "weathering"]);
    let count = files.values().map(Vec::len).sum::<usize>();
    assert!(count >= FEWEST, "{count} groups are fewer than {FEWEST}");
    let faults: Vec<String> = all_files()
        .iter()
        .flat_map(|file| {
            let open = OpenGraph::open(file).unwrap_or_else(|error| panic!("{error}"));
            let name = file.display().to_string();
            faults_of(&open.document)
                .into_iter()
                .map(move |fault| format!("{name}: {fault}"))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn faults_of(document: &Document) -> Vec<String> {
    let mut faults = Vec::new();
    let mut expect = |is_so: bool, fault: &str| {
        if !is_so {
            faults.push(fault.to_owned());
        }
    };
    let about = document.description.about.as_deref().unwrap_or("");
    expect(
        !document.name.is_empty() && about.ends_with('.'),
        "has no name or no sentence about it",
    );
    expect(
        document.description.words.len() >= 3,
        "is found by fewer than three words",
    );
    let is_of_model = OF_THE_WHOLE_MODEL.iter().any(|(name, _)| *name == document.name);
    expect(
        document.fit == Fit::Piece || is_of_model,
        "has lengths that are no shares of the piece",
    );
    let graph = &document.graph;
    let exposed = graph.exposed_in_order();
    let names: Vec<&str> = exposed.iter().map(|(name, _)| *name).collect();
    expect(names.len() <= MOST_KNOBS, "exposes more than nine knobs");
    // A group with random values for whole parts has no size; use its choice of parts instead.
    let second = if names.contains(&"by") { "by" } else { "size" };
    expect(
        names.starts_with(&["amount", second, "age"]),
        "does not begin with amount, size and age",
    );
    for (name, knob) in &exposed {
        let is_told = knob.about.as_deref().is_some_and(|about| about.ends_with('.'));
        expect(
            is_told && knob.label.is_some(),
            &format!("knob {name} has no label or no sentence about it"),
        );
    }
    let amount = graph.exposed().get("amount").and_then(|knob| knob.range);
    expect(amount == Some([0.0, 1.0]), "amount is no share of 0 to 1");
    let age = graph.exposed().get("age").map_or(0, |knob| knob.curves.len());
    expect(age >= 3, "age drives fewer than three parameters by curves");
    let variants = graph.variants().len();
    expect((3..=8).contains(&variants), "has not three to eight variants");
    let port = |name: &str| document.inputs.get(name).and_then(|input| input.ty);
    expect(port("material") == Some(PortType::Material), "has no input material");
    expect(port("mask") == Some(PortType::Mask), "has no input mask");
    for output in ["material", "mask"] {
        expect(
            document.outputs.contains_key(output),
            &format!("has no output {output}"),
        );
    }
    let kinds: Vec<&str> = graph.nodes().map(|(_, node)| node.kind.as_str()).collect();
    expect(
        kinds.contains(&"output/material"),
        "cannot be opened by itself, without an output",
    );
    faults
}

/// A document with an instance of a group of a library in a folder.
fn with_instance(folder: &Path) -> crate::OpenDocument {
    let mut document = document_with(Session::new(None), 7);
    document.library_folders = vec![LibraryFolder {
        name: "sabi".to_owned(),
        folder: folder.to_owned(),
    }];
    trust::trust_files(&mut document, &TrustedPaths::default().with_path(folder));
    library::add(&mut document, &folder.join("weathering/worn.sabi"), [0.0; 2], None).expect("an instance");
    document
}

/// Writes a library of two groups, one of which uses the other. `knobs` are the knobs that it exposes.
fn write_library(folder: &Path, knobs: &str) {
    fs::create_dir_all(folder.join("weathering")).expect("a folder");
    let write = |name: &str, more: &str, nodes: &str| {
        let text = format!(r#"{{ "format": "sabi", "version": 1, {more} "nodes": {{ {nodes} }} }}"#);
        fs::write(folder.join("weathering").join(name), text).expect("a writable folder");
    };
    write(
        "grain.sabi",
        r#""name": "Grain", "outputs": { "mask": "n" },"#,
        r#""n": { "kind": "noise/cells" }"#,
    );
    write(
        "worn.sabi",
        &format!(r#""name": "Worn", "fit": "piece", "exposed": {{ {knobs} }}, "outputs": {{ "mask": "i" }},"#),
        r#""i": { "kind": "graph/group", "group": "grain.sabi" }, "n": { "kind": "noise/cells" }"#,
    );
}

const TWO_KNOBS: &str = r#""size": { "to": ["n.size"] }, "jitter": { "to": ["n.jitter"] }"#;

#[test]
fn an_instance_has_a_copy_of_its_library_file_and_of_all_files_it_uses() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path(), TWO_KNOBS);
    let document = with_instance(folder.path());
    let groups = &document.contents().groups;
    assert_eq!(groups.keys().collect::<Vec<_>>(), ["Grain", "Worn"]);
    let link = groups["Worn"].library.as_ref().expect("a link");
    assert_eq!(link.file, "sabi:weathering/worn.sabi");
    assert!(
        groups["Grain"].library.is_none(),
        "an inner group comes with the outer one"
    );
    let inner = groups["Worn"].graph.nodes().find(|(_, node)| node.kind == GROUP_KIND);
    assert_eq!(inner.and_then(|(_, node)| node.group.as_deref()), Some("Grain"));
}

#[test]
fn an_update_keeps_existing_knobs_and_can_be_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path(), TWO_KNOBS);
    let mut document = with_instance(folder.path());
    let id = document.selected_one().cloned().expect("the instance");
    for (knob, value) in [("size", 0.5), ("jitter", 0.25)] {
        nodes::set_knob(&mut document, &id, knob, Some(value.into()));
    }
    let before = document.contents().clone();
    write_library(
        folder.path(),
        r#""size": { "to": ["n.size"] }, "sharp": { "to": ["n.sharpness"] }"#,
    );
    assert!(linked_groups::update(&mut document, "Worn"));
    let node = document.node(&id).expect("the instance").clone();
    assert_eq!(node.params.keys().collect::<Vec<_>>(), ["seed", "size"]);
    let group = &document.contents().groups["Worn"];
    assert!(group.graph.exposed().contains_key("sharp"));
    assert_ne!(group.library, before.groups["Worn"].library);
    assert_eq!(document.take_notices(), ["'Worn' has no jitter any more"]);
    history::undo(&mut document);
    assert_eq!(*document.contents(), before);
}

#[test]
fn an_unlinked_group_stays_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path(), TWO_KNOBS);
    let mut document = with_instance(folder.path());
    let before = document.contents().groups["Worn"].clone();
    assert!(linked_groups::unlink(&mut document, "Worn"));
    let after = &document.contents().groups["Worn"];
    assert_eq!((&after.graph, &after.library), (&before.graph, &None));
    assert!(!linked_groups::update(&mut document, "Worn"));
    assert_eq!(document.take_notices(), ["'Worn' is linked to no file of a library"]);
}

#[test]
fn all_updates_are_one_step_and_a_missing_file_does_not_block_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path(), TWO_KNOBS);
    let file = |name: &str| folder.path().join(format!("weathering/{name}.sabi"));
    let write = |name: &str, size: f64| {
        let node = format!(r#""n": {{ "kind": "noise/simplex", "params": {{ "size": {size} }} }}"#);
        let text = format!(
            r#"{{ "format": "sabi", "version": 1, "name": "{name}", "outputs": {{ "mask": "n" }}, "nodes": {{ {node} }} }}"#
        );
        fs::write(file(name), text).expect("a writable folder");
    };
    let mut document = with_instance(folder.path());
    for (name, size) in [("Dust", 0.1), ("Soot", 0.2)] {
        write(name, size);
        library::add(&mut document, &file(name), [0.0; 2], None).expect("an instance");
    }
    let before = document.contents().clone();
    let names = ["Dust", "Soot", "Worn"].map(str::to_owned);
    write_library(folder.path(), r#""size": { "to": ["n.size"] }"#);
    write("Dust", 0.3);
    fs::remove_file(file("Soot")).expect("a file");
    document.take_notices();
    assert!(linked_groups::update_all(&mut document, &names));
    assert_eq!(document.session.undo_names().last(), Some("Update from the library"));
    let is_updated = |document: &crate::OpenDocument, name: &str| {
        document.contents().groups[name].library != before.groups[name].library
    };
    assert_eq!(
        names.each_ref().map(|name| is_updated(&document, name)),
        [true, false, true]
    );
    assert_eq!(document.contents().groups["Soot"], before.groups["Soot"]);
    let notices = document.take_notices();
    assert!(notices.iter().any(|said| said.contains("Soot.sabi")), "{notices:?}");
    let done = "2 groups were updated; undo brings the versions before back.";
    assert!(notices.iter().any(|said| said == done), "{notices:?}");
    history::undo(&mut document);
    assert_eq!(*document.contents(), before);
}

#[test]
fn random_values_stay_in_their_ranges_and_kept_knobs_stay_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(
        folder.path(),
        r#""size": { "to": ["n.size"], "range": [0.05, 0.2] }, "jitter": { "to": ["n.jitter"] }"#,
    );
    let mut document = with_instance(folder.path());
    let id = document.selected_one().cloned().expect("the instance");
    let kept = std::iter::once("jitter".to_owned()).collect();
    let mut seen = Vec::new();
    for _ in 0..20 {
        assert!(crate::random_knobs::randomize(&mut document, &id, &kept));
        let params = &document.node(&id).expect("the instance").params;
        assert!(params.contains_key("seed") && !params.contains_key("jitter"));
        let size = params["size"].as_number().expect("a number");
        assert!((0.05..=0.2).contains(&size), "{size}");
        seen.push(size);
    }
    seen.sort_by(f64::total_cmp);
    seen.dedup();
    assert!(seen.len() > 10, "{seen:?}");
}

#[test]
fn a_file_that_uses_itself_is_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path(), TWO_KNOBS);
    let itself = r#"{ "format": "sabi", "version": 1, "outputs": { "mask": "i" },
        "nodes": { "i": { "kind": "graph/group", "group": "worn.sabi" } } }"#;
    fs::write(folder.path().join("weathering/grain.sabi"), itself).expect("a writable folder");
    let mut document = document_with(Session::new(None), 7);
    trust::trust_files(&mut document, &TrustedPaths::default().with_path(folder.path()));
    assert!(
        library::add(
            &mut document,
            &folder.path().join("weathering/worn.sabi"),
            [0.0; 2],
            None
        )
        .is_none()
    );
    let notices = document.take_notices();
    assert!(
        notices[0].ends_with("worn.sabi uses itself as a group; take that instance out"),
        "{notices:?}"
    );
    assert_eq!(document.contents().groups.len(), 0);
}
