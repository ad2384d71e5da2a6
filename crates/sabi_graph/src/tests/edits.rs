//! Edits and their inverses.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::random::{a_document, an_edit};
use super::{config, document};
use crate::{Body, Document, Edit, EditError, ExposedParameter, Fit, GroupDef, History, Node, NodeId, UNDO_STEPS};

fn id(text: &str) -> NodeId {
    text.parse().unwrap()
}

const MAIN: Body = Body::Main;

/// A chain `a → b → c`, with everything that can refer to a node.
fn chain() -> Document {
    document(
        r#""exposed": { "amount": { "to": ["b.opacity", "c.opacity"] }, "only": { "to": ["b.gain"] } },
           "variants": { "heavy": { "amount": 1, "only": 2 } },
           "frames": { "f": { "nodes": ["a", "b", "c"] } },
           "groups": { "g": { "nodes": {} } },
           "inputs": { "where": { "to": ["b.position"] } },
           "outputs": { "mask": "b" },"#,
        r#""a": { "kind": "noise/white" },
           "b": { "kind": "blend/mask", "inputs": { "below": "a", "above": "a.id" } },
           "c": { "kind": "adjust/invert", "inputs": { "source": "b" } }"#,
    )
}

#[test]
fn removing_a_node_removes_all_references_to_it_and_undo_restores_them() {
    let mut document = chain();
    let before = document.to_json();
    let inverse = document
        .apply(Edit::RemoveNode {
            body: MAIN,
            id: id("b"),
        })
        .unwrap();
    let after = document.to_json();
    assert!(!after.contains("\"b"), "{after}");
    assert!(!after.contains("only"), "a knob that turns nothing is gone: {after}");
    assert!(after.contains("c.opacity"));
    assert_eq!(Document::from_json(&after).as_ref(), Ok(&document));
    let again = document.apply(inverse).unwrap();
    assert_eq!(document.to_json(), before);
    document.apply(again).unwrap();
    assert_eq!(document.to_json(), after);
}

#[test]
fn a_link_that_closes_a_circle_is_refused_with_its_nodes() {
    let mut document = chain();
    let link = |node: &str, from: &str| Edit::Connect {
        body: MAIN,
        node: id(node),
        input: "source".to_owned(),
        from: from.parse().unwrap(),
    };
    let error = document.apply(link("a", "c")).unwrap_err().to_string();
    assert_eq!(
        error,
        "the nodes feed each other in a circle: a → b → c → a; remove one of these links"
    );
    let error = document.apply(link("a", "a")).unwrap_err().to_string();
    assert_eq!(error, "node \"a\" cannot read its own result; connect another node");
    assert_eq!(document, chain());
}

#[test]
fn a_batch_that_fails_changes_nothing() {
    let mut document = chain();
    let edits = vec![
        Edit::SetSeed { seed: 9 },
        Edit::RemoveNode {
            body: MAIN,
            id: id("b"),
        },
        Edit::RemoveNode {
            body: MAIN,
            id: id("b"),
        },
    ];
    let error = document.apply(Edit::Batch(edits)).unwrap_err();
    assert_eq!(error.to_string(), "there is no node \"b\"");
    assert_eq!(document, chain());
}

#[test]
fn values_that_no_file_can_hold_are_refused() {
    let bad_value = Edit::SetParam {
        body: MAIN,
        node: id("a"),
        param: "x".to_owned(),
        value: Some(f64::NAN.into()),
    };
    let knob = |range| Edit::Expose {
        body: MAIN,
        name: "k".to_owned(),
        knob: ExposedParameter {
            range: Some(range),
            ..ExposedParameter::default()
        },
    };
    for (edit, text) in [
        (
            bad_value,
            "the value of \"x\" cannot be kept: numbers must be finite and below 3.4e38, lists nested at most 64 levels",
        ),
        (
            Edit::SetFit { fit: Fit::Length(0.0) },
            "a fit must be a length above zero, or \"unit\" or \"metres\"",
        ),
        (
            Edit::Move {
                body: MAIN,
                node: id("a"),
                pos: [f32::NAN, 0.0],
            },
            "a node can only stand at a finite place on the canvas",
        ),
        (
            knob([1.0, 0.0]),
            "the range of knob \"k\" is empty; write the lower end first",
        ),
    ] {
        refused(edit, text);
    }
}

