use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;
use proptest::prelude::*;
use sabi_files::Disk;
use sabi_surface::patch::Site;

use super::{StrokeFileError, read, store};
use crate::step_bytes::{decode_step, encode_step};
use crate::{
    Action, Brush, BrushLimits, Eye, PictureName, PicturePart, PictureTip, Shaft, Stencil, Step, Stroke, StrokeBook,
    StrokePoint, Version,
};

fn stroke(points: usize) -> Stroke {
    let point = |index: usize| StrokePoint {
        site: Site {
            triangle: index as u32,
            position: DVec3::new(0.5, index as f64, -2.0),
        },
        normal: [0.0, 0.6, -0.8],
        triangle_key: 77 + index as u32,
        pressure: 0.25,
        starts: index == 0,
        shaft: None,
    };
    let brush = Brush {
        radius: 0.125,
        picture: Some(PictureTip {
            picture: PictureName::of(b"picture", "png").unwrap(),
            part: PicturePart::Dark,
        }),
        limits: BrushLimits {
            angle_degrees: 50.0,
            ..BrushLimits::default()
        },
        ..Brush::default()
    };
    Stroke {
        name: "first".to_owned(),
        action: Action::Clone,
        eye: Some(Eye::Place([1.0, 2.5, -3.0])),
        stencil: Some(Arc::new(Stencil {
            picture: PictureTip {
                picture: PictureName::of(b"stencil", "png").unwrap(),
                part: PicturePart::Colors,
            },
            picture_from_model: [[0.1, 0.2, 0.3, 1.0 / 3.0], [1.0, 0.0, 0.0, 4.0], [0.0, 1.0, 0.0, 5.0]],
        })),
        source: Some(StrokePoint {
            pressure: 1.0,
            ..point(9)
        }),
        ..Stroke::new(brush, (0..points).map(point).collect())
    }
}

/// Returns a book of three versions: with one stroke, with two strokes, and without the first stroke.
fn book() -> (StrokeBook, [Version; 3]) {
    let mut book = StrokeBook::default();
    let first = book.push(Version::EMPTY, &Step::Add(Arc::new(stroke(3))));
    let second = book.push(first, &Step::Add(Arc::new(stroke(5))));
    let third = book.push(second, &Step::Remove(vec![first]));
    (book, [first, second, third])
}

fn stored() -> (Vec<u8>, [Version; 3]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("crate.strokes");
    let (book, versions) = book();
    let mut known = BTreeSet::new();
    // Stored one after another, so that the later versions are appended.
    for version in versions {
        store(&Disk::default(), &file, "crate", &book, version, &mut known).unwrap();
    }
    (std::fs::read(&file).unwrap(), versions)
}

#[test]
fn strokes_that_are_stored_and_read_are_the_same() {
    let (bytes, versions) = stored();
    assert!(bytes.starts_with(b"sabi paint 1\nmodel: crate\n\n"));
    let (mut written, _) = book();
    let mut book = StrokeBook::default();
    let read = read(&bytes, &mut book).unwrap();
    assert_eq!(
        (read.model.as_str(), read.versions.len(), read.damaged_bytes),
        ("crate", 3, 0)
    );
    for version in versions {
        assert_eq!(book.list(version), written.list(version));
    }
    let last = book.list(versions[2]).unwrap();
    assert_eq!((last.strokes.len(), last.strokes[0].id), (1, versions[1]));
    assert_eq!(
        last.strokes[0].points[4].pressure,
        book.list(versions[0]).unwrap().strokes[0].points[0].pressure
    );
}

#[test]
fn strokes_of_brushes_without_newer_values_are_stored_under_the_same_name() {
    let (mut bytes, text) = (
        super::header("crate").into_bytes(),
        br#"{"add":{"brush":{"radius":0.5}}}"#,
    );
    let mut step = (text.len() as u32).to_le_bytes().to_vec();
    step.extend_from_slice(text);
    super::push_record(&mut bytes, Version::EMPTY, &step);
    let version = Version::EMPTY.after(&step);
    let mut book = StrokeBook::default();
    assert!(read(&bytes, &mut book).unwrap().versions.contains(&version));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("crate.strokes");
    store(&Disk::default(), &file, "crate", &book, version, &mut BTreeSet::new()).unwrap();
    assert_eq!(std::fs::read(&file).unwrap(), bytes);
}

