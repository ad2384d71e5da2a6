//! Textures written for engines.

mod running;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use egui::{RichText, TextEdit, Ui};
use sabi_engine::{BakeReport, DEFAULT_NAMES, Phase, export_channels, export_presets, why_no_names};

use crate::app::Editor;
use crate::errand::Failed;
use crate::files::system_dialog::{SystemDialog, answer_of};
use crate::theme::{Theme, space};

pub(crate) use running::{Bake, Running};

/// Sizes that are offered.
const SIZES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

/// What is exported and how; kept between runs.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ExportChoices {
    pub(crate) preset: String,
    /// Texels along a side.
    pub(crate) size: u32,
    /// How maps are called; empty for what they are usually called.
    pub(crate) names: String,
    /// Only maps of these channels; empty for all.
    pub(crate) channels: Vec<String>,
    pub(crate) has_model: bool,
    pub(crate) all_maps: bool,
}

impl Default for ExportChoices {
    fn default() -> ExportChoices {
        ExportChoices {
            preset: export_presets().next().unwrap_or_default().to_owned(),
            size: 2048,
            names: String::new(),
            channels: Vec::new(),
            has_model: false,
            all_maps: false,
        }
    }
}

impl ExportChoices {
    /// What of it can be used: files of settings may have been written by hand.
    pub(crate) fn sound(mut self) -> ExportChoices {
        let usual = ExportChoices::default();
        if !export_presets().any(|preset| preset == self.preset) {
            self.preset = usual.preset;
        }
        if !SIZES.contains(&self.size) {
            self.size = usual.size;
        }
        let known = export_channels();
        self.channels.retain(|channel| known.contains(channel));
        self
    }
}

/// Where textures of a graph go; kept between runs.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ExportPlace {
    pub(crate) folder: String,
    /// Whether they are written again at every save.
    pub(crate) again: bool,
    /// The model that those which are there are of.
    pub(crate) model: Option<PathBuf>,
}

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Export {
    pub(crate) place: ExportPlace,
    pub(crate) running: Option<Running>,
    /// What follows the running one, since graphs were saved meanwhile: of those graphs, whichever is open by then.
    pub(crate) queued: VecDeque<Bake>,
    /// The folder has files of somebody else, and it is to be said whether maps go there all the same.
    pub(crate) asks_force: bool,
    /// The system's dialog for the folder, while it is open.
    dialog: Option<SystemDialog>,
    /// What came of the last one.
    told: Option<Result<Told, String>>,
}

/// What a bake wrote, and what it has to say.
struct Told {
    files: Vec<String>,
    warnings: Vec<String>,
}

impl Export {
    /// Textures of another graph go elsewhere.
    pub(crate) fn turn_to(&mut self, place: ExportPlace) {
        self.place = place;
        self.asks_force = false;
        self.dialog = None;
        self.told = None;
    }

    /// Takes what came of a running export; says whether it is over.
    pub(crate) fn poll(&mut self) -> bool {
        let Some(done) = self.running.as_ref().and_then(|running| running.errand.poll()) else {
            return false;
        };
        let done = match done {
            Ok(done) => done.map_err(|error| error.to_string()),
            Err(Failed) => Err(
                "The export ended before its time, which is a mistake of the program; nothing was changed.".to_owned(),
            ),
        };
        self.running = None;
        let told = |report: BakeReport| Told {
            files: report.files,
            warnings: report.warnings.iter().map(ToString::to_string).collect(),
        };
        self.told = Some(done.map(told));
        true
    }

    /// Lets a running export go.
    pub(crate) fn cancel(&mut self) {
        self.queued.clear();
        if let Some(running) = &self.running {
            running.watch.is_canceled.store(true, Ordering::Relaxed);
        }
    }
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme) {
    let grid = egui::Grid::new("export")
        .num_columns(2)
        .spacing([space::USUAL, space::USUAL]);
    grid.show(ui, |ui| {
        choices(&mut editor.settings.export, ui, theme);
        folder(&mut editor.panels.export, ui);
        switches(editor, ui);
    });
    ui.add_space(space::USUAL);
    progress(editor, ui, theme);
    told(editor, ui, theme);
}

fn choices(export: &mut ExportChoices, ui: &mut Ui, theme: &Theme) {
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
    ui.label("Channels");
    let menu = ui.menu_button(told_channels(&export.channels), |ui| channels(&mut export.channels, ui));
    menu.response.on_hover_text("Maps of these are written");
    ui.end_row();
    let label = ui.label("Names").id;
    let field = TextEdit::singleline(&mut export.names)
        .hint_text(DEFAULT_NAMES)
        .desired_width(ui.available_width());
    ui.add(field)
        .labelled_by(label)
        .on_hover_text("{material}, {channel}, {graph} and {size} stand for what they say");
    ui.end_row();
    if let Some(why) = why_no_names(&export.names).filter(|_| !export.names.is_empty()) {
        ui.label("");
        ui.add(egui::Label::new(RichText::new(why).color(theme.fault)).wrap());
        ui.end_row();
    }
}

fn told_channels(channels: &[String]) -> String {
    match channels {
        [] => "All".to_owned(),
        [one] => one.clone(),
        several => format!("{} of {}", several.len(), export_channels().len()),
    }
}

