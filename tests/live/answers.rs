//! Requests are answered with a coarse result first, evaluate only what an edit changes, and are replaced by newer ones.

use std::sync::Arc;

use sabi_engine::live::{LiveEvent, LiveOptions, Precedence, ViewSubject};
use sabi_gpu::Gpu;
use sabi_tests::{adapter, device};

use crate::window::{COARSE, FULL, Window, bytes, graph, node, options, request};

/// Returns nodes of a layer of rust over a base; the rust is where clouds are dense.
fn rusty(at: f32) -> String {
    format!(
        r##""base": {{ "kind": "source/material" }},
           "clouds": {{ "kind": "noise/simplex", "params": {{ "octaves": 3 }} }},
           "cut": {{ "kind": "adjust/threshold", "inputs": {{ "source": "clouds" }}, "params": {{ "at": {at} }} }},
           "rust": {{ "kind": "effect/layer", "inputs": {{ "base": "base", "mask": "cut" }},
             "params": {{ "color": "#6b3a1e" }} }},
           "out": {{ "kind": "output/material", "inputs": {{ "material": "rust" }} }}"##
    )
}

#[test]
fn a_request_is_answered_coarse_first_and_then_at_full_size() {
    let window = Window::new();
    let told = window.answer(request(1, graph(&rusty(0.5))));
    assert_eq!(told.coarse_and_full(), [true, false]);
    let sizes: Vec<u32> = told.shown().iter().map(|(_, _, model, _)| model.size).collect();
    assert_eq!(sizes, [COARSE, FULL]);
    let models = told.all.iter().filter(|event| matches!(event, LiveEvent::Model { .. }));
    assert_eq!(models.count(), 2, "each size of the model is told once");
    assert!(told.times().latency.is_some());
    assert!(!window.live.is_busy());
    let can_pick = |model: &sabi_engine::live::LiveModel| model.linked.bvh.get().is_some();
    assert!(told.shown().iter().all(|(_, _, model, _)| can_pick(model)));
}

#[test]
fn a_size_that_is_no_larger_than_the_coarse_one_is_shown_at_once() {
    let window = Window::new();
    let small = sabi_engine::live::LiveRequest {
        coarse_size: FULL,
        ..request(1, graph(&rusty(0.5)))
    };
    assert_eq!(window.answer(small).coarse_and_full(), [false]);
}

#[test]
fn a_coarse_picture_that_would_soon_be_replaced_is_left_out() {
    let gpu = device();
    let patient = LiveOptions {
        coarse_after: std::time::Duration::from_secs(3600),
        ..options()
    };
    let window = Window::on(gpu, patient);
    let first = window.answer(request(1, graph(&rusty(0.5))));
    assert_eq!(
        first.coarse_and_full(),
        [true, false],
        "nobody knows yet how long it takes"
    );
    let next = window.answer(request(2, graph(&rusty(0.6))));
    assert_eq!(next.coarse_and_full(), [false]);
    let same = window.answer(request(3, graph(&rusty(0.6))));
    assert_eq!(same.coarse_and_full(), [false; 0]);
}

#[test]
fn an_edit_evaluates_its_node_and_those_that_depend_on_it() {
    let window = Window::new();
    let first = window.answer(request(1, graph(&rusty(0.5))));
    assert_eq!(first.evaluated(), ["base", "clouds", "cut", "rust"]);
    let edited = window.answer(request(2, graph(&rusty(0.6))));
    assert_eq!(edited.evaluated(), ["cut", "rust"]);
    assert_eq!(edited.times().steps, 4, "two nodes at two sizes");
    assert_eq!(edited.times().cache_hits, 4);
    assert!(edited.times().texture_bytes > 0);
    let back = window.answer(request(3, graph(&rusty(0.5))));
    assert_eq!(back.evaluated(), [""; 0], "what was made before is still known");
    assert_eq!(back.coarse_and_full(), [true, false]);
}

