//! Sessions with files, and recovery of their work.

mod brush_pictures;
mod faults;
mod killed;
mod looking_first;
mod outside;
#[cfg(unix)]
mod stroke_links;
mod strokes;

use std::collections::BTreeMap;
use std::fs;

use sabi_graph::{Body, Node, Value};
use tempfile::TempDir;

use super::edits::RECENT_EDITS;
use super::*;

fn add(id: &str) -> Edit {
    Edit::AddNode {
        body: Body::Main,
        id: id.parse().unwrap(),
        node: Node::new("noise/simplex"),
        inputs: BTreeMap::new(),
    }
}

fn set_gain(value: f32) -> Edit {
    Edit::SetParam {
        body: Body::Main,
        node: "a".parse().unwrap(),
        param: "gain".to_owned(),
        value: Some(Value::Number(f64::from(value))),
    }
}

fn desk() -> TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn a_session_is_dirty_exactly_while_its_file_holds_something_else() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    assert!(!session.is_dirty());
    assert!(session.save().is_err(), "it has no file yet");
    session.edit("Add", add("a")).unwrap();
    assert!(session.is_dirty());
    session.save_as(&file).unwrap();
    assert!(!session.is_dirty());
    assert_eq!(fs::read_to_string(&file).unwrap(), session.text());
    session.undo().unwrap();
    assert!(session.is_dirty());
    session.redo().unwrap();
    assert!(!session.is_dirty(), "undo goes on past a save");
    let mut again = Session::open(&file, None).unwrap();
    assert!(!again.is_dirty());
    assert_eq!(again.text(), session.text());
}

#[test]
fn the_edits_since_a_revision_are_known_until_the_document_changes_otherwise() {
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    let known = session.revision();
    assert_eq!(session.edits_since(known), Some(&[][..]));
    session.edit("Gain", set_gain(0.25)).unwrap();
    session.edit("Gain", set_gain(0.5)).unwrap();
    assert_eq!(session.edits_since(known), Some(&[set_gain(0.25), set_gain(0.5)][..]));
    assert_eq!(session.edits_since(known + 9), None, "of another session");
    session.undo().unwrap();
    assert_eq!(session.edits_since(known), None);
    let known = session.revision();
    for edit in 0..2 * RECENT_EDITS {
        session.edit("Gain", set_gain(edit as f32)).unwrap();
    }
    assert_eq!(session.edits_since(known), None, "long ago");
    assert_eq!(session.edits_since(session.revision() - 1).unwrap().len(), 1);
}

#[test]
fn a_drag_is_compared_with_the_file_once_it_ends() {
    let desk = desk();
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&desk.path().join("a.sabi")).unwrap();
    let saved = session.text.revision;
    session.begin("Gain");
    assert!(!session.is_dirty());
    session.edit("Gain", set_gain(0.25)).unwrap();
    assert!(session.is_dirty());
    assert_eq!(session.text.revision, saved, "no text is made while it lasts");
    session.cancel().unwrap();
    assert!(!session.is_dirty());
}

#[test]
fn saving_keeps_the_file_before() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    let first = fs::read_to_string(&file).unwrap();
    session.save().unwrap();
    assert!(!desk.path().join("a.sabi.bak").exists(), "nothing changed");
    session.edit("Add", add("b")).unwrap();
    session.save().unwrap();
    assert_eq!(fs::read_to_string(desk.path().join("a.sabi.bak")).unwrap(), first);
    let names = fs::read_dir(desk.path()).unwrap().count();
    assert_eq!(names, 2, "no temporary file is left");
}

#[test]
fn a_file_that_cannot_be_written_is_told_and_nothing_is_lost() {
    let desk = desk();
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    fs::create_dir(desk.path().join("folder.sabi")).unwrap();
    for path in [desk.path().join("folder.sabi"), PathBuf::from("/")] {
        let error = session.save_as(&path).unwrap_err();
        assert_eq!(error.kind, ErrorKind::CannotWrite, "{error}");
    }
    assert!(session.is_dirty() && session.file().is_none());
}

