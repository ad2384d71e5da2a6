//! Archives that `sabi pack` did not make: no entry writes a file, whatever path it has.

use std::fs;

use crate::cli_folder::{CLOUDS, CliFolder, graph};

/// Method of an entry that is stored without compression.
#[derive(Clone, Copy)]
struct StoredEntry<'a> {
    name: &'a str,
    bytes: &'a [u8],
    /// Kind of file and permissions, as Unix has them.
    mode: u32,
    flags: u16,
    /// Size that the archive claims; `None` for the true size.
    claimed: Option<u32>,
}

const PLAIN: StoredEntry<'_> = StoredEntry {
    name: "a",
    bytes: b"content",
    mode: 0o100_644,
    flags: 1 << 11,
    claimed: None,
};

pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ (0xedb8_8320 * (crc & 1)));
    !bytes.iter().fold(u32::MAX, step)
}

/// Returns an archive of these entries, whose headers may be false.
fn archive(entries: &[StoredEntry<'_>]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        let offset = bytes.len() as u32;
        let mut shared = Vec::new();
        for short in [20, entry.flags, 0, 0, 0x21] {
            shared.extend(short.to_le_bytes());
        }
        let length = entry.bytes.len() as u32;
        for long in [crc32(entry.bytes), length, entry.claimed.unwrap_or(length)] {
            shared.extend(long.to_le_bytes());
        }
        shared.extend((entry.name.len() as u16).to_le_bytes());
        shared.extend([0; 2]);
        bytes.extend([b"PK\x03\x04", &shared[..], entry.name.as_bytes(), entry.bytes].concat());
        directory.extend([b"PK\x01\x02\x14\x03", &shared[..], &[0; 6]].concat());
        directory.extend([(entry.mode << 16).to_le_bytes(), offset.to_le_bytes()].concat());
        directory.extend(entry.name.as_bytes());
    }
    let start = bytes.len() as u32;
    let count = entries.len() as u16;
    bytes.extend(&directory);
    bytes.extend([b"PK\x05\x06\0\0\0\0", &count.to_le_bytes()[..], &count.to_le_bytes()].concat());
    bytes.extend([(directory.len() as u32).to_le_bytes(), start.to_le_bytes()].concat());
    bytes.extend([0; 2]);
    bytes
}

/// Unpacks an archive, and expects that it is refused with this sentence and no file is written.
#[track_caller]
fn refuses(place: &CliFolder, bytes: &[u8], words: &str) {
    place.write("bad.zip", bytes);
    let before = place.listing(".");
    let run = place.sabi(&["unpack", "bad.zip", "-o", "out"]).fails(65);
    assert_eq!(run.stderr.trim_end(), format!("error: {words}"));
    assert_eq!(run.stdout, "");
    assert_eq!(place.listing("."), before, "{words}");
}

#[test]
fn an_archive_with_names_that_lead_out_or_that_some_system_cannot_hold_is_refused() {
    let place = CliFolder::new();
    for (name, why) in [
        ("../escaped", "its name leads out of the folder"),
        ("a/../../escaped", "its name leads out of the folder"),
        ("/etc/escaped", "its name leads out of the folder"),
        ("C:\\escaped", "its name leads out of the folder"),
        ("..\\escaped", "its name leads out of the folder"),
        ("a\\b", "Windows has no names with the character '\\\\'"),
        ("ab:stream", "Windows has no names with the character ':'"),
        ("a//b", "its name, or a part of it, is empty"),
        ("./a", "its name, or a part of it, is empty"),
        ("nul.png", "'nul.png' is the name of a device on Windows"),
        ("dir/COM1", "'COM1' is the name of a device on Windows"),
        ("a.", "Windows has no names that end in a dot or a space"),
        ("../escaped/", "its name leads out of the folder"),
    ] {
        let mode = if name.ends_with('/') { 0o040_755 } else { PLAIN.mode };
        let bytes = if name.ends_with('/') { b"" } else { PLAIN.bytes };
        let odd = StoredEntry {
            name,
            mode,
            bytes,
            ..PLAIN
        };
        let words = format!("the archive cannot hold '{name}': {why}");
        refuses(&place, &archive(&[PLAIN, odd]), &words);
    }
}

