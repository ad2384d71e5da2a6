//! Exposed parameters, variants, inputs and outputs, changed in the window.

use std::collections::BTreeSet;

use egui::{Event, Key, Modifiers, PointerButton, Vec2, vec2};
use egui_kittest::kittest::Queryable;
use sabi_editing::{exposed_knobs, variants};
use sabi_engine::Session;
use sabi_graph::Value;

use super::Window;
use crate::dock::Panel;

const EXPOSED: &str = r##"{
  "format": "sabi", "version": 1, "name": "Worn edges",
  "exposed": {
    "amount": { "to": ["l.opacity"], "label": "Wear", "order": 1 },
    "size": { "to": ["n.size"], "label": "Grain size", "order": 2 }
  },
  "variants": { "faint": { "amount": 0.25 } },
  "nodes": {
    "n": { "kind": "noise/simplex", "params": { "size": 0.25 } },
    "l": { "kind": "effect/layer", "inputs": { "mask": "n" }, "pos": [260, 0] },
    "out": { "kind": "output/material", "inputs": { "material": "l" }, "pos": [520, 0] }
  }
}"##;

impl Window {
    /// A graph of this text, in a file.
    pub(super) fn of(text: &str) -> Window {
        let mut window = Window::with(|folders| {
            let folder = folders
                .settings
                .as_ref()
                .and_then(|folder| folder.parent())
                .expect("a folder");
            let file = folder.join("worn.sabi");
            std::fs::write(&file, text).expect("a writable folder");
            Session::open(&file, None).expect("a graph")
        });
        window.settle();
        window
    }

    /// A graph of this text, with or without a cache folder.
    pub(super) fn with_cache(has_cache: bool, text: &str) -> Window {
        let mut window = Window::prepared(
            |folders| folders.cache = folders.cache.take().filter(|_| has_cache),
            |folders| {
                let file = super::beside(folders).join("worn.sabi");
                std::fs::write(&file, text).expect("a writable folder");
                Session::open(&file, None).expect("a graph")
            },
        );
        window.settle();
        window
    }

    pub(super) fn click(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.settle();
    }

    /// Clicks the widget of this name outside of a panel that has a widget of the same name.
    pub(super) fn click_beside(&mut self, panel: Panel, name: &str) {
        let rect = self.editor().shell.dock.rects[&panel];
        let mut all = self.harness.get_all_by_label(name);
        let other = all.find(|node| !rect.contains(node.rect().center()));
        other.expect("another one").click();
        drop(all);
        self.settle();
    }

    /// Types into a text field in place of its text, and finishes by Enter.
    pub(super) fn fill(&mut self, name: &str, text: &str) {
        self.harness.get_by_label(name).click();
        self.settle();
        self.keys(Modifiers::COMMAND, Key::A);
        self.harness.event(Event::Text(text.to_owned()));
        self.settle();
        self.key(Key::Enter);
    }

    /// Opens a context menu and clicks an entry.
    pub(super) fn choose(&mut self, name: &str, entry: &str) {
        self.harness.get_by_label(name).click_secondary();
        self.settle();
        self.click(entry);
    }

    pub(super) fn steps(&self) -> usize {
        self.editor().documents.document.session.undo_names().count()
    }

    pub(super) fn held(&self, knob: &str) -> Option<Value> {
        let panel = exposed_knobs::knobs(&self.editor().documents.document);
        panel
            .into_iter()
            .find(|known| known.name == knob)
            .map(|known| known.value)
    }
}

