//! Tests of the window by clicks and keys, without a screen.

mod answers;
mod brush_tips;
mod building;
mod choice_previews;
mod commands;
mod dropping;
mod export;
mod faults;
mod gradients;
mod graph_views;
mod groups;
mod hands;
mod keyboard;
mod knobs;
mod layers;
mod library;
mod linked_groups;
mod loss_protection;
mod lost_device;
mod manual;
mod many;
mod measures;
mod menu;
mod mouse;
mod moving;
mod newcomers;
mod notes;
mod notices;
mod paint_paths;
mod painting;
mod panels;
mod param_masks;
mod paths;
mod pens;
mod ports;
mod recovering;
mod reroutes;
mod safety;
mod second_window;
mod sizes;
mod snapshots;
mod start_page;
mod stencils;
mod stroke_list;
mod trust;
mod views;
mod watching;
mod whole_graph;
mod window_painting;
mod wires;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sabi_editing::{OpenDocument, node_paths};
use sabi_engine::Session;
use sabi_files::TrustedPaths;
use sabi_gpu::{AdapterChoice, Gpu};

use super::{Editor, Handover, InitialState, ProgramFolders};
use crate::dock::Workspace;
use crate::window::configuration;

/// Message where there is no Vulkan driver.
const INSTALL: &str = "this test needs a software Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1";
/// Time limit of every wait, far longer than any result takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Window that shows a cube, with folders of its own.
struct Window {
    harness: Harness<'static, Editor>,
    folder: tempfile::TempDir,
    handover: Handover,
}

impl Window {
    /// An empty graph, with small results so that they arrive soon.
    fn empty() -> Window {
        Window::opened("")
    }

    /// A graph of these nodes in a file of its own.
    fn opened(nodes: &str) -> Window {
        Window::with(|folders| {
            let file = beside(folders).join("graph.sabi");
            std::fs::write(&file, graph_text(nodes)).expect("a graph");
            Session::open(&file, folders.recovery.as_deref()).expect("a graph that can be read")
        })
    }

    /// A graph without a file.
    fn untitled() -> Window {
        Window::with(|folders| Session::new(folders.recovery.as_deref()))
    }

    fn with(session: impl FnOnce(&ProgramFolders) -> Session) -> Window {
        Window::in_folder(tempfile::tempdir().expect("a folder"), session)
    }

    /// A window with other folders than usual.
    fn prepared(prepare: impl FnOnce(&mut ProgramFolders), session: impl FnOnce(&ProgramFolders) -> Session) -> Window {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = folders_in(folder.path());
        prepare(&mut folders);
        Window::in_folders(folder, folders, session)
    }

    /// A window in the folder of an earlier one.
    fn in_folder(folder: tempfile::TempDir, session: impl FnOnce(&ProgramFolders) -> Session) -> Window {
        let folders = folders_in(folder.path());
        Window::in_folders(folder, folders, session)
    }

    fn in_folders(
        folder: tempfile::TempDir,
        folders: ProgramFolders,
        session: impl FnOnce(&ProgramFolders) -> Session,
    ) -> Window {
        let model = cube(&folders);
        Window::beginning_on(folder, folders, &model, session)
    }

    /// A window whose first model is not the cube.
    fn beginning_on(
        folder: tempfile::TempDir,
        folders: ProgramFolders,
        model: &Path,
        session: impl FnOnce(&ProgramFolders) -> Session,
    ) -> Window {
        let session = session(&folders);
        let handover: Handover = Arc::new(Mutex::new(None));
        let harness = open(session, folders, model.to_owned(), handover.clone());
        Window {
            harness,
            folder,
            handover,
        }
    }

    /// The next window after a crash.
    fn after_a_crash(self) -> Window {
        drop(self.harness.into_state().documents.document.session);
        let mut next = Window::in_folder(self.folder, |_| Session::new(None));
        next.settle();
        next
    }

    fn editor(&self) -> &Editor {
        self.harness.state()
    }

    fn document(&self) -> &OpenDocument {
        &self.harness.state().documents.document
    }

    /// Draws frames until animations have ended.
    fn settle(&mut self) {
        self.harness.run_steps(3);
    }

