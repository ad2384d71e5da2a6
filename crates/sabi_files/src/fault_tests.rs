//! Tests every fault at every step: a file has either its old bytes or all new ones, and a file that was reported as
//! written survives a power failure.

use std::path::Path;
use std::{fs, io};

use crate::archive::write::write_archive_on;
use crate::archive::{ArchiveError, EntryContent, UnpackedArchive};
use crate::test_folder::listing;
use crate::{Cache, CacheKind, Disk, FileError, Operation, StagedError, StagedSet, is_temporary_name};

const OLD: &[u8] = b"as it was";
const NEW: &[u8] = b"as it is now, and longer";

/// Runs a piece of work in a new folder once for each fault at each of its steps. `look` then receives the folder, and
/// whether the work reported success.
fn at_every_step(
    prepare: impl Fn(&Path),
    work: impl Fn(&Disk, &Path) -> bool,
    look: impl Fn(&Path, &Disk, bool, String),
) {
    let fresh = || {
        let folder = tempfile::tempdir().unwrap();
        prepare(folder.path());
        folder
    };
    let folder = fresh();
    let whole = Disk::counting();
    assert!(work(&whole, folder.path()));
    look(folder.path(), &whole, true, "without a fault".to_owned());
    assert!(whole.steps() > 0);
    for (disk, told) in Disk::each_fault(whole.steps()) {
        let folder = fresh();
        let is_done = work(&disk, folder.path());
        look(folder.path(), &disk, is_done, told);
    }
}

/// Returns the names in a folder, except temporary ones.
fn names(folder: &Path) -> Vec<String> {
    let mut names = listing(folder);
    names.retain(|name| !is_temporary_name(name));
    names
}

/// Returns the names in a folder; none if it does not exist.
fn listing_of_any(folder: &Path) -> Vec<String> {
    if folder.is_dir() { listing(folder) } else { Vec::new() }
}

/// Returns whether an error means that the file is in place already.
fn is_in_place(error: &FileError) -> bool {
    error.operation == Operation::SyncFolder
}

#[test]
fn after_any_fault_a_replaced_file_is_either_old_or_new() {
    at_every_step(
        |folder| fs::write(folder.join("file"), OLD).unwrap(),
        |disk, folder| disk.write_whole(&folder.join("file"), NEW).is_ok(),
        |folder, disk, is_done, told| {
            let found = fs::read(folder.join("file")).unwrap();
            assert!(found == NEW || !is_done && found == OLD, "{told}");
            assert_eq!(names(folder), ["file"], "{told}");
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
            if !disk.has_ended() {
                assert_eq!(listing(folder), ["file"], "{told}");
            }
        },
    );
}

#[test]
fn a_file_in_new_folders_survives_a_power_failure_once_reported_as_written() {
    at_every_step(
        |_| {},
        |disk, folder| disk.write_whole(&folder.join("deep/er/file"), NEW).is_ok(),
        |folder, disk, is_done, told| {
            let found = fs::read(folder.join("deep/er/file"));
            assert!(found.as_ref().map_or(!is_done, |found| found == NEW), "{told}");
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
        },
    );
}

#[test]
fn a_new_file_never_replaces_another_file() {
    at_every_step(
        |folder| fs::write(folder.join("taken"), OLD).unwrap(),
        |disk, folder| {
            let refused = Disk::default().write_new(&folder.join("taken"), NEW).unwrap_err();
            assert_eq!(refused.kind(), io::ErrorKind::AlreadyExists);
            disk.write_new(&folder.join("taken"), NEW).unwrap_err();
            disk.write_new(&folder.join("free"), NEW).is_ok()
        },
        |folder, disk, is_done, told| {
            assert_eq!(fs::read(folder.join("taken")).unwrap(), OLD, "{told}");
            let found = fs::read(folder.join("free"));
            assert!(found.as_ref().map_or(!is_done, |found| found == NEW), "{told}");
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
        },
    );
}

