use egui::{Key, Modifiers};

use super::{Window, open};
use sabi_engine::Session;

#[test]
fn a_lost_device_takes_no_work_along_and_undo_leads_back_to_the_beginning() {
    let mut window = Window::empty();
    window.settle();
    let empty = window.text();
    window.add([0.2, 0.2], "clouds");
    let text = window.text();
    window.editor().stage.gpu().device().destroy();
    let handover = window.handover.clone();
    // It is told of at the next piece of work.
    window.add([0.6, 0.2], "levels");
    window.until("the loss", |_| handover.lock().is_ok_and(|kept| kept.is_some()));
    let folders = window.harness.state().folders().clone();
    window.harness = open(Session::new(None), folders, handover);
    window.settle();
    assert_ne!(window.text(), empty);
    window.until("pictures on another device", |editor| editor.model_view.drawn > 0);
    window.point(window.on_canvas([0.5, 0.9]));
    for _ in 0..3 {
        if window.text() == text {
            break;
        }
        window.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(window.text(), text, "the last step is taken back");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), empty);
}
