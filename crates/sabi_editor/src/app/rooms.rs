//! What is in each panel.

use egui::{Rect, Ui};
use sabi_graph::NodeRef;

use super::Editor;
use super::keys::anchor_id;
use crate::action::{Action, LookAsk};
use crate::canvas::{Around, NodeState, focus_id};
use crate::dock::{self, Docked, Layout, Panel};
use crate::flat_view;
use crate::model_view::Subject;
use crate::panels;

impl Editor {
    pub(super) fn panels(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let mut layout = std::mem::replace(self.layout_in_use(), Layout::empty("panels"));
        let theme = self.theme.clone();
        let problems = self.problem_count();
        self.rects.clear();
        self.model_view.length = self.panels.parameters.length.take();
        let mut docked = Docked {
            theme: &theme,
            problems,
            contents: &mut |ui, panel| self.panel(ui, panel, actions),
        };
        // The window is cleared to the ground, and panels leave nothing of it but the lines between them.
        egui::CentralPanel::default()
            .frame(egui::Frame::NONE)
            .show(ui, |ui| layout.ui(&mut docked, ui));
        *self.layout_in_use() = layout;
        if !self.rects.contains_key(&Panel::Canvas) {
            // What is not there cannot have the focus.
            ui.ctx().memory_mut(|memory| memory.surrender_focus(focus_id()));
        }
    }

    /// Where panels are now.
    fn layout_in_use(&mut self) -> &mut Layout {
        self.use_layout.as_mut().unwrap_or(&mut self.layout)
    }

    /// Whether only the model and the published knobs are seen.
    pub(crate) fn is_use_view(&self) -> bool {
        self.use_layout.is_some()
    }

    /// Shows only the model and the published knobs, or everything again.
    pub(super) fn toggle_use_view(&mut self) {
        self.use_layout = match self.use_layout.take() {
            Some(_) => None,
            None => {
                // The whole graph is meant, its panel and its outputs, and keys are for nothing that is not seen.
                self.document.leave_to(0);
                self.followed = None;
                self.active = Panel::Viewport;
                Some(dock::use_layout())
            }
        };
    }

    /// Brings a panel to the front; the view of model and knobs ends where it lacks that one.
    pub(crate) fn bring_up(&mut self, panel: Panel) {
        match &mut self.use_layout {
            Some(layout) if dock::has(layout, panel) => dock::bring_up(layout, panel),
            _ => {
                self.use_layout = None;
                dock::bring_up(&mut self.layout, panel);
            }
        }
    }

    /// Draws what is in a panel.
    fn panel(&mut self, ui: &mut Ui, panel: Panel, actions: &mut Vec<Action>) {
        self.rects.insert(panel, ui.max_rect());
        if panel != Panel::Canvas {
            let corner = Rect::from_min_size(ui.max_rect().min, egui::Vec2::ZERO);
            let anchor = ui.interact(corner, anchor_id(panel), egui::Sense::focusable_noninteractive());
            anchor.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, panel.title()));
        }
        match panel {
            Panel::Canvas => self.canvas_panel(ui, actions),
            Panel::Viewport => self.model_panel(ui, actions),
            Panel::Flat => self.padded(ui, |editor, ui| editor.flat_panel(ui, actions)),
            _ => self.padded(ui, |editor, ui| editor.side_panel(ui, panel, actions)),
        }
    }

    fn side_panel(&mut self, ui: &mut Ui, panel: Panel, actions: &mut Vec<Action>) {
        let theme = self.theme.clone();
        match panel {
            Panel::Parameters => panels::parameters::show(self, ui, &theme, actions),
            Panel::Stack => panels::stack::show(self, ui, &theme, actions),
            Panel::Library => panels::library::show(self, ui, &theme, actions),
            Panel::Export => panels::export::show(self, ui, &theme),
            Panel::History => panels::history::show(self, ui, &theme, actions),
            Panel::Problems => panels::problems::show(self, ui, &theme, actions),
            Panel::Performance => panels::performance::show(self, ui, &theme, actions),
            Panel::Page => panels::page::show(self, ui, &theme, actions),
            Panel::Canvas | Panel::Viewport | Panel::Flat => {}
        }
    }

    /// A panel with room around what is in it.
    fn padded(&mut self, ui: &mut Ui, contents: impl FnOnce(&mut Editor, &mut Ui)) {
        let frame = egui::Frame::new().fill(self.theme.panel).inner_margin(8);
        frame.show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            contents(self, ui);
        });
    }

    fn canvas_panel(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        self.breadcrumb(ui, actions);
        // It is drawn from what is around it.
        let mut canvas = std::mem::take(&mut self.canvas);
        let (stage, document) = (&self.stage, &self.document);
        let state_of = |id: &sabi_graph::NodeId| {
            let result = self.chosen(id);
            NodeState {
                picture: stage.thumbnail(&result).map(egui::TextureHandle::id),
                time: stage.time(&result.node),
                fault: stage.fault(&result.node).cloned(),
                waits: stage.waits(&result.node).cloned(),
            }
        };
        let here = |node: &NodeRef| document.seen_at(&node.node);
        let previewed = self.inspected().and_then(here);
        let pinned = self.pinned.as_ref().and_then(here);
        let around = Around {
            document,
            theme: &self.theme,
            state_of: &state_of,
            candidates: &self.candidates.1,
            previewed: previewed.as_ref(),
            habit: self.settings.habit,
            pinned: pinned.as_ref(),
            has_map: self.settings.has_mini_map,
        };
        actions.extend(canvas.show(ui, &around));
        self.canvas = canvas;
    }

    fn model_panel(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        self.model_strip(ui, actions);
        let seen = self.seen();
        let locked = self.locked_seen();
        let theme = self.theme.clone();
        let subject = Subject {
            seen: &seen,
            locked: locked.as_ref(),
            showing: &self.showing(),
            is_moving: self.is_moving,
            is_taking_color: self.is_taking_color(),
            theme: &theme,
            habit: self.settings.habit,
            keys: &self.keys,
        };
        let render = self.render.clone();
        let done = self.model_view.show(ui, &self.stage, render.as_ref(), &subject);
        if let Some(environment) = done.environment {
            self.settings.environment = environment;
        }
        if let Some(fault) = done.fault {
            self.say(fault);
        }
        actions.extend(done.asked);
        if let Some(taken) = done.taken {
            self.take_color(taken);
        }
    }

    fn flat_panel(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let wanted = self.inspected().cloned();
        let title = wanted.as_ref().map_or_else(String::new, |node| self.title_of(node));
        let theme = self.theme.clone();
        let subject = flat_view::Subject {
            wanted: wanted.as_ref(),
            title: &title,
            is_pinned: self.pinned.is_some(),
            is_taking_color: self.is_taking_color(),
            theme: &theme,
        };
        let done = self.flat_view.show(ui, &self.stage, &subject);
        if done.unpins {
            actions.push(Action::Look(LookAsk::Unpin));
        }
        if let Some(taken) = done.taken {
            self.take_color(taken);
        }
    }
}