#[test]
fn what_was_not_saved_comes_back_after_the_program_ended() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let kept = desk.path().join("kept");
    let mut session = Session::new(Some(&kept));
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    assert!(!session.keep(&[]).unwrap(), "all is saved");
    session.edit("Gain", set_gain(0.25)).unwrap();
    assert!(session.keep(&[]).unwrap());
    assert!(!session.keep(&[]).unwrap(), "nothing changed since");
    let text = session.text().to_owned();
    assert!(recoveries(&kept).is_empty(), "its program still runs");
    // This is the state that another program finds when this program is killed.
    drop(session);
    let mut left = fs::read_dir(&kept).unwrap().map(|entry| entry.unwrap().path());
    let left = left.find(|path| path.extension().is_some_and(|ending| ending == "recovery"));
    fs::rename(left.unwrap(), kept.join("4000000000-1-0.recovery")).unwrap();
    let mut found = recoveries(&kept);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].file(), Some(file.as_path()));
    let mut session = Session::recover(found.remove(0)).unwrap();
    assert!(session.is_dirty());
    assert_eq!(session.text(), text);
    session.save().unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), text);
    assert!(recoveries(&kept).is_empty(), "once saved there is nothing to recover");
}

#[test]
fn a_session_that_ends_in_order_leaves_nothing() {
    let desk = desk();
    let mut session = Session::new(Some(desk.path()));
    session.edit("Add", add("a")).unwrap();
    assert!(session.keep(&[]).unwrap());
    session.close();
    assert_eq!(fs::read_dir(desk.path()).unwrap().count(), 0);
}

#[test]
fn node_files_that_were_being_written_come_back_too_and_keep_a_saved_graph_with_them() {
    let desk = desk();
    let kept = desk.path().join("kept");
    let draft = |known: Option<&str>| NodeDraft {
        folder: desk.path().join("nodes"),
        id: "own/rust".to_owned(),
        text: "//! Rust".to_owned(),
        known: known.map(str::to_owned),
    };
    let drafts = [draft(None), draft(Some("//! As it was"))];
    let mut session = Session::new(Some(&kept));
    assert!(session.keep(&drafts).unwrap(), "though the graph is as it began");
    assert!(!session.keep(&drafts).unwrap(), "nothing changed since");
    assert!(session.keep(&drafts[..1]).unwrap());
    assert!(session.keep(&drafts).unwrap());
    drop(session);
    let mut found = recoveries(&kept);
    assert_eq!(found.len(), 1);
    let recovery = found.remove(0);
    assert_eq!(recovery.drafts(), drafts);
    assert!(!recovery.has_graph());
    let mut session = Session::recover(recovery).unwrap();
    assert!(!session.is_dirty());
    assert!(!session.keep(&drafts).unwrap(), "it is kept as it was");
    session.keep(&[]).unwrap();
    drop(session);
    assert!(recoveries(&kept).is_empty(), "once they are saved nothing is left");
}

#[test]
fn node_files_come_back_to_the_graph_as_it_was_saved_since() {
    let desk = desk();
    let (file, kept) = (desk.path().join("a.sabi"), desk.path().join("kept"));
    let mut session = Session::new(Some(&kept));
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    let draft = NodeDraft {
        folder: "nodes".into(),
        id: "own/rust".to_owned(),
        text: "//! Rust".to_owned(),
        known: None,
    };
    assert!(session.keep(&[draft]).unwrap());
    drop(session);
    let mut later = Session::open(&file, None).unwrap();
    later.edit("Add", add("b")).unwrap();
    later.save().unwrap();
    let recovery = recoveries(&kept).remove(0);
    assert!(
        recovery.drafts()[0].folder.is_absolute(),
        "it may be read from another folder"
    );
    let mut session = Session::recover(recovery).unwrap();
    assert!(!session.is_dirty());
    assert_eq!(session.text(), later.text(), "and not as it was when the program ended");
}

#[test]
fn leftovers_that_cannot_be_read_are_told_until_they_are_let_go() {
    let desk = desk();
    let wild = [
        ("1-1-1", "half of", "expected value"),
        ("4000000000-1-1", "{}", "it holds no graph"),
        (
            "2-1-1",
            r#"{ "graph": "", "drafts": [{}] }"#,
            "a node in it has no text",
        ),
    ];
    for (name, text, _) in wild {
        fs::write(desk.path().join(name).with_extension("recovery"), text).unwrap();
    }
    fs::write(desk.path().join("other.txt"), "{}").unwrap();
    let mut found = recoveries(desk.path());
    assert_eq!(found.len(), wild.len());
    for (name, _, why) in wild {
        let told = found.iter().filter_map(|recovery| Some(recovery.fault()?.to_string()));
        let mut told = told.filter(|told| told.contains(name));
        let told = told.next().expect("a sentence for it");
        assert!(
            told.contains("the recovery file cannot be read") && told.contains(why),
            "{told}"
        );
    }
    found.iter_mut().for_each(Recovery::forget);
    assert!(recoveries(desk.path()).is_empty());
    assert!(recoveries(&desk.path().join("none")).is_empty());
}

