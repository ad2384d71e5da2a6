//! Notes on the canvas: written, moved, resized, colored and removed.

use egui::{Event, Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use sabi_graph::Note;

use super::Window;
use crate::dock::Panel;

const NOTED: &str = r#"{ "format": "sabi", "version": 1,
  "notes": { "note_a": { "text": "Rust", "pos": [0, 0], "width": 200 } },
  "nodes": { "far": { "kind": "noise/white", "pos": [220, 60] } } }"#;

fn note(window: &Window) -> Option<Note> {
    window.document().graph().notes().get("note_a").cloned()
}

#[test]
fn a_note_is_moved_resized_colored_rewritten_and_removed_each_as_a_step() {
    let mut window = Window::of(NOTED);
    // Moves the note to where nothing lies over it.
    let rect = window.harness.get_by_label("Note: Rust").rect();
    window.drag_from(rect.center(), rect.center() + vec2(0.0, 60.0));
    let zoom = window.zoom();
    let moved = note(&window).expect("the note");
    assert!(
        (moved.pos[1] - 60.0 / zoom).abs() < 1.0 && moved.pos[0].abs() < 1.0,
        "{moved:?}"
    );
    let rect = window.harness.get_by_label("Note: Rust").rect();
    let corner = rect.max - vec2(4.0, 4.0) * zoom;
    window.drag_from(corner, corner + vec2(50.0, 0.0));
    let wide = note(&window).expect("the note");
    assert!((wide.width - 200.0 - 50.0 / zoom).abs() < 1.0, "{wide:?}");
    assert_eq!(wide.pos, moved.pos);
    window.double_click(rect.center());
    window.harness.event(Event::Text(" and moss".to_owned()));
    window.settle();
    window.keys(Modifiers::COMMAND, Key::Enter);
    assert_eq!(note(&window).expect("the note").text, "Rust and moss");
    // Text before Escape is kept, too.
    window.double_click(rect.center());
    window.harness.event(Event::Text(" below".to_owned()));
    window.settle();
    window.key(Key::Escape);
    assert_eq!(note(&window).expect("the note").text, "Rust and moss below");
    let at = window.harness.get_by_label("Note: Rust and moss below").rect().center();
    window.click_with(at, PointerButton::Secondary, Modifiers::NONE);
    window.press("Next color");
    assert!(note(&window).expect("the note").color.is_some());
    window.click_with(at, PointerButton::Secondary, Modifiers::NONE);
    window.press("Delete the note");
    assert_eq!(note(&window), None);
    assert_eq!(window.steps(), 6);
}

#[test]
fn a_note_far_from_all_nodes_is_in_view_when_a_graph_is_opened() {
    let mut window = Window::of(&NOTED.replace(r#""pos": [0, 0]"#, r#""pos": [-3000, 900]"#));
    window.settle();
    let canvas = window.editor().shell.dock.rects[&Panel::Canvas];
    let note = window.harness.get_by_label("Note: Rust").rect();
    assert!(canvas.contains_rect(note), "{note:?} in {canvas:?}");
}
