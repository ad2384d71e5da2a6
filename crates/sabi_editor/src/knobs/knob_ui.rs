//! State that the widgets of one frame share: the requests so far, and the state kept between frames.

use egui::{Color32, Context, Id, Key, PointerButton, Pos2, Response, Vec2};
use sabi_graph::Value;

use super::{KnobEvent, KnobRow, LengthUnits};
use crate::theme::Theme;

/// State of parameter rows between frames: what is dragged, typed and picked. It is not saved.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnobMemory {
    pub(super) drag: Option<Drag>,
    pub(super) typing: Option<TypedText>,
    fault: Option<TextFault>,
    /// Row and index of the selected stop or point.
    pub(super) selected: Option<(Id, usize)>,
    /// Swatch whose picker is open, and its color with a hue even for grays.
    pub(super) picked: Option<(Id, egui::epaint::Hsva)>,
    /// Row whose menu is open, and its place.
    pub(super) menu: Option<(Id, Pos2)>,
    /// Row that waits for the clipboard, and the pass since when.
    pub(super) pasting: Option<(Id, u64)>,
    /// Remainder of scrolling that was too little for a step.
    pub(super) wheel: f32,
}

/// Text field that has the keyboard.
#[derive(Clone, Debug)]
pub(super) struct TypedText {
    pub(super) id: Id,
    pub(super) text: String,
    /// True until the field was given the keyboard focus.
    pub(super) is_new: bool,
    /// True if all of its text is selected when it gets the focus.
    pub(super) is_selected: bool,
}

/// Error in the text that was typed last.
#[derive(Clone, Debug)]
struct TextFault {
    /// Row of the text.
    row_id: Id,
    sentence: String,
    /// True if something else was pressed since.
    is_leaving: bool,
    /// True if that press was released. The error disappears only then, or else the clicked widget would move from
    /// under the pointer.
    is_over: bool,
}

/// Drag of a widget.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    /// Id of the widget.
    id: Id,
    has_changed: bool,
    /// Place of the pointer in the last frame.
    last: Pos2,
    /// Pass in which the widget was shown last.
    shown: u64,
    pub(super) values: DragValues,
}

/// Values that a drag changes.
#[derive(Clone, Debug, Default)]
pub(super) struct DragValues {
    /// Dragged numbers, not rounded.
    pub(super) exact: [f64; 3],
    /// Index of the dragged stop or point.
    pub(super) index: usize,
    /// All stops or points at the beginning.
    pub(super) all: Option<Value>,
}

impl Drag {
    /// Place of the pointer.
    pub(super) fn place(&self) -> Pos2 {
        self.last
    }
}

impl DragValues {
    pub(super) fn of(exact: [f64; 3]) -> DragValues {
        DragValues {
            exact,
            ..DragValues::default()
        }
    }
}

/// State that the widgets of a frame share.
pub(super) struct KnobUi<'a> {
    pub(super) theme: &'a Theme,
    pub(super) memory: &'a mut KnobMemory,
    pub(super) lengths: LengthUnits,
    /// Factor of type size and heights.
    pub(super) zoom: f32,
    /// True if the rows are those of exposed parameters.
    pub(super) is_panel: bool,
    /// Label of the switch of the section that is shown, if it has one.
    pub(super) section: Option<String>,
    pub(super) events: Vec<KnobEvent>,
}

impl<'a> KnobUi<'a> {
    pub(super) fn new(theme: &'a Theme, memory: &'a mut KnobMemory, lengths: &LengthUnits) -> KnobUi<'a> {
        KnobUi {
            theme,
            memory,
            lengths: *lengths,
            zoom: 1.0,
            is_panel: false,
            section: None,
            events: Vec::new(),
        }
    }
}

