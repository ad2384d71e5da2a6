use super::Window;

#[test]
fn a_graph_that_is_built_by_clicks_and_keys_can_be_undone_completely() {
    let mut window = Window::empty();
    window.settle();
    let empty = window.text();
    let paint = window.add([0.05, 0.1], "source material");
    let noise = window.add([0.05, 0.55], "clouds");
    let layer = window.add([0.4, 0.1], "effect layer");
    window.wire(&paint, "material", &layer, "base");
    window.wire(&noise, "mask", &layer, "mask");
    assert_eq!(window.reads(&layer, "base"), paint.to_string());
    assert_eq!(window.reads(&layer, "mask"), noise.to_string());
    let built = window.text();
    window.undo(5);
    assert_eq!(window.text(), empty, "five steps lead back to nothing");
    window.redo(5);
    assert_eq!(window.text(), built, "and forth to the same bytes");
}

#[test]
fn every_visible_node_gets_a_picture_and_the_model_is_lit() {
    let mut window = Window::empty();
    let noise = window.add([0.3, 0.3], "clouds");
    window.until("a picture of the noise", |editor| editor.thumbnail_of(&noise).is_some());
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
}