/// Returns the stroke of a pen that leans at some of its points.
fn leaning_stroke() -> Stroke {
    let mut stroke = stroke(13);
    for (index, point) in stroke.points.iter_mut().enumerate() {
        let toward = DVec3::new(1.0, 0.5, index as f64);
        point.shaft = (index % 3 != 0).then(|| Shaft::along(toward).unwrap());
    }
    stroke
}

#[test]
fn a_step_without_a_leaning_pen_has_the_same_bytes_as_before() {
    let plain = Stroke {
        brush: Brush::default(),
        ..Stroke::new(Brush::default(), stroke(2).points)
    };
    let bytes = encode_step(&Step::Add(Arc::new(plain)));
    let text = concat!(
        r#"{"add":{"action":"paint","area":"way","brush":{"tip":"round","radius":0.05,"hardness":0.5,"flow":1.0,"opacity":1.0,"#,
        r#""spacing":0.15,"angle_degrees":0.0,"jitter":{"place":0.0,"size":0.0,"angle_degrees":0.0,"flow":0.0},"value":1.0,"#,
        r#""color":[0.5,0.5,0.5],"height":0.0,"limits":{"angle_degrees":180.0,"front_only":false,"seen_only":false},"#,
        r#""symmetry":{"mirrors":[false,false,false],"turns":0},"reaches_pieces":true,"pressure":{"radius":0.0,"flow":1.0}}}}"#
    );
    assert_eq!(std::str::from_utf8(&bytes[4..bytes.len() - 2 * 26]), Ok(text));
}

#[test]
fn the_lean_of_the_pen_is_stored_in_files_and_texts() {
    let written = Arc::new(leaning_stroke());
    let mut book = StrokeBook::default();
    let version = book.push(Version::EMPTY, &Step::Add(Arc::clone(&written)));
    let read = &book.list(version).unwrap().strokes[0];
    let shafts = |stroke: &Stroke| stroke.points.iter().map(|point| point.shaft).collect::<Vec<_>>();
    assert_eq!(shafts(read), shafts(&written));
    assert_eq!(read.source.unwrap().shaft, None);
    let text = crate::strokes_as_text(&[Arc::clone(read)]);
    let [back] = crate::strokes_from_text(&text).unwrap().try_into().unwrap();
    assert_eq!(shafts(&back), shafts(&written));
    let cut = text.replace(r#""shafts":[null,"#, r#""shafts":["#);
    assert_eq!(crate::strokes_from_text(&cut), Err(crate::NoStrokes::Other));
    let placed = Step::Place {
        stroke: version,
        points: written.points.clone(),
        path: None,
        eye: None,
        stencil: None,
    };
    let moved = book.push(version, &placed);
    assert_eq!(shafts(&book.list(moved).unwrap().strokes[0]), shafts(&written));
}

#[test]
fn a_step_with_shafts_is_read_completely_or_not_at_all() {
    for count in 1..40 {
        let mut leaning = leaning_stroke();
        leaning.source = None;
        leaning.points = (0..count).map(|index| leaning.points[1 + index % 2]).collect();
        let bytes = encode_step(&Step::Add(Arc::new(leaning)));
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        assert_ne!((bytes.len() - 4 - length) % 26, 0, "{count}: as long as points alone");
        assert!(decode_step(&bytes, Version::EMPTY).is_some());
        for cut in [1, 2, 4, 5, 26, 31] {
            assert!(
                decode_step(&bytes[..bytes.len() - cut], Version::EMPTY).is_none(),
                "{count} {cut}"
            );
        }
    }
}

#[test]
fn a_stroke_that_is_moved_changes_only_its_points() {
    let (mut book, [first, ..]) = book();
    let points = stroke(2).points;
    let moved = book.push(
        first,
        &Step::Place {
            stroke: first,
            points: points.clone(),
            path: None,
            eye: Some(Eye::Toward([0.0, 0.0, 1.0])),
            stencil: None,
        },
    );
    let (before, after) = (book.list(first).unwrap(), book.list(moved).unwrap());
    let expected = Stroke {
        points,
        eye: Some(Eye::Toward([0.0, 0.0, 1.0])),
        ..Stroke::clone(&before.strokes[0])
    };
    let placed = &after.strokes[0];
    assert_eq!(
        (placed.id, &placed.brush, placed.source, placed.points.len()),
        (first, &expected.brush, expected.source, 2)
    );
}

#[test]
fn a_stroke_is_the_same_in_memory_in_every_version_that_has_it() {
    let (mut book, [first, second, _]) = book();
    let (one, two) = (book.list(first).unwrap(), book.list(second).unwrap());
    assert!(Arc::ptr_eq(&one.strokes[0], &two.strokes[0]));
}

#[test]
fn a_damaged_file_loses_only_its_damaged_parts() {
    let (bytes, versions) = stored();
    let mut cut = bytes.clone();
    cut.truncate(bytes.len() - 3);
    let mut book = StrokeBook::default();
    let whole = read(&cut, &mut book).unwrap();
    assert_eq!(whole.versions.len(), 2);
    assert!(whole.damaged_bytes > 0 && book.list(versions[1]).is_some() && book.list(versions[2]).is_none());
    // A byte in the middle of the second record is changed. The first and the third record are complete, but the third
    // builds on the second.
    let second = bytes
        .windows(4)
        .enumerate()
        .filter(|(_, window)| *window == b"SPR1")
        .nth(1)
        .unwrap()
        .0;
    let mut flipped = bytes.clone();
    flipped[second + 30] ^= 1;
    let mut book = StrokeBook::default();
    let damaged = read(&flipped, &mut book).unwrap();
    assert_eq!(damaged.versions.len(), 2);
    assert_eq!(damaged.last, Some(versions[2]));
    // The second stroke is lost, but not the later ones.
    assert_eq!(book.list(versions[0]).unwrap().strokes.len(), 1);
    assert_eq!(book.list(versions[2]).unwrap().strokes.len(), 0);
}

#[test]
fn other_and_newer_files_are_refused() {
    let mut book = StrokeBook::default();
    assert_eq!(read(b"\x89PNG\r\n", &mut book).unwrap_err(), StrokeFileError::NoStrokes);
    assert_eq!(
        read(b"sabi paint 2\nmodel: a\n\n", &mut book).unwrap_err(),
        StrokeFileError::Newer
    );
    assert_eq!(
        StrokeFileError::Newer.to_string(),
        "it was written by a newer version of Sabi"
    );
}

#[test]
fn a_version_whose_steps_are_unknown_is_not_stored() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("crate.strokes");
    let unknown: Version = "0123456789abcdef".parse().unwrap();
    let error = store(
        &Disk::default(),
        &file,
        "crate",
        &StrokeBook::default(),
        unknown,
        &mut BTreeSet::new(),
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "the strokes of version 0123456789abcdef are not known"
    );
    assert!(!file.exists());
}