#[test]
fn an_edited_graph_gives_the_same_bytes_as_one_opened_with_the_edit() {
    let set = |at: f64| sabi_graph::Edit::SetParam {
        body: sabi_graph::Body::Main,
        node: "cut".parse().expect("an id"),
        param: "at".to_owned(),
        value: Some(sabi_graph::Value::Number(at)),
    };
    let last = |told: &crate::window::ReceivedEvents| told.shown().last().map(|(.., looks)| bytes(looks));
    let window = Window::new();
    window.answer(request(1, graph(&rusty(0.5))));
    let edits: sabi_engine::live::GraphUpdate = vec![set(0.7)].into();
    let edited = sabi_engine::live::LiveRequest {
        graph: edits.followed_by(vec![set(0.25)].into()),
        ..request(2, graph(&rusty(0.5)))
    };
    let edited = last(&window.answer(edited));
    let whole = last(&Window::new().answer(request(1, graph(&rusty(0.25)))));
    assert!(edited.is_some() && edited == whole);
    // An edit that gives no valid graph is reported as a fault, and the next graph is evaluated.
    let stray = sabi_engine::live::LiveRequest {
        graph: vec![sabi_graph::Edit::SetMuted {
            body: sabi_graph::Body::Main,
            node: "gone".parse().expect("an id"),
            muted: true,
        }]
        .into(),
        ..request(3, graph(&rusty(0.5)))
    };
    let told = window.answer(stray);
    let said = told.all.iter().find_map(|event| match event {
        LiveEvent::Failed { error, .. } => Some(error.to_string()),
        _ => None,
    });
    assert!(said.is_some_and(|said| said.contains("could not follow an edit")));
    assert!(!window.answer(request(4, graph(&rusty(0.6)))).shown().is_empty());
}

#[test]
fn an_edit_that_changes_no_shown_result_is_not_shown_again() {
    let window = Window::new();
    window.answer(request(1, graph(&rusty(0.5))));
    let more = rusty(0.5) + r#", "aside": { "kind": "noise/cells" }"#;
    let told = window.answer(request(2, graph(&more)));
    assert!(told.shown().is_empty() && told.evaluated().is_empty());
}

#[test]
fn a_node_is_shown_instead_of_the_outputs_or_beside_them() {
    let window = Window::new();
    let both = sabi_engine::live::LiveRequest {
        subjects: vec![
            ViewSubject::Outputs,
            ViewSubject::Node(node("cut")),
            ViewSubject::Node(node("gone")),
        ],
        ..request(1, graph(&rusty(0.5)))
    };
    let told = window.answer(both);
    let lit: Vec<(bool, bool)> = told
        .shown()
        .iter()
        .map(|(_, coarse, _, shown)| (*coarse, shown.is_lit))
        .collect();
    assert_eq!(lit, [(true, true), (true, false), (false, true), (false, false)]);
}

#[test]
fn a_graph_without_outputs_shows_the_model_unchanged() {
    let window = Window::new();
    let told = window.answer(request(1, graph("")));
    assert_eq!(told.coarse_and_full(), [true, false]);
}

#[test]
fn many_fast_requests_end_with_the_last_one_and_its_bytes() {
    let window = Window::new();
    let last = 40;
    let at = |revision: u64| 0.3 + 0.01 * revision as f32;
    for revision in 0..last {
        let moving = sabi_engine::live::LiveRequest {
            is_moving: true,
            ..request(revision, graph(&rusty(at(revision))))
        };
        window.live.submit(moving);
    }
    let told = window.answer(request(last, graph(&rusty(at(last)))));
    let shown = told.shown();
    let (revision, is_coarse, _, stormy) = shown.last().expect("a picture");
    assert_eq!((*revision, *is_coarse), (last, false));
    let fresh = Window::new().answer(request(last, graph(&rusty(at(last)))));
    let (.., fresh) = fresh.shown().pop().expect("a picture");
    assert_eq!(bytes(stormy), bytes(fresh));
}

#[test]
fn every_started_request_shows_its_first_picture_however_many_follow() {
    let window = Window::new();
    window.answer(request(0, graph(&rusty(0.2))));
    // Each request follows as soon as any event about the previous one arrives, so that none is ever finished.
    let mut coarse = 0;
    for revision in 1..=8 {
        window
            .live
            .submit(request(revision, graph(&rusty(0.2 + 0.05 * revision as f32))));
        let is_first = |event: &LiveEvent| matches!(event, LiveEvent::Looks { revision: of, is_coarse: true, .. } if *of == revision);
        let told = window.until(is_first);
        coarse += told.all.iter().filter(|event| is_first(event)).count();
    }
    assert_eq!(coarse, 8);
}

#[test]
fn a_newer_request_ends_the_older_one() {
    let window = Window::new();
    window.answer(request(0, graph(&rusty(0.2))));
    window.live.submit(request(1, graph(&rusty(0.4))));
    let is_coarse = |event: &LiveEvent| {
        matches!(
            event,
            LiveEvent::Looks {
                revision: 1,
                is_coarse: true,
                ..
            }
        )
    };
    window.until(is_coarse);
    let told = window.answer(request(2, graph(&rusty(0.6))));
    let is_done = |event: &LiveEvent| matches!(event, LiveEvent::Done { revision: 1 });
    assert!(!told.all.iter().any(is_done), "nobody waited for the rest of the first");
    assert_eq!(told.shown().last().map(|(revision, ..)| *revision), Some(2));
}

