//! Links among files of strokes lead only where their graph may read.

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use sabi_files::TrustedPaths;

use super::strokes::{known, name, painted, stroke, versions};
use super::*;

/// Paints a stroke, and returns the reason why it is not stored.
fn refused(session: &mut Session) -> String {
    let open = session.graph();
    let versions = open.strokes.after(&open.path, "crate", &versions(session), &stroke());
    name(session, versions);
    session.keep_strokes().unwrap_err().to_string()
}

/// Moves a file or folder to `to`, and puts a link in its place.
fn replaced_by_link(file: &Path, to: &Path) {
    fs::rename(file, to).unwrap();
    symlink(to, file).unwrap();
}

fn outside(file: &Path) -> String {
    format!(
        "{} is outside of the folder of the file that names it and of the folders that you trust",
        sabi_files::canonical(file).unwrap().display()
    )
}

/// A graph whose strokes are in the file, and a folder elsewhere.
fn places() -> [TempDir; 2] {
    [desk(), desk()]
}

#[test]
fn a_link_among_strokes_is_followed_only_where_the_graph_may_read() {
    let [desk, elsewhere] = places();
    let (session, file) = painted(&desk, 1);
    drop(session);
    let (link, moved) = (
        desk.path().join("a.paint/crate.strokes"),
        elsewhere.path().join("b.strokes"),
    );
    replaced_by_link(&link, &moved);
    let before = fs::read(&moved).unwrap();
    let mut session = Session::open(&file, None).unwrap();
    assert_eq!(known(&session), 0);
    let told = format!("{} is not read: {}", link.display(), outside(&moved));
    assert_eq!(session.graph().strokes.faults(&file), std::slice::from_ref(&told));
    let why = refused(&mut session);
    assert_eq!(why, format!("strokes are not stored, since {told}; move the file away"));
    assert_eq!(fs::read(&moved).unwrap(), before);
    session.undo().unwrap();
    session.trust(&TrustedPaths::default().with_path(elsewhere.path()));
    assert_eq!(known(&session), 1);
}

#[test]
fn a_picture_of_a_brush_that_is_a_link_is_followed_only_where_the_graph_may_read() {
    let [desk, elsewhere] = places();
    let file = desk.path().join("a.sabi");
    let (session, picture) = super::brush_pictures::painted(&file);
    drop(session);
    let pictures: PathBuf = desk.path().join("a.paint/pictures");
    replaced_by_link(&pictures.join(picture.as_str()), &elsewhere.path().join("b.png"));
    let mut session = Session::open(&file, None).unwrap();
    assert_eq!(super::brush_pictures::missing(&session), [picture]);
    session.trust(&TrustedPaths::default().with_path(elsewhere.path()));
    assert_eq!(super::brush_pictures::missing(&session), []);
}

#[test]
fn strokes_are_not_written_through_links_out_of_the_graphs_folder() {
    let [desk, elsewhere] = places();
    let (mut session, _) = painted(&desk, 0);
    symlink(elsewhere.path(), desk.path().join("a.paint")).unwrap();
    super::strokes::add_node(&mut session);
    let why = refused(&mut session);
    assert_eq!(why, format!("strokes are not stored: {}", outside(elsewhere.path())));
    fs::remove_file(desk.path().join("a.paint")).unwrap();
    fs::create_dir(desk.path().join("a.paint")).unwrap();
    let link = desk.path().join("a.paint/crate.strokes");
    symlink(elsewhere.path().join("new"), &link).unwrap();
    let why = refused(&mut session);
    let told = format!(
        "strokes are not stored, since {} is a link to a file that does not exist; move the file away",
        link.display()
    );
    assert_eq!(why, told);
    assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 0);
}
