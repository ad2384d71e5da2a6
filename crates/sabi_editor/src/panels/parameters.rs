//! The knobs of the selected node; with nothing selected, those that are published.

use egui::Ui;
use sabi_graph::{NodeId, Value};

use crate::action::Action;
use crate::app::Editor;
use crate::knobs::{KnobRow, Lengths, knobs_ui};
use crate::theme::Theme;

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Parameters {
    /// The knob that takes a color from the model.
    pub(crate) eyedropper: Option<(NodeId, String)>,
    /// A length that is turned, working units.
    pub(crate) length: Option<f64>,
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    editor.model_view.length = editor.panels.parameters.length.take();
    let Some(id) = editor.desk.selected_one().cloned() else {
        let count = editor.desk.selection().len();
        let sentence = match count {
            0 => "Select a node to turn its knobs.".to_owned(),
            _ => format!("{count} nodes are selected."),
        };
        ui.colored_label(theme.quiet, sentence);
        return;
    };
    let lengths = lengths(editor);
    let (Some(face), Some(node)) = (editor.desk.face(&id).cloned(), editor.desk.node(&id).cloned()) else {
        return;
    };
    ui.heading(editor.desk.title(&id));
    ui.colored_label(theme.quiet, &face.summary);
    if let Some(fault) = editor.stage.fault(&editor.desk.full_id(&id)) {
        ui.colored_label(theme.fault, fault);
    }
    ui.separator();
    let wired: Vec<Option<String>> = face
        .knobs
        .iter()
        .map(|knob| node.inputs.get(&knob.name).map(|from| editor.desk.title(&from.node)))
        .collect();
    let exposed: Vec<Option<String>> = face
        .knobs
        .iter()
        .map(|knob| editor.desk.exposed_as(&id, &knob.name).map(str::to_owned))
        .collect();
    let rows: Vec<KnobRow<'_>> = face
        .knobs
        .iter()
        .zip(wired.iter().zip(&exposed))
        .map(|(knob, (wired, exposed))| KnobRow {
            knob,
            value: node.params.get(&knob.name),
            wired: wired.as_deref(),
            exposed: exposed.as_deref(),
            differs: differs(editor, &id, &knob.name, node.params.get(&knob.name)),
        })
        .collect();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let events = knobs_ui(ui, theme, editor.knob_memory(), &rows, &lengths);
        actions.extend(events.into_iter().map(|event| Action::Knob {
            node: id.clone(),
            event,
        }));
    });
}

/// Whether selected nodes of the same kind have another value.
fn differs(editor: &Editor, id: &NodeId, knob: &str, value: Option<&Value>) -> bool {
    let kind = editor.desk.node(id).map(|node| &node.kind);
    let others = editor
        .desk
        .selection()
        .iter()
        .filter_map(|other| editor.desk.node(other));
    others
        .filter(|other| Some(&other.kind) == kind)
        .any(|other| other.params.get(knob) != value)
}

/// How long 1 is on the model that is shown.
fn lengths(editor: &Editor) -> Lengths {
    let model = editor.stage.shown_model.as_ref();
    Lengths {
        model_units_per_working: model.map_or(1.0, |model| 1.0 / model.prepared.working_from_model(&model.fit)),
        // glTF counts in metres.
        metres_per_model_unit: 1.0,
    }
}
