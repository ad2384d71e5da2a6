//! Questions about trust: in files that lie elsewhere, and in node files beside the graph.

use std::collections::BTreeSet;
use std::path::Path;

use egui::{Margin, RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::trust;
use sabi_engine::EngineError;
use sabi_files::Refusal;

use super::bar;
use crate::action::{Action, TrustAction};
use crate::builtin_models::model_of;
use crate::context::ViewContext;

/// Most folders that are offered at once.
const MOST_FOLDERS: usize = 3;

/// Questions about files that the graph or the model names and may not open, and about node files beside the graph.
pub(crate) fn trust(ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
    let files = refused_files(ui, context);
    let nodes = untrusted_nodes(ui, context);
    files.into_iter().chain(nodes).map(Action::Trust).collect()
}

/// Refusals that trust in a folder would end.
fn refusals(context: &ViewContext<'_>) -> BTreeSet<Refusal> {
    let evaluation = context.evaluation;
    let received = evaluation.model.received.iter();
    let of_model = received.flat_map(|model| &model.linked.model.refused);
    let failed = evaluation.model.failure.iter().filter_map(EngineError::refusal);
    let named = model_of(&context.document.session, context.examples).and_then(Result::err);
    let all = evaluation.refused.iter().chain(of_model).chain(failed);
    let all = all.cloned().chain(named);
    all.filter(|refusal| refusal.folder().is_some()).collect()
}

fn refused_files(ui: &mut Ui, context: &ViewContext<'_>) -> Option<TrustAction> {
    let refusals = refusals(context);
    let first = refusals.first()?;
    let others = match refusals.len() - 1 {
        0 => String::new(),
        1 => " One more file is not read either.".to_owned(),
        others => format!(" {others} more files are not read either."),
    };
    let folders: BTreeSet<&Path> = refusals.iter().filter_map(Refusal::folder).collect();
    let mut trusted = None;
    egui::Panel::top("refused files")
        .frame(bar(context.theme.panel, Margin::symmetric(8, 4)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let sentence = format!("{} A file is not read: {first}.{others}", icon::WARNING);
                ui.label(RichText::new(sentence).color(context.theme.warning));
                for folder in folders.into_iter().take(MOST_FOLDERS) {
                    let button = ui.button(format!("Trust {}", folder.display()));
                    let tooltip = "All graphs and models may open the files below this folder from now on";
                    if button.on_hover_text(tooltip).clicked() {
                        trusted = Some(TrustAction::Folder(folder.to_owned()));
                    }
                }
            });
        });
    trusted
}

fn untrusted_nodes(ui: &mut Ui, context: &ViewContext<'_>) -> Option<TrustAction> {
    let folder = trust::untrusted_nodes(context.document).filter(|_| !context.leaves_nodes)?;
    let mut chosen = None;
    egui::Panel::top("untrusted nodes")
        .frame(bar(context.theme.panel, Margin::symmetric(8, 4)))
        .show_separator_line(false)
        .show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let sentence = format!(
                    "{} The graph comes with nodes of its own, which are programs: {}.",
                    icon::WARNING,
                    folder.display()
                );
                ui.label(RichText::new(sentence).color(context.theme.warning));
                let tooltip = "These nodes are used from now on, in all graphs of this folder";
                if ui.button("Use these nodes").on_hover_text(tooltip).clicked() {
                    chosen = Some(TrustAction::Nodes(folder.clone()));
                }
                if ui.button("Not now").clicked() {
                    chosen = Some(TrustAction::LeaveNodes);
                }
            });
        });
    chosen
}
