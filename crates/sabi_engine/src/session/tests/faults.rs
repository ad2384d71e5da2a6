//! Every fault of the disk at every step of a save and of an autosave: no file is incomplete, and nothing that was reported
//! as saved is lost.

use std::io::ErrorKind;

use sabi_files::Disk;

use super::strokes::{known, paint};
use super::*;

/// Folders of a session: that of its graph, and that of recovery files.
struct Place {
    desk: TempDir,
    kept: TempDir,
}

impl Place {
    fn new() -> Place {
        Place {
            desk: desk(),
            kept: desk(),
        }
    }

    fn file(&self) -> PathBuf {
        self.desk.path().join("new/a.sabi")
    }

    /// Returns a session whose file has an earlier state of the graph than its recovery file, which has the current one.
    fn edited(&self) -> Session {
        let mut session = Session::new(Some(self.kept.path()));
        session.edit("Add", add("a")).unwrap();
        session.save_as(&self.file()).unwrap();
        session.edit("Gain", set_gain(0.25)).unwrap();
        session.keep(&[]).unwrap();
        session
    }

    /// Returns the text and the number of known strokes that the program finds after it has ended abnormally.
    fn recovered(&self) -> Option<(String, usize)> {
        let recovery = recoveries(self.kept.path()).pop()?;
        let mut session = Session::recover(recovery).unwrap();
        Some((session.text().to_owned(), strokes_of(&session)))
    }

    fn saved(&self) -> Option<(String, usize)> {
        let mut session = Session::open(&self.file(), None).ok()?;
        Some((session.text().to_owned(), strokes_of(&session)))
    }
}

/// Number of strokes of the paint node, if there is one.
fn strokes_of(session: &Session) -> usize {
    match session.document().graph.node("p") {
        Some(_) => known(session),
        None => 0,
    }
}

/// Ends a session as a crash does.
fn crash(session: Session) {
    drop(session);
}

#[test]
fn a_save_leaves_the_old_graph_or_the_new_one_and_removes_the_copy_after_that_alone() {
    let steps = {
        let place = Place::new();
        let disk = Disk::counting();
        place.edited().on_disk(&disk).save().unwrap();
        assert_eq!(disk.at_risk(), Vec::<PathBuf>::new());
        disk.steps()
    };
    for (disk, told) in Disk::each_fault(steps) {
        let place = Place::new();
        let mut session = place.edited().on_disk(&disk);
        let (old, new) = (session.graph_file.saved().to_owned(), session.text().to_owned());
        let is_told = session.save().is_ok();
        crash(session);
        let saved = fs::read_to_string(place.file()).unwrap();
        assert!(saved == new || saved == old, "{told}");
        let recovered = place.recovered().map(|(text, _)| text);
        assert!(
            saved == new || recovered == Some(new.clone()),
            "{told}: the change is lost"
        );
        if is_told {
            assert_eq!(saved, new, "{told}");
            assert_eq!(disk.at_risk(), Vec::<PathBuf>::new(), "{told}");
        } else {
            assert_eq!(recovered, Some(new), "{told}: what was not told as saved is still kept");
        }
        if saved != old {
            let backup = fs::read_to_string(place.file().with_extension("sabi.bak"));
            assert_eq!(backup.ok(), Some(old), "{told}: the graph before is beside it");
        }
    }
}

#[test]
fn a_first_save_loses_no_stroke_wherever_the_disk_fails() {
    let painted = |place: &Place| {
        let mut session = Session::new(Some(place.kept.path()));
        paint(&mut session);
        session.keep(&[]).unwrap();
        session
    };
    let steps = {
        let place = Place::new();
        let disk = Disk::counting();
        painted(&place).on_disk(&disk).save_as(&place.file()).unwrap();
        assert_eq!(disk.at_risk(), Vec::<PathBuf>::new());
        disk.steps()
    };
    for (disk, told) in Disk::each_fault(steps) {
        let place = Place::new();
        let mut session = painted(&place).on_disk(&disk);
        let text = session.text().to_owned();
        let is_told = session.save_as(&place.file()).is_ok();
        let is_dirty = session.is_dirty();
        crash(session);
        let everything = Some((text, 1));
        let (saved, recovered) = (place.saved(), place.recovered());
        assert!(
            saved == everything || recovered == everything,
            "{told}: {saved:?} {recovered:?}"
        );
        if is_told {
            assert_eq!(saved, everything, "{told}");
            assert_eq!(disk.at_risk(), Vec::<PathBuf>::new(), "{told}");
        } else {
            assert!(is_dirty, "{told}: something is not saved");
        }
    }
}

