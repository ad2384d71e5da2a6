//! The window as somebody uses it: by clicks and keys, without a screen.

mod building;
mod layers;
mod lost;
mod panels;
mod ports;

use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sabi_engine::{AdapterChoice, Gpu, Session};
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::{Beginning, Editor, Folders, Handover};
use crate::window::configuration;

/// What runs tests needs a Vulkan driver.
const INSTALL: &str = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
/// Longer than anything takes on a busy machine; only a mistake comes near.
const PATIENCE: Duration = Duration::from_secs(120);

/// A window with nothing but a cube in it, and folders of its own.
struct Window {
    harness: Harness<'static, Editor>,
    folder: tempfile::TempDir,
    handover: Handover,
}

impl Window {
    /// An empty graph.
    fn empty() -> Window {
        Window::with(|_| Session::new(None))
    }

    fn with(session: impl FnOnce(&Folders) -> Session) -> Window {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| Some(folder.path().join(name));
        let folders = Folders {
            settings: at("settings"),
            cache: at("cache"),
            recovery: at("unsaved"),
            library: at("library"),
            examples: at("examples"),
        };
        let session = session(&folders);
        let handover: Handover = Arc::new(Mutex::new(None));
        let harness = open(session, folders, handover.clone());
        Window {
            harness,
            folder,
            handover,
        }
    }

    fn editor(&self) -> &Editor {
        self.harness.state()
    }

    /// Draws frames until nothing moves any more.
    fn settle(&mut self) {
        self.harness.run_steps(4);
    }

    /// Draws frames until something is so.
    fn until(&mut self, what: &str, is_so: impl Fn(&Editor) -> bool) {
        let began = Instant::now();
        while !is_so(self.harness.state()) {
            assert!(began.elapsed() < PATIENCE, "{what} did not come");
            self.harness.step();
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Puts the pointer somewhere.
    fn point(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.harness.step();
    }

    fn button(&mut self, at: Pos2, button: PointerButton, pressed: bool, modifiers: Modifiers) {
        self.harness.event(Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers,
        });
        self.harness.step();
    }

    /// Drags from one place to another, by way of the middle.
    fn drag(&mut self, from: Pos2, to: Pos2, button: PointerButton, modifiers: Modifiers) {
        self.harness.event(Event::PointerMoved(from));
        self.harness.step();
        self.button(from, button, true, modifiers);
        for share in [0.25, 0.5, 0.75, 1.0] {
            self.harness.event(Event::PointerMoved(from.lerp(to, share)));
            self.harness.step();
        }
        self.button(to, button, false, modifiers);
        self.settle();
    }

    fn key(&mut self, key: Key) {
        self.keys(Modifiers::NONE, key);
    }

    fn keys(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.settle();
    }

    /// Where an empty place of the canvas is: `[0, 0]` is its upper left corner, `[1, 1]` the lower right one.
    fn on_canvas(&self, share: [f32; 2]) -> Pos2 {
        let rect = self.editor().rects[&crate::dock::Panel::Canvas];
        rect.min + vec2(share[0] * rect.width(), share[1] * rect.height())
    }

    /// Adds a node by the menu at a place of the canvas.
    fn add(&mut self, share: [f32; 2], query: &str) -> NodeId {
        let at = self.on_canvas(share);
        self.point(at);
        self.key(Key::Tab);
        self.harness.event(Event::Text(query.to_owned()));
        self.settle();
        self.key(Key::Enter);
        let added = self.editor().desk.selected_one().cloned();
        added.unwrap_or_else(|| panic!("nothing is called '{query}'"))
    }

    /// Where a port of a node is on the screen, found by what is said of it to those who do not see it.
    fn port(&self, node: &NodeId, name: &str) -> Pos2 {
        let desk = &self.editor().desk;
        let face = desk.face(node).expect("a node").clone();
        let (side, port) = match face.input(name) {
            Some(port) => ("input", port),
            None => ("output", face.output(Some(name)).expect("a port")),
        };
        let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
        let said = format!("{}, {side} {}, {carries}", desk.title(node), port.label);
        self.harness.get_by_label(&said).rect().center()
    }

    /// Drags a wire from one port to another.
    fn wire(&mut self, from: (&NodeId, &str), to: (&NodeId, &str)) {
        let ends = [self.port(from.0, from.1), self.port(to.0, to.1)];
        self.drag(ends[0], ends[1], PointerButton::Primary, Modifiers::NONE);
    }

    fn wire_into(&self, node: &NodeId, input: &str) -> Option<OutputRef> {
        let slot = SlotRef {
            node: node.clone(),
            name: input.to_owned(),
        };
        self.editor().desk.wire_into(&slot).cloned()
    }

    /// The graph's text.
    fn text(&mut self) -> String {
        self.harness.state_mut().desk.session.text().to_owned()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

/// A window on the software driver.
fn open(session: Session, folders: Folders, handover: Handover) -> Harness<'static, Editor> {
    let setup = configuration(&AdapterChoice::Cpu).wgpu_setup;
    let model = cube(&folders);
    let builder = Harness::builder().with_size(vec2(1600.0, 900.0)).with_max_steps(400);
    builder.wgpu_setup(setup).build_eframe(move |context| {
        let render = context.wgpu_render_state.clone().expect(INSTALL);
        let gpu = Gpu::adopt_device(&render.adapter, render.device.clone(), render.queue.clone()).expect(INSTALL);
        let beginning = Beginning {
            session,
            model,
            folders,
            is_start: false,
        };
        Editor::new(beginning, &context.egui_ctx, Arc::new(gpu), Some(render), handover)
    })
}

/// A model that is quick to evaluate.
fn cube(folders: &Folders) -> PathBuf {
    let folder = folders.examples.as_ref().expect("a folder for examples");
    let file = folder.join("cube.glb");
    std::fs::create_dir_all(folder).expect("a folder");
    let bytes = include_bytes!("../../../../assets/meshes/cube.glb");
    std::fs::write(&file, bytes).expect("a model");
    file
}
