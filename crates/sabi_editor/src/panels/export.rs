//! Textures written for engines.

mod preset_menu;

use std::time::Duration;

use egui::{Button, Grid, Label, OpenUrl, ProgressBar, RichText, ScrollArea, TextEdit, Ui};
use sabi_engine::Remedy;
use sabi_engine::baking::{export_channels, name_pattern_fault};
use sabi_files::path_text;

use self::preset_menu::PresetMenu;
use crate::action::{Action, ExportAction};
use crate::activity_text::activity_text;
use crate::context::{View, ViewContext};
use crate::files::system_dialog::{DialogAnswer, NO_DIALOG, SystemDialog, answer_of};
use crate::paths::canonical_if_present;
use crate::remedies::{self, Request};
use crate::settings::export::{ExportChoices, ExportPadding, ExportPlace, SIZES};
use crate::theme::{Theme, space};

/// Height that stays free below the choices for the button that exports, points.
const BELOW_CHOICES: f32 = 60.0;
/// Height that stays free there for a result, as a share of the panel's.
const RESULT_SHARE: f32 = 0.4;

/// Sentence about maps that fit no UVs of the model's file.
const UNWRAPPED: &str =
    "The model was unwrapped here, so the maps fit only a copy of it: switch on \"Include the model\".";

/// Panel of exports.
#[derive(Default)]
pub(crate) struct ExportPanel {
    /// System dialog for the folder, while it is open.
    dialog: Option<SystemDialog>,
    /// Reason why the folder of the dialog is not used.
    refused: Option<String>,
    presets: PresetMenu,
}

impl View for ExportPanel {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let mut chosen = context.settings.export.clone();
        let mut place = context.exports.place.clone();
        // The button that exports stays in sight, however long the list of files is.
        let for_result = match context.exports.result {
            Some(_) => RESULT_SHARE * ui.available_height(),
            None => 0.0,
        };
        let area = ScrollArea::vertical()
            .id_salt("choices")
            .max_height((ui.available_height() - BELOW_CHOICES - for_result).max(0.0))
            .auto_shrink([false, true]);
        area.show(ui, |ui| {
            let grid = Grid::new("export").num_columns(2).spacing([space::USUAL, space::USUAL]);
            grid.show(ui, |ui| {
                if let Some(preset) = self.presets.show(&chosen.preset, ui) {
                    chosen.preset = preset;
                }
                choices(&mut chosen, ui, context.theme);
                self.folder(&mut place, ui);
                let has_variants = !context.document.contents().graph.variants().is_empty();
                switches(&mut chosen, &mut place, has_variants, ui);
            });
            if !chosen.has_model && is_unwrapped(context) {
                ui.add(Label::new(RichText::new(UNWRAPPED).color(context.theme.warning)).wrap());
            }
            self.presets.files(&chosen.preset, ui, context.theme);
        });
        if chosen != context.settings.export {
            actions.push(ExportAction::Choose(chosen));
        }
        if place != context.exports.place {
            actions.push(ExportAction::Target(place));
        }
        ui.add_space(space::USUAL);
        actions.extend(progress(ui, context));
        let mut actions: Vec<Action> = actions.into_iter().map(Action::Export).collect();
        actions.extend(self.result(ui, context));
        actions
    }
}

impl ExportPanel {
    /// Stops waiting for the answer of the system dialog, since another graph is opened.
    pub(crate) fn forget_dialog(&mut self) {
        self.dialog = None;
    }

