//! The viewport as a view of the window: what it shows, and what is asked for in it.

use egui::Ui;
use sabi_engine::ViewSubject;

use super::ModelView;
use super::showing::Showing;
use crate::action::{Action, ClickedColor, SettingAction};
use crate::bars;
use crate::command::Habit;
use crate::context::{View, ViewContext};
use crate::key_map::KeyMap;
use crate::theme::Theme;

/// What is shown.
pub(super) struct Subject<'a> {
    pub(super) seen: &'a ViewSubject,
    /// What it is compared with.
    pub(super) locked: Option<&'a ViewSubject>,
    /// Both in words.
    pub(super) showing: &'a Showing,
    /// Whether a click takes the color that is seen.
    pub(super) is_taking_color: bool,
    /// Whether a knob is being moved.
    pub(super) is_moving: bool,
    pub(super) theme: &'a Theme,
    /// What drags mean.
    pub(super) habit: Habit,
    pub(super) keys: &'a KeyMap,
}

/// What was done in the view.
#[derive(Default)]
pub(super) struct Done {
    /// The color that was clicked, where one is wanted.
    pub(super) taken: Option<ClickedColor>,
    /// The environment that was chosen.
    pub(super) environment: Option<String>,
    /// What menus ask for.
    pub(super) asked: Vec<Action>,
    /// Why an environment cannot be had.
    pub(super) fault: Option<String>,
}

impl View for ModelView {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = bars::models(ui, context);
        self.length = context.looks.length;
        self.follow_comparison(context.looks.is_compared);
        let seen = context.looks.on_model(context.document, context.settings);
        let locked = context.looks.beside_model();
        let subject = Subject {
            seen: &seen,
            locked: locked.as_ref(),
            showing: &Showing::of(context, &seen, locked.as_ref()),
            is_moving: context.is_dragging,
            is_taking_color: context.looks.color_target.is_some(),
            theme: context.theme,
            habit: context.settings.habit,
            keys: context.keys,
        };
        let done = self.draw_view(ui, context.evaluation, context.render, &subject);
        let environment = done.environment.map(SettingAction::Environment);
        actions.extend(environment.map(Action::Setting));
        actions.extend(done.fault.map(Action::Notice));
        actions.extend(done.asked);
        actions.extend(done.taken.map(Action::TakeColor));
        actions
    }
}
