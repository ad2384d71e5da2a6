//! Large graphs: nodes outside of the panel cost nothing, and nothing is drawn while nothing changes.

use std::time::Duration;

use egui::ViewportId;
use egui_kittest::kittest::{Queryable, by};

use super::Window;
use super::hands::id;

/// Five hundred nodes in a grid of 25 by 20.
fn field() -> String {
    let nodes = (0..500).map(|at| {
        let pos = [at % 25 * 260, at / 25 * 330];
        format!(
            r#""node_{at:03}": {{ "kind": "adjust/invert", "pos": [{}, {}] }}"#,
            pos[0], pos[1]
        )
    });
    nodes.collect::<Vec<_>>().join(",\n")
}

fn inverts(window: &Window) -> usize {
    let canvas = window.editor().shell.dock.rects[&crate::dock::Panel::Canvas];
    let found = window.harness.query_all(by().label("Invert"));
    found.filter(|node| canvas.intersects(node.rect())).count()
}

/// Number of nodes on the visible part of the canvas.
fn seen_nodes(window: &Window) -> usize {
    let camera = &window.editor().views.canvas.camera;
    camera.visible_nodes(window.document()).len()
}

#[test]
fn of_five_hundred_nodes_only_the_visible_ones_are_drawn() {
    let mut window = Window::opened(&field());
    assert_eq!(window.document().graph().len(), 500);
    let at = window.on_canvas([0.5, 0.5]);
    window.wheel(at, 5000.0);
    window.wheel(at, -300.0);
    let seen = seen_nodes(&window);
    assert!((1..30).contains(&seen), "{seen}");
    assert_eq!(inverts(&window), seen);
    window.wheel(at, -5000.0);
    let seen = seen_nodes(&window);
    assert_eq!(inverts(&window), seen);
    assert!(seen > 300, "from afar {seen} are seen");
}

#[test]
fn nothing_is_drawn_while_nothing_changes() {
    let mut window = Window::opened(r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#);
    let wants = |window: &Window| window.harness.output().viewport_output[&ViewportId::ROOT].repaint_delay;
    window.until("a picture", |editor| editor.thumbnail_of(&id("clouds")).is_some());
    window.until("the model", |editor| {
        editor.views.model.pictures.drawn > 0 && !editor.evaluation.is_busy()
    });
    for _ in 0..400 {
        if wants(&window) > Duration::from_secs(60) {
            break;
        }
        window.harness.step();
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(
        wants(&window) > Duration::from_secs(60),
        "{:?}",
        window.harness.ctx.repaint_causes()
    );
    let drawn = window.editor().views.model.pictures.drawn;
    window.harness.run_steps(5);
    assert_eq!(
        window.editor().views.model.pictures.drawn,
        drawn,
        "the model is not drawn anew"
    );
}
