//! What the evaluation is asked for.

use egui::Context;
use sabi_graph::NodeRef;

use super::Editor;
use crate::dock::Panel;
use crate::stage::Wanted;

impl Editor {
    /// Asks the evaluation for what is seen now.
    pub(super) fn wish(&mut self, context: &Context) {
        self.look_away_from_gone();
        let mut seen = vec![self.seen()];
        seen.extend(self.locked_seen());
        let wanted = Wanted {
            seen,
            inspected: self.inspected().cloned(),
            set: self.flat_view.set,
            thumbnails: self.pictured(),
            is_flat: self.settings.is_flat,
            is_moving: self.is_moving,
        };
        self.stage.ask(&self.document, wanted);
        // What is pointed at is known once all is drawn.
        if self.model_view.length != self.panels.parameters.length {
            context.request_repaint();
        }
        // A drag that ends outside of the window ends here.
        if self.is_moving && !context.input(|input| input.pointer.any_down()) {
            self.document.session.end();
            self.is_moving = false;
            context.request_repaint();
        }
    }

    /// The results that nodes and layers show, as far as they are seen.
    fn pictured(&self) -> Vec<NodeRef> {
        let is_seen = |panel: Panel| self.rects.contains_key(&panel);
        let nodes = self
            .canvas
            .visible(&self.document)
            .into_iter()
            .map(|id| self.chosen(&id));
        let nodes = nodes.filter(|_| is_seen(Panel::Canvas));
        let layers = self.panels.stack.wanted.iter().cloned();
        nodes.chain(layers.filter(|_| is_seen(Panel::Stack))).collect()
    }

    /// How many problems there are.
    pub(super) fn problem_count(&self) -> usize {
        let stage = &self.stage;
        let failures = usize::from(stage.failure.is_some()) + usize::from(stage.model_failure.is_some());
        let of_kinds = self.document.kinds().0.faults.len();
        stage.faults.faults.len() + stage.faults.other.len() + of_kinds + failures
    }
}
