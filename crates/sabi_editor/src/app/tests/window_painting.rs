//! The window paints more than its background.

use std::collections::BTreeSet;

use egui::Rect;
use sabi_editing::node_size::{MARGIN, PICTURE_SIDE};

use super::Window;
use super::hands::id;
use crate::dock::Panel;

/// Colors in a part of the screen.
fn colors(window: &mut Window, part: Rect) -> BTreeSet<[u8; 4]> {
    let picture = window.harness.render().expect("a picture of the window");
    let [left, right] = [part.left(), part.right()].map(|at| at.max(0.0) as u32);
    let [top, bottom] = [part.top(), part.bottom()].map(|at| at.max(0.0) as u32);
    let texels = (left..right.min(picture.width())).flat_map(|x| {
        let rows = top..bottom.min(picture.height());
        rows.map(move |y| (x, y))
    });
    texels.map(|(x, y)| picture.get_pixel(x, y).0).collect()
}

#[test]
fn the_model_and_the_pictures_on_nodes_are_on_the_screen() {
    let mut window = Window::opened(r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    window.until("the picture of the node", |editor| {
        editor.thumbnail_of(&id("clouds")).is_some()
    });
    window.until("the model", |editor| {
        editor.views.model.pictures.drawn > 0 && !editor.evaluation.is_busy()
    });
    let viewport = window.editor().shell.dock.rects[&Panel::Viewport].shrink(60.0);
    let shown = colors(&mut window, viewport).len();
    assert!(shown > 100, "{shown} colors where the model is");
    let node = window.rect(&id("clouds"));
    let side = (PICTURE_SIDE - 8.0) * window.zoom();
    let bottom = node.bottom() - MARGIN * window.zoom() - 4.0;
    let picture = Rect::from_min_max(
        egui::pos2(node.center().x - side / 2.0, bottom - side),
        egui::pos2(node.center().x + side / 2.0, bottom),
    );
    let shown = colors(&mut window, picture).len();
    assert!(shown > 50, "{shown} colors in the picture of the noise");
}