#[test]
fn appending_never_changes_the_earlier_bytes() {
    at_every_step(
        |folder| fs::write(folder.join("file"), OLD).unwrap(),
        |disk, folder| disk.append_durably(&folder.join("file"), NEW).is_ok(),
        |folder, disk, is_done, told| {
            let found = fs::read(folder.join("file")).unwrap();
            let added = found.strip_prefix(OLD).expect(&told);
            assert!(NEW.starts_with(added) && (!is_done || added == NEW), "{told}");
            assert!(!is_done || disk.at_risk().is_empty(), "{told}");
            if !is_done && !disk.has_ended() {
                assert_eq!(found, OLD, "{told}: a part that was refused is taken back");
            }
        },
    );
}

#[test]
fn files_of_a_set_are_complete_and_unchanged_if_the_set_was_refused() {
    let old = [("a.png", Some(OLD)), ("b.png", None), ("c.png", Some(OLD))];
    let write = |disk: &Disk, folder: &Path| -> Result<(), StagedError> {
        let mut set = StagedSet::create_on(disk, folder)?;
        for (name, _) in old {
            set.stage(name, NEW)?;
        }
        set.commit().map(drop)
    };
    at_every_step(
        |folder| {
            for (name, bytes) in old {
                if let Some(bytes) = bytes {
                    fs::write(folder.join(name), bytes).unwrap();
                }
            }
        },
        |disk, folder| match write(disk, folder) {
            Ok(()) => true,
            Err(error) => {
                let is_placed = matches!(&error, StagedError::Commit { error, .. } if is_in_place(error));
                let has_old =
                    |(name, bytes): (&str, Option<&[u8]>)| fs::read(folder.join(name)).ok().as_deref() == bytes;
                assert!(is_placed || disk.has_ended() || old.into_iter().all(has_old), "{error}");
                false
            }
        },
        |folder, disk, is_done, told| {
            for (name, bytes) in old {
                let found = fs::read(folder.join(name)).ok();
                assert!(
                    found.as_deref() == Some(NEW) || !is_done && found.as_deref() == bytes,
                    "{told}: {name}"
                );
            }
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
            // Writing another set succeeds, and removes the left-overs of the killed process.
            write(&Disk::default(), folder).unwrap();
            assert_eq!(listing(folder), ["a.png", "b.png", "c.png"], "{told}");
        },
    );
}

#[test]
fn a_package_of_a_set_is_either_complete_or_missing() {
    let names = ["a.png", "b.usdz"];
    let write = |disk: &Disk, folder: &Path| -> Result<bool, StagedError> {
        let mut set = StagedSet::create_on(disk, folder)?;
        set.stage(names[0], NEW)?;
        let is_packed = set.stage_package(names[1], "first", OLD, &names[..1], 64)?;
        set.commit()?;
        Ok(is_packed)
    };
    at_every_step(
        |_| {},
        |disk, folder| write(disk, folder).is_ok_and(|is_packed| is_packed),
        |folder, disk, is_done, told| {
            if let Ok(bytes) = fs::read(folder.join(names[1])) {
                assert!(bytes.windows(NEW.len()).any(|part| part == NEW), "{told}");
                assert!(bytes.ends_with(&[0, 0]), "{told}: an archive ends with its record");
            } else {
                assert!(!is_done, "{told}");
            }
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
            write(&Disk::default(), folder).unwrap();
            assert_eq!(listing(folder), names, "{told}");
        },
    );
}

/// Entries of an archive: a file in nested folders, a file beside these, and a file at the top.
const ENTRIES: [(&str, &[u8]); 3] = [("a/b/one", NEW), ("a/two", OLD), ("three", NEW)];

/// Writes the archive of [`ENTRIES`].
fn write_entries(disk: &Disk, target: &Path, replaces: bool) -> Result<(), ArchiveError> {
    let entry = |(name, bytes): (&str, &[u8])| (name.to_owned(), EntryContent::Bytes(bytes.to_vec()));
    let entries = ENTRIES.map(entry).into_iter().collect();
    write_archive_on(disk, target, &entries, replaces, &|| false).map(drop)
}