#[test]
fn strokes_that_cannot_be_stored_beside_the_graph_are_kept_until_they_can() {
    let place = Place::new();
    let mut session = Session::new(Some(place.kept.path()));
    paint(&mut session);
    session.keep(&[]).unwrap();
    let folder = place.desk.path().join("a.paint");
    fs::write(&folder, "in the way").unwrap();
    let file = place.desk.path().join("a.sabi");
    session.save_as(&file).unwrap_err();
    assert!(session.is_dirty());
    session.keep(&[]).unwrap();
    crash(session);
    let mut session = Session::recover(recoveries(place.kept.path()).remove(0)).unwrap();
    assert_eq!(known(&session), 1, "they came back");
    fs::remove_file(&folder).unwrap();
    session.save().unwrap();
    assert!(!session.is_dirty());
    assert_eq!(known(&Session::open(&file, None).unwrap()), 1);
    session.close();
    assert!(recoveries(place.kept.path()).is_empty());
}

#[test]
fn an_autosave_leaves_the_earlier_copy_or_the_new_one() {
    type Keep = fn(&mut Session) -> bool;
    let at_once: Keep = |session| session.keep(&[]).is_ok();
    // A window calls it repeatedly until everything is written.
    let meanwhile: Keep = |session| {
        loop {
            match session.keep_meanwhile(&[]) {
                Ok(Keeping::Done) => return true,
                Ok(_) => std::thread::yield_now(),
                Err(_) => return false,
            }
        }
    };
    for keep in [at_once, meanwhile] {
        let steps = {
            let place = Place::new();
            let disk = Disk::counting();
            let mut session = place.edited().on_disk(&disk);
            session.edit("Gain", set_gain(0.75)).unwrap();
            assert!(keep(&mut session));
            assert_eq!(disk.at_risk(), Vec::<PathBuf>::new());
            disk.steps()
        };
        assert!(steps > 0);
        for (disk, told) in Disk::each_fault(steps) {
            let place = Place::new();
            let mut session = place.edited().on_disk(&disk);
            let before = session.text().to_owned();
            session.edit("Gain", set_gain(0.75)).unwrap();
            let after = session.text().to_owned();
            let is_told = keep(&mut session);
            crash(session);
            let (recovered, _) = place.recovered().expect(&told);
            let names = fs::read_dir(place.kept.path())
                .unwrap()
                .flatten()
                .map(|file| file.file_name());
            let is_left = |name: std::ffi::OsString| sabi_files::is_temporary_name(&name.to_string_lossy());
            assert!(!names.into_iter().any(is_left), "{told}: nothing half is left");
            assert!(recovered == after || !is_told && recovered == before, "{told}");
            assert!(!is_told || disk.at_risk().is_empty(), "{told}");
        }
    }
}

#[test]
fn a_copy_that_is_being_written_when_the_graph_is_saved_does_not_come_back() {
    let place = Place::new();
    let mut session = place.edited();
    session.edit("Gain", set_gain(0.75)).unwrap();
    assert_eq!(session.keep_meanwhile(&[]).unwrap(), Keeping::Begun);
    session.save().unwrap();
    crash(session);
    assert!(recoveries(place.kept.path()).is_empty());
}

#[test]
fn a_refused_save_names_the_graph_and_what_can_be_done() {
    let faults = [
        (
            ErrorKind::StorageFull,
            "the disk is full; free some space on the disk, or save in another folder",
        ),
        (
            ErrorKind::PermissionDenied,
            "you have no permission; save in another folder",
        ),
        (
            ErrorKind::ReadOnlyFilesystem,
            "the disk is read-only; save in another folder",
        ),
    ];
    for (kind, told) in faults {
        let place = Place::new();
        let file = place.file();
        let error = sabi_files::StagedError::File(sabi_files::FileError {
            operation: sabi_files::Operation::Write,
            path: place.desk.path().join("new/.sabi-4711.tmp"),
            source: kind.into(),
        });
        let said = super::super::graph_write::not_saved(&file, error).to_string();
        assert_eq!(said, format!("{} cannot be saved: {told}", file.display()));
    }
}
