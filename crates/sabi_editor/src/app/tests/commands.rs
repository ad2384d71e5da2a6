//! Every command by each of its keys, in all presets: it does what its title says.

mod proofs;

use egui::Key;
use egui_kittest::kittest::Queryable;

use super::Window;
use super::hands::id;
use sabi_editing::{history, navigation};

use crate::bars::{ARRANGE, EDIT};
use crate::command::{Command, GraphCommand, InputPreset, Scope};
use crate::dock::Panel;
use crate::key_map::Chord;
use proofs::proof;

/// Two masks are blended into the mask of a layer. The layer lies on a muted material, and the output shows it.
const NODES: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [10, 330] },
    "layer": { "kind": "effect/layer", "inputs": { "base": "paint", "mask": "mix" }, "pos": [520, 90] },
    "mix": { "kind": "blend/mask", "inputs": { "above": "dots", "below": "clouds" }, "pos": [260, 60] },
    "out": { "kind": "output/material", "inputs": { "material": "layer" }, "pos": [780, 120] },
    "paint": { "kind": "source/material", "muted": true, "pos": [260, 420] }
"#;

/// State before a command.
pub(super) struct StateBefore {
    text: String,
    places: Vec<[f32; 2]>,
    zoom: f32,
    screen: egui::Pos2,
}

impl Window {
    /// Resets the window, selects nodes, and puts the pointer where the keys of a scope act.
    pub(super) fn prepare(&mut self, selected: &[&str], scope: Scope) -> StateBefore {
        let editor = self.harness.state_mut();
        while editor.documents.document.session.undo_names().next().is_some() {
            history::undo(&mut editor.documents.document);
        }
        navigation::leave_to(&mut editor.documents.document, 0);
        editor.documents.document.take_notices();
        editor.documents.document.select(selected.iter().map(|text| id(text)));
        editor.views.canvas.camera.frame_all(&editor.documents.document);
        editor.views.questions.open = None;
        let panel = match scope {
            Scope::Viewport => Panel::Viewport,
            Scope::Flat => Panel::Flat,
            Scope::Window | Scope::Canvas => Panel::Canvas,
        };
        let at = self.editor().shell.dock.rects[&panel].shrink(8.0).left_bottom();
        self.point(at);
        self.settle();
        StateBefore {
            text: self.text(),
            places: self.places(),
            zoom: self.zoom(),
            screen: self.screen([0.0, 0.0]),
        }
    }

    fn places(&self) -> Vec<[f32; 2]> {
        self.document().graph().nodes().map(|(_, node)| node.pos).collect()
    }

    fn place(&self, node: &str) -> [f32; 2] {
        self.document().node(&id(node)).expect("a node").pos
    }

    pub(super) fn chord(&mut self, text: &str) {
        let chord = Chord::parse(text).expect("a key");
        self.keys(chord.modifiers, chord.key);
    }

    pub(super) fn has(&self, label: &str) -> bool {
        self.harness.query_all_by_label(label).next().is_some()
    }
}

impl Window {
    /// Tries every command of a scope that has a proof.
    fn try_all(&mut self, preset: InputPreset) -> Vec<Command> {
        let mut tried = Vec::new();
        for command in Command::ALL.iter().copied() {
            let Some((selected, is_done)) = proof(command) else {
                continue;
            };
            // Keys of the default preset are tried in its own test.
            let is_usual = preset == InputPreset::Default || command.keys(preset) != command.keys(InputPreset::Default);
            for key in command.keys(preset).iter().filter(|_| is_usual) {
                let before = self.prepare(selected, command.scope());
                self.chord(key);
                assert!(is_done(self, &before), "{key} for '{}' in {preset:?}", command.title());
            }
            tried.push(command);
        }
        tried
    }
}

#[test]
fn the_entries_of_menus_do_what_their_keys_do() {
    let mut window = window_with(InputPreset::Default);
    for (menu, entries) in [("Edit", EDIT), ("Arrange", ARRANGE)] {
        for command in entries.iter().flatten() {
            let Some((selected, is_done)) = proof(*command) else {
                continue;
            };
            let before = window.prepare(selected, command.scope());
            window.press_entry(menu, command.title());
            assert!(is_done(&mut window, &before), "{} in {menu}", command.title());
        }
    }
}

