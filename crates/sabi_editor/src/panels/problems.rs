//! Errors and warnings; a click goes to the node.

use std::time::{Duration, Instant};

use egui::{RichText, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_editing::missing_files;
use sabi_engine::EngineError;

use super::update;
use crate::action::{Action, FileAction, ModelAction};
use crate::context::{View, ViewContext};
use crate::notices::with_capital;
use crate::paths::file_stem;
use crate::remedies::{self, Request};

/// Time after which files that were missing are looked for again, while the panel is drawn.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// Panel of errors and warnings.
#[derive(Default)]
pub(crate) struct Problems {
    /// Files that are missing, with the revision of the graph and the time for which they were looked for.
    missing: Option<(u64, Instant, Vec<String>)>,
}

impl View for Problems {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = Vec::new();
        let ViewContext {
            document,
            evaluation,
            theme,
            ..
        } = *context;
        let faults = &evaluation.faults.all;
        let of_kinds: Vec<String> = document
            .node_kinds()
            .kinds
            .faults
            .iter()
            .map(ToString::to_string)
            .collect();
        let failures: Vec<&EngineError> = [&evaluation.failure, &evaluation.model.failure]
            .into_iter()
            .flatten()
            .collect();
        actions.extend(update::all(ui, context));
        let others: Vec<&String> = faults.other.iter().chain(&of_kinds).collect();
        let pictures = pictures_of_model(context);
        let count = usize::from(context.is_named_model_refused())
            + self.missing(context).len()
            + pictures.len()
            + faults.faults.len()
            + failures.len()
            + others.len()
            + context.warning_count();
        if count == 0 {
            ui.colored_label(theme.good, format!("{} Nothing is wrong.", icon::CHECK_CIRCLE));
            return actions;
        }
        let request = Request::Evaluation {
            size: evaluation.model.size(),
        };
        let import = evaluation.model.import_options();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let lost = self.missing(context);
            actions.extend(missing(ui, context, lost));
            actions.extend(missing(ui, context, &pictures));
            if lost.is_empty() && context.is_named_model_refused() {
                actions.extend(unread_model(ui, context));
            }
            for fault in &faults.faults {
                let text = format!("{} {}", icon::WARNING, with_capital(&context.said(&fault.sentence)));
                actions.extend(at_node(ui, RichText::new(text).color(theme.fault), &fault.node));
            }
            for error in failures {
                let sentences = context.said(&error.messages.join("\n"));
                actions.extend(remedies::show(
                    ui,
                    theme.fault,
                    &sentences,
                    &error.remedies,
                    request,
                    import,
                ));
            }
            for sentence in others {
                ui.add(
                    egui::Label::new(RichText::new(with_capital(&context.said(sentence))).color(theme.fault)).wrap(),
                );
            }
            let of_model = evaluation.model.warnings();
            for warning in context.warnings() {
                let mut sentence = context.said(&warning.sentence);
                if of_model.contains(warning) {
                    sentence = format!("{}: {sentence}", file_stem(evaluation.model.file()));
                }
                actions.extend(match &warning.node {
                    Some(node) => at_node(
                        ui,
                        RichText::new(with_capital(&context.said(&warning.to_string()))).color(theme.warning),
                        node,
                    ),
                    None => remedies::show(ui, theme.warning, &sentence, &warning.remedies, request, import),
                });
            }
            for beside in context.row.beside() {
                let model = &beside.model;
                for warning in model.warnings() {
                    // Remedies are offered only for the main model, which the buttons act on.
                    let text = format!("{}: {warning}", file_stem(model.file()));
                    ui.add(egui::Label::new(RichText::new(text).color(theme.warning)).wrap());
                }
            }
        });
        actions
    }
}

impl Problems {
    /// Files that the graph names and that are not there. They are not looked for in every frame, since that takes a copy of the
    /// graph.
    fn missing(&mut self, context: &ViewContext<'_>) -> &[String] {
        let revision = context.document.session.revision();
        let is_of_now = |(of, since, _): &(u64, Instant, _)| *of == revision && since.elapsed() < LOOK_AGAIN;
        let known = self.missing.take().filter(is_of_now);
        let look = || (revision, Instant::now(), missing_files::missing(context.document));
        &self.missing.insert(known.unwrap_or_else(look)).2
    }
}

/// Pictures that the shown model names and that are not there.
fn pictures_of_model(context: &ViewContext<'_>) -> Vec<String> {
    let model = context.evaluation.model.received.as_ref();
    let names = model
        .into_iter()
        .flat_map(|model| model.linked.model.missing_pictures());
    names.map(str::to_owned).collect()
}

/// The model that the graph names, if it could not be read or its reading was canceled, with a button that reads it
/// again.
fn unread_model(ui: &mut Ui, context: &ViewContext<'_>) -> Option<Action> {
    let model = &context.evaluation.model;
    let refused = model.refused()?;
    let (name, instead) = (file_stem(refused), file_stem(model.file()));
    let text = format!(
        "{} {name}, the model of the graph, was not read; {instead} stands in for it.",
        icon::WARNING
    );
    ui.horizontal_wrapped(|ui| {
        ui.add(egui::Label::new(RichText::new(text).color(context.theme.fault)).wrap());
        let button = ui.button("Read it again");
        button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Read {name} again")));
        let again = || Action::Model(ModelAction::Show(refused.to_owned()));
        button.clicked().then(again)
    })
    .inner
}

/// Files that the graph names and that are not there, each with a button that asks where it is.
fn missing(ui: &mut Ui, context: &ViewContext<'_>, missing: &[String]) -> Option<Action> {
    let mut asked = None;
    for lost in missing {
        ui.horizontal_wrapped(|ui| {
            let text = format!("{} There is no file {lost}", icon::FILE_X);
            ui.add(egui::Label::new(RichText::new(text).color(context.theme.fault)).wrap());
            let name = missing_files::name_of(lost);
            let button = ui.button("Find it…");
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Find {name}")));
            if button
                .on_hover_text("Others that lie beside it are found, too")
                .clicked()
            {
                asked = Some(Action::File(FileAction::AskForMissing(lost.clone())));
            }
        });
    }
    asked
}

/// Shows a text; a click on it goes to a node.
fn at_node(ui: &mut Ui, text: RichText, node: &str) -> Option<Action> {
    let label = egui::Label::new(text).wrap().sense(egui::Sense::click());
    ui.add(label).clicked().then(|| Action::GoTo(node.to_owned()))
}
