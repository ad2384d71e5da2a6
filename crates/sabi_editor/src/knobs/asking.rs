//! What the widgets of one frame share: what was asked so far, and what is remembered from frame to frame.

use egui::{Color32, Context, Id, Key, PointerButton, Pos2, Response, Vec2};
use sabi_graph::Value;

use super::{KnobEvent, KnobRow, Lengths};
use crate::theme::Theme;

/// What knobs remember from frame to frame: what is dragged, typed and picked. Nothing of it is kept between sessions.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnobMemory {
    pub(super) drag: Option<Drag>,
    pub(super) typing: Option<Typing>,
    fault: Option<Fault>,
    /// The stop or point that is worked on, and in which row.
    pub(super) selected: Option<(Id, usize)>,
    /// The color that is picked, with the hue that a gray has not, and by which swatch.
    pub(super) picked: Option<(Id, egui::epaint::Hsva)>,
    /// The row whose menu is open, and where.
    pub(super) menu: Option<(Id, Pos2)>,
    /// The row that waits for what is on the clipboard, and since which pass.
    pub(super) pasting: Option<(Id, u64)>,
    /// What of a wheel's turn was too little for a step.
    pub(super) wheel: f32,
}

/// Text field that has the keyboard.
#[derive(Clone, Debug)]
pub(super) struct Typing {
    pub(super) id: Id,
    pub(super) text: String,
    /// Whether it still has to be given the keyboard.
    pub(super) is_new: bool,
    /// Whether all of its text is selected then.
    pub(super) is_selected: bool,
}

/// What is wrong with what was typed last.
#[derive(Clone, Debug)]
struct Fault {
    /// The row into which it was typed.
    row_id: Id,
    sentence: String,
    /// Something else was pressed since.
    is_leaving: bool,
    /// That was released: the sentence goes now, and not before, or what is clicked would move away under the pointer.
    is_over: bool,
}

/// Something that is being dragged.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    /// The widget.
    id: Id,
    has_changed: bool,
    /// Where the pointer was last.
    last: Pos2,
    /// The pass in which the widget was last seen.
    seen: u64,
    pub(super) grip: Grip,
}

/// What is held at the beginning of a drag.
#[derive(Clone, Debug, Default)]
pub(super) struct Grip {
    /// The numbers that move, not rounded.
    pub(super) exact: [f64; 3],
    /// The stop or point that moves.
    pub(super) index: usize,
    /// All of the stops or points that it is one of.
    pub(super) all: Option<Value>,
}

impl Drag {
    /// Where the pointer is.
    pub(super) fn place(&self) -> Pos2 {
        self.last
    }
}

impl Grip {
    pub(super) fn of(exact: [f64; 3]) -> Grip {
        Grip {
            exact,
            ..Grip::default()
        }
    }
}

/// What the widgets of one frame share.
pub(super) struct Asking<'a> {
    pub(super) theme: &'a Theme,
    pub(super) memory: &'a mut KnobMemory,
    pub(super) lengths: Lengths,
    /// Factor on type and heights.
    pub(super) zoom: f32,
    /// Whether these are the knobs of a panel, of which each is published.
    pub(super) is_panel: bool,
    pub(super) events: Vec<KnobEvent>,
}

impl<'a> Asking<'a> {
    pub(super) fn new(theme: &'a Theme, memory: &'a mut KnobMemory, lengths: &Lengths) -> Asking<'a> {
        Asking {
            theme,
            memory,
            lengths: *lengths,
            zoom: 1.0,
            is_panel: false,
            events: Vec::new(),
        }
    }
}