#[test]
fn a_drag_is_one_step() {
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    let before = session.text().to_owned();
    session.begin("Gain");
    for step in 0..100u8 {
        session.edit("ignored", set_gain(f32::from(step) / 100.0)).unwrap();
    }
    session.end();
    assert_eq!(session.undo_names().collect::<Vec<_>>(), ["Add", "Gain"]);
    assert_eq!(session.undo().unwrap().as_deref(), Some("Gain"));
    assert_eq!(session.text(), before);
}

fn image(id: &str, file: &str) -> Edit {
    let mut node = Node::new("source/image");
    node.params.insert("file".to_owned(), Value::from(file));
    Edit::AddNode {
        body: Body::Main,
        id: id.parse().unwrap(),
        node,
        inputs: BTreeMap::new(),
    }
}

/// Returns the picture that a node names, as a path on the disk.
fn picture(session: &Session, id: &str) -> PathBuf {
    let path = session.document().graph.node(id).unwrap().params["file"]
        .as_text()
        .unwrap();
    session.graph().folder().join(path).canonicalize().unwrap()
}

#[test]
fn a_graph_saved_to_another_folder_names_the_same_files_before_and_after_undo() {
    let desk = desk();
    fs::create_dir_all(desk.path().join("deep/er")).unwrap();
    let [one, other] = ["one.png", "other.png"].map(|name| {
        fs::write(desk.path().join(name), name).unwrap();
        desk.path().join(name).canonicalize().unwrap()
    });
    let mut session = Session::new(None);
    session.save_as(&desk.path().join("a.sabi")).unwrap();
    session.edit("Add", image("a", "one.png")).unwrap();
    session
        .edit(
            "Remove",
            Edit::RemoveNode {
                body: Body::Main,
                id: "a".parse().unwrap(),
            },
        )
        .unwrap();
    session.edit("Add", image("b", "other.png")).unwrap();
    let steps: Vec<String> = session.undo_names().map(str::to_owned).collect();
    let revision = session.revision();
    session.save_as(&desk.path().join("deep/er/b.sabi")).unwrap();
    assert!(!session.is_dirty());
    assert!(
        session.revision() > revision,
        "what follows from the document is made again"
    );
    assert_eq!(session.undo_names().collect::<Vec<_>>(), steps, "saving is no step");
    assert_eq!(
        session.document().graph.node("b").unwrap().params["file"].as_text(),
        Some("../../other.png")
    );
    assert_eq!(
        fs::read_to_string(desk.path().join("deep/er/b.sabi")).unwrap(),
        session.text()
    );
    assert_eq!(picture(&session, "b"), other);
    session.undo().unwrap();
    session.undo().unwrap();
    assert_eq!(picture(&session, "a"), one);
    session.redo().unwrap();
    session.redo().unwrap();
    assert!(!session.is_dirty(), "the same bytes as were saved");
    session.save_as(&desk.path().join("a.sabi")).unwrap();
    assert_eq!(
        session.document().graph.node("b").unwrap().params["file"].as_text(),
        Some("other.png")
    );
}

#[test]
fn a_graph_that_could_not_be_saved_elsewhere_keeps_its_paths() {
    let desk = desk();
    let mut session = Session::new(None);
    session.save_as(&desk.path().join("a.sabi")).unwrap();
    session.edit("Add", image("a", "one.png")).unwrap();
    let before = session.text().to_owned();
    fs::create_dir_all(desk.path().join("deep/b.sabi")).unwrap();
    session.save_as(&desk.path().join("deep/b.sabi")).unwrap_err();
    assert_eq!(session.text(), before);
    assert_eq!(session.file(), Some(desk.path().join("a.sabi").as_path()));
}

#[test]
fn an_edit_that_changes_nothing_is_no_step() {
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.edit("Gain", set_gain(0.5)).unwrap();
    session.undo().unwrap();
    session.edit("Gain", Edit::SetSeed { seed: 0 }).unwrap();
    assert_eq!(session.undo_names().count(), 1);
    assert_eq!(session.redo_names().count(), 1, "what was undone is still there");
}
