//! What is wrong; a click goes to the node.

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;

use crate::action::Action;
use crate::app::Editor;
use crate::theme::Theme;

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let stage = &editor.stage;
    let faults = &stage.faults;
    let of_kinds: Vec<String> = editor.desk.kinds().0.faults.iter().map(ToString::to_string).collect();
    let failures = [&stage.failure, &stage.model_failure].into_iter().flatten();
    let others: Vec<&String> = failures.chain(&faults.other).chain(&of_kinds).collect();
    if faults.faults.is_empty() && others.is_empty() && faults.warnings.is_empty() {
        ui.colored_label(theme.good, format!("{} Nothing is wrong.", icon::CHECK_CIRCLE));
        return;
    }
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for fault in &faults.faults {
            let text = RichText::new(format!("{} {}", icon::WARNING, fault.sentence)).color(theme.fault);
            if ui
                .add(egui::Label::new(text).wrap().sense(egui::Sense::click()))
                .clicked()
            {
                actions.push(Action::GoTo(fault.node.clone()));
            }
        }
        for sentence in others {
            ui.add(egui::Label::new(RichText::new(sentence).color(theme.fault)).wrap());
        }
        for sentence in &faults.warnings {
            ui.add(egui::Label::new(RichText::new(sentence).color(theme.warning)).wrap());
        }
    });
}
