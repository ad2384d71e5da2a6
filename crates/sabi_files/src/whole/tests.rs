//! Tests of whole files.

use super::*;
use crate::test_folder::listing;

#[test]
fn a_file_is_replaced_and_its_folder_is_created() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("a/b/file.txt");
    write_whole(&file, b"first").unwrap();
    write_whole(&file, b"second, and longer").unwrap();
    write_whole(&file, b"third").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"third");
    assert_eq!(listing(file.parent().unwrap()), ["file.txt"]);
}

#[test]
fn a_crash_in_the_middle_leaves_the_earlier_file() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file.txt");
    write_whole(&file, b"earlier").unwrap();
    let mut begun = WholeFile::create(&file).unwrap();
    begun.write(b"hal").unwrap();
    // Simulates a process that ends here, without destructors.
    std::mem::forget(begun);
    assert_eq!(fs::read(&file).unwrap(), b"earlier");
    assert_eq!(listing(root.path()).len(), 2);
    write_whole(&file, b"later").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"later");
}

#[test]
fn a_temporary_file_of_a_crash_is_never_written_to_again() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file.txt");
    let mut names = std::collections::BTreeSet::new();
    for _ in 0..50 {
        let mut begun = WholeFile::create(&file).unwrap();
        begun.write(b"half").unwrap();
        assert!(names.insert(begun.temporary.path().to_owned()), "a name came twice");
        std::mem::forget(begun);
    }
    write_whole(&file, b"whole").unwrap();
    for name in names {
        assert_eq!(fs::read(name).unwrap(), b"half");
    }
}

#[test]
fn dropping_an_unfinished_file_leaves_only_the_earlier_file() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file.txt");
    write_whole(&file, b"earlier").unwrap();
    let mut begun = WholeFile::create(&file).unwrap();
    begun.write(b"half").unwrap();
    drop(begun);
    assert_eq!(fs::read(&file).unwrap(), b"earlier");
    assert_eq!(listing(root.path()), ["file.txt"]);
}

#[test]
fn concurrent_writers_of_one_file_leave_the_complete_text_of_one() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file.txt");
    let texts: Vec<Vec<u8>> = (0..8).map(|number| vec![b'a' + number; 10_000]).collect();
    std::thread::scope(|scope| {
        for text in &texts {
            let file = &file;
            scope.spawn(move || (0..20).for_each(|_| write_whole(file, text).unwrap()));
        }
    });
    assert!(texts.contains(&fs::read(&file).unwrap()));
    assert_eq!(listing(root.path()), ["file.txt"]);
}

#[test]
fn a_folder_with_the_name_of_the_target_stays_and_is_reported() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("folder");
    fs::create_dir(&file).unwrap();
    let error = write_whole(&file, b"1").unwrap_err();
    assert_eq!(
        (error.operation, error.kind()),
        (Operation::Replace, ErrorKind::IsADirectory)
    );
    assert!(file.is_dir());
    assert_eq!(listing(root.path()), ["folder"]);
    let nameless = WholeFile::create(Path::new("a/..")).unwrap_err();
    assert_eq!(nameless.kind(), ErrorKind::InvalidFilename);
    let below_a_file = root.path().join("file");
    fs::write(&below_a_file, b"1").unwrap();
    let error = write_whole(&below_a_file.join("below"), b"1").unwrap_err();
    assert_eq!(error.operation, Operation::CreateFolder);
}

#[test]
fn a_file_with_the_longest_possible_name_can_be_written() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("n".repeat(255));
    write_whole(&file, b"1").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"1");
}

#[cfg(unix)]
mod on_unix {
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    use super::*;

    #[test]
    fn a_name_that_is_not_utf_8_is_used_exactly() {
        let root = tempfile::tempdir().unwrap();
        let names: [&[u8]; 2] = [b"a\xff.txt", b"a\xfe.txt"];
        for name in names {
            write_whole(&root.path().join(OsStr::from_bytes(name)), name).unwrap();
        }
        let mut found: Vec<_> = fs::read_dir(root.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().as_bytes().to_vec())
            .collect();
        found.sort();
        assert_eq!(found, [names[1], names[0]]);
        for name in names {
            assert_eq!(fs::read(root.path().join(OsStr::from_bytes(name))).unwrap(), name);
        }
    }

    #[test]
    fn a_link_is_kept_and_its_target_is_written() {
        let root = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| root.path().join(name));
        fs::write(&file, b"earlier").unwrap();
        symlink(&file, &link).unwrap();
        write_whole(&link, b"later").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"later");
    }

    #[test]
    fn permissions_are_kept_and_new_files_get_the_usual_ones() {
        let root = tempfile::tempdir().unwrap();
        let [usual, file] = ["usual", "file"].map(|name| root.path().join(name));
        fs::write(&usual, b"1").unwrap();
        write_whole(&file, b"1").unwrap();
        let mode = |file: &Path| fs::metadata(file).unwrap().mode();
        assert_eq!(mode(&file), mode(&usual));
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        write_whole(&file, b"2").unwrap();
        assert_eq!(mode(&file) & 0o777, 0o640);
    }
}
