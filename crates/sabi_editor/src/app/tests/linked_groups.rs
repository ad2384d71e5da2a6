//! Instances of library groups: newer versions, random values and the parameters that stay.

use std::path::{Path, PathBuf};

use egui_kittest::kittest::Queryable;
use egui_phosphor::regular as icon;
use sabi_graph::{NodeId, Value};

use super::Window;
use super::choice_previews::color_of;
use crate::app::Editor;
use crate::choice_previews::PreviewChoice;
use crate::dock::Panel;

/// Writes a group of a color, in a file of its name.
fn write_group(folder: &Path, name: &str, color: &str) {
    let text = format!(
        r##"{{ "format": "sabi", "version": 1, "name": "{name}", "outputs": {{ "material": "laid", "mask": "cells" }},
        "exposed": {{ "size": {{ "to": ["cells.size"], "range": [0.02, 1], "default": 0.3, "label": "Size" }},
            "rough": {{ "to": ["laid.roughness"], "range": [0, 1], "default": 0.5, "label": "Rough" }} }},
        "nodes": {{ "cells": {{ "kind": "noise/cells" }},
            "laid": {{ "kind": "source/material", "params": {{ "color": "{color}" }} }} }} }}"##
    );
    std::fs::write(folder.join(format!("{}.sabi", name.to_lowercase())), text).expect("a writable folder");
}

