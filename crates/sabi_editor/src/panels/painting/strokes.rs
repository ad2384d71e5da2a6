//! The strokes of a paint node on the shown model.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Image, Key, Rect, ScrollArea, Sense, Slider, TextEdit, Ui, WidgetInfo, WidgetType, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::PaintCommand;
use sabi_editing::painting::{strokes_of, strokes_on};
use sabi_engine::paint::{Action as BrushAction, Area, Brush, Step, Stroke, StrokeList, Version};
use sabi_graph::NodeId;

use super::swatches::{SWATCH, Swatches};
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;
use crate::panels::reordering;

/// Height of a row, points.
const ROW: f32 = 24.0;

/// Rows of strokes, and the one whose name is typed.
#[derive(Default)]
pub(super) struct StrokeRows {
    /// Row that a range is marked from.
    anchor: Option<usize>,
    renamed: Option<(Version, String)>,
    /// Steps of the slider that is dragged, which are taken once it is let go.
    slid: Option<f32>,
}

/// A stroke that is dragged to another place in the list.
struct DraggedStroke(Version, String);

/// Request of a row or a tool.
enum Asked {
    /// Steps in the list, with their name in the history.
    Steps(&'static str, Vec<Step>),
    /// These strokes marked.
    Mark(BTreeSet<Version>),
}

impl StrokeRows {
    /// Shows the strokes on the shown model, the topmost first.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        id: &NodeId,
    ) -> Vec<Action> {
        let Some(model) = &context.evaluation.model.received else {
            return Vec::new();
        };
        let linked = &model.linked;
        let name = &linked.model.stem;
        let mut actions = Vec::new();
        let Some(list) = strokes_on(context.document, id, name).filter(|list| !list.strokes.is_empty()) else {
            ui.weak(format!("Nothing is painted on {name} yet."));
            return actions;
        };
        let done = self.tools(ui, context, &list, linked.largest_side, &mut actions);
        let asked = done.or(self.rows(ui, context, swatches, &list));
        actions.extend(asked.map(|asked| {
            Action::Paint(match asked {
                Asked::Mark(strokes) => PaintAction::Mark(strokes),
                Asked::Steps(title, steps) => PaintAction::Change(PaintCommand::Steps {
                    node: id.clone(),
                    model: name.clone(),
                    before: strokes_of(context.document, id).unwrap_or_default(), // It has a list.
                    title: title.to_owned(),
                    steps,
                }),
            })
        }));
        actions
    }

    /// Tools for the marked strokes.
    fn tools(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        list: &StrokeList,
        largest_side: f64,
        actions: &mut Vec<Action>,
    ) -> Option<Asked> {
        let is_marked = |stroke: &&Arc<Stroke>| context.looks.marked_strokes.contains(&stroke.id);
        let marked: Vec<&Arc<Stroke>> = list.strokes.iter().filter(is_marked).collect();
        let Some(first) = marked.first() else {
            ui.weak("Click strokes to change them, with Ctrl or Shift several.");
            return None;
        };
        let mut asked = None;
        ui.horizontal(|ui| {
            let brush = context.settings.brush.brush(largest_side);
            if tool(ui, icon::PAINT_BRUSH, "Give them the present brush") {
                let steps = marked
                    .iter()
                    .map(|stroke| with_brush(stroke, placed(stroke, brush.clone())));
                asked = Some(Asked::Steps("Brush of strokes", steps.collect()));
            }
            if tool(ui, icon::EYEDROPPER_SAMPLE, "Take its brush") {
                let taken = context.settings.brush.like(first, largest_side);
                actions.push(Action::Paint(PaintAction::Choose(taken)));
            }
            if tool(ui, icon::TRASH, "Remove the strokes") {
                asked = Some(Asked::Steps(
                    "Remove strokes",
                    vec![Step::Remove(marked.iter().map(|stroke| stroke.id).collect())],
                ));
            }
            asked = asked.take().or(self.opacity(ui, &marked, first.brush.opacity));
        });
        asked
    }

    /// The slider of the opacity of the marked strokes.
    fn opacity(&mut self, ui: &mut Ui, marked: &[&Arc<Stroke>], now: f32) -> Option<Asked> {
        let mut opacity = self.slid.unwrap_or(now);
        let slider = ui.add(Slider::new(&mut opacity, 0.0..=1.0).text("Opacity"));
        if slider.changed() {
            self.slid = Some(opacity);
        }
        // One step once it is let go, so that the list stays short.
        let is_done = slider.drag_stopped() || slider.lost_focus() || (slider.changed() && !slider.dragged());
        let opacity = self.slid.take_if(|_| is_done)?;
        let changed = marked.iter().map(|stroke| {
            let brush = Brush {
                opacity,
                ..stroke.brush.clone()
            };
            with_brush(stroke, brush)
        });
        Some(Asked::Steps("Opacity of strokes", changed.collect()))
    }

    fn rows(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        list: &StrokeList,
    ) -> Option<Asked> {
        let count = list.strokes.len();
        let mut asked = None;
        let mut places: Vec<Rect> = Vec::new();
        let mut first = 0;
        let area = ScrollArea::vertical().id_salt("strokes");
        area.show_rows(ui, ROW, count, |ui, rows| {
            first = rows.start;
            for index in rows.map(|row| count - 1 - row) {
                let stroke = &list.strokes[index];
                let shown = ui.push_id(stroke.id.0, |ui| {
                    ui.horizontal(|ui| self.row(ui, context, swatches, (list, index)))
                });
                places.push(shown.response.rect);
                asked = asked.take().or(shown.inner.inner);
            }
        });
        let title = |dragged: &DraggedStroke| Some(dragged.1.clone());
        if let Some((dragged, gap)) = reordering::dropped(ui, context.theme, &places, title) {
            let from = list.strokes.iter().position(|stroke| stroke.id == dragged.0)?;
            // Gaps are counted from the topmost row, the order of strokes from the lowest.
            let gap = count.saturating_sub(first + gap);
            let to = if gap > from { gap - 1 } else { gap };
            if to != from {
                asked = Some(Asked::Steps(
                    "Order of strokes",
                    vec![Step::Move { stroke: dragged.0, to }],
                ));
            }
        }
        asked
    }

