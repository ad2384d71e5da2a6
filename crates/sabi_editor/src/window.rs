//! Opens the window on a device that can run Sabi, and again on another one when that is lost.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use sabi_engine::effect_library::effect_library;
use sabi_engine::opening::default_cache_dir;
use sabi_engine::{EngineError, ErrorKind, Remedy, Session};
use sabi_files::TrustedPaths;
use sabi_gpu::{AdapterChoice, Gpu, choose_adapter, device_descriptor};

use crate::app::{Editor, Handover, InitialState, ProgramFolders};
use crate::builtin_models::model_of;
use crate::files::{examples, new_graph};
use crate::paths::in_canonical_folder;
use crate::settings::default_folder;

/// Devices that may be lost in quick succession before the window is given up.
const MOST_DEVICES: usize = 3;
/// Time after which the loss of a device counts as the first one again.
const SOON: Duration = Duration::from_secs(60);

/// Time for a window to close after its device was lost.
const AFTER_A_LOSS: Duration = Duration::from_secs(60);

/// Options for opening the window.
#[derive(Clone, Debug)]
pub struct EditRequest {
    /// Graph file; an empty graph if none.
    pub graph: Option<PathBuf>,
    /// Model file, in place of the one that the graph names.
    pub mesh: Option<PathBuf>,
    /// Adapter to run on.
    pub adapter: AdapterChoice,
    /// Paths from which graphs and models may open the files that they name.
    pub trusted: TrustedPaths,
    /// Called if the window does not end after its device was lost; the last copy of unsaved work is offered at the
    /// next start.
    pub at_hang: fn(),
    /// Called once the window is closed for good and all work is kept. After it, the program waits for the device,
    /// which may compile or compute for long.
    pub at_end: fn(),
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// A graph that cannot be read, no display, or no adapter that can run Sabi.
pub fn edit(request: &EditRequest) -> Result<(), EngineError> {
    let folders = folders();
    let handover: Handover = Arc::new(Mutex::new(None));
    let mut session = Some(match &request.graph {
        Some(graph) => Session::open(graph, folders.recovery.as_deref())?,
        None => new_graph::session(folders.recovery.as_deref())?,
    });
    refuse_without_display()?;
    until_closed(|| {
        // After a loss, the document and its model are in the handover.
        let (session, model) = match session.take() {
            Some(session) => {
                let model = first_model(request, &session, &folders)?;
                (session, model)
            }
            None => (Session::new(None), PathBuf::new()),
        };
        let initial = InitialState {
            model,
            session,
            is_model_given: request.mesh.is_some(),
            trusted: match &request.mesh {
                Some(mesh) => request.trusted.clone().with_file(mesh),
                None => request.trusted.clone(),
            },
            folders: folders.clone(),
            is_start: request.graph.is_none(),
            at_end: request.at_end,
        };
        let opened = Instant::now();
        run(request, initial, &handover)?;
        let is_lost = handover.lock().is_ok_and(|kept| kept.is_some());
        Ok(is_lost.then(|| opened.elapsed()))
    })
}

/// Opens windows until one is closed; `open` returns the time until its window lost the device.
fn until_closed(mut open: impl FnMut() -> Result<Option<Duration>, EngineError>) -> Result<(), EngineError> {
    let mut lost_soon = 0;
    while lost_soon < MOST_DEVICES {
        let Some(lasted) = open()? else {
            return Ok(());
        };
        lost_soon = if lasted < SOON { lost_soon + 1 } else { 1 };
    }
    let why = "the graphics device was lost again and again; what is not saved is offered at the next start";
    let lost = EngineError::new(ErrorKind::NoAdapter, why);
    Err(lost.with_remedies([Remedy::UpdateDriver, Remedy::SoftwareAdapter]))
}

/// Refuses to open a window without a display, since the error of the libraries below is hard to understand.
fn refuse_without_display() -> Result<(), EngineError> {
    let is_set = |name: &&str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if !cfg!(target_os = "linux") || ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"].iter().any(is_set) {
        return Ok(());
    }
    let why = "there is no display to open a window on: neither WAYLAND_DISPLAY nor DISPLAY is set; use sabi bake, preview \
               and render, which need none";
    Err(EngineError::new(ErrorKind::NoAdapter, why))
}

fn run(request: &EditRequest, initial: InitialState, handover: &Handover) -> Result<(), EngineError> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Sabi")
            .with_app_id("sabi")
            .with_inner_size([1600.0, 900.0])
            .with_min_inner_size([640.0, 400.0])
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        run_and_return: true,
        wgpu_options: configuration(&request.adapter),
        ..eframe::NativeOptions::default()
    };
    let (handover, at_hang) = (handover.clone(), request.at_hang);
    let is_open = Arc::new(());
    let kept_open = Arc::clone(&is_open);
    let created = move |context: &eframe::CreationContext<'_>| {
        let render = context
            .wgpu_render_state
            .clone()
            .ok_or("the window has no graphics device")?;
        let gpu = Gpu::adopt_device(&render.adapter, render.device.clone(), render.queue.clone())?;
        watch_loss(&gpu, Arc::downgrade(&kept_open), AFTER_A_LOSS, at_hang);
        let editor = Editor::new(initial, &context.egui_ctx, Arc::new(gpu), Some(render), handover);
        Ok(Box::new(editor) as Box<dyn eframe::App>)
    };
    let closed = eframe::run_native("sabi", options, Box::new(created));
    drop(is_open);
    closed.map_err(|error| {
        let why = format!("the window cannot be opened: {error}. Without a display, use sabi bake, preview and render");
        EngineError::new(ErrorKind::NoAdapter, why)
    })
}

