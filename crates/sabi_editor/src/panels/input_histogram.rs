//! Histogram of the input of an adjustment, above its parameters: it shows where black and white should be.

use std::sync::Arc;

use egui::{CursorIcon, Pos2, Sense, Stroke, Ui, WidgetInfo, WidgetType, pos2, vec2};
use sabi_editing::{OpenDocument, connections};
use sabi_engine::live::InspectedResult;
use sabi_graph::{NodeId, NodeRef, SlotRef, Value};

use crate::context::ViewContext;
use crate::flat_view::Histogram;
use crate::knobs::KnobEvent;
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

/// Distance at which a line is under the pointer, points.
const NEAR: f32 = 12.0;

/// Histogram of the input of the selected node.
#[derive(Default)]
pub(super) struct InputHistogram {
    shown: Option<(Arc<InspectedResult>, Histogram)>,
    /// Parameter whose line is dragged.
    dragged: Option<&'static str>,
    /// Histogram that is being counted.
    counting: Option<(Arc<InspectedResult>, Task<Histogram>)>,
}

impl InputHistogram {
    /// Shows the histogram, with a line at each value that a parameter stands for; nothing for other nodes. A drag of a
    /// line changes its parameter.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>, id: &NodeId) -> Vec<KnobEvent> {
        let document = context.document;
        let Some((marks, wanted)) = marks_of(document, id).zip(measured(document)) else {
            return self.ended();
        };
        let known = context.evaluation.results.measured.as_ref();
        if let Some((_, values)) = known.filter(|(node, _)| *node == wanted) {
            self.count(ui, values);
        }
        let size = vec2(ui.available_width(), HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "Histogram of the input"));
        let Some((_, histogram)) = &self.shown else {
            return self.ended();
        };
        histogram.draw_in(ui.painter(), rect, context.theme);
        let value = |name: &str| {
            let knob = document.interface(id)?.knob(name)?;
            let set = document.node(id)?.params.get(name);
            set.unwrap_or(&knob.ty.default).as_number()
        };
        let lines: Vec<(&'static str, f32)> = marks
            .iter()
            .filter_map(|name| Some((*name, histogram.place_of(value(name)? as f32, rect)?)))
            .collect();
        for (_, x) in &lines {
            let line = Stroke::new(1.5, context.theme.accent);
            ui.painter()
                .line_segment([pos2(*x, rect.top()), pos2(*x, rect.bottom())], line);
        }
        ui.add_space(space::TIGHT);
        let line_at = |at: Pos2| {
            let near = lines.iter().map(|(name, x)| ((x - at.x).abs(), *name));
            near.filter(|(distance, _)| *distance < NEAR)
                .min_by(|(one, _), (other, _)| one.total_cmp(other))
                .map(|(_, name)| name)
        };
        if let Some(name) = response.hover_pos().and_then(line_at).or(self.dragged) {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
            let title = document.interface(id).and_then(|interface| interface.knob(name));
            let title = title.map_or(name, |knob| &knob.label);
            response.clone().on_hover_text(format!("Drag to change {title}"));
        }
        if response.drag_started() {
            let pressed = ui.input(|input| input.pointer.press_origin());
            self.dragged = pressed.and_then(line_at);
            if self.dragged.is_some() {
                return vec![KnobEvent::Began];
            }
        }
        if response.drag_stopped() {
            return self.ended();
        }
        let moved = self.dragged.zip(response.interact_pointer_pos());
        let Some((name, pointer)) = moved.filter(|_| response.dragged()) else {
            return Vec::new();
        };
        let place = pointer.x.clamp(rect.left(), rect.right());
        // Thousandths, as the slider shows them.
        let value = (f64::from(histogram.value_at(place, rect)) * 1000.0).round() / 1000.0;
        let range = document
            .interface(id)
            .and_then(|interface| interface.knob(name)?.ty.limits());
        let value = range.map_or(value, |[least, most]| value.clamp(least, most));
        vec![KnobEvent::Set {
            knob: name.to_owned(),
            value: Value::Number(value),
        }]
    }

    /// Ends a drag, also where the histogram is no longer there.
    fn ended(&mut self) -> Vec<KnobEvent> {
        self.dragged.take().map(|_| KnobEvent::Ended).into_iter().collect()
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

    /// Place of a value in the histogram that is drawn in a rectangle.
    pub(super) fn place_of(&self, value: f32, rect: egui::Rect) -> Option<f32> {
        self.shown.as_ref()?.1.place_of(value, rect)
    }
}
