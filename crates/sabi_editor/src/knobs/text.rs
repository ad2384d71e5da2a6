//! Texts and the paths of files.

use egui::{Id, Rect, Ui};
use egui_phosphor::regular as icon;
use sabi_graph::Value;

use super::boxes::cut_square;
use super::buttons::sign_button;
use super::knob_ui::KnobUi;
use super::sentence::sentence;
use super::text_field::{FieldResult, KnobTextField};
use super::{KnobEvent, KnobRow};

pub(super) fn text(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, rect: Rect, text: &str) {
    let typed = knob_ui.field(
        ui,
        &KnobTextField {
            id: id.with("text"),
            rect,
            name: &row.knob.label,
            shown: if row.differs { "" } else { text },
            hint: if row.differs { "mixed" } else { "" },
        },
    );
    if let FieldResult::Changed(text) = typed {
        knob_ui.set(row, Value::Text(text));
    }
}

pub(super) fn file(ui: &mut Ui, knob_ui: &mut KnobUi<'_>, row: &KnobRow<'_>, id: Id, mut rect: Rect, path: &str) {
    let browse = cut_square(&mut rect);
    text(ui, knob_ui, row, id, rect, path);
    let name = format!("{}: choose a file", row.knob.label);
    if sign_button(ui, knob_ui, id.with("browse"), browse, icon::FOLDER_OPEN, &name).clicked() {
        let knob = row.knob.name.clone();
        knob_ui.events.push(KnobEvent::Browse { knob });
    }
    if path.is_empty() && !row.differs {
        let missing = "No file yet: choose one, or type its path from the folder of the graph.";
        sentence(ui, id.with("empty"), rect.left(), missing, knob_ui.theme.warning);
    }
}