    /// Files and warnings of the last export, or its error, with buttons that apply remedies.
    fn result(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let theme = context.theme;
        let request = Request::Export(&context.settings.export);
        let import = context.evaluation.model.import_options();
        let area = ScrollArea::vertical().auto_shrink(false);
        let shown = area.show(ui, |ui| match &context.exports.result {
            Some(Ok(written)) if written.files.is_empty() => {
                let why = "Every channel is the same everywhere, so that there is nothing to write; switch on \"Include \
                           constant channels\" for maps all the same.";
                ui.colored_label(theme.quiet, why);
                Vec::new()
            }
            Some(Ok(written)) => {
                ui.colored_label(theme.good, format!("Written to {}:", written.folder.display()));
                if ui.button("Open the folder").clicked() {
                    // A graph that was named on the command line may lie in a relative folder.
                    let address = format!("file://{}", canonical_if_present(&written.folder).display());
                    ui.ctx().open_url(OpenUrl::new_tab(address));
                }
                // Above the files, since a long list would hide them.
                let warnings = written.warnings.iter().filter_map(|warning| {
                    let sentence = context.said(&warning.sentence);
                    remedies::show(ui, theme.warning, &sentence, &warning.remedies, request, import)
                });
                let chosen = warnings.collect();
                for memory in &written.memory {
                    ui.label(memory);
                }
                for file in &written.files {
                    let format = file.format.as_ref().map_or(String::new(), |format| format!("  ({format})"));
                    ui.colored_label(theme.quiet, format!("{}{format}", file.path));
                }
                for constant in &written.constants {
                    let said = ui.colored_label(theme.quiet, constant);
                    said.on_hover_text("It has no file, since a single number says the same; \"Include constant channels\" writes one.");
                }
                chosen
            }
            Some(Err(error)) => {
                let sentences = context.said(&error.messages.join("\n"));
                let action = remedies::show(ui, theme.fault, &sentences, &error.remedies, request, import);
                if error.remedies.contains(&Remedy::OtherFolder) && ui.button("Choose a folder").clicked() {
                    self.dialog = Some(SystemDialog::folder(ui.ctx()));
                }
                action.into_iter().collect()
            }
            None => Vec::new(),
        });
        shown.inner
    }

    fn folder(&mut self, place: &mut ExportPlace, ui: &mut Ui) {
        let label = ui.label("Folder").id;
        ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut place.folder).desired_width(ui.available_width() - 40.0);
            ui.add(field).labelled_by(label);
            let asks = ui.button("…").on_hover_text("The system's dialog for a folder");
            if asks.clicked() {
                self.dialog = Some(SystemDialog::folder(ui.ctx()));
            }
            match answer_of(&mut self.dialog) {
                Some(DialogAnswer::Chosen(folder)) => match path_text(&folder) {
                    Ok(folder) => (place.folder, self.refused) = (folder, None),
                    Err(refused) => self.refused = Some(refused.to_string()),
                },
                Some(DialogAnswer::NotOpened) => self.refused = Some(format!("{NO_DIALOG} Type the folder.")),
                Some(DialogAnswer::Closed) | None => {}
            }
        });
        ui.end_row();
        if let Some(refused) = &self.refused {
            ui.label("");
            ui.add(Label::new(refused).wrap());
            ui.end_row();
        }
    }
}

/// Rows of the settings of an export.
fn choices(export: &mut ExportChoices, ui: &mut Ui, theme: &Theme) {
    ui.label("Size");
    egui::ComboBox::from_id_salt("size")
        .selected_text(export.size.to_string())
        .show_ui(ui, |ui| {
            for size in SIZES {
                ui.selectable_value(&mut export.size, size, size.to_string());
            }
        });
    ui.end_row();
    ui.label("Padding");
    egui::ComboBox::from_id_salt("padding")
        .selected_text(export.padding.text(export.size))
        .show_ui(ui, |ui| {
            for padding in ExportPadding::OFFERED {
                ui.selectable_value(&mut export.padding, padding, padding.text(export.size));
            }
        })
        .response
        .on_hover_text("Color around the UV islands, so that no seam shows at a distance");
    ui.end_row();
    ui.label("Channels");
    let menu = ui.menu_button(channels_text(&export.channels), |ui| channels(&mut export.channels, ui));
    menu.response.on_hover_text("Channels that are exported");
    ui.end_row();
    let label = ui.label("Names").id;
    let field = TextEdit::singleline(&mut export.names)
        .hint_text("those of the preset")
        .desired_width(ui.available_width());
    ui.add(field)
        .labelled_by(label)
        .on_hover_text("Words: $map, $material, $udim, $size, $graph, $mesh, $variant, $seed, $preset; (groups) are left out where a word stands for nothing");
    ui.end_row();
    if let Some(why) = name_pattern_fault(&export.names).filter(|_| !export.names.is_empty()) {
        ui.label("");
        ui.add(egui::Label::new(RichText::new(why).color(theme.fault)).wrap());
        ui.end_row();
    }
}

