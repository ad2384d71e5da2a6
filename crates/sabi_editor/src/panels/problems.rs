//! Errors and warnings; a click goes to the node.

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_engine::EngineError;

use super::update;
use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::remedies::{self, Request};

/// Panel of errors and warnings.
pub(crate) struct Problems;

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
        let of_kinds: Vec<String> = document.kinds().0.faults.iter().map(ToString::to_string).collect();
        let failures: Vec<&EngineError> = [&evaluation.failure, &evaluation.model.failure]
            .into_iter()
            .flatten()
            .collect();
        actions.extend(update::all(ui, context));
        let others: Vec<&String> = faults.other.iter().chain(&of_kinds).collect();
        if faults.faults.is_empty() && failures.is_empty() && others.is_empty() && faults.warnings.is_empty() {
            ui.colored_label(theme.good, format!("{} Nothing is wrong.", icon::CHECK_CIRCLE));
            return actions;
        }
        let request = Request::Evaluation {
            size: evaluation.model.size(),
        };
        let import = evaluation.model.import_options();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for fault in &faults.faults {
                let text = format!("{} {}", icon::WARNING, fault.sentence);
                actions.extend(at_node(ui, RichText::new(text).color(theme.fault), &fault.node));
            }
            for error in failures {
                let sentences = error.messages.join("\n");
                actions.extend(remedies::show(
                    ui,
                    theme.fault,
                    (&sentences, &error.remedies),
                    request,
                    import,
                ));
            }
            for sentence in others {
                ui.add(egui::Label::new(RichText::new(sentence).color(theme.fault)).wrap());
            }
            for warning in &faults.warnings {
                let said = (warning.sentence.as_str(), warning.remedies.as_slice());
                actions.extend(match &warning.node {
                    Some(node) => at_node(ui, RichText::new(warning.to_string()).color(theme.warning), node),
                    None => remedies::show(ui, theme.warning, said, request, import),
                });
            }
        });
        actions
    }
}

/// Shows a text; a click on it goes to a node.
fn at_node(ui: &mut Ui, text: RichText, node: &str) -> Option<Action> {
    let label = egui::Label::new(text).wrap().sense(egui::Sense::click());
    ui.add(label).clicked().then(|| Action::GoTo(node.to_owned()))
}
