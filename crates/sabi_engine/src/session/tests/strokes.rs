//! Strokes of a session: beside its file, beside its recovery file, and beside the file to which it is saved.

use std::sync::Arc;

use glam::DVec3;
use sabi_paint::{Brush, Stroke, StrokePoint};
use sabi_surface::patch::Site;

use super::*;

const MODEL: &str = "crate";

pub(super) fn stroke() -> sabi_paint::Step {
    pressed(1.0)
}

fn pressed(pressure: f32) -> sabi_paint::Step {
    let point = StrokePoint {
        site: Site {
            triangle: 0,
            position: DVec3::ZERO,
        },
        normal: [0.0, 0.0, 1.0],
        triangle_key: 1,
        pressure,
        starts: true,
        shaft: None,
    };
    sabi_paint::Step::Add(Arc::new(Stroke::new(Brush::default(), vec![point])))
}

/// Adds the node `p` if it is missing.
pub(super) fn add_node(session: &mut Session) {
    if session.document().graph.node("p").is_none() {
        let edit = Edit::AddNode {
            body: Body::Main,
            id: "p".parse().unwrap(),
            node: Node::new("source/paint"),
            inputs: BTreeMap::new(),
        };
        session.edit("Add", edit).unwrap();
    }
}

/// Paints a stroke on the node `p`, which is added if it is missing.
pub(super) fn paint(session: &mut Session) {
    add_node(session);
    let open = session.graph();
    let versions = open.strokes.after(&open.path, MODEL, &versions(session), &stroke());
    name(session, versions);
    session.keep_strokes().unwrap();
}

/// Makes the node `p` name versions of strokes.
pub(super) fn name(session: &mut Session, versions: String) {
    let edit = Edit::SetParam {
        body: Body::Main,
        node: "p".parse().unwrap(),
        param: "strokes".to_owned(),
        value: Some(Value::Text(versions)),
    };
    session.edit("Stroke", edit).unwrap();
}

/// Returns a session of a file `a.sabi` with this many painted strokes, and the file.
pub(super) fn painted(desk: &TempDir, strokes: usize) -> (Session, std::path::PathBuf) {
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.save_as(&file).unwrap();
    for _ in 0..strokes {
        paint(&mut session);
    }
    session.save().unwrap();
    (session, file)
}

pub(super) fn versions(session: &Session) -> String {
    let node = session.document().graph.node("p").unwrap();
    match node.params.get("strokes") {
        Some(Value::Text(versions)) => versions.clone(),
        _ => String::new(),
    }
}

/// Returns the number of strokes of its node that a session knows.
pub(super) fn known(session: &Session) -> usize {
    let open = session.graph();
    let list = open.strokes.on_model(&open.path, MODEL, &versions(session));
    list.map_or(0, |list| list.strokes.len())
}

#[test]
fn strokes_are_stored_beside_the_file_and_found_again() {
    let desk = desk();
    let (mut session, file) = painted(&desk, 2);
    assert_eq!(known(&Session::open(&file, None).unwrap()), 2);
    let stored = fs::metadata(desk.path().join("a.paint/crate.strokes")).unwrap().len();
    session.undo().unwrap();
    session.redo().unwrap();
    session.save().unwrap();
    let again = fs::metadata(desk.path().join("a.paint/crate.strokes")).unwrap().len();
    assert_eq!(stored, again, "what is stored is not stored again");
}

