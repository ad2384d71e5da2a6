//! Models and node kinds that change while a graph is open.

use std::sync::Arc;

use sabi_engine::live::{LiveEvent, LiveRequest};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_tests::{NodeFolder, project};

use crate::window::{FULL, Window, graph, request};

const PLAIN: &str = r#"
    "plain": { "kind": "source/material" },
    "out": { "kind": "output/material", "inputs": { "material": "plain" } }"#;

fn on_model(revision: u64, model_revision: u64, path: &str) -> LiveRequest {
    LiveRequest {
        model: Arc::new(ModelOptions::new(&project(path), FULL)),
        model_revision,
        ..request(revision, graph(PLAIN))
    }
}

#[test]
fn a_model_that_cannot_be_read_keeps_the_last_one() {
    let window = Window::new();
    window.answer(on_model(1, 1, "assets/meshes/cube.glb"));
    let told = window.answer(on_model(2, 2, "assets/meshes/gone.glb"));
    let failed: Vec<String> = told
        .all
        .iter()
        .filter_map(|event| match event {
            LiveEvent::ModelFailed {
                model_revision: 2,
                error,
            } => Some(error.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(failed.len(), 1);
    assert!(failed[0].contains("gone.glb"), "{failed:?}");
    assert!(told.shown().is_empty(), "the last one is shown already");
    let recolored = graph(&PLAIN.replace(
        r#""source/material""#,
        r#""source/material", "params": { "roughness": 0.1 }"#,
    ));
    let still = LiveRequest {
        graph: Arc::new(recolored).into(),
        ..on_model(3, 2, "assets/meshes/gone.glb")
    };
    let told = window.answer(still);
    assert_eq!(told.coarse_and_full(), [true, false], "the last good one is worked on");
    assert!(told.shown().iter().all(|(_, _, model, _)| model.model_revision == 1));
    let told = window.answer(on_model(4, 3, "assets/meshes/cube.glb"));
    assert!(told.shown().iter().all(|(_, _, model, _)| model.model_revision == 3));
    assert_eq!(told.coarse_and_full(), [true, false]);
}

#[test]
fn faults_are_reported_even_without_a_model() {
    let window = Window::new();
    let mut without = on_model(1, 1, "assets/meshes/gone.glb");
    without.graph = Arc::new(graph(r#""blurred": { "kind": "filter/blur" }"#)).into();
    let told = window.answer(without);
    assert_eq!(told.faults().map(|faults| faults.faults.len()), Some(1));
}

/// Returns a node kind whose mask has one value everywhere.
fn level(value: f32) -> String {
    format!(
        "//! Level\n//! One value everywhere.\n\n/// The value.\nfn mask(at: Surface) -> f32 {{\n    return {value:?};\n}}\n"
    )
}

#[test]
fn node_kinds_that_were_read_again_are_used() {
    let folder = NodeFolder::new(&[("own/level", &level(0.25))]);
    let wished = |revision: u64, kinds_revision: u64| LiveRequest {
        kinds: Arc::new(folder.kinds()),
        kinds_revision,
        subjects: vec![sabi_engine::live::ViewSubject::Node(crate::window::node("level"))],
        ..request(revision, graph(r#""level": { "kind": "own/level" }"#))
    };
    let window = Window::new();
    assert_eq!(window.answer(wished(1, 1)).coarse_and_full(), [true, false]);
    folder.write("own/level", &level(0.75));
    assert!(
        window.answer(wished(2, 1)).shown().is_empty(),
        "nobody said that they have changed"
    );
    assert_eq!(window.answer(wished(3, 2)).coarse_and_full(), [true, false]);
}
