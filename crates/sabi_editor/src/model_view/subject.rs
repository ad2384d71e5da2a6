//! The viewport as a view of the window: its subject, and the requests made in it.

use std::collections::BTreeMap;

use egui::Ui;
use sabi_engine::live::ViewSubject;
use sabi_graph::{NodeRef, SavedView};

use super::ModelView;
use crate::action::{Action, ClickedColor, SettingAction};
use crate::bars;
use crate::brush::PaintSubject;
use crate::command::InputPreset;
use crate::context::{View, ViewContext};
use crate::evaluation::Evaluation;
use crate::key_map::KeyMap;
use crate::shown_results::title_of;
use crate::theme::Theme;

/// Views of a graph without preview settings.
static NO_VIEWS: BTreeMap<String, SavedView> = BTreeMap::new();

/// Result that the viewport shows, and the state that its input depends on.
pub(super) struct Subject<'a> {
    pub(super) shown: &'a ViewSubject,
    /// Result that it is compared with.
    pub(super) pinned: Option<&'a ViewSubject>,
    /// Evaluations on the models beside the main one.
    pub(super) beside: &'a [Evaluation],
    /// Both results as text.
    pub(super) showing: &'a SubjectText,
    /// True if a click picks a color.
    pub(super) is_picking_color: bool,
    /// The node that drags paint on, while they paint.
    pub(super) painted: Option<&'a PaintSubject>,
    /// True while a parameter is dragged.
    pub(super) is_moving: bool,
    pub(super) theme: &'a Theme,
    /// Preset that gives drags their meaning.
    pub(super) preset: InputPreset,
    pub(super) keys: &'a KeyMap,
    /// Views that are kept in the graph.
    pub(super) views: &'a BTreeMap<String, SavedView>,
}

/// Subject of the viewport as text.
#[derive(Clone, Debug, Default)]
pub(super) struct SubjectText {
    /// Result that is shown.
    pub(super) text: String,
    /// Result that it is compared with.
    pub(super) other: Option<String>,
    /// Sentence about why the result cannot be shown.
    pub(super) fault: Option<String>,
    /// True if the model follows clicks.
    pub(super) follows: bool,
    /// Title of the node that was clicked last.
    pub(super) clicked: Option<String>,
    /// Title of the pinned node.
    pub(super) pinned: Option<String>,
}

impl SubjectText {
    /// Text about a result and about the one beside it.
    pub(super) fn of(context: &ViewContext<'_>, shown: &ViewSubject, beside: Option<&ViewSubject>) -> SubjectText {
        let looks = context.looks;
        let title = |result: &NodeRef| title_of(context.document, result);
        let text = |subject: &ViewSubject| match subject {
            ViewSubject::Outputs => "Outputs".to_owned(),
            ViewSubject::Node(result) if looks.pinned_3d.as_ref() == Some(result) => {
                format!("Pinned: {}", title(result))
            }
            ViewSubject::Node(result) => format!("Follows: {}", title(result)),
        };
        let fault = match shown {
            ViewSubject::Node(result) => {
                let fault = context.evaluation.faults.sentence(&result.node);
                fault.map(|sentence| context.said(sentence))
            }
            ViewSubject::Outputs => context.fault_of_outputs(),
        };
        SubjectText {
            text: text(shown),
            other: beside.map(text),
            fault,
            follows: context.settings.follows,
            clicked: looks.shown.as_ref().map(title),
            pinned: looks.pinned_3d.as_ref().map(title),
        }
    }
}

/// Requests made in the view during a frame.
#[derive(Default)]
pub(super) struct ModelViewOutput {
    /// Clicked color.
    pub(super) color: Option<ClickedColor>,
    /// Chosen environment.
    pub(super) environment: Option<String>,
    /// Actions of the menus.
    pub(super) actions: Vec<Action>,
    /// Sentence about an environment that could not be loaded.
    pub(super) fault: Option<String>,
}

impl View for ModelView {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = bars::models(ui, context);
        self.length = context.looks.length;
        self.comparison.follow(context.looks.is_compared);
        let shown = context.looks.on_model(context.document, context.settings);
        let pinned = context.looks.beside_model();
        let painted = PaintSubject::of(context);
        let subject = Subject {
            shown: &shown,
            pinned: pinned.as_ref(),
            beside: context.row.beside(),
            showing: &SubjectText::of(context, &shown, pinned.as_ref()),
            painted: painted.as_ref(),
            is_moving: context.is_dragging,
            is_picking_color: context.looks.color_target.is_some(),
            theme: context.theme,
            preset: context.settings.input_preset,
            keys: context.keys,
            views: context
                .document
                .contents()
                .preview
                .as_ref()
                .map_or(&NO_VIEWS, |preview| &preview.views),
        };
        let output = self.draw_view(ui, context.evaluation, context.render, &subject);
        let environment = output.environment.map(SettingAction::Environment);
        actions.extend(environment.map(Action::Setting));
        actions.extend(output.fault.map(Action::Notice));
        actions.extend(output.actions);
        actions.extend(output.color.map(Action::TakeColor));
        actions
    }
}
