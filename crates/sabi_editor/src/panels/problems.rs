//! Errors and warnings; a click goes to the node.

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;

use crate::action::Action;
use crate::context::{View, ViewContext};

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
        let faults = &evaluation.faults;
        let of_kinds: Vec<String> = document.kinds().0.faults.iter().map(ToString::to_string).collect();
        let failures = [&evaluation.failure, &evaluation.model_failure].into_iter().flatten();
        let others: Vec<&String> = failures.chain(&faults.other).chain(&of_kinds).collect();
        if faults.faults.is_empty() && others.is_empty() && faults.warnings.is_empty() {
            ui.colored_label(theme.good, format!("{} Nothing is wrong.", icon::CHECK_CIRCLE));
            return actions;
        }
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let mut at_node = |ui: &mut Ui, text: RichText, node: &str| {
                let label = egui::Label::new(text).wrap().sense(egui::Sense::click());
                if ui.add(label).clicked() {
                    actions.push(Action::GoTo(node.to_owned()));
                }
            };
            for fault in &faults.faults {
                let text = format!("{} {}", icon::WARNING, fault.sentence);
                at_node(ui, RichText::new(text).color(theme.fault), &fault.node);
            }
            for sentence in others {
                ui.add(egui::Label::new(RichText::new(sentence).color(theme.fault)).wrap());
            }
            for warning in &faults.warnings {
                let text = RichText::new(warning.to_string()).color(theme.warning);
                match &warning.node {
                    Some(node) => at_node(ui, text, node),
                    None => drop(ui.add(egui::Label::new(text).wrap())),
                }
            }
        });
        actions
    }
}
