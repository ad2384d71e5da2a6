//! Errors are shown where they occur, and everything else keeps working.

use egui_kittest::kittest::{NodeT, Queryable};
use sabi_editing::navigation;
use sabi_engine::{EngineError, ErrorKind, Remedy};

use super::Window;
use super::hands::id;
use crate::dock::Panel;
use crate::notices::with_capital;

/// A blur without the source that it needs, an invert behind it, and clouds that have nothing to do with it.
const BROKEN: &str = r#"
    "blur": { "kind": "filter/blur", "pos": [0, 0] },
    "clouds": { "kind": "noise/simplex", "pos": [0, 330] },
    "invert": { "kind": "adjust/invert", "inputs": { "source": "blur" }, "pos": [300, 0] }
"#;

/// Returns the accessible description of a node besides its title.
fn told_of(window: &Window, node: &str) -> String {
    let near = window.rect(&id(node)).expand(10.0);
    let title = window.document().title(&id(node));
    let found = window.harness.query_all_by_label(&title);
    let mut told = found.filter(|found| near.contains(found.rect().center()));
    told.find_map(|found| found.accesskit_node().description())
        .unwrap_or_default()
}

#[test]
fn a_missing_input_is_reported_on_its_node_and_only_its_readers_wait() {
    let mut window = Window::opened(BROKEN);
    window.until("the fault", |editor| editor.evaluation.faults.of("blur").is_some());
    window.until("a picture", |editor| editor.thumbnail_of(&id("clouds")).is_some());
    let fault = window.fault_of("blur");
    assert_eq!(fault, "input 'Source' of node 'Blur' must be connected to a mask");
    assert_eq!(told_of(&window, "blur"), fault);
    assert_eq!(told_of(&window, "invert"), "waiting for node 'Blur'");
    assert_eq!(told_of(&window, "clouds"), "");
    assert!(window.editor().thumbnail_of(&id("invert")).is_none());
    window.click_at(window.title(&id("blur")));
    assert!(window.says(&fault), "in the panel of parameters too");
    // Once the blur is connected, all errors are gone.
    window.wire(&id("clouds"), "mask", &id("blur"), "source");
    window.until("a picture of what waited", |editor| {
        editor.thumbnail_of(&id("invert")).is_some()
    });
    assert_eq!(window.editor().problem_count(), 0);
    assert_eq!(told_of(&window, "blur"), "");
}

#[test]
fn a_click_in_problems_goes_to_the_node_whatever_group_it_is_in() {
    let mut window = Window::with(|folders| {
        let text = r#"{
            "format": "sabi", "version": 1, "preview": { "size": 64 },
            "nodes": { "worn": { "kind": "graph/group", "group": "Worn", "pos": [0, 0] } },
            "groups": { "Worn": {
                "outputs": { "mask": "blur.mask" },
                "nodes": { "blur": { "kind": "filter/blur", "pos": [9000, 0] } }
            } }
        }"#;
        let file = super::beside(folders).join("grouped.sabi");
        std::fs::write(&file, text).expect("a graph");
        sabi_engine::Session::open(&file, None).unwrap_or_else(|error| panic!("{error}"))
    });
    window.until("the fault", |editor| editor.problem_count() == 1);
    window.open(Panel::Problems);
    let fault = window.fault_of("worn/blur");
    let at = window
        .harness
        .get_by_label_contains(&with_capital(&fault))
        .rect()
        .center();
    window.click_at(at);
    assert_eq!(navigation::breadcrumb(window.document()).len(), 1);
    assert_eq!(window.document().selected_one(), Some(&id("blur")));
    assert!(
        window.editor().shell.dock.rects[&Panel::Canvas].contains(window.rect(&id("blur")).center()),
        "it is in sight"
    );
}

