//! The menu of nodes: its list for the selected node.

use egui::Key;

use super::Window;
use super::hands::id;

const NODES: &str = r#""clouds": { "kind": "noise/simplex", "pos": [0, 0] }"#;

#[test]
fn the_menu_offers_nodes_that_fit_the_selected_one_and_connects_them() {
    let mut window = Window::opened(NODES);
    window.click_at(window.title(&id("clouds")));
    window.point(window.on_canvas([0.8, 0.8]));
    window.key(Key::Tab);
    assert!(
        window.has("Connect to Clouds") && window.has("Cells"),
        "all nodes are listed at first"
    );
    window.key(Key::Tab);
    assert!(!window.has("Position"), "it takes nothing");
    window.typed("invert");
    window.key(Key::Enter);
    let added = window.document().selected_one().expect("the new node").clone();
    assert_eq!(window.reads(&added, "source"), "clouds");
    // Without the second Tab, the new node is not connected.
    window.point(window.on_canvas([0.8, 0.2]));
    window.key(Key::Tab);
    window.typed("invert");
    window.key(Key::Enter);
    let other = window.document().selected_one().expect("the new node").clone();
    assert!(other != added && window.reads(&other, "source").is_empty());
}
