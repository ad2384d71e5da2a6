//! Small pictures of nodes come when what they give changes, and only then.

use std::sync::Arc;

use sabi_engine::evaluating::TextureSet;
use sabi_engine::live::{LiveEvent, LiveRequest};
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_export::SetKey;
use sabi_tests::project;

use crate::window::{FULL, ReceivedEvents, Window, document, graph, node, request};

const NODES: &str = r##"
    "clouds": { "kind": "noise/simplex" },
    "cells": { "kind": "noise/cells" },
    "red": { "kind": "color/constant", "params": { "color": "#ff0000" } },
    "paint": { "kind": "source/material", "params": { "color": "#00ff00" } },
    "out": { "kind": "output/material", "inputs": { "material": "paint" } }"##;

fn pictured(revision: u64, nodes: &str, thumbnails: &[&str]) -> LiveRequest {
    LiveRequest {
        thumbnails: thumbnails.iter().map(|id| node(id)).collect(),
        ..request(revision, graph(nodes))
    }
}

#[test]
fn a_thumbnail_comes_once_while_nothing_changes() {
    let window = Window::new();
    let all = ["clouds", "red", "paint", "out"];
    assert_eq!(window.answer(pictured(1, NODES, &all)).pictured(), all);
    assert_eq!(window.answer(pictured(2, NODES, &all)).pictured(), [""; 0]);
    let edited = NODES.replace("#ff0000", "#0000ff");
    assert_eq!(window.answer(pictured(3, &edited, &all)).pictured(), ["red"]);
}

#[test]
fn scrolling_sends_thumbnails_only() {
    let window = Window::new();
    window.answer(pictured(1, NODES, &["clouds"]));
    let told = window.answer(pictured(2, NODES, &["cells", "red"]));
    assert_eq!(told.pictured(), ["cells", "red"]);
    assert!(told.shown().is_empty());
    assert_eq!(told.evaluated(), ["cells", "red"]);
}

#[test]
fn a_thumbnail_shows_the_model_in_what_the_node_gives_on_a_clear_ground() {
    let window = Window::new();
    let told = window.answer(pictured(1, NODES, &["red", "paint"]));
    for (id, picture) in told.thumbnails() {
        assert_eq!(picture.size, [32; 2]);
        let pixel = |x: usize, y: usize| &picture.rgba[4 * (32 * y + x)..][..4];
        assert_eq!(pixel(0, 0)[3], 0, "{id}: nothing is behind the model");
        let [r, g, b, a] = [0, 1, 2, 3].map(|at| pixel(16, 16)[at]);
        assert_eq!(a, 255, "{id}");
        match id {
            "red" => assert_eq!([r, g, b], [255, 0, 0]),
            _ => assert!(g > r && g > b && g > 30, "{id}: {r} {g} {b}"),
        }
        let soft = picture
            .rgba
            .iter()
            .skip(3)
            .step_by(4)
            .filter(|alpha| (1..255).contains(*alpha));
        assert!(soft.count() > 8, "{id}: the outline is smooth");
    }
}

#[test]
fn flat_thumbnails_show_texture_space() {
    let window = Window::new();
    let flat = |revision: u64, is_flat: bool| LiveRequest {
        is_flat,
        ..pictured(revision, NODES, &["red"])
    };
    let told = window.answer(flat(1, true));
    let [(_, picture)] = told.thumbnails()[..] else {
        panic!("one thumbnail");
    };
    let (pixels, _) = picture.rgba.as_chunks::<4>();
    assert!(pixels.contains(&[255, 0, 0, 255]));
    assert!(pixels.iter().any(|pixel| pixel[3] == 0), "between the charts");
    assert_eq!(
        window.answer(flat(2, false)).pictured(),
        ["red"],
        "the other kind is another picture"
    );
}

#[test]
fn of_several_texture_sets_the_wanted_one_is_shown_where_texture_space_is() {
    let window = Window::new();
    let model = ModelOptions::new(&project("assets/meshes/chair.glb"), FULL);
    let wished = |revision: u64, set: Option<SetKey>| LiveRequest {
        model: Arc::new(model.clone()),
        model_revision: 1,
        inspected: vec![node("red")],
        is_flat: true,
        set,
        ..pictured(revision, NODES, &["red"])
    };
    let told = window.answer(wished(1, None));
    let sets = told.shown().last().map(|(_, _, model, _)| model.sets.clone());
    let sets = sets.expect("a model");
    let names: Vec<String> = sets.iter().map(TextureSet::title).collect();
    assert_eq!(names, ["wood", "leather"]);
    let seen = |told: &ReceivedEvents| -> Option<(String, Vec<u8>)> {
        let values = told.all.iter().find_map(|event| match event {
            LiveEvent::Inspected { values, .. } => Some(values.set.title()),
            _ => None,
        });
        let picture = told.thumbnails().first().map(|(_, picture)| picture.rgba.clone());
        Some((values?, picture?))
    };
    let first = seen(&told).expect("the first set");
    let other = seen(&window.answer(wished(2, Some(sets[1].key)))).expect("the other set");
    assert_eq!([&first.0, &other.0], ["wood", "leather"]);
    assert_ne!(first.1, other.1, "they cover other texels");
    let nowhere = SetKey {
        material: 9,
        ..sets[0].key
    };
    assert_eq!(seen(&window.answer(wished(3, Some(nowhere)))), Some(first));
    assert_eq!(seen(&window.answer(wished(4, None))), None, "it is there already");
}

#[test]
fn a_group_instance_and_a_node_inside_it_have_thumbnails() {
    let grouped = r#"{ "format": "sabi", "version": 1,
        "groups": { "wear": { "outputs": { "mask": "cut" }, "nodes": {
            "bend": { "kind": "graph/reroute", "inputs": { "source": "noise" } },
            "cut": { "kind": "adjust/threshold", "inputs": { "source": "bend" } },
            "noise": { "kind": "noise/simplex" } } } },
        "nodes": {
            "wear_1": { "kind": "graph/group", "group": "wear" },
            "way": { "kind": "graph/reroute", "inputs": { "source": "wear_1" } } } }"#;
    let window = Window::new();
    let all = ["wear_1", "wear_1/bend", "wear_1/noise", "way"];
    let wished = LiveRequest {
        thumbnails: all.map(node).to_vec(),
        ..request(1, document(grouped))
    };
    let told = window.answer(wished);
    assert_eq!(told.pictured(), all);
    let pictures: Vec<&Vec<u8>> = told.thumbnails().iter().map(|(_, picture)| &picture.rgba).collect();
    assert_eq!(pictures[0], pictures[3], "a reroute shows what it passes on");
    assert_eq!(pictures[1], pictures[2]);
    assert_ne!(pictures[0], pictures[1]);
}
