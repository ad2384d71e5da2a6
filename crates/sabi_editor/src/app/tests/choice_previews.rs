//! Pictures of variants and of effects on the open model.

use egui_kittest::kittest::Queryable;
use sabi_graph::NodeId;

use super::Window;
use crate::app::Editor;
use crate::choice_previews::PreviewChoice;

const COLORS: &str = r##"{
  "format": "sabi", "version": 1, "preview": { "size": 64 },
  "exposed": { "color": { "to": ["paint.color"] } },
  "variants": { "green": { "color": "#10a010" }, "red": { "color": "#c01010" } },
  "nodes": {
    "out": { "kind": "output/material", "inputs": { "material": "paint" }, "pos": [300, 0] },
    "paint": { "kind": "source/material", "params": { "color": "#404040" } }
  }
}"##;

const GROUPED: &str = r##"{
  "format": "sabi", "version": 1, "preview": { "size": 64 },
  "groups": { "Paint": {
    "exposed": { "color": { "to": ["n.color"] } }, "outputs": { "material": "n" },
    "variants": { "blue": { "color": "#1010c0" }, "red": { "color": "#c01010" } },
    "nodes": { "n": { "kind": "source/material", "params": { "color": "#404040" } } } } },
  "nodes": {
    "g": { "kind": "graph/group", "group": "Paint" },
    "out": { "kind": "output/material", "inputs": { "material": "g" }, "pos": [300, 0] }
  }
}"##;

/// Mean color of a picture where the model is.
pub(super) fn color_of(editor: &Editor, is_meant: impl Fn(&PreviewChoice) -> bool) -> Option<[f32; 3]> {
    let pixels = editor.choice_previews.pixels_of(is_meant)?;
    let covered = pixels.rgba.chunks_exact(4).filter(|pixel| pixel[3] == 255);
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for pixel in covered {
        count += 1.0;
        for (sum, code) in sum.iter_mut().zip(pixel) {
            *sum += f32::from(*code);
        }
    }
    Some(sum.map(|sum| sum / count))
}

fn is_variant(choice: &PreviewChoice, wanted: Option<&str>) -> bool {
    matches!(choice, PreviewChoice::Variant { name, .. } if name.as_deref() == wanted)
}

#[test]
fn every_variant_of_the_graph_is_drawn_on_the_model_without_being_shown() {
    let mut window = Window::of(COLORS);
    let before = window.text();
    let color = |editor: &Editor, name| color_of(editor, |choice| is_variant(choice, name));
    window.until("the pictures", |editor| {
        [None, Some("green"), Some("red")]
            .into_iter()
            .all(|name| color(editor, name).is_some())
    });
    let [own, green, red] =
        [None, Some("green"), Some("red")].map(|name| color(window.editor(), name).expect("a picture"));
    assert!(green[1] > 1.5 * green[0] && green[1] > 1.5 * green[2], "{green:?}");
    assert!(red[0] > 1.5 * red[1] && red[0] > 1.5 * red[2], "{red:?}");
    assert!((own[0] - own[1]).abs() < 12.0, "{own:?}");
    assert_eq!(window.text(), before);
    window.click("Red");
    assert_eq!(sabi_editing::shown_variant::name(window.document()), Some("red"));
}

#[test]
fn the_variants_of_an_instance_are_drawn_in_the_whole_graph_and_chosen_by_a_click() {
    let mut window = Window::of(GROUPED);
    let id: NodeId = "g".parse().expect("an id");
    window.harness.state_mut().documents.document.select([id.clone()]);
    window.until("the pictures", |editor| {
        let has = |name| color_of(editor, |choice| is_variant(choice, name)).is_some();
        has(None) && has(Some("blue")) && has(Some("red"))
    });
    let blue = color_of(window.editor(), |choice| is_variant(choice, Some("blue"))).expect("a picture");
    assert!(blue[2] > 1.5 * blue[0], "{blue:?}");
    let chosen = |window: &Window| {
        let node = window.document().node(&"g".parse().expect("an id")).expect("a node");
        node.params
            .get("variant")
            .and_then(|value| value.as_text().map(str::to_owned))
    };
    // The parameter below the cards has the same words.
    let card = |window: &Window, name: &str| {
        let mut named = window.harness.query_all_by_label(name);
        named.next().expect("a card").rect().center()
    };
    window.click_at(card(&window, "Blue"));
    assert_eq!(chosen(&window).as_deref(), Some("blue"));
    window.click_at(card(&window, "Base"));
    assert_eq!(chosen(&window), None);
}

#[test]
fn a_changed_graph_gives_new_pictures_and_another_model_does_not_show_the_old_ones() {
    let mut window = Window::of(COLORS);
    let color = |editor: &Editor| color_of(editor, |choice| is_variant(choice, None));
    window.until("a picture", |editor| color(editor).is_some());
    let gray = color(window.editor()).expect("a picture");
    let document = &mut window.harness.state_mut().documents.document;
    let value = Some(sabi_graph::Value::Text("#1020e0".to_owned()));
    sabi_editing::nodes::set_knob(document, &"paint".parse().expect("an id"), "color", value);
    window.until("a newer one", |editor| color(editor).is_some_and(|color| color != gray));
    let sphere = window.path("sphere.glb");
    std::fs::write(&sphere, include_bytes!("../../../../../assets/meshes/sphere.glb")).expect("a model");
    window.harness.state_mut().models().take(&sphere);
    window.harness.step();
    assert_eq!(color(window.editor()), None);
    window.until("one of the sphere", |editor| color(editor).is_some());
}