    /// Row of a stroke.
    fn row(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        (list, index): (&StrokeList, usize),
    ) -> Option<Asked> {
        let stroke = &list.strokes[index];
        let (eye, name) = match stroke.is_hidden {
            true => (icon::EYE_SLASH, "Show the stroke"),
            false => (icon::EYE, "Hide the stroke"),
        };
        if tool(ui, eye, name) {
            return Some(Asked::Steps(
                name,
                vec![Step::Change {
                    stroke: stroke.id,
                    name: stroke.name.clone(),
                    brush: Box::new(stroke.brush.clone()),
                    is_hidden: !stroke.is_hidden,
                }],
            ));
        }
        let size = vec2(0.6 * SWATCH[0] as f32, 0.6 * SWATCH[1] as f32);
        match swatches.of(ui, context, &shown_brush(stroke)) {
            Some(texture) => ui.add(Image::new((texture, size))),
            None => ui.allocate_response(size, Sense::hover()),
        };
        if let Some(asked) = self.typed_name(ui, stroke) {
            return asked;
        }
        let title = title_of(stroke, index);
        let label = ui.selectable_label(context.looks.marked_strokes.contains(&stroke.id), &title);
        let label = label.interact(Sense::click_and_drag());
        label.dnd_set_drag_payload(DraggedStroke(stroke.id, title));
        if label.double_clicked() {
            self.renamed = Some((stroke.id, stroke.name.clone()));
        } else if label.clicked() {
            let marked = self.mark(ui, &context.looks.marked_strokes, list, index);
            return Some(Asked::Mark(marked));
        }
        None
    }

    /// The field for the name of a stroke, while it is typed; inside is what it asks for.
    fn typed_name(&mut self, ui: &mut Ui, stroke: &Arc<Stroke>) -> Option<Option<Asked>> {
        let (_, text) = self.renamed.as_mut().filter(|(id, _)| *id == stroke.id)?;
        let field = ui.add(TextEdit::singleline(text).hint_text("Name").desired_width(120.0));
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.renamed = None;
            return Some(None);
        }
        if !field.lost_focus() {
            field.request_focus();
            return Some(None);
        }
        let (_, name) = self.renamed.take()?;
        let name = name.trim().to_owned();
        Some((name != stroke.name).then(|| {
            Asked::Steps(
                "Name of a stroke",
                vec![Step::Change {
                    stroke: stroke.id,
                    name,
                    brush: Box::new(stroke.brush.clone()),
                    is_hidden: stroke.is_hidden,
                }],
            )
        }))
    }

    /// The marked strokes after a click on a row: it alone, with Ctrl besides others, with Shift all from the row that was clicked
    /// before.
    fn mark(&mut self, ui: &Ui, known: &BTreeSet<Version>, list: &StrokeList, index: usize) -> BTreeSet<Version> {
        let modifiers = ui.input(|input| input.modifiers);
        let id = list.strokes[index].id;
        let mut marked = known.clone();
        if let Some(anchor) = self
            .anchor
            .filter(|anchor| modifiers.shift && *anchor < list.strokes.len())
        {
            let range = anchor.min(index)..=anchor.max(index);
            marked.extend(list.strokes[range].iter().map(|stroke| stroke.id));
            return marked;
        }
        self.anchor = Some(index);
        if !modifiers.command {
            return BTreeSet::from([id]);
        }
        if !marked.remove(&id) {
            marked.insert(id);
        }
        marked
    }
}

/// The brush of a stroke as its picture shows it: a decal upright, and once.
fn shown_brush(stroke: &Stroke) -> Brush {
    let brush = stroke.brush.clone();
    if !stroke.area.is_single() {
        return brush;
    }
    Brush {
        angle_degrees: 0.0,
        spacing: 4.0,
        ..brush
    }
}

/// Number of strokes of a paint node on the shown model.
pub(super) fn count(context: &ViewContext<'_>, id: &NodeId) -> usize {
    let model = context.evaluation.model.received.as_ref();
    let list = model.and_then(|model| strokes_on(context.document, id, &model.linked.model.stem));
    list.map_or(0, |list| list.strokes.len())
}

/// A button with a sign; returns whether it was clicked.
fn tool(ui: &mut Ui, sign: &str, name: &str) -> bool {
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

/// Name of a stroke in the list.
fn title_of(stroke: &Stroke, index: usize) -> String {
    if !stroke.name.is_empty() {
        return stroke.name.clone();
    }
    let what = match (stroke.action, stroke.area) {
        (BrushAction::Paint, Area::Way) => "Stroke",
        (BrushAction::Paint, Area::Decal) => "Decal",
        (BrushAction::Paint, Area::Label) => "Label",
        (BrushAction::Paint, Area::Ribbon) => "Ribbon",
        (BrushAction::Paint, Area::Inside) => "Inside",
        (BrushAction::Paint, Area::Gradient) => "Gradient",
        (BrushAction::Paint, _) => "Fill",
        (BrushAction::Erase, _) => "Eraser",
        (BrushAction::Smear, _) => "Smear",
        (BrushAction::Blur, _) => "Blur",
        (BrushAction::Sharpen, _) => "Sharpening",
        (BrushAction::Clone, _) => "Clone",
    };
    format!("{what} {}", index + 1)
}
