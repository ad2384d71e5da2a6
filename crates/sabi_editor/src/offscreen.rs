//! The window without a screen, for benchmarks: frames are laid out and tessellated, and the model is drawn, but nothing is
//! presented.

mod painter;

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use eframe::egui_wgpu::{RenderState, WgpuSetup};
use egui::{ClippedPrimitive, Context, Event, RawInput, Rect, TextureId, Vec2};
use sabi_editing::{history, nodes};
use sabi_engine::opening::default_cache_dir;
use sabi_engine::{EngineError, Session};
use sabi_files::TrustedPaths;
use sabi_gpu::{AdapterChoice, Gpu};
use sabi_graph::{Document, Edit, NodeId, Value};

use crate::app::{Editor, InitialState, ProgramFolders};
use crate::dock::Panel;
use crate::window::configuration;
use painter::FramePainter;

/// A window without a screen.
pub struct Offscreen {
    context: Context,
    editor: Editor,
    size: Vec2,
    opened: Instant,
    /// Receives a message when a frame is requested.
    woken: Receiver<()>,
    painter: FramePainter,
}

/// CPU time of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameTime {
    /// Time for layout and actions.
    pub layout: Duration,
    /// Time for tessellation.
    pub tessellation: Duration,
    /// Number of triangles.
    pub triangles: usize,
}

/// A frame after layout and tessellation.
struct TessellatedFrame {
    time: FrameTime,
    primitives: Vec<ClippedPrimitive>,
    /// Textures to free after painting.
    free: Vec<TextureId>,
}

impl FrameTime {
    /// Sum of both times.
    pub fn whole(&self) -> Duration {
        self.layout + self.tessellation
    }
}

impl Offscreen {
    /// Setup of a device that the window can be opened on.
    pub fn setup(adapter: &AdapterChoice) -> WgpuSetup {
        configuration(adapter).wgpu_setup
    }

    /// Opens a graph on a model, on a device made with [`Offscreen::setup`]. Only the cache of evaluations is kept on disk.
    ///
    /// # Errors
    /// A graph that cannot be read, or a device that cannot run Sabi.
    pub fn open(graph: &str, model: PathBuf, render: RenderState, size: [f32; 2]) -> Result<Offscreen, EngineError> {
        let gpu = Gpu::adopt_device(&render.adapter, render.device.clone(), render.queue.clone())?;
        let context = Context::default();
        let (wake, woken) = channel();
        context.set_request_repaint_callback(move |request| {
            // Frames that are requested for later are not waited for.
            if request.delay.is_zero() {
                // Fails once the window is closed.
                let _ = wake.send(());
            }
        });
        let initial = InitialState {
            session: Session::open(graph.as_ref(), None)?,
            model,
            is_model_given: true,
            trusted: TrustedPaths::default(),
            folders: ProgramFolders {
                cache: default_cache_dir(),
                ..ProgramFolders::default()
            },
            is_start: false,
            at_end: || {},
        };
        let painter = FramePainter::new(render.clone(), size.into());
        let handover = Arc::new(Mutex::new(None));
        let editor = Editor::new(initial, &context, Arc::new(gpu), Some(render), handover);
        Ok(Offscreen {
            context,
            editor,
            size: size.into(),
            opened: Instant::now(),
            woken,
            painter,
        })
    }

    /// Lays out a frame with these events, and draws the model where it has changed.
    pub fn frame(&mut self, events: Vec<Event>) -> FrameTime {
        let TessellatedFrame { time, free, .. } = self.tessellate_frame(events);
        self.painter.free(&free);
        time
    }

    /// Lays out and paints a frame with these events as on a screen, and waits for the device. Returns the whole time.
    ///
    /// # Errors
    /// The device is lost.
    pub fn paint(&mut self, events: Vec<Event>) -> Result<Duration, EngineError> {
        let started = Instant::now();
        let TessellatedFrame { primitives, free, .. } = self.tessellate_frame(events);
        self.painter.paint(&primitives);
        self.painter.free(&free);
        self.finish()?;
        Ok(started.elapsed())
    }

