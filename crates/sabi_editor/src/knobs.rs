//! The widgets of parameters: every role of a knob has one. They show what is and ask for what should be, and decide
//! nothing.

mod asking;
mod bar;
mod boxes;
mod buttons;
mod choice;
mod color;
mod curve;
mod direction;
mod doc;
mod expression;
mod inline;
mod keys;
mod length;
mod lettering;
mod numbers;
mod row;
mod sentence;
mod stops;
#[cfg(test)]
mod tests;
mod text;
mod typing;
mod values;

use egui::{RichText, Ui};
use sabi_engine::catalog::Knob;
use sabi_graph::Value;

use self::asking::Asking;
pub(crate) use self::asking::KnobMemory;
pub(crate) use self::inline::knob_inline;
pub(crate) use self::length::Lengths;
use crate::theme::{Theme, space, type_size};

/// Points between rows.
const BETWEEN: f32 = 3.0;

/// A knob as it is shown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnobRow<'a> {
    pub(crate) knob: &'a Knob,
    /// What is set, as a file has it; nothing where the default holds.
    pub(crate) value: Option<&'a Value>,
    /// What is connected, for knobs of inputs.
    pub(crate) wired: Option<&'a str>,
    /// The name under which it is published.
    pub(crate) exposed: Option<&'a str>,
    /// Whether several nodes are selected that hold different values; `value` is that of one of them.
    pub(crate) differs: bool,
}

impl KnobRow<'_> {
    /// What is set, or the default.
    fn held(&self) -> &Value {
        self.value.unwrap_or(&self.knob.ty.default)
    }

    /// Whether anything but the default holds.
    fn is_changed(&self) -> bool {
        self.differs || *self.held() != self.knob.ty.default
    }
}

/// What is asked for. Knobs go by their name in graph files.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum KnobEvent {
    /// To hold this value, which is one that a file may hold.
    Set { knob: String, value: Value },
    /// To hold the default.
    Reset { knob: String },
    /// To be published.
    Expose { knob: String },
    /// To be published no longer.
    Unexpose { knob: String },
    /// A drag begins: everything up to [`KnobEvent::Ended`] is one step to undo.
    Began,
    /// The drag ends.
    Ended,
    /// The drag is given up: nothing that was asked for since it began was meant.
    GivenUp,
    /// To take a color from where it is seen.
    Eyedropper { knob: String },
    /// To have a file chosen.
    Browse { knob: String },
    /// To show how long this is, in working units; asked for in every frame in which a length is pointed at or dragged.
    ShowLength(f64),
}

/// Knobs of a panel that stand together, under a title where they have one.
pub(crate) struct KnobSection<'a> {
    pub(crate) title: Option<&'a str>,
    pub(crate) rows: Vec<KnobRow<'a>>,
}

/// Shows rows of knobs and says what is asked for, in order.
///
/// To be called in every frame, without rows where there are none: a drag ends here too when its row has gone. The `ui` of
/// other nodes needs another id, so that what was begun on one node is not taken by another.
pub(crate) fn knobs_ui(
    ui: &mut Ui,
    theme: &Theme,
    memory: &mut KnobMemory,
    rows: &[KnobRow<'_>],
    lengths: &Lengths,
) -> Vec<KnobEvent> {
    let mut ask = Asking::new(theme, memory, lengths);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = BETWEEN;
        for row in rows {
            row::show(ui, &mut ask, row);
        }
    });
    ask.finish(ui.ctx(), |_| true);
    ask.events
}

/// Shows knobs that are published, as [`knobs_ui`] does: all are, so that no row says it.
pub(crate) fn published_ui(
    ui: &mut Ui,
    theme: &Theme,
    memory: &mut KnobMemory,
    sections: &[KnobSection<'_>],
    lengths: &Lengths,
) -> Vec<KnobEvent> {
    let mut ask = Asking::new(theme, memory, lengths);
    ask.is_panel = true;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = BETWEEN;
        for section in sections {
            if let Some(title) = section.title {
                ui.add_space(space::USUAL);
                ui.label(RichText::new(title).size(type_size::SMALL).color(theme.quiet));
            }
            for row in &section.rows {
                row::show(ui, &mut ask, row);
            }
        }
    });
    ask.finish(ui.ctx(), |_| true);
    ask.events
}