#[test]
fn strokes_of_a_graph_without_a_file_survive_a_crash() {
    let (desk, keep) = (desk(), desk());
    let mut session = Session::new(Some(keep.path()));
    paint(&mut session);
    session.keep(&[]).unwrap();
    drop(session);
    let recovery = recoveries(keep.path()).remove(0);
    let mut session = Session::recover(recovery).unwrap();
    assert_eq!(known(&session), 1);
    let file = desk.path().join("b.sabi");
    session.save_as(&file).unwrap();
    assert_eq!(known(&Session::open(&file, None).unwrap()), 1);
    session.close();
    let left: Vec<_> = fs::read_dir(keep.path()).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn a_graph_that_is_saved_elsewhere_takes_its_strokes_along() {
    let desk = desk();
    let (_, file) = painted(&desk, 1);
    let other = desk.path().join("other");
    fs::create_dir(&other).unwrap();
    let mut opened = Session::open(&file, None).unwrap();
    opened.save_as(&other.join("c.sabi")).unwrap();
    assert_eq!(known(&Session::open(&other.join("c.sabi"), None).unwrap()), 1);
}

#[test]
fn a_damaged_stroke_file_is_not_written_to_and_the_sentence_says_what_to_do() {
    let desk = desk();
    let (_, file) = painted(&desk, 1);
    let strokes = desk.path().join("a.paint/crate.strokes");
    let mut bytes = fs::read(&strokes).unwrap();
    let whole = bytes.clone();
    bytes.truncate(bytes.len() - 5);
    fs::write(&strokes, &bytes).unwrap();
    let mut again = Session::open(&file, None).unwrap();
    assert_eq!(known(&again), 0);
    let open = again.graph();
    let versions = open.strokes.after(&open.path, MODEL, "", &stroke());
    name(&mut again, versions);
    let refused = again.keep_strokes().unwrap_err().to_string();
    assert!(
        refused.contains("is damaged") && refused.contains("move the file away"),
        "{refused}"
    );
    assert_eq!(fs::read(&strokes).unwrap(), bytes);
    // Once the complete file is back, everything is appended to it.
    fs::write(&strokes, &whole).unwrap();
    again.keep_strokes().unwrap();
    assert!(fs::read(&strokes).unwrap().starts_with(&whole));
}

#[test]
fn what_is_left_of_a_damaged_file_is_still_painted() {
    let desk = desk();
    let (_, file) = painted(&desk, 3);
    let strokes = desk.path().join("a.paint/crate.strokes");
    let mut bytes = fs::read(&strokes).unwrap();
    bytes.truncate(bytes.len() - 5);
    fs::write(&strokes, &bytes).unwrap();
    let again = Session::open(&file, None).unwrap();
    assert_eq!(known(&again), 2, "only the last stroke is cut off");
}

#[test]
fn parts_of_a_stroke_that_is_drawn_are_forgotten_after_a_while_and_kept_strokes_are_not() {
    let session = Session::new(None);
    let open = session.graph();
    let drawn = |pressure| open.strokes.after(&open.path, MODEL, "", &pressed(pressure));
    let is_known = |versions: &str| open.strokes.on_model(&open.path, MODEL, versions).is_some();
    let part = drawn(0.25);
    let next = drawn(0.3);
    assert!(is_known(&part) && is_known(&next), "an evaluation may still ask for it");
    for step in 0..300 {
        drawn(0.3 + 0.0005 * step as f32);
    }
    let whole = drawn(0.5);
    assert!(!is_known(&part) && is_known(&whole));
    open.strokes.settle();
    let other = drawn(0.75);
    assert!(is_known(&whole) && is_known(&other));
}

#[test]
fn strokes_drawn_while_their_file_was_away_count_when_it_comes_back() {
    let desk = desk();
    let (_, file) = painted(&desk, 1);
    let (strokes, away) = (desk.path().join("a.paint/crate.strokes"), desk.path().join("away"));
    fs::rename(&strokes, &away).unwrap();
    let mut again = Session::open(&file, None).unwrap();
    assert_eq!(known(&again), 0);
    let open = again.graph();
    let drawn = open.strokes.after(&open.path, MODEL, &versions(&again), &pressed(0.5));
    name(&mut again, drawn.clone());
    fs::rename(&away, &strokes).unwrap();
    again.save().unwrap();
    let opened = Session::open(&file, None).unwrap();
    let open = opened.graph();
    let list = open.strokes.on_model(&open.path, MODEL, &drawn).unwrap();
    assert_eq!(list.strokes.len(), 1);
    let pressure = list.strokes[0].points[0].pressure;
    assert!((pressure - 0.5).abs() < 0.01, "{pressure}");
    assert!(
        versions(&opened).starts_with(&drawn),
        "and the stroke of before is still named"
    );
}

#[test]
fn flattened_strokes_keep_what_is_there_and_lose_what_was_taken_away() {
    let desk = tempfile::tempdir().unwrap();
    let (mut session, file) = painted(&desk, 3);
    let open = session.graph();
    let list = open.strokes.on_model(&file, MODEL, &versions(&session)).unwrap();
    open.strokes.settle();
    let removed = sabi_paint::Step::Remove(vec![list.strokes[0].id, list.strokes[2].id]);
    let after = open.strokes.after(&file, MODEL, &versions(&session), &removed);
    name(&mut session, after);
    session.save().unwrap();
    let size = || {
        std::fs::metadata(desk.path().join("a.paint/crate.strokes"))
            .unwrap()
            .len()
    };
    let before = size();
    let trial = crate::stroke_maintenance::flatten_strokes(&file, true).unwrap();
    assert_eq!(size(), before);
    let report = crate::stroke_maintenance::flatten_strokes(&file, false).unwrap();
    assert_eq!(report, trial);
    let written = &report.files[0];
    assert_eq!(
        (written.strokes, written.bytes_before, written.bytes),
        (1, before, size())
    );
    assert!(2 * written.bytes < before, "{written:?}");
    let session = Session::open(&file, None).unwrap();
    let open = session.graph();
    let kept = open.strokes.on_model(&file, MODEL, &versions(&session)).unwrap();
    assert_eq!(kept.strokes.len(), 1);
    assert_eq!(kept.strokes[0].points, list.strokes[1].points);
    assert!(desk.path().join("a.paint/crate.strokes.bak").is_file());
}

#[test]
fn models_whose_names_differ_by_case_alone_have_files_that_every_disk_tells_apart() {
    let desk = desk();
    let graph = desk.path().join("a.sabi");
    let strokes = crate::source::Strokes::default();
    let first = strokes.after(&graph, "crate", "", &stroke());
    strokes.settle();
    let both = strokes.after(&graph, "Crate", &first, &pressed(0.5));
    strokes.store(&graph, &both).unwrap();
    let names = || -> std::collections::BTreeSet<String> {
        let files = fs::read_dir(desk.path().join("a.paint")).unwrap();
        files
            .map(|file| file.unwrap().file_name().to_string_lossy().to_lowercase())
            .collect()
    };
    assert_eq!(names().len(), 2, "{:?}", names());
    let again = crate::source::Strokes::default();
    for model in ["crate", "Crate"] {
        let list = again.on_model(&graph, model, &both).unwrap();
        assert_eq!(list.strokes.len(), 1, "{model}");
    }
    // A further stroke is stored in the existing file of the model.
    let more = again.after(&graph, "Crate", &both, &pressed(0.25));
    again.store(&graph, &more).unwrap();
    assert_eq!(names().len(), 2, "{:?}", names());
    let list = crate::source::Strokes::default().on_model(&graph, "Crate", &more);
    assert_eq!(list.unwrap().strokes.len(), 2);
}
