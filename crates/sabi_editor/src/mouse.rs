//! Mouse drags, by preset.

use egui::{Modifiers, PointerButton};

use crate::command::{InputPreset, Scope};

/// Effect of a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DragAction {
    /// Moves the view.
    Pan,
    /// Zooms.
    Zoom,
    /// Turns the model.
    Orbit,
    /// Turns the light.
    Light,
    /// Selects in a box.
    Box,
    /// Selects in a closed line.
    Lasso,
    /// Cuts wires.
    Cut,
}

impl DragAction {
    /// Title in the list of keys.
    pub(crate) fn title(self) -> &'static str {
        match self {
            DragAction::Pan => "Pan",
            DragAction::Zoom => "Zoom",
            DragAction::Orbit => "Turn the model",
            DragAction::Light => "Turn the light",
            DragAction::Box => "Select in a box",
            DragAction::Lasso => "Select in a line",
            DragAction::Cut => "Cut wires",
        }
    }
}

/// Button with held keys, and the effect of a drag with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DragBinding {
    pub(crate) action: DragAction,
    held: &'static [HeldKey],
    button: PointerButton,
}

/// Key that is held with a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HeldKey {
    Ctrl,
    Shift,
    Alt,
}

impl DragBinding {
    /// Text in the list of keys.
    pub(crate) fn text(&self) -> String {
        let held: String = self.held.iter().map(|key| format!("{key:?}+")).collect();
        let button = match self.button {
            PointerButton::Primary => "Left",
            PointerButton::Secondary => "Right",
            _ => "Middle",
        };
        format!("{held}{button} drag")
    }

    /// Returns whether a button and at least its keys are held.
    fn is(&self, modifiers: Modifiers, button: PointerButton) -> bool {
        let is_held = |key: &HeldKey| match key {
            HeldKey::Ctrl => modifiers.command || modifiers.ctrl,
            HeldKey::Shift => modifiers.shift,
            HeldKey::Alt => modifiers.alt,
        };
        self.button == button && self.held.iter().all(is_held)
    }
}

/// Rows of an effect, held keys and the button. The first that fits counts, so that those with more keys go first.
macro_rules! bindings {
    ($($action:ident [$($held:ident)*] $button:ident;)*) => {
        &[$(DragBinding {
            action: DragAction::$action,
            held: &[$(HeldKey::$held),*],
            button: PointerButton::$button,
        },)*]
    };
}

const CANVAS: &[DragBinding] = bindings! {
    Pan [] Middle;
    Pan [Ctrl Shift] Primary;
    Zoom [Alt] Secondary;
    Cut [Ctrl] Secondary;
    Lasso [Alt] Primary;
    Box [] Primary;
};

const CANVAS_OF_BLENDER: &[DragBinding] = bindings! {
    Zoom [Ctrl] Middle;
    Pan [] Middle;
    Cut [Ctrl] Secondary;
    Lasso [Alt] Primary;
    Box [] Primary;
};

const VIEWPORT: &[DragBinding] = bindings! {
    Pan [Shift] Primary;
    Orbit [] Primary;
    Orbit [Shift] Middle;
    Orbit [Ctrl] Middle;
    Pan [] Middle;
    Light [Shift] Secondary;
    Zoom [] Secondary;
};

const VIEWPORT_OF_BLENDER: &[DragBinding] = bindings! {
    Pan [Shift] Middle;
    Zoom [Ctrl] Middle;
    Orbit [] Middle;
    // For mice with two buttons.
    Pan [Shift Alt] Primary;
    Orbit [Alt] Primary;
    Light [Shift] Secondary;
};

const VIEWPORT_OF_SUBSTANCE: &[DragBinding] = bindings! {
    Orbit [Alt] Primary;
    Orbit [] Primary;
    Pan [Alt] Middle;
    Pan [] Middle;
    Light [Shift] Secondary;
    Zoom [Alt] Secondary;
};