impl KnobUi<'_> {
    /// Label as a row shows it: without the words of its section, which stand above it.
    pub(super) fn short_label(&self, label: &str) -> String {
        match &self.section {
            Some(section) => without_section(label, section),
            None => label.to_owned(),
        }
    }

    /// Requests a value, unless the parameter has it.
    pub(super) fn set(&mut self, row: &KnobRow<'_>, value: Value) {
        // Typed numbers that a file cannot store are refused before; a drag stops at them.
        let Some(value) = value.canonical() else { return };
        self.forget_fault();
        if row.differs || *row.current() != value {
            if let Some(drag) = &mut self.memory.drag {
                drag.has_changed = true;
            }
            let knob = row.knob.name.clone();
            self.events.push(KnobEvent::Set { knob, value });
        }
    }

    /// Requests the default.
    pub(super) fn reset(&mut self, row: &KnobRow<'_>) {
        self.forget_fault();
        if row.differs || row.value.is_some() {
            let knob = row.knob.name.clone();
            self.events.push(KnobEvent::Reset { knob });
        }
    }

    /// Movement of the pointer since the last frame while it drags a widget, with the drag. `values_at` gives the values at
    /// the beginning, for the place where the button was pressed.
    pub(super) fn drag_delta(
        &mut self,
        response: &Response,
        values_at: impl FnOnce(Pos2) -> Option<DragValues>,
    ) -> Option<(Vec2, &mut Drag)> {
        let is_canceled = response.ctx.input(|input| input.key_pressed(Key::Escape));
        let place = place_of(response);
        if let Some(place) = place
            && response.drag_started_by(PointerButton::Primary)
            && self.memory.drag.is_none()
        {
            // Includes the distance before the press became a drag; without it, both happened in one frame.
            let origin = place - response.total_drag_delta().unwrap_or_default();
            self.begin(&response.ctx, response.id, values_at(origin)?, origin);
        }
        let drag = self.memory.drag.as_mut().filter(|drag| drag.id == response.id)?;
        drag.shown = response.ctx.cumulative_pass_nr();
        let delta = place.filter(|_| !is_canceled)? - drag.last;
        drag.last += delta;
        (delta != Vec2::ZERO).then_some((delta, drag))
    }

    /// Returns whether a widget is dragged.
    pub(super) fn is_dragged(&self, id: Id) -> bool {
        self.memory.drag.as_ref().is_some_and(|drag| drag.id == id)
    }

    /// Begins a drag of another widget.
    pub(super) fn begin(&mut self, context: &Context, id: Id, values: DragValues, origin: Pos2) {
        self.forget_fault();
        self.events.push(KnobEvent::Began);
        self.memory.drag = Some(Drag {
            id,
            has_changed: false,
            last: origin,
            shown: context.cumulative_pass_nr(),
            values,
        });
    }

    /// Marks the widget of a drag as shown in this pass.
    pub(super) fn mark_shown(&mut self, context: &Context, id: Id) {
        if let Some(drag) = self.memory.drag.as_mut().filter(|drag| drag.id == id) {
            drag.shown = context.cumulative_pass_nr();
        }
    }

    /// Ends the drag when the button is released, when the widget is not shown any more, or when Escape cancels it,
    /// wherever the pointer is. Only the owner of the drag can cancel it; others end it once the owner does not exist any
    /// more.
    pub(super) fn finish(&mut self, context: &Context, is_owner: impl FnOnce(Id) -> bool) {
        let Some(drag) = &self.memory.drag else { return };
        let pass = context.cumulative_pass_nr();
        let is_owner = is_owner(drag.id);
        let is_shown = if is_owner {
            drag.shown == pass
        } else {
            drag.shown + 1 >= pass
        };
        let [is_down, is_canceled] =
            context.input(|input| [input.pointer.primary_down(), input.key_pressed(Key::Escape)]);
        if is_shown && (!is_owner || is_down && !is_canceled) {
            return;
        }
        if is_owner && is_canceled {
            self.events.push(KnobEvent::Canceled);
            // Escape has no other effect.
            context.input_mut(|input| input.consume_key(egui::Modifiers::NONE, Key::Escape));
        } else {
            self.events.push(KnobEvent::Ended);
        }
        self.memory.drag = None;
    }

    /// Color of text beside a value, which can be read on a filled bar as well.
    pub(super) fn beside(&self) -> Color32 {
        self.theme.quiet.lerp_to_gamma(self.theme.text, 0.45)
    }

    /// Shows an error below a row until something else is clicked or requested.
    pub(super) fn fault(&mut self, row_id: Id, sentence: impl Into<String>) {
        self.memory.fault = Some(TextFault {
            row_id,
            sentence: sentence.into(),
            is_leaving: false,
            is_over: false,
        });
    }

    /// Error below a row.
    pub(super) fn fault_of(&self, row_id: Id) -> Option<String> {
        let fault = self.memory.fault.as_ref().filter(|fault| fault.row_id == row_id)?;
        Some(fault.sentence.clone())
    }

    pub(super) fn forget_fault(&mut self) {
        self.memory.fault = None;
    }

    /// Removes the error below a row when something else is clicked.
    pub(super) fn age_fault(&mut self, context: &Context, row_id: Id) {
        let Some(fault) = self.memory.fault.as_mut().filter(|fault| fault.row_id == row_id) else {
            return;
        };
        if fault.is_over {
            self.forget_fault();
            return;
        }
        let [is_pressed, is_released] =
            context.input(|input| [input.pointer.any_pressed(), input.pointer.any_released()]);
        fault.is_leaving |= is_pressed;
        fault.is_over = fault.is_leaving && is_released;
    }
}

/// Place of the pointer that drags a widget, also after it has left the window and returned.
fn place_of(response: &Response) -> Option<Pos2> {
    let context = &response.ctx;
    response.interact_pointer_pos().or_else(|| {
        let place = context.input(|input| input.pointer.interact_pos())?;
        let to_layer = context.layer_transform_from_global(response.layer_id);
        // Most layers have no transform, as if it were the identity.
        let to_layer = to_layer.unwrap_or_default();
        response.dragged().then(|| to_layer * place)
    })
}

/// Returns a label without the words of its section at its start, unless nothing else would remain.
fn without_section(label: &str, section: &str) -> String {
    let rest = match (label.get(..section.len()), label.get(section.len()..)) {
        (Some(start), Some(rest)) if start.eq_ignore_ascii_case(section) => {
            // Only where a word ends there.
            rest.strip_prefix(' ').unwrap_or("")
        }
        _ => "",
    };
    let mut letters = rest.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => label.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_does_not_repeat_the_title_of_its_section() {
        for (label, section, short) in [
            ("Roughness map", "ROUGHNESS", "Map"),
            ("Roughness", "ROUGHNESS", "Roughness"),
            ("Opacity", "ROUGHNESS", "Opacity"),
            ("Colorize", "COLOR", "Colorize"),
            ("Color mode", "", "Color mode"),
        ] {
            assert_eq!(without_section(label, section), short);
        }
    }
}