/// A window with instances of two groups of the user's library. The first one is connected to the output.
fn with_instances() -> (Window, PathBuf, [NodeId; 2]) {
    let mut library = PathBuf::new();
    let mut window = Window::with(|folders| {
        library = folders.library.clone().expect("a folder for the library");
        std::fs::create_dir_all(&library).expect("a folder");
        write_group(&library, "Red", "#c01010");
        write_group(&library, "Gray", "#808080");
        let file = super::beside(folders).join("graph.sabi");
        let nodes = super::graph_text(r#""out": { "kind": "output/material", "pos": [600, 0] }"#);
        std::fs::write(&file, nodes).expect("a graph");
        sabi_engine::Session::open(&file, folders.recovery.as_deref()).expect("a graph that can be read")
    });
    window.settle();
    let document = &mut window.harness.state_mut().documents.document;
    let ids = [("red", [0.0, 0.0]), ("gray", [0.0, 400.0])].map(|(name, place)| {
        let file = library.join(format!("{name}.sabi"));
        sabi_editing::library::add(document, &file, place, None).expect("an instance")
    });
    let from = format!("{}.material", ids[0]).parse().expect("an output");
    let to = "out.material".parse().expect("an input");
    assert!(sabi_editing::wires::connect(document, &from, &to));
    document.select([]);
    window.settle();
    (window, library, ids)
}

impl Window {
    /// Writes newer versions of both groups, as another program does.
    fn write_newer(&mut self, library: &Path) {
        self.until("the watch", |editor| editor.documents.watching.is_watching());
        write_group(library, "Red", "#10a010");
        write_group(library, "Gray", "#a0a0a0");
        self.until("the newer files", |editor| outdated(editor) == 2);
    }

    fn select(&mut self, node: &NodeId) {
        self.harness.state_mut().documents.document.select([node.clone()]);
        self.settle();
    }

    /// Clicks the widget with this name in the panel of parameters.
    fn click_parameter(&mut self, name: &str) {
        let at = self.knob(name);
        self.click_at(at);
    }

    fn number(&self, node: &NodeId, name: &str) -> Option<f64> {
        let params = &self.document().node(node).expect("a node").params;
        params.get(name).and_then(Value::as_number)
    }
}

fn outdated(editor: &Editor) -> usize {
    let documents = &editor.documents;
    let links = documents.document.contents().groups.values();
    let is_newer = |link: &sabi_graph::LibrarySource| {
        let digest = documents.library.digest(&documents.document, link);
        digest.is_some_and(|digest| digest != link.digest)
    };
    let links = links.filter_map(|group| group.library.as_ref());
    links.filter(|link| is_newer(link)).count()
}

#[test]
fn newer_versions_are_listed_without_a_selection_and_shown_before_an_update() {
    let (mut window, library, _) = with_instances();
    assert!(!window.says("newer group"));
    window.write_newer(&library);
    let before = window.text();
    window.click(&format!("{} 2 newer groups", icon::ARROWS_CLOCKWISE));
    assert!(window.editor().shell.dock.is_shown(Panel::Problems));
    assert!(window.says("The library has newer versions of 2 groups."));
    let color = |editor: &Editor, after: bool| {
        color_of(
            editor,
            |choice| matches!(choice, PreviewChoice::Update { is_after, .. } if *is_after == after),
        )
    };
    window.until("the pictures", |editor| {
        color(editor, false).is_some() && color(editor, true).is_some()
    });
    let [red, green] = [false, true].map(|after| color(window.editor(), after).expect("a picture"));
    assert!(red[0] > 1.5 * red[1], "{red:?}");
    assert!(green[1] > 1.5 * green[0], "{green:?}");
    assert_eq!(window.text(), before, "nothing is taken yet");
    let steps = window.steps();
    window.click("Update all 2");
    assert_eq!((outdated(window.editor()), window.steps()), (0, steps + 1));
    assert!(!window.says("newer group") && !window.says("newer versions of"));
    window.undo(1);
    assert_eq!(window.text(), before);
}

#[test]
fn a_selected_instance_is_updated_with_its_values_and_unlinked() {
    let (mut window, library, [red, _]) = with_instances();
    window.write_newer(&library);
    let document = &mut window.harness.state_mut().documents.document;
    sabi_editing::nodes::set_knob(document, &red, "size", Some(Value::Number(0.7)));
    window.select(&red);
    assert!(window.says("The library has a newer version."));
    window.click("Update");
    assert_eq!((outdated(window.editor()), window.number(&red, "size")), (1, Some(0.7)));
    assert!(!window.says("The library has a newer version."));
    window.click("Unlink");
    let links = |window: &Window| {
        let groups = window.document().contents().groups.values();
        groups.filter(|group| group.library.is_some()).count()
    };
    assert_eq!(links(&window), 1);
    window.undo(2);
    assert_eq!((links(&window), outdated(window.editor())), (2, 2));
}

#[test]
fn random_changes_an_instance_but_none_of_its_kept_parameters() {
    let (mut window, _, [red, _]) = with_instances();
    window.select(&red);
    let random = format!("{} Random", icon::DICE_FIVE);
    let keep = format!("{} Keep", icon::LOCK_SIMPLE);
    let state = |window: &Window| ["seed", "size", "rough"].map(|name| window.number(&red, name));
    let before = state(&window);
    window.click(&random);
    let first = state(&window);
    assert!(
        first
            .iter()
            .zip(&before)
            .all(|(now, before)| now.is_some() && now != before),
        "{first:?}"
    );
    window.click(&keep);
    // The knob below the menu has the same name.
    let named = window.harness.query_all_by_label("Size").map(|node| node.rect());
    let boxes: Vec<egui::Rect> = named.collect();
    let entry = boxes.iter().min_by(|one, other| one.width().total_cmp(&other.width()));
    window.click_at(entry.expect("an entry").center());
    window.key(egui::Key::Escape);
    window.click(&random);
    let second = state(&window);
    assert_eq!(second[1], first[1], "it is kept");
    assert!(second[0] != first[0] && second[2] != first[2], "{second:?}");
}

#[test]
fn random_changes_the_exposed_parameters_of_a_graph_but_not_its_kept_seed() {
    let text = r#"{ "format": "sabi", "version": 1, "seed": 9, "preview": { "size": 64 },
        "exposed": { "size": { "to": ["cells.size"], "range": [0.02, 1], "default": 0.3, "label": "Width" } },
        "nodes": { "cells": { "kind": "noise/cells" } } }"#;
    let mut window = Window::of(text);
    let random = format!("{} Random", icon::DICE_FIVE);
    let size = |window: &Window| window.held("size");
    let first = size(&window);
    window.click_parameter(&format!("{} Keep", icon::LOCK_SIMPLE));
    let seeds = window
        .harness
        .query_all_by_label("Seed of the graph")
        .map(|node| node.rect().center());
    let status = window.editor().shell.dock.rects[&Panel::Parameters];
    let seeds: Vec<egui::Pos2> = seeds.filter(|at| status.contains(*at)).collect();
    window.click_at(seeds[0]);
    window.key(egui::Key::Escape);
    window.click_parameter(&random);
    assert!(size(&window) != first && window.document().contents().seed == 9);
    assert_eq!(window.steps(), 1);
}