pub(super) fn window_with(preset: InputPreset) -> Window {
    let mut window = Window::opened(NODES);
    let editor = window.harness.state_mut();
    editor.shell.settings.input_preset = preset;
    editor.shell.apply_settings();
    window.settle();
    window
}

#[test]
fn every_command_does_what_its_title_says_by_each_of_its_keys() {
    let mut window = window_with(InputPreset::Default);
    let tried = window.try_all(InputPreset::Default);
    let others: Vec<&str> = Command::ALL
        .iter()
        .filter(|it| !tried.contains(it))
        .map(|it| it.name())
        .collect();
    // Commands that other tests try; the last three have keys and no menu entries.
    let elsewhere = "new save undo redo keys copy paste ungroup enter leave frame_model focus_model front right top \
                     lens wires seams next_channel previous_channel material wipe fit_flat true_size tile_flat uv_wires \
                     paint brush_larger brush_smaller brush_erase next_port previous_port wire";
    let elsewhere: Vec<&str> = elsewhere.split(' ').collect();
    let mut missing: Vec<&str> = others
        .into_iter()
        .filter(|name| !elsewhere.contains(name) && !name.starts_with("favorite_"))
        .collect();
    missing.sort_unstable();
    assert_eq!(missing, [""; 0], "commands that nothing proves");
}

#[test]
fn the_keys_of_blender_do_what_blender_users_expect() {
    window_with(InputPreset::Blender).try_all(InputPreset::Blender);
}

#[test]
fn the_keys_of_substance_do_what_its_users_expect() {
    window_with(InputPreset::Substance).try_all(InputPreset::Substance);
}

#[test]
fn the_keys_1_to_9_add_favorites_under_the_pointer() {
    let mut window = window_with(InputPreset::Default);
    let kinds = [
        "cells",
        "chips",
        "cracks",
        "dots",
        "scratches",
        "simplex",
        "white",
        "wood",
        "simplex",
    ];
    let kinds = kinds.map(|name| format!("noise/{name}"));
    window.harness.state_mut().shell.settings.favorites = kinds.to_vec();
    for (at, kind) in kinds.iter().enumerate() {
        window.prepare(&[], Scope::Canvas);
        let place = window.on_canvas([0.2, 0.9]);
        window.point(place);
        window.chord(&(at + 1).to_string());
        let added = window.document().selected_one().expect("a node").clone();
        assert_eq!(window.document().node(&added).expect("a node").kind, *kind);
        assert!((window.rect(&added).left_top() - place).length() < 1.5, "{kind}");
    }
}

#[test]
fn keys_undo_redo_group_and_open_files() {
    for (preset, name) in InputPreset::ALL {
        let mut window = window_with(preset);
        let before = window.prepare(&["mix", "clouds"], Scope::Canvas);
        window.chord(Command::Graph(GraphCommand::Group).keys(preset)[0]);
        let group = window.document().selected_one().expect("an instance").clone();
        let grouped = window.text();
        for enter in Command::Graph(GraphCommand::Enter).keys(preset) {
            window.chord(enter);
            assert_eq!(navigation::breadcrumb(window.document()).len(), 1, "{enter} in {name}");
            window.key(Key::Escape);
            assert_eq!(navigation::breadcrumb(window.document()).len(), 0, "Escape in {name}");
            assert_eq!(
                window.document().selected_one(),
                Some(&group),
                "the instance that was left is selected"
            );
        }
        for undo in Command::Graph(GraphCommand::Undo).keys(preset) {
            for redo in Command::Graph(GraphCommand::Redo).keys(preset) {
                window.chord(undo);
                assert_eq!(window.text(), before.text, "{undo} in {name}");
                window.chord(redo);
                assert_eq!(window.text(), grouped, "{redo} in {name}");
            }
        }
        window.harness.state_mut().documents.document.select([group]);
        window.chord(Command::Graph(GraphCommand::Ungroup).keys(preset)[0]);
        assert_eq!(window.document().contents().groups.len(), 0, "{name}");
        window.chord("Ctrl+S");
        assert!(
            !window.harness.state_mut().documents.document.session.is_dirty(),
            "{name}"
        );
        window.chord("Ctrl+N");
        assert!(
            window.document().session.file().is_none() && window.document().graph().len() == 2,
            "{name}"
        );
    }
}
