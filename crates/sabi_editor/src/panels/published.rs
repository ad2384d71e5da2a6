//! The published knobs of the graph that is seen, for people who never open it; and, by the pen, what they say of themselves.

mod editing;

use egui::{RichText, Ui};
use egui_phosphor::regular as icon;
use sabi_editing::{OpenDocument, PanelKnob};

use crate::action::PanelAsk;
use crate::knobs::{KnobMemory, KnobRow, KnobSection, Lengths, published_ui};
use crate::theme::Theme;

/// What the panel needs besides the graph.
pub(crate) struct Around<'a> {
    pub(crate) theme: &'a Theme,
    pub(crate) lengths: Lengths,
    /// Whether it may only be used.
    pub(crate) is_use: bool,
}

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Published {
    is_editing: bool,
}

/// Shows the panel and says what is asked of it.
pub(crate) fn show(
    ui: &mut Ui,
    document: &OpenDocument,
    around: &Around<'_>,
    published: &mut Published,
    memory: &mut KnobMemory,
) -> Vec<PanelAsk> {
    let theme = around.theme;
    let panel = document.panel();
    let mut asked = Vec::new();
    ui.horizontal(|ui| {
        let name = document.graph_name();
        ui.heading(if name.is_empty() { "Untitled" } else { &name });
        if around.is_use || panel.is_empty() {
            published.is_editing = false;
            return;
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let pen = ui.selectable_label(published.is_editing, icon::PENCIL_SIMPLE);
            pen.widget_info(|| {
                let kind = egui::WidgetType::Checkbox;
                egui::WidgetInfo::selected(kind, true, published.is_editing, "Change the panel")
            });
            if pen
                .on_hover_text("Names, sections, ranges and order of these knobs")
                .clicked()
            {
                published.is_editing = !published.is_editing;
            }
        });
    });
    if panel.is_empty() {
        let sentence = match around.is_use {
            true => "This graph has published no knobs.",
            false => {
                "No knob is published yet. Right-click a knob of a node and put it on the panel: it will stand here, for \
                 people who never open the graph."
            }
        };
        ui.add(egui::Label::new(RichText::new(sentence).color(theme.quiet)).wrap());
    }
    if published.is_editing {
        editing::show(ui, theme, &panel, &mut asked);
        // A drag that was begun before has no row any more and ends.
        let events = published_ui(ui, theme, memory, &[], &around.lengths);
        asked.extend(events.into_iter().map(PanelAsk::Turn));
        return asked;
    }
    let knobs: Vec<_> = panel.iter().map(shown).collect();
    let sections = sections(&panel, &knobs);
    ui.push_id(("published", document.body()), |ui| {
        let events = published_ui(ui, theme, memory, &sections, &around.lengths);
        asked.extend(events.into_iter().map(PanelAsk::Turn));
    });
    asked
}

/// The knob as a row shows it: it is changed where it holds something else than when the graph was opened.
fn shown(knob: &PanelKnob) -> sabi_engine::catalog::Knob {
    let mut shown = knob.knob.clone();
    shown.ty.default = knob.at_first.clone();
    shown
}

fn sections<'p>(panel: &'p [PanelKnob], knobs: &'p [sabi_engine::catalog::Knob]) -> Vec<KnobSection<'p>> {
    let mut sections: Vec<KnobSection<'p>> = Vec::new();
    for (published, knob) in panel.iter().zip(knobs) {
        let title = published.exposed.section.as_deref();
        let row = KnobRow {
            knob,
            value: Some(&published.value),
            wired: None,
            exposed: Some(&published.name),
            differs: false,
        };
        match sections.last_mut() {
            Some(last) if last.title == title => last.rows.push(row),
            _ => sections.push(KnobSection { title, rows: vec![row] }),
        }
    }
    sections
}
