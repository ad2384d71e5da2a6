//! Times of nodes and frames, steps and memory; a click on a node goes there.

use egui::{RichText, Ui};

use sabi_editing::node_paths;

use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::time_text::time_text;

/// Panel of times and memory.
pub(crate) struct Timing;

impl View for Timing {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        summary(ui, context);
        ui.separator();
        node_times(ui, context)
    }
}

fn summary(ui: &mut Ui, context: &ViewContext<'_>) {
    let ViewContext {
        theme,
        frame_times: frames,
        ..
    } = *context;
    let last = &context.evaluation.results.last;
    let middle = {
        let mut sorted: Vec<_> = frames.iter().copied().collect();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).copied()
    };
    let longest = frames.iter().copied().max();
    egui::Grid::new("timing")
        .num_columns(2)
        .spacing([16.0, 2.0])
        .show(ui, |ui| {
            let mut row = |name: &str, value: String| {
                ui.colored_label(theme.quiet, name);
                ui.label(value);
                ui.end_row();
            };
            row(
                "From an edit to its picture",
                last.latency.map_or("–".to_owned(), time_text),
            );
            row("Steps computed", last.steps.to_string());
            row("Steps from the cache", last.cache_hits.to_string());
            let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
            let (kept, most) = (mebibytes(last.texture_bytes), mebibytes(last.budget_bytes));
            row("Memory of the cache", format!("{kept:.0} of {most:.0} MiB"));
            row(
                "Time of a window frame",
                middle.zip(longest).map_or("–".to_owned(), |(middle, longest)| {
                    format!("{} (longest {})", time_text(middle), time_text(longest))
                }),
            );
            row("Pictures of the model", context.pictures_drawn.to_string());
        });
    let share = last.texture_bytes as f32 / last.budget_bytes.max(1) as f32;
    ui.add(egui::ProgressBar::new(share).desired_height(4.0).fill(theme.accent));
}

/// Nodes by the time of their last evaluation, the slowest first.
fn node_times(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    // A result may arrive after its node was deleted.
    let times = context.evaluation.results.times().iter();
    let mut times: Vec<_> = times
        .filter(|(node, _)| node_paths::exists(context.document, node))
        .collect();
    times.sort_by(|(_, one), (_, other)| other.cmp(one));
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        egui::Grid::new("times").num_columns(2).striped(true).show(ui, |ui| {
            for (node, time) in times.into_iter().take(100) {
                if ui
                    .link(node_paths::title(context.document, node))
                    .on_hover_text("Goes to the node")
                    .clicked()
                {
                    actions.push(Action::GoTo(node.clone()));
                }
                ui.label(RichText::new(time_text(*time)).monospace());
                ui.end_row();
            }
        });
    });
    actions
}
