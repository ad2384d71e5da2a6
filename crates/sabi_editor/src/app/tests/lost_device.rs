//! The loss of a device loses no work.

use sabi_editing::{history, nodes};
use sabi_engine::Session;

use super::{Window, cube, open};

impl Window {
    /// Destroys the device while nothing is uploaded to it, since wgpu 29 would deadlock.
    pub(super) fn destroy_device(&mut self) {
        self.until("rest", |editor| {
            editor.views.model.is_loaded() && editor.views.model.pictures.drawn > 0 && !editor.evaluation.is_busy()
        });
        self.editor().evaluation.gpu().device().destroy();
    }
}

#[test]
fn no_work_is_lost_with_the_device_and_undo_still_reaches_the_first_step() {
    let mut window = Window::empty();
    window.settle();
    let empty = window.text();
    window.add([0.2, 0.2], "clouds");
    let added = window.text();
    window.destroy_device();
    nodes::toggle_muted(&mut window.harness.state_mut().documents.document);
    let muted = window.text();
    assert_ne!(muted, added);
    let handover = window.handover.clone();
    window.until("the loss", |_| handover.lock().is_ok_and(|kept| kept.is_some()));
    let folders = window.editor().folders().clone();
    if let Some(kept) = handover.lock().expect("what was kept").as_mut() {
        kept.was_exporting = true;
    }
    window.harness = open(Session::new(None), folders.clone(), cube(&folders), handover);
    window.settle();
    assert_eq!(window.text(), muted);
    assert!(window.says("The textures were not written, since the graphics device was lost"));
    assert!(!window.says("Examples"), "no start page stands before the work");
    window.until("pictures on another device", |editor| {
        editor.views.model.pictures.drawn > 0
    });
    for expected in [&added, &empty] {
        history::undo(&mut window.harness.state_mut().documents.document);
        assert_eq!(&window.text(), expected);
    }
    window.redo(2);
    assert_eq!(window.text(), muted);
}
