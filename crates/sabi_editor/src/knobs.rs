//! Widgets of parameters, one for each role. They show values and return changes as events.
//!
//! A view turns a [`KnobEvent`] into an `Action::Knob` or `Action::TurnExposed`, and `app/perform.rs` turns that into
//! an edit of `sabi_editing`. Values are checked there, not here.

mod bar;
mod boxes;
mod buttons;
mod choice;
mod color;
mod curve;
mod direction;
mod doc;
mod expression;
mod free_curve;
mod inline;
mod keys;
mod knob_ui;
mod length;
mod numbers;
mod picker;
mod row;
mod sentence;
mod stops;
#[cfg(test)]
mod tests;
mod text;
mod text_field;
mod text_painting;

mod values;

use egui::{RichText, Ui};
use sabi_engine::catalog::Knob;
use sabi_graph::Value;
use sabi_nodes::kind::Role;

pub(crate) use self::free_curve::{CurveMemory, curve_ui};
pub(crate) use self::inline::{is_inline_menu_asked, knob_inline};
pub(crate) use self::knob_ui::KnobMemory;
use self::knob_ui::KnobUi;
pub(crate) use self::length::LengthUnits;
pub(crate) use self::picker::{picker, remember as remember_color};
pub(crate) use self::stops::paint_gradient;
pub(crate) use self::text_field::select_all;
use crate::theme::{Theme, space, type_size};

/// Points between rows.
const BETWEEN: f32 = 3.0;

/// Row of a parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnobRow<'a> {
    pub(crate) knob: &'a Knob,
    /// Value as a file has it; `None` where the default holds.
    pub(crate) value: Option<&'a Value>,
    /// Title of the node that is connected, for parameters of inputs.
    pub(crate) wired: Option<&'a str>,
    /// Mask that multiplies the parameter.
    pub(crate) mask: ParamMask<'a>,
    /// Name under which the parameter is exposed.
    pub(crate) exposed: Option<&'a str>,
    /// True if the selected nodes hold different values; `value` then belongs to a single node of them.
    pub(crate) differs: bool,
}

/// Mask that multiplies a parameter at each place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ParamMask<'a> {
    /// The row offers none.
    #[default]
    NotTaken,
    /// None is linked.
    Unlinked,
    /// The mask of this name.
    Of(&'a str),
}

impl KnobRow<'_> {
    /// Value, or the default.
    fn current(&self) -> &Value {
        self.value.unwrap_or(&self.knob.ty.default)
    }

    /// Returns whether a toggle is on for all that have it.
    fn is_on(&self) -> bool {
        !self.differs && *self.current() == Value::Bool(true)
    }

    /// Returns whether the value differs from the default. The random seed of a new node does not count as changed.
    fn is_changed(&self) -> bool {
        self.differs || self.knob.ty.role != Role::Seed && *self.current() != self.knob.ty.default
    }
}

/// Event of a row. Parameters are named as in graph files.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum KnobEvent {
    /// Set a value that a file can hold.
    Set { knob: String, value: Value },
    /// Reset to the default.
    Reset { knob: String },
    /// Expose the parameter.
    Expose { knob: String },
    /// Take the parameter off the panel.
    Unexpose { knob: String },
    /// Add a node whose mask multiplies the parameter.
    AddMask { knob: String },
    /// Remove the mask that multiplies the parameter.
    RemoveMask { knob: String },
    /// Expose the input for the mask that multiplies the parameter.
    ExposeMask { knob: String },
    /// Begin a drag: everything until [`KnobEvent::Ended`] is one step to undo.
    Began,
    /// End the drag.
    Ended,
    /// Cancel the drag, and all changes since it began.
    Canceled,
    /// Take a color from the model or the 2D view.
    Eyedropper { knob: String },
    /// Ask for a file.
    Browse { knob: String },
    /// Pick a gradient from a picture.
    PickGradient { knob: String },
    /// Show this length on the model, in working units; sent in every frame in which a length is pointed at or dragged.
    ShowLength(f64),
}

/// Parameters in one section.
pub(crate) struct KnobSection<'a> {
    /// Title, if it has one.
    pub(crate) title: Option<&'a str>,
    /// Toggle that begins the section; the rows are hidden while it is off.
    pub(crate) switch: Option<KnobRow<'a>>,
    pub(crate) rows: Vec<KnobRow<'a>>,
}

/// Shows sections of parameters, and returns their events in order.
///
/// Has to be called in every frame, also without rows, since it ends drags whose row does not exist any more. The `ui` of
/// different nodes needs different ids, so that a drag does not go on at another node.
pub(crate) fn knobs_ui(
    ui: &mut Ui,
    theme: &Theme,
    memory: &mut KnobMemory,
    sections: &[KnobSection<'_>],
    lengths: &LengthUnits,
) -> Vec<KnobEvent> {
    sections_ui(ui, KnobUi::new(theme, memory, lengths), sections)
}

/// Shows exposed parameters as [`knobs_ui`] does, without marks that they are exposed.
pub(crate) fn exposed_ui(
    ui: &mut Ui,
    theme: &Theme,
    memory: &mut KnobMemory,
    sections: &[KnobSection<'_>],
    lengths: &LengthUnits,
) -> Vec<KnobEvent> {
    let mut knob_ui = KnobUi::new(theme, memory, lengths);
    knob_ui.is_panel = true;
    sections_ui(ui, knob_ui, sections)
}

fn sections_ui(ui: &mut Ui, mut knob_ui: KnobUi<'_>, sections: &[KnobSection<'_>]) -> Vec<KnobEvent> {
    let theme = knob_ui.theme;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = BETWEEN;
        for section in sections {
            if let Some(title) = section.title {
                ui.add_space(space::USUAL);
                ui.label(RichText::new(title).size(type_size::SMALL).color(theme.quiet));
            }
            let mut is_open = true;
            if let Some(switch) = &section.switch {
                ui.add_space(space::USUAL);
                row::show(ui, &mut knob_ui, switch);
                is_open = switch.is_on();
            }
            knob_ui.section = section.switch.map(|switch| switch.knob.label.clone());
            for row in section.rows.iter().filter(|_| is_open) {
                row::show(ui, &mut knob_ui, row);
            }
            knob_ui.section = None;
        }
    });
    knob_ui.finish(ui.ctx(), |_| true);
    knob_ui.events
}
