//! The viewport as a view of the window: what it shows, and what is asked for in it.

use egui::Ui;
use sabi_engine::ViewSubject;

use super::ModelView;
use super::showing::Showing;
use crate::action::{Action, ClickedColor, SettingAction};
use crate::bars;
use crate::command::InputPreset;
use crate::context::{View, ViewContext};
use crate::key_map::KeyMap;
use crate::theme::Theme;

/// What the viewport shows.
pub(super) struct Subject<'a> {
    pub(super) seen: &'a ViewSubject,
    /// Result that it is compared with.
    pub(super) locked: Option<&'a ViewSubject>,
    /// Both results in words.
    pub(super) showing: &'a Showing,
    /// Whether a click takes a color.
    pub(super) is_taking_color: bool,
    /// Whether a parameter is being dragged.
    pub(super) is_moving: bool,
    pub(super) theme: &'a Theme,
    /// Preset that gives drags their meaning.
    pub(super) habit: InputPreset,
    pub(super) keys: &'a KeyMap,
}

/// What was asked for in the view.
#[derive(Default)]
pub(super) struct Outcome {
    /// Clicked color.
    pub(super) taken: Option<ClickedColor>,
    /// Chosen environment.
    pub(super) environment: Option<String>,
    /// Actions of the menus.
    pub(super) asked: Vec<Action>,
    /// Sentence about an environment that could not be loaded.
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