    /// Draws frames until a condition holds.
    fn until(&mut self, what: &str, is_so: impl Fn(&Editor) -> bool) {
        let began = Instant::now();
        while !is_so(self.harness.state()) {
            assert!(began.elapsed() < PATIENCE, "{what} did not come");
            self.harness.step();
            std::thread::sleep(Duration::from_millis(5));
        }
        self.settle();
    }

    /// Waits for the texture of a node.
    fn until_inspected(&mut self, node: &str) {
        self.until("the texture", |editor| {
            let inspected = editor.evaluation.results.inspected.as_ref();
            inspected.is_some_and(|(shown, _)| shown.node == node)
        });
    }

    /// The graph's text.
    fn text(&mut self) -> String {
        self.harness.state_mut().documents.document.session.text().to_owned()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Returns whether a sentence that contains this text is shown.
    fn says(&self, part: &str) -> bool {
        self.harness.query_all_by_label_contains(part).next().is_some()
    }

    /// Sentence about the fault of a node, by its id in the evaluation, as the window shows it.
    fn fault_of(&self, node: &str) -> String {
        let fault = self.editor().evaluation.faults.of(node).expect("a sentence");
        node_paths::with_titles(self.document(), fault)
    }

    fn undo(&mut self, times: usize) {
        for _ in 0..times {
            self.keys(Modifiers::COMMAND, Key::Z);
        }
    }

    fn redo(&mut self, times: usize) {
        for _ in 0..times {
            self.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        }
    }
}

/// A file of a graph with these nodes.
fn graph_text(nodes: &str) -> String {
    format!(r#"{{ "format": "sabi", "version": 1, "preview": {{ "size": 64 }}, "nodes": {{ {nodes} }} }}"#)
}

fn folders_in(folder: &Path) -> ProgramFolders {
    let at = |name: &str| Some(folder.join(name));
    ProgramFolders {
        settings: at("settings"),
        // The cache is by content, and shared by all tests.
        cache: Some(
            Path::new(env!("CARGO_MANIFEST_DIR"))
                .join("../../target")
                .join("tmp/window"),
        ),
        recovery: at("unsaved"),
        library: at("library"),
        effects: None,
        examples: at("examples"),
    }
}

/// Parent folder of the folders of a window.
fn beside(folders: &ProgramFolders) -> &Path {
    let settings = folders.settings.as_deref().and_then(Path::parent);
    settings.expect("a folder for settings")
}

/// A window on the software driver.
fn open(session: Session, folders: ProgramFolders, model: PathBuf, handover: Handover) -> Harness<'static, Editor> {
    let setup = configuration(&AdapterChoice::Cpu).wgpu_setup;
    let builder = Harness::builder()
        .with_size(vec2(1600.0, 900.0))
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(4);
    builder.wgpu_setup(setup).build_eframe(move |context| {
        let render = context.wgpu_render_state.clone().expect(INSTALL);
        let gpu = Gpu::adopt_device(&render.adapter, render.device.clone(), render.queue.clone()).expect(INSTALL);
        let beginning = InitialState {
            session,
            model,
            is_model_given: true,
            trusted: TrustedPaths::default(),
            folders,
            is_start: false,
            at_end: || {},
        };
        let mut editor = Editor::new(beginning, &context.egui_ctx, Arc::new(gpu), Some(render), handover);
        // One sample, so that pictures are quick.
        editor.views.model.shot.samples = 1;
        if editor.shell.settings.layout.is_none() {
            // Most tests need the 2D view as well. Set before the first frame, because it changes places on the screen.
            editor.shell.dock.arrange(Workspace::Texture);
        }
        editor
    })
}

/// A model that is quick to evaluate.
fn cube(folders: &ProgramFolders) -> PathBuf {
    let folder = folders.examples.as_ref().expect("a folder for examples");
    let file = folder.join("cube.glb");
    std::fs::create_dir_all(folder).expect("a folder");
    let bytes = include_bytes!("../../../../assets/meshes/cube.glb");
    std::fs::write(&file, bytes).expect("a model");
    file
}
