//! A save checks the file first and keeps a backup of what it replaces; windows notice each other's open files.

use super::*;
use crate::remedy::Remedy;

/// A session of a saved graph that was edited since, and its file.
fn edited(desk: &TempDir) -> (Session, PathBuf) {
    let file = desk.path().join("a.sabi");
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    session.edit("Gain", set_gain(0.25)).unwrap();
    (session, file)
}

#[test]
fn a_save_refuses_to_replace_what_another_program_wrote_meanwhile() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    // The length is the same, and no event has informed the session.
    let theirs = fs::read_to_string(&file).unwrap().replace("simplex", "billows");
    fs::write(&file, &theirs).unwrap();
    let error = session.save().unwrap_err();
    let told = format!(
        "{} was written by another program since it was opened or saved here; replace the file, or save under another \
         name",
        file.display()
    );
    assert_eq!(error.to_string(), told);
    assert!(error.remedies.contains(&Remedy::ReplaceFile));
    assert_eq!(fs::read_to_string(&file).unwrap(), theirs);
    assert!(session.is_dirty());
    session.save_as(&file).unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), session.text());
    assert_eq!(fs::read_to_string(desk.path().join("a.sabi.bak")).unwrap(), theirs);
    session.edit("Gain", set_gain(0.5)).unwrap();
    session.save().unwrap();
}

#[test]
fn what_was_accepted_is_replaced_and_what_comes_after_it_is_not() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    fs::write(&file, "theirs").unwrap();
    session.graph_file.keep_document();
    assert_eq!(session.graph_file.check(), FileState::Same, "it was answered");
    assert!(session.is_dirty());
    fs::write(&file, "theirs, later").unwrap();
    assert_eq!(session.graph_file.check(), FileState::Another);
    session.save().unwrap_err();
    session.graph_file.keep_document();
    session.save().unwrap();
    assert!(!session.is_dirty());
}

#[test]
fn what_another_program_wrote_can_be_kept_beside() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    for (theirs, name) in [("one", "a-theirs.sabi"), ("two", "a-theirs-2.sabi")] {
        fs::write(&file, theirs).unwrap();
        let copy = session.save_beside_theirs().unwrap();
        assert_eq!(copy, Some(desk.path().join(name)));
        assert_eq!(fs::read_to_string(desk.path().join(name)).unwrap(), theirs);
        assert_eq!(fs::read_to_string(&file).unwrap(), session.text());
    }
    session.edit("Gain", set_gain(0.5)).unwrap();
    assert_eq!(
        session.save_beside_theirs().unwrap(),
        None,
        "there is nothing of theirs"
    );
}

#[test]
fn the_last_three_files_are_kept_the_latest_first() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    let backup = |number: &str| fs::read_to_string(desk.path().join(format!("a.sabi.bak{number}"))).ok();
    let mut written = vec![fs::read_to_string(&file).unwrap()];
    for gain in [0.1, 0.2, 0.3, 0.4, 0.5] {
        session.edit("Gain", set_gain(gain)).unwrap();
        session.save().unwrap();
        written.push(session.text().to_owned());
    }
    written.reverse();
    assert_eq!(fs::read_to_string(&file).unwrap(), written[0]);
    for (number, text) in ["", "2", "3"].into_iter().zip(&written[1..]) {
        assert_eq!(backup(number).as_ref(), Some(text), "{number}");
    }
    assert_eq!(backup("4"), None);
    // A save that changes nothing makes no backup.
    session.save().unwrap();
    assert_eq!(backup("3").as_ref(), Some(&written[3]));
    session.graph_file.set_backups(1);
    session.edit("Gain", set_gain(0.6)).unwrap();
    session.save().unwrap();
    assert_eq!(backup("").as_ref(), Some(&written[0]));
    assert_eq!(backup("2").as_ref(), Some(&written[2]), "those that are there stay");
    session.graph_file.set_backups(0);
    session.edit("Gain", set_gain(0.7)).unwrap();
    session.save().unwrap();
    assert_eq!(backup("").as_ref(), Some(&written[0]));
}

