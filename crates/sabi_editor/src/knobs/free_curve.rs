//! A curve that is no parameter of a node.

use egui::Ui;
use sabi_engine::catalog::Knob;
use sabi_graph::Value;
use sabi_nodes::kind::{Memory, ParamType, Role, WrittenValue};

use super::boxes::strip;
use super::knob_ui::KnobUi;
use super::sentence::sentence;
use super::values::{KnobValue, of_points, read};
use super::{KnobEvent, KnobMemory, KnobRow, LengthUnits, ParamMask, curve};
use crate::theme::{Theme, space};

/// State of a curve between frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct CurveMemory {
    knobs: KnobMemory,
    /// Points at the beginning of a drag.
    before: Vec<[f64; 2]>,
}

/// Shows a curve in the square from 0 to 1, with the widget of the curves of nodes. Returns its points if they have
/// changed. It holds at most `room` points.
pub(crate) fn curve_ui(
    ui: &mut Ui,
    theme: &Theme,
    memory: &mut CurveMemory,
    label: &str,
    room: usize,
    points: &[[f64; 2]],
) -> Option<Vec<[f64; 2]>> {
    let knob = knob_of(label, room);
    let value = of_points(points);
    let row = KnobRow {
        knob: &knob,
        value: Some(&value),
        wired: None,
        mask: ParamMask::NotTaken,
        exposed: None,
        differs: false,
    };
    let id = ui.make_persistent_id(label);
    // No length is shown.
    let lengths = LengthUnits {
        model_units_per_working: 1.0,
        metres_per_model_unit: 1.0,
    };
    let mut knob_ui = KnobUi::new(theme, &mut memory.knobs, &lengths);
    knob_ui.age_fault(ui.ctx(), id);
    let presets = strip(ui, space::ROW);
    curve::show(ui, &mut knob_ui, &row, id, presets, points.to_vec());
    if let Some(text) = knob_ui.fault_of(id) {
        sentence(ui, id.with("fault"), presets.left(), &text, theme.fault);
    }
    knob_ui.finish(ui.ctx(), |_| true);
    let mut changed = None;
    for event in knob_ui.events {
        match event {
            KnobEvent::Began => memory.before = points.to_vec(),
            KnobEvent::Canceled => changed = Some(std::mem::take(&mut memory.before)),
            KnobEvent::Set { value, .. } => changed = points_of(&knob, &value),
            _ => {}
        }
    }
    changed
}

fn points_of(knob: &Knob, value: &Value) -> Option<Vec<[f64; 2]>> {
    match read(knob, value)? {
        KnobValue::Points(points) => Some(points),
        _ => None,
    }
}

fn knob_of(label: &str, room: usize) -> Knob {
    Knob {
        name: label.to_owned(),
        label: label.to_owned(),
        doc: String::new(),
        ty: ParamType {
            role: Role::Curve,
            memory: Memory::Points(room as u32),
            range: Some([0.0, 1.0]),
            soft: Some([0.0, 1.0]),
            default: WrittenValue::Points(vec![[0.0, 0.0], [1.0, 1.0]]).to_value(),
        },
        is_of_input: false,
    }
}