#[test]
fn references_to_missing_things_are_refused() {
    let instance = |group: Option<&str>| Edit::AddNode {
        body: MAIN,
        id: id("i"),
        node: Node {
            group: group.map(str::to_owned),
            ..Node::new(crate::GROUP_KIND)
        },
        inputs: BTreeMap::new(),
    };
    for (edit, text) in [
        (
            Edit::SetVariant {
                body: MAIN,
                name: "v".to_owned(),
                values: Some([("amont".to_owned(), true.into())].into()),
            },
            "variant \"v\" sets \"amont\", which is not exposed (did you mean \"amount\"?)",
        ),
        (
            Edit::Unexpose {
                body: MAIN,
                name: "amont".to_owned(),
            },
            "there is no knob \"amont\" (did you mean \"amount\"?)",
        ),
        (
            instance(None),
            "the node is a group instance but names no group; add \"group\": \"name or file.sabi\"",
        ),
        (
            instance(Some("rust")),
            "there is no group \"rust\"; define it under \"groups\", or name a .sabi file",
        ),
        (
            Edit::AddGroup {
                name: "g".to_owned(),
                group: Box::default(),
            },
            "there is a group \"g\" already; choose another name",
        ),
    ] {
        refused(edit, text);
    }
}

/// Asserts that the edit is refused with this text and changes nothing.
fn refused(edit: Edit, text: &str) {
    let mut document = chain();
    assert_eq!(document.apply(edit).unwrap_err().to_string(), text);
    assert_eq!(document, chain());
}

#[test]
fn a_group_in_use_cannot_be_removed() {
    let mut document = chain();
    let node = Node {
        group: Some("g".to_owned()),
        ..Node::new(crate::GROUP_KIND)
    };
    document
        .apply(Edit::AddNode {
            body: MAIN,
            id: id("i"),
            node: node.clone(),
            inputs: BTreeMap::new(),
        })
        .unwrap();
    let group = Box::new(GroupDef::default());
    document
        .apply(Edit::AddGroup {
            name: "h".to_owned(),
            group,
        })
        .unwrap();
    document
        .apply(Edit::AddNode {
            body: Body::Group("h".to_owned()),
            id: id("j"),
            node,
            inputs: BTreeMap::new(),
        })
        .unwrap();
    let error = document.apply(Edit::RemoveGroup { name: "g".to_owned() }).unwrap_err();
    assert_eq!(
        error.to_string(),
        "group \"g\" is in use by \"i\", \"h/j\"; remove these instances first"
    );
    assert!(matches!(error, EditError::GroupInUse { .. }));
}

#[test]
fn a_drag_of_many_edits_is_one_step_of_undo() {
    let (mut document, mut history) = (chain(), History::new());
    let before = document.to_json();
    history.begin("Move");
    for step in 1..5u8 {
        let pos = [f32::from(step), 0.0];
        history
            .apply(
                &mut document,
                "ignored",
                Edit::Move {
                    body: MAIN,
                    node: id("a"),
                    pos,
                },
            )
            .unwrap();
    }
    history.end();
    history.apply(&mut document, "Seed", Edit::SetSeed { seed: 4 }).unwrap();
    let after = document.to_json();
    assert_eq!(history.undo_names().collect::<Vec<_>>(), ["Move", "Seed"]);
    assert_eq!(history.undo(&mut document).unwrap().as_deref(), Some("Seed"));
    assert_eq!(history.undo(&mut document).unwrap().as_deref(), Some("Move"));
    assert_eq!(history.undo(&mut document).unwrap(), None);
    assert_eq!(document.to_json(), before);
    while history.redo(&mut document).unwrap().is_some() {}
    assert_eq!(document.to_json(), after);
    history.undo(&mut document).unwrap();
    history.apply(&mut document, "Seed", Edit::SetSeed { seed: 5 }).unwrap();
    assert_eq!(history.redo_names().count(), 0);
}

