//! What holds for all of a graph.

use sabi_graph::Fit;

use super::Window;

#[test]
fn the_size_that_is_worked_at_is_chosen_in_the_status_bar() {
    let mut window = Window::opened("");
    window.click("64 texels");
    window.click("256 × 256");
    window.until("another size", |editor| editor.stage.size() == 256);
    assert!(window.text().contains("\"size\": 256"));
    window.undo(1);
    window.until("the size before", |editor| editor.stage.size() == 64);
}

#[test]
fn what_a_length_of_one_is_can_be_chosen_and_taken_back() {
    let mut window = Window::opened("");
    window.click("64 texels");
    window.click("a metre");
    assert_eq!(window.desk().document().fit, Fit::Metres);
    window.click("as many metres as");
    assert_eq!(window.desk().document().fit, Fit::Length(0.1));
    window.undo(2);
    assert_eq!(window.desk().document().fit, Fit::Unit);
}
