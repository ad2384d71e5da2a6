//! Histogram of the input of an adjustment, above its parameters: it shows where black and white should be.

use std::sync::Arc;

use egui::{Sense, Stroke, Ui, WidgetInfo, WidgetType, pos2, vec2};
use sabi_editing::{OpenDocument, connections};
use sabi_engine::live::InspectedResult;
use sabi_graph::{NodeId, NodeRef, SlotRef};

use crate::context::ViewContext;
use crate::flat_view::Histogram;
use crate::shown_results::result_of;
use crate::task::Task;
use crate::theme::space;

/// Kinds whose input is counted, with the parameters that stand for one of its values.
const KINDS: [(&str, &[&str]); 3] = [
    ("adjust/levels", &["black", "white"]),
    ("adjust/threshold", &["at"]),
    ("adjust/curve", &[]),
];
/// Input of these kinds.
const SOURCE: &str = "source";
const HEIGHT: f32 = 56.0;
const BINS: usize = 96;

/// Result that the selected node reads, if its histogram is shown.
pub(crate) fn measured(document: &OpenDocument) -> Option<NodeRef> {
    let id = document.selected_one()?;
    marks_of(document, id)?;
    let slot = SlotRef {
        node: id.clone(),
        name: SOURCE.to_owned(),
    };
    let from = connections::wire_into(document, &slot)?;
    Some(result_of(document, &from.node, from.port.clone()))
}

/// Parameters of a node that stand for a value of its input; `None` where the input is not counted.
fn marks_of(document: &OpenDocument, id: &NodeId) -> Option<&'static [&'static str]> {
    let kind = &document.node(id)?.kind;
    KINDS.iter().find(|(known, _)| known == kind).map(|(_, marks)| *marks)
}

/// Histogram of the input of the selected node.
#[derive(Default)]
pub(super) struct InputHistogram {
    shown: Option<(Arc<InspectedResult>, Histogram)>,
    /// Histogram that is being counted.
    counting: Option<(Arc<InspectedResult>, Task<Histogram>)>,
}

impl InputHistogram {
    /// Shows the histogram, with a line at each value that a parameter stands for; nothing for other nodes.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) {
        let document = context.document;
        let Some((marks, wanted)) = marks_of(document, id).zip(measured(document)) else {
            return;
        };
        let known = context.evaluation.results.measured.as_ref();
        if let Some((_, values)) = known.filter(|(node, _)| *node == wanted) {
            self.count(ui, values);
        }
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Histogram of the input"));
        let Some((_, histogram)) = &self.shown else { return };
        histogram.draw_in(ui.painter(), rect, context.theme);
        let value = |name: &&&str| {
            let knob = document.interface(id)?.knob(name)?;
            let set = document.node(id)?.params.get(**name);
            set.unwrap_or(&knob.ty.default).as_number()
        };
        for at in marks.iter().filter_map(|name| value(&name)) {
            if let Some(x) = histogram.place_of(at as f32, rect) {
                let line = Stroke::new(1.5, context.theme.accent);
                ui.painter()
                    .line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], line);
            }
        }
        ui.add_space(space::TIGHT);
    }

    /// Counts values on a thread of its own, with the last histogram shown meanwhile.
    fn count(&mut self, ui: &Ui, values: &Arc<InspectedResult>) {
        if let Some(done) = self.counting.as_ref().and_then(|(_, task)| task.poll())
            && let Some((of, _)) = self.counting.take()
        {
            // A count that failed is made again for the next values.
            self.shown = done.ok().map(|histogram| (of, histogram));
        }
        let is_shown = self.shown.as_ref().is_some_and(|(of, _)| Arc::ptr_eq(of, values));
        if is_shown || self.counting.is_some() || values.planes.is_empty() {
            return;
        }
        let counted = values.clone();
        let task = Task::start(ui.ctx(), move || {
            Histogram::of(&counted, &counted.planes[0], None, BINS)
        });
        self.counting = Some((values.clone(), task));
    }
}

#[cfg(test)]
impl InputHistogram {
    /// Returns whether a histogram is shown.
    pub(super) fn is_shown(&self) -> bool {
        self.shown.is_some()
    }
}