/// Calls `at_hang` if a window is still open some time after its device was lost. The reason is a fault of wgpu 29,
/// which frees the resources of a lost device under locks that an upload takes in the opposite order: two threads may
/// wait for each other forever.
fn watch_loss(gpu: &Gpu, window: Weak<()>, patience: Duration, at_hang: fn()) {
    gpu.when_lost(move || {
        std::thread::spawn(move || {
            std::thread::sleep(patience);
            if window.strong_count() > 0 {
                at_hang();
            }
        });
    });
}

/// Configuration of a device that Sabi can run on, for an adapter.
pub(crate) fn configuration(choice: &AdapterChoice) -> WgpuConfiguration {
    let choice = choice.clone();
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::PRIMARY;
    setup.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        choose_adapter(&choice, adapters, surface).map_err(|error| EngineError::from(error).to_string())
    }));
    setup.device_descriptor = Arc::new(|adapter| {
        // Cannot fail: the selector refuses adapters that cannot run Sabi.
        device_descriptor(adapter).unwrap_or_default()
    });
    WgpuConfiguration {
        wgpu_setup: WgpuSetup::CreateNew(setup),
        ..WgpuConfiguration::default()
    }
}

fn folders() -> ProgramFolders {
    let settings = default_folder();
    let library = settings.as_ref().map(|folder| folder.join("effects"));
    let effects = library.and_then(|folder| match effect_library(&folder) {
        Ok(effects) => Some(effects),
        Err(error) => {
            tracing::error!("the effect library is not there: {error}");
            None
        }
    });
    ProgramFolders {
        effects,
        recovery: settings.as_ref().map(|folder| folder.join("unsaved")),
        library: settings.as_ref().map(|folder| folder.join("library")),
        examples: settings.as_ref().map(|folder| folder.join(examples::EXAMPLES_FOLDER)),
        cache: default_cache_dir(),
        settings,
    }
}

/// First model: the requested one, the one that the graph names, or a built-in one.
fn first_model(request: &EditRequest, session: &Session, folders: &ProgramFolders) -> Result<PathBuf, EngineError> {
    if let Some(mesh) = &request.mesh {
        return Ok(in_canonical_folder(mesh));
    }
    let examples = folders.examples.as_deref();
    if let Some(Ok(model)) = model_of(session, examples) {
        return Ok(in_canonical_folder(&examples::at_home(examples, model)));
    }
    folders.first_model()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Number of windows that are opened for devices that last these times, and the result.
    fn opened(devices: &[Option<Duration>]) -> (usize, Result<(), EngineError>) {
        let mut left = devices.iter();
        let ended = until_closed(|| Ok(left.next().copied().flatten()));
        (devices.len() - left.len(), ended)
    }

    #[test]
    fn a_window_opens_again_unless_devices_are_lost_in_quick_succession() {
        let (soon, late) = (Some(Duration::from_secs(1)), Some(SOON));
        assert_eq!(opened(&[None, soon]), (1, Ok(())), "one that is closed stays closed");
        assert_eq!(opened(&[soon, soon, None]), (3, Ok(())));
        assert_eq!(opened(&[late; 20]), (20, Ok(())), "and then the next one is closed");
        let (times, ended) = opened(&[soon, late, soon, soon, soon]);
        assert_eq!(times, 4, "one that lasted begins the count anew");
        let why = ended.expect_err("given up").to_string();
        assert!(why.contains("lost again and again"), "{why}");
    }

    #[test]
    fn a_window_that_stays_open_on_a_lost_device_is_reported_as_hanging() {
        static TOLD: AtomicUsize = AtomicUsize::new(0);
        let patience = Duration::from_millis(20);
        for (keeps, told) in [(false, 0), (true, 1)] {
            let gpu = Gpu::open(&AdapterChoice::Cpu).expect("a software driver");
            let window = Arc::new(());
            watch_loss(&gpu, Arc::downgrade(&window), patience, || {
                TOLD.fetch_add(1, Ordering::Relaxed);
            });
            gpu.device().destroy();
            assert!(gpu.loss().is_some());
            let kept = keeps.then_some(window);
            std::thread::sleep(25 * patience);
            assert_eq!(TOLD.load(Ordering::Relaxed), told);
            drop(kept);
        }
    }

    #[test]
    fn a_window_that_cannot_be_opened_says_so() {
        let why = EngineError::new(ErrorKind::NoAdapter, "there is no display");
        assert_eq!(until_closed(|| Err(why.clone())), Err(why));
    }
}
