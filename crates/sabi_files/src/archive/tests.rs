use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;
use crate::test_folder::listing;

/// Accepts every name.
const ALL: Accepts<'static> = &|_| Ok(());

/// Returns the fault of the last of these names, which are added to one archive.
fn fault(names: &[&str]) -> Option<NameFault> {
    let mut known = EntryNames::default();
    let mut faults: Vec<Option<NameFault>> = names.iter().map(|name| known.add(name).err()).collect();
    let last = faults.pop().flatten();
    assert!(faults.iter().all(Option::is_none), "{names:?}");
    last
}

fn entries(files: &[(&str, &[u8])]) -> BTreeMap<String, EntryContent> {
    let entry = |(name, bytes): &(&str, &[u8])| ((*name).to_owned(), EntryContent::Bytes(bytes.to_vec()));
    files.iter().map(entry).collect()
}

#[test]
fn a_name_must_be_valid_on_every_system() {
    for good in [
        "a.png",
        "a/b c/d.strokes",
        "ä.sabi",
        ".hidden",
        "console.png",
        "com10",
        "a/nul_.wgsl",
    ] {
        assert_eq!(fault(&[good]), None, "{good}");
    }
    for out in ["/a", "\\a", "../a", "a/../b", "a\\..\\b", "..", "C:/a", "c:a"] {
        assert_eq!(fault(&[out]), Some(NameFault::Outside), "{out}");
    }
    for empty in ["", "a//b", "a/", "./a", "a/./b"] {
        assert_eq!(fault(&[empty]), Some(NameFault::Empty), "{empty}");
    }
    for (name, odd) in [
        ("a\\b", '\\'),
        ("ab:c", ':'),
        ("a*", '*'),
        ("a\0", '\0'),
        ("a\n", '\n'),
        ("a|b", '|'),
    ] {
        assert_eq!(fault(&[name]), Some(NameFault::Character(odd)), "{name}");
    }
    for (name, odd) in [("photo_\u{202e}gnp.exe", '\u{202e}'), ("a\u{feff}.png", '\u{feff}')] {
        let fault = fault(&[name]).expect("a fault");
        assert_eq!(fault, NameFault::Invisible(odd), "{name}");
        assert!(fault.to_string().contains(&format!("U+{:04X}", u32::from(odd))));
    }
    for end in ["a.", "a ", "a /b", "..."] {
        assert_eq!(fault(&[end]), Some(NameFault::End), "{end}");
    }
    for device in ["con", "NUL.png", "a/aux.wgsl", "Com1.txt", "lpt¹", "prn .png"] {
        assert!(matches!(fault(&[device]), Some(NameFault::Device(_))), "{device}");
    }
    assert_eq!(fault(&["x".repeat(256).as_str()]), Some(NameFault::Long));
    assert_eq!(fault(&["x/".repeat(600).as_str()]), Some(NameFault::Long));
}

#[test]
fn names_that_a_file_system_treats_as_the_same_are_refused() {
    let taken = |other: &str| Some(NameFault::Taken(other.to_owned()));
    assert_eq!(fault(&["a.png", "A.PNG"]), taken("a.png"));
    assert_eq!(fault(&["ä", "Ä"]), taken("ä"));
    assert_eq!(fault(&["a", "a/b"]), taken("a"));
    assert_eq!(fault(&["A/b", "a"]), taken("A"));
    assert_eq!(fault(&["a/b", "A/c", "b"]), None);
}

#[test]
fn the_same_files_give_the_same_archive_and_unpacking_restores_them() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let files: [(&str, &[u8]); 4] = [
        ("b.png", b"pixels"),
        ("a/c.txt", &[7; 3000]),
        ("empty", b""),
        ("B/x", b"x"),
    ];
    let mut packed = entries(&files);
    fs::write(at("source"), [9; 70_000]).unwrap();
    packed.insert("copied.bin".to_owned(), EntryContent::File(at("source")));
    let go_on = || false;
    assert_eq!(
        write_archive(&at("one.zip"), &packed, false, &go_on).unwrap(),
        [1, 3000, 6, 70_000, 0]
    );
    write_archive(&at("two.zip"), &packed, false, &go_on).unwrap();
    let bytes = fs::read(at("one.zip")).unwrap();
    assert!(fs::read(at("two.zip")).unwrap() == bytes && bytes.len() < 2000);
    let unpacked = UnpackedArchive::read(&at("one.zip"), &at("new/out"), ALL, &go_on).unwrap();
    assert_eq!(unpacked.names(), ["B/x", "a/c.txt", "b.png", "copied.bin", "empty"]);
    assert!(!at("new").exists());
    unpacked.commit().unwrap();
    for (name, bytes) in files {
        assert_eq!(fs::read(at("new/out").join(name)).unwrap(), bytes, "{name}");
    }
    assert_eq!(fs::read(at("new/out/copied.bin")).unwrap(), [9; 70_000]);
    assert_eq!(listing(folder.path()), ["new", "one.zip", "source", "two.zip"]);
}

