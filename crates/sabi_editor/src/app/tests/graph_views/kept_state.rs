//! State that is kept: choices between runs, and a bounded number of results.

use egui::Modifiers;
use sabi_editing::nodes;
use sabi_engine::Session;
use sabi_view::{Background, ViewTransform};

use super::super::Window;
use super::super::hands::id;

/// Nodes of one kind with different seeds.
fn many(count: usize) -> String {
    let node = |at: usize| {
        let place = at * 260;
        format!(r#""n{at}": {{ "kind": "noise/white", "params": {{ "seed": {at} }}, "pos": [{place}, 0] }}"#)
    };
    (0..count).map(node).collect::<Vec<_>>().join(",")
}

#[test]
fn pictures_of_deleted_nodes_are_released() {
    const COUNT: usize = 12;
    let mut window = Window::opened(&many(COUNT));
    window.until_model();
    for at in 0..COUNT {
        window.harness.state_mut().look_at(&id(&format!("n{at}")), None);
        window.until("its picture", |editor| {
            editor.evaluation.results.picture(&editor.seen()).is_some() && !editor.evaluation.is_busy()
        });
    }
    let [pictures, thumbnails, times] = window.editor().evaluation.results.counts();
    assert!(pictures <= 8, "{pictures} pictures of the model");
    assert!(thumbnails <= COUNT && times <= COUNT, "{thumbnails} {times}");
    let all = (0..COUNT).map(|at| id(&format!("n{at}")));
    let document = &mut window.harness.state_mut().documents.document;
    document.select(all.skip(1));
    nodes::delete(document, false);
    window.until("the end of it", |editor| {
        let [pictures, thumbnails, times] = editor.evaluation.results.counts();
        pictures <= 2 && thumbnails <= 1 && times <= 1 && !editor.evaluation.is_busy()
    });
    window.undo(1);
    window.until("the pictures that were let go of", |editor| {
        (0..COUNT).all(|at| editor.thumbnail_of(&id(&format!("n{at}"))).is_some())
    });
}

#[test]
fn choices_of_the_views_are_restored_in_the_next_run() {
    let mut window = Window::untitled();
    let editor = window.harness.state_mut();
    let shot = &mut editor.views.model.shot;
    shot.exposure_stops = 1.5;
    shot.transform = ViewTransform::Standard;
    shot.background = Background::Environment;
    shot.has_relief = true;
    window.point(window.on_canvas([0.5, 0.5]));
    window.key(egui::Key::N);
    window.keys(Modifiers::SHIFT, egui::Key::V);
    window.harness.state_mut().save_settings();
    let Window { harness, folder, .. } = window;
    drop(harness);
    let again = Window::in_folder(folder, |folders| Session::new(folders.recovery.as_deref()));
    let editor = again.editor();
    let shot = &editor.views.model.shot;
    assert_eq!((shot.exposure_stops, shot.transform), (1.5, ViewTransform::Standard));
    assert!(shot.background == Background::Environment && shot.has_relief);
    assert!(editor.shell.settings.has_mini_map && !editor.shell.settings.follows);
}