#[test]
fn a_drag_records_only_the_value_before_it() {
    let (mut document, mut history) = (chain(), History::new());
    let before = document.to_json();
    history.begin("Drag");
    for step in 0..1000u16 {
        let to = |node: &str| Edit::Move {
            body: MAIN,
            node: id(node),
            pos: [f32::from(step), 1.0],
        };
        let both = Edit::Batch(vec![to("a"), to("b")]);
        history.apply(&mut document, "ignored", both).unwrap();
    }
    history.end();
    assert!(format!("{history:?}").len() < 2000, "a step of a thousand edits");
    history.undo(&mut document).unwrap();
    assert_eq!(document.to_json(), before);
}

#[test]
fn the_oldest_steps_are_dropped_when_there_are_too_many() {
    let (mut document, mut history) = (chain(), History::new());
    for seed in 0..3 * UNDO_STEPS as u32 {
        history
            .apply(&mut document, "Seed", Edit::SetSeed { seed: seed + 1 })
            .unwrap();
    }
    let kept = history.undo_names().count();
    assert!((UNDO_STEPS..2 * UNDO_STEPS).contains(&kept), "{kept}");
    while history.undo(&mut document).unwrap().is_some() {}
    assert_eq!(document.seed as usize, 3 * UNDO_STEPS - kept);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn inverses_lead_back_to_the_same_bytes(mut document in a_document(), edits in prop::collection::vec(an_edit(), 1..20)) {
        let before = document.to_json();
        let mut inverses = Vec::new();
        for edit in edits {
            let unchanged = document.to_json();
            match document.apply(edit) {
                Ok(inverse) => inverses.push(inverse),
                Err(_) => prop_assert_eq!(document.to_json(), unchanged, "a refused edit changed something"),
            }
        }
        let after = document.to_json();
        let mut again = Vec::new();
        for inverse in inverses.into_iter().rev() {
            again.push(document.apply(inverse).unwrap());
        }
        prop_assert_eq!(document.to_json(), before);
        for edit in again.into_iter().rev() {
            document.apply(edit).unwrap();
        }
        prop_assert_eq!(document.to_json(), after);
    }
}

#[test]
fn replacing_a_whole_document_can_be_undone() {
    let mut first = chain();
    let other = document("", r#""lone": { "kind": "noise/white" }"#);
    let replace = Edit::Replace {
        document: Box::new(other.clone()),
    };
    assert!(!first.is_unchanged_by(&replace));
    let inverse = first.apply(replace.clone()).unwrap();
    assert_eq!(first, other);
    assert!(first.is_unchanged_by(&replace));
    first.apply(inverse).unwrap();
    assert_eq!(first.to_json(), chain().to_json());
}

#[test]
fn canceling_a_group_of_edits_restores_the_redo_stack() {
    let (mut document, mut history) = (chain(), History::new());
    let seed = |seed| Edit::SetSeed { seed };
    history.apply(&mut document, "Seed", seed(1)).unwrap();
    history.undo(&mut document).unwrap();
    history.begin("Drag");
    history.apply(&mut document, "Seed", seed(2)).unwrap();
    history.apply(&mut document, "Seed", seed(3)).unwrap();
    history.cancel(&mut document).unwrap();
    assert_eq!(document, chain());
    assert_eq!(history.redo(&mut document).unwrap().as_deref(), Some("Seed"));
    // A group that is not canceled clears the redo stack, as any edit does.
    history.undo(&mut document).unwrap();
    history.begin("Drag");
    history.apply(&mut document, "Seed", seed(2)).unwrap();
    history.end();
    assert_eq!(history.redo(&mut document).unwrap(), None);
}

#[test]
fn moving_a_node_affects_no_result_but_muting_one_does() {
    let node: NodeId = chain().graph.ids().next().unwrap().clone();
    let body = Body::Main;
    let moved = Edit::Move {
        body: body.clone(),
        node: node.clone(),
        pos: [5.0, 7.0],
    };
    let muted = Edit::SetMuted {
        body,
        node,
        muted: true,
    };
    assert!(!moved.affects_results() && muted.affects_results());
    assert!(!Edit::Batch(vec![moved.clone()]).affects_results());
    assert!(Edit::Batch(vec![moved, muted]).affects_results());
}
