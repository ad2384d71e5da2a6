//! Proofs of commands, as far as one key press shows their effect.

use egui::{Key, Modifiers};
use sabi_editing::node_size;
use sabi_engine::live::ViewSubject;
use sabi_graph::NodeId;

use super::super::Window;
use super::super::hands::id;
use super::StateBefore;
use crate::command::{ArrangeCommand, CanvasCommand, Command, FileCommand, GraphCommand, LookCommand, WindowCommand};
use crate::dock::Panel;
use crate::files::Question;
use crate::files::system_dialog::PathFor;

/// Nodes that are selected for a command, and whether it did what its title says.
pub(super) type Proof = (&'static [&'static str], fn(&mut Window, &StateBefore) -> bool);

/// Proof of a command; `None` if another test proves it.
pub(super) fn proof(command: Command) -> Option<Proof> {
    match command {
        Command::File(command) => of_file(command),
        Command::Window(command) => of_window(command),
        Command::Graph(command) => of_graph(command),
        Command::Arrange(command) => Some(of_arrange(command)),
        Command::Canvas(command) => of_canvas(command),
        Command::Look(command) => of_look(command),
        Command::Viewport(_) | Command::Texture(_) | Command::Brush(_) | Command::Favorite(_) => None,
    }
}

fn of_file(command: FileCommand) -> Option<Proof> {
    let proof: Proof = match command {
        FileCommand::Open => (&[], |window, _| window.is_asked_for(&PathFor::Open)),
        FileCommand::SaveAs => (&[], |window, _| window.is_asked_for(&PathFor::Save)),
        FileCommand::ImportPictures => (&[], |window, _| window.is_asked_for(&PathFor::ImportedPictures)),
        FileCommand::Pack => (&[], |window, _| window.is_asked_for(&PathFor::Archive)),
        FileCommand::Export => (&[], |window, _| {
            let has_begun = window.editor().exports.running.is_some() || window.editor().exports.result.is_some();
            window.editor().shell.dock.rects.contains_key(&Panel::Export) && has_begun
        }),
        FileCommand::New | FileCommand::Save => return None,
    };
    Some(proof)
}

