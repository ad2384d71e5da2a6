//! What is dragged with which button, by habit.

use egui::{Modifiers, PointerButton};

use crate::command::{Habit, Scope};

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drags {
    /// Moves what is seen.
    Pan,
    /// Comes nearer or goes away.
    Zoom,
    /// Turns the model about.
    Orbit,
    /// Turns the light.
    Light,
    /// Selects what is in a box.
    Box,
    /// Selects what is in a line.
    Lasso,
    /// Cuts wires.
    Cut,
}

impl Drags {
    /// What it is called in the list of keys.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Drags::Pan => "Move what is seen",
            Drags::Zoom => "Come nearer or go away",
            Drags::Orbit => "Turn the model",
            Drags::Light => "Turn the light",
            Drags::Box => "Select in a box",
            Drags::Lasso => "Select in a line",
            Drags::Cut => "Cut wires",
        }
    }
}

/// A button with what is held down with it, and what a drag with it does there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip {
    pub(crate) drags: Drags,
    held: &'static [Held],
    button: PointerButton,
}

/// A key that is held while a button is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Ctrl,
    Shift,
    Alt,
}

impl Grip {
    /// How it is written.
    pub(crate) fn text(&self) -> String {
        let held: String = self.held.iter().map(|key| format!("{key:?}+")).collect();
        let button = match self.button {
            PointerButton::Primary => "Left",
            PointerButton::Secondary => "Right",
            _ => "Middle",
        };
        format!("{held}{button} drag")
    }

    /// Whether everything is held that it asks for.
    fn is(&self, modifiers: Modifiers, button: PointerButton) -> bool {
        let is_held = |key: &Held| match key {
            Held::Ctrl => modifiers.command || modifiers.ctrl,
            Held::Shift => modifiers.shift,
            Held::Alt => modifiers.alt,
        };
        self.button == button && self.held.iter().all(is_held)
    }
}

/// Grips: what they do, what is held, the button. The first that fits is meant, so that those with more keys go first.
macro_rules! grips {
    ($($drags:ident [$($held:ident)*] $button:ident;)*) => {
        &[$(Grip {
            drags: Drags::$drags,
            held: &[$(Held::$held),*],
            button: PointerButton::$button,
        },)*]
    };
}

const CANVAS: &[Grip] = grips! {
    Pan [] Middle;
    Pan [Ctrl Shift] Primary;
    Zoom [Alt] Secondary;
    Cut [Ctrl] Secondary;
    Lasso [Alt] Primary;
    Box [] Primary;
};

const CANVAS_OF_BLENDER: &[Grip] = grips! {
    Zoom [Ctrl] Middle;
    Pan [] Middle;
    Cut [Ctrl] Secondary;
    Lasso [Alt] Primary;
    Box [] Primary;
};

const VIEWPORT: &[Grip] = grips! {
    Pan [Shift] Primary;
    Orbit [] Primary;
    Orbit [Shift] Middle;
    Orbit [Ctrl] Middle;
    Pan [] Middle;
    Light [Shift] Secondary;
    Zoom [] Secondary;
};

const VIEWPORT_OF_BLENDER: &[Grip] = grips! {
    Pan [Shift] Middle;
    Zoom [Ctrl] Middle;
    Orbit [] Middle;
    // For those whose mouse has two buttons.
    Pan [Shift Alt] Primary;
    Orbit [Alt] Primary;
    Light [Shift] Secondary;
};

const VIEWPORT_OF_SUBSTANCE: &[Grip] = grips! {
    Orbit [Alt] Primary;
    Orbit [] Primary;
    Pan [Alt] Middle;
    Pan [] Middle;
    Light [Shift] Secondary;
    Zoom [Alt] Secondary;
};

/// The grips of a habit in a place, in the order in which they are tried.
pub(crate) fn grips(habit: Habit, scope: Scope) -> &'static [Grip] {
    match (scope, habit) {
        (Scope::Canvas, Habit::Blender) => CANVAS_OF_BLENDER,
        (Scope::Canvas, _) => CANVAS,
        (Scope::Viewport, Habit::Default) => VIEWPORT,
        (Scope::Viewport, Habit::Blender) => VIEWPORT_OF_BLENDER,
        (Scope::Viewport, Habit::Substance) => VIEWPORT_OF_SUBSTANCE,
        (Scope::Window | Scope::Flat, _) => &[],
    }
}

