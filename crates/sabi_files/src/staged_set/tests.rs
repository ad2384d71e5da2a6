//! Tests of staged sets.

use super::*;
use crate::test_folder::listing;

#[test]
fn an_input_file_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let texture = folder.path().join("bottle_normal.png");
    fs::write(&texture, b"the artist's own").unwrap();
    let mut set = StagedSet::create(folder.path()).unwrap();
    set.protect([
        folder.path().join(".").join("bottle_normal.png"),
        folder.path().join("missing.png"),
    ]);
    let error = set.stage("bottle_normal.png", b"baked").unwrap_err();
    assert_eq!(
        error.to_string(),
        format!("{} is read by the work that would replace it", texture.display())
    );
    set.stage("bottle_height.png", b"baked").unwrap();
    set.commit().unwrap();
    assert_eq!(fs::read(&texture).unwrap(), b"the artist's own");
}

#[cfg(unix)]
#[test]
fn only_ordinary_files_are_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("map.png");
    let _listening = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let mut set = StagedSet::create(folder.path()).unwrap();
    let error = set.stage("map.png", b"baked").unwrap_err();
    assert!(error.to_string().ends_with("is no ordinary file"), "{error}");
}

#[test]
fn no_file_appears_under_its_name_before_all_are_complete() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("a/b");
    let mut set = StagedSet::create(&folder).unwrap();
    set.stage("one.png", b"1").unwrap();
    set.stage("two.png", b"2").unwrap();
    let names = listing(&folder);
    assert_eq!(names.len(), 2);
    assert!(
        names.iter().all(|name| name.starts_with('.') && name.ends_with(".tmp")),
        "{names:?}"
    );
    let placed = set.commit().unwrap();
    assert_eq!(placed, [folder.join("one.png"), folder.join("two.png")]);
    assert_eq!(listing(&folder), ["one.png", "two.png"]);
}

#[test]
fn dropping_a_set_leaves_the_old_files_and_nothing_else() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("one.png"), b"old").unwrap();
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("one.png", b"new").unwrap();
    drop(set);
    assert_eq!(listing(root.path()), ["one.png"]);
    assert_eq!(fs::read(root.path().join("one.png")).unwrap(), b"old");
    let folder = root.path().join("x/y");
    drop(StagedSet::create(&folder).unwrap());
    assert_eq!(listing(root.path()), ["one.png"], "folders made for it are gone");
}

#[test]
fn a_folder_with_the_name_of_a_target_leaves_all_old_files() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("one.png"), b"old").unwrap();
    fs::create_dir(root.path().join("two.png")).unwrap();
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("one.png", b"new").unwrap();
    set.stage("two.png", b"new").unwrap();
    let error = set.commit().unwrap_err();
    assert!(
        error
            .to_string()
            .contains("two.png: a folder of that name is in the way; 0 of 2 files are new"),
        "{error}"
    );
    assert_eq!(fs::read(root.path().join("one.png")).unwrap(), b"old");
    assert_eq!(listing(root.path()), ["one.png", "two.png"]);
}

#[test]
fn after_a_failed_rename_the_files_before_it_are_restored() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("new folder");
    for has_earlier in [true, false] {
        let mut set = StagedSet::create(&folder).unwrap();
        if has_earlier {
            fs::write(folder.join("one.png"), b"old").unwrap();
        }
        for name in ["one.png", "two.png", "three.png"] {
            set.stage(name, b"new").unwrap();
        }
        let error = set
            .commit_with(|file, target| match target.ends_with("three.png") {
                true => Err(ErrorKind::PermissionDenied.into()),
                false => file.persist(target).map(drop).map_err(|refused| refused.error),
            })
            .unwrap_err();
        assert!(
            matches!(
                &error,
                StagedError::Commit {
                    replaced: 0,
                    total: 3,
                    ..
                }
            ),
            "{error}"
        );
        if has_earlier {
            assert_eq!(fs::read(folder.join("one.png")).unwrap(), b"old");
            assert_eq!(listing(&folder), ["one.png"]);
            fs::remove_dir_all(&folder).unwrap();
        } else {
            assert_eq!(listing(root.path()), [""; 0], "the folder was created for the set");
        }
    }
}

#[test]
fn files_that_cannot_be_restored_are_counted() {
    let root = tempfile::tempdir().unwrap();
    let placed = ["one.png", "two.png", "three.png"].map(|name| {
        let target = root.path().join(name);
        fs::write(&target, b"new").unwrap();
        (
            target,
            if name == "two.png" {
                EarlierState::Unknown
            } else {
                EarlierState::Missing
            },
        )
    });
    assert_eq!(restore(&Disk::default(), placed.into()), 1);
    assert_eq!(listing(root.path()), ["two.png"]);
}

