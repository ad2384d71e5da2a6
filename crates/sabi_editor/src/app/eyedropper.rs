//! A color for a knob, taken where it is seen: on the model or in the 2D view.

use egui::{Context, Key, Modifiers};
use sabi_editing::KnobTarget;

use super::Editor;

/// A color as a file has it, or why there is none to take.
pub(crate) type Taken = Result<[u8; 3], String>;

impl Editor {
    /// The next click on the model or in the 2D view takes a color for a knob; asked for again, it does not.
    pub(super) fn ask_for_color(&mut self, knob: KnobTarget) {
        let held = &mut self.panels.parameters.eyedropper;
        if held.take_if(|held| *held == knob).is_some() {
            return;
        }
        *held = Some(knob);
        self.say("Click the color on the model or in the 2D view. Escape gives it up.");
    }

    pub(super) fn is_taking_color(&self) -> bool {
        self.panels.parameters.eyedropper.is_some()
    }

    /// Whether a color is wanted for a knob of a node, which goes by its name for the evaluation.
    pub(super) fn takes_color_for(&self, node: &str) -> bool {
        match &self.panels.parameters.eyedropper {
            Some(KnobTarget::Node { node: own, .. }) => self.document.full_id(own) == node,
            _ => false,
        }
    }

    /// Escape gives it up, and means nothing else then.
    pub(super) fn put_down_eyedropper(&mut self, context: &Context) {
        if self.is_taking_color() && context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.panels.parameters.eyedropper = None;
        }
    }

    /// Gives the knob the color that was clicked; where there was none, says so and waits for another click.
    pub(super) fn take_color(&mut self, taken: Taken) {
        let [red, green, blue] = match taken {
            Ok(color) => color,
            Err(why) => return self.say(why),
        };
        if let Some(knob) = self.panels.parameters.eyedropper.take() {
            let text = format!("#{red:02x}{green:02x}{blue:02x}");
            self.document.set_at(&knob, sabi_graph::Value::Text(text));
        }
    }
}