#[test]
fn an_archive_is_either_the_old_one_or_completely_new() {
    at_every_step(
        |folder| fs::write(folder.join("file.zip"), OLD).unwrap(),
        |disk, folder| write_entries(disk, &folder.join("file.zip"), true).is_ok(),
        |folder, disk, is_done, told| {
            let file = folder.join("file.zip");
            let is_old = fs::read(&file).unwrap() == OLD;
            assert!(!is_done || !is_old, "{told}");
            assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
            if !is_old {
                let unpacked = UnpackedArchive::read(&file, &folder.join("out"), &|_| Ok(()), &|| false).unwrap();
                assert_eq!(unpacked.names(), ENTRIES.map(|(name, _)| name), "{told}");
            }
            if !disk.has_ended() {
                assert_eq!(listing(folder), ["file.zip"], "{told}");
            }
        },
    );
}

#[test]
fn an_archive_is_unpacked_completely_or_not_at_all() {
    let has_all = |out: &Path| {
        ENTRIES
            .iter()
            .all(|(name, bytes)| fs::read(out.join(name)).is_ok_and(|found| found == *bytes))
    };
    for is_there in [false, true] {
        at_every_step(
            |folder| {
                write_entries(&Disk::default(), &folder.join("file.zip"), false).unwrap();
                if is_there {
                    fs::create_dir(folder.join("out")).unwrap();
                }
            },
            |disk, folder| {
                let unpacked = UnpackedArchive::read_on(
                    disk,
                    &folder.join("file.zip"),
                    &folder.join("out"),
                    &|_| Ok(()),
                    &|| false,
                );
                match unpacked.and_then(UnpackedArchive::commit) {
                    Ok(()) => true,
                    Err(ArchiveError::Disk(error)) => {
                        let out = folder.join("out");
                        assert!(
                            is_in_place(&error) || disk.has_ended() || listing_of_any(&out).is_empty(),
                            "{error}"
                        );
                        false
                    }
                    Err(error) => panic!("{error}"),
                }
            },
            |folder, disk, is_done, told| {
                let out = folder.join("out");
                assert!(!is_done || has_all(&out), "{told}");
                assert!(!is_done || disk.at_risk().is_empty(), "{told}: {:?}", disk.at_risk());
                // Each file is complete, even if the process ended while files were moved into an existing folder.
                for (name, bytes) in ENTRIES {
                    let found = fs::read(out.join(name));
                    assert!(
                        found.is_ok_and(|found| found == bytes) || !out.join(name).exists(),
                        "{told}: {name}"
                    );
                }
                if !disk.has_ended() {
                    assert!(names(folder) == listing(folder), "{told}: nothing is left over");
                }
            },
        );
    }
}

#[test]
fn a_cached_result_is_returned_completely_or_not_at_all() {
    let kind = CacheKind {
        prefix: "kind",
        version: 1,
        limit_bytes: 150,
    };
    let cache = |disk: &Disk, folder: &Path| Cache::new(folder.join("cache"), kind).on_disk(disk);
    let keys = [[1; 32], [2; 32]];
    at_every_step(
        |folder| cache(&Disk::default(), folder).write(&keys[0], OLD).unwrap(),
        |disk, folder| {
            let again = cache(disk, folder).write(&keys[0], NEW).is_ok();
            cache(disk, folder).write(&keys[1], NEW).is_ok() && again
        },
        |folder, _, is_done, told| {
            let read = |key| cache(&Disk::default(), folder).read(key);
            let [first, second] = [read(&keys[0]), read(&keys[1])];
            for found in [&first, &second].into_iter().flatten() {
                assert!(found == OLD || found == NEW, "{told}");
            }
            assert_ne!(second.as_deref(), Some(OLD), "{told}");
            assert!(!is_done || second.as_deref() == Some(NEW), "{told}");
        },
    );
}

#[test]
fn the_real_disk_does_not_count_steps() {
    let folder = tempfile::tempdir().unwrap();
    let disk = Disk::default();
    disk.write_whole(&folder.path().join("file"), NEW).unwrap();
    assert_eq!((disk.steps(), disk.has_ended(), disk.at_risk()), (0, false, Vec::new()));
}
