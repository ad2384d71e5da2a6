//! Exposed parameters of the shown graph, for people who never open it; while they are edited, their names and ranges.

mod parameter_cards;

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::command::ExposedCommand;
use sabi_editing::exposed_knobs::ExposedKnob;
use sabi_editing::random_knobs::SEED;
use sabi_editing::{OpenDocument, exposed_knobs, groups};
use sabi_graph::Body;

use super::random::{self, LockedParameters};
use crate::action::Action;
use crate::context::ViewContext;
use crate::knobs::{KnobMemory, KnobRow, KnobSection, ParamMask, exposed_ui};

/// Exposed parameters of the shown graph.
#[derive(Default)]
pub(crate) struct ExposedParameters {
    /// True if names and ranges are shown instead of values.
    is_editing: bool,
    /// Parameters that random values leave alone, by their graph.
    kept: LockedParameters<Body>,
}

impl ExposedParameters {
    /// Shows the parameters and returns the requested actions.
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>, memory: &mut KnobMemory) -> Vec<Action> {
        let (document, theme) = (context.document, context.theme);
        let panel = exposed_knobs::knobs(document);
        let mut actions = Vec::new();
        ui.horizontal(|ui| {
            let name = groups::graph_name(document);
            ui.heading(if name.is_empty() { "Untitled" } else { &name });
            if context.is_use_view || panel.is_empty() {
                self.is_editing = false;
                return;
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let pen = ui.selectable_label(self.is_editing, icon::PENCIL_SIMPLE);
                pen.widget_info(|| {
                    let kind = egui::WidgetType::Checkbox;
                    egui::WidgetInfo::selected(kind, true, self.is_editing, "Change the panel")
                });
                if pen.on_hover_text("Edit names, sections, ranges and order").clicked() {
                    self.is_editing = !self.is_editing;
                }
            });
        });
        if panel.is_empty() {
            let sentence = match context.is_use_view {
                true => "This graph has no exposed parameters.",
                false => {
                    "No parameter is exposed yet. Right-click a parameter of a node and choose Expose parameter; it then stands \
                     here."
                }
            };
            ui.add(egui::Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
        }
        if self.is_editing {
            let mut edits = Vec::new();
            parameter_cards::show(ui, theme, &panel, &mut edits);
            actions.extend(edits.into_iter().map(Action::edit));
            // Called without rows, so that a drag whose row has disappeared ends.
            let events = exposed_ui(ui, theme, memory, &[], &context.lengths());
            actions.extend(events.into_iter().map(Action::TurnExposed));
            return actions;
        }
        if !panel.is_empty() {
            actions.extend(self.random(ui, document, &panel).map(Action::edit));
        }
        let knobs: Vec<_> = panel.iter().map(shown).collect();
        let sections = sections(&panel, &knobs);
        ui.push_id(("exposed", document.body()), |ui| {
            let events = exposed_ui(ui, theme, memory, &sections, &context.lengths());
            actions.extend(events.into_iter().map(Action::TurnExposed));
        });
        actions
    }
}

impl ExposedParameters {
    /// Random values of the parameters.
    fn random(&mut self, ui: &mut Ui, document: &OpenDocument, panel: &[ExposedKnob]) -> Option<ExposedCommand> {
        let body = document.body();
        let of_graph = (body == Body::Main).then_some((SEED, "Seed of the graph"));
        let knobs = panel
            .iter()
            .map(|known| (known.name.as_str(), known.knob.label.as_str()));
        let knobs: Vec<(&str, &str)> = of_graph.into_iter().chain(knobs).collect();
        let kept = random::show(ui, &body, &knobs, &mut self.kept)?;
        Some(ExposedCommand::Randomize { kept })
    }
}

/// A parameter as a row shows it: it counts as changed if it has another value than when the graph was opened.
fn shown(knob: &ExposedKnob) -> sabi_engine::catalog::Knob {
    let mut shown = knob.knob.clone();
    shown.ty.default = knob.at_first.clone();
    shown
}

fn sections<'p>(panel: &'p [ExposedKnob], knobs: &'p [sabi_engine::catalog::Knob]) -> Vec<KnobSection<'p>> {
    let mut sections: Vec<KnobSection<'p>> = Vec::new();
    for (exposed, knob) in panel.iter().zip(knobs) {
        let title = exposed.exposed.section.as_deref();
        let row = KnobRow {
            knob,
            value: Some(&exposed.value),
            wired: None,
            mask: ParamMask::NotTaken,
            exposed: Some(&exposed.name),
            differs: false,
        };
        match sections.last_mut() {
            Some(last) if last.title == title => last.rows.push(row),
            _ => sections.push(KnobSection {
                title,
                switch: None,
                rows: vec![row],
            }),
        }
    }
    sections
}
