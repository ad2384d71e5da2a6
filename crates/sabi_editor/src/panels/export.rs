//! Textures written for engines.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread;

use egui::{RichText, Ui};
use sabi_engine::{BakeReport, EngineError, Progress, Stage, export_presets};

use crate::app::Editor;
use crate::theme::{Theme, space};

/// Sizes that are offered.
const SIZES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

/// What the panel holds from frame to frame.
pub(crate) struct Export {
    pub(crate) folder: String,
    pub(crate) preset: String,
    pub(crate) size: u32,
    pub(crate) has_model: bool,
    pub(crate) all_maps: bool,
    pub(crate) running: Option<Running>,
    /// What came of the last one.
    told: Option<Result<Vec<String>, String>>,
}

impl Default for Export {
    fn default() -> Export {
        Export {
            folder: String::new(),
            preset: "raw".to_owned(),
            size: 2048,
            has_model: false,
            all_maps: false,
            running: None,
            told: None,
        }
    }
}

/// An export that is being made.
pub(crate) struct Running {
    watch: Arc<Watch>,
    done: Receiver<Result<BakeReport, EngineError>>,
}

/// How far it is.
#[derive(Default)]
struct Watch {
    is_canceled: AtomicBool,
    done: AtomicUsize,
    of: AtomicUsize,
    stage: Mutex<Option<Stage>>,
}

impl Progress for Watch {
    fn advance(&self, stage: Stage, done: usize, of: usize) {
        if let Ok(mut known) = self.stage.lock() {
            *known = Some(stage);
        }
        self.done.store(done, Ordering::Relaxed);
        self.of.store(of, Ordering::Relaxed);
    }

    fn is_canceled(&self) -> bool {
        self.is_canceled.load(Ordering::Relaxed)
    }
}

impl Running {
    /// Begins a piece of work beside the window.
    pub(crate) fn start(
        context: &egui::Context,
        work: impl FnOnce(&dyn Progress) -> Result<BakeReport, EngineError> + Send + 'static,
    ) -> Running {
        let watch = Arc::new(Watch::default());
        let (sender, done) = channel();
        let (watched, woken) = (watch.clone(), context.clone());
        thread::spawn(move || {
            // A window that was closed meanwhile does not listen.
            let _ = sender.send(work(watched.as_ref()));
            woken.request_repaint();
        });
        Running { watch, done }
    }
}

impl Export {
    /// Takes what came of a running export.
    pub(crate) fn poll(&mut self) {
        let Some(done) = self.running.as_ref().and_then(|running| running.done.try_recv().ok()) else {
            return;
        };
        self.running = None;
        self.told = Some(match done {
            Ok(report) => Ok(report.files.iter().chain(&report.warnings).cloned().collect()),
            Err(error) => Err(error.to_string()),
        });
    }
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme) {
    let export = &mut editor.panels.export;
    egui::Grid::new("export")
        .num_columns(2)
        .spacing([space::USUAL, space::USUAL])
        .show(ui, |ui| {
            ui.label("Preset");
            egui::ComboBox::from_id_salt("preset")
                .selected_text(&export.preset)
                .show_ui(ui, |ui| {
                    for preset in export_presets() {
                        ui.selectable_value(&mut export.preset, preset.to_owned(), preset);
                    }
                });
            ui.end_row();
            ui.label("Size");
            egui::ComboBox::from_id_salt("size")
                .selected_text(export.size.to_string())
                .show_ui(ui, |ui| {
                    for size in SIZES {
                        ui.selectable_value(&mut export.size, size, size.to_string());
                    }
                });
            ui.end_row();
            let label = ui.label("Folder").id;
            ui.horizontal(|ui| {
                ui.add(egui::TextEdit::singleline(&mut export.folder).desired_width(ui.available_width() - 40.0))
                    .labelled_by(label);
                if ui.button("…").clicked()
                    && let Some(folder) = rfd::FileDialog::new().pick_folder()
                {
                    export.folder = folder.display().to_string();
                }
            });
            ui.end_row();
            ui.label("");
            ui.checkbox(&mut export.has_model, "The model with them");
            ui.end_row();
            ui.label("");
            ui.checkbox(&mut export.all_maps, "Constant channels too");
            ui.end_row();
            ui.label("");
            ui.checkbox(&mut editor.settings.exports_on_save, "Again at every save");
            ui.end_row();
        });
    ui.add_space(space::USUAL);
    let export = &mut editor.panels.export;
    match &export.running {
        Some(running) => {
            let watch = &running.watch;
            let share = watch.done.load(Ordering::Relaxed) as f32 / watch.of.load(Ordering::Relaxed).max(1) as f32;
            let label = watch
                .stage
                .lock()
                .map_or("", |stage| stage.map_or("Reading", Stage::label));
            ui.label(label);
            ui.add(egui::ProgressBar::new(share).fill(theme.accent).desired_height(6.0));
            if ui.button("Cancel").clicked() {
                watch.is_canceled.store(true, Ordering::Relaxed);
            }
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(250));
        }
        None => {
            let button = egui::Button::new(RichText::new("Export").color(theme.on_accent)).fill(theme.accent);
            if ui.add_sized([ui.available_width(), 28.0], button).clicked() {
                editor.export();
            }
        }
    }
    told(editor, ui, theme);
}

fn told(editor: &Editor, ui: &mut Ui, theme: &Theme) {
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show(ui, |ui| match &editor.panels.export.told {
            Some(Ok(files)) if files.is_empty() => {
                let why = "Every channel is the same everywhere, so that there is nothing to write; switch on \"Constant \
                           channels too\" for maps all the same.";
                ui.colored_label(theme.quiet, why);
            }
            Some(Ok(files)) => {
                ui.colored_label(theme.good, "Written:");
                for file in files {
                    ui.colored_label(theme.quiet, file);
                }
            }
            Some(Err(why)) => {
                ui.colored_label(theme.fault, why);
            }
            None => {}
        });
}

/// The folder that was typed; a relative one is beside the graph.
pub(crate) fn folder_of(text: &str, graph: Option<&std::path::Path>) -> Option<PathBuf> {
    let typed = PathBuf::from(text.trim());
    if typed.as_os_str().is_empty() {
        return None;
    }
    let beside = graph.and_then(|graph| graph.parent());
    Some(beside.map_or(typed.clone(), |folder| folder.join(typed)))
}