/// Bindings of a preset in a scope, in the order in which they are tried.
pub(crate) fn bindings(preset: InputPreset, scope: Scope) -> &'static [DragBinding] {
    match (scope, preset) {
        (Scope::Canvas, InputPreset::Blender) => CANVAS_OF_BLENDER,
        (Scope::Canvas, _) => CANVAS,
        (Scope::Viewport, InputPreset::Default) => VIEWPORT,
        (Scope::Viewport, InputPreset::Blender) => VIEWPORT_OF_BLENDER,
        (Scope::Viewport, InputPreset::Substance) => VIEWPORT_OF_SUBSTANCE,
        (Scope::Window | Scope::Flat, _) => &[],
    }
}

/// Effect of a drag with a button in a scope, if it has any.
pub(crate) fn action_of(
    preset: InputPreset,
    scope: Scope,
    modifiers: Modifiers,
    button: PointerButton,
) -> Option<DragAction> {
    let bindings = bindings(preset, scope).iter();
    let mut matching = bindings.filter(|binding| binding.is(modifiers, button));
    matching.next().map(|binding| binding.action)
}

/// Effect of the current drag of a widget in a scope; `None` where it is not dragged.
pub(crate) fn dragged(preset: InputPreset, scope: Scope, response: &egui::Response) -> Option<DragAction> {
    let buttons = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];
    let held = buttons.into_iter().find(|button| response.dragged_by(*button))?;
    action_of(preset, scope, response.ctx.input(|input| input.modifiers), held)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CTRL: Modifiers = Modifiers::COMMAND;
    const NONE: Modifiers = Modifiers::NONE;
    const SHIFT: Modifiers = Modifiers::SHIFT;
    const ALT: Modifiers = Modifiers::ALT;

    #[test]
    fn drags_mean_what_they_mean_in_the_program_of_the_preset() {
        use DragAction::{Cut, Lasso, Orbit, Pan, Zoom};
        use InputPreset::{Blender, Default, Substance};
        use PointerButton::{Middle, Primary, Secondary};
        let expected = [
            (Blender, Scope::Viewport, NONE, Middle, Some(Orbit)),
            (Blender, Scope::Viewport, SHIFT, Middle, Some(Pan)),
            (Blender, Scope::Viewport, CTRL, Middle, Some(Zoom)),
            (Blender, Scope::Viewport, NONE, Primary, None),
            (Blender, Scope::Canvas, NONE, Middle, Some(Pan)),
            (Blender, Scope::Canvas, NONE, Primary, Some(DragAction::Box)),
            (Substance, Scope::Viewport, ALT, Primary, Some(Orbit)),
            (Substance, Scope::Viewport, ALT, Middle, Some(Pan)),
            (Substance, Scope::Viewport, ALT, Secondary, Some(Zoom)),
            (Substance, Scope::Viewport, NONE, Secondary, None),
            (Default, Scope::Viewport, NONE, Primary, Some(Orbit)),
            (Default, Scope::Viewport, SHIFT, Primary, Some(Pan)),
            (Default, Scope::Viewport, NONE, Secondary, Some(Zoom)),
            (Default, Scope::Canvas, CTRL | SHIFT, Primary, Some(Pan)),
            (Default, Scope::Canvas, ALT, Secondary, Some(Zoom)),
            (Default, Scope::Canvas, CTRL, Secondary, Some(Cut)),
            (Default, Scope::Canvas, ALT, Primary, Some(Lasso)),
            (Default, Scope::Canvas, SHIFT, Primary, Some(DragAction::Box)),
            (Default, Scope::Canvas, NONE, Secondary, None),
        ];
        for (preset, scope, modifiers, button, action) in expected {
            assert_eq!(
                action_of(preset, scope, modifiers, button),
                action,
                "{preset:?} {scope:?} {modifiers:?} {button:?}"
            );
        }
    }

    #[test]
    fn no_binding_is_hidden_by_one_before_it() {
        for (preset, name) in InputPreset::ALL {
            for scope in [Scope::Canvas, Scope::Viewport] {
                for binding in bindings(preset, scope) {
                    let mut modifiers = Modifiers::NONE;
                    for held in binding.held {
                        match held {
                            HeldKey::Ctrl => modifiers.command = true,
                            HeldKey::Shift => modifiers.shift = true,
                            HeldKey::Alt => modifiers.alt = true,
                        }
                    }
                    let found = action_of(preset, scope, modifiers, binding.button);
                    assert_eq!(found, Some(binding.action), "{} in {name}", binding.text());
                }
            }
        }
    }
}