/// Returns whether the shown model, or a part of it, was unwrapped, so that its file has other UVs.
fn is_unwrapped(context: &ViewContext<'_>) -> bool {
    let received = context.evaluation.model.received.as_ref();
    received.is_some_and(|model| model.linked.unwrapped.is_some())
}

fn channels_text(channels: &[String]) -> String {
    match channels {
        [] => "All".to_owned(),
        [one] => one.clone(),
        several => format!("{} of {}", several.len(), export_channels().len()),
    }
}

/// Switches for channels. An empty choice stands for all of them.
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

fn switches(chosen: &mut ExportChoices, place: &mut ExportPlace, has_variants: bool, ui: &mut Ui) {
    let has_model = chosen.has_model;
    // These labels are short, since the panel is narrow; the tooltips explain them.
    let variants = has_variants.then_some((
        &mut place.variants,
        "All variants",
        "Export each variant, into a folder of its own",
    ));
    let model = [
        Some((
            &mut chosen.has_model,
            "Include the model",
            "Write a copy of the model that uses the maps",
        )),
        has_model.then_some((
            &mut chosen.keeps_look,
            "Keep the model's look",
            "Keep glass, vertex colors and whatever else no map replaces",
        )),
        has_model.then_some((
            &mut chosen.embeds,
            "Model and maps in one file",
            "Write the copy as a single file with the maps in it",
        )),
    ];
    let others = [
        (
            &mut chosen.all_maps,
            "Include constant channels",
            "Write maps of channels that are the same everywhere, too",
        ),
        (
            &mut place.again,
            "Export at every save",
            "Export to the same folder whenever the graph is saved",
        ),
    ];
    for (is_on, label, tooltip) in variants.into_iter().chain(model.into_iter().flatten()).chain(others) {
        ui.label("");
        ui.checkbox(is_on, label).on_hover_text(tooltip);
        ui.end_row();
    }
}

/// Progress of the running export, or the buttons that start one.
fn progress(ui: &mut Ui, context: &ViewContext<'_>) -> Option<ExportAction> {
    let theme = context.theme;
    if let Some(running) = &context.exports.running {
        let activity = running.activity();
        if let Some(sentence) = running.waits_for() {
            ui.add(Label::new(RichText::new(sentence).color(theme.warning)).wrap());
        } else {
            ui.label(activity.map_or_else(|| "Starting".to_owned(), |activity| activity_text(&activity)));
        }
        let share = activity.and_then(|activity| activity.share());
        // A phase of a single step leaves the bar empty: a full one would look like the end.
        let bar = ProgressBar::new(share.unwrap_or(0.0));
        ui.add(bar.fill(theme.accent).desired_height(6.0));
        ui.ctx().request_repaint_after(Duration::from_millis(250));
        return ui.button("Cancel").clicked().then_some(ExportAction::Cancel);
    }
    let mut action = None;
    if context.exports.asks_force {
        let sentence = "This folder has files, and none of them is a map of this graph.";
        ui.add(Label::new(RichText::new(sentence).color(theme.warning)).wrap());
        if ui.button("Write the textures there anyway").clicked() {
            action = Some(ExportAction::Start { force: true });
        }
    }
    let button = Button::new(RichText::new("Export").color(theme.on_accent)).fill(theme.accent);
    if ui.add_sized([ui.available_width(), 28.0], button).clicked() {
        action = Some(ExportAction::Start { force: false });
    }
    action
}