/// Switches for channels; all of them is the same as none.
fn channels(chosen: &mut Vec<String>, ui: &mut Ui) {
    let known = export_channels();
    let is_chosen = |channel: &String| chosen.is_empty() || chosen.contains(channel);
    let mut switches: Vec<bool> = known.iter().map(is_chosen).collect();
    let mut is_changed = false;
    for (channel, is_on) in known.iter().zip(&mut switches) {
        is_changed |= ui.checkbox(is_on, channel).changed();
    }
    if is_changed {
        let on = known.iter().zip(&switches).filter(|(_, is_on)| **is_on);
        *chosen = on.map(|(channel, _)| channel.clone()).collect();
        if chosen.len() == known.len() {
            chosen.clear();
        }
    }
}

fn folder(export: &mut Export, ui: &mut Ui) {
    let label = ui.label("Folder").id;
    ui.horizontal(|ui| {
        let field = TextEdit::singleline(&mut export.place.folder).desired_width(ui.available_width() - 40.0);
        if ui.add(field).labelled_by(label).changed() {
            export.asks_force = false;
        }
        let asks = ui.button("…").on_hover_text("The system's dialog for a folder");
        if asks.clicked() {
            export.dialog = Some(SystemDialog::folder(ui.ctx()));
        }
        if let Some(folder) = answer_of(&mut export.dialog) {
            export.place.folder = folder.display().to_string();
            export.asks_force = false;
        }
    });
    ui.end_row();
}

fn switches(editor: &mut Editor, ui: &mut Ui) {
    let export = &mut editor.settings.export;
    let all = [
        (&mut export.has_model, "The model with them"),
        (&mut export.all_maps, "Constant channels too"),
        (&mut editor.panels.export.place.again, "Again at every save"),
    ];
    for (is_on, label) in all {
        ui.label("");
        ui.checkbox(is_on, label);
        ui.end_row();
    }
}

/// How far a running export is, or the ways to begin one.
fn progress(editor: &mut Editor, ui: &mut Ui, theme: &Theme) {
    if let Some(running) = &editor.panels.export.running {
        let watch = &running.watch;
        let phase = watch.phase.lock().ok().and_then(|phase| *phase);
        ui.label(phase.map_or("Reading", Phase::label));
        ui.add(
            egui::ProgressBar::new(watch.share())
                .fill(theme.accent)
                .desired_height(6.0),
        );
        let is_canceled = ui.button("Cancel").clicked();
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(250));
        if is_canceled {
            editor.panels.export.cancel();
        }
        return;
    }
    if editor.panels.export.asks_force {
        let sentence = "This folder has files, and none of them is a map of this graph.";
        ui.add(egui::Label::new(RichText::new(sentence).color(theme.warning)).wrap());
        if ui.button("Put the textures there all the same").clicked() {
            editor.export_into_any_folder();
        }
    }
    let button = egui::Button::new(RichText::new("Export").color(theme.on_accent)).fill(theme.accent);
    if ui.add_sized([ui.available_width(), 28.0], button).clicked() {
        editor.export();
    }
}

fn told(editor: &Editor, ui: &mut Ui, theme: &Theme) {
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show(ui, |ui| match &editor.panels.export.told {
            Some(Ok(told)) if told.files.is_empty() => {
                let why = "Every channel is the same everywhere, so that there is nothing to write; switch on \"Constant \
                           channels too\" for maps all the same.";
                ui.colored_label(theme.quiet, why);
            }
            Some(Ok(told)) => {
                ui.colored_label(theme.good, "Written:");
                for file in &told.files {
                    ui.colored_label(theme.quiet, file);
                }
                for warning in &told.warnings {
                    ui.colored_label(theme.warning, warning);
                }
            }
            Some(Err(why)) => {
                ui.colored_label(theme.fault, why);
            }
            None => {}
        });
}

/// The folder that was typed; a relative one is beside the graph, and nowhere while the graph has no file.
pub(crate) fn folder_of(text: &str, graph: Option<&Path>) -> Option<PathBuf> {
    let typed = PathBuf::from(text.trim());
    if typed.as_os_str().is_empty() {
        return None;
    }
    match graph.and_then(Path::parent) {
        Some(folder) => Some(folder.join(typed)),
        None => Some(typed).filter(|typed| typed.is_absolute()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_beside_the_graph_and_never_where_the_program_was_started() {
        let graph = Path::new("project").join("worn.sabi");
        let whole = std::env::temp_dir();
        let told = whole.display().to_string();
        assert_eq!(folder_of(" maps ", Some(&graph)), Some(PathBuf::from("project/maps")));
        assert_eq!(folder_of(&told, Some(&graph)), Some(whole.clone()));
        assert_eq!(folder_of("maps", None), None);
        assert_eq!(folder_of(&told, None), Some(whole));
        assert_eq!(folder_of("  ", Some(&graph)), None);
    }

    #[test]
    fn choices_that_nobody_knows_are_left_out() {
        let choices = ExportChoices {
            preset: "mine".to_owned(),
            size: 1000,
            channels: vec!["normal".to_owned(), "smell".to_owned()],
            ..ExportChoices::default()
        };
        let channels = vec!["normal".to_owned()];
        let expected = ExportChoices {
            channels,
            ..ExportChoices::default()
        };
        assert_eq!(choices.sound(), expected);
    }
}
