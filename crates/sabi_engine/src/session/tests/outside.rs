//! Changes of a session's file by other programs, and properties of the file that a save preserves.

use super::*;

#[test]
fn what_another_program_wrote_is_seen_and_taken_as_a_step() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    assert_eq!(session.graph_file.check(), FileState::Same, "there is none");
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Same);
    session.edit("Turn", set_gain(0.25)).unwrap();
    let ours = session.text().to_owned();
    assert_eq!(
        session.graph_file.check(),
        FileState::Same,
        "what is not saved is not in the file"
    );
    // As another program lays it out.
    let theirs = session
        .graph_file
        .saved()
        .replace("noise/simplex", "noise/white")
        .replace("  ", "\t");
    fs::write(&file, &theirs).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Another);
    let revision = session.revision();
    session.reload().unwrap();
    assert_eq!(session.document().graph.node("a").unwrap().kind, "noise/white");
    assert!(session.revision() > revision);
    assert!(!session.is_dirty());
    assert_eq!(session.graph_file.check(), FileState::Same);
    assert_eq!(session.undo().unwrap().as_deref(), Some("Reload the file"));
    assert_eq!(session.text(), ours, "nothing was lost");
    assert!(session.is_dirty());
}

#[test]
fn a_file_that_cannot_be_read_any_more_changes_nothing() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    let ours = session.text().to_owned();
    fs::write(&file, "{ \"format\": ").unwrap();
    assert_eq!(session.graph_file.check(), FileState::Another);
    assert!(session.reload().is_err());
    fs::remove_file(&file).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Gone);
    assert!(session.reload().is_err());
    assert_eq!(session.text(), ours);
    session.save().unwrap();
    assert_eq!(session.graph_file.check(), FileState::Same);
}

#[test]
fn what_is_kept_against_its_file_or_has_lost_it_is_unsaved() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    let ours = fs::read_to_string(&file).unwrap();
    let theirs = ours.replace("noise/simplex", "noise/white");
    fs::write(&file, &theirs).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Another);
    assert!(!session.is_dirty(), "nothing was said of it yet");
    session.graph_file.keep_document();
    assert!(session.is_dirty());
    session.save().unwrap();
    assert!(!session.is_dirty());
    fs::remove_file(&file).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Gone);
    assert!(session.is_dirty());
    fs::write(&file, &ours).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Same);
    assert!(!session.is_dirty(), "it is back");
}

#[test]
fn a_file_that_is_write_protected_is_not_replaced() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.save_as(&file).unwrap();
    let before = fs::read(&file).unwrap();
    let mut permissions = fs::metadata(&file).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).unwrap();
    session.edit("Add", add("a")).unwrap();
    let why = session.save().unwrap_err().to_string();
    let told = format!(
        "{} is write-protected; allow writing to it, or save under another name",
        file.display()
    );
    assert_eq!(why, told);
    assert_eq!(fs::read(&file).unwrap(), before);
    assert!(session.is_dirty());
}

#[cfg(unix)]
#[test]
fn a_link_stays_one_and_who_may_read_a_file_stays_too() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let desk = desk();
    let [file, link] = ["real/a.sabi", "a.sabi"].map(|name| desk.path().join(name));
    fs::create_dir_all(desk.path().join("real")).unwrap();
    let mut session = Session::new(None);
    session.save_as(&file).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&file, &link).unwrap();
    let mut session = Session::open(&link, None).unwrap();
    session.edit("Add", add("a")).unwrap();
    session.save().unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&file).unwrap(), session.text());
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    assert!(desk.path().join("real/a.sabi.bak").is_file());
    // All other files that are kept are written in the same way.
    sabi_files::write_whole(&link, b"whole").unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&file).unwrap(), b"whole");
}
