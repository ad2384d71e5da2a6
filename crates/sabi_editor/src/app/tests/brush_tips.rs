//! Tips of the brush that come from elsewhere.

use egui::accesskit::Role;
use egui_kittest::Node;
use egui_kittest::kittest::Queryable;
use sabi_paint::{Action as BrushAction, Area, CopyOf, PicturePart};

use super::Window;
use super::painting::painting_on;
use crate::dock::Panel;

fn with_brush_settings() -> Window {
    let mut window = painting_on("mask");
    window.open(Panel::Parameters);
    window
}

#[test]
fn the_result_of_a_node_becomes_the_tip_of_the_brush() {
    let mut window = with_brush_settings();
    window.harness.state_mut().shell.settings.brush.area = Area::Ribbon;
    window.settle();
    window.click("Tip: Round");
    let menu = window.harness.get_by_label_contains("The result of a node");
    let at = menu.rect().left_center();
    menu.click();
    window.settle();
    // The canvas and the library show the name as well, but farther from the pointer.
    let all = window.harness.get_all_by_role_and_label(Role::Button, "Dots");
    let distance = |node: &Node<'_>| node.rect().center().distance(at);
    let entry = all.min_by(|one, other| distance(one).total_cmp(&distance(other)));
    entry.expect("the entry").click();
    window.settle();
    window.until("the tip", |editor| editor.shell.settings.brush.picture.is_some());
    let brush = window.editor().shell.settings.brush.clone();
    let tip = brush.picture.expect("a tip");
    assert_eq!((tip.part, brush.area), (PicturePart::Light, Area::Ribbon));
    let strokes = window.document().session.graph().strokes.clone();
    assert!(strokes.picture(&tip.picture).is_some(), "strokes have it");
}

#[test]
fn a_brush_that_clones_another_node_needs_no_place_to_copy_from() {
    let mut window = with_brush_settings();
    let brush = &mut window.harness.state_mut().shell.settings.brush;
    brush.action = BrushAction::Clone;
    brush.copy_of = CopyOf::Input;
    window.settle();
    window.paint(egui::Modifiers::NONE);
    let list = window.list("mask").expect("a stroke");
    assert!(list.strokes[0].copies_input() && list.strokes[0].source.is_none());
    window.until("the warning", |editor| {
        let mut told = editor.evaluation.faults.all.warnings.iter();
        told.any(|warning| warning.sentence.contains("nothing is connected to From"))
    });
}
