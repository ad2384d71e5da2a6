use egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::NodeT;

use super::*;

#[test]
fn a_click_on_a_switch_toggles_it() {
    let mut board = board([knob("effect/layer.color_on")]);
    let toggled = |board: &Board| board.get_by_label("Color on").accesskit_node().toggled();
    assert_eq!(toggled(&board), Some(Toggled::True));
    click(&mut board, "Color on");
    assert_eq!(taken(&mut board), [set("color_on", false)]);
    assert_eq!(toggled(&board), Some(Toggled::False));
}

#[test]
fn switches_that_differ_are_switched_on_together() {
    let mut differing = knob("effect/layer.color_on");
    differing.differs = true;
    let mut board = board([differing]);
    let toggled = board.get_by_label("Color on").accesskit_node().toggled();
    assert_eq!(toggled, Some(Toggled::Mixed));
    click(&mut board, "Color on");
    assert_eq!(taken(&mut board), [set("color_on", true)]);
}

#[test]
fn a_few_short_words_stand_side_by_side() {
    let mut board = board([knob("noise/simplex.mode")]);
    assert_eq!(board.get_by_role(Role::RadioGroup).value().as_deref(), Some("FBM"));
    click(&mut board, "Ridged");
    assert_eq!(taken(&mut board), [set("mode", "ridged")]);
    assert_eq!(board.get_by_label("Mode").value().as_deref(), Some("Ridged"));
}

#[test]
fn many_words_are_a_list_that_opens() {
    let mut board = board([knob("blend/mask.mode")]);
    let list = board.get_by_label("Mode");
    assert_eq!(list.accesskit_node().role(), Role::ComboBox);
    assert_eq!(list.value().as_deref(), Some("Multiply"));
    click(&mut board, "Mode");
    click(&mut board, "Soft light");
    assert_eq!(taken(&mut board), [set("mode", "soft_light")]);
    assert_eq!(board.get_by_label("Mode").value().as_deref(), Some("Soft light"));
}

#[test]
fn a_text_is_accepted_by_enter_and_canceled_by_escape() {
    let mut board = board([knob("output/mask.name")]);
    for (text, end, expected) in [("worn", Key::Enter, "worn"), ("lost", Key::Escape, "worn")] {
        click(&mut board, "Name");
        board.key_press_modifiers(Modifiers::COMMAND, Key::A);
        board.event(Event::Text(text.to_owned()));
        board.run();
        key(&mut board, end);
        assert_eq!(current(&board), Value::from(expected));
    }
    assert_eq!(taken(&mut board), [set("name", "worn")]);
}

#[test]
fn a_file_is_typed_or_asked_for_and_a_missing_one_is_reported() {
    let mut board = board([knob("source/image.file")]);
    assert!(says(&board, "No file yet"));
    click(&mut board, "File: choose a file");
    let knob = "file".to_owned();
    assert_eq!(taken(&mut board), [KnobEvent::Browse { knob }]);
    click(&mut board, "File");
    board.event(Event::Text("maps/rust.png".to_owned()));
    board.run();
    key(&mut board, Key::Enter);
    assert_eq!(taken(&mut board), [set("file", "maps/rust.png")]);
    assert!(!says(&board, "No file yet"));
}