/// An effect that lies in the library of the user.
const EFFECT: &str = r##"{
  "format": "sabi", "version": 1, "name": "Green paint", "words": ["meadow"],
  "outputs": { "mask": "m", "material": "n" },
  "nodes": { "m": { "kind": "noise/cells" }, "n": { "kind": "source/material", "params": { "color": "#10a010" } } }
}"##;

/// A window with one effect in the library of the user, which is searched for.
fn with_effect() -> (Window, std::path::PathBuf) {
    let mut file = std::path::PathBuf::new();
    let mut window = Window::with(|folders| {
        let folder = folders.library.clone().expect("a folder for the library");
        std::fs::create_dir_all(&folder).expect("a folder");
        file = folder.join("green.sabi");
        std::fs::write(&file, EFFECT).expect("an effect");
        sabi_engine::Session::new(None)
    });
    window.open(crate::dock::Panel::Library);
    window.harness.get_by_label("Search the library").focus();
    window.settle();
    window.typed("green paint");
    (window, file)
}

fn effect_color(editor: &Editor) -> Option<[f32; 3]> {
    color_of(editor, |choice| matches!(choice, PreviewChoice::Effect(_)))
}

#[test]
fn an_effect_of_the_library_is_tried_on_the_open_model_while_the_window_is_idle() {
    let (mut window, _) = with_effect();
    window.until_model();
    let entry = window.harness.get_by_label("Green paint").rect().center();
    // On a software driver it waits while something is typed or pointed at.
    window.point(entry);
    let begun = window.editor().choice_previews.begun();
    for step in 0..30 {
        window.point(entry + egui::vec2(step as f32, 0.0));
    }
    assert_eq!(window.editor().choice_previews.begun(), begun);
    window.until("its picture", |editor| effect_color(editor).is_some());
    let green = effect_color(window.editor()).expect("a picture");
    assert!(green[1] > 1.5 * green[0], "its material, not its mask: {green:?}");
    window.click("Effects on the open model");
    assert_eq!(window.editor().shell.settings.tries_effects, Some(false));
    let begun = window.editor().choice_previews.begun();
    let column = window.path("column.glb");
    std::fs::write(&column, include_bytes!("../../../../../assets/meshes/column.glb")).expect("a model");
    window.harness.state_mut().models().take(&column);
    window.until_model();
    assert_eq!(window.editor().choice_previews.begun(), begun);
}

#[test]
fn a_hovered_entry_is_explained_beside_the_list() {
    let (mut window, _) = with_effect();
    let entry = window.harness.get_by_label("Green paint").rect();
    window.point(entry.center());
    window.harness.run_steps(90);
    assert!(window.says("meadow"), "{:?}", window.labels());
    let words = window.harness.get_by_label_contains("meadow").rect();
    assert!(words.right() < entry.left(), "{words:?} is not beside {entry:?}");
}

#[test]
fn pictures_of_nodes_and_variants_have_the_shade_of_the_view() {
    let column = include_bytes!("../../../../../assets/meshes/bench.glb");
    let paint: NodeId = "paint".parse().expect("an id");
    let brightness = |pixels: &sabi_view::Pixels| {
        let covered: Vec<&[u8]> = pixels.rgba.chunks_exact(4).filter(|pixel| pixel[3] == 255).collect();
        covered.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / covered.len() as f64
    };
    // Without a cache folder there is no shade.
    let [without, with] = [false, true].map(|has_shade| {
        let mut window = Window::with_cache(has_shade, COLORS);
        let bench = window.path("bench.glb");
        std::fs::write(&bench, column).expect("a model");
        window.harness.state_mut().models().take(&bench);
        window.until("the shade", |editor| {
            let model = editor.evaluation.model.received.as_ref();
            let is_bench =
                model.is_some_and(|model| model.linked.model.files.iter().any(|file| file.ends_with("bench.glb")));
            is_bench && editor.evaluation.has_shade() == has_shade && !editor.evaluation.is_busy()
        });
        window.until("the pictures", |editor| {
            let of_variant = editor
                .choice_previews
                .pixels_of(|choice| is_variant(choice, Some("green")));
            editor.thumbnail_of(&paint).is_some() && of_variant.is_some() && !editor.evaluation.is_busy()
        });
        let editor = window.editor();
        let node = editor
            .evaluation
            .results
            .thumbnail_pixels(&editor.reference(&paint, None));
        let variant = editor
            .choice_previews
            .pixels_of(|choice| is_variant(choice, Some("green")));
        [node, variant].map(|pixels| brightness(pixels.expect("a picture")))
    });
    for (with, without) in with.iter().zip(&without) {
        // Only corners are darker.
        assert!(
            (0.7 * without..without - 0.5).contains(with),
            "{with} and without shade {without}"
        );
    }
}

#[test]
fn cards_of_variants_can_be_enlarged_and_a_hovered_one_is_larger_beside_the_list() {
    let mut window = Window::of(COLORS);
    let side = |window: &Window| window.harness.get_by_label("Green").rect().width();
    let small = side(&window);
    window.click("Larger pictures");
    assert!(side(&window) > 1.5 * small);
    let [base, green] = ["Base", "Green"].map(|name| window.harness.get_by_label(name).rect());
    assert!(
        base.right() <= green.left() && base.top() == green.top(),
        "side by side"
    );
    window.click("Larger pictures");
    let card = window.harness.get_by_label("Green").rect();
    assert_eq!(card.width(), small);
    window.point(card.center());
    window.harness.run_steps(90);
    let words = window.harness.get_by_label("Show the variant 'Green'").rect();
    assert!(
        words.right() < card.left() || words.left() > card.right(),
        "{words:?} is not beside {card:?}"
    );
    assert!(words.width() > small, "{words:?}");
}
