//! Every command by each of its keys, in all presets: it does what its title says.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sabi_engine::ViewSubject;
use sabi_graph::NodeId;

use super::super::bars::{ARRANGE, EDIT};
use super::Window;
use super::hands::id;
use crate::command::{
    ArrangeCommand, CanvasCommand, Command, FileCommand, GraphCommand, Habit, LookCommand, Scope, WindowCommand,
};
use crate::dock::Panel;
use crate::files::{PathFor, Question};
use crate::key_map::Chord;

/// Two masks in a blend, which is a layer's mask; the layer on paint is the material.
const NODES: &str = r#"
    "clouds": { "kind": "noise/simplex", "pos": [0, 0] },
    "dots": { "kind": "noise/dots", "pos": [10, 330] },
    "layer": { "kind": "effect/layer", "inputs": { "base": "paint", "mask": "mix" }, "pos": [520, 90] },
    "mix": { "kind": "blend/mask", "inputs": { "above": "dots", "below": "clouds" }, "pos": [260, 60] },
    "out": { "kind": "output/material", "inputs": { "material": "layer" }, "pos": [780, 120] },
    "paint": { "kind": "source/material", "pos": [260, 420] }
"#;

/// What a command is tried on: what is selected, and what was there before the key.
pub(super) struct Before {
    text: String,
    places: Vec<[f32; 2]>,
    zoom: f32,
    screen: egui::Pos2,
}