/// What a drag with a button means in a place; none where it means nothing.
pub(crate) fn meant(habit: Habit, scope: Scope, modifiers: Modifiers, button: PointerButton) -> Option<Drags> {
    let grips = grips(habit, scope).iter();
    let mut meant = grips.filter(|grip| grip.is(modifiers, button));
    meant.next().map(|grip| grip.drags)
}

/// What the drag of something in a place means; none where it is not dragged.
pub(crate) fn dragged(habit: Habit, scope: Scope, response: &egui::Response) -> Option<Drags> {
    let buttons = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];
    let held = buttons.into_iter().find(|button| response.dragged_by(*button))?;
    meant(habit, scope, response.ctx.input(|input| input.modifiers), held)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CTRL: Modifiers = Modifiers::COMMAND;
    const SHIFT: Modifiers = Modifiers::SHIFT;
    const ALT: Modifiers = Modifiers::ALT;

    #[test]
    fn drags_mean_what_they_mean_in_the_tools_that_the_habit_is_of() {
        use Drags::{Cut, Lasso, Orbit, Pan, Zoom};
        use PointerButton::{Middle, Primary, Secondary};
        let expected = [
            (Habit::Blender, Scope::Viewport, Modifiers::NONE, Middle, Some(Orbit)),
            (Habit::Blender, Scope::Viewport, SHIFT, Middle, Some(Pan)),
            (Habit::Blender, Scope::Viewport, CTRL, Middle, Some(Zoom)),
            (Habit::Blender, Scope::Viewport, Modifiers::NONE, Primary, None),
            (Habit::Blender, Scope::Canvas, Modifiers::NONE, Middle, Some(Pan)),
            (
                Habit::Blender,
                Scope::Canvas,
                Modifiers::NONE,
                Primary,
                Some(Drags::Box),
            ),
            (Habit::Substance, Scope::Viewport, ALT, Primary, Some(Orbit)),
            (Habit::Substance, Scope::Viewport, ALT, Middle, Some(Pan)),
            (Habit::Substance, Scope::Viewport, ALT, Secondary, Some(Zoom)),
            (Habit::Substance, Scope::Viewport, Modifiers::NONE, Secondary, None),
            (Habit::Default, Scope::Viewport, Modifiers::NONE, Primary, Some(Orbit)),
            (Habit::Default, Scope::Viewport, SHIFT, Primary, Some(Pan)),
            (Habit::Default, Scope::Viewport, Modifiers::NONE, Secondary, Some(Zoom)),
            (Habit::Default, Scope::Canvas, CTRL | SHIFT, Primary, Some(Pan)),
            (Habit::Default, Scope::Canvas, ALT, Secondary, Some(Zoom)),
            (Habit::Default, Scope::Canvas, CTRL, Secondary, Some(Cut)),
            (Habit::Default, Scope::Canvas, ALT, Primary, Some(Lasso)),
            (Habit::Default, Scope::Canvas, SHIFT, Primary, Some(Drags::Box)),
            (Habit::Default, Scope::Canvas, Modifiers::NONE, Secondary, None),
        ];
        for (habit, scope, modifiers, button, drags) in expected {
            assert_eq!(
                meant(habit, scope, modifiers, button),
                drags,
                "{habit:?} {scope:?} {modifiers:?} {button:?}"
            );
        }
    }

    #[test]
    fn no_grip_is_hidden_by_one_before_it() {
        for (habit, name) in Habit::ALL {
            for scope in [Scope::Canvas, Scope::Viewport] {
                for grip in grips(habit, scope) {
                    let mut modifiers = Modifiers::NONE;
                    for held in grip.held {
                        match held {
                            Held::Ctrl => modifiers.command = true,
                            Held::Shift => modifiers.shift = true,
                            Held::Alt => modifiers.alt = true,
                        }
                    }
                    let found = meant(habit, scope, modifiers, grip.button);
                    assert_eq!(found, Some(grip.drags), "{} in {name}", grip.text());
                }
            }
        }
    }
}
