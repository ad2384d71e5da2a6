//! Random values of exposed knobs, measured over many draws.

use std::collections::BTreeSet;

use sabi_nodes::kind::Role;

use super::effect_library::all_files;
use super::*;
use crate::random_knobs::{randomize, randomize_exposed};

/// Number of draws for each knob.
const DRAWS: usize = 120;

/// A document with an instance of a group that exposes a size, a share and a color.
fn with_instance() -> (OpenDocument, NodeId) {
    let groups = r##""groups": { "g": { "outputs": { "mask": "n" },
        "exposed": { "size": { "to": ["n.size"], "range": [0.02, 1], "default": 0.3 },
            "share": { "to": ["n.jitter"], "range": [0, 1] }, "color": { "to": ["p.color"] } },
        "variants": { "fine": { "size": 0.05, "share": 0.9, "color": "#2040c0" } },
        "nodes": { "n": { "kind": "noise/cells" }, "p": { "kind": "source/material", "params": { "color": "#808080" } } } } },"##;
    let document = opened(groups, r#""i": { "kind": "graph/group", "group": "g" }"#);
    (document, id("i"))
}

fn value(document: &OpenDocument, node: &NodeId, knob: &str) -> f64 {
    let params = &document.node(node).expect("a node").params;
    params[knob].as_number().expect("a number")
}

/// Returns the first random value of a knob for many draws, each from the initial state.
fn draws(document: &mut OpenDocument, node: &NodeId, knob: &str) -> Vec<f64> {
    let draw = |_| {
        assert!(randomize(document, node, &BTreeSet::new()));
        let drawn = value(document, node, knob);
        history::undo(document);
        drawn
    };
    (0..DRAWS).map(draw).collect()
}

fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.into_iter().collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn random_values_stay_near_the_chosen_variant() {
    let (mut document, node) = with_instance();
    instance_variants::choose(&mut document, &node, Some("fine"));
    let sizes = draws(&mut document, &node, "size");
    let middle = mean(sizes.iter().map(|size| size.ln())).exp();
    assert!((0.04..0.065).contains(&middle), "{middle}");
    let share = mean(draws(&mut document, &node, "share"));
    assert!((0.7..0.95).contains(&share), "{share}");
    randomize(&mut document, &node, &BTreeSet::new());
    let params = &document.node(&node).expect("a node").params;
    assert_eq!(params["variant"].as_text(), Some("fine"));
    let blue = params["color"].as_text().expect("a color")[5..7].to_owned();
    assert!(u8::from_str_radix(&blue, 16).expect("a channel") > 150, "{blue}");
}

#[test]
fn random_values_start_from_values_that_the_artist_has_set() {
    let (mut document, node) = with_instance();
    nodes::set_knob(&mut document, &node, "size", number(0.9));
    let sizes = draws(&mut document, &node, "size");
    assert!(sizes.iter().all(|size| *size >= 0.9 / 1.7), "{sizes:?}");
}

#[test]
fn random_lengths_are_as_often_smaller_as_larger_and_rarely_at_an_end() {
    let (mut document, node) = with_instance();
    let sizes = draws(&mut document, &node, "size");
    let smaller = sizes.iter().filter(|size| **size < 0.3).count() as f64 / DRAWS as f64;
    assert!((0.35..0.65).contains(&smaller), "{smaller}");
    let at_an_end = sizes.iter().filter(|size| [0.02, 1.0].contains(size)).count();
    assert_eq!(at_an_end, 0);
    let mut different = sizes.clone();
    different.sort_by(f64::total_cmp);
    different.dedup();
    assert!(different.len() > DRAWS / 2, "{}", different.len());
}

#[test]
fn repeated_random_values_do_not_drift_away() {
    let (mut document, node) = with_instance();
    for _ in 0..DRAWS {
        randomize(&mut document, &node, &BTreeSet::new());
        let size = value(&document, &node, "size");
        assert!((0.3 / 2.51..=0.3 * 2.51).contains(&size), "{size}");
    }
}

#[test]
fn random_values_of_all_effects_stay_in_range_and_away_from_the_ends_of_scales() {
    let (mut scales, mut at_an_end) = (0, 0);
    for file in all_files() {
        let mut document = document_with(Session::new(None), 7);
        let node = library::add(&mut document, &file, [0.0; 2], None).expect("an instance");
        let interface = document.interface(&node).cloned().expect("ports and knobs");
        for _ in 0..8 {
            assert!(randomize(&mut document, &node, &BTreeSet::new()), "{}", file.display());
            for knob in &interface.knobs {
                let set = document
                    .node(&node)
                    .and_then(|node| node.params.get(&knob.name)?.as_number());
                let Some(([low, high], drawn)) = knob.ty.range.zip(set) else {
                    continue;
                };
                let told = format!("{}: {} {drawn}", file.display(), knob.name);
                assert!((low..=high).contains(&drawn), "{told}");
                if knob.ty.role == Role::Length || low > 0.0 && high >= 8.0 * low {
                    scales += 1;
                    at_an_end += usize::from(drawn == low || drawn == high);
                }
            }
        }
    }
    assert!(scales > 300, "{scales}");
    assert!(at_an_end * 50 < scales, "{at_an_end} of {scales}");
}

#[test]
fn random_values_of_the_panel_are_one_step_and_keep_the_given_knobs() {
    let exposed = r#""seed": 5, "exposed": { "size": { "to": ["n.size"], "range": [0.02, 1], "default": 0.3 },
        "share": { "to": ["n.jitter"], "range": [0, 1], "default": 0.5 } },"#;
    let mut document = opened(exposed, r#""n": { "kind": "noise/cells" }"#);
    let values = |document: &OpenDocument| {
        let knobs = exposed_knobs::knobs(document).into_iter();
        let values: BTreeMap<String, f64> = knobs
            .filter_map(|knob| Some((knob.name, knob.value.as_number()?)))
            .collect();
        (values["size"], values["share"], document.contents().seed)
    };
    let before = values(&document);
    let kept: BTreeSet<String> = ["share".to_owned(), "seed".to_owned()].into();
    step(&mut document, |document| assert!(randomize_exposed(document, &kept)));
    let now = values(&document);
    assert!(now.0 != before.0 && now.1 == before.1 && now.2 == before.2, "{now:?}");
    step(&mut document, |document| {
        assert!(randomize_exposed(document, &BTreeSet::new()))
    });
    let now = values(&document);
    assert!(now.1 != before.1 && now.2 != before.2, "{now:?}");
    let mut bare = opened("", r#""n": { "kind": "noise/cells" }"#);
    let said = refused(&mut bare, |document| randomize_exposed(document, &BTreeSet::new()));
    assert_eq!(said, "there are no exposed parameters to give random values to");
}

#[test]
fn random_values_of_the_panel_change_the_shown_variant() {
    let exposed = r#""exposed": { "size": { "to": ["n.size"], "range": [0.02, 1], "default": 0.3 } },
        "variants": { "fine": { "size": 0.05 } }, "preview": { "variant": "fine" },"#;
    let mut document = opened(exposed, r#""n": { "kind": "noise/cells" }"#);
    assert!(randomize_exposed(&mut document, &BTreeSet::new()));
    let default = &document.graph().exposed()["size"].default;
    assert_eq!(default.as_ref().and_then(Value::as_number), Some(0.3));
    let fine = document.graph().variants()["fine"]["size"]
        .as_number()
        .expect("a number");
    assert!(fine != 0.05 && fine < 0.3, "{fine}");
}
