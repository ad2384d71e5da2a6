//! Files are examined without decoding, read again after they are saved, and pictures are kept within limits.

use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use sabi_image::Pixels;
use sabi_plan::FileFaultKind;

use super::{OpenPicture, PixelReading, SessionPictures};
use crate::source::mip_chain::PixelCurve;

/// Returns a BMP of 2 by 2 pixels, all of the same gray.
pub(in crate::source) fn bmp(gray: u8) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [70_u32, 0, 54, 40, 2, 2, 1 | 24 << 16, 0, 16, 2835, 2835, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    // Two rows of two pixels, each padded to a multiple of four bytes.
    bytes.extend([gray, gray, gray, gray, gray, gray, 0, 0].repeat(2));
    bytes
}

/// Saves a picture with a modification time of so many seconds after the start of 1970.
fn save(path: &Path, bytes: &[u8], second: u64) {
    fs::write(path, bytes).unwrap();
    let file = File::options().write(true).open(path).unwrap();
    let time = SystemTime::UNIX_EPOCH + Duration::from_secs(second);
    file.set_modified(time).unwrap();
}

fn gray(picture: &OpenPicture) -> u8 {
    match &picture.picture.pixels {
        Pixels::U8(values) => values[0],
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_picture_saved_again_is_seen_by_the_next_plan() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bmp");
    let pictures = SessionPictures::default();
    save(&path, &bmp(10), 1);
    let first = pictures.content(&path, "a.bmp").unwrap();
    assert_eq!(gray(&pictures.open(&path, "a.bmp", "").unwrap()), 10);
    save(&path, &bmp(20), 2);
    // An earlier plan still reads the content for which it was made.
    assert_eq!(gray(&pictures.open(&path, "a.bmp", "").unwrap()), 10);
    assert_ne!(pictures.content(&path, "a.bmp").unwrap(), first);
    assert_eq!(gray(&pictures.open(&path, "a.bmp", "").unwrap()), 20);
    save(&path, &bmp(10), 3);
    assert_eq!(pictures.content(&path, "a.bmp").unwrap(), first);
    fs::remove_file(&path).unwrap();
    assert!(pictures.content(&path, "a.bmp").unwrap_err().1 == FileFaultKind::Missing);
}

#[test]
fn no_result_is_kept_under_the_name_of_another_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bmp");
    let pictures = SessionPictures::default();
    save(&path, &bmp(10), 1);
    pictures.content(&path, "a.bmp").unwrap();
    save(&path, &bmp(20), 2);
    let (why, kind) = pictures.open(&path, "a.bmp", "").err().unwrap();
    assert_eq!(
        why,
        "a.bmp was saved again while it was in use; try again to use the new version"
    );
    assert_eq!(kind, FileFaultKind::Unusable);
}

#[test]
fn nothing_is_decoded_before_it_is_used() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bmp");
    let pictures = SessionPictures::default();
    save(&path, &bmp(10)[..60], 1);
    pictures.content(&path, "a.bmp").unwrap();
    assert!(pictures.lock().decoded.is_empty());
    let (why, _) = pictures.open(&path, "a.bmp", "").err().unwrap();
    assert!(why.starts_with("a.bmp is a damaged BMP file"), "{why}");
}

#[test]
fn the_picture_that_was_not_used_for_longest_goes_first() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = SessionPictures::default();
    let [a, b, c] = ["a.bmp", "b.bmp", "c.bmp"].map(|name| folder.path().join(name));
    for (path, gray) in [(&a, 1), (&b, 2), (&c, 3)] {
        save(path, &bmp(gray), 1);
        pictures.open(path, "x.bmp", "").unwrap();
    }
    pictures.open(&a, "x.bmp", "").unwrap();
    let kept = |limit: u64| {
        let mut cache = pictures.lock();
        cache.evict(limit);
        cache
            .decoded
            .iter()
            .map(|(_, picture)| gray(picture))
            .collect::<Vec<_>>()
    };
    // 2 × 2 pixels of three bytes each.
    assert_eq!(kept(36), [2, 3, 1]);
    assert_eq!(kept(35), [3, 1]);
    assert_eq!(kept(0), [1]);
    // Its single smaller copy counts as well: a pixel of four floats.
    let last = pictures.open(&a, "x.bmp", "").unwrap();
    last.levels(
        PixelReading {
            curve: PixelCurve::Linear,
            by_alpha: true,
        },
        1,
    );
    assert_eq!(last.bytes(), 12 + 16);
}

#[test]
fn a_picture_of_a_model_is_decoded_once() {
    let pictures = SessionPictures::default();
    let open = |gray: u8| {
        let bytes = bmp(gray);
        pictures
            .open_bytes("rust.bmp", &bytes, *blake3::hash(&bytes).as_bytes())
            .unwrap()
    };
    let [first, second, other] = [7, 7, 8].map(open);
    assert!(Arc::ptr_eq(&first, &second) && !Arc::ptr_eq(&first, &other));
    // A picture that is in use is never decoded a second time, whether it is kept or not.
    pictures.lock().evict(0);
    assert_eq!(pictures.lock().decoded.len(), 1);
    assert!(Arc::ptr_eq(&first, &open(7)));
    drop((first, second));
    pictures.lock().evict(0);
    open(8);
    pictures.lock().evict(0);
    assert!(pictures.lock().others.len() <= 1, "what nothing shows is forgotten");
}
