//! The knobs of the selected nodes; with nothing selected, what the graph that is seen publishes.

use egui::Ui;
use sabi_editing::{KnobTarget, OpenDocument};
use sabi_graph::{NodeId, Value};

use super::{ports, published, variants};
use crate::action::Action;
use crate::app::Editor;
use crate::knobs::{KnobRow, Lengths, knobs_ui};
use crate::theme::Theme;

/// What the panel holds from frame to frame.
#[derive(Default)]
pub(crate) struct Parameters {
    /// The knob that takes a color from what is clicked.
    pub(crate) eyedropper: Option<KnobTarget>,
    /// A length that is pointed at or turned, working units.
    pub(crate) length: Option<f64>,
    published: published::Published,
    variants: variants::Variants,
}

pub(crate) fn show(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    if editor.is_use_view() || editor.document.selection().is_empty() {
        of_graph(editor, ui, theme, actions);
        return;
    }
    match alike(&editor.document) {
        Some(id) => of_node(editor, ui, theme, &id, actions),
        None => {
            let count = editor.document.selection().len();
            let sentence =
                format!("{count} nodes of several kinds are selected; those of one kind are turned together.");
            ui.add(egui::Label::new(egui::RichText::new(sentence).color(theme.quiet)).wrap());
            let lengths = Lengths::on(editor.stage.shown_model.as_deref());
            knobs_ui(ui, theme, editor.knob_memory(), &[], &lengths);
        }
    }
}

/// What the graph publishes.
fn of_graph(editor: &mut Editor, ui: &mut Ui, theme: &Theme, actions: &mut Vec<Action>) {
    let around = published::Around {
        theme,
        lengths: Lengths::on(editor.stage.shown_model.as_deref()),
        is_use: editor.is_use_view(),
    };
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let (document, panels, memory) = editor.parts_of_panel();
        let own = &mut panels.parameters;
        let asked = published::show(ui, document, &around, &mut own.published, memory);
        actions.extend(asked.into_iter().map(Action::Panel));
        let asked = variants::show(ui, theme, document, &mut own.variants, &mut panels.keepsakes);
        actions.extend(asked.map(Action::Variant));
        if !around.is_use {
            actions.extend(ports::show(ui, theme, document).into_iter().map(Action::Port));
        }
    });
}

/// One of the selected nodes, if they are all of the same kind.
fn alike(document: &OpenDocument) -> Option<NodeId> {
    let kind = |id: &NodeId| document.node(id).map(|node| (&node.kind, &node.group));
    let mut selected = document.selection().iter();
    let first = selected.next()?;
    selected.all(|other| kind(other) == kind(first)).then(|| first.clone())
}

fn of_node(editor: &mut Editor, ui: &mut Ui, theme: &Theme, id: &NodeId, actions: &mut Vec<Action>) {
    let lengths = Lengths::on(editor.stage.shown_model.as_deref());
    let (Some(face), Some(node)) = (editor.document.face(id).cloned(), editor.document.node(id).cloned()) else {
        return;
    };
    let count = editor.document.selection().len();
    ui.heading(match count {
        1 => editor.document.title(id),
        _ => format!("{count} × {}", face.label),
    });
    ui.colored_label(theme.quiet, &face.summary);
    if let Some(fault) = editor.stage.fault(&editor.document.full_id(id)) {
        ui.colored_label(theme.fault, fault);
    }
    ui.separator();
    let wired: Vec<Option<String>> = face
        .knobs
        .iter()
        .map(|knob| {
            node.inputs
                .get(&knob.name)
                .map(|from| editor.document.title(&from.node))
        })
        .collect();
    let exposed: Vec<Option<String>> = face
        .knobs
        .iter()
        .map(|knob| editor.document.exposed_as(id, &knob.name).map(str::to_owned))
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
            differs: differs(&editor.document, &knob.name, node.params.get(&knob.name)),
        })
        .collect();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.push_id(id, |ui| {
            let events = knobs_ui(ui, theme, editor.knob_memory(), &rows, &lengths);
            actions.extend(events.into_iter().map(|event| Action::Knob {
                node: id.clone(),
                event,
            }));
        });
    });
}

/// Whether another selected node, all being of one kind, has another value.
fn differs(document: &OpenDocument, knob: &str, value: Option<&Value>) -> bool {
    let mut selected = document.selection().iter().filter_map(|other| document.node(other));
    selected.any(|other| other.params.get(knob) != value)
}
