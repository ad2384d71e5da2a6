//! Tests of commands: each reports its result, and is one undo step if it changes the document.

use super::*;
use crate::command::{
    ArrangeCommand, ClipboardCommand, DocumentCommand, EditCommand, ExposedCommand, FrameCommand, GroupCommand,
    HistoryCommand, KnobCommand, LayerCommand, NavigationCommand, NodeCommand, NodeSource, Outcome, PortCommand,
    SelectionCommand, VariantCommand, WireCommand, perform,
};

/// Two masks, one of which a layer reads.
const NODES: &str = r#""a": { "kind": "noise/simplex" }, "b": { "kind": "noise/white" },
    "l": { "kind": "effect/layer", "inputs": { "mask": "a" } },
    "o": { "kind": "output/material", "inputs": { "material": "l" } }"#;

fn add_kind(kind: &str, into: Option<SlotRef>) -> EditCommand {
    EditCommand::Node(NodeCommand::Add {
        source: NodeSource::Kind(kind.to_owned()),
        place: [0.0; 2],
        pending: None,
        into,
    })
}

/// Returns commands of every kind that can be performed on [`NODES`] with `a` and `b` selected, each alone.
fn commands() -> Vec<EditCommand> {
    let node = || id("a");
    let knob = || "size".to_owned();
    vec![
        EditCommand::Node(NodeCommand::Rename {
            node: node(),
            name: "Rust".to_owned(),
        }),
        EditCommand::Node(NodeCommand::DeleteSelected { reconnects: true }),
        EditCommand::Node(NodeCommand::DuplicateSelected { keeps_inputs: true }),
        EditCommand::Node(NodeCommand::ToggleMuted),
        EditCommand::Node(NodeCommand::AddTextureSets {
            files: vec!["bricks_color.png".into()],
            place: [0.0; 2],
        }),
        EditCommand::Knob(KnobCommand::Set {
            node: node(),
            knob: knob(),
            value: number(0.5),
        }),
        EditCommand::Knob(KnobCommand::SetTarget {
            target: KnobTarget::of_node(&node(), knob()),
            value: Value::Number(0.5),
        }),
        EditCommand::Knob(KnobCommand::Expose {
            node: node(),
            knob: knob(),
        }),
        EditCommand::Arrange(ArrangeCommand::Move(BTreeMap::from([(node(), [70.0, 30.0])]))),
        EditCommand::Arrange(ArrangeCommand::LayOut),
        EditCommand::Wire(WireCommand::Connect {
            from: from("b"),
            to: to("l.height_map"),
            off: Some(to("l.mask")),
        }),
        EditCommand::Wire(WireCommand::Merge {
            from: from("b"),
            to: to("l.mask"),
            how: MaskMerge::Blend("add"),
        }),
        EditCommand::Wire(WireCommand::Disconnect(vec![to("l.mask")])),
        EditCommand::Wire(WireCommand::Reroute {
            into: to("l.mask"),
            place: [0.0; 2],
        }),
        EditCommand::Wire(WireCommand::DetachSelected),
        EditCommand::Frame(FrameCommand::Add),
        EditCommand::Group(GroupCommand::Make),
        EditCommand::Port(PortCommand::NameGraph("Rust".to_owned())),
        EditCommand::Port(PortCommand::ExposeInput(to("l.base"))),
        EditCommand::Port(PortCommand::ExposeOutput(from("b"))),
        EditCommand::Layer(LayerCommand::Toggle(id("l"))),
        EditCommand::Layer(LayerCommand::SetOpacity {
            node: id("l"),
            opacity: 0.5,
        }),
        EditCommand::Document(DocumentCommand::SetSize(512)),
        EditCommand::Document(DocumentCommand::SetSeed(9)),
    ]
}

#[test]
fn every_command_is_one_step_that_can_be_undone() {
    for command in commands() {
        let mut document = opened("", NODES);
        select(&mut document, &["a", "b"]);
        let told = format!("{command:?}");
        let outcome = step(&mut document, |document| perform(document, command));
        assert_eq!(outcome, Outcome::Done, "{told}: {:?}", document.take_notices());
    }
}

#[test]
fn a_command_that_adds_a_node_returns_its_id() {
    let mut document = opened("", NODES);
    let command = add_kind("adjust/levels", Some(to("l.mask")));
    let Outcome::Added(added) = step(&mut document, |document| perform(document, command)) else {
        panic!("a node is added");
    };
    assert_eq!(wire(&document, "l.mask"), added.as_str());
    assert_eq!(document.selected_one(), Some(&added));
    let command = EditCommand::Node(NodeCommand::Replace {
        node: added.clone(),
        by: NodeSource::Kind("adjust/invert".to_owned()),
    });
    let Outcome::Added(new) = step(&mut document, |document| perform(document, command)) else {
        panic!("the node is replaced");
    };
    assert!(document.node(&added).is_none());
    assert_eq!(wire(&document, "l.mask"), new.as_str());
}