impl Window {
    /// Puts everything as it was opened, with these nodes selected and the pointer where keys of a scope are meant.
    pub(super) fn prepare(&mut self, selected: &[&str], scope: Scope) -> Before {
        let editor = self.harness.state_mut();
        while editor.document.session.undo_names().next().is_some() {
            editor.document.undo();
        }
        editor.document.leave_to(0);
        editor.document.take_notices();
        editor.document.select(selected.iter().map(|text| id(text)));
        editor.canvas.frame_all(&editor.document);
        editor.files.question = None;
        let panel = match scope {
            Scope::Viewport => Panel::Viewport,
            Scope::Flat => Panel::Flat,
            Scope::Window | Scope::Canvas => Panel::Canvas,
        };
        let at = self.editor().rects[&panel].shrink(8.0).left_bottom();
        self.point(at);
        self.settle();
        Before {
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

/// What is selected for a command, and whether it did what it says. None where it is proved elsewhere.
type Proof = (&'static [&'static str], fn(&mut Window, &Before) -> bool);

fn proof(command: Command) -> Option<Proof> {
    match command {
        Command::File(command) => of_file(command),
        Command::Window(command) => of_window(command),
        Command::Graph(command) => of_graph(command),
        Command::Arrange(command) => Some(of_arrange(command)),
        Command::Canvas(command) => of_canvas(command),
        Command::Look(command) => of_look(command),
        Command::Viewport(_) | Command::Texture(_) | Command::Favorite(_) => None,
    }
}

fn of_file(command: FileCommand) -> Option<Proof> {
    let proof: Proof = match command {
        FileCommand::Open => (&[], |window, _| window.is_asked_for(&PathFor::Open)),
        FileCommand::SaveAs => (&[], |window, _| window.is_asked_for(&PathFor::Save)),
        FileCommand::Export => (&[], |window, _| {
            window.editor().rects.contains_key(&Panel::Export) && window.says("Name the folder for the textures")
        }),
        FileCommand::New | FileCommand::Save => return None,
    };
    Some(proof)
}

fn of_window(command: WindowCommand) -> Option<Proof> {
    let proof: Proof = match command {
        WindowCommand::NextPanel | WindowCommand::PreviousPanel => {
            (&[], |window, _| window.editor().active != Panel::Canvas)
        }
        WindowCommand::Help => (&["mix"], |window, _| {
            window.editor().rects.contains_key(&Panel::Page) && window.has("blend/mask")
        }),
        WindowCommand::UseView => (&[], |window, _| {
            let is_use = !window.editor().rects.contains_key(&Panel::Canvas);
            window.keys(Modifiers::COMMAND, Key::Space);
            is_use && window.editor().rects.contains_key(&Panel::Canvas)
        }),
        WindowCommand::Larger => (&[], |window, _| window.is_scaled(1.1)),
        WindowCommand::Smaller => (&[], |window, _| window.is_scaled(1.0 / 1.1)),
        WindowCommand::Keys => return None,
    };
    Some(proof)
}

fn of_graph(command: GraphCommand) -> Option<Proof> {
    let proof: Proof = match command {
        GraphCommand::Delete => (&["mix"], |window, _| {
            window.document().graph().len() == 5 && window.reads(&id("layer"), "mask").is_empty()
        }),
        GraphCommand::Heal => (&["mix"], |window, _| {
            window.document().graph().len() == 5 && window.reads(&id("layer"), "mask") == "clouds"
        }),
        GraphCommand::Cut => (&["mix"], |window, _| window.document().graph().len() == 5),
        GraphCommand::TakeOut => (&["mix"], |window, _| {
            window.document().graph().len() == 6
                && window.reads(&id("layer"), "mask") == "clouds"
                && window.reads(&id("mix"), "below").is_empty()
        }),
        GraphCommand::SwapInputs => (&["mix"], |window, _| {
            window.reads(&id("mix"), "below") == "dots" && window.reads(&id("mix"), "above") == "clouds"
        }),
        GraphCommand::Mute => (&["mix"], |window, _| {
            window.document().node(&id("mix")).expect("a node").muted
        }),
        GraphCommand::Duplicate => (&["mix"], |window, _| {
            let copy = window.document().selected_one().expect("the copy").clone();
            window.document().graph().len() == 7 && window.reads(&copy, "below").is_empty()
        }),
        GraphCommand::DuplicateWired => (&["mix"], |window, _| {
            let copy = window.document().selected_one().expect("the copy").clone();
            copy != id("mix") && window.reads(&copy, "below") == "clouds"
        }),
        GraphCommand::Frame => (&["clouds", "dots"], |window, _| {
            window.document().graph().frames().len() == 1
        }),
        GraphCommand::Group => (&["mix", "clouds"], |window, _| {
            window.document().contents().groups.len() == 1
        }),
        GraphCommand::Undo
        | GraphCommand::Redo
        | GraphCommand::Copy
        | GraphCommand::Paste
        | GraphCommand::Ungroup
        | GraphCommand::Enter
        | GraphCommand::Leave => return None,
    };
    Some(proof)
}

fn of_arrange(command: ArrangeCommand) -> Proof {
    match command {
        ArrangeCommand::AlignLeft => (&["clouds", "dots"], |window, _| window.place("dots")[0] == 0.0),
        ArrangeCommand::AlignRight => (&["clouds", "dots"], |window, _| window.place("clouds")[0] == 10.0),
        ArrangeCommand::AlignTop => (&["clouds", "mix"], |window, _| window.place("mix")[1] == 0.0),
        ArrangeCommand::AlignBottom => (&["clouds", "mix"], |window, before| {
            let bottom = |node: &str| window.place(node)[1] + window.document().size(&id(node))[1];
            (bottom("clouds") - bottom("mix")).abs() < 1.0 && window.places() != before.places
        }),
        ArrangeCommand::Straighten => (&["clouds", "mix"], |window, _| {
            let [one, other] = [window.port(&id("clouds"), "mask"), window.port(&id("mix"), "below")];
            (one.y - other.y).abs() < 1.0
        }),
        ArrangeCommand::LayOut => (&[], |window, before| {
            window.places() != before.places && window.place("mix")[0] < window.place("layer")[0]
        }),
        ArrangeCommand::SelectAll => (&[], |window, _| window.document().selection().len() == 6),
        ArrangeCommand::SelectUp => (&["mix"], |window, _| {
            window
                .document()
                .selection()
                .iter()
                .map(NodeId::as_str)
                .eq(["clouds", "dots", "mix"])
        }),
        ArrangeCommand::SelectDown => (&["mix"], |window, _| {
            window
                .document()
                .selection()
                .iter()
                .map(NodeId::as_str)
                .eq(["layer", "mix", "out"])
        }),
    }
}

fn of_canvas(command: CanvasCommand) -> Option<Proof> {
    let proof: Proof = match command {
        CanvasCommand::AddMenu => (&[], |window, _| {
            let is_open = window.has("Find a node");
            window.key(Key::Escape);
            is_open && !window.has("Find a node")
        }),
        CanvasCommand::Rename => (&["mix"], |window, _| {
            window.keys(Modifiers::COMMAND, Key::A);
            window.typed("Worn");
            window.key(Key::Enter);
            window.document().title(&id("mix")) == "Worn"
        }),
        CanvasCommand::ShowSelected => (&["clouds"], |window, before| {
            let rect = window.rect(&id("clouds"));
            window.zoom() >= before.zoom && (rect.center() - window.on_canvas([0.5, 0.5])).length() < 2.0
        }),
        CanvasCommand::ShowAll => (&[], |window, before| {
            let at = window.on_canvas([0.5, 0.5]);
            window.wheel(at, 300.0);
            let key = window.editor().keys().shown(Command::Canvas(CanvasCommand::ShowAll));
            window.chord(&key);
            (window.screen([0.0, 0.0]) - before.screen).length() < 1.0
        }),
        CanvasCommand::NextPort | CanvasCommand::PreviousPort | CanvasCommand::Wire => return None,
    };
    Some(proof)
}

fn of_look(command: LookCommand) -> Option<Proof> {
    let proof: Proof = match command {
        LookCommand::Preview => (&["mix"], |window, _| {
            let editor = window.harness.state_mut();
            let is_shown = editor.shown.as_ref().is_some_and(|node| node.node == "mix");
            is_shown && editor.settings.follows && editor.seen() == ViewSubject::Node(editor.chosen(&id("mix")))
        }),
        LookCommand::Follow => (&["mix"], |window, _| {
            let follows = window.editor().settings.follows;
            window.harness.state_mut().settings.follows = true;
            !follows
        }),
        LookCommand::Lock => (&["mix"], |window, _| {
            let locked = window.harness.state_mut().locked.take();
            locked.is_some_and(|node| node.node == "mix")
        }),
        LookCommand::FlatPictures => (&[], |window, _| {
            std::mem::take(&mut window.harness.state_mut().settings.is_flat)
        }),
        LookCommand::MiniMap => (&[], |window, _| {
            let is_shown = window.has("Mini map");
            window.key(Key::N);
            is_shown && !window.has("Mini map")
        }),
        LookCommand::Compare => return None,
    };
    Some(proof)
}

impl Window {
    fn is_scaled(&mut self, by: f32) -> bool {
        let editor = self.harness.state_mut();
        let is_scaled = (editor.settings.scale - by).abs() < 1e-3;
        editor.settings.scale = 1.0;
        let is_shown = (self.harness.ctx.zoom_factor() - by).abs() < 1e-3;
        self.harness.ctx.set_zoom_factor(1.0);
        self.settle();
        is_scaled && is_shown
    }

    fn is_asked_for(&mut self, meant: &PathFor) -> bool {
        let is_asked = matches!(self.editor().question(), Some(Question::Path { what, .. }) if what == meant);
        self.key(Key::Escape);
        is_asked && self.editor().question().is_none()
    }

    /// Tries every command of a scope that has a proof.
    fn try_all(&mut self, habit: Habit) -> Vec<Command> {
        let mut tried = Vec::new();
        for command in Command::ALL.iter().copied() {
            let Some((selected, is_done)) = proof(command) else {
                continue;
            };
            // What is the same as in the usual keys is tried there.
            let is_usual = habit == Habit::Default || command.keys(habit) != command.keys(Habit::Default);
            for key in command.keys(habit).iter().filter(|_| is_usual) {
                let before = self.prepare(selected, command.scope());
                self.chord(key);
                assert!(is_done(self, &before), "{key} for '{}' in {habit:?}", command.title());
            }
            tried.push(command);
        }
        tried
    }
}

#[test]
fn the_entries_of_menus_do_what_their_keys_do() {
    let mut window = window_with(Habit::Default);
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

pub(super) fn window_with(habit: Habit) -> Window {
    let mut window = Window::opened(NODES);
    let context = window.harness.ctx.clone();
    let editor = window.harness.state_mut();
    editor.settings.habit = habit;
    editor.take_settings(&context);
    window.settle();
    window
}

#[test]
fn every_command_does_what_its_title_says_by_each_of_its_keys() {
    let mut window = window_with(Habit::Default);
    let tried = window.try_all(Habit::Default);
    let others: Vec<&str> = Command::ALL
        .iter()
        .filter(|it| !tried.contains(it))
        .map(|it| it.name())
        .collect();
    // The last three by keys alone.
    let elsewhere = "new save undo redo keys copy paste ungroup enter leave frame_model focus_model front right top \
                     lens wires seams wipe fit_flat true_size tile_flat uv_wires next_port previous_port wire";
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
    window_with(Habit::Blender).try_all(Habit::Blender);
}

#[test]
fn the_keys_of_substance_do_what_its_users_expect() {
    window_with(Habit::Substance).try_all(Habit::Substance);
}

#[test]
fn the_keys_1_to_9_add_favorites_under_the_pointer() {
    let mut window = window_with(Habit::Default);
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
    window.harness.state_mut().settings.favorites = kinds.to_vec();
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
fn undo_redo_groups_and_files_by_their_keys() {
    for (habit, name) in Habit::ALL {
        let mut window = window_with(habit);
        let before = window.prepare(&["mix", "clouds"], Scope::Canvas);
        window.chord(Command::Graph(GraphCommand::Group).keys(habit)[0]);
        let group = window.document().selected_one().expect("an instance").clone();
        let grouped = window.text();
        for enter in Command::Graph(GraphCommand::Enter).keys(habit) {
            window.chord(enter);
            assert_eq!(window.document().path().len(), 1, "{enter} in {name}");
            window.key(Key::Escape);
            assert_eq!(window.document().path().len(), 0, "Escape in {name}");
            assert_eq!(
                window.document().selected_one(),
                Some(&group),
                "the instance that was left is selected"
            );
        }
        for undo in Command::Graph(GraphCommand::Undo).keys(habit) {
            for redo in Command::Graph(GraphCommand::Redo).keys(habit) {
                window.chord(undo);
                assert_eq!(window.text(), before.text, "{undo} in {name}");
                window.chord(redo);
                assert_eq!(window.text(), grouped, "{redo} in {name}");
            }
        }
        window.harness.state_mut().document.select([group]);
        window.chord(Command::Graph(GraphCommand::Ungroup).keys(habit)[0]);
        assert_eq!(window.document().contents().groups.len(), 0, "{name}");
        window.chord("Ctrl+S");
        assert!(!window.harness.state_mut().document.session.is_dirty(), "{name}");
        window.chord("Ctrl+N");
        assert!(
            window.document().session.file().is_none() && window.document().graph().is_empty(),
            "{name}"
        );
    }
}