#[test]
fn a_commit_leaves_no_second_names_of_earlier_files() {
    let root = tempfile::tempdir().unwrap();
    for text in [b"first".as_slice(), b"second"] {
        let mut set = StagedSet::create(root.path()).unwrap();
        set.stage("one.png", text).unwrap();
        set.stage("two.png", text).unwrap();
        set.commit().unwrap();
        assert_eq!(fs::read(root.path().join("two.png")).unwrap(), text);
        assert_eq!(listing(root.path()), ["one.png", "two.png"]);
    }
}

#[test]
fn a_file_in_place_of_the_folder_gives_a_clear_error() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, b"x").unwrap();
    for folder in [file.clone(), file.join("below")] {
        let error = StagedSet::create(&folder).unwrap_err();
        assert!(error.to_string().starts_with("cannot create the folder "), "{error}");
    }
    assert_eq!(fs::read(&file).unwrap(), b"x");
}

#[test]
fn a_name_is_used_once_and_cannot_leave_the_folder() {
    let root = tempfile::tempdir().unwrap();
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("a.png", b"1").unwrap();
    assert!(set.contains("A.PNG") && !set.contains("b.png"));
    assert!(matches!(set.stage("A.PNG", b"2"), Err(StagedError::SameName { .. })));
    for name in ["../a.png", "b/c.png", "", "..", "/a"] {
        assert!(matches!(set.stage(name, b"2"), Err(StagedError::File(_))), "{name}");
    }
}

#[test]
fn the_files_of_another_set_that_is_being_written_stay() {
    let root = tempfile::tempdir().unwrap();
    let mut other = StagedSet::create(root.path()).unwrap();
    other.stage("a.png", b"theirs").unwrap();
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("a.png", b"ours").unwrap();
    set.commit().unwrap();
    assert_eq!(fs::read(root.path().join("a.png")).unwrap(), b"ours");
    other.commit().unwrap();
    assert_eq!(fs::read(root.path().join("a.png")).unwrap(), b"theirs");
}

#[test]
fn what_a_killed_process_left_is_removed_and_nothing_else_is() {
    let root = tempfile::tempdir().unwrap();
    let kept = ["notes.tmp", ".sabi-notes.txt", ".hidden.tmp", "a.png"];
    for name in kept {
        fs::write(root.path().join(name), b"kept").unwrap();
    }
    fs::create_dir(root.path().join(".sabi-folder.tmp")).unwrap();
    for name in [".sabi-Ab12.tmp", ".sabi-earlier-Cd34.tmp"] {
        fs::write(root.path().join(name), b"half").unwrap();
    }
    drop(StagedSet::create(root.path()).unwrap());
    let mut expected: Vec<&str> = kept.into_iter().chain([".sabi-folder.tmp"]).collect();
    expected.sort_unstable();
    assert_eq!(listing(root.path()), expected);
}

#[test]
fn a_file_with_the_same_bytes_keeps_its_time_stamp() {
    let root = tempfile::tempdir().unwrap();
    let [same, other] = ["same.png", "other.png"].map(|name| root.path().join(name));
    let long_ago = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    for (path, bytes) in [(&same, b"same"), (&other, b"earl")] {
        fs::write(path, bytes).unwrap();
        File::options()
            .write(true)
            .open(path)
            .unwrap()
            .set_modified(long_ago)
            .unwrap();
    }
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("same.png", b"same").unwrap();
    set.stage("other.png", b"late").unwrap();
    assert_eq!(set.commit().unwrap(), [same.clone(), other.clone()]);
    let modified = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
    assert_eq!(modified(&same), long_ago);
    assert_ne!(modified(&other), long_ago);
    assert_eq!(fs::read(&other).unwrap(), b"late");
}

