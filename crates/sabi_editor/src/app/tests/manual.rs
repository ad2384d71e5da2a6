//! The first graph of the manual, made step by step as the manual says, and its pictures.
//!
//! `cargo xtask bless manual` writes them into `docs/editor`, so that they show the window as it is.

use std::path::Path;

use egui::{Event, Key, Modifiers};
use image::imageops::{FilterType, resize};

use super::{Window, folders_in};
use crate::builtin_models::builtin_file;
use crate::dock::{Panel, Workspace};
use crate::files::{examples, new_graph};

/// Size of a picture, pixels.
const SIZE: [u32; 2] = [1200, 675];

impl Window {
    /// Writes what the window shows, once it rests, as a picture of the manual.
    fn write_picture(&mut self, name: &str) {
        self.harness.event(Event::PointerGone);
        self.until("rest", |editor| {
            let graph = editor.documents.document.graph();
            let is_drawn = graph.nodes().all(|(id, _)| editor.thumbnail_of(id).is_some());
            is_drawn && editor.views.model.pictures.drawn > 0 && !editor.evaluation.is_busy()
        });
        // Animations end, and pictures of the library arrive.
        self.harness.run_steps(60);
        let picture = self.harness.render().expect("a picture of the window");
        let [width, height] = SIZE;
        let file = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../docs/editor")
            .join(name);
        resize(&picture, width, height, FilterType::Lanczos3)
            .save(file)
            .expect("a file");
    }
}

#[test]
#[ignore = "writes the pictures of the manual: cargo xtask bless manual"]
fn the_first_graph_of_the_manual_is_made_as_the_manual_says() {
    // Its name is read in the picture of the export.
    let folder = tempfile::Builder::new()
        .prefix("materials")
        .rand_bytes(0)
        .tempdir()
        .expect("a folder");
    let folders = folders_in(folder.path());
    let places = folders.examples.clone().expect("a folder for examples");
    let bench = builtin_file(&places, "bench").expect("a model");
    examples::write_model(&places, &bench).expect("a file");
    let mut window = Window::beginning_on(folder, folders, &bench, |folders| {
        new_graph::session(folders.recovery.as_deref()).expect("a graph")
    });
    window.harness.state_mut().shell.dock.arrange(Workspace::Material);
    window.until_model();

    // 1. Begin.
    window.harness.state_mut().views.start.is_open = true;
    window.write_picture("start.png");
    window.press("Empty graph");

    // 2. Add nodes. All of them fit into a view from farther away.
    window.wheel(window.on_canvas([0.5, 0.5]), -190.0);
    let node_of = |window: &Window, kind: &str| {
        let graph = window.document().graph();
        let found = graph.nodes().find(|(_, node)| node.kind == kind);
        found.expect("a node of the kind").0.clone()
    };
    let model = node_of(&window, "source/model");
    window.click_at(window.title(&model));
    window.key(Key::Delete);
    let paint = window.add([0.3, 0.12], "plain material");
    let edges = window.add([0.03, 0.05], "edges");
    let clouds = window.add([0.03, 0.5], "clouds");
    let both = window.add([0.33, 0.55], "blend mask");
    let layer = window.add([0.66, 0.4], "effect layer");
    window.write_picture("nodes.png");

    // 3. Wire them.
    let output = node_of(&window, "output/material");
    window.wire(&paint, "material", &layer, "base");
    window.wire(&edges, "mask", &both, "below");
    window.wire(&clouds, "mask", &both, "above");
    window.wire(&both, "mask", &layer, "mask");
    window.wire(&layer, "material", &output, "material");
    window.point(window.on_canvas([0.9, 0.95]));
    window.keys(Modifiers::COMMAND, Key::A);
    window.key(Key::L);
    window.key(Key::A);
    window.write_picture("wired.png");

    // 4. Color it.
    window.click_at(window.title(&paint));
    window.set_color("Color", "#3c5a6e");
    window.click_at(window.title(&edges));
    window.set_number("Width", "0.03");
    window.click_at(window.title(&layer));
    window.set_color("Color", "#6b3a1e");
    window.set_number("Roughness", "0.85");
    window.write_picture("rust.png");

    // 5. Export.
    window.keys(Modifiers::COMMAND, Key::S);
    window.answer_path(&window.path("rusty-bench.sabi"));
    window.open(Panel::Export);
    window.press("Export");
    window.until("the maps", |editor| editor.exports.running.is_none());
    assert!(window.says("Written to"), "{:?}", window.labels());
    window.write_picture("export.png");
}