#[test]
fn an_archive_with_links_devices_or_doubled_names_is_refused() {
    let place = CliFolder::new();
    for mode in [0o120_777, 0o020_666, 0o010_644, 0o040_755] {
        let link = StoredEntry {
            name: "link",
            bytes: b"/etc/passwd",
            mode,
            ..PLAIN
        };
        let words = "'link' in the archive is no ordinary file but a link or a device, through which files elsewhere could be changed";
        refuses(&place, &archive(&[link]), words);
    }
    refuses(
        &place,
        &archive(&[PLAIN, PLAIN]),
        "the archive holds two files of one name",
    );
    let words = "the archive cannot hold 'A': 'a' is in the archive as well, and many disks take both names for one";
    refuses(&place, &archive(&[PLAIN, StoredEntry { name: "A", ..PLAIN }]), words);
    let words = "the archive cannot hold 'a/b': 'a' is in the archive as well, and many disks take both names for one";
    refuses(&place, &archive(&[PLAIN, StoredEntry { name: "a/b", ..PLAIN }]), words);
    let locked = StoredEntry { flags: 1, ..PLAIN };
    refuses(&place, &archive(&[locked]), "'a' in the archive is encrypted");
}

#[test]
fn an_archive_that_is_larger_than_it_claims_or_than_a_graph_can_be_is_refused() {
    let place = CliFolder::new();
    for claimed in [3, 30] {
        let claimed = Some(claimed);
        place.write("bad.zip", archive(&[StoredEntry { claimed, ..PLAIN }]));
        let run = place.sabi(&["unpack", "bad.zip", "-o", "out"]).fails(65);
        let words = "error: 'a' in the archive is damaged: ";
        assert!(run.stderr.starts_with(words), "{}", run.stderr);
        assert!(!place.path("out").exists());
        fs::remove_file(place.path("bad.zip")).unwrap();
        assert_eq!(place.listing("."), CliFolder::new().listing("."));
    }
    let names: Vec<String> = (0..10_001).map(|number| number.to_string()).collect();
    let many: Vec<StoredEntry<'_>> = names
        .iter()
        .map(|name| StoredEntry {
            name,
            bytes: b"",
            ..PLAIN
        })
        .collect();
    refuses(
        &place,
        &archive(&many),
        "the archive has 10001 entries, and at most 10000 are taken",
    );
    let huge: Vec<StoredEntry<'_>> = many[..9]
        .iter()
        .map(|entry| StoredEntry {
            claimed: Some(u32::MAX - 1),
            ..*entry
        })
        .collect();
    refuses(
        &place,
        &archive(&huge),
        "the archive unpacks to 36863 MiB, and at most 32768 are taken",
    );
}

#[test]
fn an_archive_brings_nothing_that_other_programs_act_on() {
    let place = CliFolder::new();
    let dotted =
        |name: &str| format!("'{name}' begins with a dot, as settings of other programs do, which no bake reads");
    let strange = || "it is no graph, node, model or picture, nor data of a model".to_owned();
    let manifest = br#"{ "format": "sabi-pack", "version": 1, "graph": "clouds.sabi", "model": null }"#;
    let text = graph(CLOUDS);
    for (name, why) in [
        (".git/config", dotted(".git")),
        (".envrc", dotted(".envrc")),
        ("files/.vscode/tasks.json", dotted(".vscode")),
        ("autorun.inf", strange()),
        ("sabi.toml", strange()),
        ("files/run.sh", strange()),
        ("desktop.ini", strange()),
        ("package.json", strange()),
        ("half.wgsl", "node files are in folders of nodes/ alone".to_owned()),
    ] {
        let archive = archive(&[
            StoredEntry {
                name: "clouds.sabi",
                bytes: text.as_bytes(),
                ..PLAIN
            },
            StoredEntry {
                name: "pack.json",
                bytes: manifest,
                ..PLAIN
            },
            StoredEntry { name, ..PLAIN },
        ]);
        refuses(
            &place,
            &archive,
            &format!("'{name}' in the archive is not unpacked: {why}"),
        );
    }
    let turned = StoredEntry {
        name: "photo_\u{202e}gnp.exe",
        ..PLAIN
    };
    let words = "the archive cannot hold 'photo_\\u{202e}gnp.exe': its name has the character U+202E, which is not seen and may show it \
                 as another name";
    refuses(&place, &archive(&[turned]), words);
}