#[test]
fn a_refused_command_changes_nothing_and_gives_the_reason() {
    let lost = || "lost".to_owned();
    let library = NodeSource::Library("lost.sabi".into());
    let refusals = [
        add_kind("lost/kind", None),
        EditCommand::Node(NodeCommand::Replace {
            node: id("a"),
            by: library,
        }),
        EditCommand::Wire(WireCommand::Connect {
            from: from("l"),
            to: to("l.mask"),
            off: None,
        }),
        EditCommand::Frame(FrameCommand::Recolor(lost())),
        EditCommand::Exposed(ExposedCommand::Reset(lost())),
        EditCommand::Variant(VariantCommand::Show(Some(lost()))),
        EditCommand::Port(PortCommand::Feed {
            name: lost(),
            slot: to("l.mask"),
        }),
        EditCommand::Clipboard(ClipboardCommand::Paste {
            text: lost(),
            place: [0.0; 2],
        }),
        EditCommand::Group(GroupCommand::SaveToLibrary("nowhere".into())),
    ];
    for command in refusals {
        let mut document = opened("", NODES);
        let told = format!("{command:?}");
        let mut outcome = Outcome::Done;
        let why = refused(&mut document, |document| outcome = perform(document, command));
        assert_eq!(outcome, Outcome::Unchanged, "{told}");
        assert!(!why.is_empty(), "{told} says nothing");
    }
}

#[test]
fn copied_nodes_are_returned_as_text_that_can_be_pasted() {
    let mut document = opened("", NODES);
    let copy = || EditCommand::Clipboard(ClipboardCommand::Copy);
    assert_eq!(perform(&mut document, copy()), Outcome::Unchanged);
    perform(
        &mut document,
        EditCommand::Selection(SelectionCommand::Only(vec![id("a")])),
    );
    let Outcome::Copied(text) = perform(&mut document, copy()) else {
        panic!("a node is copied");
    };
    let place = [200.0, 100.0];
    let paste = EditCommand::Clipboard(ClipboardCommand::Paste { text, place });
    assert_eq!(step(&mut document, |document| perform(document, paste)), Outcome::Done);
    let pasted = document.selected_one().cloned().expect("the copy");
    assert_eq!(document.node(&pasted).map(|node| node.pos), Some(place));
}

#[test]
fn frames_are_renamed_and_recolored() {
    let mut document = opened("", NODES);
    select(&mut document, &["a"]);
    perform(&mut document, EditCommand::Frame(FrameCommand::Add));
    let frame = || document.graph().frames().keys().next().cloned().expect("a frame");
    let [first, second] = [frame(), frame()];
    let before = document.graph().frames()[&first].color.clone();
    let rename = FrameCommand::Rename {
        frame: first.clone(),
        title: "Wear".to_owned(),
    };
    for command in [rename, FrameCommand::Recolor(second)] {
        step(&mut document, |document| perform(document, EditCommand::Frame(command)));
    }
    let frame = &document.graph().frames()[&first];
    assert_eq!(frame.title.as_deref(), Some("Wear"));
    assert_ne!(frame.color, before);
}

#[test]
fn a_step_of_several_edits_can_be_ended_or_canceled() {
    let mut document = opened("", NODES);
    let history = |document: &mut OpenDocument, command| perform(document, EditCommand::History(command));
    let text = document.session.text().to_owned();
    assert_eq!(history(&mut document, HistoryCommand::Undo), Outcome::Unchanged);
    for (end, is_kept) in [(HistoryCommand::End, true), (HistoryCommand::Cancel, false)] {
        history(&mut document, HistoryCommand::Begin("Move".to_owned()));
        for x in [10.0, 20.0] {
            let places = BTreeMap::from([(id("a"), [x, 0.0])]);
            perform(&mut document, EditCommand::Arrange(ArrangeCommand::Move(places)));
        }
        history(&mut document, end);
        assert_eq!(document.session.text() != text, is_kept);
        history(&mut document, HistoryCommand::Undo);
        assert_eq!(document.session.text(), text);
    }
}

#[test]
fn a_node_is_found_by_its_id_in_the_evaluation() {
    let mut document = opened("", NODES);
    select(&mut document, &["a", "b"]);
    perform(&mut document, EditCommand::Group(GroupCommand::Make));
    let instance = document.selected_one().cloned().expect("an instance");
    let go_to = |document: &mut OpenDocument, full_id: String| {
        let command = EditCommand::Navigation(NavigationCommand::GoTo(full_id));
        perform(document, command)
    };
    assert_eq!(go_to(&mut document, format!("{instance}/b")), Outcome::Done);
    assert_eq!(document.selected_one(), Some(&id("b")));
    assert_eq!(node_paths::full_id(&document, &id("b")), format!("{instance}/b"));
    assert_eq!(go_to(&mut document, instance.to_string()), Outcome::Done);
    assert_eq!(document.selected_one(), Some(&instance));
}
