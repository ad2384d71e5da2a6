//! Exposed knobs, names of groups, and edits that change nothing.

use proptest::prelude::*;

use super::random::{a_document, an_edit};
use super::{config, document};
use crate::{Document, Edit, Node, Overrides};

#[test]
fn knobs_are_sorted_by_order_then_name_and_sections_stay_together() {
    let document = document(
        r#""exposed": {
             "a": { "to": ["n.a"] },
             "b": { "to": ["n.b"], "section": "Wear", "order": 2 },
             "c": { "to": ["n.c"], "order": 3 },
             "d": { "to": ["n.d"], "section": "Wear", "order": 4 },
             "e": { "to": ["n.e"], "order": 1 } },"#,
        r#""n": { "kind": "noise/white" }"#,
    );
    let names: Vec<&str> = document
        .graph
        .exposed_in_order()
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    assert_eq!(names, ["e", "c", "a", "b", "d"]);
    assert_eq!(Document::from_json(&document.to_json()), Ok(document));
}

#[test]
fn a_knob_with_curves_gives_each_parameter_its_own_value() {
    let document = document(
        r#""about": "Rust that creeps.", "words": ["iron"],
           "exposed": { "age": { "to": ["n.size", "n.gain", "m.gain"], "about": "How old it is.", "default": 0.5,
             "curves": { "n.size": [[0, 0.1], [1, 0.3]], "m.gain": [[0.5, 1], [1, 0]] } } },
           "variants": { "old": { "age": 0.75 } },"#,
        r#""m": { "kind": "noise/white" }, "n": { "kind": "noise/white" }"#,
    );
    let values = |variant: Option<&str>| {
        let overrides = Overrides {
            variant: variant.map(str::to_owned),
            ..Overrides::default()
        };
        let nodes = super::flat(&document, &overrides).unwrap().nodes;
        let of = |node: usize, name: &str| nodes[node].params[name].as_number().unwrap();
        [of(1, "size"), of(1, "gain"), of(0, "gain")]
    };
    assert_eq!(values(None), [0.2, 0.5, 1.0]);
    assert_eq!(values(Some("old")), [0.25, 0.75, 0.5]);
    assert_eq!(document.description.words, ["iron"]);
    assert_eq!(Document::from_json(&document.to_json()), Ok(document));
}

/// Creates a group inside a group, and instances of the inner group in both graphs.
fn nested() -> Document {
    document(
        r#""groups": {
             "inner": { "name": "Inside", "nodes": { "n": { "kind": "noise/white" } }, "outputs": { "mask": "n" } },
             "outer": { "nodes": { "i": { "kind": "graph/group", "group": "inner" } } } },"#,
        r#""i": { "kind": "graph/group", "group": "inner" }, "f": { "kind": "graph/group", "group": "file.sabi" }"#,
    )
}

fn rename(to: &str, shown: Option<&str>) -> Edit {
    Edit::RenameGroup {
        name: "inner".to_owned(),
        to: to.to_owned(),
        shown: shown.map(str::to_owned),
    }
}

#[test]
fn a_group_is_renamed_in_all_its_instances_and_undo_restores_every_byte() {
    let mut document = nested();
    let before = document.to_json();
    let inverse = document.apply(rename("grain", None)).unwrap();
    let group = |node: Option<&Node>| node.and_then(|node| node.group.clone());
    assert_eq!(group(document.graph.node("i")).as_deref(), Some("grain"));
    assert_eq!(
        group(document.groups["outer"].graph.node("i")).as_deref(),
        Some("grain")
    );
    assert_eq!(group(document.graph.node("f")).as_deref(), Some("file.sabi"));
    assert!(document.groups["grain"].name.is_none());
    assert_eq!(Document::from_json(&document.to_json()).as_ref(), Ok(&document));
    document.apply(inverse).unwrap();
    assert_eq!(document.to_json(), before);
}

#[test]
fn a_group_cannot_take_the_name_of_another_group() {
    for name in ["outer", "file.sabi"] {
        let mut document = nested();
        let error = document.apply(rename(name, None)).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("there is a group \"{name}\" already; choose another name")
        );
        assert_eq!(document, nested());
    }
    let unknown = Edit::RenameGroup {
        name: "iner".to_owned(),
        to: "x".to_owned(),
        shown: None,
    };
    let error = nested().apply(unknown).unwrap_err().to_string();
    assert_eq!(error, "there is no group \"iner\" (did you mean \"inner\"?)");
}

#[test]
fn an_edit_that_would_be_refused_does_not_count_as_one_without_effect() {
    let document = nested();
    let lost = Edit::SetParam {
        body: crate::Body::Main,
        node: "lost".parse().unwrap(),
        param: "gain".to_owned(),
        value: None,
    };
    assert!(!document.is_unchanged_by(&lost));
    assert!(document.is_unchanged_by(&rename("inner", Some("Inside"))));
    assert!(!document.is_unchanged_by(&rename("inner", None)));
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn an_edit_counts_as_without_effect_only_if_it_changes_nothing(mut document in a_document(), edits in prop::collection::vec(an_edit(), 1..20)) {
        for edit in edits {
            let before = document.to_json();
            let is_idle = document.is_unchanged_by(&edit);
            // Edits that set values have no effect when they are applied a second time.
            let gives = matches!(edit, Edit::Move { .. } | Edit::SetMuted { .. } | Edit::SetDisplay { .. } | Edit::SetLabel { .. }
                | Edit::SetParam { .. } | Edit::Connect { .. } | Edit::Disconnect { .. } | Edit::SetSeed { .. }
                | Edit::SetOutput { .. } | Edit::RenameDocument { .. });
            let made = document.apply(edit.clone());
            if is_idle {
                prop_assert!(made.is_ok(), "{edit:?}");
                prop_assert_eq!(document.to_json(), before);
            }
            if gives && made.is_ok() {
                prop_assert!(document.is_unchanged_by(&edit), "{edit:?}");
            }
        }
    }
}
