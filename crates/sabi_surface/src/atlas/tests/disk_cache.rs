//! Atlases in the disk cache.

use std::fs;

use super::shapes::*;
use crate::atlas::{Atlas, AtlasOptions, atlas_key, cached};

#[test]
fn an_atlas_is_read_back_from_disk_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    for (mesh, size) in [(cube(3), 128), (ball(8), 64)] {
        for page_limit in [8192, 104] {
            let options = AtlasOptions {
                page_limit,
                ..AtlasOptions::new(size)
            };
            let (built, from_disk) = cached(Some(folder.path()), &mesh, &options).unwrap();
            assert!(!from_disk);
            let (read, from_disk) = cached(Some(folder.path()), &mesh, &options).unwrap();
            assert!(from_disk);
            assert_eq!(built, read);
            assert_eq!(built, Atlas::build(&mesh, &options).unwrap());
        }
    }
    let names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(names.len(), 4);
    assert!(
        names.iter().all(|name| name.to_str().unwrap().ends_with(".bin")),
        "{names:?}"
    );
}

#[test]
fn a_damaged_file_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let (mesh, options) = (cube(2), AtlasOptions::new(64));
    let (built, _) = cached(Some(folder.path()), &mesh, &options).unwrap();
    let file = fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    let whole = fs::read(&file).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 4;
    let mut longer = whole.clone();
    longer.push(0);
    for damaged in [
        &whole[..whole.len() - 1],
        &whole[..40],
        &[],
        &flipped,
        &longer,
        b"sabi cache\r\n",
    ] {
        fs::write(&file, damaged).unwrap();
        let (again, from_disk) = cached(Some(folder.path()), &mesh, &options).unwrap();
        assert!(!from_disk);
        assert_eq!(again, built);
        assert_eq!(fs::read(&file).unwrap(), whole);
    }
}

#[test]
fn bytes_that_only_resemble_an_atlas_are_refused() {
    let bytes = crate::atlas::codec::encode(&Atlas::build(&cube(1), &AtlasOptions::new(32)).unwrap());
    let mut dice = PcgRandom(11);
    for _ in 0..2000 {
        let mut damaged = bytes.clone();
        let at = dice.next() as usize % bytes.len();
        damaged[at] = dice.next() as u8;
        damaged.truncate(bytes.len() - (dice.next() % 3) as usize * 7);
        // Damaged bytes may or may not decode, but must never cause a panic.
        let _ = crate::atlas::codec::decode(&damaged);
    }
    assert!(crate::atlas::codec::decode(&bytes[..bytes.len() - 1]).is_none());
}

#[test]
fn a_cache_that_cannot_be_written_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "in the way").unwrap();
    let (atlas, from_disk) = cached(Some(&file), &cube(1), &AtlasOptions::new(64)).unwrap();
    assert!(!from_disk);
    let warning = atlas.report.warnings.last().unwrap();
    assert!(
        warning.starts_with(&format!("the atlas could not be kept in {}", file.display())),
        "{warning}"
    );
    assert!(
        warning.ends_with("free some space there or choose another cache folder"),
        "{warning}"
    );
    assert!(!cached(None, &cube(1), &AtlasOptions::new(64)).unwrap().1);
}

#[test]
fn the_key_changes_with_everything_that_changes_the_atlas() {
    let (mesh, options) = (cube(1), AtlasOptions::new(64));
    let key = atlas_key(&mesh, &options);
    assert_eq!(key, atlas_key(&mesh.clone(), &options));
    assert_ne!(key, atlas_key(&mesh, &AtlasOptions::new(65)));
    assert_ne!(
        key,
        atlas_key(
            &mesh,
            &AtlasOptions {
                page_limit: 4096,
                ..AtlasOptions::new(64)
            }
        )
    );
    let changes: [fn(&mut crate::model::Mesh); 5] = [
        |mesh| mesh.positions[0][1] += 0.5,
        |mesh| mesh.uvs[3][0] += 0.01,
        |mesh| mesh.triangles.swap(0, 1),
        |mesh| mesh.triangle_material[0] = 1,
        |mesh| mesh.triangle_part[0] = 1,
    ];
    for change in changes {
        let mut other = mesh.clone();
        change(&mut other);
        assert_ne!(key, atlas_key(&other, &options));
    }
}