#[test]
fn a_backup_has_the_date_at_which_it_was_written() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    let long_ago = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let open = fs::File::options().append(true).open(&file).unwrap();
    open.set_modified(long_ago).unwrap();
    session.save().unwrap();
    let backup = fs::metadata(desk.path().join("a.sabi.bak")).unwrap();
    assert_eq!(backup.modified().unwrap(), long_ago);
}

#[cfg(unix)]
#[test]
fn a_backup_of_a_private_file_is_private() {
    use std::os::unix::fs::PermissionsExt;
    let desk = desk();
    let (mut session, file) = edited(&desk);
    fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
    for gain in [0.3, 0.4] {
        session.edit("Gain", set_gain(gain)).unwrap();
        session.save().unwrap();
    }
    for name in ["a.sabi", "a.sabi.bak", "a.sabi.bak2"] {
        let mode = fs::metadata(desk.path().join(name)).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600, "{name}");
    }
}

#[test]
fn a_file_that_cannot_be_kept_as_a_backup_is_not_replaced() {
    let desk = desk();
    let file = desk.path().join("huge.sabi");
    fs::File::create(&file).unwrap().set_len((1 << 30) + 1).unwrap();
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    let told = format!(
        "{} is not replaced, since what it holds cannot be kept as a backup: it has 1024 MiB; save under another name",
        file.display()
    );
    assert_eq!(session.save_as(&file).unwrap_err().to_string(), told);
    assert_eq!(fs::metadata(&file).unwrap().len(), (1 << 30) + 1);
}

#[test]
fn a_recovered_graph_does_not_replace_what_was_saved_since_without_a_question() {
    let desk = desk();
    let (file, kept) = (desk.path().join("a.sabi"), desk.path().join("kept"));
    let mut session = Session::new(Some(&kept));
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    session.edit("Gain", set_gain(0.25)).unwrap();
    session.keep(&[]).unwrap();
    drop(session);
    let before = fs::read(&file).unwrap();
    assert!(!recoveries(&kept)[0].is_file_changed());
    fs::write(&file, "theirs").unwrap();
    let recovery = recoveries(&kept).remove(0);
    assert!(recovery.is_file_changed());
    let mut session = Session::recover(recovery).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Another);
    session.save().unwrap_err();
    assert_eq!(fs::read_to_string(&file).unwrap(), "theirs");
    fs::write(&file, &before).unwrap();
    assert_eq!(session.graph_file.check(), FileState::Same);
    session.save().unwrap();
}

#[test]
fn a_file_is_open_in_one_window_until_that_ends_in_any_way() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    assert!(!is_open_in_a_window(&file));
    assert!(session.graph_file.claim() && session.graph_file.claim());
    assert!(is_open_in_a_window(&file));
    let mut second = Session::open(&file, None).unwrap();
    assert!(!second.graph_file.claim());
    // The lock file of a killed program has no effect.
    session.save().unwrap();
    session.close();
    fs::write(desk.path().join(".a.sabi.lock"), "").unwrap();
    assert!(!is_open_in_a_window(&file));
    assert!(second.graph_file.claim());
    let other = desk.path().join("b.sabi");
    second.save_as(&other).unwrap();
    assert!(is_open_in_a_window(&other) && !is_open_in_a_window(&file));
    drop(second);
    assert!(!is_open_in_a_window(&other));
    let left: Vec<_> = fs::read_dir(desk.path())
        .unwrap()
        .flatten()
        .map(|entry| entry.file_name())
        .collect();
    assert!(
        !left.iter().any(|name| name.to_string_lossy().contains("lock")),
        "{left:?}"
    );
}

#[test]
fn a_graph_that_is_open_for_reading_alone_is_saved_under_another_name() {
    let desk = desk();
    let (mut session, file) = edited(&desk);
    let before = fs::read(&file).unwrap();
    session.graph_file.set_read_only(true);
    let told = format!(
        "{} is open in another window, and here for reading alone; save under another name",
        file.display()
    );
    assert_eq!(session.save().unwrap_err().to_string(), told);
    assert_eq!(fs::read(&file).unwrap(), before);
    session.save_as(&desk.path().join("b.sabi")).unwrap();
    assert!(!session.graph_file.is_read_only());
    session.edit("Gain", set_gain(0.5)).unwrap();
    session.save().unwrap();
}