fn of_window(command: WindowCommand) -> Option<Proof> {
    let proof: Proof = match command {
        WindowCommand::NextPanel | WindowCommand::PreviousPanel => {
            (&[], |window, _| window.editor().shell.keyboard.active != Panel::Canvas)
        }
        WindowCommand::Help => (&["mix"], |window, _| {
            window.editor().shell.dock.rects.contains_key(&Panel::Page) && window.has("blend/mask")
        }),
        WindowCommand::Tutorial => (&[], |window, _| {
            let is_shown = window.has("Close the tutorial");
            window.press("Close the tutorial");
            is_shown && !window.has("Close the tutorial")
        }),
        WindowCommand::UseView => (&[], |window, _| {
            let is_use = !window.editor().shell.dock.rects.contains_key(&Panel::Canvas);
            window.keys(Modifiers::COMMAND, Key::Space);
            is_use && window.editor().shell.dock.rects.contains_key(&Panel::Canvas)
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
        GraphCommand::Collapse => (&["mix"], |window, _| {
            let [_, height] = node_size::of(window.document(), &id("mix"));
            height < 2.0 * node_size::TITLE_HEIGHT
        }),
        GraphCommand::HidePorts => (&["clouds"], |window, _| {
            let rows = node_size::rows_of(window.document(), &id("clouds")).expect("a node");
            !rows.shows_knobs() && rows.shows_output(0) && rows.shows_picture()
        }),
        GraphCommand::NameWires => (&["mix"], |window, _| window.has("Wires from Blend masks")),
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
            let bottom = |node: &str| window.place(node)[1] + node_size::of(window.document(), &id(node))[1];
            (bottom("clouds") - bottom("mix")).abs() < 1.0 && window.places() != before.places
        }),
        ArrangeCommand::DistributeAcross => (&["clouds", "mix", "layer"], |window, _| window.is_even(0)),
        ArrangeCommand::DistributeDown => (&["clouds", "mix", "layer"], |window, _| window.is_even(1)),
        ArrangeCommand::Straighten => (&["clouds", "mix"], |window, _| {
            let [one, other] = [window.port(&id("clouds"), "mask"), window.port(&id("mix"), "below")];
            (one.y - other.y).abs() < 1.0
        }),
        ArrangeCommand::LayOut => (&[], |window, before| {
            window.places() != before.places && window.place("mix")[0] < window.place("layer")[0]
        }),
        ArrangeCommand::SelectAll => (&[], |window, _| window.document().selection().len() == 6),
        ArrangeCommand::SelectMuted => (&["mix"], |window, _| {
            window.document().selected_one() == Some(&id("paint"))
        }),
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
        CanvasCommand::AddNote => (&[], |window, _| {
            window.typed("Rust below, paint above");
            window.keys(Modifiers::COMMAND, Key::Enter);
            window.has("Note: Rust below, paint above")
        }),
        CanvasCommand::ShowSelected => (&["clouds"], |window, before| {
            let rect = window.rect(&id("clouds"));
            window.zoom() >= before.zoom && (rect.center() - window.on_canvas([0.5, 0.5])).length() < 2.0
        }),
        CanvasCommand::ShowAll => (&[], |window, before| {
            let at = window.on_canvas([0.5, 0.5]);
            window.wheel(at, 300.0);
            let key = window
                .editor()
                .shell
                .keys
                .shown(Command::Canvas(CanvasCommand::ShowAll));
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
            let is_shown = editor.looks.shown.as_ref().is_some_and(|node| node.node == "mix");
            is_shown && editor.shell.settings.follows && editor.seen() == ViewSubject::Node(editor.chosen(&id("mix")))
        }),
        LookCommand::Follow => (&["mix"], |window, _| {
            let follows = window.editor().shell.settings.follows;
            window.harness.state_mut().shell.settings.follows = true;
            !follows
        }),
        LookCommand::Pin => (&["mix"], |window, _| {
            let pinned = window.harness.state_mut().looks.pinned_3d.take();
            pinned.is_some_and(|node| node.node == "mix")
        }),
        LookCommand::FlatPictures => (&[], |window, _| {
            std::mem::take(&mut window.harness.state_mut().shell.settings.is_flat)
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
        let is_scaled = (editor.shell.settings.scale - by).abs() < 1e-3;
        editor.shell.settings.scale = 1.0;
        let is_shown = (self.harness.ctx.zoom_factor() - by).abs() < 1e-3;
        self.harness.ctx.set_zoom_factor(1.0);
        self.settle();
        is_scaled && is_shown
    }

    /// Returns whether the selected nodes are distributed evenly.
    fn is_even(&self, axis: usize) -> bool {
        let document = self.document();
        let place = |id: &NodeId| {
            let begin = document.node(id).map_or(0.0, |node| node.pos[axis]);
            [begin, begin + node_size::of(document, id)[axis]]
        };
        let mut places: Vec<[f32; 2]> = document.selection().iter().map(place).collect();
        places.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let spaces: Vec<f32> = places.windows(2).map(|pair| pair[1][0] - pair[0][1]).collect();
        let steps: Vec<f32> = places.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
        let is_even = |parts: &[f32]| parts.len() == 2 && (parts[0] - parts[1]).abs() < 1.0;
        // Nodes without room beside each other begin at equal distances.
        is_even(&spaces) || is_even(&steps)
    }

    fn is_asked_for(&mut self, meant: &PathFor) -> bool {
        let is_asked =
            matches!(&self.editor().views.questions.open, Some(Question::Path(question)) if question.what == *meant);
        self.key(Key::Escape);
        is_asked && self.editor().views.questions.open.is_none()
    }
}
