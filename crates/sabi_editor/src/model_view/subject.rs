//! The viewport as a view of the window: what it shows, and what is asked for in it.

use egui::Ui;
use sabi_engine::ViewSubject;
use sabi_graph::NodeRef;

use super::ModelView;
use crate::action::{Action, ClickedColor, SettingAction};
use crate::bars;
use crate::command::InputPreset;
use crate::context::{View, ViewContext};
use crate::key_map::KeyMap;
use crate::looks::title_of;
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

/// Subject of the viewport in words.
#[derive(Clone, Debug, Default)]
pub(super) struct Showing {
    /// Result that is shown.
    pub(super) words: String,
    /// Result that it is compared with.
    pub(super) other: Option<String>,
    /// Sentence about why the result cannot be shown.
    pub(super) fault: Option<String>,
    /// Whether the model follows clicks.
    pub(super) follows: bool,
    /// Title of the node that was clicked last.
    pub(super) clicked: Option<String>,
    /// Title of the locked node.
    pub(super) locked: Option<String>,
}

impl Showing {
    /// Words about a result and about the one beside it.
    pub(super) fn of(context: &ViewContext<'_>, seen: &ViewSubject, beside: Option<&ViewSubject>) -> Showing {
        let looks = context.looks;
        let title = |result: &NodeRef| title_of(context.document, result);
        let words = |seen: &ViewSubject| match seen {
            ViewSubject::Outputs => "Outputs".to_owned(),
            ViewSubject::Node(result) if looks.locked.as_ref() == Some(result) => format!("Locked: {}", title(result)),
            ViewSubject::Node(result) => format!("Follows: {}", title(result)),
        };
        let fault = match seen {
            ViewSubject::Node(result) => context.evaluation.sentence(&result.node).cloned(),
            ViewSubject::Outputs => context.fault_of_outputs(),
        };
        Showing {
            words: words(seen),
            other: beside.map(words),
            fault,
            follows: context.settings.follows,
            clicked: looks.shown.as_ref().map(title),
            locked: looks.locked.as_ref().map(title),
        }
    }
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
