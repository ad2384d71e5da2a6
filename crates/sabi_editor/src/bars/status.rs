//! The bar at the bottom of the window.

use std::time::Duration;

use egui::{Align, Id, Layout, Margin, RichText, Ui, UiBuilder};
use egui_phosphor::regular as icon;

use super::{bar, document};
use crate::action::Action;
use crate::activity_text::activity_text;
use crate::context::ViewContext;
use crate::dock::Panel;
use crate::model_warnings::counted;
use crate::theme::type_size;
use crate::time_text::time_text;

/// Time after which the progress of the evaluation is drawn again.
const REDRAWN_AFTER: Duration = Duration::from_millis(500);

/// Bar at the bottom: the device, what is being evaluated, problems, and the menu of the whole document.
pub(crate) fn status(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let mut actions = Vec::new();
    egui::Panel::bottom("status")
        .frame(bar(context.theme.background, Margin::symmetric(8, 2)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal(|ui| contents(ui, context, &mut actions));
        });
    actions
}

fn contents(ui: &mut Ui, context: &ViewContext<'_>, actions: &mut Vec<Action>) {
    let theme = context.theme;
    let quiet = |text: String| RichText::new(text).size(type_size::SMALL).color(theme.quiet);
    let summary = context.evaluation.gpu().summary();
    ui.label(quiet(format!("{} ({})", summary.name, summary.kind)));
    if context.evaluation.is_busy() {
        // Drawn again twice a second: an animation would draw the whole window in every frame, at the cost of the
        // evaluation.
        ui.ctx().request_repaint_after(REDRAWN_AFTER);
        let activity = context.evaluation.activity();
        let text = activity.map_or_else(|| "Evaluating".to_owned(), |activity| activity_text(&activity));
        ui.label(quiet(format!("{} {text}", icon::HOURGLASS_MEDIUM)));
    }
    if let Some(latency) = context.evaluation.results.last.latency {
        ui.label(quiet(time_text(latency)));
    }
    let count = context.problem_count();
    if count > 0 {
        let text = format!("{} {count}", icon::WARNING);
        let problems = ui.link(RichText::new(text).color(theme.fault).size(type_size::SMALL));
        if problems.clicked() {
            actions.push(Action::ShowPanel(Panel::Problems));
        }
    }
    let warnings = context.warning_count();
    if warnings > 0 {
        let text = format!("{} {}", icon::WARNING_CIRCLE, counted(warnings));
        let link = ui.link(RichText::new(text).color(theme.warning).size(type_size::SMALL));
        if link.on_hover_text("Show the warnings").clicked() {
            actions.push(Action::ShowPanel(Panel::Problems));
        }
    }
    let outdated = context.outdated_groups().len();
    if outdated > 0 {
        let text = match outdated {
            1 => format!("{} 1 newer group", icon::ARROWS_CLOCKWISE),
            count => format!("{} {count} newer groups", icon::ARROWS_CLOCKWISE),
        };
        let newer = ui.link(RichText::new(text).color(theme.warning).size(type_size::SMALL));
        if newer
            .on_hover_text("The library has newer versions of groups in this graph")
            .clicked()
        {
            actions.push(Action::ShowPanel(Panel::Problems));
        }
    }
    // With an id of its own, its widgets keep theirs whatever appears and disappears to the left.
    let builder = UiBuilder::new()
        .id(Id::new("status of the graph"))
        .layout(Layout::right_to_left(Align::Center));
    ui.scope_builder(builder, |ui| {
        actions.extend(document::menus(ui, context));
        ui.label(quiet(match context.document.graph().len() {
            1 => "1 node".to_owned(),
            count => format!("{count} nodes"),
        }));
    });
}