#[test]
fn a_manifest_that_is_too_large_is_not_said_to_be_missing() {
    let place = CliFolder::new();
    let bytes = [&[b' '; 70_000][..], b"{}"].concat();
    let large = StoredEntry {
        name: "pack.json",
        bytes: &bytes,
        ..PLAIN
    };
    let words = "bad.zip is no packed graph: its pack.json has more than 64 KiB";
    refuses(&place, &archive(&[large]), words);
}

#[test]
fn a_damaged_archive_and_one_of_another_program_are_refused() {
    let place = CliFolder::new();
    let no_graph = |why: &str| format!("bad.zip is no packed graph: {why}");
    refuses(&place, &archive(&[PLAIN]), &no_graph("it has no pack.json"));
    let named = |json: &str| {
        let manifest = StoredEntry {
            name: "pack.json",
            bytes: json.as_bytes(),
            ..PLAIN
        };
        archive(&[PLAIN, manifest])
    };
    let manifest = |version: u32, graph: &str| {
        named(&format!(
            r#"{{ "format": "sabi-pack", "version": {version}, "graph": "{graph}", "model": null }}"#
        ))
    };
    refuses(
        &place,
        &manifest(1, "../a"),
        &no_graph("it names '../a', which is not in it"),
    );
    refuses(
        &place,
        &manifest(2, "a"),
        &no_graph("it was packed by a newer version of Sabi"),
    );
    let other = named(r#"{ "format": "other", "version": 1, "graph": "a", "model": null }"#);
    refuses(&place, &other, &no_graph("its pack.json is of another program"));
    // A flipped bit is found by the checksum.
    let mut tipped = manifest(1, "a");
    let at = tipped.windows(7).position(|window| window == b"content").unwrap();
    tipped[at] ^= 1;
    refuses(&place, &tipped, "'a' in the archive is damaged: Invalid checksum");
    for bytes in [
        &b""[..],
        b"PK\x03\x04",
        b"no archive at all",
        &tipped[..tipped.len() / 2],
    ] {
        place.write("bad.zip", bytes);
        let run = place.sabi(&["unpack", "bad.zip", "-o", "out"]).fails(65);
        let words = "error: bad.zip is no zip archive, or a damaged one: ";
        assert!(run.stderr.starts_with(words), "{}", run.stderr);
        assert!(!place.path("out").exists());
    }
    let gone = place.sabi(&["unpack", "gone.zip"]).fails(66);
    assert_eq!(gone.stderr, "error: gone.zip cannot be read: there is no such file\n");
}

#[test]
fn an_archive_in_place_of_a_graph_is_told_what_it_is() {
    let place = CliFolder::new();
    place.write(
        "clouds.zip",
        archive(&[StoredEntry {
            bytes: graph(CLOUDS).as_bytes(),
            ..PLAIN
        }]),
    );
    let words =
        "clouds.zip: this is a zip archive and no graph; if it is a packed graph, unpack it first with 'sabi unpack'";
    place.refuses("clouds.zip", "cube.glb", &[], 65, words);
    let check = place.sabi(&["check", "clouds.zip"]).fails(65);
    assert!(check.stderr.contains(words), "{}", check.stderr);
    let preview = [
        "preview",
        "clouds.zip",
        "--mesh",
        "cube.glb",
        "--node",
        "a",
        "-o",
        "a.png",
    ];
    let preview = place.sabi(&preview).fails(65);
    assert!(preview.stderr.contains(words), "{}", preview.stderr);
}