#[test]
fn a_drag_of_an_exposed_knob_is_one_undo_step_and_changes_its_parameter() {
    let mut window = Window::of(EXPOSED);
    let bar = window.harness.get_by_label("Wear").rect();
    window.drag(
        bar.center(),
        bar.center() - vec2(bar.width() / 4.0, 0.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let held = window
        .held("amount")
        .and_then(|value| value.as_number())
        .expect("a number");
    assert!((0.0..1.0).contains(&held), "{held}");
    assert_eq!(window.steps(), 1);
    let layer = "l".parse().expect("an id");
    let own = window
        .editor()
        .documents
        .document
        .node(&layer)
        .and_then(|node| node.params.get("opacity").cloned());
    assert_eq!(own, Some(Value::Number(held)), "the node's own knob was turned");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.held("amount"), Some(Value::Number(1.0)));
}

#[test]
fn the_use_view_has_only_the_model_the_exposed_knobs_and_the_export() {
    let mut window = Window::of(EXPOSED);
    let noise = "n".parse().expect("an id");
    window.harness.state_mut().documents.document.select([noise]);
    window.settle();
    assert!(
        window.harness.query_by_label("Grain size").is_none(),
        "those of the node are shown"
    );
    window.keys(Modifiers::COMMAND, Key::Space);
    let shown: BTreeSet<Panel> = window.editor().shell.dock.rects.keys().copied().collect();
    assert_eq!(
        shown,
        BTreeSet::from([Panel::Viewport, Panel::Parameters, Panel::Export])
    );
    assert!(window.harness.query_by_label("Grain size").is_some());
    assert!(window.harness.query_by_label("Faint").is_some(), "variants are there");
    assert!(window.harness.query_by_label("Change the panel").is_none());
    window.keys(Modifiers::COMMAND, Key::Space);
    assert!(window.editor().shell.dock.rects.contains_key(&Panel::Canvas));
}

#[test]
fn a_graph_without_exposed_parameters_says_how_to_expose_one() {
    let mut window = Window::empty();
    window.settle();
    let sentence = "No parameter is exposed yet. Right-click a parameter of a node and choose Expose parameter; it then stands here.";
    assert!(window.harness.query_by_label(sentence).is_some());
}

#[test]
fn exposed_parameters_are_labeled_renamed_and_removed_in_their_cards() {
    let mut window = Window::of(EXPOSED);
    window.click("Change the panel");
    let labels: Vec<_> = window.harness.get_all_by_label("Label").collect();
    assert_eq!(labels.len(), 2, "a card for each");
    drop(labels);
    window.click("Remove Grain size from the panel");
    window.fill("Label", "How worn");
    window.fill("Section", "Looks");
    window.fill("Name in files", "wear");
    window.click(&format!("{} Set as default", egui_phosphor::regular::PUSH_PIN));
    let exposed = window.editor().documents.document.graph().exposed().clone();
    let wear = &exposed["wear"];
    assert_eq!(exposed.len(), 1);
    assert_eq!(
        (wear.label.as_deref(), wear.section.as_deref(), &wear.default),
        (Some("How worn"), Some("Looks"), &Some(Value::Number(1.0)))
    );
    assert_eq!(window.steps(), 5, "each is one step");
    assert!(
        window.editor().documents.document.graph().variants()["faint"].contains_key("wear"),
        "variants follow"
    );
}

#[test]
fn exposed_knobs_are_reordered_by_dragging() {
    let mut window = Window::of(EXPOSED);
    window.click("Change the panel");
    let [first, second] =
        ["Move Wear", "Move Grain size"].map(|name| window.harness.get_by_label(name).rect().center());
    window.drag(
        second,
        first - Vec2::splat(3.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let names: Vec<String> = exposed_knobs::knobs(&window.editor().documents.document)
        .into_iter()
        .map(|knob| knob.name)
        .collect();
    assert_eq!(names, ["size", "amount"]);
    assert_eq!(window.steps(), 1);
}

#[test]
fn a_variant_is_saved_with_a_picture_of_the_model_applied_renamed_and_removed() {
    let mut window = Window::of(EXPOSED);
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    window.click("Faint");
    assert_eq!(window.held("amount"), Some(Value::Number(0.25)));
    window.fill("Name of a variant", "as bought");
    let variants = window.editor().documents.document.graph().variants().clone();
    assert_eq!(variants["as bought"]["amount"], Value::Number(0.25));
    let what = variants::as_text(&window.editor().documents.document, &variants["as bought"]);
    let file = window.path("worn.sabi");
    let cache = window.editor().evaluation.cache_dir().expect("a cache");
    let kept = sabi_engine::evaluating::load_thumbnail(cache, &[&file.to_string_lossy(), &what]).expect("a picture");
    assert_eq!(kept.size, [128, 128]);
    window.choose("As bought", "Rename");
    window.fill("New name of the variant", "new");
    assert!(
        window
            .editor()
            .documents
            .document
            .graph()
            .variants()
            .contains_key("new")
    );
    let document = &window.editor().documents.document;
    assert_eq!(
        variants::as_text(document, &document.graph().variants()["new"]),
        what,
        "the picture is found under the new name"
    );
    window.choose("New", "Remove");
    assert_eq!(window.editor().documents.document.graph().variants().len(), 1);
    assert_eq!(window.steps(), 4);
}

#[test]
fn knobs_change_the_shown_variant_and_leave_the_base_unchanged() {
    let mut window = Window::of(EXPOSED);
    window.settle();
    let wear = |window: &Window| window.held("amount");
    window.click("Faint");
    assert_eq!(wear(&window), Some(Value::Number(0.25)));
    assert!(window.says("Changes apply to the variant 'Faint' only."));
    window.harness.get_by_label("Wear").focus();
    window.settle();
    window.key(Key::ArrowRight);
    let turned = wear(&window);
    assert_ne!(turned, Some(Value::Number(0.25)));
    assert_eq!(
        window.document().graph().variants()["faint"].get("amount"),
        turned.as_ref()
    );
    window.click("Base");
    assert_eq!(wear(&window), Some(Value::Number(1.0)));
    window.click("Faint");
    assert_eq!(wear(&window), turned);
    window.choose("Faint", "Remove");
    assert_eq!(wear(&window), Some(Value::Number(1.0)));
    window.undo(1);
    assert_eq!(wear(&window), turned);
}

#[test]
fn the_base_and_every_shown_variant_have_a_picture() {
    let mut window = Window::of(EXPOSED);
    let has_picture = |editor: &crate::app::Editor, of_variant: Option<&str>| {
        let document = &editor.documents.document;
        let what = match of_variant {
            Some(name) => variants::as_text(document, &document.graph().variants()[name]),
            None => variants::own_as_text(document),
        };
        let file = document.session.file().expect("a file").to_owned();
        editor
            .documents
            .pictures
            .find(&editor.shell.context, &file, &what)
            .is_some()
    };
    window.until("a picture of the base", |editor| has_picture(editor, None));
    assert!(!has_picture(window.editor(), Some("faint")));
    window.click("Faint");
    window.until("a picture of the variant", |editor| has_picture(editor, Some("faint")));
}
