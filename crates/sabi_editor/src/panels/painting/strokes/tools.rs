//! Tools for the strokes that are marked in their list.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Label, RichText, Slider, Ui, WidgetInfo, WidgetType};
use egui_phosphor::regular as icon;
use sabi_paint::{Brush, Path, Step, Stroke, StrokeGroup, StrokeList};

use super::{StrokeListRequest, order};
use crate::action::{Action, PaintAction};
use crate::command::{Command, GraphCommand};
use crate::context::ViewContext;

/// Tools for marked strokes.
#[derive(Default)]
pub(super) struct StrokeTools {
    /// Value of the opacity slider while it is dragged; a step is made when it is released.
    slid: Option<f32>,
}

impl StrokeTools {
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        list: &StrokeList,
        largest_side: f64,
        actions: &mut Vec<Action>,
    ) -> Option<StrokeListRequest> {
        let ids = &context.looks.marked_strokes;
        let is_marked = |stroke: &&Arc<Stroke>| ids.contains(&stroke.id);
        let marked: Vec<Arc<Stroke>> = list.strokes.iter().filter(is_marked).cloned().collect();
        let mut asked = None;
        ui.horizontal_wrapped(|ui| {
            if let Some(first) = marked.first() {
                asked = brush_tools(ui, context, &marked, first, largest_side, actions);
                asked = asked.take().or(group_tools(ui, context, list, &marked));
                if tool(ui, icon::COPY, "Copy the strokes as text, for another Paint node") {
                    actions.push(Action::Paint(PaintAction::CopyStrokes(marked.clone())));
                }
            }
            if tool(ui, icon::CLIPBOARD_TEXT, "Paste strokes") {
                actions.push(Action::Do(Command::Graph(GraphCommand::Paste)));
            }
        });
        if marked.is_empty() {
            let hint = RichText::new("Click strokes to change them, with Ctrl or Shift several.").weak();
            ui.add(Label::new(hint).wrap());
            return asked;
        }
        asked.or(self.opacity(ui, context, list, &marked))
    }

    /// The slider of the opacity of the marked strokes, or of their group.
    fn opacity(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        list: &StrokeList,
        marked: &[Arc<Stroke>],
    ) -> Option<StrokeListRequest> {
        let group = order::group_of(list, &context.looks.marked_strokes);
        let (title, now) = match &group {
            Some(group) => ("Opacity of the group", group.opacity),
            None => ("Opacity", marked.first()?.brush.opacity),
        };
        let mut opacity = self.slid.unwrap_or(now);
        let slider = ui.add(Slider::new(&mut opacity, 0.0..=1.0).text(title));
        if slider.changed() {
            self.slid = Some(opacity);
        }
        // One step when the slider is released, so that the list of steps stays short.
        let is_done = slider.drag_stopped() || slider.lost_focus() || (slider.changed() && !slider.dragged());
        let opacity = self.slid.take_if(|_| is_done)?;
        if let Some(group) = group {
            let group = StrokeGroup {
                opacity,
                ..(*group).clone()
            };
            return Some(StrokeListRequest::Steps(
                "Opacity of a group",
                vec![order::changed(list, group)],
            ));
        }
        let changed = marked.iter().map(|stroke| {
            let brush = Brush {
                opacity,
                ..stroke.brush.clone()
            };
            with_brush(stroke, brush)
        });
        Some(StrokeListRequest::Steps("Opacity of strokes", changed.collect()))
    }
}

fn brush_tools(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    marked: &[Arc<Stroke>],
    first: &Stroke,
    largest_side: f64,
    actions: &mut Vec<Action>,
) -> Option<StrokeListRequest> {
    let mut asked = None;
    let brush = context.settings.brush.brush(largest_side);
    if tool(ui, icon::PAINT_BRUSH, "Give them the present brush") {
        let steps = marked
            .iter()
            .map(|stroke| with_brush(stroke, placed(stroke, brush.clone())));
        asked = Some(StrokeListRequest::Steps("Brush of strokes", steps.collect()));
    }
    if tool(ui, icon::EYEDROPPER_SAMPLE, "Take its brush") {
        let taken = context.settings.brush.like(first, largest_side);
        actions.push(Action::Paint(PaintAction::Choose(Box::new(taken))));
    }
    if tool(ui, icon::TRASH, "Remove the strokes") {
        let removed = marked.iter().map(|stroke| stroke.id).collect();
        asked = Some(StrokeListRequest::Steps("Remove strokes", vec![Step::Remove(removed)]));
    }
    // Fitting takes long for many strokes.
    let can_be_path = |stroke: &Arc<Stroke>| stroke.path.is_none() && Path::follows(stroke);
    if marked.iter().any(can_be_path) && tool(ui, icon::BEZIER_CURVE, "Make paths of them, with knots to bend") {
        let paths: Vec<Step> = marked.iter().filter_map(|stroke| as_path(stroke)).collect();
        asked = Some(StrokeListRequest::Steps("Path of a stroke", paths));
    }
    asked
}

fn group_tools(
    ui: &mut Ui,
    context: &ViewContext<'_>,
    list: &StrokeList,
    marked: &[Arc<Stroke>],
) -> Option<StrokeListRequest> {
    let ids = &context.looks.marked_strokes;
    if marked.iter().any(|stroke| stroke.group.is_some())
        && tool(ui, icon::FOLDER_MINUS, "Take them out of their group")
    {
        let strokes = marked.iter().map(|stroke| stroke.id).collect();
        return Some(StrokeListRequest::Steps(
            "Ungroup strokes",
            vec![Step::Group { strokes, group: None }],
        ));
    }
    let is_group = order::group_of(list, ids).is_some();
    if !is_group && tool(ui, icon::FOLDER_PLUS, "Group the strokes") {
        let marked: BTreeSet<_> = marked.iter().map(|stroke| stroke.id).collect();
        return Some(StrokeListRequest::Steps("Group strokes", order::grouped(list, &marked)));
    }
    None
}

/// The step that makes a path of a stroke that was drawn by hand; `None` for others.
fn as_path(stroke: &Stroke) -> Option<Step> {
    let path = Path::of_stroke(stroke).filter(|_| stroke.path.is_none())?;
    let (points, form) = path.places();
    Some(Step::Place {
        stroke: stroke.id,
        points,
        path: Some(form),
        eye: stroke.eye,
        stencil: stroke.stencil.clone(),
    })
}

/// A button with a sign; returns whether it was clicked.
pub(super) fn tool(ui: &mut Ui, sign: &str, name: &str) -> bool {
    let button = ui.small_button(sign);
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
    button.on_hover_text(name).clicked()
}

fn with_brush(stroke: &Stroke, brush: Brush) -> Step {
    Step::Change {
        stroke: stroke.id,
        name: stroke.name.clone(),
        brush: Box::new(brush),
        is_hidden: stroke.is_hidden,
    }
}

/// The brush on a stroke: a decal keeps the size and the turn that it was dragged to.
fn placed(stroke: &Stroke, brush: Brush) -> Brush {
    if !stroke.area.is_single() {
        return brush;
    }
    Brush {
        radius: stroke.brush.radius,
        angle_degrees: stroke.brush.angle_degrees,
        ..brush
    }
}