#[test]
fn the_exact_values_of_a_node_are_reported_once() {
    let window = Window::new();
    let looking = |revision: u64, at: f32| sabi_engine::live::LiveRequest {
        inspected: vec![node("cut")],
        ..request(revision, graph(&rusty(at)))
    };
    let values = |told: &crate::window::ReceivedEvents| {
        let mut found = told.all.iter().filter_map(|event| match event {
            LiveEvent::Inspected { values, .. } => Some(values.clone()),
            _ => None,
        });
        (found.next(), found.count())
    };
    let (first, more) = values(&window.answer(looking(1, 0.5)));
    let first = first.expect("values");
    assert_eq!((first.size, first.planes.len(), more), (FULL, 1, 0));
    assert_eq!(first.planes[0].values.len(), (FULL * FULL) as usize);
    assert!(first.is_on_surface.iter().any(|is_on| *is_on));
    assert!(values(&window.answer(looking(2, 0.5))).0.is_none());
    assert!(values(&window.answer(looking(3, 0.6))).0.is_some());
}

#[test]
fn another_fit_is_reported_with_a_model_of_its_lengths() {
    let window = Window::new();
    window.answer(request(1, graph(&rusty(0.5))));
    let mut longer = graph(&rusty(0.5));
    longer.document.fit = sabi_graph::Fit::Length(2.0);
    let told = window.answer(request(2, longer));
    assert_eq!(told.coarse_and_full(), [true, false]);
    assert!(
        told.shown()
            .iter()
            .all(|(_, _, model, _)| model.fit == sabi_graph::Fit::Length(2.0))
    );
}

#[test]
fn an_evaluator_dropped_during_its_work_waits_for_its_thread() {
    let window = Window::new();
    window.live.submit(request(1, graph(&rusty(0.5))));
    window.events();
    drop(window);
}

#[test]
fn a_lost_device_is_reported_and_ends_the_work() {
    let gpu = Arc::new(Gpu::open(&adapter()).expect("an adapter, as all tests have"));
    let window = Window::on(gpu.clone(), options());
    window.answer(request(1, graph(&rusty(0.5))));
    gpu.device().destroy();
    window.live.submit(request(2, graph(&rusty(0.6))));
    let told = window.until(|event| matches!(event, LiveEvent::Lost(_)));
    let Some(LiveEvent::Lost(error)) = told.all.last() else {
        panic!("something came after the end");
    };
    assert!(error.to_string().contains("the graphics device was lost"), "{error}");
    assert!(!window.live.is_busy());
}

#[test]
fn results_that_do_not_fit_are_reported_and_a_smaller_graph_is_evaluated() {
    let tight = LiveOptions {
        // The maps of a full material alone take more than this.
        budget_bytes: 128 << 10,
        cache_bytes: 1 << 20,
        ..options()
    };
    let window = Window::on(device(), tight);
    let told = window.answer(request(1, graph(&rusty(0.5))));
    let errors: Vec<String> = told
        .all
        .iter()
        .filter_map(|event| match event {
            LiveEvent::Failed { error, .. } => Some(error.to_string()),
            _ => None,
        })
        .collect();
    assert!(!errors.is_empty());
    for error in errors {
        assert!(
            error.contains("; choose a smaller size, or close other programs"),
            "{error}"
        );
    }
    let mask = r#""clouds": { "kind": "noise/simplex" }"#;
    let small = sabi_engine::live::LiveRequest {
        subjects: vec![ViewSubject::Node(node("clouds"))],
        ..request(2, graph(mask))
    };
    assert_eq!(window.answer(small).coarse_and_full(), [true, false]);
}

#[test]
fn an_evaluator_of_a_higher_rank_works_while_those_before_it_are_idle() {
    let precedence = Precedence::default();
    let ranked = |rank| LiveOptions {
        precedence: precedence.clone(),
        rank,
        ..options()
    };
    let (first, beside) = (Window::on(device(), ranked(0)), Window::on(device(), ranked(1)));
    first.live.submit(request(1, graph(&rusty(0.5))));
    first.events();
    // The first evaluator is now held in the middle of its work.
    beside.live.submit(request(1, graph(&rusty(0.5))));
    beside.live.submit(request(2, graph(&rusty(0.4))));
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(beside.live.take_events().is_empty() && beside.live.is_busy());
    drop(first);
    let told = beside.until(|event| matches!(event, LiveEvent::Done { .. }));
    assert!(
        told.shown().iter().all(|(revision, ..)| *revision == 2),
        "only the last request is answered"
    );
    assert_eq!(told.coarse_and_full(), [true, false]);
}
