//! Pictures of brushes, which are stored beside the strokes that use them.

use std::path::Path;
use std::sync::Arc;

use sabi_image::{PngData, PngOptions, encode_png};
use sabi_paint::{Brush, PictureName, PicturePart, PictureTip, Step, Stroke, StrokeList, Version};

use super::*;

const MODEL: &str = "crate";

fn png() -> Vec<u8> {
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: true,
    };
    encode_png(2, 1, PngData::U8(&[255, 0, 0, 0, 0, 255]), options).unwrap()
}

/// Returns a session of a new file whose node `p` has a stroke with a picture.
pub(super) fn painted(file: &Path) -> (Session, PictureName) {
    let mut session = Session::new(None);
    session.save_as(file).unwrap();
    let strokes = session.graph().strokes.clone();
    let picture = strokes.keep_picture(png(), "png").unwrap();
    let brush = Brush {
        picture: Some(PictureTip {
            picture: picture.clone(),
            part: PicturePart::Colors,
        }),
        ..Brush::default()
    };
    let step = Step::Add(Arc::new(Stroke::new(brush, Vec::new())));
    let mut node = Node::new("source/paint");
    let versions = strokes.after(file, MODEL, "", &step);
    node.params.insert("strokes".to_owned(), Value::Text(versions));
    let edit = Edit::AddNode {
        body: Body::Main,
        id: "p".parse().unwrap(),
        node,
        inputs: BTreeMap::new(),
    };
    session.edit("Add", edit).unwrap();
    session.save().unwrap();
    (session, picture)
}

/// The list of the node `p`, and its version.
fn list(session: &Session) -> (Arc<StrokeList>, Version) {
    let Some(Value::Text(version)) = session.document().graph.node("p").unwrap().params.get("strokes") else {
        panic!("the node names no strokes");
    };
    let open = session.graph();
    let list = open.strokes.on_model(&open.path, MODEL, version).unwrap();
    (list, version.parse().unwrap())
}

/// Returns the names of pictures that strokes of a graph use but that are missing.
pub(super) fn missing(session: &Session) -> Vec<PictureName> {
    let open = session.graph();
    open.strokes.missing_pictures(&open.path, list(session).1)
}

#[test]
fn a_picture_lies_beside_the_strokes_as_it_was_and_is_found_again() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let (_, picture) = painted(&file);
    let stored = desk.path().join("a.paint/pictures").join(picture.as_str());
    assert_eq!(fs::read(&stored).unwrap(), png());
    let session = Session::open(&file, None).unwrap();
    assert!(missing(&session).is_empty());
    assert_eq!(session.graph().strokes.picture(&picture).unwrap().size(), [2, 1]);
}

#[test]
fn a_picture_goes_along_when_the_graph_is_saved_elsewhere() {
    let desk = desk();
    let (file, other) = (desk.path().join("a.sabi"), desk.path().join("other/b.sabi"));
    painted(&file);
    fs::create_dir(other.parent().unwrap()).unwrap();
    Session::open(&file, None).unwrap().save_as(&other).unwrap();
    assert!(missing(&Session::open(&other, None).unwrap()).is_empty());
}

#[test]
fn a_picture_that_is_gone_or_was_changed_is_missed_and_another_result_than_with_it() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let (_, picture) = painted(&file);
    let stored = desk.path().join("a.paint/pictures").join(picture.as_str());
    fs::write(&stored, b"something else").unwrap();
    assert_eq!(
        missing(&Session::open(&file, None).unwrap()),
        std::slice::from_ref(&picture)
    );
    fs::remove_file(&stored).unwrap();
    let session = Session::open(&file, None).unwrap();
    assert_eq!(missing(&session), [picture]);
    fs::write(&stored, png()).unwrap();
    assert!(missing(&session).is_empty(), "it is looked for again");
}

#[test]
fn what_is_no_picture_is_refused_with_its_name() {
    let desk = desk();
    let file = desk.path().join("note.png");
    fs::write(&file, b"no picture").unwrap();
    let strokes = crate::source::Strokes::default();
    let refused = strokes.take_picture(&file).unwrap_err();
    assert!(refused.contains("note.png"), "{refused}");
    let gone = strokes.take_picture(&desk.path().join("gone.png")).unwrap_err();
    assert!(gone.contains("gone.png"), "{gone}");
}

#[test]
fn a_damaged_picture_is_not_read_again_until_its_file_changes() {
    let desk = desk();
    let file = desk.path().join("a.sabi");
    let (_, picture) = painted(&file);
    let stored = desk.path().join("a.paint/pictures").join(picture.as_str());
    let time = fs::metadata(&stored).unwrap().modified().unwrap();
    let write = |bytes: &[u8], time| {
        fs::write(&stored, bytes).unwrap();
        let written = fs::File::options().write(true).open(&stored).unwrap();
        written.set_modified(time).unwrap();
    };
    write(&vec![0; png().len()], time);
    let session = Session::open(&file, None).unwrap();
    assert_eq!(missing(&session), std::slice::from_ref(&picture));
    write(&png(), time);
    assert_eq!(
        missing(&session),
        [picture],
        "the file looks the same, so it is not read"
    );
    write(&png(), time + std::time::Duration::from_secs(2));
    assert!(missing(&session).is_empty(), "it is another file now");
}
