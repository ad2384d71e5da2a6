//! Settings of the whole graph: texture size while editing, unit of length, and options for reading the model.

use sabi_engine::Session;
use sabi_engine::opening::linked_model::Overlap;
use sabi_graph::Fit;
use sabi_surface::load::Up;

use super::{Window, beside};

#[test]
fn the_texture_size_while_editing_is_chosen_in_the_status_bar() {
    let mut window = Window::opened("");
    window.click("64 texels");
    window.click("256 × 256");
    window.until("another size", |editor| editor.evaluation.model.size() == 256);
    assert!(window.text().contains("\"size\": 256"));
    window.undo(1);
    window.until("the size before", |editor| editor.evaluation.model.size() == 64);
}

#[test]
fn the_unit_of_length_can_be_chosen_and_undone() {
    let mut window = Window::opened("");
    window.click("1 = largest side");
    window.click("a metre");
    assert_eq!(window.document().contents().fit, Fit::Metres);
    window.click("as many metres as");
    assert_eq!(window.document().contents().fit, Fit::Length(0.1));
    window.undo(2);
    assert_eq!(window.document().contents().fit, Fit::Unit);
}

#[test]
fn the_chosen_parts_of_the_graphs_model_are_kept_in_the_graph() {
    let mut window = Window::with(|folders| {
        let folder = beside(folders);
        let square = "vt 0 0\nvt 1 0\nvt 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let parts = ["Rock_LOD0", "Rock_LOD1", "Moss"].map(|name| format!("o {name}\nf 1/1 2/2 3/3\n"));
        std::fs::write(folder.join("rock.obj"), format!("{square}{}", parts.concat())).unwrap();
        let graph = r#"{ "format": "sabi", "version": 1, "name": "", "preview": { "mesh": "rock.obj" }, "nodes": {} }"#;
        std::fs::write(folder.join("rock.sabi"), graph).unwrap();
        Session::open(&folder.join("rock.sabi"), folders.recovery.as_deref()).unwrap()
    });
    let rock = window.document().session.file().unwrap().with_extension("obj");
    window.harness.state_mut().models().take(&rock);
    let shows = |window: &mut Window, expected: &[&str]| {
        window.until("the parts", |editor| {
            let (_, is_loaded) = editor.evaluation.model.loaded();
            let received = editor.evaluation.model.received.as_ref();
            let is_received = received.is_some_and(|model| model.linked.model.parts == expected);
            // Parts are listed once the model was read without an error.
            is_loaded && is_received && !editor.evaluation.model.file_parts().is_empty()
        });
    };
    let preview = |window: &Window| window.document().contents().preview.clone().unwrap();
    shows(&mut window, &["Rock_LOD0", "Moss"]);
    window.click("How the model is read");
    window.click("Moss");
    shows(&mut window, &["Rock_LOD0"]);
    assert_eq!(preview(&window).without, ["Moss"]);
    window.click("Rock_LOD1");
    shows(&mut window, &["Rock_LOD0", "Rock_LOD1"]);
    assert_eq!(preview(&window).parts, ["Rock_LOD0", "Rock_LOD1"]);
    assert!(preview(&window).without.is_empty());
    let request = window.editor().bake_request("maps".into(), false);
    assert_eq!(request.evaluator.model.reading.parts.parts, ["Rock_LOD0", "Rock_LOD1"]);
    window.undo(2);
    shows(&mut window, &["Rock_LOD0", "Moss"]);
    assert!(window.editor().shell.settings.readings.is_empty(), "the graph keeps it");
}

#[test]
fn import_options_are_chosen_kept_and_used_for_exports() {
    let mut window = Window::opened("");
    let is_there = |editor: &super::Editor| editor.evaluation.model.loaded().1;
    window.until("the model", is_there);
    window.click("How the model is read");
    window.click("+Z");
    window.click("Take the average");
    window.until("the model", is_there);
    let reading = window.editor().evaluation.model.import_options();
    assert_eq!((reading.up, reading.overlap), (Up::Z, Overlap::Merge));
    let request = window.editor().bake_request("maps".into(), false);
    assert_eq!(request.evaluator.model.up, Up::Z);
    assert_eq!(request.evaluator.model.overlap, Overlap::Merge);
    window.click("Smooth the faces");
    window.until("the smooth model", is_there);
    window.fill("Up to, degrees", "60");
    window.until("the smoother model", is_there);
    let request = window.editor().bake_request("maps".into(), false);
    assert_eq!(request.evaluator.model.smooth_degrees, Some(60.0));
    window.fill("UV set", "3");
    window.until("why not", |editor| editor.evaluation.model.failure.is_some());
    let why = window
        .editor()
        .evaluation
        .model
        .failure
        .as_ref()
        .map(ToString::to_string);
    assert!(why.as_ref().is_some_and(|why| why.contains("UV set 3")), "{why:?}");
    assert!(
        window.editor().evaluation.model.received.is_some(),
        "the last good one stays"
    );
    window.click("Reset");
    window.until("the model", is_there);
    assert!(window.editor().shell.settings.readings.is_empty());
    window.click("+X");
    window.harness.state_mut().documents.autosave.every = std::time::Duration::ZERO;
    window.settle();
    let Window { harness, folder, .. } = window;
    drop(harness);
    let window = Window::in_folder(folder, |_| Session::new(None));
    assert_eq!(
        window.editor().evaluation.model.import_options().up,
        Up::X,
        "another window reads it so, too"
    );
}
