//! What everything takes: time by node, steps, memory, frames; a click on a node goes there.

use egui::{RichText, Ui};

use crate::action::Action;
use crate::app::Editor;
use crate::canvas::shown_time;
use crate::theme::Theme;

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let last = &editor.stage.last;
    let frames = &editor.frame_times;
    let middle = {
        let mut sorted: Vec<_> = frames.iter().copied().collect();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).copied().unwrap_or_default()
    };
    let longest = frames.iter().copied().max().unwrap_or_default();
    egui::Grid::new("performance")
        .num_columns(2)
        .spacing([16.0, 2.0])
        .show(ui, |ui| {
            let mut row = |name: &str, value: String| {
                ui.colored_label(theme.quiet, name);
                ui.label(value);
                ui.end_row();
            };
            row(
                "From an edit to the picture",
                last.latency.map_or("–".to_owned(), shown_time),
            );
            row("Steps that ran", last.steps.to_string());
            row("Steps whose results were known", last.cache_hits.to_string());
            let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
            let (kept, most) = (mebibytes(last.texture_bytes), mebibytes(last.budget_bytes));
            row("Results kept", format!("{kept:.0} of {most:.0} MiB"));
            row(
                "Window, a frame",
                format!("{} (longest {})", shown_time(middle), shown_time(longest)),
            );
            row("Pictures of the model", editor.model_view.drawn.to_string());
        });
    let share = last.texture_bytes as f32 / last.budget_bytes.max(1) as f32;
    ui.add(egui::ProgressBar::new(share).desired_height(4.0).fill(theme.accent));
    ui.separator();
    let document = &editor.document;
    // Times may come of nodes that are gone by then.
    let mut times: Vec<_> = editor
        .stage
        .times()
        .iter()
        .filter(|(node, _)| document.has(node))
        .collect();
    times.sort_by(|(_, one), (_, other)| other.cmp(one));
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        egui::Grid::new("times").num_columns(2).striped(true).show(ui, |ui| {
            for (node, time) in times.into_iter().take(100) {
                let link = ui.link(document.title_at(node));
                if link.on_hover_text("Goes to the node").clicked() {
                    actions.push(Action::GoTo(node.clone()));
                }
                ui.label(RichText::new(shown_time(*time)).monospace());
                ui.end_row();
            }
        });
    });
}