#[test]
fn if_an_unchanged_file_changes_before_the_commit_nothing_is_replaced() {
    let root = tempfile::tempdir().unwrap();
    let [same, other] = ["same.png", "other.png"].map(|name| root.path().join(name));
    fs::write(&same, b"same").unwrap();
    let mut set = StagedSet::create(root.path()).unwrap();
    set.stage("other.png", b"new").unwrap();
    set.stage("same.png", b"same").unwrap();
    fs::write(&same, b"somebody's own").unwrap();
    let error = set.commit().unwrap_err().to_string();
    assert!(
        error.ends_with("same.png: another program has changed it meanwhile; 0 of 2 files are new"),
        "{error}"
    );
    assert!(!other.exists());
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf_8_are_distinguished() {
    use std::os::unix::ffi::OsStrExt;
    let root = tempfile::tempdir().unwrap();
    let names = [b"a\xfe.png".as_slice(), b"a\xff.png"].map(OsStr::from_bytes);
    let mut set = StagedSet::create(root.path()).unwrap();
    for name in names {
        set.stage(name, name.as_bytes()).unwrap();
    }
    assert!(matches!(set.stage(names[0], b"2"), Err(StagedError::SameName { .. })));
    set.commit().unwrap();
    for name in names {
        assert_eq!(fs::read(root.path().join(name)).unwrap(), name.as_bytes());
    }
}

/// Reads a little-endian number of two or four bytes.
fn number(bytes: &[u8], at: usize, length: usize) -> usize {
    bytes[at..at + length]
        .iter()
        .rev()
        .fold(0, |sum, byte| (sum << 8) | usize::from(*byte))
}

/// Returns names, offsets and contents of the files in an uncompressed archive, according to PKWARE's APPNOTE 4.3.7.
fn stored_files(bytes: &[u8]) -> Vec<(String, usize, Vec<u8>)> {
    let mut files = Vec::new();
    let mut at = 0;
    while bytes[at..].starts_with(b"PK\x03\x04") {
        assert_eq!(number(bytes, at + 8, 2), 0, "stored");
        let (size, name, extra) = (
            number(bytes, at + 18, 4),
            number(bytes, at + 26, 2),
            number(bytes, at + 28, 2),
        );
        let text = String::from_utf8(bytes[at + 30..at + 30 + name].to_vec()).unwrap();
        let start = at + 30 + name + extra;
        files.push((text, start, bytes[start..start + size].to_vec()));
        at = start + size;
    }
    assert!(bytes[at..].starts_with(b"PK\x01\x02"), "the directory follows");
    files
}

#[test]
fn the_files_of_a_package_are_aligned_and_unchanged() {
    let package = || {
        let folder = tempfile::tempdir().unwrap();
        let mut set = StagedSet::create(folder.path()).unwrap();
        let contents: Vec<(String, Vec<u8>)> = (0..70).map(|at| (format!("錆{at}.png"), vec![at; at.into()])).collect();
        for (name, bytes) in &contents {
            set.stage(name, bytes).unwrap();
        }
        let members: Vec<&str> = contents.iter().map(|(name, _)| name.as_str()).collect();
        assert!(set.stage_package("all.usdz", "a.usda", b"first", &members, 64).unwrap());
        assert!(set.contains("ALL.usdz"));
        let mut copied = Vec::new();
        set.copy_staged("all.usdz", &mut copied).unwrap();
        set.commit().unwrap();
        let bytes = fs::read(folder.path().join("all.usdz")).unwrap();
        assert_eq!(copied, bytes);
        (bytes, contents)
    };
    let (bytes, contents) = package();
    let files = stored_files(&bytes);
    assert!(files.iter().all(|(_, start, _)| start % 64 == 0), "{files:?}");
    let expected = [("a.usda".to_owned(), b"first".to_vec())].into_iter().chain(contents);
    assert!(files.into_iter().map(|(name, _, content)| (name, content)).eq(expected));
    assert_eq!(package().0, bytes, "the same files give the same bytes");
}

#[test]
fn a_package_refuses_duplicate_and_missing_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut set = StagedSet::create(folder.path()).unwrap();
    set.stage("a.usdz", b"1").unwrap();
    let twice = set.stage_package("A.usdz", "a.usda", b"", &[], 64).unwrap_err();
    assert_eq!(twice.to_string(), "two files would be written to A.usdz");
    set.stage_package("b.usdz", "a.usda", b"", &["gone.png"], 64)
        .unwrap_err();
    assert!(!set.contains("b.usdz"));
}

#[test]
fn a_package_with_the_same_bytes_keeps_its_time_stamp() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("all.usdz");
    let long_ago = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let staged = |content: &[u8]| {
        let mut set = StagedSet::create(root.path()).unwrap();
        // A file that is unchanged is read from its final place.
        set.stage("a.png", content).unwrap();
        assert!(set.stage_package("all.usdz", "a.usda", b"", &["a.png"], 64).unwrap());
        set.commit().unwrap();
        fs::metadata(&path).unwrap().modified().unwrap()
    };
    staged(b"one");
    let file = File::options().write(true).open(&path).unwrap();
    file.set_modified(long_ago).unwrap();
    assert_eq!(staged(b"one"), long_ago);
    assert_ne!(staged(b"two"), long_ago);
}