#[test]
fn an_empty_folder_is_filled_and_a_folder_with_files_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_archive(&at("a.zip"), &entries(&[("x/y", b"1"), ("z", b"2")]), false, &|| false).unwrap();
    fs::create_dir(at("out")).unwrap();
    let read = |target: &str| UnpackedArchive::read(&at("a.zip"), &at(target), ALL, &|| false);
    read("out").unwrap().commit().unwrap();
    assert_eq!(listing(&at("out")), ["x", "z"]);
    assert!(matches!(read("out"), Err(ArchiveError::FolderInUse(_))));
    assert!(matches!(read("a.zip"), Err(ArchiveError::NoFolder(_))));
    drop(read("dropped").unwrap());
    // Files that another program has written in the meantime are kept.
    let late = read("late").unwrap();
    fs::create_dir(at("late")).unwrap();
    fs::write(at("late/own"), b"own").unwrap();
    assert!(matches!(late.commit(), Err(ArchiveError::FolderInUse(_))));
    assert_eq!(listing(&at("late")), ["own"]);
    assert_eq!(listing(folder.path()), ["a.zip", "late", "out"]);
}

#[test]
fn an_archive_is_either_complete_or_missing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let write = |entries: &BTreeMap<String, EntryContent>, replaces: bool, stops: bool| {
        write_archive(&at("a.zip"), entries, replaces, &|| stops)
    };
    let good = entries(&[("a", b"1")]);
    let of_file = |path: &Path| BTreeMap::from([("a".to_owned(), EntryContent::File(path.to_owned()))]);
    assert!(matches!(
        write(&of_file(&at("gone")), false, false),
        Err(ArchiveError::Unread { .. })
    ));
    assert!(matches!(
        write(&of_file(folder.path()), false, false),
        Err(ArchiveError::Unread { .. })
    ));
    assert!(matches!(
        write(&entries(&[("a", b""), ("A", b"")]), false, false),
        Err(ArchiveError::Name { .. })
    ));
    fs::write(at("source"), b"1").unwrap();
    assert!(matches!(
        write(&of_file(&at("source")), false, true),
        Err(ArchiveError::Canceled)
    ));
    assert_eq!(listing(folder.path()), ["source"]);
    write(&good, false, false).unwrap();
    assert!(matches!(write(&good, false, false), Err(ArchiveError::Exists(_))));
    write(&entries(&[("b", b"2")]), true, false).unwrap();
    let read = UnpackedArchive::read(&at("a.zip"), &at("out"), ALL, &|| false).unwrap();
    assert_eq!(read.names(), ["b"]);
    assert!(matches!(
        UnpackedArchive::read(&at("a.zip"), &at("out"), ALL, &|| true),
        Err(ArchiveError::Canceled)
    ));
}

#[cfg(unix)]
#[test]
fn left_overs_of_killed_processes_are_removed_but_not_files_being_unpacked() {
    let root = tempfile::tempdir().unwrap();
    let archive = root.path().join("a.zip");
    write_archive(&archive, &entries(&[("a.png", b"a")]), false, &|| false).unwrap();
    let read = |target: &str| UnpackedArchive::read(&archive, &root.path().join(target), ALL, &|| false).unwrap();
    let left = |place: &str| {
        let left = root.path().join(place).join(".sabi-Ab12.tmp");
        fs::create_dir_all(left.join("below")).unwrap();
        fs::write(left.join("below/half"), b"half").unwrap();
        left
    };
    let (beside, inside) = (left("."), left("filled"));
    let first = read("first");
    assert!(!beside.exists());
    let second = read("filled");
    assert!(!inside.exists(), "a folder with nothing but left-overs counts as empty");
    second.commit().unwrap();
    assert!(first.folder().join("a.png").is_file(), "it is still being unpacked");
    first.commit().unwrap();
    for target in ["first", "filled"] {
        assert_eq!(listing(&root.path().join(target)), ["a.png"]);
    }
}

#[test]
fn an_entry_that_the_caller_refuses_leaves_no_files_behind() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let files: [(&str, &[u8]); 2] = [("a.png", b"1"), (".git/config", b"[core]")];
    write_archive(&at("a.zip"), &entries(&files), false, &|| false).unwrap();
    let accepts = |name: &str| match name.starts_with('.') {
        true => Err("it is hidden".to_owned()),
        false => Ok(()),
    };
    let told = UnpackedArchive::read(&at("a.zip"), &at("out"), &accepts, &|| false).unwrap_err();
    assert_eq!(
        told.to_string(),
        "'.git/config' in the archive is not unpacked: it is hidden"
    );
    assert_eq!(listing(folder.path()), ["a.zip"]);
}

#[test]
fn entries_that_share_bytes_are_refused() {
    // Two directory entries that refer to one local entry, a trick of archives that unpack to a million times their size.
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_archive(
        &at("a.zip"),
        &entries(&[("a.txt", b"x"), ("b.txt", b"x")]),
        false,
        &|| false,
    )
    .unwrap();
    let mut bytes = fs::read(at("a.zip")).unwrap();
    // The signature of a directory entry; the offset of the local entry is stored 42 bytes behind it (APPNOTE 4.3.12).
    let places: Vec<usize> = (0..bytes.len() - 4)
        .filter(|at| bytes[*at..].starts_with(b"PK\x01\x02"))
        .collect();
    assert_eq!(places.len(), 2);
    let first: [u8; 4] = bytes[places[0] + 42..][..4].try_into().unwrap();
    bytes[places[1] + 42..][..4].copy_from_slice(&first);
    fs::write(at("b.zip"), bytes).unwrap();
    let told = UnpackedArchive::read(&at("b.zip"), &at("out"), ALL, &|| false).unwrap_err();
    assert!(matches!(told, ArchiveError::Overlapping(_)), "{told}");
    assert_eq!(listing(folder.path()), ["a.zip", "b.zip"]);
}