impl Asking<'_> {
    /// Asks for a value, unless it is there already.
    pub(super) fn set(&mut self, row: &KnobRow<'_>, value: Value) {
        // Numbers that no file can hold were refused where they were typed; a drag just stops there.
        let Some(value) = value.canonical() else { return };
        self.forget_fault();
        if row.differs || *row.held() != value {
            if let Some(drag) = &mut self.memory.drag {
                drag.has_changed = true;
            }
            let knob = row.knob.name.clone();
            self.events.push(KnobEvent::Set { knob, value });
        }
    }

    /// Asks for the default.
    pub(super) fn reset(&mut self, row: &KnobRow<'_>) {
        self.forget_fault();
        if row.differs || row.value.is_some() {
            let knob = row.knob.name.clone();
            self.events.push(KnobEvent::Reset { knob });
        }
    }

    /// How far the pointer has come since the last frame while it drags a widget, with what it holds. `grip` says what is
    /// held at the place where the pointer was pressed.
    pub(super) fn pull(
        &mut self,
        response: &Response,
        grip: impl FnOnce(Pos2) -> Option<Grip>,
    ) -> Option<(Vec2, &mut Drag)> {
        let is_given_up = response.ctx.input(|input| input.key_pressed(Key::Escape));
        let place = place_of(response);
        if let Some(place) = place
            && response.drag_started_by(PointerButton::Primary)
            && self.memory.drag.is_none()
        {
            // The way to where the press became a drag counts too.
            let origin = place - response.total_drag_delta().unwrap_or_default();
            self.begin(&response.ctx, response.id, grip(origin)?, origin);
        }
        let drag = self.memory.drag.as_mut().filter(|drag| drag.id == response.id)?;
        drag.seen = response.ctx.cumulative_pass_nr();
        let way = place.filter(|_| !is_given_up)? - drag.last;
        drag.last += way;
        (way != Vec2::ZERO).then_some((way, drag))
    }

    /// Whether this widget is dragged.
    pub(super) fn is_dragged(&self, id: Id) -> bool {
        self.memory.drag.as_ref().is_some_and(|drag| drag.id == id)
    }

    /// Begins a drag by hand, where the widget that is dragged is another's.
    pub(super) fn begin(&mut self, context: &Context, id: Id, grip: Grip, origin: Pos2) {
        self.forget_fault();
        self.events.push(KnobEvent::Began);
        self.memory.drag = Some(Drag {
            id,
            has_changed: false,
            last: origin,
            seen: context.cumulative_pass_nr(),
            grip,
        });
    }

    /// Says that the widget of a drag is still there.
    pub(super) fn keep(&mut self, context: &Context, id: Id) {
        if let Some(drag) = self.memory.drag.as_mut().filter(|drag| drag.id == id) {
            drag.seen = context.cumulative_pass_nr();
        }
    }

    /// Ends the drag when the button was released, when the widget is gone, or when Escape gave it up, wherever the
    /// pointer is by then. Only the owner of the drag can give it up; others end it once the owner is gone.
    pub(super) fn finish(&mut self, context: &Context, is_owner: impl FnOnce(Id) -> bool) {
        let Some(drag) = &self.memory.drag else { return };
        let pass = context.cumulative_pass_nr();
        let is_owner = is_owner(drag.id);
        let is_seen = if is_owner {
            drag.seen == pass
        } else {
            drag.seen + 1 >= pass
        };
        let [is_down, is_given_up] =
            context.input(|input| [input.pointer.primary_down(), input.key_pressed(Key::Escape)]);
        if is_seen && (!is_owner || is_down && !is_given_up) {
            return;
        }
        if is_owner && is_given_up {
            self.events.push(KnobEvent::GivenUp);
            // Nothing else is left or closed by it.
            context.input_mut(|input| input.consume_key(egui::Modifiers::NONE, Key::Escape));
        } else {
            self.events.push(KnobEvent::Ended);
        }
        self.memory.drag = None;
    }

    /// The color of what stands beside a value, on a filled bar too.
    pub(super) fn beside(&self) -> Color32 {
        self.theme.quiet.lerp_to_gamma(self.theme.text, 0.45)
    }

    /// Keeps a sentence to be shown under a row until something else is clicked or asked for.
    pub(super) fn fault(&mut self, row_id: Id, sentence: impl Into<String>) {
        self.memory.fault = Some(Fault {
            row_id,
            sentence: sentence.into(),
            is_leaving: false,
            is_over: false,
        });
    }

    /// The sentence that stands under a row.
    pub(super) fn fault_of(&self, row_id: Id) -> Option<String> {
        let fault = self.memory.fault.as_ref().filter(|fault| fault.row_id == row_id)?;
        Some(fault.sentence.clone())
    }

    pub(super) fn forget_fault(&mut self) {
        self.memory.fault = None;
    }

    /// Lets the sentence under a row go when something else is clicked.
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

/// Where the pointer is that holds a widget, also once it has left the window and come back.
fn place_of(response: &Response) -> Option<Pos2> {
    let context = &response.ctx;
    response.interact_pointer_pos().or_else(|| {
        let place = context.input(|input| input.pointer.interact_pos())?;
        let to_layer = context
            .layer_transform_from_global(response.layer_id)
            .unwrap_or_default();
        response.dragged().then(|| to_layer * place)
    })
}