#[test]
fn nan_is_replaced_by_the_numbers_of_the_usual_brush() {
    let mut odd = stroke(1);
    odd.brush.radius = f32::NAN;
    odd.brush.opacity = f32::INFINITY;
    odd.points[0].pressure = 7.0;
    let mut book = StrokeBook::default();
    let version = book.push(Version::EMPTY, &Step::Add(Arc::new(odd)));
    let kept = &book.list(version).unwrap().strokes[0];
    assert_eq!((kept.brush.radius, kept.brush.opacity), (Brush::default().radius, 1.0));
    assert_eq!(kept.points[0].pressure, 1.0);
}

#[test]
fn a_stroke_that_no_file_could_store_changes_nothing() {
    let mut book = StrokeBook::default();
    let first = book.push(Version::EMPTY, &Step::Add(Arc::new(stroke(3))));
    let huge = Arc::new(stroke((1 << 20) + 1));
    assert_eq!(book.push(first, &Step::Add(Arc::clone(&huge))), first);
    let text = crate::strokes_as_text(&[huge]);
    assert_eq!(crate::strokes_from_text(&text), Err(crate::NoStrokes::Other));
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(change in prop::collection::vec((0_usize..2000, any::<u8>()), 0..20), cut in 0_usize..2000) {
        let (mut bytes, _) = stored();
        for (at, value) in change {
            let length = bytes.len();
            bytes[at % length] = value;
        }
        bytes.truncate(cut.min(bytes.len()));
        let mut book = StrokeBook::default();
        if let Ok(read) = read(&bytes, &mut book) {
            for version in read.versions {
                let _ = book.list(version);
            }
        }
    }
}