    fn tessellate_frame(&mut self, events: Vec<Event>) -> TessellatedFrame {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, self.size)),
            time: Some(self.opened.elapsed().as_secs_f64()),
            focused: true,
            events,
            ..RawInput::default()
        };
        let started = Instant::now();
        let editor = &mut self.editor;
        let output = self.context.run_ui(input, |ui| editor.frame(ui));
        let layout = started.elapsed();
        let started = Instant::now();
        let primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        let triangles = primitives.iter().map(|primitive| match &primitive.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
            egui::epaint::Primitive::Callback(_) => 0,
        });
        let time = FrameTime {
            layout,
            triangles: triangles.sum(),
            tessellation: started.elapsed(),
        };
        self.painter.upload(&output.textures_delta.set);
        TessellatedFrame {
            time,
            primitives,
            free: output.textures_delta.free,
        }
    }

    /// Draws frames as they are requested, until no result is outstanding.
    pub fn rest(&mut self) {
        loop {
            while self.woken.try_recv().is_ok() {}
            self.frame(Vec::new());
            if !self.is_busy() && self.woken.recv_timeout(Duration::from_millis(300)).is_err() {
                return;
            }
            let _ = self.woken.recv_timeout(Duration::from_millis(50));
        }
    }

    /// Waits until a frame is requested, at most this long.
    pub fn wait(&self, longest: Duration) {
        let _ = self.woken.recv_timeout(longest);
        while self.woken.try_recv().is_ok() {}
    }

    /// Returns whether results are outstanding.
    pub fn is_busy(&self) -> bool {
        self.editor.evaluation.is_busy()
    }

    /// Sets a parameter, as a drag or as a single click does.
    pub fn turn(&mut self, node: &str, knob: &str, value: f64, is_drag: bool) {
        let Ok(node) = node.parse::<NodeId>() else { return };
        let documents = &mut self.editor.documents;
        if is_drag && !documents.is_dragging {
            documents.document.session.begin("");
        }
        documents.is_dragging = is_drag;
        nodes::set_knob(
            &mut self.editor.documents.document,
            &node,
            knob,
            Some(Value::Number(value)),
        );
    }

    /// Shows a node's result, as a click on it does.
    pub fn look_at(&mut self, node: &str) {
        let Ok(node) = node.parse::<NodeId>() else { return };
        let Editor { looks, documents, .. } = &mut self.editor;
        looks.show(&documents.document, &node, None);
    }

    /// Paints on a node from now on, as the key for it does.
    pub fn paint_on(&mut self, node: &str) {
        let Ok(node) = node.parse::<NodeId>() else { return };
        let Editor { looks, documents, .. } = &mut self.editor;
        documents.document.select([node]);
        looks.is_painting = true;
    }

    /// The open document.
    pub fn document(&self) -> &Document {
        self.editor.documents.document.contents()
    }

    /// Makes an edit, unless it is refused.
    pub fn edit(&mut self, edit: Edit) {
        self.editor.documents.document.edit("Edit", vec![edit]);
    }

    /// Undoes the last step.
    pub fn undo(&mut self) {
        history::undo(&mut self.editor.documents.document);
    }

    /// Redoes the last step that was undone.
    pub fn redo(&mut self) {
        history::redo(&mut self.editor.documents.document);
    }

    /// Number of pictures of the model that were drawn, and the size of the last result in texels.
    pub fn drawn(&self) -> (u64, u32) {
        let picture = self
            .editor
            .evaluation
            .results
            .picture(&sabi_engine::live::ViewSubject::Outputs);
        (
            self.editor.views.model.pictures.drawn,
            picture.map_or(0, |picture| picture.model.size),
        )
    }

    /// Bytes of cached results, and their limit.
    pub fn kept_bytes(&self) -> [u64; 2] {
        let last = &self.editor.evaluation.results.last;
        [last.texture_bytes, last.budget_bytes]
    }

    /// Waits until the device has drawn everything.
    ///
    /// # Errors
    /// The device is lost.
    pub fn finish(&self) -> Result<(), EngineError> {
        Ok(self.editor.evaluation.gpu().wait()?)
    }

    /// Rectangle of the model's view on the screen.
    pub fn viewport(&self) -> Option<Rect> {
        self.editor.shell.dock.rects.get(&Panel::Viewport).copied()
    }

    /// Rectangle of the canvas on the screen.
    pub fn canvas(&self) -> Option<Rect> {
        self.editor.shell.dock.rects.get(&Panel::Canvas).copied()
    }
}