#[test]
fn a_missing_picture_and_an_unknown_kind_are_reported_and_nothing_else_stops() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 330] },
        "lost": { "kind": "source/image", "params": { "file": "nowhere.png" }, "pos": [0, 0] },
        "odd": { "kind": "noise/of_tomorrow", "params": { "depth": 3 }, "pos": [300, 0] }
        "#,
    );
    let before = window.text();
    window.until("both faults", |editor| {
        editor.evaluation.faults.of("lost").is_some() && editor.evaluation.faults.of("odd").is_some()
    });
    window.until("a picture", |editor| editor.thumbnail_of(&id("clouds")).is_some());
    assert!(
        window
            .editor()
            .evaluation
            .faults
            .of("lost")
            .expect("a fault")
            .contains("nowhere.png")
    );
    assert!(
        window
            .editor()
            .evaluation
            .faults
            .of("odd")
            .expect("a fault")
            .contains("noise/of_tomorrow")
    );
    window.open(Panel::Problems);
    assert!(window.says("nowhere.png") && window.says("noise/of_tomorrow"));
    // The unknown node is kept unchanged.
    window.click_at(window.title(&id("odd")));
    window.drag_from(window.title(&id("clouds")), window.on_canvas([0.5, 0.9]));
    window.undo(1);
    assert_eq!(window.text(), before);
}

#[test]
fn a_group_shows_the_faults_and_the_time_of_its_nodes() {
    let mut window = Window::with(|folders| {
        let text = r#"{
            "format": "sabi", "version": 1, "preview": { "size": 64 },
            "nodes": { "worn": { "kind": "graph/group", "group": "Worn", "pos": [0, 0] },
                       "after": { "kind": "adjust/invert", "inputs": { "source": "worn.mask" }, "pos": [300, 0] } },
            "groups": { "Worn": {
                "outputs": { "mask": "blur.mask", "plain": "clouds.mask" },
                "nodes": { "blur": { "kind": "filter/blur" }, "clouds": { "kind": "noise/simplex" } }
            } }
        }"#;
        let file = super::beside(folders).join("grouped.sabi");
        std::fs::write(&file, text).expect("a graph");
        sabi_engine::Session::open(&file, None).unwrap_or_else(|error| panic!("{error}"))
    });
    window.until("the fault", |editor| editor.evaluation.faults.of("worn").is_some());
    let fault = window.fault_of("worn/blur");
    assert_eq!(told_of(&window, "worn"), fault);
    assert_eq!(told_of(&window, "after"), "waiting for node 'Worn › Blur'");
    window.click_at(window.title(&id("worn")));
    assert!(window.says(&fault), "in the panel of parameters too");
    window
        .harness
        .state_mut()
        .look_at(&id("worn"), Some("plain".to_owned()));
    window.until("its other result", |editor| {
        editor.evaluation.results.inspected.is_some()
    });
    window.until("its time", |editor| editor.evaluation.results.time("worn").is_some());
    assert_eq!(
        window.editor().evaluation.results.time("worn"),
        window.editor().evaluation.results.time("worn/clouds")
    );
}

#[test]
fn a_missing_group_file_is_reported_on_its_node_and_nothing_else_stops() {
    let mut window = Window::opened(
        r#"
        "clouds": { "kind": "noise/simplex", "pos": [0, 330] },
        "gone": { "kind": "graph/group", "group": "gone.sabi", "pos": [0, 0] },
        "after": { "kind": "adjust/invert", "inputs": { "source": "gone.mask" }, "pos": [300, 0] }
    "#,
    );
    window.until("a picture", |editor| editor.thumbnail_of(&id("clouds")).is_some());
    let fault = window.fault_of("gone");
    assert!(fault.contains("needs the group file \"gone.sabi\""), "{fault}");
    assert_eq!(
        window.editor().evaluation.faults.waits("after").map(String::as_str),
        Some("waiting for node 'gone'")
    );
    window.open(Panel::Problems);
    window.click_at(
        window
            .harness
            .get_by_label_contains(&with_capital(&fault))
            .rect()
            .center(),
    );
    assert_eq!(window.document().selected_one(), Some(&id("gone")));
}

#[test]
fn a_remedy_that_the_window_can_apply_is_a_button_and_the_others_are_words() {
    let mut window = Window::opened("");
    window.until("the model", |editor| editor.evaluation.model.loaded().1);
    window.until("the end", |editor| !editor.evaluation.is_busy());
    let error = EngineError::new(ErrorKind::OutOfMemory, "there is no room for this");
    let error = error.with_remedies([Remedy::LargerSize, Remedy::CloseOtherPrograms]);
    window.harness.state_mut().evaluation.failure = Some(error);
    window.open(Panel::Problems);
    let words = "There is no room for this; close other programs that use the graphics card";
    assert!(window.says(words), "{:?}", window.labels());
    window.press("Work at 256 texels");
    let size = window
        .document()
        .contents()
        .preview
        .as_ref()
        .and_then(|preview| preview.size);
    assert_eq!(size, Some(256));
}
